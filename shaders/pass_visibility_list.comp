// SPDX-License-Identifier: GPL-3.0-or-later
// Visibility of one light at the listed pixels: a pass over the image works on vectors of neighbours, of which it would
// throw away most.
layout(local_size_x = 64) in;

vec2 listed_fragment; // centre of this invocation's pixel, in the crop
#define LISTED_PIXELS

#include "common_pixel_list.glsl"
#include "common_visibility.glsl"

layout(binding = 0) writeonly uniform image2D visibility;

void main() {
    uint place = (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * 64u + gl_LocalInvocationIndex;
    if (place >= pixel_count)
        return;
    ivec2 pixel = listed_pixel(place);
    listed_fragment = vec2(pixel) + 0.5;
    imageStore(visibility, pixel, visibility_at(camera_pixel(listed_fragment)));
}
