/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "shapes.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

static const float PI = 3.14159265358979f;

/* Makes room for one more vertex. */
static bool reserve_vertex(struct shape *shape) {
    if (shape->vertex_count < shape->vertex_capacity)
        return true;
    uint32_t capacity = shape->vertex_capacity ? 2 * shape->vertex_capacity : 64;
    float *positions = realloc(shape->positions, capacity * 3 * sizeof *positions);
    if (positions)
        shape->positions = positions;
    float *normals = realloc(shape->normals, capacity * 3 * sizeof *normals);
    if (normals)
        shape->normals = normals;
    if (!positions || !normals)
        return false;
    shape->vertex_capacity = capacity;
    return true;
}

uint32_t shape_vertex(struct shape *shape, const float position[3], const float normal[3]) {
    static const float no_normal[3] = {0, 0, 0};
    if (!reserve_vertex(shape)) {
        shape->failed = 1;
        return 0;
    }
    uint32_t vertex = shape->vertex_count++;
    memcpy(shape->positions + 3 * (size_t)vertex, position, 3 * sizeof(float));
    memcpy(shape->normals + 3 * (size_t)vertex, normal ? normal : no_normal, 3 * sizeof(float));
    return vertex;
}

void shape_triangle(struct shape *shape, uint32_t a, uint32_t b, uint32_t c) {
    if (shape->triangle_count == shape->triangle_capacity) {
        uint32_t capacity = shape->triangle_capacity ? 2 * shape->triangle_capacity : 64;
        uint32_t *triangles = realloc(shape->triangles, capacity * 3 * sizeof *triangles);
        if (!triangles) {
            shape->failed = 1;
            return;
        }
        shape->triangles = triangles;
        shape->triangle_capacity = capacity;
    }
    uint32_t *triangle = shape->triangles + 3 * (size_t)shape->triangle_count++;
    triangle[0] = a;
    triangle[1] = b;
    triangle[2] = c;
}

/* Unit normal of a surface by central differences, a little inside so that poles have one too. */
static void surface_normal(shape_function function, float u, float v, float normal[3]) {
    const float step = 1e-3f;
    u = fminf(fmaxf(u, step), 1 - step);
    v = fminf(fmaxf(v, step), 1 - step);
    float west[3], east[3], south[3], north[3];
    function(u - step, v, west);
    function(u + step, v, east);
    function(u, v - step, south);
    function(u, v + step, north);
    float du[3], dv[3];
    for (int i = 0; i < 3; i++) {
        du[i] = east[i] - west[i];
        dv[i] = north[i] - south[i];
    }
    normal[0] = du[1] * dv[2] - du[2] * dv[1];
    normal[1] = du[2] * dv[0] - du[0] * dv[2];
    normal[2] = du[0] * dv[1] - du[1] * dv[0];
    float length = sqrtf(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]);
    for (int i = 0; i < 3; i++)
        normal[i] /= length;
}

/* At a pole a side of the quadrilateral vanishes. */
static bool same_place(const struct shape *shape, uint32_t a, uint32_t b) {
    float distance = 0;
    for (int i = 0; i < 3; i++)
        distance += fabsf(shape->positions[3 * (size_t)a + (size_t)i] - shape->positions[3 * (size_t)b + (size_t)i]);
    return distance < 1e-6f;
}

void shape_surface(struct shape *shape, uint32_t columns, uint32_t rows, shape_function function) {
    uint32_t first = shape->vertex_count;
    for (uint32_t row = 0; row <= rows; row++) {
        for (uint32_t column = 0; column <= columns; column++) {
            float u = (float)column / (float)columns, v = (float)row / (float)rows;
            float position[3], normal[3];
            function(u, v, position);
            surface_normal(function, u, v, normal);
            shape_vertex(shape, position, normal);
        }
    }
    if (shape->failed)
        return;
    for (uint32_t row = 0; row < rows; row++) {
        for (uint32_t column = 0; column < columns; column++) {
            uint32_t a = first + row * (columns + 1) + column;
            uint32_t b = a + columns + 1;
            if (!same_place(shape, a, a + 1))
                shape_triangle(shape, a, a + 1, b + 1);
            if (!same_place(shape, b, b + 1))
                shape_triangle(shape, a, b + 1, b);
        }
    }
}

static void quadrilateral(struct shape *shape, const float corners[4][3]) {
    uint32_t first = shape->vertex_count;
    for (int i = 0; i < 4; i++)
        shape_vertex(shape, corners[i], NULL);
    shape_triangle(shape, first, first + 1, first + 2);
    shape_triangle(shape, first, first + 2, first + 3);
}

void shape_rectangle(struct shape *shape, float x0, float y0, float x1, float y1, float z) {
    quadrilateral(shape, (const float[4][3]){{x0, y0, z}, {x1, y0, z}, {x1, y1, z}, {x0, y1, z}});
}

void shape_disc(struct shape *shape, uint32_t sides, float radius, float z) {
    uint32_t centre = shape_vertex(shape, (const float[3]){0, 0, z}, NULL);
    for (uint32_t i = 0; i < sides; i++) {
        float angle = 2 * PI * (float)i / (float)sides;
        shape_vertex(shape, (const float[3]){radius * cosf(angle), radius * sinf(angle), z}, NULL);
    }
    for (uint32_t i = 0; i < sides; i++)
        shape_triangle(shape, centre, centre + 1 + i, centre + 1 + (i + 1) % sides);
}

void shape_box(struct shape *shape, const float minimum[3], const float maximum[3]) {
    /* Bit 0, 1, 2 of a corner: the maximum along x, y, z. */
    static const int faces[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    for (int face = 0; face < 6; face++) {
        float corners[4][3];
        for (int corner = 0; corner < 4; corner++)
            for (int axis = 0; axis < 3; axis++)
                corners[corner][axis] = (faces[face][corner] >> axis & 1) ? maximum[axis] : minimum[axis];
        quadrilateral(shape, (const float(*)[3])corners);
    }
}

static void sphere_point(float u, float v, float position[3]) {
    float radius = sinf(PI * v);
    position[0] = radius * cosf(2 * PI * u);
    position[1] = radius * sinf(2 * PI * u);
    position[2] = -cosf(PI * v);
}

void shape_sphere(struct shape *shape, uint32_t columns, uint32_t rows) {
    shape_surface(shape, columns, rows, sphere_point);
}

static void tube_point(float u, float v, float position[3]) {
    position[0] = cosf(2 * PI * u);
    position[1] = sinf(2 * PI * u);
    position[2] = v;
}

void shape_tube(struct shape *shape, uint32_t columns, uint32_t rows) {
    shape_surface(shape, columns, rows, tube_point);
}

static void ring_point(float u, float v, float position[3]) {
    float around = 2 * PI * u, across = 2 * PI * v;
    float thickness = 0.35f * (1 + 0.12f * sinf(9 * around + 2 * across) + 0.05f * sinf(6 * across - 5 * around));
    float radius = 1 + thickness * cosf(across);
    position[0] = radius * cosf(around);
    position[1] = radius * sinf(around);
    position[2] = thickness * sinf(across);
}

void shape_rippled_ring(struct shape *shape, uint32_t columns, uint32_t rows) {
    shape_surface(shape, columns, rows, ring_point);
}

void shape_perforated_sheet(struct shape *shape, uint32_t holes) {
    uint32_t cells = 2 * holes + 1;
    float side = 2 / (float)cells;
    for (uint32_t row = 0; row < cells; row++) {
        for (uint32_t column = 0; column < cells; column++) {
            if (row % 2 && column % 2)
                continue;
            float x = -1 + side * (float)column, y = -1 + side * (float)row;
            shape_rectangle(shape, x, y, x + side, y + side, 0);
        }
    }
}

pnb_mesh *shape_finish(struct shape *shape, const char *name) {
    pnb_mesh *mesh = NULL;
    if (!shape->failed) {
        pnb_mesh_desc desc = PNB_INIT(pnb_mesh_desc);
        desc.name = name;
        desc.vertex_count = desc.corner_count = shape->vertex_count;
        desc.triangle_count = shape->triangle_count;
        desc.positions.data = shape->positions;
        desc.corner_normals.data = shape->normals;
        desc.triangles.data = shape->triangles;
        pnb_mesh_create(&desc, &mesh);
    }
    free(shape->positions);
    free(shape->normals);
    free(shape->triangles);
    *shape = (struct shape){0};
    return mesh;
}
