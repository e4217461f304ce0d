// SPDX-License-Identifier: GPL-3.0-or-later
// Each tile's bounds and plane for pass_classify.comp; and its nearest and farthest depth, since light views are fitted
// to what it may show.
#include "common_camera.glsl"
#include "common_tile.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
uniform sampler2D gbuffer_depth, gbuffer_normal;
uniform ivec2 tile_count;

layout(std430, binding = 1) writeonly buffer range_block {
    vec2 depths[]; // 0 at the far end: nothing seen
};
layout(std430, binding = 5) writeonly buffer tile_block {
    tile tiles[];
};

const float FAR = 3.4e38;

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(at, tile_count)))
        return;
    ivec2 first = at * TILE, last = min(first + TILE, textureSize(gbuffer_depth, 0));
    float nearest = FAR, farthest = 0.0;
    tile t = tile(vec4(FAR), vec4(-FAR), vec4(0.0, 0.0, 1.0, 0.0));
    t.normal.xyz = octahedral_decode(texelFetch(gbuffer_normal, (first + last) / 2, 0).zw);
    float deviation = 0.0; // squared
    for (int y = first.y; y < last.y; y++)
        for (int x = first.x; x < last.x; x++) {
            float depth = abs(texelFetch(gbuffer_depth, ivec2(x, y), 0).r);
            vec3 normal = octahedral_decode(texelFetch(gbuffer_normal, ivec2(x, y), 0).zw);
            vec3 difference = normal - t.normal.xyz;
            vec3 position = camera_position(vec2(x, y) + 0.5, depth), mean = camera_mean_position(position, normal);
            vec4 value = vec4(position, dot(t.normal.xyz, position)), other = vec4(mean, dot(t.normal.xyz, mean));
            bool seen = depth > 0.0;
            nearest = seen ? min(nearest, depth) : nearest;
            farthest = max(farthest, depth);
            t.minimum = seen ? min(t.minimum, min(value, other)) : t.minimum;
            t.maximum = seen ? max(t.maximum, max(value, other)) : t.maximum;
            deviation = seen ? max(deviation, dot(difference, difference)) : deviation;
        }
    t.normal.w = sqrt(deviation) + 1e-6;
    int index = at.y * tile_count.x + at.x;
    depths[index] = vec2(nearest, farthest);
    tiles[index] = t;
}
