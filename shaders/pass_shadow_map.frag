// SPDX-License-Identifier: GPL-3.0-or-later
// Linear depth, 0 at the near plane, 1 at the far plane. In perspective it is written explicitly: a float keeps the
// same relative precision at any distance, so the planes need not be tight.

uniform vec2 depth_planes; // near, far

#ifdef SPECIAL
#include "common_material.glsl"
#include "common_random.glsl"
in vec2 uv;

uniform int translucency; // passes.h: enum translucency
uniform int sample_index;

// Whether the map keeps a fragment that lets this share of the light through.
bool is_kept(vec3 transmittance, float depth) {
    float opacity = 1.0 - dot(transmittance, vec3(1.0 / 3.0));
    if (translucency == 0)
        return opacity >= 0.5;
    if (translucency == 2)
        return all(lessThan(transmittance, vec3(TRANSMITTANCE_OPAQUE)));
    if (translucency == 3)
        return any(lessThan(transmittance, vec3(TRANSMITTANCE_CLEAR)));
    float jitter = fragment_random(uvec2(gl_FragCoord.xy), depth);
    return opacity >= fract(jitter + float(sample_index) * 0.61803399) + 1e-6;
}
#endif

void main() {
#ifdef PERSPECTIVE
    float depth = (1.0 / gl_FragCoord.w - depth_planes.x) / (depth_planes.y - depth_planes.x);
    gl_FragDepth = depth;
#else
    float depth = gl_FragCoord.z;
#endif
#ifdef SPECIAL
    if (is_culled() || !is_kept(material_transmittance(uv), depth))
        discard;
#endif
}
