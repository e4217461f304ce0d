/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "octahedral.h"

#include <math.h>

static double sign_of(double value) {
    return value < 0 ? -1.0 : 1.0;
}

/* To the nearest, so that the error is at most half a step. */
static int16_t snorm16(double value) {
    return (int16_t)(value * 32767.0 + sign_of(value) * 0.5);
}

bool octahedral_pack(const double vector[3], int16_t packed[2]) {
    double length = fabs(vector[0]) + fabs(vector[1]) + fabs(vector[2]);
    if (!(length > 0) || !isfinite(length)) {
        return false;
    }
    double x = vector[0] / length, y = vector[1] / length;
    if (vector[2] < 0) { /* the lower half: fold each corner outwards */
        double folded = (1 - fabs(y)) * sign_of(x);
        y = (1 - fabs(x)) * sign_of(y);
        x = folded;
    }
    packed[0] = snorm16(x);
    packed[1] = snorm16(y);
    return true;
}
