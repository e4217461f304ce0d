/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "passes.h"

/* The irradiance of all lights, per sample. Only what a pass asks for is kept. */
pnb_result ensure_irradiance(struct frame *frame) {
    struct renderer *renderer = frame->renderer;
    const bool lit = frame->scene->light_count > 0;
    const struct {
        struct gl_texture *texture;
        bool wanted;
        GLenum format;
    } parts[] = {{&renderer->irradiance, lit, GL_RGBA32F},
                 {&renderer->unshadowed_irradiance,
                  lit && ((frame->settings->passes & PNB_PASS_SHADOW) || frame->scene->catches_shadows), GL_RGBA32F},
                 {&renderer->drawn, frame->reuses, GL_DEPTH_COMPONENT32F}};
    pnb_result result = PNB_OK;
    for (int i = 0; i < 3 && result == PNB_OK; i++) {
        if (parts[i].wanted)
            result = gl_texture_ensure(frame->gl, parts[i].texture, parts[i].format, frame->width, frame->height, 0, 1);
        else
            gl_texture_free(frame->gl, parts[i].texture);
    }
    return result;
}

void test_drawn(struct frame *frame) {
    test_depth(frame, frame->reuses);
}

void test_depth(struct frame *frame, bool on) {
    const struct gl *gl = frame->gl;
    if (!on) {
        gl->Disable(GL_DEPTH_TEST);
        return;
    }
    gl->Enable(GL_DEPTH_TEST);
    gl->DepthFunc(GL_LESS); /* both vertex shaders draw at a depth of one half */
    gl->DepthMask(GL_FALSE);
}

/* The first light replaces what the sample before left; with a light's own share, which is a sum, it is added to
 * nothing: blending is switched for all targets at once. */
static void begin_light(struct frame *frame, bool first, bool with_share) {
    const struct gl *gl = frame->gl;
    const float nothing[4] = {0, 0, 0, 0};
    if (first && !with_share) {
        gl->Disable(GL_BLEND);
        return;
    }
    for (int i = 0; i < 2 && first; i++)
        gl->ClearBufferfv(GL_COLOR, i, nothing);
    gl->Enable(GL_BLEND);
    gl->BlendFunc(GL_ONE, GL_ONE);
}

pnb_result pass_irradiance(struct frame *frame, const struct frame_light *light, bool first, enum tiles tiles) {
    struct renderer *renderer = frame->renderer;
    const struct gl *gl = renderer->gl;
    const struct program_desc desc = {
        .vertex = tiles ? "pass_tile.vert" : "pass_screen.vert",
        .fragment = "pass_irradiance.frag",
        .defines = {light_defines(&light->emitter, &light->views), tiles ? "#define TILES\n" : NULL,
                    frame->scene->light_linked ? "#define LINKS\n" : NULL}};
    GLuint program;
    pnb_result result = program_use(&renderer->programs, &desc, &program);
    if (result != PNB_OK || (result = pass_begin(frame, "Irradiance")) != PNB_OK)
        return result;
    const struct gl_texture *share = if_made(&renderer->light_shadows[light - frame->lights]);
    const struct gl_target target = {
        .colors = {&renderer->irradiance, if_made(&renderer->unshadowed_irradiance), share},
        .color_count = 3,
        .depth = if_made(&renderer->drawn)};
    if ((result = gl_target_bind(gl, renderer->framebuffer, &target)) == PNB_OK) {
        begin_light(frame, first, share != NULL);
        test_drawn(frame);
        bind_gbuffer(renderer, program);
        bind_steady(frame, program);
        gl_texture_bind(gl, &renderer->visibility, 3);
        program_set_int(gl, program, "visibility", 3);
        if (frame->scene->light_linked)
            gl_texture_bind(gl, &renderer->gbuffer_links, 4);
        program_set_int(gl, program, "gbuffer_links", 4);
        program_set_int(gl, program, "light_number", (int)frame->light);
        program_set_vec3(gl, program, "shadow_color", light->source->shadow_color);
        draw_over(frame, program, tiles, false);
        result = gl_check(gl, "irradiance");
    }
    pass_end(frame,
              gl_texture_bytes(&renderer->irradiance) + gl_texture_bytes(&renderer->unshadowed_irradiance));
    return result;
}
