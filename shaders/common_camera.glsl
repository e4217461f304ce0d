// SPDX-License-Identifier: GPL-3.0-or-later
// The camera of one sub-pixel sample (frame.h: struct camera_block) and the G-buffer it fills.
// Relative world space has its origin at the camera.

layout(std140, binding = 0) uniform camera_block {
    vec4 axis_x, axis_y, axis_z; // camera axes; it looks along -axis_z
    vec4 window;                 // left, bottom, width, height of the full image at distance 1 or in metres
    vec4 image;                  // full width and height in pixels, lower left pixel of the crop
    float perspective;           // 1 or 0
    float sample_index, sample_count;
    float padding;
    vec4 lit;                    // xy: from window.xy to that of the point a key sample is lit at; z: 1 = there is one
} camera;

// gbuffer_depth: metres along the camera axis, negative = receives no shadow, 0 = background.
// gbuffer_normal: octahedral shading normal (xy) and geometric normal (zw); both face the camera.
// gbuffer_color: base colour; a: 0 = holdout, 0.5 = shadow catcher.
// gbuffer_emission: emitted radiance.

vec2 octahedral_encode(vec3 n) {
    n /= abs(n.x) + abs(n.y) + abs(n.z);
    vec2 folded = (1.0 - abs(n.yx)) * vec2(n.x >= 0.0 ? 1.0 : -1.0, n.y >= 0.0 ? 1.0 : -1.0);
    return n.z >= 0.0 ? n.xy : folded;
}

vec3 octahedral_decode(vec2 e) {
    vec3 n = vec3(e, 1.0 - abs(e.x) - abs(e.y));
    float fold = max(-n.z, 0.0);
    n.x += n.x >= 0.0 ? -fold : fold;
    n.y += n.y >= 0.0 ? -fold : fold;
    return normalize(n);
}

// Full-image coordinate of a fragment of a pass over the crop.
vec2 camera_pixel(vec2 fragment) {
    return fragment + camera.image.zw;
}

// Relative world position of a full-image coordinate and its gbuffer_depth, in a sample with this window.
vec3 camera_position_in(vec4 window, vec2 coordinate, float depth) {
    depth = abs(depth);
    vec2 p = window.xy + coordinate / camera.image.xy * window.zw;
    vec3 across = p.x * camera.axis_x.xyz + p.y * camera.axis_y.xyz;
    return camera.perspective != 0.0 ? depth * (across - camera.axis_z.xyz) : across - depth * camera.axis_z.xyz;
}

vec3 camera_position(vec2 coordinate, float depth) {
    return camera_position_in(camera.window, coordinate, depth);
}

// Where a key sample lights a surface: it stands for others, so at the mean of their places in the pixel, on the
// surface's own tangent plane.
vec3 camera_mean_position(vec3 position, vec3 normal) {
    float scale = camera.perspective != 0.0 ? abs(dot(position, camera.axis_z.xyz)) : 1.0;
    vec3 across = scale * (camera.lit.x * camera.axis_x.xyz + camera.lit.y * camera.axis_y.xyz);
    vec3 along = camera.perspective != 0.0 ? normalize(position + across) : -camera.axis_z.xyz;
    vec3 step = across - along * dot(normal, across) / min(dot(normal, along), -0.1); // edge-on the plane is not met
    return camera.lit.z != 0.0 ? position + step : position;
}
