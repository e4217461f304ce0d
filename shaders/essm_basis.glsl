// SPDX-License-Identifier: GPL-3.0-or-later
// The ESSM basis (Shen, Feng, Yang 2013), and the planes that the tables of ROBUST refer to. Needs shadow_map.
#include "common_exponential.glsl"

uniform sampler2DArray pyramid; // AS_PUBLISHED: pass_exponential_pyramid.comp; its level 0 is level 1 of the basis
uniform sampler2DArray tile_planes;  // ROBUST: pass_tile_planes.comp
uniform vec4 near_ratio[2];     // by layer: near_depth / depth span of a perspective view, 0: orthographic
uniform int tile_log;           // of a tile's side, texels of its level
const int MODE_ROBUST = 0, MODE_AS_PUBLISHED = 1;

float map_depth(ivec2 texel, int layer) {
    ivec2 last = textureSize(shadow_map, 0).xy - 1;
    return clean_depth(texelFetch(shadow_map, ivec3(min(texel, last), layer), 0).r);
}

// Means over a texel of a level: e^(c (t - m)), t e^(c (t - m)), t; and m. Beyond the border lie copies.
vec4 essm_basis(ivec3 texel, int at_level) {
    if (at_level > 0)
        return texelFetch(pyramid, texel, at_level - 1);
    float t = exponential_depth(map_depth(texel.xy, texel.z));
    return vec4(1.0, t, t, t);
}

// As the paper puts them into its tables: esm, esm-z and z, each 0..1 over the whole depth range.
vec3 essm_normalize(vec4 basis) {
    float factor = exp(p_c * (basis.w - 1.0)), least = exp(-p_c);
    return vec3((basis.x * factor - least) / (1.0 - least), basis.y * factor, basis.z);
}

// A plane's map depth is linear in map coordinates in an orthographic view; in perspective the inverse of its
// light-space depth is. These convert between map depth and what is linear.
float depth_to_linear(float depth, int layer) {
    float k = near_ratio[layer >> 2][layer & 3];
    return k > 0.0 ? 1.0 / (depth + k) : depth;
}

float linear_to_depth(float value, int layer) {
    float k = near_ratio[layer >> 2][layer & 3];
    return k > 0.0 ? 1.0 / max(value, 1e-6) - k : value;
}

// t of a tile's plane at an offset from the tile's centre, texels of the map.
float plane_t(vec4 plane, vec2 offset, int layer) {
    float depth = linear_to_depth(plane.x + dot(plane.yz, offset), layer);
    return exponential_depth(clamp(depth, -1.0, 4.0)) + abs(plane.w);
}
