/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "renderer.h"
#include "../memory.h"
#include "../passes/passes.h"

#include <stdio.h>

/* Shadow maps kept at once. More lights are handled in groups, each of which draws the G-buffer again. */
#define SHADOW_MAP_BUDGET (512ull << 20)

pnb_result renderer_create(const struct gl *gl, struct renderer **out) {
    struct renderer *renderer = memory_array(1, sizeof *renderer);
    if (!renderer)
        return PNB_ERROR_OUT_OF_MEMORY;
    renderer->gl = gl;
    timer_init(&renderer->timer, gl);
    program_cache_init(&renderer->programs, gl);
    gl->GenFramebuffers(1, &renderer->framebuffer);
    gl->GenVertexArrays(1, &renderer->empty_vertex_array);
    gl->GenVertexArrays(1, &renderer->tile_vertex_array);
    GLuint *const buffers[] = {&renderer->camera_buffer, &renderer->light_buffer, &renderer->tap_buffer,
                               &renderer->range_buffer,  &renderer->tile_buffer,  &renderer->tile_visibility_buffer,
                               &renderer->cursor_buffer};
    for (size_t i = 0; i < sizeof buffers / sizeof *buffers; i++)
        gl->GenBuffers(1, buffers[i]);
    kept_init(&renderer->kept, gl);
    pnb_result result = gpu_scene_create(gl, &renderer->scene);
    if (result == PNB_OK)
        result = gl_check(gl, "renderer");
    if (result != PNB_OK) {
        renderer_destroy(&renderer);
        return result;
    }
    *out = renderer;
    return PNB_OK;
}

void renderer_destroy(struct renderer **out) {
    struct renderer *renderer = *out;
    if (!renderer)
        return;
    const struct gl *gl = renderer->gl;
    gpu_scene_destroy(&renderer->scene);
    kept_free(&renderer->kept, gl);
    timer_free(&renderer->timer);
    program_cache_free(&renderer->programs);
    gl->DeleteFramebuffers(1, &renderer->framebuffer);
    gl->DeleteVertexArrays(1, &renderer->empty_vertex_array);
    gl->DeleteVertexArrays(1, &renderer->tile_vertex_array);
    const GLuint buffers[] = {renderer->camera_buffer, renderer->light_buffer, renderer->tap_buffer,
                              renderer->range_buffer,  renderer->tile_buffer,  renderer->tile_visibility_buffer,
                              renderer->cursor_buffer};
    gl->DeleteBuffers(sizeof buffers / sizeof *buffers, buffers);
    gl_buffer_free(gl, &renderer->pixel_list);
    struct gl_texture *const textures[] = {&renderer->gbuffer_depth,
                                           &renderer->gbuffer_normal,
                                           &renderer->gbuffer_color,
                                           &renderer->gbuffer_z,
                                           &renderer->visibility,
                                           &renderer->coarse_visibility,
                                           &renderer->combined,
                                           &renderer->shadowed,
                                           &renderer->unshadowed,
                                           &renderer->normal,
                                           &renderer->gbuffer_emission,
                                           &renderer->caught,
                                           &renderer->uncaught,
                                           &renderer->key_depth,
                                           &renderer->key_normal,
                                           &renderer->drawn,
                                           &renderer->irradiance,
                                           &renderer->unshadowed_irradiance,
                                           &renderer->gbuffer_links};
    for (size_t i = 0; i < sizeof textures / sizeof *textures; i++)
        gl_texture_free(gl, textures[i]);
    for (int i = 0; i < MAX_LIGHTS; i++)
        gl_texture_free(gl, &renderer->light_shadows[i]);
    memory_free(renderer);
    *out = NULL;
}

void draw_screen(struct renderer *renderer) {
    renderer->gl->BindVertexArray(renderer->empty_vertex_array);
    renderer->gl->DrawArrays(GL_TRIANGLES, 0, 3);
}

/* ---- One frame ---- */

/* The whole first sample, crop or not: light views must not depend on the crop. */
static pnb_result find_receivers(struct frame *frame) {
    camera_block_init(&frame->camera, &frame->scene->camera, frame->settings, 0);
    reuse_light_mean(frame);
    camera_block_upload(frame);
    if (kept_take_gbuffer(frame))
        return PNB_OK;
    pnb_result result = pass_gbuffer(frame, true);
    if (result == PNB_OK)
        result = pass_tiles(frame);
    return result == PNB_OK ? read_receivers(frame) : result;
}

static void choose_techniques(struct frame *frame) {
    for (uint32_t i = 0; i < frame->scene->light_count; i++) {
        struct frame_light *light = &frame->lights[i];
        light->source = &frame->scene->lights[i];
        light->technique = settings_technique(frame->settings, light->source);
        light->parameters = frame->settings->parameters[technique_index(light->technique)];
        light->map_size = (int)settings_map_size(frame->settings, light->source);
    }
}

static void fit_lights(struct frame *frame) {
    for (uint32_t i = 0; i < frame->scene->light_count; i++) {
        struct frame_light *light = &frame->lights[i];
        emitter_init(&light->emitter, light->source, frame->origin);
        glm_vec3_copy(frame->origin, light->views_origin);
        light_views_fit(&light->views, &light->emitter, frame->receivers.tiles, frame->receivers.tile_count,
                        frame->casters, frame->caster_count, light->map_size);
        if (!light->emitter.casts_shadow)
            light->views.count = 0;
    }
}

static bool uses_tiles(const struct frame_light *light) {
    return technique_skips(light->technique, light->parameters);
}

static bool subsamples(const struct frame_light *light) {
    return technique_subsamples(light->technique, light->parameters);
}

static bool some_light(const struct frame *frame, bool (*has)(const struct frame_light *light)) {
    for (uint32_t i = 0; i < frame->scene->light_count; i++)
        if (has(&frame->lights[i]))
            return true;
    return false;
}

static uint64_t light_bytes(const struct frame_light *light) {
    const uint64_t side = (uint64_t)light->map_size;
    return side * side * (4 * 2 + light->technique->prefilter_bytes) * (uint64_t)light->views.count;
}

static enum translucency map_translucency(const struct frame *frame, const struct frame_light *light) {
    if (light->technique->needs & NEEDS_ALL_CASTERS)
        return TRANSLUCENCY_ANY;
    return frame->settings->samples > 1 ? TRANSLUCENCY_STOCHASTIC : TRANSLUCENCY_CUT;
}

static pnb_result draw_shadow_maps(struct frame *frame, struct frame_light *light) {
    frame->light = (uint32_t)(light - frame->lights);
    if (light->views.count == 0 || (light->technique->draw && !wants_diagnosis(frame)))
        return PNB_OK;
    if (kept_take_maps(frame, light))
        return PNB_OK;
    pnb_result result =
        pass_shadow_map(frame, &light->views, light->map_size, map_translucency(frame, light), &light->shadow_map);
    if (result == PNB_OK && ((light->technique->needs & NEEDS_MIN_MAX) || wants_blockers(frame)))
        result = pass_min_max(frame, &light->shadow_map, &light->min_max);
    if (result == PNB_OK && uses_tiles(light)) {
        light_block_upload(frame->renderer, &light->emitter, &light->views);
        result = pass_planes(frame, light);
    }
    if (result == PNB_OK && light->technique->prefilter)
        result = light->technique->prefilter(frame, light);
    return result;
}

/* Progress: light by light of every sample. */
static pnb_result report(struct frame *frame, uint32_t light) {
    struct pnb_job *job = frame->job;
    const uint32_t lights = frame->scene->light_count ? frame->scene->light_count : 1;
    const uint32_t samples = frame->settings->samples;
    char text[96];
    snprintf(text, sizeof text, "Sample %u/%u, light %u/%u", frame->sample + 1, samples, light + 1, lights);
    job_set_progress(job, (float)(frame->sample * lights + light) / (float)(samples * lights), frame->sample, text);
    return check_cancel(frame); /* which waits, so that progress is true */
}

/* first: of the sample. */
static pnb_result draw_light(struct frame *frame, uint32_t index, bool first) {
    struct renderer *renderer = frame->renderer;
    const struct frame_light *light = &frame->lights[index];
    frame->light = index;
    pnb_result result = report(frame, index);
    if (result != PNB_OK)
        return result;
    /* A technique that adds up many samples needs single precision; one that writes its result does not. */
    const GLenum format = light->technique->draw ? GL_RGBA32F : GL_RGBA16F;
    result = gl_texture_ensure(frame->gl, &renderer->visibility, format, frame->width, frame->height, 0, 1);
    if (result != PNB_OK)
        return result;
    light_block_upload(renderer, &light->emitter, &light->views);
    const enum tiles tiles = !light->planes.id ? TILES_NONE : reuse_is_key(frame) ? TILES_CLASSIFIED : TILES_UNDECIDED;
    if (tiles == TILES_CLASSIFIED)
        result = pass_classify(frame, light);
    if (result == PNB_OK && light->technique->draw)
        result = light->technique->draw(frame, light);
    else if (result == PNB_OK)
        result = pass_visibility(frame, light, tiles);
    if (result != PNB_OK)
        return result;
    light_block_upload(renderer, &light->emitter, &light->views);
    return pass_irradiance(frame, light, first, tiles);
}

/* Shows what a progressive job has so far; after powers of two, each of which has half the noise of the one before. */
static pnb_result show_samples(struct frame *frame) {
    const uint32_t done = frame->sums_samples;
    if (!(frame->settings->flags & PNB_SETTINGS_PROGRESSIVE) || done >= frame->settings->samples || (done & (done - 1)))
        return PNB_OK;
    pnb_result result = pass_resolve(frame);
    return result == PNB_OK ? job_publish(frame->job, done) : result;
}

/* Whether each sample has its own part of what is translucent in the light's maps. */
static bool has_sample_maps(const struct frame *frame, const struct frame_light *light) {
    return frame->scene->translucent && map_translucency(frame, light) == TRANSLUCENCY_STOCHASTIC;
}

static pnb_result draw_sample_maps(struct frame *frame, uint32_t first, uint32_t last) {
    pnb_result result = PNB_OK;
    for (uint32_t i = first; i < last && result == PNB_OK && frame->sample > 0; i++)
        if (has_sample_maps(frame, &frame->lights[i]))
            result = draw_shadow_maps(frame, &frame->lights[i]);
    return result;
}

/* Of the first sample, as depth is. */
static pnb_result diagnose(struct frame *frame, uint32_t first, uint32_t last) {
    pnb_result result = PNB_OK;
    for (uint32_t i = first; i < last && result == PNB_OK && frame->sample == 0 && wants_diagnosis(frame); i++)
        result = pass_diagnosis(frame, &frame->lights[i]);
    return result;
}

/* The G-buffer of the sample and what follows from it alone. */
static pnb_result begin_sample(struct frame *frame, bool drawn_already) {
    const bool key = reuse_is_key(frame);
    pnb_result result = PNB_OK;
    reuse_keep_key(frame);
    camera_block_init(&frame->camera, &frame->scene->camera, frame->settings, frame->sample);
    reuse_light_mean(frame);
    camera_block_upload(frame);
    if (!drawn_already)
        result = pass_gbuffer(frame, false);
    if (result == PNB_OK && !drawn_already && key && some_light(frame, uses_tiles))
        result = pass_tiles(frame);
    if (key)
        glm_vec4_copy(frame->camera.window, frame->key_window);
    if (result == PNB_OK)
        result = key ? reuse_set_drawn(frame, true) : pass_reuse(frame);
    return result;
}

/* Every sample of the lights first .. last - 1, whose maps are in memory. */
static pnb_result draw_samples(struct frame *frame, uint32_t first, uint32_t last) {
    pnb_result result = PNB_OK;
    for (frame->sample = 0; frame->sample < frame->settings->samples && result == PNB_OK; frame->sample++) {
        frame->sums_samples = frame->sample + 1;
        result = begin_sample(frame, first == 0 && frame->sample == 0); /* find_receivers has drawn the first */
        if (result == PNB_OK && first == 0 && frame->sample == 0)
            result = pass_resolve_first_sample(frame);
        if (result == PNB_OK)
            result = draw_sample_maps(frame, first, last);
        if (result == PNB_OK)
            result = diagnose(frame, first, last);
        for (uint32_t i = first; i < last && result == PNB_OK; i++)
            result = draw_light(frame, i, i == first);
        if (result == PNB_OK && reuse_is_key(frame))
            result = reuse_set_drawn(frame, false);
        if (result == PNB_OK)
            result = pass_shading(frame, first == 0);
        if (result == PNB_OK && first == 0 && last == frame->scene->light_count)
            result = show_samples(frame);
    }
    return result;
}

/* Not where every light's share is wanted, each of which would have to be kept, nor where a sample has maps of its own
 * or instances have lights of their own, nor for a technique that draws by itself, which is the truth the others are
 * measured by. */
static bool can_reuse(const struct frame *frame) {
    const struct settings *settings = frame->settings;
    bool steady = true;
    for (uint32_t i = 0; i < frame->scene->light_count; i++)
        steady = steady && !frame->lights[i].technique->draw && !has_sample_maps(frame, &frame->lights[i]);
    return settings->samples > 1 && frame->scene->light_count > 0 && steady &&
           !(settings->passes & PNB_PASS_LIGHT_SHADOWS) && !frame->scene->light_linked;
}

static pnb_result draw_frame(struct frame *frame) {
    pnb_result result;
    choose_techniques(frame);
    frame->reuses = can_reuse(frame);
    /* Memory first: an image that is too large must not be drawn for a minute before it fails. */
    if ((result = pass_create_images(frame)) != PNB_OK || (result = pass_prepare_sums(frame)) != PNB_OK ||
        (result = ensure_subsampling(frame, some_light(frame, subsamples))) != PNB_OK ||
        (result = gpu_scene_update(frame->renderer->scene, frame)) != PNB_OK ||
        (result = find_receivers(frame)) != PNB_OK)
        return result;
    fit_lights(frame);
    const uint32_t count = frame->scene->light_count;
    for (uint32_t first = 0; (first < count || first == 0) && result == PNB_OK;) {
        uint32_t last = first;
        frame->sample = 0;
        for (uint64_t bytes = 0; last < count && result == PNB_OK; last++) {
            bytes += light_bytes(&frame->lights[last]);
            if (bytes > SHADOW_MAP_BUDGET && last > first)
                break;
            result = draw_shadow_maps(frame, &frame->lights[last]);
        }
        if (result == PNB_OK)
            result = draw_samples(frame, first, last);
        for (uint32_t i = first; i < last; i++)
            if (result != PNB_OK || !kept_give_maps(frame, &frame->lights[i]))
                light_maps_free(frame->gl, &frame->lights[i]);
        first = last > first ? last : first + 1;
    }
    return result == PNB_OK ? pass_resolve(frame) : result;
}

pnb_result renderer_run(struct renderer *renderer, struct pnb_job *job) {
    struct frame *frame = memory_array(1, sizeof *frame);
    if (!frame)
        return PNB_ERROR_OUT_OF_MEMORY;
    frame->gl = renderer->gl;
    frame->renderer = renderer;
    frame->job = job;
    frame->scene = job->scene;
    frame->settings = &job->settings;
    frame->width = (int)job->settings.crop[2];
    frame->height = (int)job->settings.crop[3];
    glm_vec3_copy((float *)&job->scene->camera.matrix[12], frame->origin);
    kept_begin(frame);
    pnb_result result = draw_frame(frame);
    for (uint32_t i = 0; i < MAX_LIGHTS; i++)
        light_maps_free(frame->gl, &frame->lights[i]);
    kept_end(frame, result == PNB_OK);
    if (frame->binds_lists) {
        const pnb_result forgotten = fragment_lists_forget(frame);
        result = result == PNB_OK ? forgotten : result;
    }
    pnb_result timing = timer_collect(&renderer->timer, job);
    receivers_free(&frame->receivers);
    memory_free(frame->casters);
    memory_free(frame);
    return result != PNB_OK ? result : timing;
}
