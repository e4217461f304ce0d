/* SPDX-License-Identifier: GPL-3.0-or-later
 * A small scene that uses every part of the description. */
#ifndef EXAMPLE_SCENE_H
#define EXAMPLE_SCENE_H

#include <penumbra.h>

#include <string.h>

static const float example_identity[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

struct example {
    pnb_mesh *pyramid, *plane;
    pnb_texture *colors, *mask;
    pnb_instance instances[4];
    pnb_material materials[3];
    uint32_t slots[4];
    pnb_light lights[4];
    pnb_value values[2];
    pnb_scene scene;
    pnb_settings settings;
};

static inline pnb_result example_meshes(struct example *example) {
    static const float positions[5][3] = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}, {0, 0, 2}};
    static const float uvs[5][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0.5f, 0.5f}};
    static const uint32_t triangles[6][3] = {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}, {2, 1, 0}, {3, 2, 0}};
    static const int32_t materials[6] = {1, 0, 1, 0, 2, 2};
    pnb_mesh_desc desc = PNB_INIT(pnb_mesh_desc);
    desc.name = "Pyramid";
    desc.vertex_count = desc.corner_count = 5;
    desc.triangle_count = 6;
    desc.positions.data = positions;
    desc.corner_uvs.data = uvs;
    desc.triangles.data = triangles;
    desc.polygon_materials.data = materials;
    pnb_result result = pnb_mesh_create(&desc, &example->pyramid);
    if (result == PNB_OK) {
        desc = (pnb_mesh_desc)PNB_INIT(pnb_mesh_desc);
        desc.name = "Plane";
        desc.vertex_count = desc.corner_count = 4;
        desc.triangle_count = 3; /* the last one has no area, for the sake of a warning */
        desc.positions.data = positions;
        desc.triangles.data = (const uint32_t[3][3]){{0, 1, 2}, {0, 2, 3}, {0, 2, 2}};
        result = pnb_mesh_create(&desc, &example->plane);
    }
    return result;
}

static inline pnb_result example_textures(struct example *example) {
    static const float colors[4][4] = {{1, 0, 0, 1}, {0, 1, 0, 0.5f}, {0, 0, 1, 0}, {0.5f, 0.25f, 0.75f, 1}};
    pnb_texture_desc desc = PNB_INIT(pnb_texture_desc);
    desc.name = "Colors";
    desc.width = desc.height = 2;
    desc.channels = 4;
    desc.is_srgb = 1;
    desc.pixels.data = colors;
    pnb_result result = pnb_texture_create(&desc, &example->colors);
    if (result == PNB_OK) {
        desc.name = "Mask";
        desc.width = 3;
        desc.height = 1;
        desc.channels = 1;
        desc.is_srgb = 0;
        result = pnb_texture_create(&desc, &example->mask);
    }
    return result;
}

static inline void example_instances(struct example *example) {
    static const char *const names[] = {"Floor", "Left", NULL, ""};
    for (int i = 0; i < 4; i++) {
        pnb_instance *instance = &example->instances[i];
        *instance = (pnb_instance)PNB_INIT(pnb_instance);
        instance->flags = (uint32_t)i % 3;
        instance->mesh = i == 0 ? example->plane : example->pyramid;
        instance->name = names[i];
        instance->first_slot = i == 0 ? 0 : 1;
        instance->slot_count = i == 0 ? 1 : 3;
        memcpy(instance->matrix, example_identity, sizeof instance->matrix);
        instance->matrix[12] = (float)i;
    }
}

static inline void example_materials(struct example *example) {
    for (int i = 0; i < 3; i++) {
        pnb_material *material = &example->materials[i];
        *material = (pnb_material)PNB_INIT(pnb_material);
        material->base_color[i] = 0.5f;
        material->transparency = 0.125f * (float)i;
        material->base_color_texture = i == 1 ? example->colors : NULL;
        material->alpha_texture = i == 2 ? example->mask : i == 1 ? example->colors : NULL;
        material->flags = (uint32_t)i;
        material->emission[i] = 0.25f * (float)i;
        material->shadow_threshold = 0.25f * (float)i;
        material->emission_texture = i == 1 ? example->colors : NULL;
    }
    static const uint32_t slots[4] = {0, 1, 2, 1};
    memcpy(example->slots, slots, sizeof slots);
}

static inline void example_lights(struct example *example) {
    static const char *const names[] = {"Lamp", "Bulb", NULL, "Sun"};
    for (int i = 0; i < 4; i++) {
        pnb_light *light = &example->lights[i];
        *light = (pnb_light)PNB_INIT(pnb_light);
        light->type = (pnb_light_type)i;
        light->shape = PNB_AREA_ELLIPSE;
        light->flags = (uint32_t)i % 2;
        light->name = names[i];
        memcpy(light->matrix, example_identity, sizeof light->matrix);
        light->matrix[14] = 4;
        light->emission[0] = 1 + (float)i;
        light->size[0] = 0.5f;
        light->size[1] = 0.25f;
        light->radius = 0.1f;
        light->angle = 0.01f;
        light->spot_angle = 1.5f;
        light->spot_blend = 0.25f;
        light->technique = i == 1 ? "HARD" : i == 2 ? "" : NULL;
        light->shadow_map_size = 16 * (uint32_t)i;
        light->shadow_color[i % 3] = 0.125f * (float)i;
    }
}

static inline void example_view(struct example *example) {
    static const float window[4] = {-0.36f, 0.36f, -0.2f, 0.25f};
    pnb_camera *camera = &example->scene.camera;
    *camera = (pnb_camera)PNB_INIT(pnb_camera);
    memcpy(camera->matrix, example_identity, sizeof camera->matrix);
    camera->matrix[14] = 10;
    memcpy(camera->window, window, sizeof window);
    camera->clip_start = 0.5f;
    camera->clip_end = 50;
    example->scene.world_color[2] = 0.0625f;
}

static inline void example_settings(struct example *example) {
    pnb_settings *settings = &example->settings;
    *settings = (pnb_settings)PNB_INIT(pnb_settings);
    example->values[0] = (pnb_value){"filter_samples", 16};
    example->values[1] = (pnb_value){"light_size_scale", 0.1};
    settings->flags = PNB_SETTINGS_FILM_TRANSPARENT;
    settings->technique = "PCSS";
    settings->values = example->values;
    settings->value_count = 2;
    settings->width = 64;
    settings->height = 36;
    settings->crop[2] = 32;
    settings->crop[3] = 18;
    settings->samples = 4;
    settings->filter_width = 1.25f;
    settings->shadow_map_size = 256;
    settings->light_samples = 8;
    settings->passes = PNB_PASS_COMBINED | PNB_PASS_SHADOW;
}

static inline void example_destroy(struct example *example) {
    pnb_mesh_destroy(&example->pyramid);
    pnb_mesh_destroy(&example->plane);
    pnb_texture_destroy(&example->colors);
    pnb_texture_destroy(&example->mask);
}

/* On an error nothing is left to destroy. */
static inline pnb_result example_create(struct example *example) {
    memset(example, 0, sizeof *example);
    pnb_result result = example_meshes(example);
    if (result == PNB_OK) {
        result = example_textures(example);
    }
    if (result != PNB_OK) {
        example_destroy(example);
        return result;
    }
    pnb_scene *scene = &example->scene;
    *scene = (pnb_scene)PNB_INIT(pnb_scene);
    scene->instances = example->instances;
    scene->materials = example->materials;
    scene->slots = example->slots;
    scene->lights = example->lights;
    scene->instance_count = scene->slot_count = scene->light_count = 4;
    scene->material_count = 3;
    example_instances(example);
    example_materials(example);
    example_lights(example);
    example_view(example);
    example_settings(example);
    return PNB_OK;
}

#endif
