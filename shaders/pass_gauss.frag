// SPDX-License-Identifier: GPL-3.0-or-later
// One axis of a Gaussian of 3, 5 or 7 texels, with the binomial weights 1 2 1, 1 4 6 4 1 or 1 6 15 20 15 6 1.

uniform sampler2DArray source;
uniform int layer, radius, vertical;

layout(location = 0) out vec4 out_value;

void main() {
    ivec2 texel = ivec2(gl_FragCoord.xy), last = textureSize(source, 0).xy - 1;
    ivec2 step = vertical == 1 ? ivec2(0, 1) : ivec2(1, 0);
    float weight = exp2(-2.0 * float(radius)); // normalised: the values may be close to the greatest float
    out_value = vec4(0.0);
    for (int i = -radius; i <= radius; i++) {
        out_value += weight * texelFetch(source, ivec3(clamp(texel + i * step, ivec2(0), last), layer), 0);
        weight *= float(radius - i) / float(radius + i + 1);
    }
}
