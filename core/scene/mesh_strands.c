/* SPDX-License-Identifier: GPL-3.0-or-later
 * Curves as prisms. */
#include "../error.h"
#include "../memory.h"
#include "mesh_shapes.h"
#include "strided.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

#define STRAND_RADIUS 0.005f /* the default of hosts */

/* Turns `side` as little as needed to be perpendicular to the unit vector `tangent`. */
static void align_side(const float tangent[3], float side[3]) {
    float along = mesh_shape_dot(side, tangent), rest[3];
    for (int i = 0; i < 3; i++) {
        rest[i] = side[i] - along * tangent[i];
    }
    if (mesh_shape_dot(rest, rest) < 1e-6f || !mesh_shape_normalize(rest, side)) {
        int least = fabsf(tangent[0]) < fabsf(tangent[1]) ? 0 : 1;
        least = fabsf(tangent[2]) < fabsf(tangent[least]) ? 2 : least;
        for (int i = 0; i < 3; i++) {
            rest[i] = (i == least ? 1.0f : 0.0f) - tangent[least] * tangent[i];
        }
        mesh_shape_normalize(rest, side);
    }
}

/* Up to so many points strands have five sides, whose width differs by 2.6 % on either side of the mean; else three, by
 * 7 %. */
#define FINE_STRANDS 100000u

/* A regular polygon whose girth is the unit circle's. */
struct section {
    float corners[5][2];
    uint32_t sides;
    float grow; /* radius of the corners */
};

static void section_make(struct section *section, uint32_t sides) {
    const float turn = 6.2831853f / (float)sides;
    section->sides = sides;
    section->grow = 0.5f * turn / sinf(0.5f * turn);
    for (uint32_t corner = 0; corner < sides; corner++) {
        section->corners[corner][0] = cosf(turn * (float)corner);
        section->corners[corner][1] = sinf(turn * (float)corner);
    }
}

static void add_ring(struct shape *shape, const struct section *section, const float center[4], const float tangent[3],
                     const float side[3], const float uv[2]) {
    const float other[3] = {tangent[1] * side[2] - tangent[2] * side[1], tangent[2] * side[0] - tangent[0] * side[2],
                            tangent[0] * side[1] - tangent[1] * side[0]};
    for (uint32_t corner = 0; corner < section->sides; corner++) {
        uint32_t vertex = shape->vertex_count++;
        for (int i = 0; i < 3; i++) {
            float normal = section->corners[corner][0] * side[i] + section->corners[corner][1] * other[i];
            shape->normals[vertex][i] = normal;
            shape->positions[vertex][i] = center[i] + section->grow * center[3] * normal;
        }
        memcpy(shape->uvs[vertex], uv, sizeof shape->uvs[vertex]);
    }
}

static void add_walls(struct shape *shape, uint32_t sides) {
    const uint32_t first = shape->vertex_count - 2 * sides;
    for (uint32_t corner = 0; corner < sides; corner++) {
        uint32_t a = first + corner, b = first + (corner + 1) % sides;
        mesh_shape_add_triangle(shape, a, b, b + sides);
        mesh_shape_add_triangle(shape, a, b + sides, a + sides);
    }
}

/* ---- The curve through the points of a strand: Catmull and Rom's, as hosts draw it ---- */

#define MOST_PIECES 8u

struct strand {
    const pnb_strands_desc *desc;
    uint32_t first, last; /* points first .. last - 1 */
};

static struct strand strand_get(const pnb_strands_desc *desc, uint32_t index) {
    const bool is_last = index + 1 == desc->strand_count;
    return (struct strand){.desc = desc,
                           .first = strided_read_u32(&desc->first_points, index),
                           .last = is_last ? desc->point_count : strided_read_u32(&desc->first_points, index + 1)};
}

/* Position and radius. Beyond its ends the strand has its end points again. */
static void strand_read(const struct strand *strand, int64_t point, float to[4]) {
    const int64_t first = strand->first, last = (int64_t)strand->last - 1;
    const uint32_t index = (uint32_t)(point < first ? first : point > last ? last : point);
    strided_read(&strand->desc->positions, index, to, 3 * sizeof *to);
    to[3] = mesh_shape_read_radius(&strand->desc->radii, index, STRAND_RADIUS);
}

/* The two points about the segment after `point`, and its own. */
static void strand_read_segment(const struct strand *strand, uint32_t point, float keys[4][4]) {
    for (int i = 0; i < 4; i++) {
        strand_read(strand, (int64_t)point - 1 + i, keys[i]);
    }
}

/* Pieces of the segment that keep to the curve within a quarter of the radius: the middle of the curve is this far from
 * that of a straight line, and the distance falls with the square of the pieces. Between equal points lies no curve. */
static uint32_t segment_pieces(float keys[4][4]) {
    float bend[3], length = 0;
    for (int i = 0; i < 3; i++) {
        bend[i] = (keys[1][i] + keys[2][i] - keys[0][i] - keys[3][i]) / 16.0f;
        length = fmaxf(length, fabsf(keys[2][i] - keys[1][i]));
    }
    const float off = length > 0 ? sqrtf(mesh_shape_dot(bend, bend)) : 0;
    const float pieces = ceilf(sqrtf(4.0f * off / fminf(keys[1][3], keys[2][3])));
    return pieces > 1.0f ? (uint32_t)fminf(pieces, (float)MOST_PIECES) : 1; /* not a number: 1 */
}

static void segment_point(float keys[4][4], float t, float to[4]) {
    const float weights[4] = {0.5f * t * (t * (2.0f - t) - 1.0f), 0.5f * (t * t * (3.0f * t - 5.0f) + 2.0f),
                              0.5f * t * (t * (4.0f - 3.0f * t) + 1.0f), 0.5f * t * t * (t - 1.0f)};
    for (int i = 0; i < 4; i++) {
        to[i] = weights[0] * keys[0][i] + weights[1] * keys[1][i] + weights[2] * keys[2][i] + weights[3] * keys[3][i];
    }
    to[3] = to[3] > SMALLEST_RADIUS ? to[3] : SMALLEST_RADIUS;
}

static uint64_t strand_count_points(const struct strand *strand) {
    uint64_t count = strand->first < strand->last ? 1 : 0;
    float keys[4][4];
    for (uint32_t point = strand->first; point + 1 < strand->last; point++) {
        strand_read_segment(strand, point, keys);
        count += segment_pieces(keys);
    }
    return count;
}

/* Writes strand_count_points points. */
static void strand_points(const struct strand *strand, float (*points)[4]) {
    float keys[4][4];
    for (uint32_t point = strand->first; point + 1 < strand->last; point++) {
        strand_read_segment(strand, point, keys);
        const uint32_t pieces = segment_pieces(keys);
        memcpy(*points++, keys[1], sizeof *points);
        for (uint32_t piece = 1; piece < pieces; piece++) {
            segment_point(keys, (float)piece / (float)pieces, *points++);
        }
    }
    if (strand->first < strand->last) {
        strand_read(strand, strand->last - 1, *points);
    }
}

/* A point on the one before it is left out. */
static void add_strand(struct shape *shape, const struct section *section, float (*points)[4], uint64_t count,
                       const float uv[2]) {
    float side[3] = {0, 0, 0}, tangent[3] = {0, 0, 1};
    uint32_t rings = 0;
    for (uint64_t point = 0; point < count; point++) {
        const bool is_end = point + 1 == count;
        float step[3] = {0, 0, 0};
        for (int i = 0; i < 3 && !is_end; i++) {
            step[i] = points[point + 1][i] - points[point][i];
        }
        if (!mesh_shape_normalize(step, step) && !is_end) {
            continue;
        }
        /* The mean direction of both segments; at the ends that of the only one. */
        for (int i = 0; i < 3; i++) {
            tangent[i] = rings > 0 ? tangent[i] + step[i] : step[i];
        }
        if (!mesh_shape_normalize(tangent, tangent)) {
            memcpy(tangent, mesh_shape_dot(step, step) > 0 ? step : (float[3]){0, 0, 1}, sizeof tangent);
        }
        align_side(tangent, side);
        add_ring(shape, section, points[point], tangent, side, uv);
        if (rings++ > 0) {
            add_walls(shape, section->sides);
        }
        memcpy(tangent, mesh_shape_dot(step, step) > 0 ? step : tangent, sizeof tangent);
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
    return mesh_shape_check_points(name, desc->point_count, &desc->positions, mesh);
}

/* Room for the shape, and in *points for the longest strand. */
static pnb_result allocate_strands(struct shape *shape, const struct section *section, const pnb_strands_desc *desc,
                                   const char *name, float (**points)[4]) {
    uint64_t total = 0, longest = 0;
    for (uint32_t i = 0; i < desc->strand_count; i++) {
        const struct strand strand = strand_get(desc, i);
        const uint64_t count = strand_count_points(&strand);
        total += count;
        longest = count > longest ? count : longest;
    }
    *points = memory_array((size_t)longest, sizeof **points);
    if (!*points) {
        return PNB_ERROR_OUT_OF_MEMORY;
    }
    return mesh_shape_allocate(shape, section->sides * total, 2ull * section->sides * total, name);
}

pnb_result pnb_mesh_create_strands(const pnb_strands_desc *desc, pnb_mesh **mesh) {
    pnb_result result = check_strands(desc, mesh);
    if (result != PNB_OK) {
        return result;
    }
    const char *name = desc->name ? desc->name : "strands";
    struct shape shape = {0};
    struct section section;
    float(*points)[4] = NULL;
    section_make(&section, desc->point_count <= FINE_STRANDS ? 5 : 3);
    result = allocate_strands(&shape, &section, desc, name, &points);
    for (uint32_t i = 0; result == PNB_OK && i < desc->strand_count; i++) {
        const struct strand strand = strand_get(desc, i);
        float uv[2] = {0, 0};
        if (desc->uvs.data) {
            strided_read(&desc->uvs, i, uv, sizeof uv);
        }
        strand_points(&strand, points);
        add_strand(&shape, &section, points, strand_count_points(&strand), uv);
    }
    memory_free(points);
    return mesh_shape_finish(&shape, result, name, mesh);
}
