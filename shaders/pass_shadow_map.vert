// SPDX-License-Identifier: GPL-3.0-or-later
#include "common_instance.glsl"

#ifdef CLIP_BEHIND
uniform vec4 front; // relative world: plane of the emitter, positive before it
#endif
uniform mat4 projection; // relative world to the map's clip space; w is the light-space depth in perspective

#ifdef SPECIAL
out vec2 uv;
flat out int mirrored;
#endif

void main() {
#ifdef SPECIAL
    uv = vertex_uv;
    // Light space is right-handed with z away from the light, which sees it as in a mirror.
    mirrored = dot(instance_x.xyz, cross(instance_y.xyz, instance_z.xyz)) < 0.0 ? 0 : 1;
#endif
    vec4 position = vec4(instance_position(), 1.0);
    gl_Position = projection * position;
#ifdef CLIP_BEHIND
    gl_ClipDistance[0] = dot(front, position);
#endif
}
