// SPDX-License-Identifier: GPL-3.0-or-later
#include "common_camera.glsl"

// How far the map coordinate of a receiver moves from pixel to pixel, on the receiver's tangent plane.

// A pass over tiles has no pixel, and uses no footprint.
#ifdef WHOLE_TILES
const vec2 footprint_pixel = vec2(0.5);
#elif defined(EVERY_OTHER_PIXEL)
#define footprint_pixel subsampled_fragment()
#elif defined(LISTED_PIXELS)
#define footprint_pixel listed_fragment
#else
#define footprint_pixel gl_FragCoord.xy
#endif

// Map coordinate where the ray through a full-image coordinate meets the tangent plane.
vec2 footprint_point(receiver r, vec2 coordinate) {
    mat4 to_light = LIGHT_VIEW(r.layer).from_world;
    vec3 a = (to_light * vec4(camera_position(coordinate, 0.0), 1.0)).xyz;
    // Of the ray per metre along the camera's axis: a difference of points would lose its digits far from the light.
    vec3 direction = mat3(to_light) *
                     (camera.perspective != 0.0 ? camera_position(coordinate, 1.0) : -camera.axis_z.xyz);
    // Seen edge-on the ray leaves the plane; the footprint is then as long as it can get.
    float away = dot(r.normal, direction);
    away = abs(away) < 1e-6 ? -1e-6 : away;
    vec3 position = a + dot(r.normal, r.position - a) / away * direction;
    vec2 q = is_perspective() ? position.xy / max(position.z, 1e-6) : position.xy;
    return (q - LIGHT_VIEW(r.layer).rect.xy) * LIGHT_VIEW(r.layer).rect.zw * vec2(r.map_size);
}

// Columns: texels per pixel to the right and up.
mat2 receiver_footprint(receiver r) {
    vec2 coordinate = camera_pixel(footprint_pixel);
    // A tenth of a pixel: over a whole one a grazing ray may miss the plane.
    vec2 right = footprint_point(r, coordinate + vec2(0.1, 0.0)) - footprint_point(r, coordinate - vec2(0.1, 0.0));
    vec2 up = footprint_point(r, coordinate + vec2(0.0, 0.1)) - footprint_point(r, coordinate - vec2(0.0, 0.1));
    return mat2(right * 5.0, up * 5.0);
}
