// SPDX-License-Identifier: GPL-3.0-or-later
// Random numbers in 0..1 that need no state (Jarzynski and Olano 2020, PCG).

float random(uint seed) {
    uint v = ((seed >> ((seed >> 28u) + 4u)) ^ seed) * 277803737u;
    return float((v >> 22u) ^ v) / 4294967296.0;
}

// Of a pixel of the full image.
float pixel_random(uvec2 pixel) {
    return random(pixel.x * 1664525u + pixel.y * 22695477u + 1013904223u);
}

// Of a surface in a texel: another one for each that lies behind it.
float fragment_random(uvec2 texel, float depth) {
    return random(texel.x * 1664525u + texel.y * 22695477u + floatBitsToUint(depth) * 2654435761u + 1013904223u);
}
