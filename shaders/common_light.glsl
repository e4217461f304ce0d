// SPDX-License-Identifier: GPL-3.0-or-later
// One light and the views of its shadow maps (passes.h: struct light_block). Terms as in core/render/light.h.
// LIGHT_TYPE, ELLIPSE, SINGLE_VIEW and SPREAD come from light_defines() in visibility.c.

struct light_view {
    mat4 from_world;
    vec4 rect;     // lower left corner in q, 1 / extent
    float near_depth, far_depth;
    float perspective;
    float texel;   // larger side of a texel in q
};

layout(std140, binding = 1) uniform light_block {
    light_view views[6];
    vec4 position;               // emitter centre
    vec4 frame_x, frame_y, frame_z; // frame_z: direction of emission; frame_y.w: 1 = SPOT that falls with the cosine to its axis
    vec4 half_u, half_v;         // AREA: half axes
    vec4 emission;               // rgb; w: radius of POINT and SPOT
    vec4 cone;                   // SPOT: cosine of the half angle, blend, scale of X and Y. AREA: x = tangent of half the spread
    ivec4 faces_a, faces_b;      // map layer of the faces +Z +X -X +Y | -Y -Z, -1: none
    float tan_half_angle;        // SUN
    float casts_shadow;
    int view_count;
    float padding;
} light;

const int AREA = 0, POINT = 1, SPOT = 2, SUN = 3;
const float PI = 3.14159265;

#ifdef SINGLE_VIEW
#define LIGHT_VIEW(layer) light.views[0]
#else
#define LIGHT_VIEW(layer) light.views[layer]
#endif

// Map layer that holds a receiver, or -1 if no caster can shadow it.
int light_layer(vec3 position) {
#ifdef SINGLE_VIEW
    return light.faces_a.x;
#else
    vec3 d = position - light.position.xyz;
    vec3 local = vec3(dot(d, light.frame_x.xyz), dot(d, light.frame_y.xyz), dot(d, light.frame_z.xyz));
    vec3 a = abs(local);
    if (a.z >= a.x && a.z >= a.y)
        return local.z >= 0.0 ? light.faces_a.x : light.faces_b.y;
    if (a.x >= a.y)
        return local.x >= 0.0 ? light.faces_a.y : light.faces_a.z;
    return local.y >= 0.0 ? light.faces_a.w : light.faces_b.x;
#endif
}

// Integral of smoothstep(0, 1, t).
float smooth_integral(float t) {
    float inside = clamp(t, 0.0, 1.0);
    return inside * inside * inside * (1.0 - 0.5 * inside) + max(t - 1.0, 0.0);
}

// Share of a SPOT's intensity in the direction of a point, with the smooth edge Blender draws. Each point of its bulb has a
// cone of its own: the edge is averaged over two overlapping intervals, whose second and fourth moments are those of a disk.
float light_cone(vec3 position) {
    vec3 d = position - light.position.xyz;
    vec3 local = vec3(dot(d, light.frame_x.xyz) / light.cone.z, dot(d, light.frame_y.xyz) / light.cone.w,
                      dot(d, light.frame_z.xyz));
    float far = max(length(local), 1e-12);
    float c = local.z / far, radius = light.emission.w;
    float width = (1.0 - light.cone.x) * light.cone.y;
    width = radius > 0.0 ? max(width, 1e-4) : width;
    float edge = c > light.cone.x ? 1.0 : 0.0, spread = 0.0;
    float t = (c - light.cone.x) / max(width, 1e-12);
    if (radius > 0.0)
        spread = min(radius * length(vec3(c * local.xy / (far * light.cone.zw), 1.0 - c * c)) / (far * width), 1e3);
    if (c <= 0.0) // where no view of the map looks
        edge = 0.0;
    else if (spread > 0.01)
        edge = (smooth_integral(t + 0.978148 * spread) - smooth_integral(t - 0.669128 * spread) +
                smooth_integral(t + 0.669128 * spread) - smooth_integral(t - 0.978148 * spread)) / (3.294552 * spread);
    else if (width > 0.0)
        edge *= smoothstep(0.0, 1.0, t);
    return light.frame_y.w != 0.0 ? edge * max(c, 0.0) : edge;
}

#ifdef SPREAD
// Share of an area light's radiance that leaves its grid towards a point: the slats hide the rest (Blender D10594). It is
// normalised so that the light's power stays what it is.
float light_spread(vec3 to_light) {
    float facing = -dot(to_light, light.frame_z.xyz);
    float sine = length(cross(to_light, light.frame_z.xyz));
    float open = max(light.cone.x * facing - sine, 0.0) / max(facing, 1e-12);
    return facing > 0.0 ? open / (light.cone.x - atan(light.cone.x)) : 0.0;
}
#endif

// Whether any of the light can reach a surface point, were nothing in between. Never false where it can.
bool light_reaches(vec3 position, vec3 normal) {
    vec3 to_light = light.position.xyz - position;
    if (LIGHT_TYPE == SUN)
        return dot(normal, -light.frame_z.xyz) > -light.tan_half_angle;
    if (LIGHT_TYPE == AREA)
        return dot(to_light, light.frame_z.xyz) < 0.0 &&
               dot(normal, to_light) + abs(dot(normal, light.half_u.xyz)) + abs(dot(normal, light.half_v.xyz)) > 0.0;
    if (LIGHT_TYPE == SPOT && light_cone(position) <= 0.0)
        return false;
    return dot(normal, to_light) > -light.emission.w;
}
