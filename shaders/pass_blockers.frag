// SPDX-License-Identifier: GPL-3.0-or-later
// What blocks one light at every pixel, as a dense search of its shadow map finds it, whatever the technique: to look
// at, not to shade with.
#include "common_camera.glsl"
#include "common_light.glsl"
#include "common_shadow.glsl"
#include "common_min_max.glsl"

uniform sampler2D gbuffer_depth, gbuffer_normal;

layout(location = 0) out vec4 out_blockers; // metres: x: to the average blocker, y: width of its penumbra; 0: none

const int SIDE = 32; // points of the emitter along each side
const int REDUCTION = 2;

// Mean light-space depth of what hides part of the emitter, each texel weighted by the share it hides; 0: nothing does.
float average_blocker(inout receiver r) {
    vec2 depths, sum = vec2(0.0), reach = kernel_extent(r, 1.0);
    float scale = search_scale(r, REDUCTION, depths);
    vec2 extent = kernel_extent(r, scale) + 1.0;
    receiver_set_bias(r, max(extent.x, extent.y));
    for (int i = 0; i < SIDE * SIDE; i++) {
        vec2 s = (2.0 * vec2(i % SIDE, i / SIDE) + 1.0) / float(SIDE) - 1.0;
        vec2 offset = r.kernel * s * scale;
        float depth;
        if ((ELLIPSE == 1 && dot(s, s) > 1.0) || !blocker_at(r, r.center + offset, depth))
            continue;
        vec2 kernel = reach * kernel_scale(r, depth) + 1.0;
        if (all(lessThanEqual(abs(offset), kernel)))
            sum += vec2(depth, 1.0) / (kernel.x * kernel.y);
    }
    return sum.y > 0.0 ? sum.x / sum.y : 0.0;
}

// Full size of the emitter's image at distance 1, of its wider axis; SUN: at distance 1 from the blocker.
float emitter_width(receiver r) {
    vec2 q = is_perspective() ? r.position.xy / r.position.z : r.position.xy;
    mat2 axes = emitter_axes(r.position, q, mat3(LIGHT_VIEW(r.layer).from_world));
    return 2.0 * max(length(axes[0]), length(axes[1]));
}

void main() {
    vec2 coordinate = camera_pixel(gl_FragCoord.xy);
    ivec2 pixel = ivec2(coordinate); // in the G-buffer
    float depth = texelFetch(gbuffer_depth, pixel, 0).r;
    vec4 normals = texelFetch(gbuffer_normal, pixel, 0);
    vec3 geometric = octahedral_decode(normals.zw), shading = octahedral_decode(normals.xy);
    vec3 position = camera_position(coordinate, depth);
    int layer = light_layer(position);
    out_blockers = vec4(0.0);
    if (depth <= 0.0 || layer < 0 || light.casts_shadow == 0.0 || !light_reaches(position, geometric))
        return;
    receiver r = receiver_create(position, geometric, shading, layer);
    float blocker = average_blocker(r);
    if (blocker == 0.0)
        return;
    float to_receiver = is_perspective() ? length(r.position) : r.position.z - r.near_depth;
    out_blockers.x = is_perspective() ? to_receiver * blocker / r.position.z : blocker - r.near_depth;
    out_blockers.y = emitter_width(r) * kernel_scale(r, blocker) * (is_perspective() ? r.position.z : 1.0);
}
