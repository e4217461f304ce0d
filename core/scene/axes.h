/* SPDX-License-Identifier: GPL-3.0-or-later
 * The three axes of a column-major 4 x 4 matrix of the host. */
#ifndef PNB_AXES_H
#define PNB_AXES_H

float axis_length(const float axis[3]);
/* Positive if the axes are right-handed. */
double axes_determinant(const float matrix[16]);
/* Replaces axes that are zero or depend on the others by perpendicular ones of length 1. The Z axis, the direction of
 * lights and cameras, is kept if possible, then X. Bit i of the result: axis i was replaced. */
unsigned axes_complete(float matrix[16]);
/* Makes independent axes perpendicular, of length 1 and right-handed, keeping the directions of Z and, as far as
 * possible, Y. */
void axes_orthonormalize(float matrix[16]);
/* Sets the bottom row to 0 0 0 1. */
void matrix_make_affine(float matrix[16]);

#endif
