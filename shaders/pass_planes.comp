// SPDX-License-Identifier: GPL-3.0-or-later
// One level of the bounding planes (common_planes.glsl): rg = slope per texel, b and a = least and greatest nearness at
// the block's centre of parallel planes that hold all its texels between them. Texels with nothing in them block
// nobody: they bring down the least and leave the greatest.
#include "common_light.glsl"
#include "common_shadow.glsl"
#include "common_planes.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(rgba32f, binding = 0) uniform writeonly image2DArray target;
uniform int level;

// Nearness of a texel of the map, NO_BLOCKER where there is nothing.
float texel_nearness(ivec3 texel) {
    float depth = texelFetch(shadow_map, texel, 0).r;
    light_view view = LIGHT_VIEW(texel.z);
    return depth < 1.0 ? nearness(view.near_depth + (view.far_depth - view.near_depth) * depth) : NO_BLOCKER;
}

// Any slope makes correct bounds; that of the means of the halves makes them exact for a plane.
vec4 block_of_texels(ivec3 block) {
    ivec2 first = block.xy * PLANE_BLOCK, last = textureSize(shadow_map, 0).xy - 1;
    vec2 sums = vec2(0.0);
    bool full = true;
    for (int i = 0; i < PLANE_BLOCK * PLANE_BLOCK; i++) {
        ivec2 at = ivec2(i % PLANE_BLOCK, i / PLANE_BLOCK);
        float n = texel_nearness(ivec3(min(first + at, last), block.z));
        sums += vec2(2 * at.x < PLANE_BLOCK ? -n : n, 2 * at.y < PLANE_BLOCK ? -n : n);
        full = full && n != NO_BLOCKER && all(lessThanEqual(first + at, last));
    }
    float middle = 0.5 * float(PLANE_BLOCK - 1);
    vec2 slope = full ? sums * (4.0 / pow(float(PLANE_BLOCK), 3.0)) : vec2(0.0);
    vec2 range = vec2(1e30, NO_BLOCKER);
    for (int i = 0; i < PLANE_BLOCK * PLANE_BLOCK; i++) {
        ivec2 at = ivec2(i % PLANE_BLOCK, i / PLANE_BLOCK);
        float n = texel_nearness(ivec3(min(first + at, last), block.z));
        float residual = n == NO_BLOCKER ? n : n - dot(slope, vec2(at) - middle);
        range = vec2(min(range.x, residual), max(range.y, residual));
    }
    return vec4(slope, range);
}

vec4 block_of_blocks(ivec3 block) {
    vec4 parts[4];
    vec2 slope = vec2(0.0);
    ivec2 last = textureSize(planes, level - 1).xy - 1;
    for (int i = 0; i < 4; i++) {
        parts[i] = texelFetch(planes, ivec3(min(2 * block.xy + ivec2(i & 1, i >> 1), last), block.z), level - 1);
        slope += 0.25 * parts[i].xy;
    }
    float quarter = 0.25 * float(PLANE_BLOCK << level);
    float half_side = quarter - 0.5; // from a part's centre to its outermost texel
    vec2 range = vec2(1e30, NO_BLOCKER);
    for (int i = 0; i < 4; i++) {
        vec2 center = quarter * vec2((i & 1) != 0 ? 1.0 : -1.0, (i >> 1) != 0 ? 1.0 : -1.0);
        vec2 difference = abs(parts[i].xy - slope);
        float spread = (difference.x + difference.y) * half_side;
        vec2 at_center = parts[i].zw - dot(slope, center);
        range = vec2(min(range.x, at_center.x - spread), max(range.y, at_center.y + spread));
    }
    return vec4(slope, range);
}

void main() {
    ivec3 block = ivec3(gl_GlobalInvocationID);
    if (all(lessThan(block.xy, imageSize(target).xy)))
        imageStore(target, block, level == 0 ? block_of_texels(block) : block_of_blocks(block));
}
