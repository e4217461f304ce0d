// SPDX-License-Identifier: GPL-3.0-or-later
// Fragment lists (core/passes/fragment_lists.c): for every texel of a light's views, what casts shadows there, in order
// of its light-space depth, with its opacity: 1 - transmittance, a number or, with COLORED, one for each channel.

#ifdef COLORED
#define OPACITY vec3
const uint FRAGMENT_WORDS = 3u;
#else
#define OPACITY float
const uint FRAGMENT_WORDS = 2u;
#endif

layout(std430, binding = 2) buffer head_block {
    uint heads[]; // two for each texel: first fragment, number of fragments
};
layout(std430, binding = 3) buffer fragment_block {
    uint fragments[]; // depth and opacity, FRAGMENT_WORDS for each
};

#ifdef SPLIT_FRAGMENTS
// More than one block may hold: the following ones.
layout(std430, binding = 6) buffer fragment_block_1 {
    uint fragments_1[];
};
layout(std430, binding = 7) buffer fragment_block_2 {
    uint fragments_2[];
};
layout(std430, binding = 0) buffer fragment_block_3 {
    uint fragments_3[];
};
uniform int fragment_block_shift; // words of a block: 2 to this

uint fragment_word(uint place) {
    uint block = place >> fragment_block_shift, i = place - (block << fragment_block_shift);
    if (block == 0u)
        return fragments[i];
    if (block == 1u)
        return fragments_1[i];
    return block == 2u ? fragments_2[i] : fragments_3[i];
}

void fragment_set_word(uint place, uint word) {
    uint block = place >> fragment_block_shift, i = place - (block << fragment_block_shift);
    if (block == 0u)
        fragments[i] = word;
    else if (block == 1u)
        fragments_1[i] = word;
    else if (block == 2u)
        fragments_2[i] = word;
    else
        fragments_3[i] = word;
}
#else
uint fragment_word(uint place) {
    return fragments[place];
}

void fragment_set_word(uint place, uint word) {
    fragments[place] = word;
}
#endif

float fragment_depth(uint index) {
    return uintBitsToFloat(fragment_word(FRAGMENT_WORDS * index));
}

// A colour has 21 bits for each channel: opacity is averaged over up to 4^10 texels.
OPACITY fragment_opacity(uint index) {
#ifdef COLORED
    uvec2 bits = uvec2(fragment_word(3u * index + 1u), fragment_word(3u * index + 2u));
    return vec3(bits.x & 0x1fffffu, bits.y & 0x1fffffu, (bits.x >> 21u) << 10u | (bits.y >> 21u) & 0x3ffu) / 2097151.0;
#else
    return uintBitsToFloat(fragment_word(2u * index + 1u));
#endif
}

void fragment_store(uint index, float depth, OPACITY opacity) {
    fragment_set_word(FRAGMENT_WORDS * index, floatBitsToUint(depth));
#ifdef COLORED
    uvec3 bits = uvec3(clamp(opacity, 0.0, 1.0) * 2097151.0 + 0.5);
    fragment_set_word(3u * index + 1u, bits.x | (bits.z >> 10u) << 21u);
    fragment_set_word(3u * index + 2u, bits.y | (bits.z & 0x3ffu) << 21u);
#else
    fragment_set_word(2u * index + 1u, floatBitsToUint(opacity));
#endif
}

// Of a colour, or the mean of its channels.
OPACITY opacity_from(vec3 transmittance) {
#ifdef COLORED
    return 1.0 - transmittance;
#else
    return 1.0 - dot(transmittance, vec3(1.0 / 3.0));
#endif
}
