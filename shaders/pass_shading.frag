// SPDX-License-Identifier: GPL-3.0-or-later
// What one light adds to a sample: reflected radiance, and its shares of the shadow pass. The first one of a sample
// (FIRST) also adds what needs no light: background, ambient light and the normal. Without LIGHT_TYPE only that.
#include "common_camera.glsl"
#ifdef LIGHT_TYPE
#include "common_light.glsl"
#include "common_irradiance.glsl"
uniform sampler2D visibility; // rgb = visibility times weight, a = weight
#endif
#ifdef TILES
flat in float tile_visibility; // 0.5: the texture's
#endif

uniform sampler2D gbuffer_depth, gbuffer_normal, gbuffer_color;
#ifdef EMISSION
uniform sampler2D gbuffer_emission;
#endif
#ifdef LINKS
uniform usampler2D gbuffer_links;
uniform int light_number;
#endif
uniform vec4 world; // rgb; a: 0 = transparent film

layout(location = 0) out vec4 out_combined;
layout(location = 1) out vec4 out_shadowed;   // irradiance
layout(location = 2) out vec4 out_unshadowed; // irradiance
layout(location = 3) out vec4 out_normal;
layout(location = 4) out vec4 out_visibility; // of this light
layout(location = 5) out vec4 out_caught;     // irradiance of a shadow catcher; a: its coverage
layout(location = 6) out vec4 out_uncaught;   // irradiance

#ifdef LIGHT_TYPE
// rgb: visibility; a: 0 where the light does not reach.
vec4 light_visibility(vec3 position, vec3 normal, bool receives) {
    vec4 v = texelFetch(visibility, ivec2(gl_FragCoord.xy), 0);
#ifdef TILES
    if (tile_visibility != 0.5)
        v = light_reaches(position, normal) ? vec4(vec3(receives ? tile_visibility : 1.0), 1.0) : vec4(0.0);
#endif
    return v;
}
#endif

void main() {
    vec2 coordinate = camera_pixel(gl_FragCoord.xy);
    ivec2 pixel = ivec2(coordinate); // in the G-buffer
    float depth = texelFetch(gbuffer_depth, pixel, 0).r;
    vec4 surface = texelFetch(gbuffer_color, pixel, 0);
    float seen = surface.a == 1.0 ? 1.0 : 0.0; // neither holdout nor shadow catcher
    float catcher = surface.a == 0.5 ? 1.0 : 0.0;
    vec3 color = surface.rgb * seen;
    vec3 normal = octahedral_decode(texelFetch(gbuffer_normal, pixel, 0).xy);
    bool covered = depth != 0.0;
    vec3 radiance = vec3(0.0), irradiance = vec3(0.0), visible = vec3(1.0);
#ifdef LIGHT_TYPE
    vec3 position = camera_position(coordinate, depth);
    vec4 v = light_visibility(position, normal, depth > 0.0);
    if (covered && v.a > 0.0) {
        visible = v.rgb / v.a;
        irradiance = light.emission.rgb * light_irradiance(position, normal);
#ifdef LINKS
        uvec2 unlit_by = texelFetch(gbuffer_links, pixel, 0).xy;
        irradiance *= float(1u - ((light_number < 32 ? unlit_by.x : unlit_by.y) >> uint(light_number & 31) & 1u));
#endif
        radiance = color / PI * irradiance * visible;
    }
#endif
    out_shadowed = vec4(irradiance * visible, 0.0);
    out_unshadowed = vec4(irradiance, 0.0);
    out_visibility = vec4(visible, 1.0);
    out_combined = vec4(radiance, 0.0);
    out_caught = vec4(irradiance * visible * catcher, 0.0);
    out_uncaught = vec4(irradiance * catcher, 0.0);
#ifdef FIRST
    out_combined += covered ? vec4(color * world.rgb, seen) : vec4(world.rgb * world.a, world.a);
#ifdef EMISSION
    out_combined.rgb += texelFetch(gbuffer_emission, pixel, 0).rgb * seen;
#endif
    const float pi = 3.14159265; // of ambient irradiance over radiance
    out_caught += catcher * vec4(pi * world.rgb, 1.0);
    out_uncaught += catcher * vec4(pi * world.rgb, 1.0);
    out_normal = covered ? vec4(normal, 1.0) : vec4(0.0);
#endif
}
