/* SPDX-License-Identifier: GPL-3.0-or-later
 * Passes alone, on the calling thread: a context, a renderer and an empty frame. */
#ifndef PASS_BENCH_H
#define PASS_BENCH_H

#include "quality.h"

#include "gl/backend.h"
#include "passes/passes.h"
#include "render/renderer.h"

struct bench {
    struct backend backend;
    struct renderer *renderer;
    struct settings settings;
    struct scene scene;
    struct messages messages;
    struct frame frame;
};

static inline bool bench_open(struct bench *bench) {
    struct backend_choice choice;
    struct backend_report report;
    *bench = (struct bench){.settings = {.technique = technique_find("PCSS")}};
    if (!CHECK_RESULT(backend_choose("", &choice), PNB_OK) ||
        !CHECK_RESULT(backend_open(&choice, &(struct context_options){0}, &bench->backend, &report), PNB_OK) ||
        !CHECK_RESULT(renderer_create(&bench->backend.gl, &bench->renderer), PNB_OK))
        return false;
    bench->frame = (struct frame){.gl = &bench->backend.gl, .renderer = bench->renderer, .settings = &bench->settings};
    return true;
}

static inline void bench_close(struct bench *bench) {
    renderer_destroy(&bench->renderer);
    backend_close(&bench->backend);
}

/* All layers of a level. */
static inline float *read_texture(const struct gl *gl, const struct gl_texture *texture, int level, GLenum format,
                                  int channels) {
    const size_t side = (size_t)(texture->width >> level);
    float *pixels = malloc(side * side * (size_t)texture->layers * (size_t)channels * sizeof *pixels);
    gl_texture_bind(gl, texture, 0);
    if (pixels)
        gl->GetTexImage(GL_TEXTURE_2D_ARRAY, level, format, GL_FLOAT, pixels);
    return pixels;
}

/* Fills level 0 of an array texture. */
static inline void upload_texture(struct bench *bench, const struct gl_texture *texture, GLenum format,
                                  const float *pixels) {
    PFNGLTEXSUBIMAGE3DPROC upload =
        (PFNGLTEXSUBIMAGE3DPROC)bench->backend.lookup(bench->backend.state, "glTexSubImage3D");
    gl_texture_bind(&bench->backend.gl, texture, 0);
    upload(GL_TEXTURE_2D_ARRAY, 0, 0, 0, 0, texture->width, texture->height, texture->layers, format, GL_FLOAT, pixels);
}

static inline uint32_t next_random(uint32_t *state) {
    *state = *state * 1664525u + 1013904223u;
    return *state >> 8;
}

#endif
