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
    vec3 minimum = vec3(3.4e38), maximum = vec3(-3.4e38);
    ivec2 first = tile * 16, last = min(first + 16, textureSize(gbuffer_depth, 0));
    for (int y = first.y; y < last.y; y++)
        for (int x = first.x; x < last.x; x++) {
            float depth = texelFetch(gbuffer_depth, ivec2(x, y), 0).r;
            if (depth == 0.0)
                continue;
            vec3 position = camera_position(vec2(x, y) + 0.5, depth);
            minimum = min(minimum, position);
            maximum = max(maximum, position);
        }
    int index = tile.y * tile_count.x + tile.x;
    boxes[index].minimum = float[3](minimum.x, minimum.y, minimum.z);
    boxes[index].maximum = float[3](maximum.x, maximum.y, maximum.z);
}
