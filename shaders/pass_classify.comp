// SPDX-License-Identifier: GPL-3.0-or-later
// Tiles that are wholly lit or wholly in umbra by the bounding planes of the shadow map, with bounds of the tile's
// receivers in the place of one receiver's values. A decided tile has exactly the visibility that
// the technique would compute at each of its pixels.
#define WHOLE_TILES
#include "common_light.glsl"
#include "common_shadow.glsl"
#include "common_planes.glsl"
#include "common_tile.glsl"
#include "technique"

layout(local_size_x = 64) in;
uniform int tile_count;

layout(std430, binding = 1) writeonly buffer visibility_block {
    float tile_visibility[]; // 0, 1, or 0.5: undecided
};
layout(std430, binding = 5) readonly buffer tile_block {
    tile tiles[];
};

vec3 tile_corner(tile t, int corner) {
    return vec3((corner & 1) != 0 ? t.maximum.x : t.minimum.x, (corner & 2) != 0 ? t.maximum.y : t.minimum.y,
                (corner & 4) != 0 ? t.maximum.z : t.minimum.z);
}

// Whether light_reaches(position, geometric normal) fails at every point of the tile.
bool tile_faces_away(tile t) {
    vec3 normal = t.normal.xyz;
    float spread = t.normal.w;
    if (LIGHT_TYPE == SUN)
        return dot(normal, -light.frame_z.xyz) + spread <= -light.tan_half_angle;
    vec3 far_corner = max(abs(t.minimum.xyz - light.position.xyz), abs(t.maximum.xyz - light.position.xyz));
    float height = dot(normal, light.position.xyz) - t.minimum.w + spread * length(far_corner);
    if (LIGHT_TYPE == AREA) {
        vec3 u = light.half_u.xyz, v = light.half_v.xyz;
        return height + abs(dot(normal, u)) + abs(dot(normal, v)) + spread * (length(u) + length(v)) < 0.0;
    }
    return height < -light.emission.w;
}

// The layer that holds all of the tile, -1: no caster, -2: more than one layer.
int tile_layer(tile t) {
    int layer = light_layer(tile_corner(t, 0));
    for (int corner = 1; corner < 8; corner++)
        layer = light_layer(tile_corner(t, corner)) == layer ? layer : -2;
    return layer;
}

// Bounds of the tile in light space: q and depth.
struct region {
    vec3 minimum, maximum;
};

region tile_region(tile t, int layer) {
    region bounds = region(vec3(1e30), vec3(-1e30));
    for (int corner = 0; corner < 8; corner++) {
        vec3 p = (LIGHT_VIEW(layer).from_world * vec4(tile_corner(t, corner), 1.0)).xyz;
        vec3 q = is_perspective() ? vec3(p.xy / max(p.z, 1e-6), p.z) : p;
        bounds.minimum = min(bounds.minimum, q);
        bounds.maximum = max(bounds.maximum, q);
    }
    return bounds;
}

// No less, component by component, than emitter_axes of any receiver with such a q.
mat2 widest_axes(vec2 q, mat3 to_light) {
    if (LIGHT_TYPE == SUN)
        return mat2(light.tan_half_angle);
    if (LIGHT_TYPE != AREA)
        return light.emission.w * mat2(1.0 + q.x, q.y, 1.0 + q);
    vec3 u = abs(to_light * light.half_u.xyz), v = abs(to_light * light.half_v.xyz);
    return mat2(u.xy + q * u.z, v.xy + q * v.z);
}

// A receiver in the place of all: in the middle on the map, at the tile's greatest depth, with the widest kernel.
receiver tile_receiver(tile t, region bounds, int layer) {
    light_view view = LIGHT_VIEW(layer);
    mat3 to_light = mat3(view.from_world);
    vec2 middle = 0.5 * (bounds.minimum.xy + bounds.maximum.xy);
    receiver r = receiver_on_map(vec3(middle * (is_perspective() ? bounds.maximum.z : 1.0), bounds.maximum.z),
                                 to_light * t.normal.xyz, to_light * t.normal.xyz, layer);
    vec2 scale = view.rect.zw * vec2(r.map_size);
    mat2 axes = widest_axes(max(abs(bounds.minimum.xy), abs(bounds.maximum.xy)), to_light);
    r.kernel = mat2(axes[0] * scale, axes[1] * scale);
    r.spread = 0.5 * (bounds.maximum.xy - bounds.minimum.xy) * scale;
    return r;
}

// The cosine between the tile's normal and the rays of the light is no less than this anywhere.
float least_facing(receiver r, region bounds, float plane) {
    if (!is_perspective())
        return -r.normal.z;
    vec2 q = max(abs(bounds.minimum.xy), abs(bounds.maximum.xy));
    return -plane / (bounds.maximum.z * length(vec3(q, 1.0)));
}

// A receiver p has its own normal n beside the tile's m. The height dot(n, x - p) of a texel's point x, whose ray meets
// the tile's plane at a distance L of p, differs from dot(m, x - p) by |n - m| L at most where x is on the plane; below
// it by less, above it by up to |n - m| h / facing more. L is the texel's distance on the map over `facing`, and
// receiver_set_bias tolerates 5e-4 of the kernel's radius, which that distance does not exceed.
float classify_tile(tile t, region bounds, int layer) {
    receiver r = tile_receiver(t, bounds, layer);
    vec2 extent = technique_extent(r);
    float near = bounds.minimum.z, far = bounds.maximum.z;
    float rounding = 4e-6 * (r.depth_span + far);
    vec2 plane = vec2(t.minimum.w, t.maximum.w) + dot(r.normal, LIGHT_VIEW(layer).from_world[3].xyz);
    float facing = least_facing(r, bounds, plane.y);
    vec2 texel = r.texel_size * (is_perspective() ? vec2(near, far) : vec2(1.0));
    float radius = max(extent.x, extent.y) * texel.y;
    float doubt = 1.5 * t.normal.w / facing;
    if (!(facing > 0.0 && doubt < 0.1 && extent.x >= 0.0))
        return 0.5;
    // The least and the greatest bias that receiver_set_bias can have added.
    plane.x += 0.15 * texel.x - max(doubt - 5e-4, 0.0) * radius - rounding;
    plane.y += 1.2 * (1.3 * texel.y + (doubt + 5e-4) * radius) + rounding;
    return classify_region(r, extent, plane, vec2(far, near - rounding));
}

float known_visibility(tile t) {
    if (t.minimum.x > t.maximum.x)
        return 1.0;
    int layer = tile_layer(t);
    if (layer < 0)
        return layer == -1 ? 1.0 : 0.5;
    if (tile_faces_away(t))
        return 0.0;
    region bounds = tile_region(t, layer);
    if (is_perspective() && bounds.minimum.z < 1e-4 * bounds.maximum.z)
        return 0.5;
    return classify_tile(t, bounds, layer);
}

void main() {
    int i = int(gl_GlobalInvocationID.x);
    if (i < tile_count)
        tile_visibility[i] = known_visibility(tiles[i]);
}
