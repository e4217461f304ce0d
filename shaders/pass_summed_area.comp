// SPDX-License-Identifier: GPL-3.0-or-later
// Summed-area tables of CHANNELS (1 or 2) values per texel, `vec4 summed_value(ivec3 texel)` of the included file,
// after its `void summed_create(int layer)`. A table holds at each texel the sum of what lies left of, below and at it
// within its tile. Stored as 32-bit integers: sums of round(value * scale) that wrap around, or with FLOATS the bits
// of floats.
// STEP 0: tables of blocks of 64 x 64, or of smaller tiles. STEP 1, 2: larger tiles, by adding to each block what lies
// left of it, then what lies below.

layout(local_size_x = 64) in;
#if CHANNELS == 2
layout(rg32ui, binding = 0) coherent uniform uimage2DArray table;
#else
layout(r32ui, binding = 0) coherent uniform uimage2DArray table;
#endif
uniform int side;      // texels of the level
uniform ivec2 origin;  // of the level
uniform int tile;      // texels along a tile's side, a power of two
uniform float scale;

#ifdef FLOATS
#define VALUE vec2
VALUE to_value(uvec2 bits) {
    return uintBitsToFloat(bits);
}
uvec4 to_bits(VALUE value) {
    return uvec4(floatBitsToUint(value), 0u, 0u);
}
#else
#define VALUE uvec2
VALUE to_value(uvec2 bits) {
    return bits;
}
uvec4 to_bits(VALUE value) {
    return uvec4(value, 0u, 0u);
}
#endif

#include "technique"

#if STEP == 0

// Rows are summed into the block, then columns out of it. The swizzle keeps threads apart in memory banks.
shared uint block[64 * 64 * CHANNELS];

int block_index(int x, int y) {
    return (y * 64 + (x ^ y)) * CHANNELS;
}

void main() {
    ivec2 corner = ivec2(gl_WorkGroupID.xy) * 64;
    int layer = int(gl_WorkGroupID.z), thread = int(gl_LocalInvocationIndex);
    VALUE sum = VALUE(0);
    summed_create(layer);
    for (int x = 0; x < 64; x++) {
        ivec2 texel = corner + ivec2(x, thread);
        sum = (x & (tile - 1)) == 0 ? VALUE(0) : sum;
        if (all(lessThan(texel, ivec2(side)))) {
            vec2 value = summed_value(ivec3(texel, layer)).xy;
#ifdef FLOATS
            sum += value;
#else
            sum += uvec2(value * scale + 0.5);
#endif
        }
        uvec4 bits = to_bits(sum);
        block[block_index(x, thread)] = bits.x;
#if CHANNELS == 2
        block[block_index(x, thread) + 1] = bits.y;
#endif
    }
    barrier();
    sum = VALUE(0);
    for (int y = 0; y < 64; y++) {
        ivec2 texel = corner + ivec2(thread, y);
        sum = (y & (tile - 1)) == 0 ? VALUE(0) : sum;
        int index = block_index(thread, y);
        sum += to_value(uvec2(block[index], block[index + CHANNELS - 1]));
        if (all(lessThan(texel, ivec2(side))))
            imageStore(table, ivec3(origin + texel, layer), to_bits(sum));
    }
}
#else

// One thread for each row (STEP 1) or column (STEP 2) of the table.
void main() {
    int line = int(gl_GlobalInvocationID.x), layer = int(gl_WorkGroupID.z);
    if (line >= side)
        return;
    VALUE carry = VALUE(0);
    for (int i = 64; i < side; i++) {
        if ((i & 63) == 0) {
            ivec2 before = STEP == 1 ? ivec2(i - 1, line) : ivec2(line, i - 1);
            carry = (i & (tile - 1)) == 0 ? VALUE(0) : to_value(imageLoad(table, ivec3(origin + before, layer)).xy);
        }
        ivec3 texel = ivec3(origin + (STEP == 1 ? ivec2(i, line) : ivec2(line, i)), layer);
        imageStore(table, texel, to_bits(to_value(imageLoad(table, texel).xy) + carry));
    }
}
#endif
