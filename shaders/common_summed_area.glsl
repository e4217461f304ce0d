// SPDX-License-Identifier: GPL-3.0-or-later
// Sums over rectangles of a summed-area table (pass_summed_area.comp), of any position and size in texels: a texel the
// rectangle cuts counts by the share inside it.

// The texels a rectangle touches on one axis, as three strips: the first texel, those between, and the last.
struct strips {
    ivec4 edge;  // last texel before the first strip, and of each strip
    vec3 weight; // share of each strip inside
};

strips strips_create(float low, float high, int last) {
    int first = int(floor(low)), end = min(int(floor(high)), last);
    strips s;
    s.edge = ivec4(first - 1, first, max(end - 1, first), max(end, first));
    s.weight = vec3(min(float(first + 1), high) - low, 1.0, high - float(end));
    return s;
}

// Entries of a table's row at the edges; 0 before the tile's first texel.
uvec4 table_row(usampler2DArray table, ivec4 x, int y, int layer, int level, ivec2 tile_corner, int channel) {
    if (y < tile_corner.y)
        return uvec4(0u);
    return uvec4(x.x < tile_corner.x ? 0u : texelFetch(table, ivec3(x.x, y, layer), level)[channel],
                 texelFetch(table, ivec3(x.y, y, layer), level)[channel],
                 texelFetch(table, ivec3(x.z, y, layer), level)[channel],
                 texelFetch(table, ivec3(x.w, y, layer), level)[channel]);
}

// Sum over whole texels low .. high - 1 of one tile, of all channels of integers.
uvec2 table_sum_whole(usampler2DArray table, int layer, int level, ivec2 tile_corner, ivec2 low, ivec2 high) {
    ivec2 before = low - 1, last = high - 1;
    uvec2 sum = texelFetch(table, ivec3(last, layer), level).rg;
    if (before.x >= tile_corner.x)
        sum -= texelFetch(table, ivec3(before.x, last.y, layer), level).rg;
    if (before.y >= tile_corner.y)
        sum -= texelFetch(table, ivec3(last.x, before.y, layer), level).rg;
    if (all(greaterThanEqual(before, tile_corner)))
        sum += texelFetch(table, ivec3(before, layer), level).rg;
    return sum;
}

// Sum over low .. high, which must lie in one tile. Integers are subtracted before anything is weighted, so that sums
// may have wrapped around.
float table_sum(usampler2DArray table, int layer, int level, ivec2 tile_corner, int side, vec2 low, vec2 high, int channel,
                bool floats) {
    strips x = strips_create(low.x, high.x, tile_corner.x + side - 1);
    strips y = strips_create(low.y, high.y, tile_corner.y + side - 1);
    uvec4 below = table_row(table, x.edge, y.edge[0], layer, level, tile_corner, channel);
    float sum = 0.0;
    for (int i = 0; i < 3; i++) {
        uvec4 above = table_row(table, x.edge, y.edge[i + 1], layer, level, tile_corner, channel);
        vec3 row;
        if (floats) {
            vec4 a = uintBitsToFloat(above), b = uintBitsToFloat(below);
            row = (a.yzw - a.xyz) - (b.yzw - b.xyz);
        } else
            row = vec3((above.yzw - above.xyz) - (below.yzw - below.xyz));
        sum += y.weight[i] * dot(row, x.weight);
        below = above;
    }
    return sum;
}
