// SPDX-License-Identifier: GPL-3.0-or-later
// Shadow mapping (Williams 1978): one texel decides.

vec3 technique_visibility(receiver r) {
    float depth;
    return vec3(blocker_at(r, r.center, depth) ? 0.0 : 1.0);
}
