// SPDX-License-Identifier: GPL-3.0-or-later
// Percentage-closer soft shadows (Fernando 2005): blocker search, penumbra estimate, filter.
#include "common_min_max.glsl"
#include "common_taps.glsl"

uniform int p_search_reduction;
uniform int p_min_max;

// Scale of the search: the kernel of the nearest depth a blocker can have. Each step looks up the nearest depth inside
// the last rectangle, which can only shrink it (Guennebaud et al. 2006, section 4.2), and never loses a blocker.
float search_scale(receiver r) {
    float scale = max(kernel_scale(r, r.near_depth), 0.0);
    for (int i = 0; i < p_search_reduction; i++) {
        float nearest = depth_range(r, kernel_extent(r, scale) + r.texel).x;
        scale = clamp(kernel_scale(r, min(nearest, r.position.z)), 0.0, scale);
    }
    return scale;
}

void search_tap(receiver r, vec2 q, inout vec2 sum) {
    float depth;
    if (blocker_at(r, q, depth))
        sum += vec2(depth, 1.0);
}

float filter_tap(receiver r, vec2 q) {
    float depth;
    return float(blocker_at(r, q, depth));
}

vec3 technique_visibility(receiver r) {
    // Never narrower than two texels, so that the edges of texels are smoothed away.
    float scale = search_scale(r);
    mat2 kernel = r.kernel * scale;
    vec2 extent = kernel_extent(r, scale) + r.texel;
    receiver_set_bias(r, max(extent.x, extent.y));
    if (p_min_max == 1) {
        float known = classify(r, extent);
        if (known != 0.5)
            return vec3(known);
    }
    vec2 sum = vec2(0.0);
    for (int i = 0; i < (search_count + 1) / 2; i++) {
        vec4 s = search_taps[i];
        search_tap(r, r.q + kernel * s.xy + r.texel * s.xy, sum);
        search_tap(r, r.q + kernel * s.zw + r.texel * s.zw, sum);
    }
    if (sum.y == 0.0)
        return vec3(1.0);
    kernel = r.kernel * max(kernel_scale(r, sum.x / sum.y), 0.0);
    float blocked = 0.0;
    for (int i = 0; i < (filter_count + 1) / 2; i++) {
        vec4 s = filter_taps[i];
        blocked += filter_tap(r, r.q + kernel * s.xy + r.texel * s.xy);
        blocked += filter_tap(r, r.q + kernel * s.zw + r.texel * s.zw);
    }
    return vec3(1.0 - blocked / float(filter_count));
}
