/* SPDX-License-Identifier: GPL-3.0-or-later
 * Triangle meshes of simple shapes, for scenes built by tests. */
#ifndef SHAPES_H
#define SHAPES_H

#include <penumbra.h>

/* Growing arrays of a mesh under construction. A failed allocation sets `failed` and drops what follows. */
struct shape {
    float *positions, *normals; /* 3 per vertex; a zero normal stands for the triangle's own */
    uint32_t *triangles;        /* 3 per triangle, counter-clockwise seen from the front */
    uint32_t vertex_count, triangle_count;
    uint32_t vertex_capacity, triangle_capacity;
    int failed;
};

uint32_t shape_vertex(struct shape *shape, const float position[3], const float normal[3]);
void shape_triangle(struct shape *shape, uint32_t a, uint32_t b, uint32_t c);

/* Position of a surface at u, v in 0..1; its front is the side of d/du x d/dv. */
typedef void (*shape_function)(float u, float v, float position[3]);
/* A surface of columns x rows quadrilaterals with smooth normals. */
void shape_surface(struct shape *shape, uint32_t columns, uint32_t rows, shape_function function);

/* Horizontal rectangle facing up. */
void shape_rectangle(struct shape *shape, float x0, float y0, float x1, float y1, float z);
/* Horizontal disc around the Z axis facing up. */
void shape_disc(struct shape *shape, uint32_t sides, float radius, float z);
void shape_box(struct shape *shape, const float minimum[3], const float maximum[3]);
/* Unit sphere, unit-height and unit-radius open tube from z = 0, and ring of radius 1 and thickness 0.35 with ripples.
 */
void shape_sphere(struct shape *shape, uint32_t columns, uint32_t rows);
void shape_tube(struct shape *shape, uint32_t columns, uint32_t rows);
void shape_rippled_ring(struct shape *shape, uint32_t columns, uint32_t rows);
/* Square sheet of side 2 facing up with holes x holes square holes, as wide as the bars between them. */
void shape_perforated_sheet(struct shape *shape, uint32_t holes);

/* Makes the mesh and frees the shape. NULL on failure (pnb_last_error tells why). */
pnb_mesh *shape_finish(struct shape *shape, const char *name);

#endif
