/* SPDX-License-Identifier: GPL-3.0-or-later
 * Median and range of repeated measurements. */
#ifndef STATISTICS_H
#define STATISTICS_H

#include <stdint.h>

struct statistics {
    double median, minimum, maximum;
};

/* Sorts `values`. All zero for none. */
struct statistics statistics_of(double *values, uint32_t count);

#endif
