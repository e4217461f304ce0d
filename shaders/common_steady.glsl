// SPDX-License-Identifier: GPL-3.0-or-later
// Whether the lights change so little within a pixel that samples of one surface may share what a key sample found.

// Of each light: its position, and what a pixel may cover at distance 1; SUN: any, and minus the width everywhere.
uniform vec4 widths[64];
uniform int width_count;

// Width at a point within which all lights are steady, metres.
float steady_width(vec3 position) {
    float width = 1e30;
    for (int i = 0; i < width_count; i++)
        width = min(width, widths[i].w < 0.0 ? -widths[i].w : widths[i].w * distance(position, widths[i].xyz));
    return width;
}

// Of a pixel at a position, across the view, metres.
float pixel_width(vec3 position) {
    float depth = camera.perspective != 0.0 ? abs(dot(position, camera.axis_z.xyz)) : 1.0;
    return camera.window.z / camera.image.x * depth;
}

bool is_steady(vec3 position, vec3 normal) {
    vec3 to_camera = camera.perspective != 0.0 ? -normalize(position) : camera.axis_z.xyz;
    return pixel_width(position) < steady_width(position) * max(dot(normal, to_camera), 1e-3);
}

// Where a surface is lit in this sample.
vec3 lit_position(vec3 position, vec3 normal) {
    return is_steady(position, normal) ? camera_mean_position(position, normal) : position;
}
