/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "../memory.h"
#include "passes.h"

#include <stdio.h>

#define NO_DEPTH 1e10f /* Blender's value where there is nothing */

static pnb_result read_pixels(struct frame *frame, const struct gl_texture *texture, GLenum format, float *pixels) {
    const struct gl *gl = frame->gl;
    const struct gl_target target = {.colors = {texture}, .color_count = 1};
    pnb_result result = gl_target_bind(gl, frame->renderer->framebuffer, &target);
    if (result != PNB_OK)
        return result;
    gl->ReadBuffer(GL_COLOR_ATTACHMENT0);
    gl->PixelStorei(GL_PACK_ALIGNMENT, 4);
    gl->ReadPixels(0, 0, frame->width, frame->height, format, GL_FLOAT, pixels);
    return gl_check(gl, "read-back");
}

/* A new image of the job with what the texture holds. */
static pnb_result read_back(struct frame *frame, const struct gl_texture *texture, GLenum format, const char *name,
                            uint32_t channels, float **pixels) {
    *pixels = job_add_image(frame->job, name, channels);
    return *pixels ? read_pixels(frame, texture, format, *pixels) : PNB_ERROR_OUT_OF_MEMORY;
}

static pnb_result draw_resolve(struct frame *frame) {
    struct renderer *renderer = frame->renderer;
    const struct gl *gl = renderer->gl;
    struct gl_texture *outputs[] = {&renderer->out_combined, &renderer->out_shadow, &renderer->out_normal};
    const struct gl_texture *sums[] = {&renderer->combined, &renderer->shadowed, &renderer->unshadowed, &renderer->normal};
    static const char *const names[] = {"combined", "shadowed", "unshadowed", "normal"};
    pnb_result result = PNB_OK;
    for (int i = 0; i < 3 && result == PNB_OK; i++)
        result = gl_texture_ensure(gl, outputs[i], GL_RGBA32F, frame->width, frame->height, 0, 1);
    const struct gl_target target = {.colors = {outputs[0], outputs[1], outputs[2]}, .color_count = 3};
    if (result != PNB_OK || (result = gl_target_bind(gl, renderer->framebuffer, &target)) != PNB_OK)
        return result;
    gl->Disable(GL_BLEND);
    gl->Disable(GL_DEPTH_TEST);
    static const struct program_desc desc = {.vertex = "pass_screen.vert", .fragment = "pass_resolve.frag"};
    GLuint program;
    if ((result = program_use(&renderer->programs, &desc, &program)) != PNB_OK)
        return result;
    for (int i = 0; i < 4; i++) {
        gl_texture_bind(gl, sums[i], i);
        program_set_int(gl, program, names[i], i);
    }
    program_set_float(gl, program, "sample_weight", 1.0f / (float)frame->settings->samples);
    draw_screen(renderer);
    return gl_check(gl, "resolve");
}

/* The share of each light: a plain average over the samples. */
static pnb_result resolve_light(struct frame *frame, uint32_t light) {
    char name[256];
    snprintf(name, sizeof name, "Shadow.%s", frame->scene->lights[light].name);
    float *pixels;
    pnb_result result = read_back(frame, &frame->renderer->light_shadows[light], GL_RGB, name, 3, &pixels);
    if (result != PNB_OK)
        return result;
    const float weight = 1.0f / (float)frame->settings->samples;
    for (size_t i = 0; i < 3 * (size_t)frame->width * (size_t)frame->height; i++)
        pixels[i] *= weight;
    return PNB_OK;
}

/* Depth is not averaged over the samples: the mean of two surfaces is the depth of neither. */
pnb_result pass_first_sample(struct frame *frame) {
    const size_t count = (size_t)frame->width * (size_t)frame->height;
    if (!(frame->settings->passes & PNB_PASS_DEPTH))
        return PNB_OK;
    frame->first_depth = memory_array(count, sizeof *frame->first_depth);
    if (!frame->first_depth)
        return PNB_ERROR_OUT_OF_MEMORY;
    return read_pixels(frame, &frame->renderer->gbuffer_depth, GL_RED, frame->first_depth);
}

static pnb_result add_depth(struct frame *frame) {
    float *pixels = job_add_image(frame->job, "Depth", 1);
    if (!pixels)
        return PNB_ERROR_OUT_OF_MEMORY;
    for (size_t i = 0; i < (size_t)frame->width * (size_t)frame->height; i++)
        pixels[i] = frame->first_depth[i] > 0.0f ? frame->first_depth[i] : NO_DEPTH;
    return PNB_OK;
}

pnb_result pass_resolve(struct frame *frame) {
    struct renderer *renderer = frame->renderer;
    const uint32_t passes = frame->settings->passes;
    pnb_result result = timer_begin(&renderer->timer, "Resolve and read-back");
    if (result != PNB_OK)
        return result;
    float *pixels;
    result = draw_resolve(frame);
    if (result == PNB_OK && (passes & PNB_PASS_COMBINED))
        result = read_back(frame, &renderer->out_combined, GL_RGBA, "Combined", 4, &pixels);
    if (result == PNB_OK && (passes & PNB_PASS_DEPTH))
        result = add_depth(frame);
    if (result == PNB_OK && (passes & PNB_PASS_NORMAL))
        result = read_back(frame, &renderer->out_normal, GL_RGB, "Normal", 3, &pixels);
    if (result == PNB_OK && (passes & PNB_PASS_SHADOW))
        result = read_back(frame, &renderer->out_shadow, GL_RGB, "Shadow", 3, &pixels);
    for (uint32_t i = 0; i < frame->scene->light_count && result == PNB_OK && (passes & PNB_PASS_LIGHT_SHADOWS); i++)
        result = resolve_light(frame, i);
    timer_end(&renderer->timer, gl_texture_bytes(&renderer->out_combined) * 3);
    return result;
}
