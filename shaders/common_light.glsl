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
    vec4 frame_x, frame_y, frame_z; // frame_z: direction of emission; frame_y.w: 1 = SPOT times the cosine to its axis
    vec4 half_u, half_v;         // AREA: half axes
    vec4 emission;               // rgb; w: radius of POINT and SPOT
    vec4 cone;                   // SPOT: cosine of the half angle, blend, scale of X and Y. AREA: x = tan(half spread)
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

vec3 in_light_frame(vec3 d) {
    return vec3(dot(d, light.frame_x.xyz), dot(d, light.frame_y.xyz), dot(d, light.frame_z.xyz));
}

// Map layer that holds a receiver, or -1 if no caster can shadow it.
int light_layer(vec3 position) {
#ifdef SINGLE_VIEW
    return light.faces_a.x;
#else
    vec3 local = in_light_frame(position - light.position.xyz), a = abs(local);
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

// Mean of smoothstep(0, 1, x) for x within s of t. Differences of integrals lose their digits where s is small.
float smooth_mean(float t, float s) {
    float near = clamp(t, -s, 1.0 + s);
    return s > 0.01 ? (smooth_integral(near + s) - smooth_integral(near - s)) / (2.0 * s) : smoothstep(0.0, 1.0, t);
}

// Cosine to a SPOT's axis of a vector in its frame, in the space that the light's scale makes.
float cone_cosine(vec3 d) {
    vec3 local = vec3(d.xy / light.cone.zw, d.z);
    return local.z * inversesqrt(max(dot(local, local), 1e-24));
}

// How the cosine grows with the vector.
vec3 cone_gradient(vec3 d, float cosine) {
    vec3 local = vec3(d.xy / light.cone.zw, d.z);
    float far = max(length(local), 1e-12);
    return vec3(-cosine * local.xy / (far * light.cone.zw), 1.0 - cosine * cosine) / far;
}

// At least how much the cosine to a point differs over a SPOT's bulb.
float cone_slack(vec3 d, vec3 gradient) {
    float bend = light.emission.w / min(min(light.cone.z, light.cone.w), 1.0);
    return 1.2 * light.emission.w * length(gradient) + bend * bend / dot(d, d);
}

// Whether any of a SPOT's light has a vector in its cone. No view of the map looks behind it.
bool cone_reaches(float cosine, float slack) {
    return cosine > 0.0 && cosine + slack > light.cone.x;
}

// Share of a SPOT's intensity in the direction of a point, with the smooth edge Blender draws. Each point of its bulb
// has a cone of its own: the edge is averaged over seven small disks in the bulb's, whose second moments are together
// those of the bulb, and over an interval in each, whose second moment is that of the small disk.
float light_cone(vec3 position) {
    vec3 d = in_light_frame(position - light.position.xyz);
    float c = cone_cosine(d), start = light.cone.x, radius = light.emission.w, edge = c > start ? 1.0 : 0.0;
    vec3 gradient = cone_gradient(d, c);
    float width = max((1.0 - start) * light.cone.y, radius > 0.0 ? 1e-4 : 0.0), slack = cone_slack(d, gradient);
    if (!cone_reaches(c, slack))
        return 0.0;
    if (radius > 0.0 && c - slack < start + width) {
        const vec2 places[7] = vec2[7](vec2(0.0), vec2(0.70710678, 0.0), vec2(-0.70710678, 0.0),
                                       vec2(0.35355339, 0.61237244), vec2(-0.35355339, 0.61237244),
                                       vec2(0.35355339, -0.61237244), vec2(-0.35355339, -0.61237244));
        vec3 across = radius / max(length(gradient), 1e-12) * gradient, along = cross(normalize(d), across);
        // The cosine grows with the sine of the same angle.
        float growth = 0.32732684 * radius * length(gradient) * inversesqrt(max(1.0 - c * c, 1e-12)) / width;
        edge = 0.0;
        for (int i = 0; i < 7; i++) {
            float cosine = cone_cosine(d - places[i].x * across - places[i].y * along);
            edge += smooth_mean((cosine - start) / width, growth * sqrt(max(1.0 - cosine * cosine, 0.0))) / 7.0;
        }
    } else if (width > 0.0)
        edge *= smoothstep(start, start + width, c);
    return light.frame_y.w != 0.0 ? edge * c : edge;
}

#ifdef SPREAD
// Share of an area light's radiance that leaves its grid towards a point: the slats hide the rest (Blender D10594).
// It is normalised so that the light's power stays what it is.
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
    vec3 d = in_light_frame(-to_light);
    float cosine = cone_cosine(d);
    if (LIGHT_TYPE == SPOT && !cone_reaches(cosine, cone_slack(d, cone_gradient(d, cosine))))
        return false;
    return dot(normal, to_light) > -light.emission.w;
}
