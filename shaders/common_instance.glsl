// SPDX-License-Identifier: GPL-3.0-or-later
// Vertices and instances of the scene (gpu_scene.h).

struct instance {
    vec4 rows[3];   // object to relative world
    vec4 receives;  // x: 1 = receives shadows, 0.5 = does not
};

layout(std430, binding = 0) readonly buffer instance_block {
    instance instances[];
};

layout(location = 0) in vec3 vertex_position;
layout(location = 1) in vec2 vertex_normal; // octahedral
layout(location = 2) in vec2 vertex_uv;
layout(location = 3) in uint vertex_instance;

vec3 instance_position() {
    instance i = instances[vertex_instance];
    vec4 p = vec4(vertex_position, 1.0);
    return vec3(dot(i.rows[0], p), dot(i.rows[1], p), dot(i.rows[2], p));
}
