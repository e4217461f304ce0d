// SPDX-License-Identifier: GPL-3.0-or-later
// Bounding planes of the shadow map's texels. On a plane nearness(depth) is linear in the map coordinate, so that a
// block of texels of one surface lies between two parallel planes a rounding error apart, however steep it is; of
// minimum and maximum depth the same block fills a box, which every steep receiver would touch.

uniform sampler2DArray planes; // level 0: blocks of 4 x 4 texels; pass_planes.comp

// Greater is nearer. Perspective: 1 / depth; orthographic: -depth.
float nearness(float depth) {
    return is_perspective() ? 1.0 / depth : -depth;
}

const int PLANE_BLOCK = 4; // texels per side of a block of level 0
const float NO_BLOCKER = -1e30;

// A plane over texels t, given by their indices: value + dot(slope, t).
struct linear {
    vec2 slope;
    float value;
};

// Nearness of the points whose height (is_blocker) equals `height`: texels that are nearer are higher. Only for planes
// that face the light and do not hold it: faces_light.
linear plane_nearness(receiver r, float height) {
    if (is_perspective())
        return linear(r.slope / height, r.level / height);
    return linear(r.slope / r.normal.z, (r.level - height) / r.normal.z);
}

bool faces_light(receiver r, float height) {
    return is_perspective() ? height < 0.0 : r.normal.z < 0.0;
}

float linear_at(linear plane, vec2 texel) {
    return plane.value + dot(plane.slope, texel);
}

// What is asked of the texels in a rectangle of the map, corners low and high in indices of texels.
struct question {
    vec2 low, high;
    linear plane;
    float limit; // nearness
    vec2 reach;  // half sides of the kernel per unit of nearness before `limit`
};

// Whether no texel of a block within the rectangle can block: each is lower than the plane, or farther than the limit,
// or outside the kernel of its own depth, which nothing blocks from.
bool block_is_clear(receiver r, question ask, vec4 bounds, vec2 middle, vec2 half_side, vec2 at_middle) {
    float highest = at_middle.y - linear_at(ask.plane, middle) + dot(abs(bounds.xy - ask.plane.slope), half_side);
    float nearest = at_middle.y - ask.limit + dot(abs(bounds.xy), half_side);
    vec2 away = abs(middle - (r.center - 0.5)) - half_side - r.spread - 1.5;
    float rounding = 2e-6 * abs(ask.limit);
    return highest <= -rounding || nearest <= -rounding || any(greaterThan(away, ask.reach * nearest));
}

// Whether every texel of a block within the rectangle is higher than the plane and nearer than the limit.
bool block_is_solid(question ask, vec4 bounds, vec2 middle, vec2 half_side, vec2 at_middle) {
    float lowest = at_middle.x - linear_at(ask.plane, middle) - dot(abs(bounds.xy - ask.plane.slope), half_side);
    float farthest = at_middle.x - ask.limit - dot(abs(bounds.xy), half_side);
    return min(lowest, farthest) > 2e-6 * abs(ask.limit);
}

// Whether all blocks in the rectangle are clear, or solid. Walks down the pyramid where a block is neither.
bool all_blocks(receiver r, question ask, bool solid) {
    int top = textureQueryLevels(planes) - 1, level = top;
    ivec2 block = ivec2(0);
    while (level <= top) {
        float width = float(PLANE_BLOCK << level);
        vec2 corner = vec2(block) * width;
        // The part of the block within the rectangle.
        vec2 a = max(corner, ask.low), b = min(corner + width - 1.0, ask.high);
        if (all(lessThan(a, b + 1.0))) {
            vec4 bounds = texelFetch(planes, ivec3(block, r.layer), level);
            vec2 middle = 0.5 * (a + b), half_side = max(0.5 * (b - a), vec2(0.0));
            vec2 at_middle = bounds.zw + dot(bounds.xy, middle - (corner + 0.5 * (width - 1.0)));
            if (!(solid ? block_is_solid(ask, bounds, middle, half_side, at_middle)
                        : block_is_clear(r, ask, bounds, middle, half_side, at_middle))) {
                if (level == 0)
                    return false;
                level--;
                block *= 2;
                continue;
            }
        }
        // The next block of this level, or the one after its parent.
        while ((block.x & block.y & 1) == 1) {
            block /= 2;
            level++;
        }
        if (level >= top)
            return true;
        block += (block.x & 1) == 0 ? ivec2(1, 0) : ivec2(-1, 1);
    }
    return true;
}

// 1: no texel in the rectangle center +- (extent + spread) can block the receiver: each is lower than plane.x, farther
// than limit.x, or outside the kernel of its own depth. 0: every texel does: is higher than plane.y and nearer than
// limit.y. 0.5: undecided.
float classify_region(receiver r, vec2 extent, vec2 plane, vec2 limit) {
    if (!faces_light(r, plane.x) || !faces_light(r, plane.y))
        return 0.5;
    // A texel is tested at its centre, up to half of one outside the rectangle.
    vec2 reach = extent + r.spread + 1.0, last = vec2(r.map_size) - 1.0;
    vec2 low = r.center - 0.5 - reach, high = r.center - 0.5 + reach;
    bool inside = all(greaterThanEqual(low, vec2(0.0))) && all(lessThanEqual(high, last));
    question ask = question(clamp(low, vec2(0.0), last), clamp(high, vec2(0.0), last), plane_nearness(r, plane.x),
                            nearness(limit.x), kernel_extent(r, 1.0));
    if (all_blocks(r, ask, false))
        return 1.0;
    ask.plane = plane_nearness(r, plane.y);
    ask.limit = nearness(limit.y);
    return inside && all_blocks(r, ask, true) ? 0.0 : 0.5;
}
