// SPDX-License-Identifier: GPL-3.0-or-later
// One level of filtered lists from the level below: merges the lists of 2 x 2 texels (Selgrad et al. 2015, figure 3).
// A list gets as much room as its four sources have together, and what merging saves stays unused; or, where that would
// be too much, it is merged twice: COUNT to know its length, FILL to store it.
#include "common_fragments.glsl"
#include "common_accumulation.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(std430, binding = 4) buffer cursor_block {
    uint cursor; // end of the room taken
    uint kept;   // fragments of the new level
};
uniform uint target_first, source_first; // heads of the levels
uniform int target_side, source_side;
uniform ivec2 pair;       // the sources of texel x: scale * x + pair.x and scale * x + pair.y
uniform int scale;
uniform float texels[6]; // width of a texel of each view, metres, at depth 1 in perspective
// How near depths are merged, in such widths; most_tolerance is times the depth in perspective.
uniform float tolerance, most_tolerance, least_tolerance;
uniform int perspective;
uniform int phase; // STORE, or COUNT and FILL
uniform int by_reference; // 1: takes the list of the first source as it is

const int STORE = 0, COUNT = 1, FILL = 2;

uvec2 source_list(ivec3 texel) { // first and last + 1
    if (any(lessThan(texel, ivec3(0))) || any(greaterThanEqual(texel.xy, ivec2(source_side))))
        return uvec2(0u);
    uint head = 2u * (source_first + uint((texel.z * source_side + texel.y) * source_side + texel.x));
    return uvec2(heads[head], heads[head] + heads[head + 1u]);
}

float nearest(uvec2 list) {
    return list.x < list.y ? fragment_depth(list.x) : 3e38;
}

// Takes the fragments up to a depth from a list: their number, how far behind `base` together, and their opacity.
void take(inout uvec2 list, float base, float last, inout vec2 sum, inout OPACITY opacity) {
    OPACITY own = OPACITY(0.0);
    while (list.x < list.y) {
        float depth = fragment_depth(list.x);
        if (depth > last)
            break;
        sum += vec2(depth - base, 1.0);
        own = accumulate(own, fragment_opacity(list.x));
        list.x++;
    }
    opacity += own;
}

void main() {
    ivec3 texel = ivec3(gl_GlobalInvocationID);
    if (any(greaterThanEqual(texel.xy, ivec2(target_side))))
        return;
    ivec2 x = scale * texel.x + pair, y = scale * texel.y + pair;
    uvec2 a = source_list(ivec3(x.x, y.x, texel.z)), b = source_list(ivec3(x.y, y.x, texel.z));
    uvec2 c = source_list(ivec3(x.x, y.y, texel.z)), d = source_list(ivec3(x.y, y.y, texel.z));
    uint head = 2u * (target_first + uint((texel.z * target_side + texel.y) * target_side + texel.x));
    if (by_reference == 1) {
        heads[head] = a.x;
        heads[head + 1u] = a.y - a.x;
        return;
    }
    uint total = (a.y - a.x) + (b.y - b.x) + (c.y - c.x) + (d.y - d.x);
    uint room = phase == STORE ? total : heads[head + 1u];
    uint first = phase != COUNT && room > 0u ? atomicAdd(cursor, room) : 0u, place = first;
    while (true) {
        float base = min(min(nearest(a), nearest(b)), min(nearest(c), nearest(d)));
        if (base == 3e38)
            break;
        float z = perspective == 1 ? base : 1.0;
        float last = base + z * texels[texel.z] * max(min(tolerance, most_tolerance * z), least_tolerance);
        vec2 sum = vec2(0.0);
        OPACITY opacity = OPACITY(0.0); // of the four lists, which lie side by side
        take(a, base, last, sum, opacity);
        take(b, base, last, sum, opacity);
        take(c, base, last, sum, opacity);
        take(d, base, last, sum, opacity);
        if (phase != COUNT)
            fragment_store(place, base + sum.x / sum.y, 0.25 * opacity);
        place++;
    }
    heads[head] = first;
    heads[head + 1u] = place - first;
    if (phase != FILL && total > 0u)
        atomicAdd(kept, place - first);
}
