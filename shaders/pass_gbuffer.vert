// SPDX-License-Identifier: GPL-3.0-or-later
#include "common_camera.glsl"
#include "common_instance.glsl"

#ifdef SPECIAL
flat out int mirrored;
#endif
uniform mat4 projection; // relative world to clip

out vec3 position;
out vec3 normal;
out vec2 uv;
flat out vec2 traits;
#ifdef SPECIAL
out vec3 tint;
#endif
#ifdef LINKS
flat out uvec2 unlit_by;
#endif

void main() {
    position = instance_position();
    // Cofactors of the matrix: right for any scale, mirrored and singular ones too.
    vec3 a = instance_x.xyz, b = instance_y.xyz, c = instance_z.xyz;
    vec3 n = octahedral_decode(vertex_normal);
    normal = vec3(dot(cross(b, c), n), dot(cross(c, a), n), dot(cross(a, b), n));
    float side = dot(a, cross(b, c)) < 0.0 ? -1.0 : 1.0;
    // Of length 1 before it is interpolated, as Cycles and EEVEE have it: an uneven scale would favour some corners.
    normal *= side * inversesqrt(max(dot(normal, normal), 1e-37));
#ifdef SPECIAL
    bool is_image_mirrored = dot(camera.axis_x.xyz, cross(camera.axis_y.xyz, camera.axis_z.xyz)) < 0.0;
    mirrored = (side < 0.0) != is_image_mirrored ? 1 : 0;
    tint = vertex_color * vertex_color;
#endif
#ifdef LINKS
    unlit_by = instance_unlit_by;
#endif
    uv = vertex_uv;
    traits = instance_traits;
    gl_Position = projection * vec4(position, 1.0);
}
