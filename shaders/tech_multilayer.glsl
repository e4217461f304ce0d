// SPDX-License-Identifier: GPL-3.0-or-later
// Filtered multi-layer shadow maps (Selgrad, Dachsbacher, Meyer, Stamminger 2015). An occluder at some depth is looked
// up in the level whose filter is as wide as the kernel of that depth.
#include "common_min_max.glsl"
#include "common_fragments.glsl"
#include "common_accumulation.glsl"
#include "common_horizon.glsl"
#include "common_footprint.glsl"

uniform ivec4 levels[14];        // first head, texels per side, log2 of a texel's width, border of a stack or -1
uniform float filter_widths[14]; // of the box with the variance of the level's filter, in texels of the map
uniform int level_count, p_antialiasing;
uniform ivec2 parts; // of the emitter, along each of its axes

// What the fragments of one level hide between the depths of two levels.
struct share {
    OPACITY opacity;
    vec2 weight; // of the upper of the two levels: sum over the fragments, each weighted by its opacity; that of these
};

float mean(OPACITY opacity) {
#ifdef COLORED
    return dot(opacity, vec3(1.0 / 3.0));
#else
    return opacity;
#endif
}

share nothing() {
    return share(OPACITY(0.0), vec2(0.0));
}

// Adds a fragment. upper: how far its kernel's width lies from the width of the lower level to that of the upper one;
// own: the weight of the level it is in. MULTIPLY weighs a level as a whole, since (1 - w a) (1 - (1 - w) a) > 1 - a.
void accumulate(inout share s, OPACITY opacity, float upper, float own) {
    if (ACCUMULATION == ADD)
        s.opacity += own * opacity;
    else if (ACCUMULATION == MAXIMUM)
        s.opacity = max(s.opacity, own * opacity);
    else
        s.opacity = 1.0 - (1.0 - s.opacity) * (1.0 - opacity);
    s.weight += vec2(upper, 1.0) * mean(opacity);
}

// Opacity between the depths of two levels.
OPACITY blend(share lower, share upper) {
    if (ACCUMULATION != MULTIPLY)
        return min(lower.opacity + upper.opacity, OPACITY(1.0));
    vec2 weight = lower.weight + upper.weight;
    return mix(lower.opacity, upper.opacity, weight.y > 0.0 ? weight.x / weight.y : 0.0);
}

// Side of the square with the kernel's area, in texels per unit of kernel_scale.
float kernel_side(receiver r) {
    float area = 4.0 * abs(r.kernel[0].x * r.kernel[1].y - r.kernel[0].y * r.kernel[1].x);
    return max(sqrt(ELLIPSE == 1 ? 0.25 * PI * area : area), 1e-20);
}

// What kernels are at least as wide as, in texels: with shadow anti-aliasing the longer side of a pixel.
float least_width(receiver r) {
    if (p_antialiasing == 0)
        return 0.0;
    mat2 footprint = receiver_footprint(r);
    return max(length(footprint[0]), length(footprint[1]));
}

// Light-space depth at which the kernel is so wide; none for a width that no kernel has.
float depth_of_width(receiver r, float side, float width, float least) {
    if (width <= least)
        return 3e38;
    float scale = width / side;
    return is_perspective() ? 1.0 / (scale + 1.0 / r.position.z) : r.position.z - scale;
}

// Depths between which fragments are looked up in a level, and the depth at which its filter fits.
struct level_depths {
    float nearest, own, farthest;
    float least; // width of any kernel
};

level_depths depths_of_level(receiver r, float side, float least, int level) {
    level_depths d;
    d.nearest = level + 1 < level_count ? depth_of_width(r, side, filter_widths[level + 1], least) : -3e38;
    d.own = level + 1 < level_count ? depth_of_width(r, side, filter_widths[level], least) : -3e38;
    d.farthest = level > 0 ? depth_of_width(r, side, filter_widths[level - 1], least) : 3e38;
    if (level == 0)
        d.own = 3e38;
    d.least = least;
    return d;
}

// As coordinates of the map's texels, whose centres are whole numbers.
vec2 texel_center(ivec4 level, ivec2 texel) {
    return (vec2(texel) - (level.w < 0 ? -0.5 : float(level.w))) * exp2(float(level.z)) - 0.5;
}

// Height of a texel's centre over the receiver's plane at a depth.
float height_above(receiver r, vec2 texel, float depth) {
    float height = dot(r.slope, texel) + r.level;
    return (is_perspective() ? height * depth : height + r.normal.z * depth) - r.plane;
}

// Width of what a texel of a level was merged from, in texels of the map.
float merged_width(ivec4 level) {
    return exp2(float(level.z)) * (level.w < 0 ? 1.0 : 2.0 * float(level.w + 1));
}

// Opacity of the part of a texel that lies above the receiver's plane. A surface that covers only some of the texel is
// taken for the receiver's own body, below the plane, as far as it has room there.
OPACITY opacity_above(receiver r, float height, float depth, float width, OPACITY opacity) {
    float reach = 0.5 * width * (abs(r.slope.x) + abs(r.slope.y)) * (is_perspective() ? depth : 1.0);
    float above = clamp(0.5 + 0.5 * height / max(reach, 1e-20), 0.5, 1.0);
    return max(opacity - (1.0 - above), OPACITY(0.0)) / above;
}

// Adds the fragments of one texel: nearer to the light than the level's own depth to `lower`, since there this level is
// the lower of two, farther to `upper`. overlap: of both, the product.
void look_up(receiver r, int level, ivec2 texel, level_depths d, float side, float weight, inout share lower,
             inout share upper, inout OPACITY overlap) {
    ivec4 l = levels[level];
    if (any(lessThan(texel, ivec2(0))) || any(greaterThanEqual(texel, ivec2(l.y))))
        return;
    uint head = 2u * uint(l.x + (r.layer * l.y + texel.y) * l.y + texel.x);
    uint i = heads[head], last = i + heads[head + 1u];
    vec2 center = texel_center(l, texel);
    float width = merged_width(l);
    share near = nothing(), far = nothing();
    for (; i < last; i++) {
        float depth = fragment_depth(i);
        if (depth >= d.farthest || depth >= r.limit)
            break;
        float height = height_above(r, center, depth);
        if (depth < d.nearest || height <= 0.0)
            continue;
        OPACITY opacity = level > 0 ? opacity_above(r, height, depth, width, fragment_opacity(i)) : fragment_opacity(i);
        bool is_lower = depth < d.own || level == 0;
        float kernel = log2(max(side * kernel_scale(r, depth), max(d.least, 1e-20)));
        int low = is_lower ? level : level - 1;
        float from = log2(filter_widths[low]), to = log2(filter_widths[min(low + 1, level_count - 1)]);
        float t = to > from ? clamp((kernel - from) / (to - from), 0.0, 1.0) : 0.0;
        if (is_lower)
            accumulate(near, opacity, t, 1.0 - t);
        else
            accumulate(far, opacity, t, t);
    }
    lower.opacity += weight * near.opacity;
    lower.weight += weight * near.weight;
    upper.opacity += weight * far.opacity;
    upper.weight += weight * far.weight;
    overlap += weight * near.opacity * far.opacity;
}

// The four texels around a place on the map.
void look_up_bilinear(receiver r, vec2 center, int level, level_depths d, float side, out share lower,
                      out share upper, out OPACITY overlap) {
    ivec4 l = levels[level];
    vec2 corner = center * exp2(-float(l.z)) + (l.w < 0 ? -0.5 : float(l.w));
    vec2 f = fract(corner);
    ivec2 texel = ivec2(floor(corner));
    vec4 w = vec4((1.0 - f.x) * (1.0 - f.y), f.x * (1.0 - f.y), (1.0 - f.x) * f.y, f.x * f.y);
    // The emitter that is seen lies above the receiver's plane, so texels below it tell nothing.
    vec4 above;
    for (int i = 0; i < 4; i++) {
        vec2 center = texel_center(l, texel + ivec2(i & 1, i >> 1));
        above[i] = d.own > r.position.z || height_above(r, center, d.own) > 0.0 ? w[i] : 0.0;
    }
    float sum = above.x + above.y + above.z + above.w;
    w = sum > 0.0 ? above / sum : w;
    lower = upper = nothing();
    overlap = OPACITY(0.0);
    for (int i = 0; i < 4; i++)
        look_up(r, level, texel + ivec2(i & 1, i >> 1), d, side, w[i], lower, upper, overlap);
}

// The first level whose filter is as wide as the widest kernel of any caster around; -1: nothing shadows the receiver.
int last_level(receiver r, float side, float least) {
    float scale = max(kernel_scale(r, nearest_depth(r)), 0.0);
    vec2 extent;
    vec2 depths;
    for (int i = 0; i < 2; i++) {
        // Filters reach farther than the kernel they stand for: three texels of a level for two.
        extent = 1.75 * kernel_extent(r, scale) + 2.0;
        depths = depth_range(r, extent);
        scale = clamp(kernel_scale(r, min(depths.x, r.position.z)), 0.0, scale);
    }
    if (classify(r, extent, depths) == 1.0)
        return -1;
    int level = 0;
    while (level + 1 < level_count && filter_widths[level] < max(side * scale, least))
        level++;
    return level;
}

// Adds what the next two levels hide, `own`, to the sum; what the two before them hid is `before`. Of a surface that
// passes from these to those the level they share has some texels in each: they lie side by side, not one behind the
// other. meeting: share of what would be one behind the other by chance that is so in that level.
OPACITY add_nearer(OPACITY sum, OPACITY own, OPACITY meeting, inout OPACITY before) {
    if (ACCUMULATION != MULTIPLY)
        return accumulate(sum, own);
    OPACITY passing = 1.0 - own * (1.0 - meeting * before) / max(1.0 - before, OPACITY(1e-6));
    before = own;
    return 1.0 - (1.0 - sum) * clamp(passing, OPACITY(0.0), OPACITY(1.0));
}

// What hides a part of the emitter. aside: where the centre of its kernel lies, in widths of the kernel.
OPACITY hidden(receiver r, vec2 aside, float side, float least, int last) {
    float facing = abs(is_perspective() ? dot(r.normal, normalize(r.position)) : r.normal.z);
    float texel = r.texel_size * (is_perspective() ? r.position.z : 1.0) * sqrt(max(1.0 - facing * facing, 0.0));
    float plane = r.plane;
    OPACITY opacity = OPACITY(0.0), before = OPACITY(0.0), meeting = OPACITY(1.0);
    share lower = nothing();
    for (int level = 0; level <= last; level++) {
        // The surfaces of a texel may lie anywhere in its filter, not at its centre, where they are tested.
        r.plane = plane + (level > 0 ? 0.05 * filter_widths[level] * texel : 0.0);
        // The first level serves kernels from nothing to its filter's width.
        vec2 center = r.center + (level > 0 ? 1.0 : 0.5) * filter_widths[level] * aside;
        share here, upper;
        OPACITY overlap;
        look_up_bilinear(r, center, level, depths_of_level(r, side, least, level), side, here, upper, overlap);
        if (level > 0)
            opacity = add_nearer(opacity, blend(lower, upper), meeting, before);
        meeting = min(overlap / max(here.opacity * upper.opacity, OPACITY(1e-6)), OPACITY(1.0));
        lower = here;
    }
    return add_nearer(opacity, blend(lower, nothing()), meeting, before);
}

// The filters of one level differ from the emitter in shape and forget which of the casters they blur overlap. So the
// emitter is cut into equal parts, about as long as they are wide, for which narrower filters do.
vec3 technique_visibility(receiver r) {
    seen_emitter seen = emitter_seen(r);
    float narrower = inversesqrt(float(parts.x * parts.y));
    float side = kernel_side(r) * sqrt(seen.scale.x * seen.scale.y) * narrower;
    float least = least_width(r) * narrower;
    int last = last_level(r, side, least);
    OPACITY opacity = OPACITY(0.0);
    vec2 extent = (ELLIPSE == 1 ? 0.886 : 1.0) * seen.scale; // half sides of the square with its area
    for (int i = 0; i < parts.x * parts.y; i++) {
        vec2 part = vec2(float(i % parts.x), float(i / parts.x));
        vec2 center = seen.center + extent * ((2.0 * part + 1.0) / vec2(parts) - 1.0);
        opacity += hidden(r, r.kernel * center / side, side, least, last);
    }
    opacity /= float(parts.x * parts.y);
    return vec3(clamp(seen.share * (1.0 - opacity), 0.0, 1.0)); // rounding
}
