// SPDX-License-Identifier: GPL-3.0-or-later
// For each tile of a level the plane its tables refer to: the one that most of its texels lie in and few behind, since
// that is what shadows fall on, moved back until no surface is behind it. Where there is no such plane: one across the
// view at the farthest depth. xyz: value at the tile's centre and slopes (depth_to_linear); w: distance moved, as t,
// negative if there are texels with nothing in them, which count as if they were in the plane.

layout(local_size_x = 64) in;
layout(rgba32f, binding = 0) uniform writeonly image2DArray target;
uniform sampler2DArray shadow_map, min_max;
#include "essm_basis.glsl"

uniform int level;
shared vec3 candidates[64]; // planes through the tile's samples
shared vec3 samples[64];    // offset from the centre, and t
shared float values[64];  // of their depths, depth_to_linear
shared float behind[64];
shared bool empties[64];
shared int score[64];
shared vec3 chosen; // of the candidates, or what is taken where none is good

// Of 64 samples, those that make a plane, and those that may lie behind it.
const int LEAST_SUPPORT = 4, MOST_BEHIND = 1;

float distance_behind(vec3 plane, int i, int layer) {
    return p_c * (samples[i].z - plane_t(vec4(plane, 0.0), samples[i].xy, layer));
}

// Least squares over the samples near a plane: its slopes come from two texels and carry their rounding far.
vec3 fit(vec3 plane, int sample_count, int layer) {
    mat3 sum = mat3(0.0);
    vec3 right = vec3(0.0);
    float side = float((1 << tile_log) << level);
    for (int i = 0; i < sample_count; i++) {
        if (abs(distance_behind(plane, i, layer)) >= 0.5)
            continue;
        vec3 row = vec3(1.0, samples[i].xy / side);
        float error = values[i] - dot(plane, vec3(1.0, samples[i].xy));
        sum += outerProduct(row, row);
        right += row * error;
    }
    return abs(determinant(sum)) > 1e-3 ? plane + inverse(sum) * right / vec3(1.0, side, side) : plane;
}

void main() {
    int thread = int(gl_LocalInvocationIndex), layer = int(gl_WorkGroupID.z);
    int tile = 1 << tile_log, side = tile << level;
    exponential_create(layer);
    ivec2 corner = ivec2(gl_WorkGroupID.xy) * side;
    if (any(greaterThanEqual(corner, textureSize(shadow_map, 0).xy)))
        return;
    vec2 center = vec2(corner) + 0.5 * float(side);
    ivec2 texel = corner + (2 * ivec2(thread % 8, thread / 8) + 1) * side / 16;
    vec2 offset = vec2(texel) + 0.5 - center;
    float depth = map_depth(texel, layer), value = depth_to_linear(depth, layer);
    int reach = 1 << level;
    vec2 slope = (vec2(depth_to_linear(map_depth(texel + ivec2(reach, 0), layer), layer),
                       depth_to_linear(map_depth(texel + ivec2(0, reach), layer), layer)) - value) / float(reach);
    candidates[thread] = vec3(value - dot(slope, offset), slope);
    samples[thread] = vec3(offset, exponential_depth(depth));
    values[thread] = value;
    barrier();
    int support = 0, farther = 0;
    vec3 candidate = candidates[thread];
    for (int i = 0; i < 64; i++) {
        float distance = distance_behind(candidate, i, layer);
        support += int(abs(distance) < 0.5);
        farther += int(distance >= 0.5 && samples[i].z < 1.0);
    }
    score[thread] = support < LEAST_SUPPORT || farther > MOST_BEHIND ? -1 : support;
    barrier();
    int best = 0;
    for (int i = 1; i < 64; i++)
        best = score[i] > score[best] ? i : best;
    // One thread fits. The others go through its loop once: what is behind a branch alone takes its time in software.
    vec3 fitted = fit(candidates[best], thread == 0 ? 64 : 0, layer);
    if (thread == 0)
        chosen = score[best] >= 0 ? fitted : vec3(depth_to_linear(0.0, layer), vec2(0.0));
    barrier();
    vec4 plane = vec4(chosen, 0.0);
    float greatest = 0.0;
    bool empty = false;
    for (int i = thread; i < tile * tile; i += 64) {
        ivec2 at = corner + (ivec2(i & (tile - 1), i >> tile_log) << level) + (1 << level) / 2;
        vec2 from_center = vec2(at) + 0.5 - center;
        float t = exponential_depth(map_depth(at, layer));
        greatest = t < 1.0 ? max(greatest, t - plane_t(plane, from_center, layer)) : greatest;
        empty = empty || t >= 1.0;
    }
    behind[thread] = greatest;
    empties[thread] = empty;
    barrier();
    if (thread > 0)
        return;
    for (int i = 0; i < 64; i++) {
        greatest = max(greatest, behind[i]);
        empty = empty || empties[i];
    }
    plane.w = empty ? -greatest - 1e-30 : greatest;
    imageStore(target, ivec3(gl_WorkGroupID.xy, layer), plane);
}
