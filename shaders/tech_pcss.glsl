// SPDX-License-Identifier: GPL-3.0-or-later
// Percentage-closer soft shadows (Fernando 2005): blocker search, penumbra estimate, filter.
#include "common_min_max.glsl"
#include "common_taps.glsl"

uniform int p_search_reduction;
uniform int p_blocker_average;
const int AREA_AVERAGE = 0;

// Half sides of the rectangle that holds every tap.
vec2 technique_extent(receiver r) {
    vec2 depths;
    return kernel_extent(r, search_scale(r, p_search_reduction, depths)) + 1.0;
}

// Counts a texel that hides some point of the emitter: its offset must lie within the kernel of its own depth. Without
// this the search averages texels no ray to the light passes, such as a rising floor beside the receiver. A texel of
// the map covers the smaller a share of the emitter the wider the kernel of its depth; that share is its weight, so
// that a twig near the light does not outweigh the bowl that hides the light.
void search_tap(receiver r, vec2 offset, vec2 reach, inout vec2 sum) {
    float depth;
    if (!blocker_at(r, r.center + offset, depth))
        return;
    vec2 kernel = reach * kernel_scale(r, depth) + 1.0;
    if (all(lessThanEqual(abs(offset), kernel)))
        sum += vec2(depth, 1.0) / (p_blocker_average == AREA_AVERAGE ? kernel.x * kernel.y : 1.0);
}

float filter_tap(receiver r, vec2 offset) {
    float depth;
    return blocker_at(r, r.center + offset, depth) ? 1.0 : 0.0;
}

// The kernel at a scale, a texel wide at least, so that the edges of texels are smoothed.
mat2 kernel_at(receiver r, float scale) {
    vec2 u = r.kernel[0], v = r.kernel[1];
    float u_length = length(u), v_length = length(v);
    return mat2(u_length > 1e-30 ? u * max(scale, 0.5 / u_length) : vec2(0.5, 0.0),
                v_length > 1e-30 ? v * max(scale, 0.5 / v_length) : vec2(0.0, 0.5));
}

// Every stride-th pair of taps is enough for a kernel of few texels: two taps to a texel, and four to begin with.
int tap_stride(mat2 kernel, int count) {
    float texels = 4.0 * abs(kernel[0].x * kernel[1].y - kernel[0].y * kernel[1].x);
    return clamp(int(float(count) / (2.0 * texels + 4.0)), 1, (count + 1) / 2);
}

vec3 technique_visibility(receiver r) {
    vec2 depths;
    float scale = search_scale(r, p_search_reduction, depths);
    vec2 extent = kernel_extent(r, scale) + 1.0;
    receiver_set_bias(r, max(extent.x, extent.y));
    mat2 kernel = kernel_at(r, scale);
    vec2 reach = kernel_extent(r, 1.0);
    vec2 sum = vec2(0.0);
    search_tap(r, vec2(0.0), reach, sum);
    int stride = tap_stride(kernel, search_count);
    for (int i = 0; i < (search_count + 1) / 2; i += stride) {
        search_tap(r, kernel * search_taps[i].xy, reach, sum);
        search_tap(r, kernel * search_taps[i].zw, reach, sum);
    }
    if (sum.y == 0.0)
        return vec3(1.0);
    kernel = kernel_at(r, max(kernel_scale(r, sum.x / sum.y), 0.0));
    stride = tap_stride(kernel, filter_count);
    vec2 blocked = vec2(0.0);
    for (int i = 0; i < (filter_count + 1) / 2; i += stride)
        blocked += vec2(filter_tap(r, kernel * filter_taps[i].xy) + filter_tap(r, kernel * filter_taps[i].zw),
                        2 * i + 1 < filter_count ? 2.0 : 1.0);
    return vec3(1.0 - blocked.x / blocked.y);
}
