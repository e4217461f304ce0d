// SPDX-License-Identifier: GPL-3.0-or-later
// What one light adds to the irradiance of a sample, with and without shadows.
#include "common_camera.glsl"
#include "common_steady.glsl"
#include "common_light.glsl"
#include "common_irradiance.glsl"

uniform sampler2D gbuffer_depth, gbuffer_normal;
uniform sampler2D visibility; // rgb = visibility times weight, a = weight
uniform vec3 shadow_color;    // what arrives where the light is hidden
#ifdef LINKS
uniform usampler2D gbuffer_links;
uniform int light_number;
#endif
#ifdef TILES
flat in float tile_visibility; // 0.5: the texture's
#endif

layout(location = 0) out vec4 out_irradiance;
layout(location = 1) out vec4 out_unshadowed;
layout(location = 2) out vec4 out_visibility;

// rgb: visibility; a: 0 where the light does not reach.
vec4 light_visibility(vec3 position, vec3 normal, bool receives) {
    vec4 v = texelFetch(visibility, ivec2(gl_FragCoord.xy), 0);
#ifdef TILES
    if (tile_visibility != 0.5)
        v = light_reaches(position, normal) ? vec4(vec3(receives ? tile_visibility : 1.0), 1.0) : vec4(0.0);
#endif
    return v;
}

void main() {
    vec2 coordinate = camera_pixel(gl_FragCoord.xy);
    ivec2 pixel = ivec2(coordinate); // in the G-buffer
    float depth = texelFetch(gbuffer_depth, pixel, 0).r;
    vec4 normals = texelFetch(gbuffer_normal, pixel, 0);
    vec3 normal = octahedral_decode(normals.xy);
    vec3 position = lit_position(camera_position(coordinate, depth), octahedral_decode(normals.zw));
    vec4 v = light_visibility(position, normal, depth > 0.0);
    vec3 irradiance = vec3(0.0), visible = vec3(1.0);
    if (depth != 0.0 && v.a > 0.0) {
        visible = v.rgb / v.a;
        visible += (1.0 - visible) * shadow_color;
        irradiance = light.emission.rgb * light_irradiance(position, normal);
#ifdef LINKS
        uvec2 unlit_by = texelFetch(gbuffer_links, pixel, 0).xy;
        irradiance *= float(1u - ((light_number < 32 ? unlit_by.x : unlit_by.y) >> uint(light_number & 31) & 1u));
#endif
    }
    out_irradiance = vec4(irradiance * visible, 0.0);
    out_unshadowed = vec4(irradiance, 0.0);
    out_visibility = vec4(visible, 1.0);
}
