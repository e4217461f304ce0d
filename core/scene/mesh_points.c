/* SPDX-License-Identifier: GPL-3.0-or-later
 * Points as polyhedra. */
#include "../error.h"
#include "../memory.h"
#include "mesh_shapes.h"
#include "strided.h"

#include <math.h>
#include <string.h>

#define POINT_RADIUS 0.05f /* the default of hosts */

/* Up to so many points each gets 80 triangles, else 20. */
#define FINE_POINTS 20000u

/* A polyhedron around the unit sphere's centre, with its corners on the sphere. */
struct ball {
    float corners[42][3];
    uint8_t faces[80][3];
    uint32_t corner_count, face_count;
    float grow; /* radius of the corners that makes its surface that of the unit sphere */
};

static uint8_t ball_add(struct ball *ball, const float corner[3]) {
    float unit[3] = {0, 0, 1};
    mesh_shape_normalize(corner, unit);
    for (uint32_t i = 0; i < ball->corner_count; i++) {
        if (mesh_shape_dot(ball->corners[i], unit) > 0.9999f) {
            return (uint8_t)i;
        }
    }
    memcpy(ball->corners[ball->corner_count], unit, sizeof unit);
    return (uint8_t)ball->corner_count++;
}

static void ball_icosahedron(struct ball *ball) {
    static const uint8_t faces[20][3] = {{0, 1, 4},  {0, 4, 9},  {9, 4, 5},  {4, 8, 5},  {4, 1, 8},
                                         {8, 1, 10}, {8, 10, 3}, {5, 8, 3},  {5, 3, 2},  {2, 3, 7},
                                         {7, 3, 10}, {7, 10, 6}, {7, 6, 11}, {11, 6, 0}, {0, 6, 1},
                                         {6, 10, 1}, {9, 11, 0}, {9, 2, 11}, {9, 5, 2},  {7, 11, 2}};
    const float z = 1.6180340f; /* the golden ratio */
    const float corners[12][3] = {{-1, 0, z}, {1, 0, z},   {-1, 0, -z}, {1, 0, -z}, {0, z, 1},  {0, z, -1},
                                  {0, -z, 1}, {0, -z, -1}, {z, 1, 0},   {-z, 1, 0}, {z, -1, 0}, {-z, -1, 0}};
    for (int i = 0; i < 12; i++) {
        ball_add(ball, corners[i]);
    }
    memcpy(ball->faces, faces, sizeof faces);
    ball->face_count = 20;
}

/* Cuts each face into four. */
static void ball_subdivide(struct ball *ball) {
    const struct ball coarse = *ball;
    ball->face_count = 0;
    for (uint32_t face = 0; face < coarse.face_count; face++) {
        const uint8_t *corners = coarse.faces[face];
        uint8_t middles[3];
        for (int i = 0; i < 3; i++) {
            const float *a = coarse.corners[corners[i]], *b = coarse.corners[corners[(i + 1) % 3]];
            middles[i] = ball_add(ball, (float[3]){a[0] + b[0], a[1] + b[1], a[2] + b[2]});
        }
        for (int i = 0; i < 3; i++) {
            memcpy(ball->faces[ball->face_count++], (uint8_t[3]){corners[i], middles[i], middles[(i + 2) % 3]}, 3);
        }
        memcpy(ball->faces[ball->face_count++], middles, 3);
    }
}

static void ball_find_size(struct ball *ball) {
    float surface = 0;
    for (uint32_t face = 0; face < ball->face_count; face++) {
        const float *a = ball->corners[ball->faces[face][0]], *b = ball->corners[ball->faces[face][1]];
        const float *c = ball->corners[ball->faces[face][2]];
        const float u[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]}, v[3] = {c[0] - a[0], c[1] - a[1], c[2] - a[2]};
        surface +=
            0.5f * sqrtf(mesh_shape_dot(u, u) * mesh_shape_dot(v, v) - mesh_shape_dot(u, v) * mesh_shape_dot(u, v));
    }
    ball->grow = sqrtf(12.566371f / surface);
}

static void add_point(struct shape *shape, const struct ball *ball, const float center[3], float radius) {
    const uint32_t first = shape->vertex_count;
    for (uint32_t corner = 0; corner < ball->corner_count; corner++) {
        uint32_t vertex = shape->vertex_count++;
        for (int i = 0; i < 3; i++) {
            shape->normals[vertex][i] = ball->corners[corner][i];
            shape->positions[vertex][i] = center[i] + ball->grow * radius * ball->corners[corner][i];
        }
    }
    for (uint32_t face = 0; face < ball->face_count; face++) {
        const uint8_t *corners = ball->faces[face];
        mesh_shape_add_triangle(shape, first + corners[0], first + corners[1], first + corners[2]);
    }
}

pnb_result pnb_mesh_create_points(const pnb_points_desc *desc, pnb_mesh **mesh) {
    pnb_result result = CHECK_STRUCT(desc, pnb_points_desc);
    if (result != PNB_OK) {
        return result;
    }
    const char *name = desc->name ? desc->name : "points";
    if ((result = mesh_shape_check_points(name, desc->point_count, &desc->positions, mesh)) != PNB_OK) {
        return result;
    }
    struct ball ball = {.corner_count = 0};
    ball_icosahedron(&ball);
    if (desc->point_count <= FINE_POINTS) {
        ball_subdivide(&ball);
    }
    ball_find_size(&ball);
    struct shape shape = {0};
    result = mesh_shape_allocate(&shape, (uint64_t)ball.corner_count * desc->point_count,
                                 (uint64_t)ball.face_count * desc->point_count, name);
    for (uint32_t i = 0; result == PNB_OK && i < desc->point_count; i++) {
        float center[3];
        strided_read(&desc->positions, i, center, sizeof center);
        add_point(&shape, &ball, center, mesh_shape_read_radius(&desc->radii, i, POINT_RADIUS));
    }
    return mesh_shape_finish(&shape, result, name, mesh);
}
