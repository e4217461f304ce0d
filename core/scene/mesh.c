/* SPDX-License-Identifier: GPL-3.0-or-later
 * Life and death of meshes; mesh_build.c fills them. */
#include "mesh.h"
#include "../memory.h"
#include "content_key.h"

#include <float.h>
#include <inttypes.h>

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
