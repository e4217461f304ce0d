/* SPDX-License-Identifier: GPL-3.0-or-later
 * What the tests of contexts and jobs share. */
#ifndef SUPPORT_H
#define SUPPORT_H

#include "check.h"
#include "memory.h"

#include <stdlib.h>

#ifdef __has_feature
#define UNDER_ADDRESS_SANITIZER __has_feature(address_sanitizer)
#elif defined __SANITIZE_ADDRESS__
#define UNDER_ADDRESS_SANITIZER 1
#else
#define UNDER_ADDRESS_SANITIZER 0
#endif

/* One triangle under a square light, seen by a camera. */
struct small_scene {
    pnb_mesh *mesh;
    pnb_instance instance;
    pnb_light light;
    pnb_scene scene;
    pnb_settings settings;
};

#define IDENTITY_AT(x, y, z)                                                                                           \
    { 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, x, y, z, 1 }

static inline pnb_result small_scene_create(struct small_scene *small) {
    static const float positions[] = {-2, -2, 0, 2, -2, 0, 0, 2, 0};
    static const uint32_t triangle[] = {0, 1, 2};
    pnb_mesh_desc desc = PNB_INIT(pnb_mesh_desc);
    desc.name = "Triangle";
    desc.vertex_count = desc.corner_count = 3;
    desc.triangle_count = 1;
    desc.positions.data = positions;
    desc.triangles.data = triangle;
    *small = (struct small_scene){
        .instance = {.struct_size = sizeof(pnb_instance), .matrix = IDENTITY_AT(0, 0, 0)},
        .light = {.struct_size = sizeof(pnb_light),
                  .name = "Lamp",
                  .matrix = IDENTITY_AT(0, 0, 3),
                  .emission = {10, 10, 10},
                  .size = {1, 1}},
        .scene = {.struct_size = sizeof(pnb_scene),
                  .instance_count = 1,
                  .light_count = 1,
                  .camera = {.struct_size = sizeof(pnb_camera), .matrix = IDENTITY_AT(0, 0, 5)}},
        .settings = {.struct_size = sizeof(pnb_settings), .width = 64, .height = 48, .shadow_map_size = 64},
    };
    return pnb_mesh_create(&desc, &small->mesh);
}

/* The description, pointing into *small wherever that lies now. */
static inline const pnb_scene *small_scene_get(struct small_scene *small) {
    small->instance.mesh = small->mesh;
    small->scene.instances = &small->instance;
    small->scene.lights = &small->light;
    return &small->scene;
}

static inline void small_scene_destroy(struct small_scene *small) {
    pnb_mesh_destroy(&small->mesh);
}

/* Log messages, "level: text" on one line each. */
struct log_record {
    char text[16384];
    int count[PNB_LOG_DEBUG + 1];
};

static inline void record_log(void *user, pnb_log_level level, const char *message) {
    struct log_record *record = user;
    size_t length = strlen(record->text);
    record->count[level] += 1;
    snprintf(record->text + length, sizeof record->text - length, "%d: %s\n", (int)level, message);
}

static inline pnb_result create_logged(const char *backend, pnb_log_level level, struct log_record *record,
                                       pnb_context **context) {
    *record = (struct log_record){0};
    pnb_context_desc desc = PNB_INIT(pnb_context_desc);
    desc.backend = backend;
    desc.log_level = level;
    desc.log = record_log;
    desc.log_user = record;
    return pnb_context_create(&desc, context);
}

static inline pnb_result create_context(const char *backend, pnb_context **context) {
    pnb_context_desc desc = PNB_INIT(pnb_context_desc);
    desc.backend = backend;
    return pnb_context_create(&desc, context);
}

/* Backends of the ladder by their kind, for tests that run on each that works here. */
static const char *const backend_kinds[] = {"egl", "surfaceless", "osmesa"};
#define BACKEND_KINDS 3

static inline bool backend_works(const char *backend) {
    pnb_context *context;
    if (create_context(backend, &context) != PNB_OK) {
        return false;
    }
    pnb_context_destroy(&context);
    return true;
}

/* Resident memory of this process in KiB. */
static inline long resident_kib(void) {
    char line[256];
    long kib = -1;
    FILE *status = fopen("/proc/self/status", "r");
    while (status && fgets(line, sizeof line, status)) {
        sscanf(line, "VmRSS: %ld", &kib);
    }
    if (status) {
        fclose(status);
    }
    return kib;
}

#endif
