/* SPDX-License-Identifier: GPL-3.0-or-later
 * Image-space sub-sampling (Selgrad et al. 2015, section 8): a technique is drawn at every other pixel of both axes,
 * interpolated in between where that is safe, and drawn at the pixels that are left. */
#include "passes.h"

/* Pixels with even full-image coordinates from that at or before the crop's first to that at or after its last. */
static int coarse_size(uint32_t first, uint32_t size) {
    return (int)((first + size) / 2 - first / 2 + 1);
}

pnb_result ensure_subsampling(struct frame *frame, bool wanted) {
    struct renderer *renderer = frame->renderer;
    const uint32_t *crop = frame->settings->crop;
    if (!wanted) {
        gl_texture_free(frame->gl, &renderer->coarse_visibility);
        return PNB_OK;
    }
    const GLenum format = frame->scene->colored ? GL_RGBA16F : GL_R32F;
    return gl_texture_ensure(frame->gl, &renderer->coarse_visibility, format, coarse_size(crop[0], crop[2]),
                             coarse_size(crop[1], crop[3]), 0, 1);
}

void bind_subsampling(struct frame *frame, GLuint program) {
    const uint32_t *crop = frame->settings->crop;
    program_set_vec2(frame->gl, program, "first_pixel", (const float[2]){-(float)(crop[0] % 2), -(float)(crop[1] % 2)});
}

pnb_result pass_interpolate(struct frame *frame, const struct frame_light *light, int row, int rows) {
    struct renderer *renderer = frame->renderer;
    const struct gl *gl = renderer->gl;
    const struct program_desc desc = {
        .vertex = "pass_screen.vert",
        .fragment = "pass_interpolate.frag",
        .defines = {light_defines(&light->emitter, &light->views), fragment_defines(frame, &light->lists)}};
    GLuint program;
    pnb_result result = program_use(&renderer->programs, &desc, &program);
    if (result != PNB_OK || (result = pass_begin(frame, "Interpolation")) != PNB_OK)
        return result;
    const struct gl_target target = {.colors = {&renderer->visibility}, .color_count = 1};
    if ((result = gl_target_bind(gl, renderer->framebuffer, &target)) == PNB_OK &&
        (result = pixel_list_begin(frame)) == PNB_OK) {
        gl->Disable(GL_BLEND);
        test_depth(frame, false);
        gl->Enable(GL_SCISSOR_TEST);
        gl->Scissor(0, row, frame->width, rows);
        bind_gbuffer(renderer, program);
        bind_subsampling(frame, program);
        gl_texture_bind(gl, &renderer->coarse_visibility, 3);
        program_set_int(gl, program, "coarse_visibility", 3);
        draw_screen(renderer);
        gl->Disable(GL_SCISSOR_TEST);
        result = gl_check(gl, "interpolation");
    }
    pass_end(frame, gl_texture_bytes(&renderer->coarse_visibility) + renderer->pixel_list.bytes);
    return result;
}
