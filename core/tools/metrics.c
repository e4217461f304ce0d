/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "metrics.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static uint32_t color_channels(const struct image *image) {
    return image->channels < 3 ? 1 : 3;
}

static float channel_value(const struct image *image, size_t pixel, uint32_t channel) {
    uint32_t index = color_channels(image) == 1 ? 0 : channel;
    return image->pixels[pixel * image->channels + index];
}

static float luminance(const struct image *image, size_t pixel) {
    const float *values = image->pixels + pixel * image->channels;
    if (color_channels(image) == 1)
        return values[0];
    return 0.2126f * values[0] + 0.7152f * values[1] + 0.0722f * values[2];
}

static bool is_finite_pixel(const struct image *image, size_t pixel) {
    for (uint32_t c = 0; c < color_channels(image); c++)
        if (!isfinite(channel_value(image, pixel, c)))
            return false;
    return true;
}

/* ---- SSIM ---- */

#define WINDOW_RADIUS 5
/* Weight, and weighted sums of x, y, xx, yy and xy over the window. */
#define MOMENTS 6

static void gaussian(double weights[2 * WINDOW_RADIUS + 1]) {
    const double sigma = 1.5;
    for (int i = -WINDOW_RADIUS; i <= WINDOW_RADIUS; i++)
        weights[i + WINDOW_RADIUS] = exp(-i * i / (2 * sigma * sigma));
}

/* Convolves `count` elements `stride` moments apart. */
static void blur_line(const double *from, double *to, uint32_t count, size_t stride, const double *weights) {
    for (int64_t i = 0; i < count; i++) {
        double sums[MOMENTS] = {0};
        for (int64_t k = -WINDOW_RADIUS; k <= WINDOW_RADIUS; k++) {
            if (i + k < 0 || i + k >= count)
                continue;
            const double *values = from + (size_t)(i + k) * stride * MOMENTS;
            for (int m = 0; m < MOMENTS; m++)
                sums[m] += weights[k + WINDOW_RADIUS] * values[m];
        }
        memcpy(to + (size_t)i * stride * MOMENTS, sums, sizeof sums);
    }
}

static double ssim_of(const double moments[MOMENTS]) {
    const double c1 = 0.01 * 0.01, c2 = 0.03 * 0.03;
    double weight = moments[0];
    double x = moments[1] / weight, y = moments[2] / weight;
    double xx = moments[3] / weight - x * x, yy = moments[4] / weight - y * y, xy = moments[5] / weight - x * y;
    return (2 * x * y + c1) * (2 * xy + c2) / ((x * x + y * y + c1) * (xx + yy + c2));
}

/* `error` below 0 marks pixels to leave out. */
static bool ssim_mean(const struct image *a, const struct image *b, const float *error, double *mean) {
    uint32_t width = a->width, height = a->height;
    size_t pixels = (size_t)width * height, count = 0;
    double *moments = calloc(pixels, MOMENTS * sizeof *moments), *blurred = calloc(pixels, MOMENTS * sizeof *blurred);
    if (!moments || !blurred) {
        free(moments);
        free(blurred);
        return tool_error("out of memory");
    }
    for (size_t i = 0; i < pixels; i++) {
        if (error[i] < 0)
            continue;
        double x = luminance(a, i), y = luminance(b, i);
        memcpy(moments + i * MOMENTS, (double[MOMENTS]){1, x, y, x * x, y * y, x * y}, MOMENTS * sizeof(double));
    }
    double weights[2 * WINDOW_RADIUS + 1];
    gaussian(weights);
    for (uint32_t y = 0; y < height; y++)
        blur_line(moments + (size_t)y * width * MOMENTS, blurred + (size_t)y * width * MOMENTS, width, 1, weights);
    for (uint32_t x = 0; x < width; x++)
        blur_line(blurred + (size_t)x * MOMENTS, moments + (size_t)x * MOMENTS, height, width, weights);
    double sum = 0;
    for (size_t i = 0; i < pixels; i++) {
        if (error[i] < 0)
            continue;
        sum += ssim_of(moments + i * MOMENTS);
        count++;
    }
    *mean = count ? sum / (double)count : 1;
    free(moments);
    free(blurred);
    return true;
}

/* ---- Differences ---- */

bool metrics_compute(const struct image *a, const struct image *b, const bool *mask, struct metrics *metrics,
                     float *error) {
    *metrics = (struct metrics){0};
    size_t pixels = (size_t)a->width * a->height;
    uint32_t channels = color_channels(a) > color_channels(b) ? color_channels(a) : color_channels(b);
    double squares = 0, absolutes = 0;
    uint64_t fifth = 0, visible = 0, finite = 0;
    for (size_t i = 0; i < pixels; i++) {
        error[i] = -1;
        metrics->pixels += mask[i];
        if (!mask[i])
            continue;
        if (!is_finite_pixel(a, i) || !is_finite_pixel(b, i)) {
            metrics->not_finite++;
            continue;
        }
        double largest = 0;
        for (uint32_t c = 0; c < channels; c++) {
            double difference = fabs((double)channel_value(a, i, c) - (double)channel_value(b, i, c));
            squares += difference * difference;
            absolutes += difference;
            largest = fmax(largest, difference);
        }
        error[i] = (float)largest;
        finite++;
        fifth += largest > 0.2;
        visible += largest > 1.0 / 64;
        if (largest > metrics->max) {
            metrics->max = largest;
            metrics->max_x = (uint32_t)(i % a->width);
            metrics->max_y = (uint32_t)(i / a->width);
        }
    }
    double count = finite ? (double)finite : 1;
    metrics->rmse = sqrt(squares / (count * channels));
    metrics->mean = absolutes / (count * channels);
    metrics->above_fifth = (double)fifth / count;
    metrics->above_64th = (double)visible / count;
    return ssim_mean(a, b, error, &metrics->ssim);
}
