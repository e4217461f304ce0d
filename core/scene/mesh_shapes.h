/* SPDX-License-Identifier: GPL-3.0-or-later
 * Meshes of what has no faces: curves as prisms, points as polyhedra. Both keep the mean projected size of the round
 * shape: that of a convex body is a quarter of its surface (Cauchy 1832), for a prism's width its girth over pi. */
#ifndef PNB_MESH_SHAPES_H
#define PNB_MESH_SHAPES_H

#include "scene.h"

#include <stdbool.h>

/* The least radius: a tip without any width would have faces without area. */
#define SMALLEST_RADIUS 1e-7f

/* What is handed to pnb_mesh_create: corner i is vertex i. */
struct shape {
    float (*positions)[3], (*normals)[3], (*uvs)[2];
    uint32_t (*triangles)[3];
    uint32_t vertex_count, triangle_count;
};

pnb_result mesh_shape_allocate(struct shape *shape, uint64_t vertices, uint64_t triangles, const char *name);
/* Makes the mesh, if all went well, and frees the shape. */
pnb_result mesh_shape_finish(struct shape *shape, pnb_result result, const char *name, pnb_mesh **mesh);
void mesh_shape_add_triangle(struct shape *shape, uint32_t a, uint32_t b, uint32_t c);
float mesh_shape_read_radius(const pnb_array *radii, uint32_t index, float absent);
/* Errors of a description that both kinds can have. */
pnb_result mesh_shape_check_points(const char *name, uint32_t count, const pnb_array *positions, pnb_mesh **mesh);

float mesh_shape_dot(const float a[3], const float b[3]);
/* False, and nothing written, without a direction. */
bool mesh_shape_normalize(const float from[3], float to[3]);

#endif
