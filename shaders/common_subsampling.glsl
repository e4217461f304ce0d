// SPDX-License-Identifier: GPL-3.0-or-later
// Image-space sub-sampling (core/passes/subsampling.c): which pixel a texel of coarse_visibility is. It has those with
// even full-image coordinates, so that what is interpolated does not depend on the crop.

uniform vec2 first_pixel; // lower left corner of the first such pixel, from the crop's

// Of a pass over coarse_visibility: the place in the crop.
vec2 subsampled_fragment() {
    return first_pixel + 2.0 * floor(gl_FragCoord.xy) + 0.5;
}
