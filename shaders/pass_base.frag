// SPDX-License-Identifier: GPL-3.0-or-later
// What a sample adds before any light: ambient light or background, and the normal.
#include "common_camera.glsl"

uniform sampler2D gbuffer_depth, gbuffer_normal, gbuffer_color;
uniform vec4 world; // rgb; a: 0 = transparent film

layout(location = 0) out vec4 out_combined;
layout(location = 3) out vec4 out_normal;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    bool covered = texelFetch(gbuffer_depth, pixel, 0).r > 0.0;
    vec3 color = texelFetch(gbuffer_color, pixel, 0).rgb;
    out_combined = covered ? vec4(color * world.rgb, 1.0) : vec4(world.rgb * world.a, world.a);
    out_normal = covered ? vec4(octahedral_decode(texelFetch(gbuffer_normal, pixel, 0).xy), 1.0) : vec4(0.0);
}
