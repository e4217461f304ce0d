// SPDX-License-Identifier: GPL-3.0-or-later
// Depth as exponential shadow maps see it: t = 0 at the nearest caster, 1 at the farthest receiver.

uniform float p_c;
uniform int p_depth_range;
const int RANGE_MAP = 0, RANGE_BOUNDS = 1;

// Map depth of t = 0 in the layer of exponential_create. The far end needs no search: a view's far plane lies just
// behind the farthest receiver.
float exponential_start;

void exponential_create(int layer) {
    float nearest = texelFetch(min_max, ivec3(0, 0, layer), textureQueryLevels(min_max) - 1).r;
    exponential_start = p_depth_range == RANGE_BOUNDS ? 0.0 : min(nearest, 1.0 - 1e-6);
}

// Depth of a texel. NaN, which would spread over all sums and means, counts as nothing there. By its bits, since
// compilers may take comparisons for minima.
float clean_depth(float depth) {
    return floatBitsToUint(depth) < floatBitsToUint(1.0) ? depth : 1.0;
}

// t of a map depth.
float exponential_depth(float depth) {
    return (depth - exponential_start) / (1.0 - exponential_start);
}
