// SPDX-License-Identifier: GPL-3.0-or-later
// What a sample adds to the sums: the light its surfaces reflect (LIT), and, once per sample (FIRST), what needs no
// light: background, ambient light, and EMISSION and NORMAL if they are wanted.
#include "common_camera.glsl"

uniform sampler2D gbuffer_depth, gbuffer_normal, gbuffer_color;
#ifdef LIT
uniform sampler2D irradiance, unshadowed; // of all lights
#endif
#ifdef EMISSION
uniform sampler2D gbuffer_emission;
#endif
uniform vec4 world; // rgb; a: 0 = transparent film

layout(location = 0) out vec4 out_combined;
layout(location = 1) out vec4 out_shadowed;   // irradiance
layout(location = 2) out vec4 out_unshadowed; // irradiance
layout(location = 3) out vec4 out_normal;
layout(location = 4) out vec4 out_caught;     // irradiance of a shadow catcher; a: its coverage
layout(location = 5) out vec4 out_uncaught;   // irradiance

void main() {
    ivec2 pixel = ivec2(camera_pixel(gl_FragCoord.xy)); // in the G-buffer
    vec4 surface = texelFetch(gbuffer_color, pixel, 0);
    float seen = surface.a == 1.0 ? 1.0 : 0.0; // neither holdout nor shadow catcher
    float catcher = surface.a == 0.5 ? 1.0 : 0.0;
    vec3 color = surface.rgb * seen, with = vec3(0.0), without = vec3(0.0);
    const float pi = 3.14159265; // of irradiance over radiance
#ifdef LIT
    with = texelFetch(irradiance, ivec2(gl_FragCoord.xy), 0).rgb;
    without = texelFetch(unshadowed, ivec2(gl_FragCoord.xy), 0).rgb;
#endif
    out_combined = vec4(color / pi * with, 0.0);
    out_shadowed = vec4(with, 0.0);
    out_unshadowed = vec4(without, 0.0);
    out_caught = vec4(with * catcher, 0.0);
    out_uncaught = vec4(without * catcher, 0.0);
#ifdef FIRST
    bool covered = texelFetch(gbuffer_depth, pixel, 0).r != 0.0;
    out_combined += covered ? vec4(color * world.rgb, seen) : vec4(world.rgb * world.a, world.a);
#ifdef EMISSION
    out_combined.rgb += texelFetch(gbuffer_emission, pixel, 0).rgb * seen;
#endif
    out_caught += catcher * vec4(pi * world.rgb, 1.0);
    out_uncaught += catcher * vec4(pi * world.rgb, 1.0);
#ifdef NORMAL
    out_normal = covered ? vec4(octahedral_decode(texelFetch(gbuffer_normal, pixel, 0).xy), 1.0) : vec4(0.0);
#endif
#endif
}
