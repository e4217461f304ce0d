// SPDX-License-Identifier: GPL-3.0-or-later
// Fragment lists (core/passes/fragment_lists.c): for every texel of a light's views, what casts shadows there, in order of
// its light-space depth, with its opacity: 1 - transmittance, a number or, with COLORED, one for each channel.

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

float fragment_depth(uint index) {
    return uintBitsToFloat(fragments[FRAGMENT_WORDS * index]);
}

// A colour has 21 bits for each channel: opacity is averaged over up to 4^10 texels.
OPACITY fragment_opacity(uint index) {
#ifdef COLORED
    uvec2 bits = uvec2(fragments[3u * index + 1u], fragments[3u * index + 2u]);
    return vec3(bits.x & 0x1fffffu, bits.y & 0x1fffffu, (bits.x >> 21u) << 10u | (bits.y >> 21u) & 0x3ffu) / 2097151.0;
#else
    return uintBitsToFloat(fragments[2u * index + 1u]);
#endif
}

void fragment_store(uint index, float depth, OPACITY opacity) {
    fragments[FRAGMENT_WORDS * index] = floatBitsToUint(depth);
#ifdef COLORED
    uvec3 bits = uvec3(clamp(opacity, 0.0, 1.0) * 2097151.0 + 0.5);
    fragments[3u * index + 1u] = bits.x | (bits.z >> 10u) << 21u;
    fragments[3u * index + 2u] = bits.y | (bits.z & 0x3ffu) << 21u;
#else
    fragments[2u * index + 1u] = floatBitsToUint(opacity);
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
