/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "kept.h"
#include "../passes/passes.h"
#include "../scene/content_key.h"

#include <stddef.h>

/* Of the maps of all lights; others are drawn for every picture. */
#define MOST_MAP_BYTES (128ull << 20)

/* A look at how shadows come about needs more of the maps than a technique may. */
static bool is_quick(const struct frame *frame) {
    return (frame->settings->flags & PNB_SETTINGS_QUICK) && frame->settings->samples == 1 && !wants_diagnosis(frame);
}

/* ---- Keys ---- */

static void add_texture(struct content_key *key, const pnb_texture *texture) {
    const struct content_key none = {{0, 0}};
    content_key_add(key, texture ? &texture->content : &none, sizeof none);
}

/* Of instances and materials: all that G-buffer and shadow maps show, wherever they are seen from. */
static struct content_key surfaces_key(const struct scene *scene) {
    struct content_key key = {{0, 0}};
    content_key_add(&key, scene->slots, scene->slot_count * sizeof *scene->slots);
    for (uint32_t i = 0; i < scene->instance_count; i++) {
        const struct scene_instance *instance = &scene->instances[i];
        const uint64_t links[2] = {instance->unlit_by, instance->unshadowed_by};
        const uint32_t numbers[3] = {instance->flags, instance->first_slot, instance->slot_count};
        content_key_add(&key, &instance->mesh->content, sizeof instance->mesh->content);
        content_key_add(&key, instance->matrix, sizeof instance->matrix);
        content_key_add(&key, links, sizeof links);
        content_key_add(&key, numbers, sizeof numbers);
    }
    for (uint32_t i = 0; i < scene->material_count; i++) {
        const struct scene_material *material = &scene->materials[i];
        content_key_add(&key, material, offsetof(struct scene_material, base_color_texture));
        add_texture(&key, material->base_color_texture);
        add_texture(&key, material->alpha_texture);
        add_texture(&key, material->emission_texture);
    }
    return key;
}

static struct content_key gbuffer_key(const struct frame *frame) {
    const struct scene_camera *camera = &frame->scene->camera;
    const float clip[2] = {camera->clip_start, camera->clip_end};
    struct content_key key = frame->surfaces;
    content_key_add(&key, &frame->camera, sizeof frame->camera);
    content_key_add(&key, frame->origin, sizeof frame->origin);
    content_key_add(&key, clip, sizeof clip);
    return key;
}

/* What decides which maps there are. */
static struct content_key kind_key(const struct frame_light *light) {
    const int numbers[2] = {technique_index(light->technique), light->map_size};
    struct content_key key = {{0, 0}};
    content_key_add(&key, numbers, sizeof numbers);
    content_key_add(&key, light->parameters, MAX_PARAMETERS * sizeof *light->parameters);
    return key;
}

/* Without the light's colours, which no map shows. */
static struct content_key maps_key(const struct frame *frame, const struct frame_light *light) {
    const struct scene_light *source = light->source;
    const struct content_key kind = kind_key(light);
    const int number = (int)(light - frame->lights);
    struct content_key key = frame->surfaces;
    content_key_add(&key, &kind, sizeof kind);
    content_key_add(&key, &number, sizeof number);
    content_key_add(&key, &source->type, offsetof(struct scene_light, emission) - offsetof(struct scene_light, type));
    content_key_add(&key, &source->size, offsetof(struct scene_light, technique) - offsetof(struct scene_light, size));
    return key;
}

/* ---- The G-buffer ---- */

static void swap_gbuffer(struct renderer *renderer) {
    struct kept *kept = &renderer->kept;
    struct gl_texture *const used[] = {&renderer->gbuffer_depth,    &renderer->gbuffer_normal, &renderer->gbuffer_color,
                                       &renderer->gbuffer_emission, &renderer->gbuffer_links,  &renderer->gbuffer_z};
    for (size_t i = 0; i < sizeof used / sizeof *used; i++)
        gl_texture_swap(used[i], &kept->gbuffer[i]);
    const GLuint tiles = renderer->tile_buffer;
    renderer->tile_buffer = kept->tile_buffer;
    kept->tile_buffer = tiles;
}

static void move_receivers(struct receivers *to, struct receivers *from) {
    receivers_free(to);
    *to = *from;
    *from = (struct receivers){0};
}

bool kept_take_gbuffer(struct frame *frame) {
    struct kept *kept = &frame->renderer->kept;
    if (!is_quick(frame))
        return false;
    const struct content_key key = gbuffer_key(frame);
    const bool same = content_key_equal(&kept->gbuffer_key, &key);
    kept->gbuffer_key = (struct content_key){{0, 0}}; /* until this job ends well */
    if (same)
        move_receivers(&frame->receivers, &kept->receivers);
    return same;
}

/* ---- Maps ---- */

static void drop_maps(struct kept *kept, const struct gl *gl, uint32_t light) {
    struct kept_light *old = &kept->lights[light];
    kept->map_bytes -= light_maps_bytes(&old->light);
    light_maps_free(gl, &old->light);
    *old = (struct kept_light){0};
}

/* Maps that no longer serve are drawn over: memory for new ones would be new to the processor, page by page. */
static void reuse_textures(struct kept *kept, const struct gl *gl, struct frame_light *light, uint32_t index) {
    struct kept_light *old = &kept->lights[index];
    const struct content_key kind = kind_key(light);
    if (content_key_equal(&old->kind, &kind)) {
        kept->map_bytes -= light_maps_bytes(&old->light);
        light_maps_move(light, &old->light);
        fragment_lists_free(gl, &light->lists);
    }
    drop_maps(kept, gl, index);
}

bool kept_take_maps(struct frame *frame, struct frame_light *light) {
    struct kept *kept = &frame->renderer->kept;
    const uint32_t index = (uint32_t)(light - frame->lights);
    struct kept_light *old = &kept->lights[index];
    if (!is_quick(frame) || !old->light.shadow_map.id)
        return false;
    const struct content_key key = maps_key(frame, light);
    const bool same = content_key_equal(&old->key, &key);
    struct light_views views = light->views;
    if (light->emitter.type == PNB_LIGHT_SUN)
        light_views_move(&views, frame->origin, old->light.views_origin);
    if (!same || !light_views_cover(&old->light.views, &views, light->map_size)) {
        if (same)
            light_views_loosen(&light->views);
        reuse_textures(kept, frame->gl, light, index);
        return false;
    }
    kept->map_bytes -= light_maps_bytes(&old->light);
    light_views_take_maps(&views, &old->light.views);
    light->views = views;
    glm_vec3_copy(old->light.views_origin, light->views_origin);
    light_maps_move(light, &old->light);
    return true;
}

bool kept_give_maps(struct frame *frame, struct frame_light *light) {
    struct kept *kept = &frame->renderer->kept;
    const uint32_t index = (uint32_t)(light - frame->lights);
    if (!is_quick(frame))
        return false;
    drop_maps(kept, frame->gl, index); /* even if this picture needs none: it may be long until one does again */
    if (!light->shadow_map.id || kept->map_bytes + light_maps_bytes(light) > MOST_MAP_BYTES)
        return false;
    struct kept_light *now = &kept->lights[index];
    now->key = maps_key(frame, light);
    now->kind = kind_key(light);
    now->light.views = light->views;
    glm_vec3_copy(light->views_origin, now->light.views_origin);
    light_maps_move(&now->light, light);
    kept->map_bytes += light_maps_bytes(&now->light);
    return true;
}

/* ---- Jobs ---- */

void kept_init(struct kept *kept, const struct gl *gl) {
    *kept = (struct kept){0};
    gl->GenBuffers(1, &kept->tile_buffer);
}

static void drop_all(struct kept *kept, const struct gl *gl) {
    for (uint32_t i = 0; i < MAX_LIGHTS; i++)
        drop_maps(kept, gl, i);
    for (size_t i = 0; i < sizeof kept->gbuffer / sizeof *kept->gbuffer; i++)
        gl_texture_free(gl, &kept->gbuffer[i]);
    receivers_free(&kept->receivers);
    kept->gbuffer_key = (struct content_key){{0, 0}};
}

void kept_free(struct kept *kept, const struct gl *gl) {
    drop_all(kept, gl);
    gl->DeleteBuffers(1, &kept->tile_buffer);
}

void kept_begin(struct frame *frame) {
    if (is_quick(frame)) {
        frame->surfaces = surfaces_key(frame->scene);
        swap_gbuffer(frame->renderer);
    } else if (!(frame->settings->flags & PNB_SETTINGS_PROGRESSIVE)) {
        drop_all(&frame->renderer->kept, frame->gl);
    }
}

void kept_end(struct frame *frame, bool complete) {
    struct kept *kept = &frame->renderer->kept;
    if (!is_quick(frame))
        return;
    swap_gbuffer(frame->renderer);
    if (!complete) {
        drop_all(kept, frame->gl);
        return;
    }
    kept->gbuffer_key = gbuffer_key(frame);
    move_receivers(&kept->receivers, &frame->receivers);
    for (uint32_t i = frame->scene->light_count; i < MAX_LIGHTS; i++)
        drop_maps(kept, frame->gl, i);
}
