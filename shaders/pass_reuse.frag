// SPDX-License-Identifier: GPL-3.0-or-later
// Marks the pixels at which a sample may not use the key sample's irradiance: where it sees another surface, or where a
// pixel covers more than a texel of a shadow map, so that visibility changes within it. Depth 1 = drawn, 0 = reused.
#include "common_camera.glsl"

uniform sampler2D gbuffer_depth, gbuffer_normal, key_depth, key_normal;
uniform vec4 key_window; // camera.window of the key sample
// Of each light with a map: its position and its texels' width at distance 1; SUN: any, and minus the width.
uniform vec4 texels[64];
uniform int texel_count;

// Width of the narrowest texel of any map at a point, metres.
float texel_width(vec3 position) {
    float width = 1e30;
    for (int i = 0; i < texel_count; i++)
        width = min(width, texels[i].w < 0.0 ? -texels[i].w : texels[i].w * distance(position, texels[i].xyz));
    return width;
}

bool is_reusable(vec2 coordinate, ivec2 pixel) {
    float depth = texelFetch(gbuffer_depth, pixel, 0).r, before = texelFetch(key_depth, pixel, 0).r;
    if (depth == 0.0 || before == 0.0)
        return depth == before;
    vec4 normals = texelFetch(gbuffer_normal, pixel, 0);
    vec4 turn = abs(normals - texelFetch(key_normal, pixel, 0)); // of the octahedral normals
    vec3 normal = octahedral_decode(normals.zw);
    vec3 position = camera_position(coordinate, depth);
    vec3 step = position - camera_position_in(key_window, coordinate, before);
    float pixel_width = camera.window.z / camera.image.x * (camera.perspective != 0.0 ? abs(depth) : 1.0);
    vec3 to_camera = camera.perspective != 0.0 ? -normalize(position) : camera.axis_z.xyz;
    float footprint = pixel_width / max(dot(normal, to_camera), 1e-3);
    // The samples lie symmetrically about the pixel's centre: what changes evenly over it cancels, if it changes little.
    return depth * before > 0.0 && all(lessThan(turn, vec4(vec2(0.1), vec2(0.3)))) &&
           abs(dot(normal, step)) < 0.5 * pixel_width && footprint <= texel_width(position);
}

void main() {
    vec2 coordinate = camera_pixel(gl_FragCoord.xy);
    gl_FragDepth = 1.0;
    if (is_reusable(coordinate, ivec2(coordinate)))
        discard;
}
