// SPDX-License-Identifier: GPL-3.0-or-later
// Hierarchical shadow map (Guennebaud, Barthe, Paulin 2006): what a whole rectangle of the map can do to a receiver.

// The first level whose texels are as wide as a rectangle of this size: then it touches two at most on each axis.
int depth_range_level(vec2 side) {
    return clamp(int(ceil(log2(max(max(side.x, side.y), 2.0)))), 1, textureQueryLevels(min_max));
}

// Low and high corner, inside the map, of what depth_range really looks at.
vec4 depth_range_cover(receiver r, vec2 extent) {
    vec2 last = vec2(r.map_size) - 1.0;
    vec2 low = clamp(r.center - extent, vec2(0.0), last), high = clamp(r.center + extent, vec2(0.0), last);
    int level = depth_range_level(2.0 * extent);
    return vec4((ivec4(low, high) >> level) + ivec4(0, 0, 1, 1)) * float(1 << level);
}

// Least and greatest light-space depth of the texels in the rectangle center +- (extent + spread); 1e30 off the map.
vec2 depth_range(receiver r, vec2 extent) {
    vec2 size = vec2(r.map_size);
    extent += r.spread;
    vec2 low = r.center - extent, high = r.center + extent;
    bool inside = all(greaterThanEqual(low, vec2(0.0))) && all(lessThan(high, size));
    vec2 side = high - low;
    low = clamp(low, vec2(0.0), size - 1.0);
    high = clamp(high, vec2(0.0), size - 1.0);
    int level = depth_range_level(side);
    ivec2 a = ivec2(low) >> level, b = ivec2(high) >> level;
    vec2 t0 = texelFetch(min_max, ivec3(a, r.layer), level - 1).rg;
    vec2 t1 = texelFetch(min_max, ivec3(b.x, a.y, r.layer), level - 1).rg;
    vec2 t2 = texelFetch(min_max, ivec3(a.x, b.y, r.layer), level - 1).rg;
    vec2 t3 = texelFetch(min_max, ivec3(b, r.layer), level - 1).rg;
    float least = min(min(t0.r, t1.r), min(t2.r, t3.r)), greatest = max(max(t0.g, t1.g), max(t2.g, t3.g));
    return vec2(r.near_depth + r.depth_span * least, inside ? r.near_depth + r.depth_span * greatest : 1e30);
}

// Light-space depth of the nearest texel of the whole map.
float nearest_depth(receiver r) {
    int level = textureQueryLevels(min_max) - 1;
    return r.near_depth + r.depth_span * texelFetch(min_max, ivec3(0, 0, r.layer), level).r;
}

// Scale of a blocker search: the kernel of the nearest blocker there can be. Each step looks up the nearest depth in
// the last rectangle, which can only shrink it (Guennebaud et al. 2006, section 4.2), and never loses a blocker.
// `depths`: range of depths in the last rectangle looked up, which holds the final one.
float search_scale(receiver r, int steps, out vec2 depths) {
    float scale = max(kernel_scale(r, nearest_depth(r)), 0.0);
    depths = depth_range(r, kernel_extent(r, scale) + 1.0);
    for (int i = 0; i < steps; i++) {
        scale = clamp(kernel_scale(r, min(depths.x, r.position.z)), 0.0, scale);
        if (i + 1 < steps)
            depths = depth_range(r, kernel_extent(r, scale) + 1.0);
    }
    return scale;
}

// Least and greatest height (is_blocker) of the texels in the rectangle center +- extent at the depths given.
vec2 height_range(receiver r, vec2 extent, vec2 depths) {
    float spread = dot(abs(r.slope), extent);
    float middle = dot(r.slope, r.center - 0.5) + r.level;
    vec2 height = vec2(middle - spread, middle + spread);
    if (!is_perspective())
        return height + (r.normal.z < 0.0 ? r.normal.z * depths.yx : r.normal.z * depths);
    return vec2(height.x * (height.x < 0.0 ? depths.y : depths.x), height.y * (height.y < 0.0 ? depths.x : depths.y));
}

// 1: no texel in the rectangle center +- extent can block the receiver. 0: every texel does. 0.5: undecided.
// depths: depth_range of that rectangle, or of a larger one.
float classify(receiver r, vec2 extent, vec2 depths) {
    // A texel is tested at its centre, up to half of one outside the rectangle.
    if (depths.x >= r.limit || height_range(r, extent + 1.0, vec2(depths.x, r.limit)).y <= r.plane)
        return 1.0;
    if (depths.y < r.limit && height_range(r, extent + 1.0, depths).x > r.plane)
        return 0.0;
    return 0.5;
}
