// SPDX-License-Identifier: GPL-3.0-or-later
#include "common_instance.glsl"

uniform mat4 projection; // relative world to the map's clip space; w is the light-space depth in perspective

#ifdef TRANSPARENT
out vec2 uv;
#endif

void main() {
#ifdef TRANSPARENT
    uv = vertex_uv;
#endif
    gl_Position = projection * vec4(instance_position(), 1.0);
}
