/* SPDX-License-Identifier: GPL-3.0-or-later
 * Ground truth: the average of hard shadows from N x N points of the emitter. Every other technique is measured
 * against it, and it is measured against a path tracer. */
#include "../passes/passes.h"
#include "technique.h"

#include <math.h>

enum { WEIGHTS };

static const char *const weightings[] = {"IRRADIANCE", "UNIFORM", NULL};

static const struct parameter parameters[] = {
    [WEIGHTS] = {.name = "weights",
                 .label = "Weights",
                 .description =
                     "IRRADIANCE: a point of the light counts as much as it lights the surface, as in nature. "
                     "UNIFORM: all count the same, as in the papers",
                 .unit = "",
                 .type = PNB_ENUM,
                 .maximum = 1,
                 .items = weightings},
    {0}};

/* A point-like emitter at point i of `count` points of `emitter`, and the way its surface faces there (w = 0: all). */
static void emitter_at(const struct emitter *emitter, int i, int count, uint32_t turn, struct emitter *point,
                       vec4 normal) {
    float s[2];
    *point = *emitter;
    glm_vec4_zero(normal);
    if (emitter->type == PNB_LIGHT_AREA) {
        light_point(i, count, emitter->ellipse, turn, s);
        glm_vec3_muladds((float *)emitter->half_u, s[0], point->position);
        glm_vec3_muladds((float *)emitter->half_v, s[1], point->position);
        glm_vec3_zero(point->half_u);
        glm_vec3_zero(point->half_v);
        glm_vec4((float *)emitter->frame[2], 1.0f, normal);
    } else if (emitter->type == PNB_LIGHT_SUN) {
        light_point(i, count, true, turn, s);
        vec3 *frame = point->frame;
        glm_vec3_muladds((float *)emitter->frame[0], s[0] * emitter->tan_half_angle, frame[2]);
        glm_vec3_muladds((float *)emitter->frame[1], s[1] * emitter->tan_half_angle, frame[2]);
        glm_vec3_normalize(frame[2]);
        glm_vec3_crossn(frame[1], frame[2], frame[0]);
        glm_vec3_cross(frame[2], frame[0], frame[1]);
        point->tan_half_angle = 0.0f;
    } else if (emitter->radius > 0.0f) {
        /* A sphere; each receiver counts the side it sees. */
        vec3 direction;
        sphere_point(i, count, turn, direction);
        glm_vec3_muladds((float *)direction, emitter->radius, point->position);
        point->radius = 0.0f;
        point->cone_offset = emitter->radius;
        glm_vec4((float *)direction, 1.0f, normal);
    }
}

/* A caster of few texels is drawn a texel too wide or too narrow, by where it lies among them, and samples of a small
 * light agree in that. Each sample's texels lie elsewhere within half a texel: the plastic number's lattice, which does
 * not follow the order of the points. */
static void shift_texels(struct light_views *views, int i, int map_size) {
    const double steps[2] = {0.754877666246693, 0.569840290998053};
    for (int v = 0; v < views->count; v++)
        for (int axis = 0; axis < 2; axis++) {
            const double turns = i * steps[axis], texel = 1.0 / ((double)views->views[v].rect[axis + 2] * map_size);
            views->views[v].rect[axis] += (float)((turns - floor(turns) - 0.5) * texel);
        }
}

/* What a light sample sees of the casters: the nearest that is opaque, and all that light shines through. */
struct sample_maps {
    struct gl_texture opaque;
    struct fragment_lists translucent;
};

/* Adds one light sample to the visibility sums. */
static pnb_result add_sample(struct frame *frame, const struct frame_light *light, const struct emitter *point,
                             const struct light_views *views, const vec4 normal, const struct sample_maps *maps) {
    struct renderer *renderer = frame->renderer;
    const struct gl *gl = frame->gl;
    const struct program_desc desc = {.vertex = "pass_screen.vert",
                                      .fragment = "pass_reference.frag",
                                      .defines = {light_defines(point, views),
                                                  fragment_defines(frame, &maps->translucent),
                                                  maps->translucent.count > 0 ? "#define TRANSLUCENT\n" : NULL}};
    GLuint program;
    pnb_result result = program_use(&renderer->programs, &desc, &program);
    if (result != PNB_OK)
        return result;
    result = pass_begin(frame, "Visibility");
    const struct gl_target target = {.colors = {&renderer->visibility}, .color_count = 1};
    if (result != PNB_OK || (result = gl_target_bind(gl, renderer->framebuffer, &target)) != PNB_OK)
        return result;
    gl->Disable(GL_DEPTH_TEST);
    gl->Enable(GL_BLEND);
    gl->BlendFunc(GL_ONE, GL_ONE);
    bind_gbuffer(renderer, program);
    if (views->count > 0)
        gl_texture_bind(gl, &maps->opaque, 3);
    if (maps->translucent.count > 0)
        fragment_lists_bind(frame, program, &maps->translucent);
    program_set_int(gl, program, "shadow_map", 3);
    program_set_vec4(gl, program, "emitter_normal", normal);
    program_set_int(gl, program, "uniform_weights", light->parameters[WEIGHTS] > 0.0);
    draw_screen(renderer);
    pass_end(frame, gl_texture_bytes(&renderer->visibility));
    return gl_check(gl, "reference visibility");
}

static pnb_result draw_sample(struct frame *frame, const struct frame_light *light, int i, int count,
                              struct sample_maps *maps) {
    struct emitter point;
    struct light_views views;
    vec4 normal;
    emitter_at(&light->emitter, i, count, frame->sample, &point, normal);
    light_views_fit(&views, &point, frame->receivers.groups, frame->receivers.group_count, frame->casters,
                    frame->caster_count, light->map_size);
    shift_texels(&views, i, light->map_size);
    pnb_result result = PNB_OK;
    const bool shadows = views.count > 0 && point.casts_shadow;
    maps->translucent.count = 0;
    if (shadows)
        result = pass_shadow_map(frame, &views, light->map_size, TRANSLUCENCY_OPAQUE, &maps->opaque);
    if (result == PNB_OK && shadows && frame->scene->translucent)
        result = pass_fragment_lists(frame, &views, &(struct fragment_choice){.casters = CASTERS_TRANSLUCENT},
                                     &maps->opaque, "translucent surfaces", &maps->translucent);
    if (result != PNB_OK)
        return result;
    light_block_upload(frame->renderer, &point, &views);
    return add_sample(frame, light, &point, &views, normal, maps);
}

static pnb_result reference_draw(struct frame *frame, const struct frame_light *light) {
    const struct gl *gl = frame->gl;
    const struct gl_target target = {.colors = {&frame->renderer->visibility}, .color_count = 1};
    pnb_result result = gl_target_bind(gl, frame->renderer->framebuffer, &target);
    const float zero[4] = {0, 0, 0, 0};
    if (result != PNB_OK)
        return result;
    gl->ClearBufferfv(GL_COLOR, 0, zero);
    struct sample_maps maps = {0};
    const int side = (int)frame->settings->light_samples, count = side * side;
    for (int i = 0; i < count && result == PNB_OK; i++) {
        result = draw_sample(frame, light, i, count, &maps);
        if (result == PNB_OK && i % 8 == 7)
            result = check_cancel(frame);
    }
    gl_texture_free(gl, &maps.opaque);
    fragment_lists_free(gl, &maps.translucent);
    return result;
}

const struct technique technique_reference = {
    .id = "REFERENCE",
    .label = "Reference",
    .description = "Ground truth: hard shadows from many points of each light, averaged",
    .paper = "P. Heckbert, M. Herf, Simulating Soft Shadows with Graphics Hardware, 1997",
    .parameters = parameters,
    .draw = reference_draw,
};
