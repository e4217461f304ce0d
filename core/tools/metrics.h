/* SPDX-License-Identifier: GPL-3.0-or-later
 * How two images differ. */
#ifndef METRICS_H
#define METRICS_H

#include "image.h"

struct metrics {
    uint64_t pixels;     /* compared */
    uint64_t not_finite; /* of them, those where an image is NaN or infinite; they count in nothing else */
    double rmse;         /* root of the mean squared difference over pixels and colour channels */
    double mean;         /* mean absolute difference */
    double ssim;         /* structural similarity of the luminance */
    double max;          /* largest absolute difference of a channel, at max_x, max_y from the lower left */
    uint32_t max_x, max_y;
    double above_fifth; /* share of the pixels that differ by more than 0.2 in a channel */
    double above_64th;  /* by more than 1/64, about 0.016: visible */
};

/* SSIM of Wang et al. 2004: Gaussian window of 11 x 11 pixels, sigma 1.5, K1 = 0.01, K2 = 0.03, dynamic range 1,
 * mean over the compared pixels; the window is renormalised over them at borders. */
#define SSIM_TEXT "Gaussian 11x11, sigma 1.5, K1 0.01, K2 0.03, range 1, luminance"

/* Compares the pixels where mask is true; alpha does not count. Images of one channel are compared as grey. error
 * (width * height floats) receives the largest difference of each pixel, or -1 where nothing was compared. The
 * images have one size. False: out of memory, reported. */
bool metrics_compute(const struct image *a, const struct image *b, const bool *mask, struct metrics *metrics,
                     float *error);

#endif
