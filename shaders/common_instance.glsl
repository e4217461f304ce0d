// SPDX-License-Identifier: GPL-3.0-or-later
// Vertices and instances of the scene (gpu_cache.h: struct vertex, struct instance_block).

layout(location = 0) in vec3 vertex_position;
layout(location = 1) in vec2 vertex_normal; // octahedral
layout(location = 2) in vec2 vertex_uv;
layout(location = 3) in vec4 instance_x;    // rows of object to relative world
layout(location = 4) in vec4 instance_y;
layout(location = 5) in vec4 instance_z;
layout(location = 6) in vec2 instance_traits; // x: 1 = receives shadows; y: 1 = holdout, 0.5 = shadow catcher
layout(location = 7) in uvec2 instance_unlit_by; // bits of the lights that do not light it
layout(location = 8) in vec3 vertex_color;       // square roots

vec3 instance_position() {
    vec4 p = vec4(vertex_position, 1.0);
    return vec3(dot(instance_x, p), dot(instance_y, p), dot(instance_z, p));
}
