// SPDX-License-Identifier: GPL-3.0-or-later
// What every shadow-map technique needs: the receiver as the map sees it, and the test whether a texel blocks it.

uniform sampler2DArray shadow_map; // linear depth: 0 = near_depth, 1 = far_depth or nothing
uniform sampler2DArray min_max;    // pyramid of shadow_map: minimum, maximum; level 0 has half its size

struct receiver {
    vec3 position;   // light space of its view, metres
    vec3 normal;     // geometric, light space
    vec2 q;          // map coordinate
    mat2 kernel;     // half axes of the emitter as seen from the receiver, on the plane of the map
    float plane;     // dot(normal, point) of the points a blocker must be above
    float limit;     // light-space depth a blocker must be before
    // Its view, out of the uniform block once and not at every tap:
    int layer;
    vec2 scale, offset; // q * scale + offset = texel coordinate in the map
    vec2 texel;         // size of a texel in q
    vec2 map_size;      // texels
    float near_depth, depth_span;
};

bool is_perspective() {
    return light_type() != SUN;
}

// Distance between blocker and receiver as the kernel's scale: the offset in q of a blocker that hides the emitter
// point s is kernel * s * kernel_scale. Perspective: 1/z_b - 1/z_r; orthographic: z_r - z_b.
float kernel_scale(receiver r, float blocker_depth) {
    return is_perspective() ? 1.0 / blocker_depth - 1.0 / r.position.z : r.position.z - blocker_depth;
}

// Half extent in q of the rectangle that holds the kernel at this scale.
vec2 kernel_extent(receiver r, float scale) {
    return (abs(r.kernel[0]) + abs(r.kernel[1])) * scale;
}

// The emitter's half axes on the map plane. A tilted axis o moves the image of a blocker by o.xy - q o.z to first order.
mat2 receiver_kernel(receiver r, mat3 to_light) {
    if (light_type() == SUN)
        return mat2(light.tan_half_angle);
    vec3 u, v;
    if (light_type() == AREA) {
        u = to_light * light.half_u.xyz;
        v = to_light * light.half_v.xyz;
    } else { // a disk that faces the receiver
        vec3 axis = normalize(r.position);
        u = light.emission.w * normalize(vec3(axis.z, 0.0, -axis.x));
        v = cross(axis, u);
    }
    return mat2(u.xy - r.q * u.z, v.xy - r.q * v.z);
}

// Bias: a blocker must be nearer than the receiver and above its tangent plane. On a plane the map's texels lie in
// that plane exactly, because each is tested at its own centre, so only rounding remains to be tolerated. The tolerance
// grows with the kernel, since the plane's slope is known to about 2e-4 (16-bit normals), and is the same in search and
// filter.
void receiver_set_bias(inout receiver r, float kernel_radius) {
    float scale = is_perspective() ? r.position.z : 1.0;
    float rounding = r.depth_span + abs(r.position.z);
    float tolerance = scale * (0.02 * max(r.texel.x, r.texel.y) + 5e-4 * kernel_radius) + 2e-6 * rounding;
    r.plane = dot(r.normal, r.position) + tolerance;
    r.limit = r.position.z - 1e-6 * rounding;
}

receiver receiver_create(vec3 world_position, vec3 world_normal, int layer) {
    receiver r;
    light_view view = light.views[layer];
    r.layer = layer;
    vec2 size = vec2(textureSize(shadow_map, 0).xy);
    r.map_size = size;
    r.scale = view.rect.zw * size;
    r.offset = -view.rect.xy * r.scale;
    r.texel = 1.0 / r.scale;
    r.near_depth = view.near_depth;
    r.depth_span = view.far_depth - view.near_depth;
    r.position = (view.from_world * vec4(world_position, 1.0)).xyz;
    r.normal = mat3(view.from_world) * world_normal;
    r.q = is_perspective() ? r.position.xy / r.position.z : r.position.xy;
    r.kernel = receiver_kernel(r, mat3(view.from_world));
    receiver_set_bias(r, 0.0);
    return r;
}

// Whether the surface at q, at this light-space depth, hides part of the emitter from the receiver.
bool is_blocker(receiver r, vec2 q, float depth) {
    float height = dot(r.normal.xy, q);
    height = is_perspective() ? (height + r.normal.z) * depth : height + r.normal.z * depth;
    return depth < r.limit && height > r.plane;
}

// Whether the texel that holds q blocks the receiver, and its light-space depth. Nothing blocks outside the map:
// light_views_fit covers every caster that matters.
bool blocker_at(receiver r, vec2 q, out float depth) {
    vec2 texel = floor(q * r.scale + r.offset);
    depth = r.near_depth + r.depth_span * texelFetch(shadow_map, ivec3(ivec2(texel), r.layer), 0).r;
    bool inside = all(lessThan(abs(texel + 0.5 - 0.5 * r.map_size), 0.5 * r.map_size));
    return inside && is_blocker(r, (texel + 0.5 - r.offset) * r.texel, depth);
}

// Share of the four texels around q that block the receiver, with bilinear weights.
float blocked_bilinear(receiver r, vec2 q) {
    vec2 f = fract(q * r.scale + r.offset - 0.5);
    vec2 corner = q - 0.5 * r.texel;
    float depth;
    vec4 blocked = vec4(blocker_at(r, corner, depth), blocker_at(r, corner + vec2(r.texel.x, 0.0), depth),
                        blocker_at(r, corner + vec2(0.0, r.texel.y), depth), blocker_at(r, corner + r.texel, depth));
    return mix(mix(blocked.x, blocked.y, f.x), mix(blocked.z, blocked.w, f.x), f.y);
}
