/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "mesh_shapes.h"
#include "../error.h"
#include "../memory.h"
#include "strided.h"

#include <math.h>

pnb_result mesh_shape_allocate(struct shape *shape, uint64_t vertices, uint64_t triangles, const char *name) {
    if (vertices > UINT32_MAX || triangles > UINT32_MAX / 3) {
        return error_set(PNB_ERROR_INVALID_ARGUMENT, "mesh '%s': it has too many points", name);
    }
    shape->positions = memory_array((size_t)vertices, sizeof *shape->positions);
    shape->normals = memory_array((size_t)vertices, sizeof *shape->normals);
    shape->uvs = memory_array((size_t)vertices, sizeof *shape->uvs);
    shape->triangles = memory_array((size_t)triangles, sizeof *shape->triangles);
    return shape->positions && shape->normals && shape->uvs && shape->triangles ? PNB_OK : PNB_ERROR_OUT_OF_MEMORY;
}

pnb_result mesh_shape_finish(struct shape *shape, pnb_result result, const char *name, pnb_mesh **mesh) {
    if (result == PNB_OK) {
        const pnb_mesh_desc desc = {.struct_size = sizeof desc,
                                    .vertex_count = shape->vertex_count,
                                    .corner_count = shape->vertex_count,
                                    .triangle_count = shape->triangle_count,
                                    .name = name,
                                    .positions = {shape->positions, sizeof *shape->positions},
                                    .corner_normals = {shape->normals, sizeof *shape->normals},
                                    .corner_uvs = {shape->uvs, sizeof *shape->uvs},
                                    .triangles = {shape->triangles, sizeof *shape->triangles}};
        result = pnb_mesh_create(&desc, mesh);
    }
    memory_free(shape->positions);
    memory_free(shape->normals);
    memory_free(shape->uvs);
    memory_free(shape->triangles);
    return result;
}

void mesh_shape_add_triangle(struct shape *shape, uint32_t a, uint32_t b, uint32_t c) {
    uint32_t *triangle = shape->triangles[shape->triangle_count++];
    triangle[0] = a, triangle[1] = b, triangle[2] = c;
}

float mesh_shape_read_radius(const pnb_array *radii, uint32_t index, float absent) {
    float radius = absent;
    if (radii->data) {
        strided_read(radii, index, &radius, sizeof radius);
    }
    return radius > SMALLEST_RADIUS ? radius : SMALLEST_RADIUS; /* not a number: the smallest */
}

pnb_result mesh_shape_check_points(const char *name, uint32_t count, const pnb_array *positions, pnb_mesh **mesh) {
    if (!mesh || (count > 0 && !positions->data)) {
        return error_set(PNB_ERROR_INVALID_ARGUMENT, "mesh '%s': %s is NULL", name, mesh ? "positions" : "mesh");
    }
    return PNB_OK;
}

float mesh_shape_dot(const float a[3], const float b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

bool mesh_shape_normalize(const float from[3], float to[3]) {
    float length = sqrtf(mesh_shape_dot(from, from));
    if (!(length > 0) || !isfinite(length)) {
        return false;
    }
    for (int i = 0; i < 3; i++) {
        to[i] = from[i] / length;
    }
    return true;
}
