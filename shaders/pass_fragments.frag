// SPDX-License-Identifier: GPL-3.0-or-later
// Fragments of casters: counts them for each texel, or with COLLECT stores them where the scan has made room.
#include "common_fragments.glsl"

uniform vec2 depth_planes; // near, far
uniform int layer, side;
#ifdef SPECIAL
#include "common_material.glsl"
in vec2 uv;
uniform int translucent_only; // 1: without what is opaque
#endif

void main() {
    vec3 transmittance = vec3(0.0);
#ifdef SPECIAL
    transmittance = material_transmittance(uv);
    bool opaque = all(lessThan(transmittance, vec3(TRANSMITTANCE_OPAQUE)));
    bool clear = all(greaterThanEqual(transmittance, vec3(TRANSMITTANCE_CLEAR)));
    if (is_culled() || clear || (opaque && translucent_only == 1))
        discard;
#endif
    uint head = 2u * uint((layer * side + int(gl_FragCoord.y)) * side + int(gl_FragCoord.x));
    uint place = atomicAdd(heads[head + 1u], 1u);
#ifdef COLLECT
#ifdef PERSPECTIVE
    float depth = 1.0 / gl_FragCoord.w;
#else
    float depth = mix(depth_planes.x, depth_planes.y, gl_FragCoord.z);
#endif
    fragment_store(heads[head] + place, depth, opacity_from(transmittance));
#endif
}
