// SPDX-License-Identifier: GPL-3.0-or-later
// Exponential shadow maps (Annen et al. 2008): visibility is the filtered e^(c z) times e^(-c d).
#include "common_exponential.glsl"
#include "common_footprint.glsl"
#include "common_min_max.glsl"

uniform sampler2DArray prefiltered_0; // e^(c t), convolved, with levels
uniform int p_prefilter, p_lookup, p_anisotropy, p_classification, p_fallback, p_contact, p_show_failures;
uniform float p_zmax_offset, p_epsilon;
const int LOOKUP_BILINEAR = 0, LOOKUP_MIP = 1, LOOKUP_ANISOTROPIC = 2;
const int CLASSIFY_NONE = 0, CLASSIFY_ZMAX = 1, CLASSIFY_THRESHOLD = 2;

// t of a light-space depth.
float receiver_depth(receiver r, float depth) {
    return exponential_depth((depth - r.near_depth) / r.depth_span);
}

// The ellipse of a pixel's footprint on the map.
struct ellipse {
    vec2 major;   // half the longer axis, texels
    float minor;  // length of the shorter axis, texels, at least 1
    float longer; // length of the longer axis, at least 1
};

// From the eigenvectors of J J^T: J maps the unit circle to an ellipse.
ellipse footprint_ellipse(mat2 j) {
    float a = dot(vec2(j[0].x, j[1].x), vec2(j[0].x, j[1].x)), b = dot(vec2(j[0].x, j[1].x), vec2(j[0].y, j[1].y));
    float c = dot(vec2(j[0].y, j[1].y), vec2(j[0].y, j[1].y));
    float mean = 0.5 * (a + c), spread = sqrt(0.25 * (a - c) * (a - c) + b * b);
    vec2 axis = abs(b) > 1e-12 ? vec2(mean + spread - c, b) : a >= c ? vec2(1.0, 0.0) : vec2(0.0, 1.0);
    ellipse e;
    e.longer = max(sqrt(mean + spread), 1.0);
    e.minor = max(sqrt(max(mean - spread, 0.0)), 1.0);
    e.major = normalize(axis) * 0.5 * e.longer;
    return e;
}

float look_up(receiver r, vec2 coordinate, float level) {
    return textureLod(prefiltered_0, vec3(coordinate / vec2(r.map_size), r.layer), level).r;
}

// Mean of e^(c t) over the footprint. Anisotropic: several round lookups along the longer axis.
float filtered(receiver r, ellipse e) {
    if (p_lookup == LOOKUP_BILINEAR)
        return look_up(r, r.center, 0.0);
    if (p_lookup == LOOKUP_MIP)
        return look_up(r, r.center, log2(e.longer));
    int count = clamp(int(ceil(e.longer / e.minor)), 1, p_anisotropy);
    float level = log2(max(e.minor, e.longer / float(count))), sum = 0.0;
    for (int i = 0; i < count; i++)
        sum += look_up(r, r.center + e.major * ((2.0 * float(i) + 1.0) / float(count) - 1.0), level);
    return sum / float(count);
}

// Texels that contribute, on both sides of the centre.
vec2 filter_extent(ellipse e) {
    float convolved = float(p_prefilter);
    if (p_lookup == LOOKUP_BILINEAR)
        return vec2(convolved + 0.5);
    if (p_lookup == LOOKUP_MIP)
        return vec2(convolved + 0.5 + 0.5 * e.longer);
    return convolved + 0.5 + abs(e.major) + 0.5 * e.minor;
}

// Exponent's growth from texel to texel, on the receiver's tangent plane.
vec2 exponent_slope(receiver r) {
    float along = is_perspective() ? dot(r.normal, r.position) / r.position.z : r.normal.z;
    vec2 change = r.slope * (is_perspective() ? r.position.z : 1.0) / max(-along, 1e-6);
    return p_c * change / ((1.0 - exponential_start) * r.depth_span);
}

// What convolution and linear interpolation make of the receiver's own plane. The exponential is convex, so that a
// slope comes out brighter than 1. Divided by this, slopes neither fail nor wash out. Levels add a little more.
float lit_value(receiver r, vec2 slope) {
    vec2 f = fract(r.center - 0.5);
    slope = clamp(slope, vec2(-1.0), vec2(1.0));
    vec2 value = mix(exp(-f * slope), exp((1.0 - f) * slope), f) * pow(cosh(0.5 * slope), vec2(2 * p_prefilter));
    return value.x * value.y;
}

// Failure classification (section 3.3): whether something behind the receiver is inside the filter, so that the
// exponential may exceed 1. Z_MAX compares with the farthest point of the receiver's tangent plane inside the filter:
// compared with the receiver itself, as in the paper, either all slopes fail or the offset hides real failures.
bool fails(receiver r, ellipse e, vec2 slope, float visibility) {
    float offset = p_zmax_offset * (1.0 - exponential_start) * r.depth_span;
    vec2 extent = filter_extent(e);
    vec4 covered = depth_range_cover(r, extent);
    vec2 farthest = mix(covered.xy, covered.zw, greaterThan(r.slope, vec2(0.0)));
    bool behind = depth_range(r, extent).y > tangent_depth(r, farthest) + offset;
    if (p_classification == CLASSIFY_NONE)
        return false;
    bool steep = max(abs(slope.x), abs(slope.y)) > 1.0; // the map is too coarse for it
    return steep || (p_classification == CLASSIFY_ZMAX ? behind : visibility > 1.0 + p_epsilon);
}

// What the exponential lets through the casters among the four texels around the receiver: they hide the light, however
// close they are.
float contact_leak(receiver r, float d) {
    vec2 corner = r.center - 0.5, f = fract(corner);
    float leak = 0.0;
    for (int i = 0; i < 4; i++) {
        vec2 at = vec2(i & 1, i >> 1), weight = mix(1.0 - f, f, at);
        float depth;
        if (blocker_at(r, corner + at, depth))
            leak += weight.x * weight.y * exp(p_c * (receiver_depth(r, depth) - d));
    }
    return leak;
}

vec3 technique_visibility(receiver r) {
    if (any(lessThan(r.center, vec2(0.0))) || any(greaterThanEqual(r.center, vec2(r.map_size))))
        return vec3(1.0);
    exponential_create(r.layer);
    ellipse e = footprint_ellipse(receiver_footprint(r));
    float d = receiver_depth(r, r.position.z);
    vec2 slope = exponent_slope(r);
    float visibility = exp(-p_c * d) * filtered(r, e) / lit_value(r, slope);
    bool failed = fails(r, e, slope, visibility);
    visibility = min(visibility, 1.0);
    if (failed && p_fallback == 1)
        visibility = 1.0 - blocked_bilinear(r, r.center);
    else if (p_contact == 1 && classify(r, filter_extent(e), depth_range(r, filter_extent(e))) < 1.0)
        visibility = max(visibility - contact_leak(r, d), 0.0);
    return failed && p_show_failures == 1 ? vec3(1.0, 0.3 * visibility, 0.0) : vec3(visibility);
}
