// SPDX-License-Identifier: GPL-3.0-or-later
// Visibility between every other pixel (Selgrad et al. 2015, section 8), where the two or four around a pixel show the
// surface that it shows, in much the same light. Other pixels are listed, and drawn by the technique.
// Output: as pass_visibility.frag.
#include "common_subsampling.glsl"
#include "common_pixel_list.glsl"
#include "common_camera.glsl"
#include "common_steady.glsl"
#include "common_light.glsl"

uniform sampler2D gbuffer_depth, gbuffer_normal;
uniform sampler2D coarse_visibility;

layout(location = 0) out vec4 out_visibility;

// Visibilities that differ by more have an edge between them; surfaces whose visibility hardly differs need not be told
// apart by their normals, too.
const float MOST_DIFFERENCE = 0.1;
// How far a neighbour may lie from the pixel's plane, in pixels.
const float MOST_DISTANCE = 1.0;

bool differ(COARSE least, COARSE most) {
    return any(greaterThan(vec4(most - least), vec4(MOST_DIFFERENCE)));
}

vec3 position_at(ivec2 pixel, float depth) {
    return camera_position(vec2(pixel) + 0.5, depth);
}

void main() {
    ivec2 place = ivec2(gl_FragCoord.xy) - ivec2(first_pixel), odd = place & 1;
    ivec2 pixel = ivec2(camera_pixel(gl_FragCoord.xy)), size = ivec2(camera.image.xy);
    float own_depth = texelFetch(gbuffer_depth, pixel, 0).r;
    vec3 normal = octahedral_decode(texelFetch(gbuffer_normal, pixel, 0).zw), own = position_at(pixel, own_depth);
    float most_distance = MOST_DISTANCE * pixel_width(own);
    COARSE least = COARSE(1.0), most = COARSE(-1.0), sum = COARSE(0.0);
    bool same = true;
    for (int i = 0; i < 4; i++) {
        ivec2 side = ivec2(i & 1, i >> 1), other = pixel - odd + 2 * side * odd;
        float depth = texelFetch(gbuffer_depth, other, 0).r;
        COARSE v = COARSE(texelFetch(coarse_visibility, (place >> 1) + side * odd, 0));
        same = same && all(lessThan(other, size)) && sign(depth) == sign(own_depth) &&
               abs(dot(normal, position_at(other, depth) - own)) <= most_distance;
        least = min(least, v);
        most = max(most, v);
        sum += 0.25 * v;
    }
    if (odd != ivec2(0) && own_depth != 0.0 && (!same || differ(least, most))) {
        list_pixel(ivec2(gl_FragCoord.xy));
        discard;
    }
    out_visibility = own_depth != 0.0 ? coarse_decode(sum) : vec4(0.0);
}
