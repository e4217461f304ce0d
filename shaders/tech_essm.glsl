// SPDX-License-Identifier: GPL-3.0-or-later
// Exponential soft shadow mapping (Shen, Feng, Yang 2013): PCSS whose averages over rectangles come from summed-area
// tables. Depths t as in common_exponential.glsl; map coordinates in texels of the shadow map.
//
// ROBUST differs from the paper where that cannot work. The paper's tables hold e^(c t) over the whole depth range in
// 20 bits, which is 0 for everything nearer than about 0.83: lit surfaces turn black. Here every tile refers to a plane
// of its own, the one most of it lies in. A receiver in that plane is resolved however steep the plane is; where a
// receiver lies elsewhere, its part of the kernel is split and then sampled. Besides, ROBUST tests against the
// receiver's tangent plane, and reads wide kernels from tables of a coarser level, so that no kernel touches more than
// 2 x 2 tiles.
#include "common_footprint.glsl"
#include "common_min_max.glsl"
#include "common_summed_area.glsl"
#include "essm_basis.glsl"

uniform usampler2DArray prefiltered_0; // tables of esm
uniform usampler2DArray prefiltered_1; // tables of esm-z and z
uniform int p_subdivision, p_search_reduction, p_bits, p_min_max;
uniform float p_epsilon, p_slab_height;
const int ROBUST = 0, RECTANGLE = 0; // values of MODE and KERNEL, which are defines
// Rounding of tables and planes must not darken what is lit.
const float SLACK = 0.02;

// ---- Exponents ----

float exponent_scale, exponent_offset; // c t of a light-space depth is depth * scale + offset

void exponent_create(receiver r) {
    exponential_create(r.layer);
    float start = exponential_start;
    exponent_scale = p_c / ((1.0 - start) * r.depth_span);
    exponent_offset = -exponent_scale * (r.near_depth + start * r.depth_span);
}

float exponent(float depth) {
    return depth * exponent_scale + exponent_offset;
}

// ROBUST: whether every part of the kernel must be sampled, because the nearest caster may be so close before the
// receiver that the exponential has not fallen to 5 %, or because the surface is turned away from the light's middle.
bool must_sample(receiver r, float nearest) {
    float facing = is_perspective() ? -dot(r.normal, r.position) : -r.normal.z;
    return MODE == ROBUST && (exponent_scale * (r.limit - nearest) < 3.0 || facing <= 0.0);
}

// Light-space depths of the receiver's tangent plane at four map coordinates. Without bias: a mean over a plane is no
// less than its value in the middle, and bias alone would make the exponential exceed 1.
vec4 tangent_depths(receiver r, vec4 x, vec4 y) {
    vec4 height = r.slope.x * (x - 0.5) + r.slope.y * (y - 0.5) + r.level;
    float level = dot(r.normal, r.position);
    return is_perspective() ? level / min(height, vec4(-1e-6)) : (level - height) / min(r.normal.z, -1e-6);
}

// The same of a tile's plane, at offsets from the tile's centre.
vec4 plane_depths(receiver r, vec4 plane, vec4 x, vec4 y) {
    vec4 value = plane.x + plane.y * x + plane.z * y;
    if (is_perspective())
        value = 1.0 / max(value, vec4(1e-6)) - near_ratio[r.layer >> 2][r.layer & 3];
    return r.near_depth + r.depth_span * value;
}

float least_of(vec4 v) {
    return min(min(v.x, v.y), min(v.z, v.w));
}

float greatest_of(vec4 v) {
    return max(max(v.x, v.y), max(v.z, v.w));
}

// ---- Means over rectangles ----

struct rectangle {
    vec2 low, high;
};

struct basis_mean {
    float visibility;   // of e^(c (t - d)): beyond 1 where the rectangle reaches behind d
    float t_visibility; // of t e^(c (t - d))
    float t;
    bool failed;        // the tables cannot tell
};

// ROBUST: e^(c (p - d)) in the middle of a rectangle (texels of the map), for a tile's plane p and the receiver's d.
// failed: the planes are too far apart for what the tile's values resolve. `behind`: nothing in the tile can block.
float plane_factor(receiver r, int level, ivec2 tile_index, vec2 low, vec2 high, out bool behind, inout bool failed) {
    vec4 plane = texelFetch(tile_planes, ivec3(tile_index, r.layer), level);
    vec2 center = (vec2(tile_index) + 0.5) * float(1 << (tile_log + level));
    vec4 x = vec4(low.x, high.x, low.x, high.x), y = vec4(low.y, low.y, high.y, high.y);
    vec4 tangent = tangent_depths(r, x, y);
    vec4 apart = plane_depths(r, plane, x - center.x, y - center.y) - tangent;
    vec4 distance = exponent_scale * apart + p_c * abs(plane.w);
    float least = least_of(distance), greatest = greatest_of(distance);
    int top = min(tile_log + level, textureQueryLevels(min_max)) - 1;
    float nearest = texelFetch(min_max, ivec3(tile_index, r.layer), top).r;
    behind = r.near_depth + r.depth_span * nearest > greatest_of(tangent);
    // A receiver behind everything in the tile sees none of it, however far apart the planes; unless there are texels
    // with nothing in them, whose value is 1 for all.
    float lowest = plane.w < 0.0 ? -0.5 : -2.0 * p_c;
    failed = failed || (!behind && (greatest - least > 1.5 || greatest > 9.0 || least < lowest));
    return exp(clamp(0.5 * (least + greatest) + SLACK, -80.0, 80.0));
}

// Adds one tile's part of a rectangle, both in texels of the level.
void add_tile(receiver r, int level, ivec2 tile_index, vec2 low, vec2 high, bool blockers, inout basis_mean sum) {
    float unit = 1.0 / float((1 << p_bits) - 1), texel = float(1 << level);
    ivec2 corner = tile_index << tile_log, origin = table_origin(level, textureSize(prefiltered_0, 0).x);
    float area = (high.x - low.x) * (high.y - low.y), factor = exp(p_c - exponent(r.limit));
    vec3 esm = vec3(0.0);
    if (blockers) { // to whole texels, as the paper allows for the search
        ivec2 first = ivec2(low), last = max(ivec2(ceil(high)), first + 1);
        vec2 share = vec2(1.0 / float((last.x - first.x) * (last.y - first.y)));
        esm.x = float(table_sum_whole(prefiltered_0, r.layer, origin, corner, first, last).x) * share.x;
        esm.yz = vec2(table_sum_whole(prefiltered_1, r.layer, origin, corner, first, last)) * share;
        esm *= unit * area;
    } else
        esm.x = unit * table_sum(prefiltered_0, r.layer, origin, corner, 1 << tile_log, low, high, false);
    bool behind = false;
    if (MODE == ROBUST)
        factor = plane_factor(r, level, tile_index, low * texel, high * texel, behind, sum.failed);
    else // undoes the paper's normalisation
        esm.x += exp(-p_c) * (area - esm.x);
    float t = area * exponent(r.limit) / p_c;
    sum.visibility += behind ? area : factor * esm.x;
    sum.t_visibility += behind ? t : factor * esm.y;
    sum.t += behind ? t : esm.z;
}

// Level whose tables hold a kernel in 2 x 2 tiles at most. AS_PUBLISHED has one level.
int level_of(vec2 size) {
    float tiles = max(size.x, size.y) / float(1 << tile_log);
    return MODE == ROBUST ? clamp(int(ceil(log2(max(tiles, 1e-6)))), 0, textureQueryLevels(tile_planes) - 1) : 0;
}

// Nothing blocks outside the map: it counts as if it were as far as the receiver.
basis_mean mean_over(receiver r, int level, rectangle rect, bool blockers) {
    float texel = 1.0 / float(1 << level), side = float(1 << tile_log);
    vec2 low = clamp(rect.low, vec2(0.0), vec2(r.map_size)) * texel;
    vec2 high = clamp(rect.high, vec2(0.0), vec2(r.map_size)) * texel;
    basis_mean sum = basis_mean(0.0, 0.0, 0.0, false);
    vec2 size = (rect.high - rect.low) * texel, inside = max(high - low, vec2(0.0));
    float area = size.x * size.y;
    ivec2 first = ivec2(low) >> tile_log, last = ivec2(ceil(high) - 1.0) >> tile_log, tile_index = first;
    last.y = inside.x * inside.y > 0.0 ? last.y : -1;
    while (tile_index.y <= last.y) { // one loop, not two nested: its body is executed at least once
        vec2 corner = side * vec2(tile_index);
        add_tile(r, level, tile_index, max(low, corner), min(high, corner + side), blockers, sum);
        tile_index = tile_index.x < last.x ? tile_index + ivec2(1, 0) : ivec2(first.x, tile_index.y + 1);
    }
    float outside = area - inside.x * inside.y, d = exponent(r.limit) / p_c;
    sum.visibility = (sum.visibility + outside) / area;
    sum.t_visibility = (sum.t_visibility + outside * d) / area;
    sum.t = (sum.t + outside * d) / area;
    sum.failed = sum.failed || sum.visibility > 1.0 + p_epsilon;
    return sum;
}

// ---- One kernel and its parts ----

// Section 5.2: a kernel that cannot be trusted as a whole is split into n x n parts, and of those the ones that cannot
// be trusted are sampled. AS_PUBLISHED always splits. Parts are numbered row by row; -1 is the whole.
rectangle part(rectangle whole, int index) {
    vec2 size = (whole.high - whole.low) / float(p_subdivision);
    float row = floor((float(index) + 0.5) / float(p_subdivision)); // a division of integers is slow in software
    vec2 low = whole.low + size * vec2(float(index) - row * float(p_subdivision), row);
    if (index < 0)
        return whole;
    return rectangle(low, low + size);
}

// 2 x 2 PCF: four samples, one in each quarter and no two in a line, so that edges along the axes get four steps. For
// the mean depth that is enough. In parts of a kernel the filter takes two in each quarter.
const vec2 sample_points[4] = vec2[4](vec2(0.375, 0.125), vec2(0.875, 0.375), vec2(0.625, 0.875), vec2(0.125, 0.625));
const vec2 part_points[8] =
    vec2[8](vec2(0.0625, 0.0625), vec2(0.1875, 0.5625), vec2(0.3125, 0.3125), vec2(0.4375, 0.8125),
            vec2(0.5625, 0.1875), vec2(0.6875, 0.6875), vec2(0.8125, 0.4375), vec2(0.9375, 0.9375));

// Blocked share, and the blockers' mean light-space depth.
vec2 sampled(receiver r, rectangle rect) {
    vec2 sum = vec2(0.0);
    for (int i = 0; i < 4; i++) {
        float depth;
        if (blocker_at(r, mix(rect.low, rect.high, sample_points[i]), depth))
            sum += vec2(1.0, depth);
    }
    return vec2(0.25 * sum.x, sum.y / max(sum.x, 1.0));
}

// Blocked share and the blockers' mean light-space depth, by ESM-Z. Where little is blocked that is the quotient of
// small differences; `nearest` is the light-space depth it cannot be before.
vec2 esm_blockers(receiver r, basis_mean mean, float nearest) {
    float blocked = 1.0 - mean.visibility;
    float exponents = clamp(p_c * (mean.t - mean.t_visibility) / max(blocked, 1e-3), 0.0, exponent(r.limit));
    float depth = max((exponents - exponent_offset) / exponent_scale, nearest);
    return blocked < 1e-3 ? vec2(0.0) : vec2(blocked, depth);
}

// Weight of a part in the search: as the taps of PCSS (tech_pcss.glsl) it counts only as far as rays to the light pass,
// and by the share of the light it hides.
float search_weight(receiver r, rectangle rect, float depth) {
    if (MODE != ROBUST)
        return 1.0;
    vec2 extent = max(kernel_extent(r, kernel_scale(r, depth)), 0.0) + 1.0;
    vec2 overlap = min(rect.high, r.center + extent) - max(rect.low, r.center - extent);
    return max(overlap.x, 0.0) * max(overlap.y, 0.0) / (extent.x * extent.y);
}

// Whether there are blockers, and their mean light-space depth. The kernel is always split, so that the weights
// of its parts keep far texels apart from near ones.
bool find_blockers(receiver r, rectangle kernel, float nearest, out float depth) {
    const int count = p_subdivision * p_subdivision;
    int level = level_of(kernel.high - kernel.low);
    int failed = must_sample(r, nearest) ? (1 << count) - 1 : 0; // a bit for each part
    vec2 sum = vec2(0.0);
    for (int i = failed == 0 ? 0 : count; i < count; i++) {
        rectangle rect = part(kernel, i);
        basis_mean mean = mean_over(r, level, rect, true);
        vec2 blockers = esm_blockers(r, mean, nearest);
        if (mean.failed)
            failed |= 1 << i;
        else if (blockers.x > 0.0)
            sum += search_weight(r, rect, blockers.y) * blockers.x * vec2(blockers.y, 1.0);
    }
    for (; failed != 0; failed &= failed - 1) {
        rectangle rect = part(kernel, findLSB(failed));
        vec2 blockers = sampled(r, rect);
        if (blockers.x > 0.0)
            sum += search_weight(r, rect, blockers.y) * blockers.x * vec2(blockers.y, 1.0);
    }
    depth = sum.x / max(sum.y, 1e-30);
    return sum.y > 0.0;
}

// The rectangle of an elliptic emitter's kernel has the same variance as the ellipse.
const float BOX_SIDE = ELLIPSE == 1 && KERNEL == RECTANGLE ? 0.8660254 : 1.0;
vec2 filter_half_size;         // half sides of the whole kernel, of which slabs are parts
vec2 filter_pixel = vec2(0.0); // of the pixel's footprint in it

// ROBUST: half sides of the kernel of what blocks at a depth. A kernel that must be split holds surfaces far apart, of
// which one at its mean depth is a poor account: a step beside the receiver hides nothing beyond its own kernel, and
// more of the light inside it than the mean kernel says.
vec2 own_kernel(receiver r, float depth) {
    vec2 soft = kernel_extent(r, kernel_scale(r, depth)) * BOX_SIDE;
    return sqrt(soft * soft + filter_pixel * filter_pixel) + 1.0;
}

// Not for kernels as wide as an eighth of the map: of those few samples and the mean depths of parts say too little.
bool counts_own_kernels(receiver r) {
    return MODE == ROBUST && 16.0 * max(filter_half_size.x, filter_half_size.y) < float(r.map_size.x);
}

// Share of the light that a part of a kernel hides by samples, over that of one it fills.
float hidden_by_samples(receiver r, rectangle rect) {
    bool by_own = counts_own_kernels(r);
    int count = p_subdivision > 1 ? 8 : 4;
    float sum = 0.0;
    for (int i = 0; i < count; i++) {
        vec2 at = mix(rect.low, rect.high, count > 4 ? part_points[i] : sample_points[i]);
        float depth;
        bool blocked = blocker_at(r, at, depth);
        vec2 own = own_kernel(r, depth), weight = max(filter_half_size / own, 1.0);
        bool reaches = all(lessThanEqual(abs(at - r.center), own));
        if (blocked && (reaches || !by_own))
            sum += by_own ? weight.x * weight.y : 1.0;
    }
    return sum / float(count);
}

// The same where the part is as visible as the tables say, by the mean depth they hold.
float hidden_by_tables(receiver r, int level, rectangle rect, float visibility, float nearest) {
    vec2 blockers = counts_own_kernels(r) ? esm_blockers(r, mean_over(r, level, rect, true), nearest) : vec2(0.0);
    if (blockers.x <= 0.0)
        return 1.0 - visibility;
    vec2 own = own_kernel(r, blockers.y), size = rect.high - rect.low;
    vec2 overlap = max(min(rect.high, r.center + own) - max(rect.low, r.center - own), 0.0);
    overlap *= max(filter_half_size / own, 1.0);
    return (1.0 - visibility) * overlap.x * overlap.y / (size.x * size.y);
}

// Visibility in a rectangle.
float filter_rectangle(receiver r, rectangle rect, float nearest) {
    const int count = p_subdivision * p_subdivision, first = MODE == ROBUST ? -1 : 0;
    bool sample_all = must_sample(r, nearest);
    int level = level_of(rect.high - rect.low);
    int failed = 0, last = first < 0 ? -1 : count - 1; // a bit for each part
    float sum = 0.0;
    for (int i = first; i <= last; i++) {
        basis_mean mean = mean_over(r, level, part(rect, i), false);
        float visibility = min(mean.visibility, 1.0);
        if (sample_all)
            failed = (1 << count) - 1;
        else if (i < 0 && mean.failed)
            last = count - 1;
        else if (mean.failed)
            failed |= 1 << i;
        else
            sum += i < 0 ? visibility * float(count)
                         : 1.0 - hidden_by_tables(r, level, part(rect, i), visibility, nearest);
    }
    for (; failed != 0; failed &= failed - 1)
        sum += 1.0 - hidden_by_samples(r, part(rect, findLSB(failed)));
    return max(sum / float(count), 0.0);
}

// Visibility over the rectangle of the kernel.
float filter_box(receiver r, float scale) {
    filter_half_size = max(kernel_extent(r, scale) * BOX_SIDE, vec2(0.5));
    rectangle rect = rectangle(r.center - filter_half_size, r.center + filter_half_size);
    return filter_rectangle(r, rect, depth_range(r, filter_half_size).x);
}

// ---- Elliptic kernels ----

// An ellipse around the receiver, by its covariance: where rows of the map cross it.
struct ellipse {
    float half_height, shear, half_width;
};

// The kernel of the emitter convolved with the pixel's footprint, both as Gaussians whose 2 sigma outlines are theirs.
ellipse filter_ellipse(receiver r, float scale) {
    mat2 soft = r.kernel * (0.5 * scale), pixel = receiver_footprint(r) * 0.25;
    mat2 covariance = soft * transpose(soft) + pixel * transpose(pixel);
    float xx = max(covariance[0].x, 0.0625), yy = max(covariance[1].y, 0.0625), xy = covariance[0].y;
    return ellipse(2.0 * sqrt(yy), xy / yy, 2.0 * sqrt(max(xx - xy * xy / yy, 0.0625)));
}

// Left and right end of the ellipse at height y over its centre.
vec2 ellipse_span(ellipse e, float y) {
    float ratio = y / e.half_height;
    float half_width = e.half_width * sqrt(max(1.0 - ratio * ratio, 0.0));
    return e.shear * y + vec2(-half_width, half_width);
}

bool is_inside(ellipse e, vec2 point) {
    vec2 span = ellipse_span(e, point.y);
    return abs(point.y) < e.half_height && point.x > span.x && point.x < span.y;
}

void add_rectangle(receiver r, float nearest, vec2 low, vec2 high, float weight, inout vec2 sum) {
    vec2 size = high - low;
    if (weight <= 0.0 || min(size.x, size.y) < 1e-3)
        return;
    weight *= size.x * size.y;
    sum += weight * vec2(filter_rectangle(r, rectangle(r.center + low, r.center + high), nearest), 1.0);
}

// 1, 0.5 or 0: whether a rectangle lies inside the ellipse, across it or outside.
float coverage(ellipse e, vec2 low, vec2 high) {
    int corners = int(is_inside(e, low)) + int(is_inside(e, high)) + int(is_inside(e, vec2(low.x, high.y))) +
                  int(is_inside(e, vec2(high.x, low.y)));
    return corners == 4 ? 1.0 : corners == 0 ? 0.0 : 0.5;
}

// The part of a slab beside its inner rectangle: LEVEL_1 takes half of it, LEVEL_2 looks at its quarters.
void add_side(receiver r, float nearest, ellipse e, vec2 low, vec2 high, inout vec2 sum) {
    int count = KERNEL == 2 ? 1 : 2;
    vec2 size = (high - low) / float(count);
    for (int i = 0; i < count * count; i++) {
        vec2 corner = low + size * vec2(i % count, i / count);
        add_rectangle(r, nearest, corner, corner + size, count == 1 ? 0.5 : coverage(e, corner, corner + size), sum);
    }
}

float filter_slabs(receiver r, float scale) {
    ellipse e = filter_ellipse(r, scale);
    float width = sqrt(e.half_width * e.half_width + e.shear * e.shear * e.half_height * e.half_height);
    int level = level_of(2.0 * vec2(width, e.half_height));
    mat2 pixel = receiver_footprint(r) * 0.5;
    filter_pixel = sqrt(pixel[0] * pixel[0] + pixel[1] * pixel[1]);
    filter_half_size = vec2(width, e.half_height);
    float nearest = depth_range(r, filter_half_size).x;
    int count = max(int(ceil(2.0 * e.half_height / (p_slab_height * float(1 << level)))), 1);
    float height = 2.0 * e.half_height / float(count);
    vec2 sum = vec2(0.0);
    for (int i = 0; i < count; i++) {
        float y = -e.half_height + height * float(i);
        vec2 span = ellipse_span(e, y + 0.5 * height), below = ellipse_span(e, y), above = ellipse_span(e, y + height);
        vec2 inner = vec2(max(below.x, above.x), min(below.y, above.y));
        vec2 outer = vec2(min(below.x, above.x), max(below.y, above.y));
        if (KERNEL == 1 || i == 0 || i == count - 1 || inner.x >= inner.y) {
            add_rectangle(r, nearest, vec2(span.x, y), vec2(span.y, y + height), 1.0, sum);
            continue;
        }
        add_rectangle(r, nearest, vec2(inner.x, y), vec2(inner.y, y + height), 1.0, sum);
        add_side(r, nearest, e, vec2(outer.x, y), vec2(inner.x, y + height), sum);
        add_side(r, nearest, e, vec2(inner.y, y), vec2(outer.y, y + height), sum);
    }
    return sum.y > 0.0 ? sum.x / sum.y : 1.0;
}

// Half sides of the rectangle that holds the kernels. AS_PUBLISHED decides nothing beforehand.
vec2 technique_extent(receiver r) {
    vec2 depths;
    return MODE == ROBUST ? kernel_extent(r, search_scale(r, p_search_reduction, depths)) + 1.0 : vec2(-1.0);
}

vec3 technique_visibility(receiver r) {
    const bool robust = MODE == ROBUST;
    exponent_create(r);
    vec2 depths;
    float scale = search_scale(r, robust ? p_search_reduction : 0, depths);
    vec2 extent = kernel_extent(r, scale) + 1.0;
    receiver_set_bias(r, max(extent.x, extent.y));
    float known = robust && p_min_max == 1 ? classify(r, extent, depths) : 0.5;
    if (known != 0.5)
        return vec3(known);
    float depth;
    // Casters very near to the light make kernels larger than the map. Its parts must not all lie outside.
    rectangle search = rectangle(max(r.center - extent, 0.0), min(r.center + extent, vec2(r.map_size)));
    if (any(lessThanEqual(search.high, search.low)) || !find_blockers(r, search, depths.x, depth))
        return vec3(1.0);
    scale = max(kernel_scale(r, depth), 0.0);
    return vec3(KERNEL == RECTANGLE ? filter_box(r, scale) : filter_slabs(r, scale));
}
