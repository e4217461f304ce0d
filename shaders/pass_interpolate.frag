// SPDX-License-Identifier: GPL-3.0-or-later
// Visibility between every other pixel (Selgrad et al. 2015, section 8), where the two or four around a pixel show the
// surface that it shows, in much the same light. Other pixels are discarded, and drawn by the technique.
// Output: as pass_visibility.frag.
#include "common_subsampling.glsl"
#include "common_camera.glsl"
#include "common_steady.glsl"
#include "common_light.glsl"

uniform sampler2D gbuffer_depth, gbuffer_normal;
uniform sampler2D coarse_visibility;

layout(location = 0) out vec4 out_visibility;

// Visibilities that differ by more have an edge between them.
const float MOST_DIFFERENCE = 0.1;
// Of the geometric normals of one smooth surface, as a cosine; and how far apart their planes may lie, in pixels.
const float LEAST_COSINE = 0.98, MOST_DISTANCE = 1.0;

struct surface {
    float depth; // as in the G-buffer
    vec3 position, geometric;
};

surface surface_at(ivec2 pixel) {
    surface s;
    s.depth = texelFetch(gbuffer_depth, pixel, 0).r;
    s.geometric = octahedral_decode(texelFetch(gbuffer_normal, pixel, 0).zw);
    s.position = camera_position(vec2(pixel) + 0.5, s.depth);
    return s;
}

bool is_same(surface a, surface b) {
    return sign(a.depth) == sign(b.depth) && dot(a.geometric, b.geometric) >= LEAST_COSINE &&
           abs(dot(a.geometric, b.position - a.position)) <= MOST_DISTANCE * pixel_width(a.position);
}

void main() {
    ivec2 place = ivec2(gl_FragCoord.xy) - ivec2(first_pixel), odd = place & 1;
    ivec2 pixel = ivec2(camera_pixel(gl_FragCoord.xy)), size = ivec2(camera.image.xy);
    surface own = surface_at(pixel);
    vec4 least = vec4(1.0), most = vec4(0.0), sum = vec4(0.0);
    bool same = true;
    for (int i = 0; i < 4; i++) {
        ivec2 side = ivec2(i & 1, i >> 1), other = pixel - odd + 2 * side * odd;
        vec4 v = texelFetch(coarse_visibility, (place >> 1) + side * odd, 0);
        same = same && all(lessThan(other, size)) && is_same(own, surface_at(other));
        least = min(least, v);
        most = max(most, v);
        sum += 0.25 * v;
    }
    if (odd != ivec2(0) && own.depth != 0.0 && (!same || any(greaterThan(most - least, vec4(MOST_DIFFERENCE)))))
        discard;
    out_visibility = own.depth != 0.0 ? sum : vec4(0.0);
}
