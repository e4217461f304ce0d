// SPDX-License-Identifier: GPL-3.0-or-later
// What every shadow-map technique needs: the receiver as the map sees it, and the test whether a texel blocks it.

uniform sampler2DArray shadow_map; // linear depth: 0 = near_depth, 1 = far_depth or nothing
uniform sampler2DArray min_max;    // pyramid of shadow_map: minimum, maximum; level 0 has half its size

// Map coordinates are in texels: texel i covers i .. i + 1.
struct receiver {
    vec3 position;    // light space of its view, metres
    vec3 normal;      // geometric, light space
    vec3 shading;     // the shading normal
    vec2 center;      // map coordinate
    vec2 spread;      // half sides, in texels, of the rectangle of receivers it stands for; 0 but in pass_classify.comp
    mat2 kernel;      // the emitter's half axes on the map, in texels per unit of kernel_scale
    vec2 slope;       // height of the receiver's tangent plane: is_blocker
    float level;
    float plane;      // what the height of a blocker must exceed
    float limit;      // light-space depth a blocker must be before
    float texel_size; // larger side of a texel in q
    // Its view, out of the uniform block once and not at every tap:
    int layer;
    uvec2 map_size;
    float near_depth, depth_span;
};

bool is_perspective() {
    return LIGHT_TYPE != SUN;
}

// Distance between blocker and receiver as the kernel's scale: the map offset of a blocker that hides the emitter point
// s is kernel * s * kernel_scale. Perspective: 1/z_b - 1/z_r; orthographic: z_r - z_b.
float kernel_scale(receiver r, float blocker_depth) {
    return is_perspective() ? 1.0 / blocker_depth - 1.0 / r.position.z : r.position.z - blocker_depth;
}

// Half sides, in texels, of the rectangle that holds the kernel at this scale.
vec2 kernel_extent(receiver r, float scale) {
    return (abs(r.kernel[0]) + abs(r.kernel[1])) * scale;
}

// The emitter's half axes in light space; not of a SUN.
void emitter_half_axes(vec3 position, mat3 to_light, out vec3 u, out vec3 v) {
    if (LIGHT_TYPE == AREA) {
        u = to_light * light.half_u.xyz;
        v = to_light * light.half_v.xyz;
    } else { // a disk that faces the receiver
        vec3 axis = normalize(position);
        u = light.emission.w * normalize(vec3(axis.z, 0.0, -axis.x));
        v = cross(axis, u);
    }
}

// The emitter's half axes in q. A tilted axis o moves the image of a blocker by o.xy - q o.z to first order.
mat2 emitter_axes(vec3 position, vec2 q, mat3 to_light) {
    if (LIGHT_TYPE == SUN)
        return mat2(light.tan_half_angle);
    vec3 u, v;
    emitter_half_axes(position, to_light, u, v);
    return mat2(u.xy - q * u.z, v.xy - q * v.z);
}

// Bias: a blocker must be nearer than the receiver and above its tangent plane. On a plane the map's texels lie in
// that plane exactly, because each is tested at its own centre; what must be tolerated is rounding, the error of the
// stored normal (16 bits: 2e-4 over the kernel), and the rise of a neighbouring facet of a curved surface within a
// texel, which grows with the slope. Where a smooth mesh is coarse its facets rise more: beside an edge, by the angle
// between them, which is twice that of the normals. kernel_radius: texels. The same in search and filter.
void receiver_set_bias(inout receiver r, float kernel_radius) {
    bool perspective = is_perspective();
    float scale = r.texel_size * (perspective ? r.position.z : 1.0);
    float facing = abs(perspective ? dot(r.normal, normalize(r.position)) : r.normal.z);
    float rounding = r.depth_span + abs(r.position.z);
    float rise = (0.15 + min(2.0 * length(r.normal - r.shading), 0.5)) / max(facing, 0.5);
    r.plane = dot(r.normal, r.position) + scale * (rise + 5e-4 * kernel_radius) + 2e-6 * rounding;
    r.limit = r.position.z - 1e-6 * rounding;
}

// A receiver of light-space position and normal, without its kernel.
receiver receiver_on_map(vec3 position, vec3 normal, vec3 shading, int layer) {
    receiver r;
    light_view view = LIGHT_VIEW(layer);
    r.layer = layer;
    r.map_size = uvec2(textureSize(shadow_map, 0).xy);
    r.near_depth = view.near_depth;
    r.depth_span = view.far_depth - view.near_depth;
    r.texel_size = view.texel;
    r.position = position;
    r.normal = normal;
    r.shading = shading;
    vec2 q = is_perspective() ? position.xy / position.z : position.xy;
    vec2 scale = view.rect.zw * vec2(r.map_size); // texels per unit of q
    r.center = (q - view.rect.xy) * scale;
    r.spread = vec2(0.0);
    // dot(normal.xy, q) at the centre of texel t is dot(slope, t) + level.
    r.slope = normal.xy / scale;
    r.level = dot(r.slope, vec2(0.5)) + dot(normal.xy, view.rect.xy) + (is_perspective() ? normal.z : 0.0);
    receiver_set_bias(r, 0.0);
    return r;
}

receiver receiver_create(vec3 world_position, vec3 geometric, vec3 shading, int layer) {
    light_view view = LIGHT_VIEW(layer);
    mat3 to_light = mat3(view.from_world);
    receiver r = receiver_on_map((view.from_world * vec4(world_position, 1.0)).xyz, to_light * geometric,
                                 to_light * shading, layer);
    vec2 q = is_perspective() ? r.position.xy / r.position.z : r.position.xy;
    vec2 scale = view.rect.zw * vec2(r.map_size);
    mat2 axes = emitter_axes(r.position, q, to_light);
    r.kernel = mat2(axes[0] * scale, axes[1] * scale);
    return r;
}

// Whether the surface at a texel, at this light-space depth, hides part of the emitter from the receiver.
bool is_blocker(receiver r, vec2 texel, float depth) {
    float height = dot(r.slope, texel) + r.level;
    height = is_perspective() ? height * depth : height + r.normal.z * depth;
    return depth < r.limit && height > r.plane;
}

// Light-space depth of the receiver's tangent plane at a map coordinate; far behind everything where it does not face
// the light there.
float tangent_depth(receiver r, vec2 coordinate) {
    float height = dot(r.slope, coordinate - 0.5) + r.level, level = dot(r.normal, r.position);
    bool faces = is_perspective() ? height < 0.0 : r.normal.z < 0.0;
    float depth = is_perspective() ? level / height : (level - height) / r.normal.z;
    return faces ? clamp(depth, r.near_depth - r.depth_span, r.near_depth + 4.0 * r.depth_span)
                 : r.near_depth + 4.0 * r.depth_span;
}

// Whether the texel at a map coordinate blocks the receiver, and its light-space depth. Nothing blocks outside the map:
// light_views_fit covers every caster that matters.
bool blocker_at(receiver r, vec2 coordinate, out float depth) {
    vec2 texel = floor(coordinate);
    ivec2 index = ivec2(texel);
    depth = r.near_depth + r.depth_span * texelFetch(shadow_map, ivec3(index, r.layer), 0).r;
    return all(lessThan(uvec2(index), r.map_size)) && is_blocker(r, texel, depth);
}

// Share of the four texels around a map coordinate that block the receiver, with bilinear weights.
float blocked_bilinear(receiver r, vec2 coordinate) {
    vec2 corner = coordinate - 0.5;
    vec2 f = fract(corner);
    float depth;
    bvec4 blocked = bvec4(blocker_at(r, corner, depth), blocker_at(r, corner + vec2(1.0, 0.0), depth),
                          blocker_at(r, corner + vec2(0.0, 1.0), depth), blocker_at(r, corner + 1.0, depth));
    vec4 b = vec4(blocked);
    return mix(mix(b.x, b.y, f.x), mix(b.z, b.w, f.x), f.y);
}
