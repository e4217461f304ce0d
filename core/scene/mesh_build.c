/* SPDX-License-Identifier: GPL-3.0-or-later
 * Turns a modeller's mesh (triangles of corners of vertices) into welded vertices and triangles sorted by material.
 * Two passes over the triangles: the first finds which are good and counts them by slot, the second welds. */
#include "../error.h"
#include "../memory.h"
#include "mesh.h"
#include "numbers.h"
#include "octahedral.h"
#include "strided.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

/* How many welded vertices of one source vertex are compared before a new one is made. A fan can have any number of
 * different corners at its tip; without a limit the time would grow with their square. */
#define MAX_COMPARED 64

/* Why a triangle is dropped. */
enum fault { FAULT_NONE, FAULT_POSITION, FAULT_AREA, FAULT_CORNER, FAULT_VERTEX, FAULT_POLYGON, FAULT_COUNT };

static const struct {
    const char *singular, *plural;
} fault_texts[FAULT_COUNT] = {
    [FAULT_POSITION] = {"uses non-finite positions", "use non-finite positions"},
    [FAULT_AREA] = {"has no area", "have no area"},
    [FAULT_CORNER] = {"names corners that do not exist", "name corners that do not exist"},
    [FAULT_VERTEX] = {"names vertices that do not exist", "name vertices that do not exist"},
    [FAULT_POLYGON] = {"names a polygon that does not exist", "name polygons that do not exist"},
};

struct triangle {
    uint32_t corners[3], vertices[3];
    uint32_t slot;
    float positions[3][3];
    double normal[3]; /* not normalised */
};

#define SLOT_DROPPED UINT16_MAX

/* What is only needed while a mesh is being built. */
struct build {
    const pnb_mesh_desc *from;
    struct pnb_mesh *mesh;
    uint16_t *slots;      /* of each source triangle, or SLOT_DROPPED */
    uint32_t *next_index; /* where the next triangle of each slot goes in mesh->indices */
    uint32_t slot_count;
    uint32_t faults[FAULT_COUNT];
    uint32_t bad_uvs; /* corners */
    uint32_t *newest; /* of each source vertex: its newest welded vertex + 1, or 0 */
    uint32_t *older;  /* of each welded vertex: the one before it of the same source vertex + 1, or 0 */
    uint32_t vertex_capacity;
};

/* ---- One source triangle ---- */

static enum fault triangle_read_slot(const pnb_mesh_desc *from, uint32_t index, struct triangle *triangle) {
    triangle->slot = 0;
    if (!from->polygon_materials.data) {
        return FAULT_NONE;
    }
    uint32_t polygon = from->triangle_polygons.data ? strided_read_u32(&from->triangle_polygons, index) : index;
    if (polygon >= (from->polygon_count ? from->polygon_count : from->triangle_count)) {
        return FAULT_POLYGON;
    }
    int32_t slot;
    strided_read(&from->polygon_materials, polygon, &slot, sizeof slot);
    if (slot > 0) {
        triangle->slot = (uint32_t)slot < MESH_MAX_SLOT ? (uint32_t)slot : MESH_MAX_SLOT;
    }
    return FAULT_NONE;
}

/* The cross product of two edges, in doubles so that it is zero for degenerate triangles only. */
static void triangle_find_normal(struct triangle *triangle) {
    double edges[2][3];
    for (int i = 0; i < 3; i++) {
        double origin = triangle->positions[0][i];
        edges[0][i] = triangle->positions[1][i] - origin;
        edges[1][i] = triangle->positions[2][i] - origin;
    }
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        triangle->normal[i] = edges[0][j] * edges[1][k] - edges[0][k] * edges[1][j];
    }
}

static enum fault triangle_read(const pnb_mesh_desc *from, uint32_t index, struct triangle *triangle) {
    strided_read(&from->triangles, index, triangle->corners, sizeof triangle->corners);
    for (int i = 0; i < 3; i++) {
        uint32_t corner = triangle->corners[i];
        if (corner >= from->corner_count) {
            return FAULT_CORNER;
        }
        uint32_t vertex = from->corner_vertices.data ? strided_read_u32(&from->corner_vertices, corner) : corner;
        if (vertex >= from->vertex_count) {
            return FAULT_VERTEX;
        }
        triangle->vertices[i] = vertex;
        strided_read(&from->positions, vertex, triangle->positions[i], sizeof triangle->positions[i]);
        if (!numbers_usable(triangle->positions[i], 3)) {
            return FAULT_POSITION;
        }
    }
    triangle_find_normal(triangle);
    if (triangle->normal[0] == 0 && triangle->normal[1] == 0 && triangle->normal[2] == 0) {
        return FAULT_AREA;
    }
    return triangle_read_slot(from, index, triangle);
}

/* ---- First pass: which triangles, in which order ---- */

static pnb_result build_classify(struct build *build) {
    const pnb_mesh_desc *from = build->from;
    build->slots = memory_array(from->triangle_count, sizeof *build->slots);
    if (!build->slots) {
        return PNB_ERROR_OUT_OF_MEMORY;
    }
    for (uint32_t i = 0; i < from->triangle_count; i++) {
        struct triangle triangle;
        enum fault fault = triangle_read(from, i, &triangle);
        build->faults[fault]++;
        build->slots[i] = fault == FAULT_NONE ? (uint16_t)triangle.slot : SLOT_DROPPED;
        if (fault == FAULT_NONE && triangle.slot >= build->slot_count) {
            build->slot_count = triangle.slot + 1;
        }
    }
    return PNB_OK;
}

/* Makes the ranges, and in next_index the first index of each. */
static pnb_result build_ranges(struct build *build) {
    struct pnb_mesh *mesh = build->mesh;
    build->next_index = memory_array(build->slot_count, sizeof *build->next_index);
    if (!build->next_index) {
        return PNB_ERROR_OUT_OF_MEMORY;
    }
    for (uint32_t i = 0; i < build->from->triangle_count; i++) {
        if (build->slots[i] != SLOT_DROPPED) {
            mesh->range_count += build->next_index[build->slots[i]] == 0;
            build->next_index[build->slots[i]] += 3;
        }
    }
    mesh->ranges = memory_array(mesh->range_count, sizeof *mesh->ranges);
    if (!mesh->ranges) {
        return PNB_ERROR_OUT_OF_MEMORY;
    }
    struct mesh_range *range = mesh->ranges;
    for (uint32_t slot = 0; slot < build->slot_count; slot++) {
        uint32_t count = build->next_index[slot];
        build->next_index[slot] = mesh->index_count;
        if (count > 0) {
            *range++ = (struct mesh_range){slot, mesh->index_count, count};
            mesh->index_count += count;
        }
    }
    return PNB_OK;
}

/* ---- Second pass: weld ---- */

static void corner_read_color(const pnb_mesh_desc *from, uint32_t corner, uint32_t vertex, uint8_t color[4]) {
    const bool by_corner = from->corner_colors.data != NULL;
    float linear[3] = {1, 1, 1};
    if (by_corner || from->vertex_colors.data) {
        strided_read(by_corner ? &from->corner_colors : &from->vertex_colors, by_corner ? corner : vertex, linear,
                     sizeof linear);
    }
    for (int i = 0; i < 3; i++) {
        float value = linear[i] > 0 ? fminf(linear[i], 1) : 0; /* not a number: 0 */
        color[i] = (uint8_t)lrintf(sqrtf(value) * 255);
    }
}

static struct vertex corner_read(struct build *build, const struct triangle *triangle, int i) {
    const pnb_mesh_desc *from = build->from;
    struct vertex vertex = {0};
    memcpy(vertex.position, triangle->positions[i], sizeof vertex.position);
    corner_read_color(from, triangle->corners[i], triangle->vertices[i], vertex.color);
    bool packed = false;
    if (from->corner_normals.data) {
        float normal[3];
        strided_read(&from->corner_normals, triangle->corners[i], normal, sizeof normal);
        packed = octahedral_pack((double[3]){normal[0], normal[1], normal[2]}, vertex.normal);
    }
    if (!packed) {
        octahedral_pack(triangle->normal, vertex.normal);
    }
    if (from->corner_uvs.data) {
        strided_read(&from->corner_uvs, triangle->corners[i], vertex.uv, sizeof vertex.uv);
        if (!numbers_usable(vertex.uv, 2)) {
            vertex.uv[0] = vertex.uv[1] = 0;
            build->bad_uvs++;
        }
    }
    return vertex;
}

static bool build_set_capacity(struct build *build, uint32_t capacity) {
    struct vertex *vertices = memory_resize(build->mesh->vertices, capacity, sizeof *vertices);
    if (!vertices) {
        return false;
    }
    build->mesh->vertices = vertices;
    uint32_t *older = memory_resize(build->older, capacity, sizeof *older);
    if (!older) {
        return false;
    }
    build->older = older;
    build->vertex_capacity = capacity;
    return true;
}

/* Finds or makes the welded vertex; false without memory. The bits of normal, uv and colour are compared: they follow
 * the position, which is the source vertex's own. */
static bool build_weld(struct build *build, uint32_t source, const struct vertex *vertex, uint32_t *index) {
    struct pnb_mesh *mesh = build->mesh;
    _Static_assert(sizeof(struct vertex) - offsetof(struct vertex, normal) == 16, "no padding to compare");
    uint32_t link = build->newest[source];
    for (int compared = 0; link > 0 && compared < MAX_COMPARED; compared++, link = build->older[link - 1]) {
        if (memcmp(mesh->vertices[link - 1].normal, vertex->normal, 16) == 0) {
            *index = link - 1;
            return true;
        }
    }
    if (mesh->vertex_count == build->vertex_capacity) {
        /* Never more than three vertices per triangle. */
        uint32_t limit = mesh->index_count, half = limit / 2;
        uint32_t capacity = build->vertex_capacity > half ? limit : build->vertex_capacity * 2;
        if (!build_set_capacity(build, capacity)) {
            return false;
        }
    }
    *index = mesh->vertex_count++;
    mesh->vertices[*index] = *vertex;
    build->older[*index] = build->newest[source];
    build->newest[source] = *index + 1;
    return true;
}

static pnb_result build_triangles(struct build *build) {
    const pnb_mesh_desc *from = build->from;
    struct pnb_mesh *mesh = build->mesh;
    mesh->indices = memory_array(mesh->index_count, sizeof *mesh->indices);
    build->newest = mesh->indices ? memory_array(from->vertex_count, sizeof *build->newest) : NULL;
    /* Most meshes have about as many corners that differ as vertices. */
    uint32_t capacity = from->vertex_count < mesh->index_count ? from->vertex_count : mesh->index_count;
    if (!build->newest || !build_set_capacity(build, capacity)) {
        return PNB_ERROR_OUT_OF_MEMORY;
    }
    for (uint32_t i = 0; i < from->triangle_count; i++) {
        if (build->slots[i] == SLOT_DROPPED) {
            continue;
        }
        struct triangle triangle;
        triangle_read(from, i, &triangle);
        uint32_t *indices = mesh->indices + build->next_index[build->slots[i]];
        build->next_index[build->slots[i]] += 3;
        for (int corner = 0; corner < 3; corner++) {
            struct vertex vertex = corner_read(build, &triangle, corner);
            if (!build_weld(build, triangle.vertices[corner], &vertex, &indices[corner])) {
                return PNB_ERROR_OUT_OF_MEMORY;
            }
        }
    }
    struct vertex *exact = memory_resize(mesh->vertices, mesh->vertex_count, sizeof *exact);
    if (!exact) {
        return PNB_ERROR_OUT_OF_MEMORY;
    }
    mesh->vertices = exact;
    return PNB_OK;
}

/* ---- What was wrong ---- */

static void text_add(char text[ERROR_TEXT_SIZE], const char *format, ...) PNB_PRINTF(2, 3);

static void text_add(char text[ERROR_TEXT_SIZE], const char *format, ...) {
    size_t length = strlen(text);
    va_list arguments;
    va_start(arguments, format);
    text_format_list(text + length, ERROR_TEXT_SIZE - length, format, arguments);
    va_end(arguments);
}

static void build_describe_faults(const struct build *build, uint32_t dropped, char text[ERROR_TEXT_SIZE]) {
    text_add(text, "%" PRIu32 " of %" PRIu32 " triangles dropped", dropped, build->from->triangle_count);
    const char *separator = ": ";
    for (int fault = FAULT_NONE + 1; fault < FAULT_COUNT; fault++) {
        uint32_t count = build->faults[fault];
        if (count > 0) {
            text_add(text, "%s%" PRIu32 " %s", separator, count,
                     count == 1 ? fault_texts[fault].singular : fault_texts[fault].plural);
            separator = ", ";
        }
    }
}

static pnb_result build_warning(struct build *build) {
    uint32_t dropped = build->from->triangle_count - build->faults[FAULT_NONE];
    char text[ERROR_TEXT_SIZE] = "";
    if (dropped > 0 || build->bad_uvs > 0) {
        text_add(text, "mesh '%s': ", build->mesh->name);
    }
    if (dropped > 0) {
        build_describe_faults(build, dropped, text);
    }
    if (build->bad_uvs > 0) {
        text_add(text, "%s%" PRIu32 " non-finite uvs taken as 0", dropped > 0 ? "; " : "", build->bad_uvs);
    }
    text_make_line(text);
    build->mesh->warning = memory_string(text, "");
    return build->mesh->warning ? PNB_OK : PNB_ERROR_OUT_OF_MEMORY;
}

/* ---- All steps ---- */

static pnb_result build_run(struct build *build) {
    pnb_result result = build_classify(build);
    if (result == PNB_OK) {
        result = build_ranges(build);
    }
    if (result == PNB_OK) {
        result = build_triangles(build);
    }
    if (result == PNB_OK) {
        result = build_warning(build);
    }
    return result;
}

pnb_result mesh_build(const pnb_mesh_desc *from, pnb_mesh *mesh) {
    struct build build = {.from = from, .mesh = mesh};
    pnb_result result = build_run(&build);
    memory_free(build.slots);
    memory_free(build.next_index);
    memory_free(build.newest);
    memory_free(build.older);
    return result;
}
