/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "passes.h"

void camera_block_upload(struct frame *frame) {
    const struct gl *gl = frame->gl;
    gl->BindBuffer(GL_UNIFORM_BUFFER, frame->renderer->camera_buffer);
    gl->BufferData(GL_UNIFORM_BUFFER, sizeof frame->camera, &frame->camera, GL_STREAM_DRAW);
    gl->BindBufferBase(GL_UNIFORM_BUFFER, 0, frame->renderer->camera_buffer);
}

static pnb_result ensure_optional(struct renderer *renderer, struct gl_texture *texture, GLenum format, int width,
                                  int height, bool wanted) {
    if (wanted)
        return gl_texture_ensure(renderer->gl, texture, format, width, height, 0, 1);
    gl_texture_free(renderer->gl, texture);
    return PNB_OK;
}

static pnb_result ensure_gbuffer(struct renderer *renderer, int width, int height, bool emissive, bool linked) {
    const struct {
        struct gl_texture *texture;
        GLenum format;
    } parts[] = {{&renderer->gbuffer_depth, GL_R32F},
                 {&renderer->gbuffer_normal, GL_RGBA16_SNORM},
                 {&renderer->gbuffer_color, GL_RGBA16F},
                 {&renderer->gbuffer_z, GL_DEPTH_COMPONENT32F}};
    pnb_result result = ensure_optional(renderer, &renderer->gbuffer_emission, GL_RGBA16F, width, height, emissive);
    if (result == PNB_OK)
        result = ensure_optional(renderer, &renderer->gbuffer_links, GL_RG32UI, width, height, linked);
    for (int i = 0; i < 4 && result == PNB_OK; i++)
        result = gl_texture_ensure(renderer->gl, parts[i].texture, parts[i].format, width, height, 0, 1);
    return result;
}

/* The G-buffer is that of the full image, whatever the crop, so that pixels do not depend on it to the last bit; only
 * the crop of it is drawn when no more is needed. */
static void scissor_crop(const struct frame *frame) {
    const struct gl *gl = frame->gl;
    const GLint *crop = (const GLint *)frame->settings->crop;
    GLint border = 0; /* pixels beside the crop are interpolated from, too */
    for (uint32_t i = 0; i < frame->scene->light_count; i++)
        if (technique_subsamples(frame->lights[i].technique, frame->lights[i].parameters))
            border = 1;
    gl->Enable(GL_SCISSOR_TEST);
    gl->Scissor(crop[0] - border, crop[1] - border, crop[2] + 2 * border, crop[3] + 2 * border);
}

pnb_result pass_gbuffer(struct frame *frame, bool whole) {
    struct renderer *renderer = frame->renderer;
    const struct gl *gl = renderer->gl;
    const bool emissive = frame->scene->emissive, linked = frame->scene->light_linked;
    pnb_result result =
        ensure_gbuffer(renderer, (int)frame->settings->width, (int)frame->settings->height, emissive, linked);
    if (result != PNB_OK || (result = pass_begin(frame, "G-buffer")) != PNB_OK)
        return result;
    const struct gl_target target = {.colors = {&renderer->gbuffer_depth, &renderer->gbuffer_normal,
                                                &renderer->gbuffer_color, emissive ? &renderer->gbuffer_emission : NULL,
                                                linked ? &renderer->gbuffer_links : NULL},
                                     .color_count = linked     ? 5
                                                    : emissive ? 4
                                                               : 3,
                                     .depth = &renderer->gbuffer_z};
    if ((result = gl_target_bind(gl, renderer->framebuffer, &target)) != PNB_OK)
        return result;
    if (!whole)
        scissor_crop(frame);
    gl->Enable(GL_DEPTH_TEST);
    gl->DepthMask(GL_TRUE);
    gl->Disable(GL_BLEND);
    const float nothing[4] = {0, 0, 0, 0}, farthest = 1.0f;
    for (int i = 0; i < (emissive ? 4 : 3); i++)
        gl->ClearBufferfv(GL_COLOR, i, nothing);
    if (linked)
        gl->ClearBufferuiv(GL_COLOR, 4, (const GLuint[4]){0, 0, 0, 0});
    gl->ClearBufferfv(GL_DEPTH, 0, &farthest);

    float planes[2] = {frame->scene->camera.clip_start, frame->scene->camera.clip_end};
    gpu_scene_depth_range(renderer->scene, &frame->camera, planes);
    mat4 clip;
    camera_projection(&frame->camera, planes[0], planes[1], clip);
    const char *const optional = emissive && linked ? "#define EMISSION\n#define LINKS\n"
                                 : emissive         ? "#define EMISSION\n"
                                 : linked           ? "#define LINKS\n"
                                                    : NULL;
    const struct program_desc descs[] = {
        {.vertex = "pass_gbuffer.vert", .fragment = "pass_gbuffer.frag", .defines = {optional}},
        {.vertex = "pass_gbuffer.vert", .fragment = "pass_gbuffer.frag", .defines = {optional, "#define SPECIAL\n"}}};
    GLuint programs[2];
    for (int i = 0; i < 2 && result == PNB_OK; i++) {
        result = program_use(&renderer->programs, &descs[i], &programs[i]);
        if (result == PNB_OK)
            program_set_mat4(gl, programs[i], "projection", (const float *)clip);
    }
    if (result == PNB_OK)
        result = gpu_scene_draw(
            renderer->scene, clip, PNB_INSTANCE_HIDDEN_FROM_CAMERA, 0,
            &(struct draw_programs){programs[0], programs[1], CASTERS_NONE, PNB_MATERIAL_CULL_CAMERA, false});
    gl->Disable(GL_SCISSOR_TEST);
    pass_end(frame,
              gl_texture_bytes(&renderer->gbuffer_depth) + gl_texture_bytes(&renderer->gbuffer_normal) +
                  gl_texture_bytes(&renderer->gbuffer_color) + gl_texture_bytes(&renderer->gbuffer_emission) +
                  gl_texture_bytes(&renderer->gbuffer_z) + gl_texture_bytes(&renderer->gbuffer_links));
    return result;
}
