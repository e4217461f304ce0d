/* SPDX-License-Identifier: GPL-3.0-or-later
 * Curves and points as meshes. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "scene/scene.h"

#include <math.h>
#include <stdint.h>

static const double PI = 3.14159265358979;

static double surface_of(const pnb_mesh *mesh) {
    double sum = 0;
    for (uint32_t i = 0; i < mesh->index_count; i += 3) {
        double edges[2][3], cross[3];
        for (int e = 0; e < 2; e++) {
            for (int k = 0; k < 3; k++) {
                edges[e][k] = (double)mesh->vertices[mesh->indices[i + 1 + (uint32_t)e]].position[k] -
                              (double)mesh->vertices[mesh->indices[i]].position[k];
            }
        }
        for (int k = 0; k < 3; k++) {
            cross[k] = edges[0][(k + 1) % 3] * edges[1][(k + 2) % 3] - edges[0][(k + 2) % 3] * edges[1][(k + 1) % 3];
        }
        sum += 0.5 * sqrt(cross[0] * cross[0] + cross[1] * cross[1] + cross[2] * cross[2]);
    }
    return sum;
}

/* Volume by the divergence theorem: positive if all faces look outwards. */
static double volume_of(const pnb_mesh *mesh) {
    double sum = 0;
    for (uint32_t i = 0; i < mesh->index_count; i += 3) {
        const float *a = mesh->vertices[mesh->indices[i]].position;
        const float *b = mesh->vertices[mesh->indices[i + 1]].position;
        const float *c = mesh->vertices[mesh->indices[i + 2]].position;
        for (int k = 0; k < 3; k++) {
            int l = (k + 1) % 3, m = (k + 2) % 3;
            sum += (double)a[k] * ((double)b[l] * (double)c[m] - (double)b[m] * (double)c[l]) / 6.0;
        }
    }
    return sum;
}

static pnb_mesh *strands(const float (*points)[3], uint32_t count, const float *radii, const uint32_t *firsts,
                         uint32_t strand_count) {
    const pnb_strands_desc desc = {.struct_size = sizeof desc,
                                   .point_count = count,
                                   .strand_count = strand_count,
                                   .positions = {points, 0},
                                   .radii = {radii, 0},
                                   .first_points = {firsts, 0}};
    pnb_mesh *mesh = NULL;
    assert_int_equal(pnb_mesh_create_strands(&desc, &mesh), PNB_OK);
    assert_string_equal(pnb_mesh_warning(mesh), "");
    return mesh;
}

/* The prism's walls are as large as the round tube's, whatever the direction, and look outwards. */
static void strands_keep_their_width(void **state) {
    (void)state;
    static const float ends[][3] = {{0, 0, 2}, {2, 0, 0}, {0, -2, 0}, {1.2f, -1.6f, 0}, {0, 0, -2}};
    for (size_t i = 0; i < sizeof ends / sizeof *ends; i++) {
        const float points[2][3] = {{0, 0, 0}, {ends[i][0], ends[i][1], ends[i][2]}};
        pnb_mesh *mesh = strands(points, 2, (float[2]){0.1f, 0.1f}, (uint32_t[1]){0}, 1);
        assert_int_equal(mesh->index_count, 3 * 10);
        assert_true(fabs(surface_of(mesh) - 2 * PI * 0.1 * 2) < 1e-4);
        assert_true(volume_of(mesh) > 0);
        pnb_mesh_destroy(&mesh);
    }
}

/* A corner, a point that is there twice, a strand of one point, a tip without width. */
static void odd_strands_are_drawn(void **state) {
    (void)state;
    static const float points[][3] = {{0, 0, 0}, {0, 0, 1}, {0, 0, 1}, {1, 0, 1}, {5, 5, 5}, {0, 2, 0}, {0, 3, 0}};
    static const float radii[] = {0.1f, 0.1f, 0.1f, 0.1f, 0.1f, 0.1f, 0};
    pnb_mesh *mesh = strands(points, 7, radii, (uint32_t[]){0, 4, 5}, 3);
    assert_int_equal(mesh->index_count, 3 * 10 * 3); /* two segments, none, one */
    for (uint32_t i = 0; i < mesh->vertex_count; i++) {
        assert_true(isfinite(mesh->vertices[i].position[0]));
    }
    pnb_mesh_destroy(&mesh);
}

/* A quarter of a circle of radius 1 by its ends and two points in between, with neighbours beyond: the walls' corners
 * lie on the tube about the circle, also between the points, where straight lines would leave it by .034. */
static void strands_are_smooth(void **state) {
    (void)state;
    float points[6][3] = {{0}};
    for (int i = 0; i < 6; i++) {
        const double angle = PI / 6 * (i - 1);
        points[i][0] = (float)cos(angle), points[i][1] = (float)sin(angle);
    }
    static const float radii[6] = {0.01f, 0.01f, 0.01f, 0.01f, 0.01f, 0.01f};
    pnb_mesh *mesh = strands(points, 6, radii, (uint32_t[1]){0}, 1);
    uint32_t between = 0;
    for (uint32_t i = 0; i < mesh->vertex_count; i++) {
        const float *at = mesh->vertices[i].position;
        const double angle = atan2((double)at[1], (double)at[0]) * 6 / PI;
        const double off = hypot(hypot((double)at[0], (double)at[1]) - 1, (double)at[2]);
        if (angle < 0 || angle > 3) {
            continue; /* the end segments bend less */
        }
        between += fabs(angle - round(angle)) > 0.2;
        assert_true(fabs(off - 0.01) < 0.003);
    }
    assert_true(between >= 3 * 5);
    pnb_mesh_destroy(&mesh);
}

static void points_keep_their_size(void **state) {
    (void)state;
    static const float points[][3] = {{0, 0, 0}, {3, 0, 0}};
    static const float radii[] = {0.5f, 0.25f};
    const pnb_points_desc desc = {
        .struct_size = sizeof desc, .point_count = 2, .positions = {points, 0}, .radii = {radii, 0}};
    pnb_mesh *mesh = NULL;
    assert_int_equal(pnb_mesh_create_points(&desc, &mesh), PNB_OK);
    assert_int_equal(mesh->index_count, 2 * 80 * 3);
    assert_true(fabs(surface_of(mesh) - 4 * PI * (0.25 + 0.0625)) < 1e-3);
    assert_true(volume_of(mesh) > 0.4); /* of the spheres 0.59: a face turned inwards would cost a sixtieth of it */
    pnb_mesh_destroy(&mesh);
}

static void nothing_is_an_empty_mesh(void **state) {
    (void)state;
    const pnb_strands_desc none = {.struct_size = sizeof none};
    const pnb_points_desc nothing = {.struct_size = sizeof nothing};
    pnb_mesh *mesh = NULL;
    assert_int_equal(pnb_mesh_create_strands(&none, &mesh), PNB_OK);
    assert_int_equal(mesh->index_count, 0);
    pnb_mesh_destroy(&mesh);
    assert_int_equal(pnb_mesh_create_points(&nothing, &mesh), PNB_OK);
    assert_int_equal(mesh->index_count, 0);
    pnb_mesh_destroy(&mesh);
}

static void broken_descriptions_are_errors(void **state) {
    (void)state;
    static const float points[2][3] = {{0, 0, 0}, {0, 0, 1}};
    static const uint32_t beyond[] = {3}, falling[] = {2, 1};
    pnb_strands_desc desc = {.struct_size = sizeof desc, .point_count = 2, .strand_count = 1, .positions = {points, 0}};
    pnb_mesh *mesh = NULL;
    assert_int_equal(pnb_mesh_create_strands(&desc, &mesh), PNB_ERROR_INVALID_ARGUMENT);
    desc.first_points = (pnb_array){beyond, 0};
    assert_int_equal(pnb_mesh_create_strands(&desc, &mesh), PNB_ERROR_INVALID_ARGUMENT);
    desc.first_points = (pnb_array){falling, 0}, desc.strand_count = 2;
    assert_int_equal(pnb_mesh_create_strands(&desc, &mesh), PNB_ERROR_INVALID_ARGUMENT);
    desc.struct_size = 3;
    assert_int_equal(pnb_mesh_create_strands(&desc, &mesh), PNB_ERROR_INVALID_ARGUMENT);
    pnb_points_desc cloud = {.struct_size = sizeof cloud, .point_count = 2};
    assert_int_equal(pnb_mesh_create_points(&cloud, &mesh), PNB_ERROR_INVALID_ARGUMENT);
    cloud.positions = (pnb_array){points, 0};
    assert_int_equal(pnb_mesh_create_points(&cloud, NULL), PNB_ERROR_INVALID_ARGUMENT);
    assert_null(mesh);
}

/* Colours go through square roots of 8 bits: within half a step. */
static void colors_are_kept(void **state) {
    (void)state;
    static const float positions[3][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    static const float colors[3][3] = {{0, 0.25f, 1}, {0.01f, 2, -1}, {0.5f, NAN, 0.75f}};
    static const float expected[3][3] = {{0, 0.25f, 1}, {0.01f, 1, 0}, {0.5f, 0, 0.75f}};
    static const uint32_t triangle[1][3] = {{0, 1, 2}};
    pnb_mesh_desc desc = {.struct_size = sizeof desc,
                          .vertex_count = 3,
                          .corner_count = 3,
                          .triangle_count = 1,
                          .positions = {positions, 0},
                          .triangles = {triangle, 0},
                          .vertex_colors = {colors, 0}};
    for (int by_corner = 0; by_corner < 2; by_corner++) {
        pnb_mesh *mesh = NULL;
        assert_int_equal(pnb_mesh_create(&desc, &mesh), PNB_OK);
        for (uint32_t i = 0; i < 3; i++) {
            for (int k = 0; k < 3; k++) {
                double root = mesh->vertices[mesh->indices[i]].color[k] / 255.0;
                assert_true(fabs(root - sqrt((double)expected[i][k])) <= 0.51 / 255);
            }
        }
        pnb_mesh_destroy(&mesh);
        desc.corner_colors = desc.vertex_colors;
        desc.vertex_colors = (pnb_array){NULL, 0};
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(strands_keep_their_width), cmocka_unit_test(strands_are_smooth),
        cmocka_unit_test(odd_strands_are_drawn),    cmocka_unit_test(points_keep_their_size),
        cmocka_unit_test(nothing_is_an_empty_mesh), cmocka_unit_test(broken_descriptions_are_errors),
        cmocka_unit_test(colors_are_kept),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
