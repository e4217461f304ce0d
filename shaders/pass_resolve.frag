// SPDX-License-Identifier: GPL-3.0-or-later
// Sums over the samples to the passes the host gets.

uniform sampler2D combined, shadowed, unshadowed, normal;
uniform float sample_weight; // 1 / samples

layout(location = 0) out vec4 out_combined;
layout(location = 1) out vec4 out_shadow;
layout(location = 2) out vec4 out_normal;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    out_combined = texelFetch(combined, pixel, 0) * sample_weight;
    vec3 lit = texelFetch(unshadowed, pixel, 0).rgb;
    vec3 ratio = texelFetch(shadowed, pixel, 0).rgb / max(lit, vec3(1e-30));
    out_shadow = vec4(mix(vec3(1.0), ratio, greaterThan(lit, vec3(0.0))), 1.0);
    vec3 n = texelFetch(normal, pixel, 0).rgb;
    out_normal = vec4(dot(n, n) > 0.0 ? normalize(n) : vec3(0.0), 1.0);
}
