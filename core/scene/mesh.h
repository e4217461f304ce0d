/* SPDX-License-Identifier: GPL-3.0-or-later
 * The making of meshes, shared by pnb_mesh_create and captures. */
#ifndef PNB_MESH_H
#define PNB_MESH_H

#include "scene.h"

/* Three indices of each triangle are counted in 32 bits. */
#define MESH_MAX_TRIANGLES (UINT32_MAX / 3)
/* Material slots beyond are taken as this one; hosts have 15 or 16 bits of them. */
#define MESH_MAX_SLOT 32767u

/* An empty mesh with one reference; NULL without memory. */
pnb_mesh *mesh_allocate(const char *name);
/* Fills vertices, indices, ranges and the warning from a checked description. */
pnb_result mesh_build(const pnb_mesh_desc *from, pnb_mesh *mesh);
/* Computes bounds and content key of a filled mesh. */
void mesh_finish(pnb_mesh *mesh);
/* Whether every edge of a finished mesh joins its triangles, and their fronts are outside. Reads the whole mesh. */
bool mesh_is_closed(const pnb_mesh *mesh);

#endif
