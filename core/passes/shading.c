/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "passes.h"

/* Attachment of the light's own share. */
#define SHARE 4

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
    for (uint32_t i = 0; i < MAX_LIGHTS && result == PNB_OK; i++) {
        const bool wanted = i < frame->scene->light_count && (passes & PNB_PASS_LIGHT_SHADOWS);
        result = ensure_sum(frame, &renderer->light_shadows[i], wanted);
        if (wanted && result == PNB_OK)
            result = clear_sum(frame, &renderer->light_shadows[i]);
    }
    return result;
}

/* Every pass of every sample adds to the sums, except the very first, which replaces what they held. Blending is
 * switched for all targets at once, so that with a light's share, which was cleared, the others are cleared too. */
static void begin_adding(const struct gl *gl, bool replace, bool with_share) {
    gl->Disable(GL_DEPTH_TEST);
    if (replace && !with_share) {
        gl->Disable(GL_BLEND);
        return;
    }
    for (int i = 0; i < MAX_ATTACHMENTS && replace; i++)
        if (i != SHARE)
            gl->ClearBufferfv(GL_COLOR, i, (const float[4]){0, 0, 0, 0});
    gl->Enable(GL_BLEND);
    gl->BlendFunc(GL_ONE, GL_ONE);
}

static const struct gl_texture *if_made(const struct gl_texture *texture) {
    return texture->id ? texture : NULL;
}

static pnb_result use_program(struct frame *frame, const struct frame_light *light, bool first, bool tiles,
                              GLuint *program) {
    const char *const first_define = frame->scene->emissive ? "#define FIRST\n#define EMISSION\n" : "#define FIRST\n";
    const bool links = light && frame->scene->light_linked;
    const struct program_desc desc = {.vertex = tiles ? "pass_tile.vert" : "pass_screen.vert",
                                      .fragment = "pass_shading.frag",
                                      .defines = {light ? light_defines(&light->emitter, &light->views) : NULL,
                                                  first ? first_define : NULL, tiles ? "#define TILES\n" : NULL,
                                                  links ? "#define LINKS\n" : NULL}};
    return program_use(&frame->renderer->programs, &desc, program);
}

void set_world(struct frame *frame, GLuint program) {
    const float *world = frame->scene->world_color;
    const bool transparent = frame->settings->flags & PNB_SETTINGS_FILM_TRANSPARENT;
    const float value[4] = {world[0], world[1], world[2], transparent ? 0.0f : 1.0f};
    program_set_vec4(frame->gl, program, "world", value);
}

pnb_result pass_shading(struct frame *frame, const struct frame_light *light, bool first, bool tiles) {
    struct renderer *renderer = frame->renderer;
    const struct gl *gl = renderer->gl;
    GLuint program;
    pnb_result result = use_program(frame, light, first, tiles, &program);
    if (result != PNB_OK || (result = timer_begin(&renderer->timer, "Shading")) != PNB_OK)
        return result;
    const struct gl_texture *share = light ? if_made(&renderer->light_shadows[light - frame->lights]) : NULL;
    const struct gl_target target = {.colors = {&renderer->combined, if_made(&renderer->shadowed),
                                                if_made(&renderer->unshadowed),
                                                first ? if_made(&renderer->normal) : NULL, share,
                                                if_made(&renderer->caught), if_made(&renderer->uncaught)},
                                     .color_count = 7};
    if ((result = gl_target_bind(gl, renderer->framebuffer, &target)) != PNB_OK)
        return result;
    begin_adding(gl, first && frame->sample == 0, share != NULL);
    bind_gbuffer(renderer, program);
    gl_texture_bind(gl, frame->scene->emissive ? &renderer->gbuffer_emission : &renderer->gbuffer_color, 5);
    program_set_int(gl, program, "gbuffer_emission", 5);
    if (frame->scene->light_linked)
        gl_texture_bind(gl, &renderer->gbuffer_links, 6);
    program_set_int(gl, program, "gbuffer_links", 6);
    program_set_int(gl, program, "light_number", (int)frame->light);
    gl_texture_bind(gl, &renderer->visibility, 3);
    program_set_int(gl, program, "visibility", 3);
    set_world(frame, program);
    if (tiles)
        draw_tiles(frame, program, false);
    else
        draw_screen(renderer);
    timer_end(&renderer->timer, sums_bytes(renderer) + (share ? gl_texture_bytes(share) : 0));
    return gl_check(gl, "shading");
}
