/* SPDX-License-Identifier: GPL-3.0-or-later
 * Which numbers of the host can be computed with. */
#ifndef PNB_NUMBERS_H
#define PNB_NUMBERS_H

#include <math.h>
#include <stdbool.h>
#include <stddef.h>

/* Largest usable number: squared lengths beyond it overflow single precision. */
#define LARGEST_NUMBER 1e18f
/* Farthest that anything may lie from the world's origin, metres: fourth powers of distances must not overflow. */
#define LARGEST_COORDINATE 1e9f

/* True if all are finite and not larger than the limit. */
static inline bool numbers_within(const float *numbers, size_t count, float limit) {
    for (size_t i = 0; i < count; i++) {
        if (!(fabsf(numbers[i]) <= limit)) {
            return false;
        }
    }
    return true;
}

/* True if all are finite and of usable size. */
static inline bool numbers_usable(const float *numbers, size_t count) {
    return numbers_within(numbers, count, LARGEST_NUMBER);
}

#endif
