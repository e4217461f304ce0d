/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "passes.h"

#include <stdio.h>
#include <string.h>

void light_block_upload(struct renderer *renderer, const struct emitter *emitter, const struct light_views *views) {
    struct light_block block = {.tan_half_angle = emitter->tan_half_angle,
                                .casts_shadow = emitter->casts_shadow ? 1.0f : 0.0f,
                                .view_count = views->count};
    memcpy(block.views, views->views, sizeof block.views);
    glm_vec4((float *)emitter->position, 0.0f, block.position);
    glm_vec4((float *)emitter->frame[0], 0.0f, block.frame_x);
    glm_vec4((float *)emitter->frame[1], emitter->cosine_spot ? 1.0f : 0.0f, block.frame_y);
    glm_vec4((float *)emitter->frame[2], 0.0f, block.frame_z);
    glm_vec4((float *)emitter->half_u, 0.0f, block.half_u);
    glm_vec4((float *)emitter->half_v, 0.0f, block.half_v);
    glm_vec4((float *)emitter->emission, emitter->radius, block.emission);
    block.cone[0] = emitter->type == PNB_LIGHT_AREA ? emitter->tan_half_spread : emitter->cos_cone;
    block.cone[1] = emitter->blend;
    block.cone[2] = emitter->cone_scale[0];
    block.cone[3] = emitter->cone_scale[1];
    for (int i = 0; i < 4; i++)
        block.faces_a[i] = views->layer_of_face[i];
    block.faces_b[0] = views->layer_of_face[4];
    block.faces_b[1] = views->layer_of_face[5];
    const struct gl *gl = renderer->gl;
    gl->BindBuffer(GL_UNIFORM_BUFFER, renderer->light_buffer);
    gl->BufferData(GL_UNIFORM_BUFFER, sizeof block, &block, GL_STREAM_DRAW);
    gl->BindBufferBase(GL_UNIFORM_BUFFER, 1, renderer->light_buffer);
}

void bind_gbuffer(struct renderer *renderer, GLuint program) {
    static const char *const names[] = {"gbuffer_depth", "gbuffer_normal", "gbuffer_color"};
    const struct gl_texture *textures[] = {&renderer->gbuffer_depth, &renderer->gbuffer_normal,
                                           &renderer->gbuffer_color};
    for (int i = 0; i < 3; i++) {
        gl_texture_bind(renderer->gl, textures[i], i);
        program_set_int(renderer->gl, program, names[i], i);
    }
}

#define DEFINES(type, ellipse, spread)                                                                                 \
    {                                                                                                                  \
        "#define LIGHT_TYPE " #type "\n#define ELLIPSE " #ellipse "\n" spread,                                         \
            "#define LIGHT_TYPE " #type "\n#define ELLIPSE " #ellipse "\n#define SINGLE_VIEW\n" spread                 \
    }

const char *light_defines(const struct emitter *emitter, const struct light_views *views) {
    static const char *const area[2][2][2] = {{DEFINES(0, 0, ""), DEFINES(0, 0, "#define SPREAD\n")},
                                              {DEFINES(0, 1, ""), DEFINES(0, 1, "#define SPREAD\n")}};
    static const char *const others[][2] = {[PNB_LIGHT_POINT] = DEFINES(1, 1, ""),
                                            [PNB_LIGHT_SPOT] = DEFINES(2, 1, ""),
                                            [PNB_LIGHT_SUN] = DEFINES(3, 1, "")};
    const bool spread = emitter->tan_half_spread > 0.0f;
    return emitter->type == PNB_LIGHT_AREA ? area[emitter->ellipse][spread][views->single]
                                           : others[emitter->type][views->single];
}

const char *technique_defines(const struct frame_light *light) {
    return light->technique->defines ? light->technique->defines(light->parameters) : NULL;
}

void set_parameters(const struct gl *gl, GLuint program, const struct frame_light *light) {
    for (int i = 0; light->technique->parameters[i].name; i++) {
        const struct parameter *parameter = &light->technique->parameters[i];
        char name[64];
        snprintf(name, sizeof name, "p_%s", parameter->name);
        if (parameter->type == PNB_FLOAT)
            program_set_float(gl, program, name, (float)light->parameters[i]);
        else
            program_set_int(gl, program, name, (int)light->parameters[i]);
    }
}

static void upload_taps(struct frame *frame, const struct frame_light *light, GLuint program) {
    const struct gl *gl = frame->gl;
    struct taps taps = {0};
    light->technique->taps(light->parameters, light->emitter.ellipse, frame->sample, reuse_key_count(frame), &taps);
    gl->BindBuffer(GL_UNIFORM_BUFFER, frame->renderer->tap_buffer);
    gl->BufferData(GL_UNIFORM_BUFFER, sizeof taps.search + sizeof taps.filter, &taps, GL_STREAM_DRAW);
    gl->BindBufferBase(GL_UNIFORM_BUFFER, 2, frame->renderer->tap_buffer);
    program_set_int(gl, program, "search_count", taps.search_count);
    program_set_int(gl, program, "filter_count", taps.filter_count);
}

void bind_technique(struct frame *frame, const struct frame_light *light, GLuint program) {
    const struct gl *gl = frame->gl;
    set_parameters(gl, program, light);
    if (light->technique->taps)
        upload_taps(frame, light, program);
    if (light->views.count > 0) {
        gl_texture_bind(gl, &light->shadow_map, 3);
        if (light->min_max.id)
            gl_texture_bind(gl, &light->min_max, 4);
    }
    program_set_int(gl, program, "shadow_map", 3);
    program_set_int(gl, program, "min_max", 4);
    if (light->technique->bind)
        light->technique->bind(frame, light, program, 5);
}

/* Gives the current program what common_visibility.glsl reads. */
static void bind_visibility(struct frame *frame, const struct frame_light *light, GLuint program) {
    bind_gbuffer(frame->renderer, program);
    bind_steady(frame, program);
    bind_technique(frame, light, program);
}

/* coarse: every other pixel of both axes, else all that are wanted. */
static pnb_result draw_pixels(struct frame *frame, const struct frame_light *light, enum tiles tiles, bool coarse) {
    struct renderer *renderer = frame->renderer;
    const struct gl *gl = renderer->gl;
    const struct program_desc desc = {.vertex = tiles ? "pass_tile.vert" : "pass_screen.vert",
                                      .fragment = "pass_visibility.frag",
                                      .technique = light->technique->shader,
                                      .defines = {light_defines(&light->emitter, &light->views),
                                                  technique_defines(light), fragment_defines(frame, &light->lists),
                                                  coarse ? "#define EVERY_OTHER_PIXEL\n" : NULL}};
    GLuint program;
    pnb_result result = program_use(&renderer->programs, &desc, &program);
    if (result != PNB_OK || (result = pass_begin(frame, "Visibility")) != PNB_OK)
        return result;
    const struct gl_texture *output = coarse ? &renderer->coarse_visibility : &renderer->visibility;
    const struct gl_target target = {
        .colors = {output}, .color_count = 1, .depth = coarse ? NULL : if_made(&renderer->drawn)};
    if ((result = gl_target_bind(gl, renderer->framebuffer, &target)) != PNB_OK)
        return result;
    test_depth(frame, !coarse && frame->reuses);
    gl->Disable(GL_BLEND);
    if (coarse)
        bind_subsampling(frame, program);
    bind_visibility(frame, light, program);
    draw_over(frame, program, tiles, true);
    pass_end(frame, gl_texture_bytes(output));
    return gl_check(gl, "visibility");
}

static pnb_result draw_list(struct frame *frame, const struct frame_light *light) {
    struct renderer *renderer = frame->renderer;
    const struct gl *gl = renderer->gl;
    const struct program_desc desc = {.compute = "pass_visibility_list.comp",
                                      .technique = light->technique->shader,
                                      .defines = {light_defines(&light->emitter, &light->views),
                                                  technique_defines(light), fragment_defines(frame, &light->lists)}};
    GLuint program;
    pnb_result result = program_use(&renderer->programs, &desc, &program);
    if (result != PNB_OK || (result = pass_begin(frame, "Visibility")) != PNB_OK)
        return result;
    bind_visibility(frame, light, program);
    gl->BindImageTexture(0, renderer->visibility.id, 0, GL_FALSE, 0, GL_WRITE_ONLY, renderer->visibility.format);
    pixel_list_dispatch(frame);
    pass_end(frame, gl_texture_bytes(&renderer->visibility));
    return gl_check(gl, "visibility of listed pixels");
}

static pnb_result draw_subsampled(struct frame *frame, const struct frame_light *light) {
    pnb_result result = draw_pixels(frame, light, TILES_NONE, true);
    const int rows = pixel_list_rows(frame);
    for (int row = 0; row < frame->height && result == PNB_OK; row += rows)
        if ((result = pass_interpolate(frame, light, row, rows)) == PNB_OK)
            result = draw_list(frame, light);
    return result;
}

pnb_result pass_visibility(struct frame *frame, const struct frame_light *light, enum tiles tiles) {
    /* Between keys few pixels are drawn, and hardly any with all its neighbours. */
    const bool subsampled =
        technique_subsamples(light->technique, light->parameters) && tiles == TILES_NONE && reuse_is_key(frame);
    return subsampled ? draw_subsampled(frame, light) : draw_pixels(frame, light, tiles, false);
}
