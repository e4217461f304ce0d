// SPDX-License-Identifier: GPL-3.0-or-later
// Takes all places of buffers, so that the driver lets go of those it had there (fragment_lists_forget).
layout(local_size_x = 1) in;

layout(std430, binding = 0) buffer place_block {
    uint value;
} places[PLACES];

void main() {
    for (int i = 0; i < PLACES; i++)
        places[i].value = 0u;
}
