// SPDX-License-Identifier: GPL-3.0-or-later
// Image-space sub-sampling (core/passes/subsampling.c): which pixel a texel of coarse_visibility is, and what is in it.
// It has those with even full-image coordinates, so that what is interpolated does not depend on the crop.

uniform vec2 first_pixel; // lower left corner of the first such pixel, from the crop's

// Of a pass over coarse_visibility: the place in the crop.
vec2 subsampled_fragment() {
    return first_pixel + 2.0 * floor(gl_FragCoord.xy) + 0.5;
}

// What a texel holds of out_visibility: all of it, or where nothing is coloured one number, since interpolation fetches
// four texels a pixel: the visibility, -1 where the light does not reach.
#ifdef COLORED
#define COARSE vec4

vec4 coarse_encode(vec4 v) {
    return v;
}

vec4 coarse_decode(vec4 v) {
    return v;
}
#else
#define COARSE float

float coarse_encode(vec4 v) {
    return v.a > 0.0 ? v.r : -1.0;
}

vec4 coarse_decode(float v) {
    return v < 0.0 ? vec4(0.0) : vec4(vec3(v), 1.0);
}
#endif
