// SPDX-License-Identifier: GPL-3.0-or-later
#include "common_camera.glsl"
#include "common_material.glsl"
#include "common_random.glsl"

in vec3 position;
in vec3 normal;
in vec2 uv;
flat in vec2 traits;
#ifdef SPECIAL
in vec3 tint;
#else
const vec3 tint = vec3(1.0);
#endif
#ifdef LINKS
flat in uvec2 unlit_by;
#endif

layout(location = 0) out float out_depth;
layout(location = 1) out vec4 out_normal;
layout(location = 2) out vec4 out_color;
#ifdef EMISSION
layout(location = 3) out vec4 out_emission;
#endif
#ifdef LINKS
layout(location = 4) out uvec2 out_links;
#endif

#ifdef SPECIAL
// Random number of the sample. Each surface has its own, or one behind another would be seen in the same samples: it is
// known by the digits of its plane's distance, which depend neither on the order of drawing nor on the scene's unit.
float layer_random(vec3 plane_normal) {
    uvec2 pixel = uvec2(gl_FragCoord.xy);
    uint digits = floatBitsToUint(dot(plane_normal, position)) >> 13u & 0x3ffu;
    uint surface = hash(digits * 2891336453u + 1u);
    return stratified_random(uint(camera.sample_index), pixel.x + hash(pixel.y * 747796405u + surface));
}
#endif

void main() {
    vec4 color = material_color(uv, tint);
    vec3 geometric = cross(dFdx(position), dFdy(position));
    geometric = dot(geometric, geometric) > 0.0 ? normalize(geometric) : vec3(0.0);
#ifdef SPECIAL
    if (is_culled())
        discard;
    // Stochastic transparency, stratified over the samples of the pixel; a single sample cuts at one half.
    if (color.a < (camera.sample_count > 1.0 ? layer_random(geometric) : 0.5) + 1e-6)
        discard;
#endif
    // The triangle's own plane, seen from its visible side; a shading normal must not leave that side.
    vec3 to_camera = camera.perspective != 0.0 ? -position : camera.axis_z.xyz;
    geometric = dot(geometric, to_camera) < 0.0 ? -geometric : geometric;
    geometric = dot(geometric, geometric) > 0.0 ? geometric : normalize(to_camera);
    vec3 shading = dot(normal, normal) > 0.0 ? normalize(normal) : geometric;
    if (dot(shading, geometric) < 0.0)
        shading = -shading;
    float depth = -dot(position, camera.axis_z.xyz);
    out_depth = traits.x != 0.0 ? depth : -depth;
    out_normal = vec4(octahedral_encode(shading), octahedral_encode(geometric));
    out_color = vec4(min(color.rgb, vec3(65504.0)), 1.0 - max(traits.y, emission.a));
#ifdef EMISSION
    out_emission = vec4(min(material_emission(uv), vec3(65504.0)), 1.0);
#endif
#ifdef LINKS
    out_links = unlit_by;
#endif
}
