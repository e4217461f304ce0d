// SPDX-License-Identifier: GPL-3.0-or-later
// Visibility of one light by the technique's function `vec3 technique_visibility(receiver r)`.
#include "common_camera.glsl"
#include "common_steady.glsl"
#include "common_light.glsl"
#include "common_shadow.glsl"
#include "technique"

uniform sampler2D gbuffer_depth, gbuffer_normal;

// At a full-image coordinate: rgb = visibility times weight, a = weight; a = 0 where the light does not reach.
vec4 visibility_at(vec2 coordinate) {
    ivec2 pixel = ivec2(coordinate); // in the G-buffer
    float depth = texelFetch(gbuffer_depth, pixel, 0).r;
    if (depth == 0.0)
        return vec4(0.0);
    vec4 normals = texelFetch(gbuffer_normal, pixel, 0);
    vec3 geometric = octahedral_decode(normals.zw), shading = octahedral_decode(normals.xy);
    vec3 position = lit_position(camera_position(coordinate, depth), geometric);
    if (!light_reaches(position, shading))
        return vec4(0.0);
    int layer = light_layer(position);
    if (layer < 0 || light.casts_shadow == 0.0 || depth < 0.0)
        return vec4(1.0);
    // Light wholly behind the surface itself lights nothing, whatever the shading normal says.
    receiver r = receiver_create(position, geometric, shading, layer);
    return vec4(light_reaches(position, geometric) ? technique_visibility(r) : vec3(0.0), 1.0);
}
