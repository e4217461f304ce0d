/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "passes.h"

static uint64_t sums_bytes(const struct renderer *renderer) {
    return gl_texture_bytes(&renderer->combined) + gl_texture_bytes(&renderer->shadowed) +
           gl_texture_bytes(&renderer->unshadowed) + gl_texture_bytes(&renderer->normal);
}

static pnb_result clear_sum(struct frame *frame, struct gl_texture *texture) {
    const struct gl *gl = frame->gl;
    pnb_result result = gl_texture_ensure(gl, texture, GL_RGBA32F, frame->width, frame->height, 0, 1);
    const struct gl_target target = {.colors = {texture}, .color_count = 1};
    if (result != PNB_OK || (result = gl_target_bind(gl, frame->renderer->framebuffer, &target)) != PNB_OK)
        return result;
    const float zero[4] = {0, 0, 0, 0};
    gl->ClearBufferfv(GL_COLOR, 0, zero);
    return PNB_OK;
}

pnb_result pass_clear_sums(struct frame *frame) {
    struct renderer *renderer = frame->renderer;
    struct gl_texture *sums[] = {&renderer->combined, &renderer->shadowed, &renderer->unshadowed, &renderer->normal};
    for (int i = 0; i < 4; i++) {
        pnb_result result = clear_sum(frame, sums[i]);
        if (result != PNB_OK)
            return result;
    }
    for (uint32_t i = 0; i < MAX_LIGHTS; i++) {
        const bool wanted = i < frame->scene->light_count && (frame->settings->passes & PNB_PASS_LIGHT_SHADOWS);
        pnb_result result = PNB_OK;
        if (wanted)
            result = clear_sum(frame, &renderer->light_shadows[i]);
        else
            gl_texture_free(frame->gl, &renderer->light_shadows[i]);
        if (result != PNB_OK)
            return result;
    }
    return PNB_OK;
}

/* Additive: every pass of every sample adds to the sums. */
static void begin_adding(const struct gl *gl) {
    gl->Disable(GL_DEPTH_TEST);
    gl->Enable(GL_BLEND);
    gl->BlendFunc(GL_ONE, GL_ONE);
}

pnb_result pass_base(struct frame *frame) {
    struct renderer *renderer = frame->renderer;
    const struct gl *gl = renderer->gl;
    pnb_result result = timer_begin(&renderer->timer, "Ambient");
    const struct gl_target target = {.colors = {&renderer->combined, NULL, NULL, &renderer->normal}, .color_count = 4};
    if (result != PNB_OK || (result = gl_target_bind(gl, renderer->framebuffer, &target)) != PNB_OK)
        return result;
    begin_adding(gl);
    static const struct program_desc desc = {.vertex = "pass_screen.vert", .fragment = "pass_base.frag"};
    GLuint program;
    if ((result = program_use(&renderer->programs, &desc, &program)) != PNB_OK)
        return result;
    bind_gbuffer(renderer, program);
    const float *world = frame->scene->world_color;
    const bool transparent = frame->settings->flags & PNB_SETTINGS_FILM_TRANSPARENT;
    program_set_vec4(gl, program, "world", (const float[4]){world[0], world[1], world[2], transparent ? 0.0f : 1.0f});
    draw_screen(renderer);
    timer_end(&renderer->timer, sums_bytes(renderer));
    return gl_check(gl, "ambient");
}

pnb_result pass_shading(struct frame *frame, uint32_t light) {
    struct renderer *renderer = frame->renderer;
    const struct gl *gl = renderer->gl;
    pnb_result result = timer_begin(&renderer->timer, "Shading");
    const bool shadow = frame->settings->passes & PNB_PASS_SHADOW;
    const bool per_light = frame->settings->passes & PNB_PASS_LIGHT_SHADOWS;
    const struct gl_target target = {.colors = {&renderer->combined, shadow ? &renderer->shadowed : NULL,
                                                shadow ? &renderer->unshadowed : NULL,
                                                per_light ? &renderer->light_shadows[light] : NULL},
                                     .color_count = 4};
    if (result != PNB_OK || (result = gl_target_bind(gl, renderer->framebuffer, &target)) != PNB_OK)
        return result;
    begin_adding(gl);
    const struct frame_light *source = &frame->lights[light];
    const struct program_desc desc = {.vertex = "pass_screen.vert",
                                      .fragment = "pass_shading.frag",
                                      .defines = {light_defines(&source->emitter, &source->views)}};
    GLuint program;
    if ((result = program_use(&renderer->programs, &desc, &program)) != PNB_OK)
        return result;
    bind_gbuffer(renderer, program);
    gl_texture_bind(gl, &renderer->visibility, 3);
    program_set_int(gl, program, "visibility", 3);
    draw_screen(renderer);
    timer_end(&renderer->timer, per_light ? gl_texture_bytes(&renderer->light_shadows[light]) : 0);
    return gl_check(gl, "shading");
}
