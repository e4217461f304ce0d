/* SPDX-License-Identifier: GPL-3.0-or-later
 * Life and death of meshes; mesh_build.c fills them. */
#include "mesh.h"
#include "../memory.h"
#include "content_key.h"

#include <float.h>
#include <inttypes.h>
#include <string.h>

pnb_mesh *mesh_allocate(const char *name) {
    pnb_mesh *mesh = memory_array(1, sizeof *mesh);
    if (mesh) {
        atomic_init(&mesh->references, 1);
        mesh->name = memory_string(name, "mesh");
        if (!mesh->name) {
            pnb_mesh_destroy(&mesh);
        }
    }
    return mesh;
}

static uint64_t mix(uint64_t x) {
    x = (x ^ x >> 32) * 0x9e3779b97f4a7c15u;
    x = (x ^ x >> 29) * 0xbf58476d1ce4e5b9u;
    return x ^ x >> 32;
}

static uint64_t position_hash(const float position[3]) {
    uint32_t bits[3];
    for (int i = 0; i < 3; i++) {
        const float value = position[i] + 0.0f; /* one zero */
        memcpy(&bits[i], &value, sizeof value);
    }
    return mix(mix((uint64_t)bits[0] << 32 | bits[1]) + bits[2]);
}

/* Whether every edge, known by the places of its ends, is walked as often in one direction as in the other. The hashes of
 * the edges add up to 0 then, those of opposite directions with opposite signs, and by chance in one of 2^64 meshes. */
static bool mesh_is_closed(const pnb_mesh *mesh) {
    uint64_t sum = 0;
    for (uint32_t i = 0; i < mesh->index_count; i += 3) {
        uint64_t ends[3];
        for (int k = 0; k < 3; k++)
            ends[k] = position_hash(mesh->vertices[mesh->indices[i + (uint32_t)k]].position);
        for (int k = 0; k < 3; k++) {
            const uint64_t a = ends[k], b = ends[(k + 1) % 3];
            sum += mix(3 * a + b) - mix(3 * b + a);
        }
    }
    return mesh->index_count > 0 && sum == 0;
}

void mesh_finish(pnb_mesh *mesh) {
    for (int i = 0; i < 3; i++) {
        mesh->bounds[0][i] = FLT_MAX;
        mesh->bounds[1][i] = -FLT_MAX;
    }
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        for (int i = 0; i < 3; i++) {
            float value = mesh->vertices[v].position[i];
            mesh->bounds[0][i] = value < mesh->bounds[0][i] ? value : mesh->bounds[0][i];
            mesh->bounds[1][i] = value > mesh->bounds[1][i] ? value : mesh->bounds[1][i];
        }
    }
    mesh->closed = mesh_is_closed(mesh);
    mesh->content = (struct content_key){{0}};
    content_key_add(&mesh->content, mesh->vertices, mesh->vertex_count * sizeof *mesh->vertices);
    content_key_add(&mesh->content, mesh->indices, mesh->index_count * sizeof *mesh->indices);
    content_key_add(&mesh->content, mesh->ranges, mesh->range_count * sizeof *mesh->ranges);
}

static pnb_result mesh_check(const pnb_mesh_desc *desc) {
    pnb_result result = CHECK_STRUCT(desc, pnb_mesh_desc);
    if (result != PNB_OK) {
        return result;
    }
    const char *name = desc->name ? desc->name : "mesh";
    if (desc->vertex_count > 0 && !desc->positions.data) {
        return error_set(PNB_ERROR_INVALID_ARGUMENT, "mesh '%s': %" PRIu32 " vertices, but positions is NULL", name,
                         desc->vertex_count);
    }
    if (desc->triangle_count > 0 && !desc->triangles.data) {
        return error_set(PNB_ERROR_INVALID_ARGUMENT, "mesh '%s': %" PRIu32 " triangles, but triangles is NULL", name,
                         desc->triangle_count);
    }
    if (desc->triangle_count > MESH_MAX_TRIANGLES) {
        return error_set(PNB_ERROR_INVALID_ARGUMENT, "mesh '%s': %" PRIu32 " triangles are more than %" PRIu32, name,
                         desc->triangle_count, MESH_MAX_TRIANGLES);
    }
    return PNB_OK;
}

pnb_result pnb_mesh_create(const pnb_mesh_desc *desc, pnb_mesh **mesh) {
    pnb_result result = mesh_check(desc);
    if (result != PNB_OK) {
        return result;
    }
    if (!mesh) {
        return error_set(PNB_ERROR_INVALID_ARGUMENT, "mesh is NULL");
    }
    pnb_mesh *made = mesh_allocate(desc->name);
    if (!made) {
        return PNB_ERROR_OUT_OF_MEMORY;
    }
    result = mesh_build(desc, made);
    if (result != PNB_OK) {
        pnb_mesh_destroy(&made);
        return result;
    }
    mesh_finish(made);
    *mesh = made;
    return PNB_OK;
}

pnb_mesh *mesh_retain(pnb_mesh *mesh) {
    atomic_fetch_add_explicit(&mesh->references, 1, memory_order_relaxed);
    return mesh;
}

void pnb_mesh_destroy(pnb_mesh **mesh) {
    if (!mesh || !*mesh) {
        return;
    }
    pnb_mesh *last = *mesh;
    *mesh = NULL;
    if (atomic_fetch_sub_explicit(&last->references, 1, memory_order_acq_rel) > 1) {
        return;
    }
    memory_free(last->name);
    memory_free(last->warning);
    memory_free(last->vertices);
    memory_free(last->indices);
    memory_free(last->ranges);
    memory_free(last);
}

const char *pnb_mesh_warning(const pnb_mesh *mesh) {
    return mesh ? mesh->warning : "";
}
