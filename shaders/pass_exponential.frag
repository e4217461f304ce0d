// SPDX-License-Identifier: GPL-3.0-or-later
// The basis of exponential shadow maps: e^(c t) of every texel of a shadow map.
uniform sampler2DArray shadow_map, min_max;
#include "common_exponential.glsl"
uniform int layer;

layout(location = 0) out float out_exponential;

void main() {
    exponential_create(layer);
    float depth = clean_depth(texelFetch(shadow_map, ivec3(gl_FragCoord.xy, layer), 0).r);
    out_exponential = exp(p_c * exponential_depth(depth));
}
