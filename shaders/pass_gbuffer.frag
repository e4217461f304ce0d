// SPDX-License-Identifier: GPL-3.0-or-later
#include "common_camera.glsl"
#include "common_material.glsl"
#include "common_random.glsl"

in vec3 position;
in vec3 normal;
in vec2 uv;
flat in vec2 traits;

layout(location = 0) out float out_depth;
layout(location = 1) out vec4 out_normal;
layout(location = 2) out vec4 out_color;
#ifdef EMISSION
layout(location = 3) out vec4 out_emission;
#endif

void main() {
    vec4 color = material_color(uv);
#ifdef SPECIAL
    if (is_culled())
        discard;
    // Stochastic transparency, stratified over the samples of the pixel; a single sample cuts at one half.
    float jitter = camera.sample_count > 1.0 ? pixel_random(uvec2(gl_FragCoord.xy)) : 0.5;
    if (color.a < fract(jitter + camera.sample_index * 0.61803399) + 1e-6)
        discard;
#endif
    // The triangle's own plane, seen from its visible side; a shading normal must not leave that side.
    vec3 geometric = cross(dFdx(position), dFdy(position));
    vec3 to_camera = camera.perspective != 0.0 ? -position : camera.axis_z.xyz;
    geometric = dot(geometric, to_camera) < 0.0 ? -geometric : geometric;
    geometric = dot(geometric, geometric) > 0.0 ? normalize(geometric) : normalize(to_camera);
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
}
