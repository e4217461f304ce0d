/* SPDX-License-Identifier: GPL-3.0-or-later
 * Meshes of what has no faces: curves as prisms, points as polyhedra. Both keep the mean projected size of the round
 * shape: that of a convex body is a quarter of its surface (Cauchy 1832), for a prism's width its girth over pi. */
#include "../error.h"
#include "../memory.h"
#include "scene.h"
#include "strided.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

/* Hosts' own defaults of the radii, and the least one: a tip without any width would have faces without area. */
#define STRAND_RADIUS   0.005f
#define POINT_RADIUS    0.05f
#define SMALLEST_RADIUS 1e-7f

/* What is handed to pnb_mesh_create: corner i is vertex i. */
struct shape {
    float (*positions)[3], (*normals)[3], (*uvs)[2];
    uint32_t (*triangles)[3];
    uint32_t vertex_count, triangle_count;
};

static pnb_result shape_allocate(struct shape *shape, uint64_t vertices, uint64_t triangles, const char *name) {
    if (vertices > UINT32_MAX || triangles > UINT32_MAX / 3) {
        return error_set(PNB_ERROR_INVALID_ARGUMENT, "mesh '%s': it has too many points", name);
    }
    shape->positions = memory_array((size_t)vertices, sizeof *shape->positions);
    shape->normals = memory_array((size_t)vertices, sizeof *shape->normals);
    shape->uvs = memory_array((size_t)vertices, sizeof *shape->uvs);
    shape->triangles = memory_array((size_t)triangles, sizeof *shape->triangles);
    return shape->positions && shape->normals && shape->uvs && shape->triangles ? PNB_OK : PNB_ERROR_OUT_OF_MEMORY;
}

/* Makes the mesh, if all went well, and frees the shape. */
static pnb_result shape_finish(struct shape *shape, pnb_result result, const char *name, pnb_mesh **mesh) {
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

static void shape_add_triangle(struct shape *shape, uint32_t a, uint32_t b, uint32_t c) {
    uint32_t *triangle = shape->triangles[shape->triangle_count++];
    triangle[0] = a, triangle[1] = b, triangle[2] = c;
}

static float read_radius(const pnb_array *radii, uint32_t index, float absent) {
    float radius = absent;
    if (radii->data) {
        strided_read(radii, index, &radius, sizeof radius);
    }
    return radius > SMALLEST_RADIUS ? radius : SMALLEST_RADIUS; /* not a number: the smallest */
}

static pnb_result check_points(const char *name, uint32_t count, const pnb_array *positions, pnb_mesh **mesh) {
    if (!mesh || (count > 0 && !positions->data)) {
        return error_set(PNB_ERROR_INVALID_ARGUMENT, "mesh '%s': %s is NULL", name, mesh ? "positions" : "mesh");
    }
    return PNB_OK;
}

/* ---- Strands ---- */

static float dot(const float a[3], const float b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* False, and nothing written, without a direction. */
static bool normalize(const float from[3], float to[3]) {
    float length = sqrtf(dot(from, from));
    if (!(length > 0) || !isfinite(length)) {
        return false;
    }
    for (int i = 0; i < 3; i++) {
        to[i] = from[i] / length;
    }
    return true;
}

/* Turns `side` as little as needed to be perpendicular to the unit vector `tangent`. */
static void align_side(const float tangent[3], float side[3]) {
    float along = dot(side, tangent), rest[3];
    for (int i = 0; i < 3; i++) {
        rest[i] = side[i] - along * tangent[i];
    }
    if (dot(rest, rest) < 1e-6f || !normalize(rest, side)) {
        int least = fabsf(tangent[0]) < fabsf(tangent[1]) ? 0 : 1;
        least = fabsf(tangent[2]) < fabsf(tangent[least]) ? 2 : least;
        for (int i = 0; i < 3; i++) {
            rest[i] = (i == least ? 1.0f : 0.0f) - tangent[least] * tangent[i];
        }
        normalize(rest, side);
    }
}

static void add_ring(struct shape *shape, const float center[3], const float tangent[3], const float side[3],
                     float radius, const float uv[2]) {
    const float grow = 1.2091996f; /* 2 pi / (3 sqrt 3): the prism's girth is the tube's */
    const float other[3] = {tangent[1] * side[2] - tangent[2] * side[1], tangent[2] * side[0] - tangent[0] * side[2],
                            tangent[0] * side[1] - tangent[1] * side[0]};
    static const float turns[3][2] = {{1, 0}, {-0.5f, 0.8660254f}, {-0.5f, -0.8660254f}};
    for (int corner = 0; corner < 3; corner++) {
        uint32_t vertex = shape->vertex_count++;
        for (int i = 0; i < 3; i++) {
            float normal = turns[corner][0] * side[i] + turns[corner][1] * other[i];
            shape->normals[vertex][i] = normal;
            shape->positions[vertex][i] = center[i] + grow * radius * normal;
        }
        memcpy(shape->uvs[vertex], uv, sizeof shape->uvs[vertex]);
    }
}

static void add_walls(struct shape *shape) {
    const uint32_t first = shape->vertex_count - 6;
    for (uint32_t corner = 0; corner < 3; corner++) {
        uint32_t a = first + corner, b = first + (corner + 1) % 3;
        shape_add_triangle(shape, a, b, b + 3);
        shape_add_triangle(shape, a, b + 3, a + 3);
    }
}

/* Points first .. last - 1. A point on the one before it is left out. */
static void add_strand(struct shape *shape, const pnb_strands_desc *desc, uint32_t first, uint32_t last,
                       const float uv[2]) {
    float side[3] = {0, 0, 0}, tangent[3] = {0, 0, 1}, here[3], there[3];
    uint32_t rings = 0;
    for (uint32_t point = first; point < last; point++) {
        float step[3] = {0, 0, 0};
        strided_read(&desc->positions, point, here, sizeof here);
        if (point + 1 < last) {
            strided_read(&desc->positions, point + 1, there, sizeof there);
            for (int i = 0; i < 3; i++) {
                step[i] = there[i] - here[i];
            }
        }
        if (!normalize(step, step) && point + 1 < last) {
            continue;
        }
        /* The mean direction of both segments; at the ends that of the only one. */
        for (int i = 0; i < 3; i++) {
            tangent[i] = rings > 0 ? tangent[i] + step[i] : step[i];
        }
        if (!normalize(tangent, tangent)) {
            memcpy(tangent, dot(step, step) > 0 ? step : (float[3]){0, 0, 1}, sizeof tangent);
        }
        align_side(tangent, side);
        add_ring(shape, here, tangent, side, read_radius(&desc->radii, point, STRAND_RADIUS), uv);
        if (rings++ > 0) {
            add_walls(shape);
        }
        memcpy(tangent, dot(step, step) > 0 ? step : tangent, sizeof tangent);
    }
}

static pnb_result check_strands(const pnb_strands_desc *desc, pnb_mesh **mesh) {
    pnb_result result = CHECK_STRUCT(desc, pnb_strands_desc);
    if (result != PNB_OK) {
        return result;
    }
    const char *name = desc->name ? desc->name : "strands";
    if (desc->strand_count > 0 && !desc->first_points.data) {
        return error_set(PNB_ERROR_INVALID_ARGUMENT, "mesh '%s': first_points is NULL", name);
    }
    for (uint32_t i = 0, before = 0; i < desc->strand_count; i++) {
        uint32_t first = strided_read_u32(&desc->first_points, i);
        if (first < before || first > desc->point_count) {
            return error_set(PNB_ERROR_INVALID_ARGUMENT, "mesh '%s': strand %" PRIu32 " begins at point %" PRIu32, name,
                             i, first);
        }
        before = first;
    }
    return check_points(name, desc->point_count, &desc->positions, mesh);
}

pnb_result pnb_mesh_create_strands(const pnb_strands_desc *desc, pnb_mesh **mesh) {
    pnb_result result = check_strands(desc, mesh);
    if (result != PNB_OK) {
        return result;
    }
    const char *name = desc->name ? desc->name : "strands";
    struct shape shape = {0};
    result = shape_allocate(&shape, 3ull * desc->point_count, 6ull * desc->point_count, name);
    for (uint32_t i = 0; result == PNB_OK && i < desc->strand_count; i++) {
        const bool is_last = i + 1 == desc->strand_count;
        float uv[2] = {0, 0};
        if (desc->uvs.data) {
            strided_read(&desc->uvs, i, uv, sizeof uv);
        }
        add_strand(&shape, desc, strided_read_u32(&desc->first_points, i),
                   is_last ? desc->point_count : strided_read_u32(&desc->first_points, i + 1), uv);
    }
    return shape_finish(&shape, result, name, mesh);
}

/* ---- Points ---- */

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
    normalize(corner, unit);
    for (uint32_t i = 0; i < ball->corner_count; i++) {
        if (dot(ball->corners[i], unit) > 0.9999f) {
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
        surface += 0.5f * sqrtf(dot(u, u) * dot(v, v) - dot(u, v) * dot(u, v));
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
        shape_add_triangle(shape, first + corners[0], first + corners[1], first + corners[2]);
    }
}

pnb_result pnb_mesh_create_points(const pnb_points_desc *desc, pnb_mesh **mesh) {
    pnb_result result = CHECK_STRUCT(desc, pnb_points_desc);
    if (result != PNB_OK) {
        return result;
    }
    const char *name = desc->name ? desc->name : "points";
    if ((result = check_points(name, desc->point_count, &desc->positions, mesh)) != PNB_OK) {
        return result;
    }
    struct ball ball = {.corner_count = 0};
    ball_icosahedron(&ball);
    if (desc->point_count <= FINE_POINTS) {
        ball_subdivide(&ball);
    }
    ball_find_size(&ball);
    struct shape shape = {0};
    result = shape_allocate(&shape, (uint64_t)ball.corner_count * desc->point_count,
                            (uint64_t)ball.face_count * desc->point_count, name);
    for (uint32_t i = 0; result == PNB_OK && i < desc->point_count; i++) {
        float center[3];
        strided_read(&desc->positions, i, center, sizeof center);
        add_point(&shape, &ball, center, read_radius(&desc->radii, i, POINT_RADIUS));
    }
    return shape_finish(&shape, result, name, mesh);
}
