/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "memory.h"
#include "scene/content_key.h"
#include "scene/mesh.h"
#include "scene/octahedral.h"

#include <float.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- A cube the way modelling programs keep it: 8 vertices, 6 quads with 4 corners each ---- */

struct cube {
    float positions[8][3];
    uint32_t corner_vertices[24];
    float normals[24][3];
    float uvs[24][2];
    uint32_t triangles[12][3];
    uint32_t polygons[12];
    int32_t materials[6];
    pnb_mesh_desc desc;
};

static void cube_init(struct cube *cube) {
    memset(cube, 0, sizeof *cube);
    for (uint32_t v = 0; v < 8; v++) {
        for (uint32_t axis = 0; axis < 3; axis++) {
            cube->positions[v][axis] = v & 1u << axis ? 1.0f : -1.0f;
        }
    }
    for (uint32_t face = 0; face < 6; face++) {
        uint32_t axis = face / 2, u = (axis + 1) % 3, v = (axis + 2) % 3;
        for (uint32_t i = 0; i < 4; i++) {
            uint32_t right = i == 1 || i == 2, up = i >= 2, corner = 4 * face + i;
            cube->corner_vertices[corner] = (face % 2) << axis | right << u | up << v;
            cube->normals[corner][axis] = face % 2 ? 2.0f : -2.0f; /* not normalised */
            cube->uvs[corner][0] = (float)right;
            cube->uvs[corner][1] = (float)up;
        }
        for (uint32_t half = 0; half < 2; half++) {
            uint32_t *triangle = cube->triangles[2 * face + half];
            uint32_t second = half ? 2 : 1, third = half ? 3 : 2;
            triangle[0] = 4 * face;
            triangle[1] = 4 * face + (face % 2 ? second : third);
            triangle[2] = 4 * face + (face % 2 ? third : second);
            cube->polygons[2 * face + half] = face;
        }
        cube->materials[face] = (int32_t)(face % 3);
    }
    cube->desc = (pnb_mesh_desc){.struct_size = sizeof cube->desc,
                                 .name = "Cube",
                                 .vertex_count = 8,
                                 .corner_count = 24,
                                 .triangle_count = 12,
                                 .polygon_count = 6,
                                 .positions = {cube->positions, 0},
                                 .corner_vertices = {cube->corner_vertices, 0},
                                 .corner_normals = {cube->normals, 0},
                                 .corner_uvs = {cube->uvs, 0},
                                 .triangles = {cube->triangles, 0},
                                 .triangle_polygons = {cube->polygons, 0},
                                 .polygon_materials = {cube->materials, 0}};
}

static pnb_mesh *create(const pnb_mesh_desc *desc) {
    pnb_mesh *mesh = NULL;
    assert_int_equal(pnb_mesh_create(desc, &mesh), PNB_OK);
    assert_non_null(mesh);
    return mesh;
}

static void decode_normal(const int16_t packed[2], double normal[3]) {
    double x = fmax(packed[0] / 32767.0, -1), y = fmax(packed[1] / 32767.0, -1), z = 1 - fabs(x) - fabs(y);
    if (z < 0) {
        double folded = (1 - fabs(y)) * (x < 0 ? -1 : 1);
        y = (1 - fabs(x)) * (y < 0 ? -1 : 1);
        x = folded;
    }
    double length = sqrt(x * x + y * y + z * z);
    normal[0] = x / length;
    normal[1] = y / length;
    normal[2] = z / length;
}

/* Radians, accurate for small angles. */
static double angle_between(const double a[3], const double b[3]) {
    double x = a[1] * b[2] - a[2] * b[1], y = a[2] * b[0] - a[0] * b[2], z = a[0] * b[1] - a[1] * b[0];
    return atan2(sqrt(x * x + y * y + z * z), a[0] * b[0] + a[1] * b[1] + a[2] * b[2]);
}

/* ---- Octahedral normals ---- */

/* Rounding moves a point of the octahedron by up to half a step h = 0.5 / 32767 in x and y each, so by 2 h in z, in
 * all by sqrt(6) h; it is at least 1 / sqrt(3) from the centre: sqrt(18) h = 6.47e-5 radians. */
#define NORMAL_TOLERANCE 6.5e-5

static void normals_survive_packing(void **state) {
    (void)state;
    double worst = 0;
    for (int i = -50; i <= 50; i++) {
        for (int j = -50; j <= 50; j++) {
            double latitude = i * 3.14159265358979 / 100, longitude = j * 3.14159265358979 / 50;
            double normal[3] = {cos(latitude) * cos(longitude), cos(latitude) * sin(longitude), sin(latitude)};
            const double scale = 0x1p60; /* exact */
            double scaled[3] = {normal[0] * scale, normal[1] * scale, normal[2] * scale}, back[3];
            int16_t packed[2], from_scaled[2];
            assert_true(octahedral_pack(normal, packed));
            assert_true(octahedral_pack(scaled, from_scaled));
            assert_int_equal(packed[0], from_scaled[0]);
            assert_int_equal(packed[1], from_scaled[1]);
            decode_normal(packed, back);
            worst = fmax(worst, angle_between(normal, back));
        }
    }
    assert_true(worst < NORMAL_TOLERANCE);
}

static void axes_pack_exactly(void **state) {
    (void)state;
    static const struct {
        double normal[3];
        int16_t packed[2];
    } cases[] = {{{1, 0, 0}, {32767, 0}},   {{-1, 0, 0}, {-32767, 0}}, {{0, 1, 0}, {0, 32767}},
                 {{0, -1, 0}, {0, -32767}}, {{0, 0, 1}, {0, 0}},       {{0, 0, -1}, {32767, 32767}}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        int16_t packed[2];
        assert_true(octahedral_pack(cases[i].normal, packed));
        assert_int_equal(packed[0], cases[i].packed[0]);
        assert_int_equal(packed[1], cases[i].packed[1]);
    }
}

static void directionless_vectors_do_not_pack(void **state) {
    (void)state;
    int16_t packed[2];
    assert_false(octahedral_pack((double[3]){0, 0, 0}, packed));
    assert_false(octahedral_pack((double[3]){(double)NAN, 0, 1}, packed));
    assert_false(octahedral_pack((double[3]){(double)INFINITY, 0, 1}, packed));
}

/* ---- Closed meshes ---- */

static bool cube_is_closed(const struct cube *cube, uint32_t triangles) {
    pnb_mesh_desc desc = cube->desc;
    desc.triangle_count = triangles;
    pnb_mesh *mesh = create(&desc);
    const bool closed = mesh_is_closed(mesh);
    pnb_mesh_destroy(&mesh);
    return closed;
}

static void cube_turn(struct cube *cube, uint32_t triangle) {
    const uint32_t kept = cube->triangles[triangle][1];
    cube->triangles[triangle][1] = cube->triangles[triangle][2];
    cube->triangles[triangle][2] = kept;
}

/* By the places of the edges' ends: split corners do not open a mesh, a missing or a turned triangle does. */
static void closed_meshes_are_known(void **state) {
    (void)state;
    struct cube cube;
    cube_init(&cube);
    assert_true(cube_is_closed(&cube, 12));
    assert_false(cube_is_closed(&cube, 11));
    assert_false(cube_is_closed(&cube, 0));
    for (uint32_t v = 0; v < 8; v++) {
        cube.positions[v][2] = v & 4u ? 1.0f : (v & 1u ? -0.0f : 0.0f); /* one zero and the other */
    }
    assert_true(cube_is_closed(&cube, 12));
    cube_turn(&cube, 5);
    assert_false(cube_is_closed(&cube, 12));
    for (uint32_t t = 0; t < 12; t++) {
        if (t != 5) {
            cube_turn(&cube, t);
        }
    }
    assert_false(cube_is_closed(&cube, 12)); /* inside out */
}

/* ---- Welding ---- */

static void cube_is_welded_and_sorted(void **state) {
    (void)state;
    struct cube cube;
    cube_init(&cube);
    pnb_mesh *mesh = create(&cube.desc);
    assert_string_equal(pnb_mesh_warning(mesh), "");
    assert_int_equal(mesh->vertex_count, 24); /* the two triangles of a face share two corners */
    assert_int_equal(mesh->index_count, 36);
    assert_int_equal(mesh->range_count, 3);
    for (uint32_t i = 0; i < 3; i++) {
        assert_int_equal(mesh->ranges[i].slot, i);
        assert_int_equal(mesh->ranges[i].first_index, 12 * i);
        assert_int_equal(mesh->ranges[i].index_count, 12);
        assert_true(mesh->bounds[0][i] == -1 && mesh->bounds[1][i] == 1);
    }
    /* Slot 0 are faces 0 and 3: -X and +Y. Stable: -X first. Every corner has its face's normal and its own uv. */
    for (uint32_t i = 0; i < 12; i++) {
        const struct vertex *vertex = &mesh->vertices[mesh->indices[i]];
        uint32_t face = i < 6 ? 0 : 3, corner = cube.triangles[2 * face + i % 6 / 3][i % 3];
        double normal[3], expected[3] = {cube.normals[4 * face][0] / 2, cube.normals[4 * face][1] / 2, 0};
        decode_normal(vertex->normal, normal);
        assert_true(angle_between(normal, expected) < 1e-12);
        assert_memory_equal(vertex->position, cube.positions[cube.corner_vertices[corner]], 12);
        assert_memory_equal(vertex->uv, cube.uvs[corner], 8);
    }
    pnb_mesh_destroy(&mesh);
}

static void equal_corners_are_one_vertex(void **state) {
    (void)state;
    struct cube cube;
    cube_init(&cube);
    memcpy(cube.normals, (float[24][3]){{0}}, sizeof cube.normals);
    for (int i = 0; i < 24; i++) {
        memcpy(cube.normals[i], cube.positions[cube.corner_vertices[i]], sizeof cube.normals[i]);
    }
    cube.desc.corner_uvs.data = NULL;
    pnb_mesh *mesh = create(&cube.desc);
    assert_int_equal(mesh->vertex_count, 8); /* smooth: as many as the cube has */
    pnb_mesh_destroy(&mesh);
    cube.desc.corner_uvs.data = cube.uvs;
    mesh = create(&cube.desc);
    assert_true(mesh->vertex_count > 8); /* differing uvs keep corners apart */
    pnb_mesh_destroy(&mesh);
}

static void flat_normals_stand_in(void **state) {
    (void)state;
    struct cube cube;
    cube_init(&cube);
    pnb_mesh *given = create(&cube.desc);
    cube.desc.corner_normals.data = NULL;
    pnb_mesh *absent = create(&cube.desc);
    assert_true(content_key_equal(&given->content, &absent->content));
    float zero_and_broken[24][3] = {{0}};
    zero_and_broken[5][1] = NAN;
    zero_and_broken[7][0] = INFINITY;
    cube.desc.corner_normals.data = zero_and_broken;
    pnb_mesh *useless = create(&cube.desc);
    assert_true(content_key_equal(&given->content, &useless->content));
    pnb_mesh_destroy(&given);
    pnb_mesh_destroy(&absent);
    pnb_mesh_destroy(&useless);
}

/* Any number of different corners at one vertex take linear time: 300,000 compared with each other would need
 * minutes. */
static void fan_is_linear(void **state) {
    (void)state;
    const uint32_t count = 300000;
    float *positions = calloc(count + 2, sizeof(float[3])), *uvs = calloc(3 * (size_t)count, sizeof(float[2]));
    uint32_t *vertices = calloc(3 * (size_t)count, sizeof *vertices);
    uint32_t *triangles = calloc(3 * (size_t)count, sizeof *triangles);
    assert_true(positions && uvs && vertices && triangles);
    for (uint32_t i = 0; i <= count; i++) {
        double angle = 6.28 * i / count;
        positions[3 * i + 3] = (float)cos(angle);
        positions[3 * i + 4] = (float)sin(angle);
    }
    for (uint32_t i = 0; i < 3 * count; i++) {
        vertices[i] = i % 3 ? 1 + i / 3 + (i % 3 - 1) : 0;
        uvs[2 * i] = (float)i;
        triangles[i] = i;
    }
    pnb_mesh_desc desc = {.struct_size = sizeof desc,
                          .vertex_count = count + 2,
                          .corner_count = 3 * count,
                          .triangle_count = count,
                          .positions = {positions, 0},
                          .corner_vertices = {vertices, 0},
                          .corner_uvs = {uvs, 0},
                          .triangles = {triangles, 0}};
    pnb_mesh *mesh = create(&desc);
    assert_int_equal(mesh->index_count, 3 * count);
    assert_int_equal(mesh->vertex_count, 3 * count);
    pnb_mesh_destroy(&mesh);
    free(positions);
    free(uvs);
    free(vertices);
    free(triangles);
}

/* ---- Layouts ---- */

/* Interleaved, unaligned and spread data make the same mesh as packed arrays. */
static void strides_and_alignment_do_not_matter(void **state) {
    (void)state;
    struct cube cube;
    cube_init(&cube);
    pnb_mesh *packed = create(&cube.desc);
    enum { STRIDE = 37, OFFSET = 3 };
    static unsigned char positions[8 * STRIDE + 64], corners[24 * STRIDE + 64], triangles[12 * STRIDE + 64];
    for (size_t i = 0; i < 8; i++) {
        memcpy(positions + OFFSET + i * STRIDE, cube.positions[i], 12);
    }
    for (size_t i = 0; i < 24; i++) {
        memcpy(corners + OFFSET + i * STRIDE, &cube.corner_vertices[i], 4);
        memcpy(corners + OFFSET + 4 + i * STRIDE, cube.normals[i], 12);
        memcpy(corners + OFFSET + 16 + i * STRIDE, cube.uvs[i], 8);
    }
    for (size_t i = 0; i < 12; i++) {
        memcpy(triangles + OFFSET + i * STRIDE, cube.triangles[i], 12);
        memcpy(triangles + OFFSET + 12 + i * STRIDE, &cube.polygons[i], 4);
    }
    cube.desc.positions = (pnb_array){positions + OFFSET, STRIDE};
    cube.desc.corner_vertices = (pnb_array){corners + OFFSET, STRIDE};
    cube.desc.corner_normals = (pnb_array){corners + OFFSET + 4, STRIDE};
    cube.desc.corner_uvs = (pnb_array){corners + OFFSET + 16, STRIDE};
    cube.desc.triangles = (pnb_array){triangles + OFFSET, STRIDE};
    cube.desc.triangle_polygons = (pnb_array){triangles + OFFSET + 12, STRIDE};
    pnb_mesh *strided = create(&cube.desc);
    assert_true(content_key_equal(&packed->content, &strided->content));
    pnb_mesh_destroy(&packed);
    pnb_mesh_destroy(&strided);
}

static void absent_arrays_have_their_defaults(void **state) {
    (void)state;
    static const float positions[3][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    static const uint32_t triangle[3] = {0, 1, 2};
    pnb_mesh_desc desc = {.struct_size = sizeof desc,
                          .vertex_count = 3,
                          .corner_count = 3,
                          .triangle_count = 1,
                          .positions = {positions, 0},
                          .triangles = {triangle, 0}};
    pnb_mesh *mesh = create(&desc);
    assert_string_equal(mesh->name, "mesh");
    assert_int_equal(mesh->vertex_count, 3);
    assert_int_equal(mesh->range_count, 1);
    assert_int_equal(mesh->ranges[0].slot, 0);
    for (int i = 0; i < 3; i++) {
        assert_true(mesh->vertices[i].uv[0] == 0 && mesh->vertices[i].uv[1] == 0);
        assert_true(mesh->vertices[i].normal[0] == 0 && mesh->vertices[i].normal[1] == 0); /* +Z */
    }
    pnb_mesh_destroy(&mesh);
}

static void slots_are_capped(void **state) {
    (void)state;
    struct cube cube;
    cube_init(&cube);
    static const int32_t materials[6] = {-1, INT32_MIN, 0, 40000, INT32_MAX, 5};
    cube.desc.polygon_materials.data = materials;
    pnb_mesh *mesh = create(&cube.desc);
    assert_string_equal(pnb_mesh_warning(mesh), "");
    assert_int_equal(mesh->range_count, 3);
    assert_int_equal(mesh->ranges[0].slot, 0);
    assert_int_equal(mesh->ranges[0].index_count, 18);
    assert_int_equal(mesh->ranges[1].slot, 5);
    assert_int_equal(mesh->ranges[2].slot, MESH_MAX_SLOT);
    assert_int_equal(mesh->ranges[2].index_count, 12);
    pnb_mesh_destroy(&mesh);
}

static void empty_meshes_are_valid(void **state) {
    (void)state;
    pnb_mesh_desc desc = PNB_INIT(pnb_mesh_desc);
    pnb_mesh *mesh = create(&desc);
    assert_int_equal(mesh->vertex_count + mesh->index_count + mesh->range_count, 0);
    assert_true(mesh->bounds[0][0] > mesh->bounds[1][0]);
    assert_string_equal(pnb_mesh_warning(mesh), "");
    pnb_mesh_destroy(&mesh);
    assert_null(mesh);
    pnb_mesh_destroy(&mesh);
    pnb_mesh_destroy(NULL);
    assert_string_equal(pnb_mesh_warning(NULL), "");
}

/* ---- Bad data ---- */

static void bad_triangles_are_dropped_and_counted(void **state) {
    (void)state;
    struct cube cube;
    cube_init(&cube);
    cube.positions[7][1] = NAN;        /* used by 4 or 5 triangles of three faces */
    cube.triangles[0][1] = 24;         /* a corner that does not exist */
    cube.triangles[1][2] = UINT32_MAX; /* another */
    cube.corner_vertices[8] = 8;       /* a vertex that does not exist: both triangles of face 2 */
    cube.polygons[8] = 6;              /* a polygon that does not exist: on face 4 */
    cube.triangles[9][1] = cube.triangles[9][0];
    uint32_t broken = 0;
    for (uint32_t i = 0; i < 12; i++) {
        for (uint32_t j = 0; j < 3; j++) {
            uint32_t corner = cube.triangles[i][j];
            if (corner < 24 && cube.corner_vertices[corner] == 7) {
                broken++;
            }
        }
    }
    pnb_mesh *mesh = create(&cube.desc);
    char expected[200];
    snprintf(expected, sizeof expected,
             "mesh 'Cube': %u of 12 triangles dropped: %u use non-finite positions, 1 has no area, "
             "2 name corners that do not exist, 2 name vertices that do not exist, "
             "1 names a polygon that does not exist",
             broken + 6, broken);
    assert_string_equal(pnb_mesh_warning(mesh), expected);
    assert_int_equal(mesh->index_count, 3 * (12 - broken - 6));
    for (uint32_t i = 0; i < mesh->vertex_count; i++) {
        assert_true(isfinite(mesh->vertices[i].position[1]));
    }
    pnb_mesh_destroy(&mesh);
}

static void single_faults_read_as_singular(void **state) {
    (void)state;
    static const float values[] = {NAN, INFINITY, -INFINITY, 2e18f, FLT_MAX};
    for (size_t i = 0; i < sizeof values / sizeof *values; i++) {
        float positions[3][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
        positions[2][2] = values[i];
        pnb_mesh_desc desc = {.struct_size = sizeof desc,
                              .name = "A",
                              .vertex_count = 3,
                              .corner_count = 3,
                              .triangle_count = 1,
                              .positions = {positions, 0},
                              .triangles = {(const uint32_t[3]){0, 1, 2}, 0}};
        pnb_mesh *mesh = create(&desc);
        assert_string_equal(pnb_mesh_warning(mesh), "mesh 'A': 1 of 1 triangles dropped: 1 uses non-finite positions");
        assert_int_equal(mesh->vertex_count, 0);
        pnb_mesh_destroy(&mesh);
    }
}

static void collinear_triangles_have_no_area(void **state) {
    (void)state;
    static const float positions[4][3] = {{0.1f, 0.2f, 0.3f}, {0.2f, 0.4f, 0.6f}, {0.4f, 0.8f, 1.2f}, {1, 0, 0}};
    static const uint32_t triangles[3][3] = {{0, 1, 2}, {0, 0, 3}, {0, 1, 3}};
    pnb_mesh_desc desc = {.struct_size = sizeof desc,
                          .vertex_count = 4,
                          .corner_count = 4,
                          .triangle_count = 3,
                          .positions = {positions, 0},
                          .triangles = {triangles, 0}};
    pnb_mesh *mesh = create(&desc);
    assert_int_equal(mesh->index_count, 3);
    assert_string_equal(pnb_mesh_warning(mesh), "mesh 'mesh': 2 of 3 triangles dropped: 2 have no area");
    pnb_mesh_destroy(&mesh);
}

/* Tiny and huge triangles are not degenerate. */
static void extreme_sizes_are_kept(void **state) {
    (void)state;
    static const float sizes[] = {1e-40f, 1e-30f, 1e-10f, 1e10f, 9e17f};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        float positions[3][3] = {{0}};
        positions[1][0] = positions[2][1] = sizes[i];
        pnb_mesh_desc desc = {.struct_size = sizeof desc,
                              .vertex_count = 3,
                              .corner_count = 3,
                              .triangle_count = 1,
                              .positions = {positions, 0},
                              .triangles = {(const uint32_t[3]){0, 1, 2}, 0}};
        pnb_mesh *mesh = create(&desc);
        assert_int_equal(mesh->index_count, 3);
        assert_true(mesh->vertices[0].normal[0] == 0 && mesh->vertices[0].normal[1] == 0);
        pnb_mesh_destroy(&mesh);
    }
}

static void bad_uvs_become_zero(void **state) {
    (void)state;
    struct cube cube;
    cube_init(&cube);
    cube.uvs[1][0] = NAN;
    cube.uvs[2][1] = INFINITY;
    cube.desc.name = "A\nCube";
    pnb_mesh *mesh = create(&cube.desc);
    /* One corner is shared. A warning is one line. */
    assert_string_equal(pnb_mesh_warning(mesh), "mesh 'A Cube': 3 non-finite uvs taken as 0");
    for (uint32_t i = 0; i < mesh->vertex_count; i++) {
        assert_true(isfinite(mesh->vertices[i].uv[0]) && isfinite(mesh->vertices[i].uv[1]));
    }
    pnb_mesh_destroy(&mesh);
}

static void broken_descriptions_are_errors(void **state) {
    (void)state;
    struct cube cube;
    pnb_mesh *mesh = (pnb_mesh *)1;
    assert_int_equal(pnb_mesh_create(NULL, &mesh), PNB_ERROR_INVALID_ARGUMENT);
    cube_init(&cube);
    assert_int_equal(pnb_mesh_create(&cube.desc, NULL), PNB_ERROR_INVALID_ARGUMENT);
    cube.desc.struct_size--;
    assert_int_equal(pnb_mesh_create(&cube.desc, &mesh), PNB_ERROR_INVALID_ARGUMENT);
    cube_init(&cube);
    cube.desc.positions.data = NULL;
    assert_int_equal(pnb_mesh_create(&cube.desc, &mesh), PNB_ERROR_INVALID_ARGUMENT);
    assert_non_null(strstr(pnb_last_error(), "mesh 'Cube'"));
    cube_init(&cube);
    cube.desc.triangles.data = NULL;
    assert_int_equal(pnb_mesh_create(&cube.desc, &mesh), PNB_ERROR_INVALID_ARGUMENT);
    assert_non_null(strstr(pnb_last_error(), "triangles is NULL"));
    cube_init(&cube);
    cube.desc.triangle_count = UINT32_MAX;
    assert_int_equal(pnb_mesh_create(&cube.desc, &mesh), PNB_ERROR_INVALID_ARGUMENT);
    assert_ptr_equal(mesh, (pnb_mesh *)1); /* never written */
}

static void long_names_do_not_overflow(void **state) {
    (void)state;
    char name[5000];
    memset(name, 'n', sizeof name - 1);
    name[sizeof name - 1] = '\0';
    struct cube cube;
    cube_init(&cube);
    cube.desc.name = name;
    cube.triangles[0][0] = 99;
    pnb_mesh *mesh = create(&cube.desc);
    assert_string_equal(mesh->name, name);
    assert_true(strlen(pnb_mesh_warning(mesh)) < 1024);
    pnb_mesh_destroy(&mesh);
}

/* ---- Content and references ---- */

static void content_follows_the_data(void **state) {
    (void)state;
    struct cube cube;
    cube_init(&cube);
    pnb_mesh *first = create(&cube.desc);
    cube.desc.name = "Another name";
    pnb_mesh *same = create(&cube.desc);
    assert_true(content_key_equal(&first->content, &same->content));
    cube.positions[3][0] = nextafterf(cube.positions[3][0], 2);
    pnb_mesh *moved = create(&cube.desc);
    assert_false(content_key_equal(&first->content, &moved->content));
    cube_init(&cube);
    cube.materials[0] = 1;
    pnb_mesh *painted = create(&cube.desc);
    assert_false(content_key_equal(&first->content, &painted->content));
    pnb_mesh_destroy(&first);
    pnb_mesh_destroy(&same);
    pnb_mesh_destroy(&moved);
    pnb_mesh_destroy(&painted);
}

static void references_are_counted(void **state) {
    (void)state;
    int64_t before = memory_live_blocks();
    struct cube cube;
    cube_init(&cube);
    pnb_mesh *mesh = create(&cube.desc), *second = mesh_retain(mesh);
    pnb_mesh_destroy(&mesh);
    assert_null(mesh);
    assert_string_equal(second->name, "Cube");
    pnb_mesh_destroy(&second);
    assert_int_equal(memory_live_blocks(), before);
}

static void every_allocation_may_fail(void **state) {
    (void)state;
    struct cube cube;
    cube_init(&cube);
    int64_t before = memory_live_blocks();
    uint64_t failures = 0;
    for (;;) {
        pnb_mesh *mesh = NULL;
        memory_fail_at(failures + 1);
        pnb_result result = pnb_mesh_create(&cube.desc, &mesh);
        memory_fail_at(0);
        if (result == PNB_OK) {
            pnb_mesh_destroy(&mesh);
            break;
        }
        assert_int_equal(result, PNB_ERROR_OUT_OF_MEMORY);
        assert_null(mesh);
        assert_int_equal(memory_live_blocks(), before);
        failures++;
    }
    print_message("%d allocations failed\n", (int)failures);
    assert_true(failures >= 9);
    assert_int_equal(memory_live_blocks(), before);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(normals_survive_packing),
        cmocka_unit_test(axes_pack_exactly),
        cmocka_unit_test(directionless_vectors_do_not_pack),
        cmocka_unit_test(closed_meshes_are_known),
        cmocka_unit_test(cube_is_welded_and_sorted),
        cmocka_unit_test(equal_corners_are_one_vertex),
        cmocka_unit_test(flat_normals_stand_in),
        cmocka_unit_test(fan_is_linear),
        cmocka_unit_test(strides_and_alignment_do_not_matter),
        cmocka_unit_test(absent_arrays_have_their_defaults),
        cmocka_unit_test(slots_are_capped),
        cmocka_unit_test(empty_meshes_are_valid),
        cmocka_unit_test(bad_triangles_are_dropped_and_counted),
        cmocka_unit_test(single_faults_read_as_singular),
        cmocka_unit_test(collinear_triangles_have_no_area),
        cmocka_unit_test(extreme_sizes_are_kept),
        cmocka_unit_test(bad_uvs_become_zero),
        cmocka_unit_test(broken_descriptions_are_errors),
        cmocka_unit_test(long_names_do_not_overflow),
        cmocka_unit_test(content_follows_the_data),
        cmocka_unit_test(references_are_counted),
        cmocka_unit_test(every_allocation_may_fail),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
