/* SPDX-License-Identifier: GPL-3.0-or-later
 * Sample patterns on emitters and pixels. */
#ifndef PNB_SAMPLING_H
#define PNB_SAMPLING_H

#include <stdbool.h>
#include <stdint.h>

/* Most points of one tap pattern: 32 x 32. */
#define MAX_TAPS 1024

/* Sample points of a technique's search and filter; std140 as common_taps.glsl reads it. */
struct taps {
    float search[MAX_TAPS][2], filter[MAX_TAPS][2];
    int search_count, filter_count;
};

enum pattern { PATTERN_VOGEL, PATTERN_GRID };

/* Fills `points` with points of [-1, 1]^2, or of the unit disk, evenly dense, whose centroid is near 0. VOGEL takes
 * `count` points, GRID the cell centres of the largest n x n <= count. turn: which of a set of patterns that complete
 * each other. Returns the number of points; the one after an odd number is set far away. */
int pattern_fill(enum pattern pattern, int count, bool disk, uint32_t turn, float points[][2]);

/* Point i of `count` points of a light, any number, for the truth: Vogel's spiral, also on the square. What lies on one
 * side of a line is off its share by 0.28 / count^(3/4), root mean square over lines of one direction, 0.4 in the worst
 * direction; a lattice is better along the axes but has directions in which it is no better than a grid. turn: see
 * pattern_fill. */
void light_point(int i, int count, bool disk, uint32_t turn, float point[2]);

/* Point i of `count` points of the unit sphere, evenly dense: Vogel's spiral on a sphere (a Fibonacci lattice). Any
 * hemisphere has its centroid where it should be, which cannot be said of a grid. turn: see pattern_fill. */
void sphere_point(int i, int count, uint32_t turn, float point[3]);

/* Area-preserving map of [-1, 1]^2 to the unit disk (Shirley and Chiu 1997), and back. */
void square_to_disk(float point[2]);
void disk_to_square(float point[2]);

/* Offset in pixels from the centre, of sample `index` of `count`, distributed as a Blackman-Harris filter of that
 * width. One sample is at the centre. */
void pixel_sample(uint32_t index, uint32_t count, float filter_width, float offset[2]);

#endif
