/* SPDX-License-Identifier: GPL-3.0-or-later
 * What lies behind one light's shadow, to look at: its shadow map, and what a search of it finds at every pixel. */
#include "../memory.h"
#include "passes.h"

#include <math.h>

/* Between the layers of a map and around them. */
#define NO_TEXEL -1.0f

bool wants_blockers(const struct frame *frame) {
    return frame->settings->passes & (PNB_PASS_PENUMBRAE | PNB_PASS_BLOCKERS);
}

bool wants_diagnosis(const struct frame *frame) {
    return wants_blockers(frame) || (frame->settings->passes & PNB_PASS_SHADOW_MAPS);
}

/* ---- Blockers ---- */

static pnb_result draw_blockers(struct frame *frame, const struct frame_light *light, const struct gl_texture *target) {
    struct renderer *renderer = frame->renderer;
    const struct gl *gl = renderer->gl;
    const struct program_desc desc = {.vertex = "pass_screen.vert",
                                      .fragment = "pass_blockers.frag",
                                      .defines = {light_defines(&light->emitter, &light->views)}};
    GLuint program;
    pnb_result result = program_use(&renderer->programs, &desc, &program);
    const struct gl_target bound = {.colors = {target}, .color_count = 1};
    if (result != PNB_OK || (result = gl_target_bind(gl, renderer->framebuffer, &bound)) != PNB_OK)
        return result;
    gl->Disable(GL_DEPTH_TEST);
    gl->Disable(GL_BLEND);
    light_block_upload(renderer, &light->emitter, &light->views);
    bind_gbuffer(renderer, program);
    gl_texture_bind(gl, &light->shadow_map, 3);
    gl_texture_bind(gl, &light->min_max, 4);
    program_set_int(gl, program, "shadow_map", 3);
    program_set_int(gl, program, "min_max", 4);
    draw_screen(renderer);
    return gl_check(gl, "blockers");
}

static pnb_result read_blockers(struct frame *frame) {
    const size_t count = (size_t)frame->width * (size_t)frame->height;
    float *pixels = memory_array(count, 4 * sizeof *pixels);
    if (!pixels)
        return PNB_ERROR_OUT_OF_MEMORY;
    frame->gl->ReadPixels(0, 0, frame->width, frame->height, GL_RGBA, GL_FLOAT, pixels);
    float *const images[] = {frame->images[IMAGE_BLOCKERS][frame->light], frame->images[IMAGE_PENUMBRAE][frame->light]};
    for (int i = 0; i < 2; i++)
        for (size_t p = 0; p < count && images[i]; p++)
            images[i][p] = pixels[4 * p + (size_t)i];
    memory_free(pixels);
    return gl_check(frame->gl, "read-back of blockers");
}

static pnb_result diagnose_blockers(struct frame *frame, const struct frame_light *light) {
    struct gl_texture found = {0};
    pnb_result result = gl_texture_ensure(frame->gl, &found, GL_RGBA32F, frame->width, frame->height, 0, 1);
    if (result == PNB_OK)
        result = draw_blockers(frame, light, &found);
    if (result == PNB_OK)
        result = read_blockers(frame);
    gl_texture_free(frame->gl, &found);
    return result;
}

/* ---- Maps ---- */

/* The layers side by side, as large as they fit, in the full image; of it, the crop. */
static void place_map(const struct frame *frame, const struct gl_texture *map, const float *depths, float *pixels) {
    const int columns = map->layers > 1 ? 3 : 1, rows = (map->layers + columns - 1) / columns, side = map->width;
    const uint32_t *crop = frame->settings->crop;
    const float width = (float)frame->settings->width, height = (float)frame->settings->height;
    const float cell = fminf(width / (float)columns, height / (float)rows);
    const float left = 0.5f * (width - cell * (float)columns), below = 0.5f * (height - cell * (float)rows);
    for (int y = 0; y < frame->height; y++)
        for (int x = 0; x < frame->width; x++) {
            const float u = ((float)x + (float)crop[0] + 0.5f - left) / cell,
                        v = ((float)y + (float)crop[1] + 0.5f - below) / cell;
            const int column = (int)floorf(u), row = (int)floorf(v), layer = (rows - 1 - row) * columns + column;
            const bool outside = column < 0 || column >= columns || row < 0 || row >= rows || layer >= map->layers;
            const int s = (int)((u - (float)column) * (float)side), t = (int)((v - (float)row) * (float)side);
            pixels[(size_t)y * (size_t)frame->width + (size_t)x] =
                outside ? NO_TEXEL : depths[((size_t)layer * (size_t)side + (size_t)t) * (size_t)side + (size_t)s];
        }
}

static pnb_result diagnose_map(struct frame *frame, const struct frame_light *light) {
    const struct gl_texture *map = &light->shadow_map;
    float *depths = memory_array((size_t)map->width * (size_t)map->height, (size_t)map->layers * sizeof *depths);
    if (!depths)
        return PNB_ERROR_OUT_OF_MEMORY;
    gl_texture_bind(frame->gl, map, 0);
    frame->gl->GetTexImage(GL_TEXTURE_2D_ARRAY, 0, GL_DEPTH_COMPONENT, GL_FLOAT, depths);
    place_map(frame, map, depths, frame->images[IMAGE_SHADOW_MAPS][frame->light]);
    memory_free(depths);
    return gl_check(frame->gl, "read-back of a shadow map");
}

pnb_result pass_diagnosis(struct frame *frame, const struct frame_light *light) {
    frame->light = (uint32_t)(light - frame->lights);
    float *map = frame->images[IMAGE_SHADOW_MAPS][frame->light];
    for (int i = 0; i < frame->width * frame->height && map; i++)
        map[i] = NO_TEXEL;
    if (!light->shadow_map.id)
        return PNB_OK;
    pnb_result result = pass_begin(frame, "Diagnosis");
    if (result != PNB_OK)
        return result;
    if (wants_blockers(frame))
        result = diagnose_blockers(frame, light);
    if (result == PNB_OK && map)
        result = diagnose_map(frame, light);
    pass_end(frame, (uint64_t)frame->width * (uint64_t)frame->height * 16);
    return result;
}
