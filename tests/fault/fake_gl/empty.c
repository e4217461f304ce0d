/* SPDX-License-Identifier: GPL-3.0-or-later
 * A library of the right name without the right functions. */
extern const int fake_gl_empty;
const int fake_gl_empty = 1;
