/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "passes.h"

static uint64_t sums_bytes(const struct renderer *renderer) {
    return gl_texture_bytes(&renderer->combined) + gl_texture_bytes(&renderer->shadowed) +
           gl_texture_bytes(&renderer->unshadowed) + gl_texture_bytes(&renderer->normal) +
           gl_texture_bytes(&renderer->caught) + gl_texture_bytes(&renderer->uncaught);
}

static pnb_result ensure_sum(struct frame *frame, struct gl_texture *texture, bool wanted) {
    if (wanted)
        return gl_texture_ensure(frame->gl, texture, GL_RGBA32F, frame->width, frame->height, 0, 1);
    gl_texture_free(frame->gl, texture);
    return PNB_OK;
}

static pnb_result clear_sum(struct frame *frame, const struct gl_texture *texture) {
    const struct gl_target target = {.colors = {texture}, .color_count = 1};
    const float zero[4] = {0, 0, 0, 0};
    pnb_result result = gl_target_bind(frame->gl, frame->renderer->framebuffer, &target);
    if (result == PNB_OK)
        frame->gl->ClearBufferfv(GL_COLOR, 0, zero);
    return result;
}

pnb_result pass_prepare_sums(struct frame *frame) {
    struct renderer *renderer = frame->renderer;
    const uint32_t passes = frame->settings->passes;
    pnb_result result;
    if ((result = ensure_sum(frame, &renderer->combined, true)) != PNB_OK ||
        (result = ensure_sum(frame, &renderer->shadowed, passes & PNB_PASS_SHADOW)) != PNB_OK ||
        (result = ensure_sum(frame, &renderer->unshadowed, passes & PNB_PASS_SHADOW)) != PNB_OK ||
        (result = ensure_sum(frame, &renderer->normal, passes & PNB_PASS_NORMAL)) != PNB_OK ||
        (result = ensure_sum(frame, &renderer->caught, frame->scene->catches_shadows)) != PNB_OK ||
        (result = ensure_sum(frame, &renderer->uncaught, frame->scene->catches_shadows)) != PNB_OK)
        return result;
    if ((result = ensure_irradiance(frame)) != PNB_OK)
        return result;
    for (uint32_t i = 0; i < MAX_LIGHTS && result == PNB_OK; i++) {
        const bool wanted = i < frame->scene->light_count && (passes & PNB_PASS_LIGHT_SHADOWS);
        result = ensure_sum(frame, &renderer->light_shadows[i], wanted);
        if (wanted && result == PNB_OK)
            result = clear_sum(frame, &renderer->light_shadows[i]);
    }
    return result;
}

const struct gl_texture *if_made(const struct gl_texture *texture) {
    return texture->id ? texture : NULL;
}

static void set_world(struct frame *frame, GLuint program) {
    const float *world = frame->scene->world_color;
    const bool transparent = frame->settings->flags & PNB_SETTINGS_FILM_TRANSPARENT;
    const float value[4] = {world[0], world[1], world[2], transparent ? 0.0f : 1.0f};
    program_set_vec4(frame->gl, program, "world", value);
}

static const char *shading_defines(const struct frame *frame, bool first) {
    if (!first)
        return NULL;
    return frame->scene->emissive ? "#define FIRST\n#define EMISSION\n" : "#define FIRST\n";
}

static void bind_irradiance(struct frame *frame, GLuint program) {
    struct renderer *renderer = frame->renderer;
    const struct gl *gl = renderer->gl;
    const bool both = renderer->unshadowed_irradiance.id;
    gl_texture_bind(gl, &renderer->irradiance, 3);
    gl_texture_bind(gl, both ? &renderer->unshadowed_irradiance : &renderer->irradiance, 4);
    program_set_int(gl, program, "irradiance", 3);
    program_set_int(gl, program, "unshadowed", 4);
}

pnb_result pass_shading(struct frame *frame, bool first) {
    struct renderer *renderer = frame->renderer;
    const struct gl *gl = renderer->gl;
    const bool lit = frame->scene->light_count > 0;
    const struct program_desc desc = {.vertex = "pass_screen.vert",
                                      .fragment = "pass_shading.frag",
                                      .defines = {lit ? "#define LIT\n" : NULL, shading_defines(frame, first),
                                                  renderer->normal.id ? "#define NORMAL\n" : NULL}};
    GLuint program;
    pnb_result result = program_use(&renderer->programs, &desc, &program);
    if (result != PNB_OK || (result = pass_begin(frame, "Shading")) != PNB_OK)
        return result;
    const struct gl_target target = {
        .colors = {&renderer->combined, if_made(&renderer->shadowed), if_made(&renderer->unshadowed),
                   first ? if_made(&renderer->normal) : NULL, if_made(&renderer->caught), if_made(&renderer->uncaught)},
        .color_count = 6};
    if ((result = gl_target_bind(gl, renderer->framebuffer, &target)) == PNB_OK) {
        gl->Disable(GL_DEPTH_TEST);
        /* Every sample adds to the sums, except the very first, which replaces what they held. */
        (first && frame->sample == 0 ? gl->Disable : gl->Enable)(GL_BLEND);
        gl->BlendFunc(GL_ONE, GL_ONE);
        bind_gbuffer(renderer, program);
        gl_texture_bind(gl, frame->scene->emissive ? &renderer->gbuffer_emission : &renderer->gbuffer_color, 5);
        program_set_int(gl, program, "gbuffer_emission", 5);
        if (lit)
            bind_irradiance(frame, program);
        set_world(frame, program);
        draw_screen(renderer);
        result = gl_check(gl, "shading");
    }
    pass_end(frame, sums_bytes(renderer));
    return result;
}
