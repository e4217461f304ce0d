// SPDX-License-Identifier: GPL-3.0-or-later
// Bounding box, in relative world space, of what the camera sees in each 16 x 16 tile. Light views are fitted to these.
#include "common_camera.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
uniform sampler2D gbuffer_depth;
uniform ivec2 tile_count;

struct box {
    float minimum[3], maximum[3]; // minimum > maximum: nothing seen
};
layout(std430, binding = 1) writeonly buffer box_block {
    box boxes[];
};

void main() {
    ivec2 tile = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(tile, tile_count)))
        return;
    ivec2 first = tile * 16, last = min(first + 16, textureSize(gbuffer_depth, 0));
    float nearest = 3.4e38, farthest = 0.0;
    for (int y = first.y; y < last.y; y++)
        for (int x = first.x; x < last.x; x++) {
            float depth = abs(texelFetch(gbuffer_depth, ivec2(x, y), 0).r);
            nearest = depth > 0.0 ? min(nearest, depth) : nearest;
            farthest = max(farthest, depth);
        }
    // The corners of the piece of the view the tile cuts out between these depths.
    vec3 minimum = vec3(3.4e38), maximum = vec3(-3.4e38);
    if (farthest > 0.0)
        for (int corner = 0; corner < 8; corner++) {
            vec2 pixel = vec2((corner & 1) != 0 ? last.x : first.x, (corner & 2) != 0 ? last.y : first.y);
            vec3 position = camera_position(pixel, (corner & 4) != 0 ? farthest : nearest);
            minimum = min(minimum, position);
            maximum = max(maximum, position);
        }
    int index = tile.y * tile_count.x + tile.x;
    boxes[index].minimum = float[3](minimum.x, minimum.y, minimum.z);
    boxes[index].maximum = float[3](maximum.x, maximum.y, maximum.z);
}
