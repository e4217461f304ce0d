// SPDX-License-Identifier: GPL-3.0-or-later
// One image of the job from the sums over the samples, packed as the host gets it, for a band of rows.
// Exactly one of COMBINED, DEPTH, NORMAL, SHADOW, LIGHT_SHADOW is defined.

layout(local_size_x = 16, local_size_y = 4) in;
uniform sampler2D source, divisor; // divisor: SHADOW only
#ifdef CATCHER
uniform sampler2D caught, uncaught;
uniform vec4 world;                // rgb; a: 0 = transparent film
#endif
uniform ivec2 band;                // first row and number of rows
uniform ivec2 corner;              // of the crop in the source
uniform int width;                 // of the crop
uniform float sample_weight;       // 1 / samples in the sums
layout(std430, binding = 1) writeonly buffer pixel_block {
    float pixels[];
};

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (pixel.x >= width || pixel.y >= band.y)
        return;
    int index = pixel.y * width + pixel.x;
    vec4 sum = texelFetch(source, corner + ivec2(pixel.x, pixel.y + band.x), 0);
#if defined(COMBINED)
    sum *= sample_weight;
#ifdef CATCHER
    // The background as dark as the shadow on the catcher, or the shadow's alpha.
    vec4 with = texelFetch(caught, ivec2(pixel.x, pixel.y + band.x), 0);
    vec3 without = texelFetch(uncaught, ivec2(pixel.x, pixel.y + band.x), 0).rgb;
    vec3 light = mix(vec3(1.0), with.rgb / max(without, vec3(1e-30)), greaterThan(without, vec3(0.0)));
    float coverage = with.a * sample_weight;
    sum += coverage * (world.a != 0.0 ? vec4(world.rgb * light, 1.0) : vec4(vec3(0.0), 1.0 - dot(light, vec3(1.0 / 3.0))));
#endif
    pixels[4 * index] = sum.r;
    pixels[4 * index + 1] = sum.g;
    pixels[4 * index + 2] = sum.b;
    pixels[4 * index + 3] = sum.a;
#elif defined(DEPTH)
    pixels[index] = sum.r != 0.0 ? abs(sum.r) : 1e10; // Blender's value where there is nothing
#else
#if defined(NORMAL)
    vec3 value = dot(sum.rgb, sum.rgb) > 0.0 ? normalize(sum.rgb) : vec3(0.0);
#elif defined(SHADOW)
    vec3 lit = texelFetch(divisor, ivec2(pixel.x, pixel.y + band.x), 0).rgb;
    vec3 value = mix(vec3(1.0), sum.rgb / max(lit, vec3(1e-30)), greaterThan(lit, vec3(0.0)));
#elif defined(LIGHT_SHADOW)
    vec3 value = sum.rgb * sample_weight;
#endif
    pixels[3 * index] = value.r;
    pixels[3 * index + 1] = value.g;
    pixels[3 * index + 2] = value.b;
#endif
}
