/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "statistics.h"

#include <stdlib.h>

static int compare_doubles(const void *a, const void *b) {
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

struct statistics statistics_of(double *values, uint32_t count) {
    if (!count)
        return (struct statistics){0};
    qsort(values, count, sizeof *values, compare_doubles);
    double median = (values[(count - 1) / 2] + values[count / 2]) / 2;
    return (struct statistics){.median = median, .minimum = values[0], .maximum = values[count - 1]};
}
