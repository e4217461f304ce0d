/* SPDX-License-Identifier: GPL-3.0-or-later
 * Unit vectors in two signed normalised 16-bit numbers: the octahedron's surface unfolded into a square. */
#ifndef PNB_OCTAHEDRAL_H
#define PNB_OCTAHEDRAL_H

#include <stdbool.h>
#include <stdint.h>

/* False, with `packed` unwritten, if the vector is zero or not finite. Any other length will do. */
bool octahedral_pack(const double vector[3], int16_t packed[2]);

#endif
