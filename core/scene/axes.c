/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "axes.h"

#include <math.h>
#include <stdbool.h>

/* Axes that enclose an angle whose sine is smaller are taken as parallel: single precision cannot tell. */
#define SMALLEST_SINE 1e-6
/* Shorter axes are taken as zero: divisions by them would leave the usable numbers. */
#define SHORTEST_AXIS 1e-18

struct vector {
    double x, y, z;
};

static struct vector axis_get(const float matrix[16], int axis) {
    const float *column = matrix + 4 * axis;
    return (struct vector){column[0], column[1], column[2]};
}

static void axis_set(float matrix[16], int axis, struct vector vector) {
    float *column = matrix + 4 * axis;
    column[0] = (float)vector.x;
    column[1] = (float)vector.y;
    column[2] = (float)vector.z;
}

static struct vector cross(struct vector a, struct vector b) {
    return (struct vector){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

static double dot(struct vector a, struct vector b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static double length(struct vector a) {
    return sqrt(dot(a, a));
}

/* Zero if it is too short to have a direction. */
static struct vector normalized(struct vector a) {
    double inverse = length(a) >= SHORTEST_AXIS ? 1 / length(a) : 0;
    return (struct vector){a.x * inverse, a.y * inverse, a.z * inverse};
}

static bool is_zero(struct vector a) {
    return length(a) == 0;
}

/* Of unit vectors, or zero ones. */
static bool are_parallel(struct vector a, struct vector b) {
    return length(cross(a, b)) < SMALLEST_SINE;
}

static struct vector any_perpendicular(struct vector unit) {
    struct vector other = fabs(unit.x) < 0.9 ? (struct vector){1, 0, 0} : (struct vector){0, 1, 0};
    return normalized(cross(unit, other));
}

float axis_length(const float axis[3]) {
    return (float)length((struct vector){axis[0], axis[1], axis[2]});
}

double axes_determinant(const float matrix[16]) {
    return dot(cross(axis_get(matrix, 0), axis_get(matrix, 1)), axis_get(matrix, 2));
}

unsigned axes_complete(float matrix[16]) {
    struct vector x = normalized(axis_get(matrix, 0)), y = normalized(axis_get(matrix, 1)),
                  z = normalized(axis_get(matrix, 2));
    unsigned replaced = 0;
    if (is_zero(z)) {
        if (!are_parallel(x, y)) {
            z = normalized(cross(x, y));
        } else if (!is_zero(x) || !is_zero(y)) {
            z = any_perpendicular(is_zero(x) ? y : x);
        } else {
            z = (struct vector){0, 0, 1};
        }
        axis_set(matrix, 2, z);
        replaced |= 1u << 2;
    }
    if (are_parallel(x, z)) {
        x = are_parallel(y, z) ? any_perpendicular(z) : normalized(cross(y, z));
        axis_set(matrix, 0, x);
        replaced |= 1u << 0;
    }
    struct vector normal = normalized(cross(z, x));
    if (fabs(dot(y, normal)) < SMALLEST_SINE) {
        axis_set(matrix, 1, normal);
        replaced |= 1u << 1;
    }
    return replaced;
}

void axes_orthonormalize(float matrix[16]) {
    struct vector z = normalized(axis_get(matrix, 2));
    struct vector x = normalized(cross(axis_get(matrix, 1), z));
    axis_set(matrix, 0, x);
    axis_set(matrix, 1, cross(z, x));
    axis_set(matrix, 2, z);
}

void matrix_make_affine(float matrix[16]) {
    matrix[3] = matrix[7] = matrix[11] = 0;
    matrix[15] = 1;
}
