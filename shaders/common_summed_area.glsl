// SPDX-License-Identifier: GPL-3.0-or-later
// Sums over rectangles of a summed-area table (pass_summed_area.comp), of any position and size in texels: a texel the
// rectangle cuts counts by the share inside it.

// Where a level of a table begins: beside each other above level 0, since gathering knows no levels.
ivec2 table_origin(int level, int side) {
    return level == 0 ? ivec2(0) : ivec2(side - (side >> (level - 1)), side);
}

// Sum over whole texels low .. high - 1 of one tile, of all channels of integers.
uvec2 table_sum_whole(usampler2DArray table, int layer, ivec2 origin, ivec2 tile_corner, ivec2 low, ivec2 high) {
    ivec2 before = origin + low - 1, last = origin + high - 1;
    tile_corner += origin;
    bvec2 inside = greaterThanEqual(before, tile_corner);
    uvec2 sum = texelFetch(table, ivec3(last, layer), 0).rg;
    sum -= inside.x ? texelFetch(table, ivec3(before.x, last.y, layer), 0).rg : uvec2(0u);
    sum -= inside.y ? texelFetch(table, ivec3(last.x, before.y, layer), 0).rg : uvec2(0u);
    sum += all(inside) ? texelFetch(table, ivec3(before, layer), 0).rg : uvec2(0u);
    return sum;
}

// Channel that table_sum sums.
#ifndef TABLE_CHANNEL
#define TABLE_CHANNEL 0
#endif

// Sums of three strips of one row, from what the table holds above and below it.
vec3 strip_sums(uvec4 above, uvec4 below, bool floats) {
    if (floats) {
        vec4 a = uintBitsToFloat(above), b = uintBitsToFloat(below);
        return (a.yzw - a.xyz) - (b.yzw - b.xyz);
    }
    return vec3((above.yzw - above.xyz) - (below.yzw - below.xyz));
}

// Sum over low .. high, which must lie in one tile. On each axis the texels it touches are three strips: the first
// texel, those between, and the last. Integers are subtracted before anything is weighted, so that sums may have
// wrapped around.
float table_sum(usampler2DArray table, int layer, ivec2 origin, ivec2 tile_corner, int side, vec2 low, vec2 high,
                bool floats) {
    ivec2 first = ivec2(low), last = min(ivec2(high), tile_corner + side - 1);
    // Each corner's four entries: before and at the first texel, before and at the last.
    vec2 unit = 1.0 / vec2(textureSize(table, 0).xy);
    vec2 a = vec2(origin + first) * unit, b = vec2(origin + last) * unit;
    uvec4 low_low = textureGather(table, vec3(a, layer), TABLE_CHANNEL);
    uvec4 high_low = textureGather(table, vec3(b.x, a.y, layer), TABLE_CHANNEL);
    uvec4 low_high = textureGather(table, vec3(a.x, b.y, layer), TABLE_CHANNEL);
    uvec4 high_high = textureGather(table, vec3(b, layer), TABLE_CHANNEL);
    uvec4 rows[4] = uvec4[4](uvec4(low_low.wz, high_low.wz), uvec4(low_low.xy, high_low.xy),
                             uvec4(low_high.wz, high_high.wz), uvec4(low_high.xy, high_high.xy));
    rows[0] = first.y == tile_corner.y ? uvec4(0u) : rows[0];
    rows[2] = first.y == last.y ? rows[1] : rows[2];
    for (int i = 0; i < 4; i++) {
        rows[i].x = first.x == tile_corner.x ? 0u : rows[i].x;
        rows[i].z = first.x == last.x ? rows[i].y : rows[i].z;
    }
    vec2 weight_first = min(vec2(first + 1), high) - low, weight_last = high - vec2(last);
    vec3 x = vec3(weight_first.x, 1.0, weight_last.x), y = vec3(weight_first.y, 1.0, weight_last.y);
    float sum = 0.0;
    for (int i = 0; i < 3; i++)
        sum += y[i] * dot(strip_sums(rows[i + 1], rows[i], floats), x);
    return sum;
}
