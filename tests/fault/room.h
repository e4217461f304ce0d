/* SPDX-License-Identifier: GPL-3.0-or-later
 * A good scene for tests to spoil: a box and a leaf with a textured alpha stand on a floor between four lights, one of
 * each type. And what must hold for every image, whatever the scene. */
#ifndef ROOM_H
#define ROOM_H

#include "support.h"

#define ROOM_MESHES 3
#define ROOM_LIGHTS 65 /* one more than allowed */

/* What a mesh is made of; a field of zeros is what tests change. */
struct room_mesh {
    pnb_mesh_desc desc;
    float positions[8][3], normals[36][3], uvs[36][2];
    uint32_t triangles[12][3], corner_vertices[36];
    int32_t materials[12];
};

struct room {
    struct room_mesh data[ROOM_MESHES]; /* floor, box, leaf */
    float pixels[4][4][4];
    pnb_texture_desc texture_desc;
    pnb_mesh *meshes[ROOM_MESHES];
    pnb_texture *texture;
    pnb_instance instances[ROOM_MESHES];
    pnb_material materials[2];
    uint32_t slots[2];
    pnb_light lights[ROOM_LIGHTS];
    pnb_value values[2];
    pnb_scene scene;
    pnb_settings settings;
};

enum { ROOM_FLOOR, ROOM_BOX, ROOM_LEAF };
enum { ROOM_AREA, ROOM_POINT, ROOM_SPOT, ROOM_SUN, ROOM_LAMPS };

/* Quadrilaterals of a box without a bottom: vertex i lies at the far side of axis a if bit a of i is set. */
static inline void room_box(struct room_mesh *mesh, const float low[3], const float high[3]) {
    static const uint32_t quads[5][4] = {{4, 5, 7, 6}, {0, 1, 5, 4}, {1, 3, 7, 5}, {3, 2, 6, 7}, {2, 0, 4, 6}};
    for (int i = 0; i < 8; ++i) {
        for (int axis = 0; axis < 3; ++axis) {
            mesh->positions[i][axis] = (i >> axis) & 1 ? high[axis] : low[axis];
        }
    }
    for (uint32_t i = 0; i < 10; ++i) {
        const uint32_t *quad = quads[i / 2];
        for (uint32_t corner = 0; corner < 3; ++corner) {
            mesh->corner_vertices[3 * i + corner] = quad[corner == 0 ? 0 : corner + i % 2];
            mesh->triangles[i][corner] = 3 * i + corner;
        }
    }
    mesh->desc.vertex_count = 8;
    mesh->desc.corner_count = 30;
    mesh->desc.triangle_count = 10;
}

static inline void room_quad(struct room_mesh *mesh, const float positions[4][3]) {
    memcpy(mesh->positions, positions, 4 * sizeof positions[0]);
    for (uint32_t i = 0; i < 6; ++i) {
        const uint32_t vertex = i == 0 || i == 3 ? 0 : i % 3 + i / 3;
        mesh->corner_vertices[i] = vertex;
        mesh->triangles[i / 3][i % 3] = i;
        mesh->uvs[i][0] = (float)(vertex == 1 || vertex == 2);
        mesh->uvs[i][1] = (float)(vertex >= 2);
    }
    mesh->desc.vertex_count = 4;
    mesh->desc.corner_count = 6;
    mesh->desc.triangle_count = 2;
}

static inline void room_meshes(struct room *room) {
    static const char *const names[ROOM_MESHES] = {"Floor", "Box", "Leaf"};
    static const float ground[4][3] = {{-3, -3, 0}, {3, -3, 0}, {3, 3, 0}, {-3, 3, 0}};
    static const float leaf[4][3] = {
        {-1.2f, 0.3f, 0.2f}, {-0.5f, 0.4f, 0.2f}, {-0.5f, 0.7f, 1.1f}, {-1.2f, 0.6f, 1.1f}};
    for (int i = 0; i < ROOM_MESHES; ++i) {
        struct room_mesh *mesh = &room->data[i];
        mesh->desc = (pnb_mesh_desc){.struct_size = sizeof mesh->desc,
                                     .name = names[i],
                                     .positions = {mesh->positions, 0},
                                     .corner_vertices = {mesh->corner_vertices, 0},
                                     .corner_normals = {mesh->normals, 0},
                                     .corner_uvs = {mesh->uvs, 0},
                                     .triangles = {mesh->triangles, 0},
                                     .polygon_materials = {mesh->materials, 0}};
        room->instances[i] =
            (pnb_instance){.struct_size = sizeof(pnb_instance), .slot_count = 2, .matrix = IDENTITY_AT(0, 0, 0)};
    }
    room_quad(&room->data[ROOM_FLOOR], ground);
    room_box(&room->data[ROOM_BOX], (const float[3]){-0.4f, -0.4f, 0}, (const float[3]){0.5f, 0.4f, 0.9f});
    room_quad(&room->data[ROOM_LEAF], leaf);
    room->data[ROOM_LEAF].materials[0] = room->data[ROOM_LEAF].materials[1] = 1;
}

static inline void room_lights(struct room *room) {
    for (int i = 0; i < ROOM_LIGHTS; ++i) {
        room->lights[i] = (pnb_light){.struct_size = sizeof(pnb_light),
                                      .type = (pnb_light_type)(i % ROOM_LAMPS),
                                      .name = "Lamp",
                                      .matrix = IDENTITY_AT(0.4f, -0.3f, 2.5f),
                                      .emission = {3, 3, 3},
                                      .size = {0.6f, 0.4f},
                                      .radius = 0.2f,
                                      .angle = 0.1f,
                                      .spot_angle = 1.2f,
                                      .spot_blend = 0.3f};
    }
    room->lights[ROOM_AREA].name = "Area";
    room->lights[ROOM_POINT].name = "Point";
    room->lights[ROOM_SPOT].name = "Spot";
    room->lights[ROOM_SUN].name = "Sun";
    room->lights[ROOM_POINT].matrix[12] = -1.5f;
}

/* The description before anything is made of it. It points into *room, which must stay where it is. */
static inline void room_reset(struct room *room) {
    *room = (struct room){0};
    room_meshes(room);
    room_lights(room);
    for (int i = 0; i < 64; ++i) {
        (&room->pixels[0][0][0])[i] = i % 4 < 3 ? 0.5f : (float)(i / 4 % 2);
    }
    room->texture_desc = (pnb_texture_desc){.struct_size = sizeof(pnb_texture_desc),
                                            .width = 4,
                                            .height = 4,
                                            .channels = 4,
                                            .name = "Leaf texture",
                                            .pixels = {room->pixels, 0}};
    room->materials[0] = (pnb_material){.struct_size = sizeof(pnb_material), .base_color = {0.8f, 0.7f, 0.6f}};
    room->materials[1] = (pnb_material){.struct_size = sizeof(pnb_material), .base_color = {0.2f, 0.8f, 0.2f}};
    room->slots[1] = 1;
    room->scene = (pnb_scene){.struct_size = sizeof(pnb_scene),
                              .instance_count = ROOM_MESHES,
                              .material_count = 2,
                              .slot_count = 2,
                              .light_count = ROOM_LAMPS,
                              .instances = room->instances,
                              .materials = room->materials,
                              .slots = room->slots,
                              .lights = room->lights,
                              .camera = {.struct_size = sizeof(pnb_camera), .matrix = IDENTITY_AT(0, 0, 6)},
                              .world_color = {0.1f, 0.1f, 0.2f}};
    room->settings = (pnb_settings){.struct_size = sizeof(pnb_settings),
                                    .values = room->values,
                                    .width = 40,
                                    .height = 30,
                                    .shadow_map_size = 64,
                                    .light_samples = 2,
                                    .passes = PNB_PASS_COMBINED | PNB_PASS_DEPTH | PNB_PASS_NORMAL | PNB_PASS_SHADOW |
                                              PNB_PASS_LIGHT_SHADOWS};
}

static inline void room_free(struct room *room) {
    for (int i = 0; i < ROOM_MESHES; ++i) {
        pnb_mesh_destroy(&room->meshes[i]);
    }
    pnb_texture_destroy(&room->texture);
}

/* Makes meshes and texture, and gives them to the instances and materials that have none. */
static inline pnb_result room_make(struct room *room) {
    pnb_result result = pnb_texture_create(&room->texture_desc, &room->texture);
    for (int i = 0; i < ROOM_MESHES && result == PNB_OK; ++i) {
        result = pnb_mesh_create(&room->data[i].desc, &room->meshes[i]);
        room->instances[i].mesh = room->meshes[i];
    }
    room->materials[1].base_color_texture = room->materials[1].alpha_texture = room->texture;
    return result;
}

/* ---- Images -------------------------------------------------------------------------------------------------- */

/* The range of the values of a pass. */
static inline void pass_range(const char *name, float range[2]) {
    range[0] = range[1] = 0;
    if (strcmp(name, "Combined") == 0 || strcmp(name, "Depth") == 0) {
        range[1] = 3e38f;
    } else if (strcmp(name, "Normal") == 0) {
        range[0] = -1.001f;
        range[1] = 1.001f;
    } else if (strncmp(name, "Shadow", 6) == 0) {
        range[1] = 1.001f;
    } else if (strncmp(name, "Blocker.", 8) == 0 || strncmp(name, "Penumbra.", 9) == 0) {
        range[1] = 3e38f;
    } else if (strncmp(name, "Map.", 4) == 0) {
        range[0] = -1;
        range[1] = 1;
    }
}

/* Whether every image of the job is finite and in its range; prints the first value that is not. */
static inline bool images_are_sound(const pnb_job *job) {
    for (uint32_t i = 0; i < pnb_job_image_count(job); ++i) {
        pnb_image image = PNB_INIT(pnb_image);
        float range[2];
        if (!CHECK_RESULT(pnb_job_get_image(job, i, &image), PNB_OK)) {
            return false;
        }
        pass_range(image.name, range);
        const size_t count = (size_t)image.width * image.height * image.channels;
        for (size_t j = 0; j < count; ++j) {
            if (!(image.pixels[j] >= range[0] && image.pixels[j] <= range[1])) {
                const size_t pixel = j / image.channels;
                printf("pass %s, pixel %zu, %zu, channel %zu: %g\n", image.name, pixel % image.width,
                       pixel / image.width, j % image.channels, (double)image.pixels[j]);
                return false;
            }
        }
    }
    return true;
}

/* FNV-1a over names and values of all images. */
static inline uint64_t images_hash(const pnb_job *job) {
    uint64_t hash = 14695981039346656037u;
    for (uint32_t i = 0; i < pnb_job_image_count(job); ++i) {
        pnb_image image = PNB_INIT(pnb_image);
        pnb_job_get_image(job, i, &image);
        const unsigned char *bytes = (const unsigned char *)image.pixels;
        const size_t size = (size_t)image.width * image.height * image.channels * sizeof *image.pixels;
        for (size_t j = 0; j < size; ++j) {
            hash = (hash ^ bytes[j]) * 1099511628211u;
        }
        for (const char *name = image.name; *name; ++name) {
            hash = (hash ^ (unsigned char)*name) * 1099511628211u;
        }
    }
    return hash;
}

#endif
