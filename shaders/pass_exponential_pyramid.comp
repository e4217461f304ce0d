// SPDX-License-Identifier: GPL-3.0-or-later
// One level of the pyramid of the ESSM basis, from the level below or from the map: of each block of texels the means
// of e^(c (t - m)), of t e^(c (t - m)) and of t, and the greatest t, m. Relative to their own m, no value is ever lost
// to the range of a float. Also finds the level's greatest value as it would enter a table with a tile per block.

layout(local_size_x = 8, local_size_y = 8) in;
layout(rgba32f, binding = 0) uniform writeonly image2DArray target;
layout(std430, binding = 1) buffer greatest_block {
    uint greatest[]; // bits of a float >= 0, by level
};
uniform sampler2DArray shadow_map, min_max;
#include "essm_basis.glsl"

uniform int level;

vec4 join(vec4 a, vec4 b, vec4 c, vec4 d) {
    float m = max(max(a.w, b.w), max(c.w, d.w));
    vec4 weight = 0.25 * exp(p_c * (vec4(a.w, b.w, c.w, d.w) - m));
    return vec4(dot(weight, vec4(a.x, b.x, c.x, d.x)), dot(weight, vec4(a.y, b.y, c.y, d.y)),
                0.25 * (a.z + b.z + c.z + d.z), m);
}

void main() {
    ivec3 texel = ivec3(gl_GlobalInvocationID);
    if (any(greaterThanEqual(texel.xy, imageSize(target).xy)))
        return;
    exponential_create(texel.z);
    ivec3 first = ivec3(2 * texel.xy, texel.z);
    vec4 value = join(essm_basis(first, level - 1), essm_basis(first + ivec3(1, 0, 0), level - 1),
                      essm_basis(first + ivec3(0, 1, 0), level - 1), essm_basis(first + ivec3(1, 1, 0), level - 1));
    imageStore(target, texel, value);
    vec3 entry = essm_normalize(value);
    atomicMax(greatest[level], floatBitsToUint(max(max(entry.x, entry.y), max(entry.z, 0.0))));
}
