/* SPDX-License-Identifier: GPL-3.0-or-later
 * Sample patterns: what a shadow's position, width and banding rest on. */
#include "check.h"

#include "render/sampling.h"

#include <stdlib.h>

#define PI 3.14159265358979

static int compare(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Share of the square or disk left of t. */
static double area_left_of(double t, bool disk) {
    t = fmin(fmax(t, -1), 1);
    return disk ? 0.5 + (t * sqrt(1 - t * t) + asin(t)) / PI : 0.5 + 0.5 * t;
}

struct evenness {
    double centroid, spread, worst; /* spread: standard deviation over the right one; worst: of the share of points
                                     * on one side of a line, off the share of the area */
};

static struct evenness measure(float points[][2], int count, bool disk) {
    struct evenness even = {0, 1, 0};
    double *sorted = malloc((size_t)count * sizeof *sorted);
    const int directions = disk ? 24 : 1; /* a square's edges are straight along its axes alone */
    for (int k = 0; k < 2 * directions && sorted; k++) {
        const double angle = PI / 2 * k / directions, x = cos(angle), y = sin(angle);
        double sum = 0, square = 0;
        for (int i = 0; i < count; i++) {
            sorted[i] = x * (double)points[i][0] + y * (double)points[i][1];
            sum += sorted[i] / count;
            square += sorted[i] * sorted[i] / count;
        }
        qsort(sorted, (size_t)count, sizeof *sorted, compare);
        for (int i = 0; i < count; i++) {
            const double area = area_left_of(sorted[i], disk);
            even.worst = fmax(even.worst, fmax(fabs((double)i / count - area), fabs((i + 1.0) / count - area)));
        }
        const double spread = sqrt(square) / (disk ? 0.5 : sqrt(1.0 / 3));
        even.centroid = fmax(even.centroid, fabs(sum));
        even.spread = fabs(spread - 1) > fabs(even.spread - 1) ? spread : even.spread;
    }
    free(sorted);
    return even;
}

static void patterns_are_even(void) {
    static const int counts[] = {1, 9, 16, 32, 64, 81, 225, 1024};
    for (enum pattern pattern = PATTERN_VOGEL; pattern <= PATTERN_GRID; pattern++)
        for (int disk = 0; disk < 2; disk++)
            for (size_t k = 0; k < sizeof counts / sizeof *counts; k++) {
                static float points[MAX_TAPS + 1][2];
                const int asked = counts[k], count = pattern_fill(pattern, asked, disk, 0, points);
                const int side = (int)sqrt(asked);
                CHECK_INT(count, pattern == PATTERN_GRID ? side * side : asked);
                double reach = 0;
                for (int i = 0; i < count; i++) {
                    const double x = fabs((double)points[i][0]), y = fabs((double)points[i][1]);
                    reach = fmax(reach, disk ? hypot(x, y) : fmax(x, y));
                }
                const struct evenness even = measure(points, count, disk);
                printf("%s %s %4d points: centroid %.4f, spread %.3f, share beside a line within %.4f\n",
                       pattern == PATTERN_GRID ? "grid " : "Vogel", disk ? "disk  " : "square", count, even.centroid,
                       even.spread, even.worst);
                CHECK_AT_MOST(reach, 1);
                CHECK_AT_MOST(even.centroid, 1e-5); /* every pattern is symmetric about the centre */
                /* Random points would be off by about 1 / sqrt(count); a grid is off by a whole column. */
                CHECK_AT_MOST(even.worst, pattern == PATTERN_GRID ? 1.0 / side + 1e-6 : 2 / pow(count, 0.75));
                if (count >= 9) /* too narrow a pattern makes too narrow a penumbra */
                    CHECK_NEAR(even.spread, 1, pattern == PATTERN_GRID ? 0.5 / side : 2.0 / count);
                if (count % 2 == 1)
                    CHECK(points[count][0] > 1e20f && points[count][1] > 1e20f);
            }
}

/* Thinned patterns, every stride-th pair, must not move an edge either. */
static void pairs_are_opposite(void) {
    static float points[MAX_TAPS + 1][2];
    const int count = pattern_fill(PATTERN_VOGEL, 64, true, 0, points);
    double worst = 0;
    for (int i = 0; i < count; i += 2)
        worst =
            fmax(worst, hypot((double)(points[i][0] + points[i + 1][0]), (double)(points[i][1] + points[i + 1][1])));
    CHECK_AT_MOST(worst, 1e-6);
}

/* The patterns of several anti-aliasing samples together are as even as one of as many points. */
static void turns_complete_each_other(void) {
    enum { TURNS = 8, POINTS = 16 };
    static float all[TURNS * POINTS + 1][2], once[POINTS + 1][2];
    for (int disk = 0; disk < 2; disk++) {
        for (uint32_t turn = 0; turn < TURNS; turn++) {
            static float points[POINTS + 1][2];
            pattern_fill(PATTERN_VOGEL, POINTS, disk, turn, points);
            memcpy(all[turn * POINTS], points, POINTS * sizeof *points);
        }
        pattern_fill(PATTERN_VOGEL, POINTS, disk, 0, once);
        const struct evenness one = measure(once, POINTS, disk), together = measure(all, TURNS * POINTS, disk);
        printf("%s: share beside a line within %.4f with 16 points, %.4f with 8 such patterns\n",
               disk ? "disk" : "square", one.worst, together.worst);
        CHECK_AT_MOST(together.worst, 0.5 * one.worst);
    }
}

/* Share of the square where x cos + y sin < t: a point of it is the sum of two even distributions. */
static double square_beside(double t, double x, double y) {
    const double a = fmax(fabs(x), fabs(y)), b = fmin(fabs(x), fabs(y)), side = fabs(t);
    const double beyond = side >= a + b   ? 0
                          : side <= a - b ? 0.5 - side / (2 * a)
                                          : (a + b - side) * (a + b - side) / (8 * a * b);
    return t < 0 ? beyond : 1 - beyond;
}

/* Root mean square, over lines of one direction, of the share of points beside a line off the share of the area. */
static double line_error(float points[][2], int count, bool disk, double angle) {
    enum { LINES = 50 };
    const double x = cos(angle), y = sin(angle);
    double error = 0;
    for (int k = 0; k < LINES; k++) {
        const double line = (2 * (k + 0.5) / LINES - 1) * (disk ? 1 : fabs(x) + fabs(y));
        int beside = 0;
        for (int i = 0; i < count; i++)
            beside += x * (double)points[i][0] + y * (double)points[i][1] < line;
        const double area = disk ? area_left_of(line, true) : square_beside(line, x, y);
        error += pow((double)beside / count - area, 2) / LINES;
    }
    return sqrt(error);
}

/* Edges of shadows run in all directions over a light. As even as points can be (Beck 1987): count^(-3/4), where random
 * points have count^(-1/2), and so has a lattice in its worst directions: 0.6 / count^(3/4) with 64 points, 1.2 with
 * 1024. */
static void lines_of_any_direction_get_their_share(void) {
    enum { DIRECTIONS = 90 };
    static float points[4096][2];
    for (int side = 4; side <= 64; side *= 2)
        for (int disk = 0; disk < 2; disk++) {
            const int count = side * side;
            for (int i = 0; i < count; i++)
                light_point(i, count, disk, 0, points[i]);
            double square = 0, worst = 0;
            for (int k = 0; k < DIRECTIONS; k++) {
                const double error = line_error(points, count, disk, PI * k / DIRECTIONS);
                square += error * error / DIRECTIONS;
                worst = fmax(worst, error);
            }
            const double unit = pow(count, -0.75);
            printf("%s %4d points: share beside a line within %.5f = %.3f / count^(3/4), in the worst direction %.3f\n",
                   disk ? "disk  " : "square", count, sqrt(square), sqrt(square) / unit, worst / unit);
            CHECK_AT_MOST(sqrt(square), 0.32 * unit);
            CHECK_AT_MOST(worst, 0.5 * unit);
        }
}

/* Area-preserving: a ring or a sector holds its share of a fine grid. */
static void disk_map_preserves_area(void) {
    enum { SIDE = 400 };
    int inner = 0, sector = 0;
    for (int i = 0; i < SIDE * SIDE; i++) {
        float point[2] = {2 * ((float)(i % SIDE) + 0.5f) / SIDE - 1, 2 * ((float)(i / SIDE) + 0.5f) / SIDE - 1};
        square_to_disk(point);
        inner += hypotf(point[0], point[1]) < 0.6f;
        const double angle = atan2((double)point[1], (double)point[0]);
        sector += angle > 0.3 && angle < 1.4;
    }
    printf("map to the disk: %.5f of the area within radius 0.6, %.5f within 1.1 radians\n",
           (double)inner / SIDE / SIDE, (double)sector / SIDE / SIDE);
    CHECK_NEAR((double)inner / SIDE / SIDE, 0.36, 1e-3);
    CHECK_NEAR((double)sector / SIDE / SIDE, 1.1 / (2 * PI), 1e-3);
    float center[2] = {0, 0};
    square_to_disk(center);
    CHECK(center[0] == 0 && center[1] == 0);
    double worst = 0;
    for (int i = 0; i < SIDE * SIDE; i++) {
        const float x = 2 * ((float)(i % SIDE) + 0.5f) / SIDE - 1, y = 2 * ((float)(i / SIDE) + 0.5f) / SIDE - 1;
        float point[2] = {x, y};
        square_to_disk(point);
        disk_to_square(point);
        worst = fmax(worst, hypot((double)(point[0] - x), (double)(point[1] - y)));
    }
    CHECK_AT_MOST(worst, 2e-6); /* rounding */
}

/* Half of a sphere, weighted by how much each point faces the eye, looks like a disk: its centroid is the centre. */
static void spheres_are_even(void) {
    for (int n = 4; n <= 32; n *= 2) {
        double worst = 0, length = 0;
        for (int k = 0; k < 64; k++) {
            float eye[3], point[3];
            sphere_point(k, 64, 0, eye);
            double sum[3] = {0}, weights = 0;
            for (int i = 0; i < n * n; i++) {
                sphere_point(i, n * n, 0, point);
                double facing = 0, norm = 0;
                for (int c = 0; c < 3; c++) {
                    facing += (double)point[c] * (double)eye[c];
                    norm += (double)point[c] * (double)point[c];
                }
                length = fmax(length, fabs(norm - 1));
                facing = fmax(facing, 0);
                weights += facing;
                for (int c = 0; c < 3; c++)
                    sum[c] += facing * (double)point[c];
            }
            double along = 0, square = 0;
            for (int c = 0; c < 3; c++) {
                along += sum[c] / weights * (double)eye[c];
                square += sum[c] / weights * sum[c] / weights;
            }
            worst = fmax(worst, sqrt(fmax(square - along * along, 0)));
        }
        printf("sphere of %d points: centroid of a half within %.4f of where it should be\n", n * n, worst);
        CHECK_AT_MOST(worst, 2.0 / (n * n)); /* a random choice: 1 / n */
        CHECK_AT_MOST(length, 1e-6);
    }
}

/* Mean 0 and the variance of a Blackman-Harris window over twice the width. */
static void pixel_samples_follow_the_filter(void) {
    enum { COUNT = 1024, STEPS = 10000 };
    double total = 0, variance = 0;
    for (int i = 0; i < STEPS; i++) {
        const double x = (i + 0.5) / STEPS - 0.5, t = 2 * PI * (x + 0.5);
        const double weight = 0.35875 - 0.48829 * cos(t) + 0.14128 * cos(2 * t) - 0.01168 * cos(3 * t);
        total += weight;
        variance += weight * x * x;
    }
    const double expected = 2 * 1.5 * sqrt(variance / total);
    double mean[2] = {0}, square[2] = {0};
    for (uint32_t i = 0; i < COUNT; i++) {
        float offset[2];
        pixel_sample(i, COUNT, 1.5f, offset);
        for (int axis = 0; axis < 2; axis++) {
            mean[axis] += (double)offset[axis] / COUNT;
            square[axis] += (double)offset[axis] * (double)offset[axis] / COUNT;
        }
    }
    printf("pixel samples: mean %.4f %.4f, deviation %.4f %.4f, of the filter %.4f\n", mean[0], mean[1],
           sqrt(square[0]), sqrt(square[1]), expected);
    for (int axis = 0; axis < 2; axis++) {
        CHECK_NEAR(mean[axis], 0, 2e-3);
        CHECK_NEAR(sqrt(square[axis]), expected, 0.01 * expected);
    }
    float offset[2] = {1, 1};
    pixel_sample(0, 1, 1.5f, offset);
    CHECK(offset[0] == 0 && offset[1] == 0);
}

/* What a progressive render shows after 1, 2, 4 ... samples must not be shifted. Of an even number of them pairs
 * cancel; an odd number begins with the centre and lacks one point's opposite, which is at most two filter widths away.
 */
static void first_pixel_samples_surround_the_centre(void) {
    static const uint32_t counts[] = {2, 3, 4, 5, 8, 16, 64, 100, 1024, 4096};
    for (size_t c = 0; c < sizeof counts / sizeof *counts; c++) {
        double sum[2] = {0}, worst = 0;
        for (uint32_t i = 0; i < counts[c]; i++) {
            float offset[2];
            pixel_sample(i, counts[c], 1.5f, offset);
            sum[0] += (double)offset[0];
            sum[1] += (double)offset[1];
            const double shift = fmax(fabs(sum[0]), fabs(sum[1])) / (i + 1);
            if (i == 0)
                CHECK_AT_MOST(shift, 0.5);
            else if ((i & (i + 1)) == 0)
                worst = fmax(worst, shift - (counts[c] % 2 ? 3.0 / (i + 1) : 0));
        }
        printf("%u pixel samples: powers of two of them are at most %.6f pixels off\n", counts[c], worst);
        CHECK_AT_MOST(worst, 1e-4);
    }
}

int main(void) {
    patterns_are_even();
    pairs_are_opposite();
    turns_complete_each_other();
    lines_of_any_direction_get_their_share();
    disk_map_preserves_area();
    spheres_are_even();
    pixel_samples_follow_the_filter();
    first_pixel_samples_surround_the_centre();
    return check_report();
}
