/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "passes.h"

/* One axis: every layer of source -> target. */
static pnb_result convolve(struct frame *frame, const struct gl_texture *source, const struct gl_texture *target,
                           int width, bool vertical) {
    struct renderer *renderer = frame->renderer;
    const struct gl *gl = renderer->gl;
    static const struct program_desc desc = {.vertex = "pass_screen.vert", .fragment = "pass_gauss.frag"};
    GLuint program;
    pnb_result result = program_use(&renderer->programs, &desc, &program);
    if (result != PNB_OK)
        return result;
    gl_texture_bind(gl, source, 0);
    program_set_int(gl, program, "source", 0);
    program_set_int(gl, program, "radius", width / 2);
    program_set_int(gl, program, "vertical", vertical);
    for (int layer = 0; layer < target->layers && result == PNB_OK; layer++) {
        const struct gl_target to = {.colors = {target}, .color_count = 1, .layer = layer};
        result = gl_target_bind(gl, renderer->framebuffer, &to);
        program_set_int(gl, program, "layer", layer);
        if (result == PNB_OK)
            draw_screen(renderer);
    }
    return result;
}

pnb_result pass_gauss(struct frame *frame, struct gl_texture *texture, int width) {
    struct gl_texture rows = {0};
    pnb_result result =
        gl_texture_ensure(frame->gl, &rows, texture->format, texture->width, texture->height, texture->layers, 1);
    if (result == PNB_OK)
        result = pass_begin(frame, "Gaussian");
    if (result == PNB_OK) {
        frame->gl->Disable(GL_DEPTH_TEST);
        frame->gl->Disable(GL_BLEND);
        result = convolve(frame, texture, &rows, width, false);
        if (result == PNB_OK)
            result = convolve(frame, &rows, texture, width, true);
        pass_end(frame, gl_texture_bytes(&rows));
    }
    gl_texture_free(frame->gl, &rows);
    return result == PNB_OK ? gl_check(frame->gl, "Gaussian") : result;
}
