/* SPDX-License-Identifier: GPL-3.0-or-later
 * Which numbers of the host can be computed with. */
#ifndef PNB_NUMBERS_H
#define PNB_NUMBERS_H

#include <math.h>
#include <stdbool.h>
#include <stddef.h>

/* Largest usable coordinate or colour: squared lengths beyond it overflow single precision. */
#define LARGEST_NUMBER 1e18f

/* True if all are finite and of usable size. */
static inline bool numbers_usable(const float *numbers, size_t count) {
    for (size_t i = 0; i < count; i++) {
        if (!(fabsf(numbers[i]) <= LARGEST_NUMBER)) {
            return false;
        }
    }
    return true;
}

#endif
