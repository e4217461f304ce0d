// SPDX-License-Identifier: GPL-3.0-or-later
// Sample points on the unit emitter, [-1, 1]^2 or the unit disk (sampling.h), two to a vec4.

layout(std140, binding = 2) uniform tap_block {
    vec4 search_taps[512];
    vec4 filter_taps[512];
};
uniform int search_count, filter_count; // points; an odd last half is far outside the map
