/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "sampling.h"

#include <math.h>

#define PI           3.14159265358979f
#define GOLDEN_ANGLE 2.39996323f

void square_to_disk(float point[2]) {
    const float x = point[0], y = point[1];
    if (x == 0.0f && y == 0.0f)
        return;
    const bool wide = fabsf(x) > fabsf(y);
    const float radius = wide ? x : y;
    const float angle = wide ? PI / 4.0f * (y / x) : PI / 2.0f - PI / 4.0f * (x / y);
    point[0] = radius * cosf(angle);
    point[1] = radius * sinf(angle);
}

void disk_to_square(float point[2]) {
    const float x = point[0], y = point[1];
    const float radius = hypotf(x, y);
    if (radius == 0.0f)
        return;
    const bool wide = fabsf(x) > fabsf(y);
    const float side = copysignf(radius, wide ? x : y);
    const float across = side * (4.0f / PI) * atanf(wide ? y / x : x / y);
    point[0] = wide ? side : across;
    point[1] = wide ? across : side;
}

/* To [-1, 1), about 0. In double: of thousands of points, some are closer than what floats tell apart here. */
static float wrap(double x) {
    return (float)(2.0 * (x + 0.5 - floor(x + 0.5)) - 1.0);
}

/* Two opposite arms of Vogel's spiral (a bijugate pattern): consecutive points are opposite, so that the centroid of
 * any pairs of them is exactly 0 and edges do not move. An odd last point is the centre. */
static void disk_point(int i, int count, float turn, float point[2]) {
    const int pair = i / 2, odd = count % 2;
    const float radius = odd && i == count - 1 ? 0.0f : sqrtf((float)(2 * pair + 1 + odd) / (float)count);
    const float angle = (float)pair * 0.5f * GOLDEN_ANGLE + turn * PI * 0.61803399f;
    const float side = i % 2 == 0 ? 1.0f : -1.0f;
    point[0] = side * radius * cosf(angle);
    point[1] = side * radius * sinf(angle);
}

/* A disk: Vogel's spiral. A square: the golden-ratio lattice, whose projections on both axes are even, so that straight
 * edges get as many steps as there are points; it is symmetric about the centre. */
static void vogel_point(int i, int count, bool disk, uint32_t turn, float point[2]) {
    if (disk) {
        disk_point(i, count, (float)turn, point);
        return;
    }
    const double n = count, t = turn, from_middle = i + 0.5 - 0.5 * n;
    point[0] = wrap((from_middle + 0.618033988749895 * t) / n);
    point[1] = wrap(from_middle * 0.618033988749895 + 0.754877666246693 * t);
}

void light_point(int i, int count, bool disk, uint32_t turn, float point[2]) {
    disk_point(i, count, (float)turn, point);
    if (!disk)
        disk_to_square(point);
}

static void grid_point(int i, int side, bool disk, float point[2]) {
    point[0] = 2.0f * ((float)(i % side) + 0.5f) / (float)side - 1.0f;
    point[1] = 2.0f * ((float)(i / side) + 0.5f) / (float)side - 1.0f;
    if (disk)
        square_to_disk(point);
}

int pattern_fill(enum pattern pattern, int count, bool disk, uint32_t turn, float points[][2]) {
    const int side = (int)floorf(sqrtf((float)count) + 1e-3f);
    if (pattern == PATTERN_GRID)
        count = side * side;
    for (int i = 0; i < count; i++) {
        if (pattern == PATTERN_GRID)
            grid_point(i, side, disk, points[i]);
        else
            vogel_point(i, count, disk, turn, points[i]);
    }
    if (count % 2 == 1)
        points[count][0] = points[count][1] = 1e30f;
    return count;
}

void sphere_point(int i, int count, uint32_t turn, float point[3]) {
    const float z = 1.0f - (2.0f * (float)i + 1.0f) / (float)count, across = sqrtf(1.0f - z * z);
    /* In double: with thousands of points the angle is large. */
    const float angle = (float)fmod(i * 2.399963229728653 + turn * 1.941611038725466, 2.0 * 3.141592653589793);
    point[0] = across * cosf(angle);
    point[1] = across * sinf(angle);
    point[2] = z;
}

/* Blackman-Harris window over [-0.5, 0.5]. */
static float blackman_harris(float x) {
    const float t = 2.0f * PI * (x + 0.5f);
    return 0.35875f - 0.48829f * cosf(t) + 0.14128f * cosf(2.0f * t) - 0.01168f * cosf(3.0f * t);
}

/* Where the window's integral reaches the share u, by its cumulative sum. */
static float filter_inverse(float u) {
    enum { STEPS = 256 };
    float total = 0.0f, sum = 0.0f;
    for (int i = 0; i < STEPS; i++)
        total += blackman_harris(((float)i + 0.5f) / STEPS - 0.5f);
    for (int i = 0; i < STEPS; i++) {
        const float part = blackman_harris(((float)i + 0.5f) / STEPS - 0.5f) / total;
        if (sum + part >= u)
            return ((float)i + (u - sum) / part) / STEPS - 0.5f;
        sum += part;
    }
    return 0.5f;
}

static uint32_t greatest_common_divisor(uint32_t a, uint32_t b) {
    return b == 0 ? a : greatest_common_divisor(b, a % b);
}

/* The order of symmetric points: from the middle, each followed by its opposite, pairs in steps of the golden ratio.
 * What the first few show is then not shifted, and does not move while the others follow. */
static uint32_t spread(uint32_t index, uint32_t count) {
    const uint32_t pairs = count / 2, odd = count % 2;
    if (odd && index == 0)
        return pairs;
    uint32_t step = (uint32_t)(0.61803399 * pairs + 0.5);
    while (greatest_common_divisor(step, pairs) != 1)
        step++;
    const uint32_t pair = (uint32_t)((uint64_t)((index - odd) / 2) * step % pairs);
    return (index - odd) % 2 ? pairs - 1 - pair : pairs + odd + pair;
}

void pixel_sample(uint32_t index, uint32_t count, float filter_width, float offset[2]) {
    offset[0] = offset[1] = 0.0f;
    if (count <= 1)
        return;
    float point[2];
    vogel_point((int)spread(index, count), (int)count, false, 0, point);
    /* A Blackman-Harris filter of width w is the window over [-w, w] (Cycles' convention). */
    for (int axis = 0; axis < 2; axis++)
        offset[axis] = filter_inverse(0.5f * point[axis] + 0.5f) * 2.0f * filter_width;
}
