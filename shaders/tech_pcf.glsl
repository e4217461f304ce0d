// SPDX-License-Identifier: GPL-3.0-or-later
// Percentage-closer filtering (Reeves, Salesin, Cook 1987): the share of unblocked texels in a square of fixed size.

uniform float p_kernel_width; // texels
uniform int p_samples;        // per side

vec3 technique_visibility(receiver r) {
    receiver_set_bias(r, 0.5 * p_kernel_width);
    float blocked = 0.0;
    for (int y = 0; y < p_samples; y++)
        for (int x = 0; x < p_samples; x++) {
            vec2 s = (vec2(x, y) + 0.5) / float(p_samples) - 0.5;
            blocked += blocked_bilinear(r, r.center + p_kernel_width * s);
        }
    return vec3(1.0 - blocked / float(p_samples * p_samples));
}
