// SPDX-License-Identifier: GPL-3.0-or-later
// Marks the pixels at which a sample may not use the key sample's irradiance: where it sees another surface, or where a
// pixel covers so much, such as more than a texel of a shadow map, that a light changes within it. Depth 1 = drawn,
// 0 = reused.
#include "common_camera.glsl"
#include "common_steady.glsl"

uniform sampler2D gbuffer_depth, gbuffer_normal, key_depth, key_normal;
uniform vec4 key_window; // camera.window of the key sample
bool is_reusable(vec2 coordinate, ivec2 pixel) {
    float depth = texelFetch(gbuffer_depth, pixel, 0).r, before = texelFetch(key_depth, pixel, 0).r;
    if (depth == 0.0 || before == 0.0)
        return depth == before;
    vec4 normals = texelFetch(gbuffer_normal, pixel, 0);
    vec4 turn = abs(normals - texelFetch(key_normal, pixel, 0)); // of the octahedral normals
    vec3 normal = octahedral_decode(normals.zw);
    vec3 position = camera_position(coordinate, depth);
    vec3 step = position - camera_position_in(key_window, coordinate, before);
    // The samples lie symmetrically about the pixel's centre: what changes evenly over it cancels, if it is little.
    return depth * before > 0.0 && all(lessThan(turn, vec4(vec2(0.1), vec2(0.3)))) &&
           abs(dot(normal, step)) < 0.5 * pixel_width(position) && is_steady(position, normal);
}

void main() {
    vec2 coordinate = camera_pixel(gl_FragCoord.xy);
    gl_FragDepth = 1.0;
    if (is_reusable(coordinate, ivec2(coordinate)))
        discard;
}
