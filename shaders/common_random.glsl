// SPDX-License-Identifier: GPL-3.0-or-later
// Random numbers in 0..1 that need no state (Jarzynski and Olano 2020, PCG).

uint hash(uint seed) {
    uint v = ((seed >> ((seed >> 28u) + 4u)) ^ seed) * 277803737u;
    return (v >> 22u) ^ v;
}

float random(uint seed) {
    return float(hash(seed)) / 4294967296.0;
}

// Owen's scrambling of the bits, from the lowest up (Laine and Karras 2011).
uint scramble(uint v, uint seed) {
    v += seed;
    v ^= v * 0x6c50b47cu;
    v ^= v * 0xb82f1e52u;
    v ^= v * 0xc7afe638u;
    v ^= v * 0x8d22f6e6u;
    return v;
}

// The sample with this index of a set that is stratified, and independent of the sets of other seeds: van der Corput's
// sequence, scrambled, and shuffled by the same scrambling (Burley 2020).
float stratified_random(uint index, uint seed) {
    uint a = hash(seed * 747796405u + 2891336453u), b = hash(a * 747796405u + 2891336453u);
    uint shuffled = bitfieldReverse(scramble(bitfieldReverse(index), a));
    return float(bitfieldReverse(scramble(shuffled, b)) >> 8u) / 16777216.0;
}

// Of a surface in a texel: another one for each that lies behind it.
float fragment_random(uvec2 texel, float depth) {
    return random(texel.x * 1664525u + texel.y * 22695477u + floatBitsToUint(depth) * 2654435761u + 1013904223u);
}
