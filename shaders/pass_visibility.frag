// SPDX-License-Identifier: GPL-3.0-or-later
// Visibility of one light at every pixel, or every other one of both axes.
#ifdef EVERY_OTHER_PIXEL
#include "common_subsampling.glsl"
#endif
#include "common_visibility.glsl"

#ifdef EVERY_OTHER_PIXEL
layout(location = 0) out COARSE out_visibility;
#else
layout(location = 0) out vec4 out_visibility;
#endif

void main() {
#ifdef EVERY_OTHER_PIXEL
    out_visibility = coarse_encode(visibility_at(camera_pixel(subsampled_fragment())));
#else
    out_visibility = visibility_at(camera_pixel(gl_FragCoord.xy));
#endif
}
