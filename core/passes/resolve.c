/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "passes.h"

#include <stdio.h>

/* Largest buffer an image is packed into at once, bytes; larger images take several bands of rows. */
#define BAND_BYTES (32u << 20)

static const struct image_kind {
    uint32_t pass;
    const char *name, *define;
    uint32_t channels;
} kinds[] = {{PNB_PASS_COMBINED, "Combined", "#define COMBINED\n", 4},
             {PNB_PASS_DEPTH, "Depth", "#define DEPTH\n", 1},
             {PNB_PASS_NORMAL, "Normal", "#define NORMAL\n", 3},
             {PNB_PASS_SHADOW, "Shadow", "#define SHADOW\n", 3},
             {PNB_PASS_LIGHT_SHADOWS, "Shadow.", "#define LIGHT_SHADOW\n", 3}};

pnb_result pass_create_images(struct frame *frame) {
    for (int i = 0; i < IMAGE_KINDS; i++) {
        if (!(frame->settings->passes & kinds[i].pass))
            continue;
        const uint32_t count = i == IMAGE_LIGHT_SHADOWS ? frame->scene->light_count : 1;
        for (uint32_t k = 0; k < count; k++) {
            char name[256];
            snprintf(name, sizeof name, "%s%s", kinds[i].name, i == IMAGE_LIGHT_SHADOWS ? frame->scene->lights[k].name : "");
            frame->images[i + (int)k] = job_add_image(frame->job, name, kinds[i].channels);
            if (!frame->images[i + (int)k])
                return PNB_ERROR_OUT_OF_MEMORY;
        }
    }
    return PNB_OK;
}

/* Packs a band of rows and copies it to the host. */
static pnb_result resolve_band(struct frame *frame, GLuint program, int channels, int row, int rows, float *pixels) {
    const struct gl *gl = frame->gl;
    const size_t row_bytes = (size_t)frame->width * (size_t)channels * sizeof *pixels;
    gl->Uniform2iv(gl->GetUniformLocation(program, "band"), 1, (const int[2]){row, rows});
    gl->DispatchCompute((GLuint)(frame->width + 15) / 16, (GLuint)(rows + 3) / 4, 1);
    gl->MemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    gl->GetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, (GLsizeiptr)(row_bytes * (size_t)rows),
                         (char *)pixels + row_bytes * (size_t)row);
    return gl_check(gl, "read-back");
}

static void set_catcher(struct frame *frame, GLuint program) {
    const struct gl *gl = frame->gl;
    gl_texture_bind(gl, &frame->renderer->caught, 2);
    gl_texture_bind(gl, &frame->renderer->uncaught, 3);
    program_set_int(gl, program, "caught", 2);
    program_set_int(gl, program, "uncaught", 3);
    set_world(frame, program);
}

/* From the sums, or the G-buffer for depth, to the host's image, if it is wanted. */
static pnb_result resolve_image(struct frame *frame, int index, const struct gl_texture *source,
                                const struct gl_texture *divisor) {
    const struct image_kind *kind = &kinds[index < IMAGE_LIGHT_SHADOWS ? index : IMAGE_LIGHT_SHADOWS];
    float *pixels = frame->images[index];
    if (!pixels)
        return PNB_OK;
    struct renderer *renderer = frame->renderer;
    const struct gl *gl = renderer->gl;
    const bool catches = index == IMAGE_COMBINED && frame->scene->catches_shadows;
    const struct program_desc desc = {.compute = "pass_resolve.comp", .defines = {kind->define, catches ? "#define CATCHER\n" : NULL}};
    GLuint program;
    pnb_result result = program_use(&renderer->programs, &desc, &program);
    if (result != PNB_OK || (result = timer_begin(&renderer->timer, "Resolve and read-back")) != PNB_OK)
        return result;
    gl_texture_bind(gl, source, 0);
    gl_texture_bind(gl, divisor ? divisor : source, 1);
    program_set_int(gl, program, "source", 0);
    program_set_int(gl, program, "divisor", 1);
    if (catches)
        set_catcher(frame, program);
    const bool whole = source->width != frame->width || source->height != frame->height; /* the G-buffer, not a sum */
    const int corner[2] = {whole ? (int)frame->settings->crop[0] : 0, whole ? (int)frame->settings->crop[1] : 0};
    gl->Uniform2iv(gl->GetUniformLocation(program, "corner"), 1, corner);
    program_set_int(gl, program, "width", frame->width);
    program_set_float(gl, program, "sample_weight", 1.0f / (float)frame->sums_samples);
    const int row_bytes = frame->width * (int)kind->channels * (int)sizeof(float);
    int band = (int)(BAND_BYTES / (unsigned)row_bytes);
    band = band < 1 ? 1 : band > frame->height ? frame->height : band;
    gl->BindBuffer(GL_SHADER_STORAGE_BUFFER, renderer->pixel_buffer);
    gl->BufferData(GL_SHADER_STORAGE_BUFFER, (GLsizeiptr)row_bytes * band, NULL, GL_STREAM_READ);
    gl->BindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, renderer->pixel_buffer);
    for (int row = 0; row < frame->height && result == PNB_OK; row += band)
        result = resolve_band(frame, program, (int)kind->channels, row,
                              band < frame->height - row ? band : frame->height - row, pixels);
    timer_end(&renderer->timer, (uint64_t)row_bytes * (uint64_t)band);
    return result;
}

/* Depth is not averaged over the samples: the mean of two surfaces is the depth of neither. */
pnb_result pass_resolve_first_sample(struct frame *frame) {
    return resolve_image(frame, IMAGE_DEPTH, &frame->renderer->gbuffer_depth, NULL);
}

pnb_result pass_resolve(struct frame *frame) {
    struct renderer *renderer = frame->renderer;
    pnb_result result;
    if ((result = resolve_image(frame, IMAGE_COMBINED, &renderer->combined, NULL)) != PNB_OK ||
        (result = resolve_image(frame, IMAGE_NORMAL, &renderer->normal, NULL)) != PNB_OK ||
        (result = resolve_image(frame, IMAGE_SHADOW, &renderer->shadowed, &renderer->unshadowed)) != PNB_OK)
        return result;
    for (uint32_t i = 0; i < frame->scene->light_count && result == PNB_OK; i++)
        result = resolve_image(frame, IMAGE_LIGHT_SHADOWS + (int)i, &renderer->light_shadows[i], NULL);
    return result;
}
