/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "content_key.h"

#include <string.h>

#define LANES      4
#define BLOCK_SIZE (LANES * sizeof(uint64_t))

/* Odd, with about half of their bits set and no visible pattern: fractional digits of square roots of primes. */
static const uint64_t multipliers[LANES] = {0x6a09e667f3bcc909u, 0xbb67ae8584caa73bu, 0x3c6ef372fe94f82bu,
                                            0xa54ff53a5f1d36f1u};
#define FINAL_MULTIPLIER 0x510e527fade682d1u

/* One step of a lane. Each part can be undone for a known `word`, so a changed word always changes the lane; the
 * shift brings high bits down before the second product spreads them, so that two changes do not cancel. */
static inline uint64_t lane_step(uint64_t lane, uint64_t word, uint64_t multiplier) {
    uint64_t mixed = (lane ^ word) * multiplier;
    mixed ^= mixed >> 32;
    return mixed * FINAL_MULTIPLIER + multiplier;
}

static void lanes_add_block(uint64_t lanes[LANES], const unsigned char *block) {
    for (size_t i = 0; i < LANES; i++) {
        uint64_t word;
        memcpy(&word, block + i * sizeof word, sizeof word);
        lanes[i] = lane_step(lanes[i], word, multipliers[i]);
    }
}

uint64_t content_key_mix(uint64_t word) {
    word = (word ^ (word >> 31)) * multipliers[0];
    word = (word ^ (word >> 29)) * multipliers[1];
    return word ^ (word >> 32);
}

void content_key_add(struct content_key *key, const void *data, size_t size) {
    const unsigned char *bytes = data;
    uint64_t lanes[LANES];
    for (size_t i = 0; i < LANES; i++) {
        lanes[i] = content_key_mix(key->words[i % 2] + multipliers[i]);
    }
    size_t left = size;
    for (; left >= BLOCK_SIZE; left -= BLOCK_SIZE, bytes += BLOCK_SIZE) {
        lanes_add_block(lanes, bytes);
    }
    if (left > 0) {
        unsigned char last[BLOCK_SIZE] = {0};
        memcpy(last, bytes, left);
        lanes_add_block(lanes, last);
    }
    uint64_t forward = size, backward = ~(uint64_t)size;
    for (size_t i = 0; i < LANES; i++) {
        forward = content_key_mix(forward ^ lanes[i]);
        backward = content_key_mix(backward + lanes[LANES - 1 - i]);
    }
    key->words[0] = forward;
    key->words[1] = backward;
}
