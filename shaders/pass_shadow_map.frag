// SPDX-License-Identifier: GPL-3.0-or-later
// Linear depth, 0 at the near plane, 1 at the far plane. In perspective it is written explicitly: a float keeps the
// same relative precision at any distance, so the planes need not be tight.

uniform vec2 depth_planes; // near, far

#ifdef SPECIAL
#include "common_material.glsl"
in vec2 uv;
#endif

void main() {
#ifdef SPECIAL
    if (material_color(uv).a < 0.5 || is_culled())
        discard;
#endif
#ifdef PERSPECTIVE
    gl_FragDepth = (1.0 / gl_FragCoord.w - depth_planes.x) / (depth_planes.y - depth_planes.x);
#endif
}
