// SPDX-License-Identifier: GPL-3.0-or-later
// The emitter as a receiver weighs it, which is how REFERENCE does: each point s by the light that it brings to the
// shading normal. Points behind the surface itself are hidden, and the rest is a smaller emitter elsewhere.

struct seen_emitter {
    float share; // of the weight, before the surface itself
    // The uniform emitter with the mean and variance of that share:
    vec2 center; // in half axes of the emitter, as s in receiver.kernel
    vec2 scale;  // of the half axes
};

// Cosine at a normal times the distance of the point s: x + dot(yz, s).
vec3 horizon(receiver r, vec3 normal, vec3 u, vec3 v) {
    if (LIGHT_TYPE == SUN)
        return vec3(-normal.z, light.tan_half_angle * normal.xy);
    return vec3(-dot(normal, r.position), dot(normal, u), dot(normal, v));
}

// Relative change of 1 / d^4, the rest of the weight, per half axis. Not so much that a weight could be negative.
vec2 falloff(receiver r, vec3 u, vec3 v) {
    if (LIGHT_TYPE == SUN)
        return vec2(0.0);
    return clamp(4.0 * vec2(dot(r.position, u), dot(r.position, v)) / dot(r.position, r.position), -0.45, 0.45);
}

// The part of low..high in which p + b x is positive; empty if high <= low.
vec2 above(float p, float b, vec2 range) {
    if (abs(b) <= 1e-20)
        return p > 0.0 ? range : vec2(range.x);
    float edge = clamp(-p / b, range.x, range.y);
    return b > 0.0 ? vec2(edge, range.y) : vec2(range.x, edge);
}

// Integrals over x of (p + b x) (q + g x) times 1, x and x^2.
vec3 weighted_moments(vec2 pb, vec2 qg, vec2 range) {
    float l = range.x, h = range.y, l2 = l * l, h2 = h * h;
    vec4 powers = vec4(h - l, (h2 - l2) / 2.0, (h2 * h - l2 * l) / 3.0, (h2 * h2 - l2 * l2) / 4.0);
    float fifth = (h2 * h2 * h - l2 * l2 * l) / 5.0;
    vec3 c = vec3(pb.x * qg.x, pb.x * qg.y + pb.y * qg.x, pb.y * qg.y);
    return vec3(dot(c, powers.xyz), dot(c, powers.yzw), dot(c, vec3(powers.zw, fifth)));
}

// Exact along the axis on which the weight changes most, in rows along the other.
seen_emitter emitter_seen(receiver r) {
    vec3 u = vec3(0.0), v = vec3(0.0);
    if (LIGHT_TYPE != SUN)
        emitter_half_axes(r.position, mat3(LIGHT_VIEW(r.layer).from_world), u, v);
    vec3 weight = horizon(r, r.shading, u, v), facing = horizon(r, r.normal, u, v);
    vec2 fall = falloff(r, u, v);
    bool swapped = abs(weight.z) > abs(weight.y);
    weight = swapped ? weight.xzy : weight;
    facing = swapped ? facing.xzy : facing;
    fall = swapped ? fall.yx : fall;
    const int ROWS = 8;
    float whole = 0.0;
    vec3 sum = vec3(0.0);      // weight; weight times x and x^2
    vec2 sum_rows = vec2(0.0); // weight times t and t^2
    for (int i = 0; i < ROWS; i++) {
        float t = (2.0 * float(i) + 1.0) / float(ROWS) - 1.0, edge = ELLIPSE == 1 ? sqrt(1.0 - t * t) : 1.0;
        vec2 pb = vec2(weight.x + weight.z * t, weight.y), qg = vec2(1.0 + fall.y * t, fall.x);
        vec2 range = above(pb.x, pb.y, vec2(-edge, edge));
        whole += weighted_moments(pb, qg, range).x;
        vec3 row = weighted_moments(pb, qg, above(facing.x + facing.z * t, facing.y, range));
        sum += row;
        sum_rows += row.x * vec2(t, t * t + 1.0 / (3.0 * float(ROWS * ROWS)));
    }
    if (sum.x <= 0.0) // nothing arrives, or nothing would in any case
        return seen_emitter(whole > 0.0 ? 0.0 : 1.0, vec2(0.0), vec2(1.0));
    vec2 mean = vec2(sum.y, sum_rows.x) / sum.x;
    vec2 variance = vec2(sum.z, sum_rows.y) / sum.x - mean * mean;
    vec2 scale = sqrt(max((ELLIPSE == 1 ? 4.0 : 3.0) * variance, 1e-4));
    float share = sum.x / whole;
    return swapped ? seen_emitter(share, mean.yx, scale.yx) : seen_emitter(share, mean, scale);
}
