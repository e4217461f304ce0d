// SPDX-License-Identifier: GPL-3.0-or-later
// What the summed-area tables of ESSM sum: esm in the table of one channel, esm-z and z in the other.
uniform sampler2DArray shadow_map, min_max;
#include "essm_basis.glsl"

uniform int level, p_mode;

// Relative to the plane of the tile. A texel of a coarse level takes the middle one of its texels of the map: kernels
// that are read from there cover a thousand of them and more.
vec3 robust_value(ivec3 texel) {
    ivec2 tile = texel.xy >> tile_log, at = (texel.xy << level) + (1 << level) / 2;
    vec2 center = (vec2(tile) + 0.5) * float(1 << (tile_log + level));
    vec4 plane = texelFetch(tile_planes, ivec3(tile, texel.z), level);
    float t = exponential_depth(map_depth(at, texel.z));
    float esm = exp(p_c * (t - plane_t(plane, vec2(at) + 0.5 - center, texel.z)));
    return vec3(esm, esm * t, t);
}

void summed_create(int layer) {
    exponential_create(layer);
}

vec4 summed_value(ivec3 texel) {
    vec3 value = p_mode == MODE_ROBUST ? robust_value(texel) : essm_normalize(essm_basis(texel, level));
    value = clamp(value, 0.0, 1.0);
#if CHANNELS == 1
    return vec4(value.x, 0.0, 0.0, 0.0);
#else
    return vec4(value.yz, 0.0, 0.0);
#endif
}
