// SPDX-License-Identifier: GPL-3.0-or-later
// Exact unshadowed irradiance of a diffuse surface point, W/m2 per unit of emission.

// Angle over its sine, from its cosine: on the acute side a polynomial in Chebyshev's sense, within 6e-7, for an arc
// tangent takes four times as long; `sine` at least avoids dividing by less.
float angle_over_sine(float cosine, float sine) {
    float x = abs(cosine);
    float acute = 1.5707955 + x * (-0.99990356 + x * (0.7832979 + x * (-0.64862698 + x * (0.5090546 +
                  x * (-0.32393202 + x * (0.13595128 + x * -0.026637152))))));
    return cosine < 0.0 ? PI * inversesqrt(max(1.0 - x * x, sine * sine)) - acute : acute;
}

// Angle of one edge, between unit vectors, times its normal's height: one term of Lambert's polygon formula (1760).
float edge_term(vec3 a, vec3 b) {
    float height = a.x * b.y - a.y * b.x;
    return height * angle_over_sine(dot(a, b), max(abs(height), 1e-6));
}

vec3 unit(vec3 v) {
    return v * inversesqrt(max(dot(v, v), 1e-30));
}

// Sum of the edge terms of a convex polygon of unit vectors, cut at the horizon z = 0 while it is walked round.
struct polygon_walk {
    vec3 entry, leave; // where the outline crosses the horizon upwards and downwards
    float sum;
    bool crosses;
};

void polygon_edge(inout polygon_walk walk, vec3 a, vec3 b) {
    bool a_above = a.z > 0.0, b_above = b.z > 0.0;
    if (!a_above && !b_above)
        return;
    vec3 crossing = unit(vec3(mix(a.xy, b.xy, a_above == b_above ? 0.0 : a.z / (a.z - b.z)), 0.0));
    walk.sum += edge_term(a_above ? a : crossing, b_above ? b : crossing);
    if (a_above == b_above)
        return;
    walk.crosses = true;
    if (a_above)
        walk.leave = crossing;
    else
        walk.entry = crossing;
}

// Form factor times pi of a rectangle or ellipse. A 16-gon of the ellipse's area stands for it: within 0.3 %.
float area_integral(vec3 center, vec3 u, vec3 v) {
    polygon_walk walk = polygon_walk(vec3(0.0), vec3(0.0), 0.0, false);
    if (ELLIPSE == 1) {
        const float step_cos = 0.92387953, step_sin = 0.38268343, grow = 1.01298903;
        vec2 direction = vec2(grow, 0.0);
        vec3 a = unit(center + direction.x * u);
        for (int i = 0; i < 16; i++) {
            direction = vec2(direction.x * step_cos - direction.y * step_sin,
                             direction.x * step_sin + direction.y * step_cos);
            vec3 b = unit(center + direction.x * u + direction.y * v);
            polygon_edge(walk, a, b);
            a = b;
        }
    } else {
        vec3 corners[4] = vec3[](unit(center + u + v), unit(center - u + v), unit(center - u - v),
                                 unit(center + u - v));
        for (int i = 0; i < 4; i++)
            polygon_edge(walk, corners[i], corners[(i + 1) & 3]);
    }
    if (walk.crosses)
        walk.sum += edge_term(walk.leave, walk.entry);
    return 0.5 * abs(walk.sum);
}

#ifdef SPREAD
// By midpoints over the part of the emitter that shines this way, row by row: no closed form is known.
float area_irradiance(vec3 position, vec3 normal) {
    vec3 to_light = light.position.xyz - position;
    float facing = -dot(to_light, light.frame_z.xyz);
    vec3 u = light.half_u.xyz, v = light.half_v.xyz;
    vec2 foot = -vec2(dot(to_light, u) / dot(u, u), dot(to_light, v) / dot(v, v)); // of the point, in half axes
    vec2 reach = facing * light.cone.x * vec2(inversesqrt(dot(u, u)), inversesqrt(dot(v, v)));
    float low = max(foot.y - reach.y, -1.0), high = min(foot.y + reach.y, 1.0);
    if (facing <= 0.0 || low >= high)
        return 0.0;
    const int STEPS = 16;
    float sum = 0.0;
    for (int i = 0; i < STEPS; i++) {
        float y = mix(low, high, (float(i) + 0.5) / float(STEPS)), across = (y - foot.y) / reach.y;
        float lit = reach.x * sqrt(max(1.0 - across * across, 0.0)), outline = ELLIPSE == 1 ? sqrt(1.0 - y * y) : 1.0;
        float left = max(foot.x - lit, -outline), right = min(foot.x + lit, outline);
        for (int j = 0; j < STEPS && left < right; j++) {
            vec3 l = to_light + mix(left, right, (float(j) + 0.5) / float(STEPS)) * u + y * v;
            float d2 = dot(l, l);
            sum += (right - left) * light_spread(l) * max(dot(normal, l), 0.0) * facing / (d2 * d2);
        }
    }
    return sum * (high - low) / float(STEPS * STEPS) * length(cross(u, v));
}
#else
float area_irradiance(vec3 position, vec3 normal) {
    vec3 to_light = light.position.xyz - position;
    float d2 = dot(to_light, to_light);
    float facing = -dot(to_light, light.frame_z.xyz);
    if (facing <= 0.0)
        return 0.0;
    vec3 u = light.half_u.xyz, v = light.half_v.xyz;
    // Far and small: the polygon formula would lose its digits, the point formula is good to 1e-4.
    if (dot(u, u) + dot(v, v) < 1e-4 * d2) {
        float area = length(cross(u, v)) * (ELLIPSE == 1 ? PI : 4.0);
        return area * facing * max(dot(normal, to_light), 0.0) / (d2 * d2);
    }
    vec3 x = normalize(abs(normal.z) < 0.9 ? vec3(normal.y, -normal.x, 0.0) : vec3(0.0, normal.z, -normal.y));
    mat3 local = transpose(mat3(x, cross(normal, x), normal));
    return area_integral(local * to_light, local * u, local * v);
}
#endif

// Irradiance of a cone of directions over pi sin^2(half angle), cut at the horizon (Snyder 1996).
float cap_factor(float cos_theta, float sin2_sigma) {
    if (cos_theta * cos_theta >= sin2_sigma)
        return max(cos_theta, 0.0);
    float sin_theta = sqrt(1.0 - cos_theta * cos_theta);
    float x = sqrt(1.0 / sin2_sigma - 1.0);
    float y = clamp(-x * cos_theta / sin_theta, -1.0, 1.0);
    float s = sin_theta * sqrt(1.0 - y * y);
    float integral = (cos_theta * acos(y) - x * s) * sin2_sigma + atan(s, x);
    return max(integral, 0.0) / (PI * sin2_sigma);
}

// Irradiance for emission 1.
float light_irradiance(vec3 position, vec3 normal) {
    if (LIGHT_TYPE == AREA)
        return area_irradiance(position, normal);
    if (LIGHT_TYPE == SUN) {
        float t2 = light.tan_half_angle * light.tan_half_angle;
        return cap_factor(dot(normal, -light.frame_z.xyz), t2 / (1.0 + t2));
    }
    vec3 to_light = light.position.xyz - position;
    float d2 = max(dot(to_light, to_light), 1e-12);
    float r2 = light.emission.w * light.emission.w;
    // The emitter is a disk that faces the point: it fills a cone of sin^2 = r2 / (r2 + d2).
    float irradiance = cap_factor(dot(normal, to_light) * inversesqrt(d2), r2 / (r2 + d2)) / (r2 + d2);
    return LIGHT_TYPE == SPOT ? irradiance * light_cone(position) : irradiance;
}
