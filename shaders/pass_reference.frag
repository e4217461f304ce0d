// SPDX-License-Identifier: GPL-3.0-or-later
// One light sample of REFERENCE: the emitter shrunk to one of its points. Adds up visibility and weight; the weight is
// what the point contributes to the unshadowed irradiance.
#include "common_camera.glsl"
#include "common_light.glsl"
#include "common_shadow.glsl"
#ifdef TRANSLUCENT
#include "common_fragments.glsl"
#endif

uniform sampler2D gbuffer_depth, gbuffer_normal;
uniform vec4 emitter_normal; // xyz: of the emitter's surface at the sample; w: 0 = shines equally everywhere
uniform int uniform_weights; // 1: every sample counts the same, as in the papers

layout(location = 0) out vec4 out_visibility;

float sample_weight(vec3 position, vec3 normal) {
    if (LIGHT_TYPE == SUN)
        return max(dot(normal, -light.frame_z.xyz), 0.0);
    vec3 to_light = light.position.xyz - position;
    float d2 = dot(to_light, to_light);
    float facing = emitter_normal.w != 0.0 ? max(-dot(to_light, emitter_normal.xyz), 0.0) : sqrt(d2);
    float weight = max(dot(normal, to_light), 0.0) * facing / max(d2 * d2, 1e-20);
#ifdef SPREAD
    weight *= light_spread(to_light);
#endif
    return weight;
}

#ifdef TRANSLUCENT
// Share of the light that passes all translucent surfaces before the receiver at a texel; none if one is opaque.
vec3 texel_transmittance(receiver r, vec2 coordinate) {
    float depth;
    if (blocker_at(r, coordinate, depth))
        return vec3(0.0);
    vec2 texel = floor(coordinate);
    if (any(greaterThanEqual(uvec2(ivec2(texel)), r.map_size)))
        return vec3(1.0);
    uint head = 2u * ((uint(r.layer) * r.map_size.y + uint(texel.y)) * r.map_size.x + uint(texel.x));
    uint first = heads[head], last = first + heads[head + 1u];
    vec3 transmittance = vec3(1.0);
    for (uint i = first; i < last; i++)
        if (is_blocker(r, texel, fragment_depth(i)))
            transmittance *= 1.0 - fragment_opacity(i);
    return transmittance;
}
#else
vec3 texel_transmittance(receiver r, vec2 coordinate) {
    float depth;
    return blocker_at(r, coordinate, depth) ? vec3(0.0) : vec3(1.0);
}
#endif

// Edges fade over half a texel; samples whose texels lie elsewhere (reference.c) smooth them further.
vec3 transmittance(receiver r, vec2 coordinate) {
    vec2 corner = coordinate - 0.5;
    vec2 f = clamp(2.0 * fract(corner) - 0.5, 0.0, 1.0);
    return mix(mix(texel_transmittance(r, corner), texel_transmittance(r, corner + vec2(1.0, 0.0)), f.x),
               mix(texel_transmittance(r, corner + vec2(0.0, 1.0)), texel_transmittance(r, corner + 1.0), f.x), f.y);
}

void main() {
    vec2 coordinate = camera_pixel(gl_FragCoord.xy);
    ivec2 pixel = ivec2(coordinate); // in the G-buffer
    float depth = texelFetch(gbuffer_depth, pixel, 0).r;
    out_visibility = vec4(0.0);
    if (depth == 0.0)
        return;
    vec4 normals = texelFetch(gbuffer_normal, pixel, 0);
    vec3 position = camera_position(coordinate, depth), shading = octahedral_decode(normals.xy);
    float weight = sample_weight(position, shading);
    if (weight <= 0.0)
        return;
    if (uniform_weights == 1)
        weight = 1.0;
    out_visibility = vec4(weight);
    int layer = light_layer(position);
    if (layer < 0 || light.casts_shadow == 0.0 || depth < 0.0)
        return;
    // A point of the light behind the surface itself lights nothing, whatever the shading normal says.
    vec3 geometric = octahedral_decode(normals.zw);
    vec3 to_light = LIGHT_TYPE == SUN ? -light.frame_z.xyz : light.position.xyz - position;
    if (dot(geometric, to_light) <= 0.0) {
        out_visibility.rgb = vec3(0.0);
        return;
    }
    receiver r = receiver_create(position, geometric, shading, layer);
    out_visibility.rgb *= transmittance(r, r.center);
}
