// SPDX-License-Identifier: GPL-3.0-or-later
// What one light adds to a sample: reflected radiance, and its shares of the shadow pass.
#include "common_camera.glsl"
#include "common_light.glsl"
#include "common_irradiance.glsl"

uniform sampler2D gbuffer_depth, gbuffer_normal, gbuffer_color, visibility;

layout(location = 0) out vec4 out_combined;
layout(location = 1) out vec4 out_shadowed;   // irradiance
layout(location = 2) out vec4 out_unshadowed; // irradiance
layout(location = 3) out vec4 out_visibility; // of this light

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    out_combined = out_shadowed = out_unshadowed = vec4(0.0);
    vec4 v = texelFetch(visibility, pixel, 0);
    vec3 visible = v.a > 0.0 ? v.rgb / v.a : vec3(1.0);
    out_visibility = vec4(visible, 1.0);
    if (v.a <= 0.0)
        return;
    float depth = texelFetch(gbuffer_depth, pixel, 0).r;
    vec3 normal = octahedral_decode(texelFetch(gbuffer_normal, pixel, 0).xy);
    vec3 irradiance = light.emission.rgb * light_irradiance(camera_position(gl_FragCoord.xy, depth), normal);
    out_unshadowed = vec4(irradiance, 0.0);
    out_shadowed = vec4(irradiance * visible, 0.0);
    out_combined = vec4(texelFetch(gbuffer_color, pixel, 0).rgb / PI * irradiance * visible, 0.0);
}
