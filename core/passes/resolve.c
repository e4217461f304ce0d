/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "../memory.h"
#include "passes.h"

#include <math.h>
#include <stdio.h>

/* Rows read at once: few enough to stay in the processor's caches until they are finished. */
#define BAND_ROWS 64
/* Blender's depth where there is nothing. */
#define NO_DEPTH 1e10f

static const struct image_kind {
    uint32_t pass;
    const char *name;
    uint32_t channels;
} kinds[] = {{PNB_PASS_COMBINED, "Combined", 4},     {PNB_PASS_DEPTH, "Depth", 1},
             {PNB_PASS_NORMAL, "Normal", 3},         {PNB_PASS_SHADOW, "Shadow", 3},
             {PNB_PASS_LIGHT_SHADOWS, "Shadow.", 3}, {PNB_PASS_BLOCKERS, "Blocker.", 1},
             {PNB_PASS_PENUMBRAE, "Penumbra.", 1},   {PNB_PASS_SHADOW_MAPS, "Map.", 1}};

pnb_result pass_create_images(struct frame *frame) {
    for (int i = 0; i < IMAGE_KINDS; i++) {
        if (!(frame->settings->passes & kinds[i].pass))
            continue;
        const uint32_t count = i >= IMAGE_LIGHT_SHADOWS ? frame->scene->light_count : 1;
        for (uint32_t k = 0; k < count; k++) {
            char name[256];
            snprintf(name, sizeof name, "%s%s", kinds[i].name,
                     i >= IMAGE_LIGHT_SHADOWS ? frame->scene->lights[k].name : "");
            frame->images[i][k] = job_add_image(frame->job, name, kinds[i].channels);
            if (!frame->images[i][k])
                return PNB_ERROR_OUT_OF_MEMORY;
        }
    }
    return PNB_OK;
}

/* ---- One image: rows of sums -> rows of pixels. The sums lie in up to three blocks of RGBA, one after another. ----
 */

struct rows {
    const struct frame *frame;
    const float *sums[3];
    size_t count; /* pixels */
    float *pixels;
};

static float weight_of_sample(const struct rows *rows) {
    return 1.0f / (float)rows->frame->sums_samples;
}

static void finish_combined(const struct rows *rows) {
    const float weight = weight_of_sample(rows);
    for (size_t i = 0; i < 4 * rows->count; i++)
        rows->pixels[i] = rows->sums[0][i] * weight;
}

/* Adds the background as dark as the shadow on a catcher, or on a transparent film the shadow's alpha. */
static void finish_combined_with_catchers(const struct rows *rows) {
    finish_combined(rows);
    const bool transparent = rows->frame->settings->flags & PNB_SETTINGS_FILM_TRANSPARENT;
    const float *world = rows->frame->scene->world_color;
    const float weight = weight_of_sample(rows);
    for (size_t i = 0; i < rows->count; i++) {
        const float *with = rows->sums[1] + 4 * i, *without = rows->sums[2] + 4 * i;
        const float coverage = with[3] * weight;
        float mean = 0.0f;
        for (int c = 0; c < 3; c++) {
            const float light = without[c] > 0.0f ? with[c] / without[c] : 1.0f;
            mean += light / 3.0f;
            rows->pixels[4 * i + (size_t)c] += transparent ? 0.0f : coverage * world[c] * light;
        }
        rows->pixels[4 * i + 3] += coverage * (transparent ? 1.0f - mean : 1.0f);
    }
}

static void finish_depth(const struct rows *rows) {
    for (size_t i = 0; i < rows->count; i++)
        rows->pixels[i] = rows->sums[0][i] != 0.0f ? fabsf(rows->sums[0][i]) : NO_DEPTH;
}

static void finish_normal(const struct rows *rows) {
    for (size_t i = 0; i < rows->count; i++) {
        const float *n = rows->sums[0] + 4 * i;
        const float length = sqrtf(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
        const float scale = length > 0.0f ? 1.0f / length : 0.0f;
        for (size_t c = 0; c < 3; c++)
            rows->pixels[3 * i + c] = n[c] * scale;
    }
}

static void finish_shadow(const struct rows *rows) {
    for (size_t i = 0; i < rows->count; i++)
        for (size_t c = 0; c < 3; c++) {
            const float shadowed = rows->sums[0][4 * i + c], unshadowed = rows->sums[1][4 * i + c];
            rows->pixels[3 * i + c] = unshadowed > 0.0f ? shadowed / unshadowed : 1.0f;
        }
}

static void finish_light_shadow(const struct rows *rows) {
    const float weight = weight_of_sample(rows);
    for (size_t i = 0; i < rows->count; i++)
        for (size_t c = 0; c < 3; c++)
            rows->pixels[3 * i + c] = rows->sums[0][4 * i + c] * weight;
}

/* What an image is made of: `finish` gets the rows of the sources. */
struct recipe {
    const struct gl_texture *sources[3];
    void (*finish)(const struct rows *rows);
};

static pnb_result read_rows(struct frame *frame, const struct gl_texture *source, int row, int rows, float *values) {
    const struct gl *gl = frame->gl;
    const struct gl_target target = {.colors = {source}, .color_count = 1};
    pnb_result result = gl_target_bind(gl, frame->renderer->framebuffer, &target);
    if (result != PNB_OK)
        return result;
    const bool whole = source->width != frame->width || source->height != frame->height; /* the G-buffer, not a sum */
    const int x = whole ? (int)frame->settings->crop[0] : 0, y = whole ? (int)frame->settings->crop[1] : 0;
    gl->ReadPixels(x, y + row, frame->width, rows, source->format == GL_R32F ? GL_RED : GL_RGBA, GL_FLOAT, values);
    return gl_check(gl, "read-back");
}

static pnb_result resolve_rows(struct frame *frame, const struct recipe *recipe, int row, int count, float *scratch,
                               float *pixels) {
    struct rows rows = {.frame = frame, .count = (size_t)count * (size_t)frame->width, .pixels = pixels};
    pnb_result result = PNB_OK;
    for (int i = 0; i < 3 && recipe->sources[i] && result == PNB_OK; i++) {
        float *values = scratch + (size_t)i * 4 * rows.count;
        rows.sums[i] = values;
        result = read_rows(frame, recipe->sources[i], row, count, values);
    }
    if (result == PNB_OK)
        recipe->finish(&rows);
    return result;
}

static pnb_result resolve_image(struct frame *frame, int kind, uint32_t light, const struct recipe *recipe) {
    float *pixels = frame->images[kind][light];
    if (!pixels)
        return PNB_OK;
    const size_t channels = kinds[kind].channels;
    const size_t band = (size_t)frame->width * BAND_ROWS * 4 * 3;
    float *scratch = memory_array(band, sizeof *scratch);
    if (!scratch)
        return PNB_ERROR_OUT_OF_MEMORY;
    pnb_result result = pass_begin(frame, "Resolve and read-back");
    if (result != PNB_OK) {
        memory_free(scratch);
        return result;
    }
    for (int row = 0; row < frame->height && result == PNB_OK; row += BAND_ROWS) {
        const int rows = frame->height - row < BAND_ROWS ? frame->height - row : BAND_ROWS;
        result =
            resolve_rows(frame, recipe, row, rows, scratch, pixels + (size_t)row * (size_t)frame->width * channels);
    }
    pass_end(frame, band * sizeof *scratch);
    memory_free(scratch);
    return result;
}

/* Depth is not averaged over the samples: the mean of two surfaces is the depth of neither. */
pnb_result pass_resolve_first_sample(struct frame *frame) {
    return resolve_image(frame, IMAGE_DEPTH, 0, &(struct recipe){{&frame->renderer->gbuffer_depth}, finish_depth});
}

pnb_result pass_resolve(struct frame *frame) {
    const struct renderer *renderer = frame->renderer;
    const struct recipe combined = {{&renderer->combined}, finish_combined},
                        with_catchers = {{&renderer->combined, &renderer->caught, &renderer->uncaught},
                                         finish_combined_with_catchers},
                        normal = {{&renderer->normal}, finish_normal},
                        shadow = {{&renderer->shadowed, &renderer->unshadowed}, finish_shadow};
    pnb_result result;
    if ((result = resolve_image(frame, IMAGE_COMBINED, 0,
                                frame->scene->catches_shadows ? &with_catchers : &combined)) != PNB_OK ||
        (result = resolve_image(frame, IMAGE_NORMAL, 0, &normal)) != PNB_OK ||
        (result = resolve_image(frame, IMAGE_SHADOW, 0, &shadow)) != PNB_OK)
        return result;
    for (uint32_t i = 0; i < frame->scene->light_count && result == PNB_OK; i++)
        result = resolve_image(frame, IMAGE_LIGHT_SHADOWS, i,
                               &(struct recipe){{&renderer->light_shadows[i]}, finish_light_shadow});
    return result;
}
