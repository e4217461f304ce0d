// SPDX-License-Identifier: GPL-3.0-or-later
// One level of the min-max pyramid from the level below (or from the map): least and greatest of 2 x 2 texels.

layout(local_size_x = 8, local_size_y = 8) in;
layout(rg32f, binding = 0) uniform writeonly image2DArray target;
uniform sampler2DArray source;
uniform int source_level;
uniform int source_is_map; // 1: one channel

vec2 source_texel(ivec3 texel, ivec2 last) {
    vec2 t = texelFetch(source, ivec3(min(texel.xy, last), texel.z), source_level).rg;
    return source_is_map == 1 ? vec2(t.r < 1.0 ? t.r : 1.0) : t; // NaN counts as nothing there
}

void main() {
    ivec3 texel = ivec3(gl_GlobalInvocationID);
    if (any(greaterThanEqual(texel.xy, imageSize(target).xy)))
        return;
    ivec2 last = textureSize(source, source_level).xy - 1;
    ivec3 first = ivec3(texel.xy * 2, texel.z);
    vec2 a = source_texel(first, last), b = source_texel(first + ivec3(1, 0, 0), last);
    vec2 c = source_texel(first + ivec3(0, 1, 0), last), d = source_texel(first + ivec3(1, 1, 0), last);
    vec2 range = vec2(min(min(a.x, b.x), min(c.x, d.x)), max(max(a.y, b.y), max(c.y, d.y)));
    imageStore(target, texel, vec4(range, 0.0, 0.0));
}
