/* SPDX-License-Identifier: GPL-3.0-or-later
 * Anti-aliasing samples of one surface see much the same light. Every KEY_SAMPLES-th one, the key, is lit at every
 * pixel; those after it only where they see something else, as the depth buffer `drawn` says: 1 where the passes of a
 * light draw, 0 where the key's irradiance stays. What was drawn anew is no longer the key's, so a pixel stays drawn
 * until the next key. */
#include "passes.h"

#define KEY_SAMPLES 4

uint32_t reuse_key_count(const struct frame *frame) {
    const uint32_t samples = frame->settings->samples;
    return frame->reuses ? (samples + KEY_SAMPLES - 1) / KEY_SAMPLES : samples;
}

bool reuse_is_key(const struct frame *frame) {
    return !frame->reuses || frame->sample % KEY_SAMPLES == 0;
}

void reuse_light_mean(struct frame *frame) {
    const struct settings *settings = frame->settings;
    if (!frame->reuses || !reuse_is_key(frame))
        return;
    float mean[2] = {0, 0}, own[2] = {0, 0}, count = 0;
    for (uint32_t i = frame->sample; i < frame->sample + KEY_SAMPLES && i < settings->samples; i++, count++) {
        float offset[2];
        pixel_sample(i, settings->samples, settings->filter_width, offset);
        for (int axis = 0; axis < 2; axis++) {
            mean[axis] += offset[axis];
            own[axis] = i == frame->sample ? offset[axis] : own[axis];
        }
    }
    struct camera_block *camera = &frame->camera;
    for (int axis = 0; axis < 2; axis++)
        camera->lit[axis] = (mean[axis] / count - own[axis]) * camera->window[2 + axis] / camera->image[axis];
    camera->lit[2] = 1.0f;
}

void reuse_keep_key(struct frame *frame) {
    struct renderer *renderer = frame->renderer;
    if (reuse_is_key(frame) || frame->sample % KEY_SAMPLES != 1)
        return;
    gl_texture_swap(&renderer->gbuffer_depth, &renderer->key_depth);
    gl_texture_swap(&renderer->gbuffer_normal, &renderer->key_normal);
}

pnb_result reuse_set_drawn(struct frame *frame, bool drawn) {
    if (!frame->reuses)
        return PNB_OK;
    const struct gl_target target = {.depth = &frame->renderer->drawn};
    pnb_result result = gl_target_bind(frame->gl, frame->renderer->framebuffer, &target);
    const float depth = drawn ? 1.0f : 0.0f;
    if (result == PNB_OK) {
        frame->gl->DepthMask(GL_TRUE);
        frame->gl->ClearBufferfv(GL_DEPTH, 0, &depth);
    }
    return result;
}

/* What a pixel may cover of one light for its visibility and irradiance to be all but linear within: a texel of its
 * map, a hundredth of its distance, a tenth of the soft edge of its cone; as a width at distance 1. */
static float steady_width(const struct frame_light *light) {
    const struct emitter *emitter = &light->emitter;
    float width = 0.01f;
    for (int view = 0; view < light->views.count; view++)
        width = fminf(width, light->views.views[view].texel);
    if (emitter->type == PNB_LIGHT_SPOT) {
        const float sine = sqrtf(fmaxf(1.0f - emitter->cos_cone * emitter->cos_cone, 1e-6f));
        width = fminf(width, 0.1f * (1.0f - emitter->cos_cone) * emitter->blend / sine);
    }
    return width;
}

/* pass_reuse.frag: widths. A SUN's texels are as wide everywhere, and without a map it is steady. */
static int steady_widths(const struct frame *frame, vec4 widths[MAX_LIGHTS]) {
    int count = 0;
    for (uint32_t i = 0; i < frame->scene->light_count; i++) {
        const struct frame_light *light = &frame->lights[i];
        const bool sun = light->emitter.type == PNB_LIGHT_SUN;
        if (sun && light->views.count == 0)
            continue;
        glm_vec4((float *)light->emitter.position, sun ? -light->views.views[0].texel : steady_width(light),
                 widths[count++]);
    }
    return count;
}

void bind_steady(struct frame *frame, GLuint program) {
    vec4 widths[MAX_LIGHTS];
    const int count = frame->reuses ? steady_widths(frame, widths) : 0;
    program_set_int(frame->gl, program, "width_count", count);
    if (count > 0)
        frame->gl->Uniform4fv(frame->gl->GetUniformLocation(program, "widths"), count, widths[0]);
}

pnb_result pass_reuse(struct frame *frame) {
    struct renderer *renderer = frame->renderer;
    const struct gl *gl = renderer->gl;
    static const struct program_desc desc = {.vertex = "pass_screen.vert", .fragment = "pass_reuse.frag"};
    GLuint program;
    pnb_result result = program_use(&renderer->programs, &desc, &program);
    if (result != PNB_OK || (result = pass_begin(frame, "Reuse")) != PNB_OK)
        return result;
    const struct gl_target target = {.depth = &renderer->drawn};
    if ((result = gl_target_bind(gl, renderer->framebuffer, &target)) == PNB_OK) {
        gl->Enable(GL_DEPTH_TEST);
        gl->DepthFunc(GL_ALWAYS);
        gl->DepthMask(GL_TRUE);
        bind_gbuffer(renderer, program);
        gl_texture_bind(gl, &renderer->key_depth, 3);
        gl_texture_bind(gl, &renderer->key_normal, 4);
        program_set_int(gl, program, "key_depth", 3);
        program_set_int(gl, program, "key_normal", 4);
        program_set_vec4(gl, program, "key_window", frame->key_window);
        bind_steady(frame, program);
        draw_screen(renderer);
        gl->DepthFunc(GL_LESS);
        result = gl_check(gl, "reuse");
    }
    pass_end(frame, gl_texture_bytes(&renderer->drawn) + gl_texture_bytes(&renderer->key_depth) +
                                    gl_texture_bytes(&renderer->key_normal));
    return result;
}
