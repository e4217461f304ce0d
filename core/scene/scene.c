/* SPDX-License-Identifier: GPL-3.0-or-later
 * Deep copies of the host's scene in which every index, number and name can be relied on. */
#include "scene.h"
#include "../memory.h"
#include "axes.h"
#include "numbers.h"
#include "scene_parts.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

/* ---- Materials and slots ---- */

static const struct scene_material default_material = {
    .base_color = {0.8f, 0.8f, 0.8f}, .alpha = 1, .clearness = {1, 1, 1}, .uv_matrix = {1, 0, 0, 0, 1, 0}};

/* False: a channel was not usable and became 0. */
static bool color_resolve(const float from[3], float to[3]) {
    bool good = true;
    for (int i = 0; i < 3; i++) {
        bool usable = numbers_usable(&from[i], 1) && from[i] >= 0;
        to[i] = usable ? from[i] : 0;
        good = good && usable;
    }
    return good;
}

/* 1 - share. False: it was not within 0..1 and was clamped, NaN to 0. */
static bool complement_resolve(float share, float *to) {
    bool usable = share >= 0 && share <= 1;
    *to = usable ? 1 - share : share > 1 ? 0.0f : 1.0f;
    return usable;
}

/* A threshold that is the same everywhere decides on the shadow as a whole. Gives whether it was usable. */
static bool threshold_resolve(const pnb_material *from, struct scene_material *to) {
    const float threshold = from->shadow_threshold;
    if (threshold > 0 && threshold <= 1 && from->alpha_texture)
        to->shadow_threshold = threshold;
    else if (threshold > 0 && threshold <= 1)
        to->flags |= to->alpha >= threshold ? PNB_MATERIAL_OPAQUE_SHADOW : PNB_MATERIAL_NO_SHADOW;
    return threshold >= 0 && threshold <= 1;
}

static void material_resolve(const pnb_material *from, uint32_t index, struct messages *messages,
                             struct scene_material *to) {
    *to = default_material;
    to->flags = from->flags;
    bool good = color_resolve(from->base_color, to->base_color);
    good = color_resolve(from->emission, to->emission) && good;
    good = complement_resolve(from->transparency, &to->alpha) && good;
    for (int i = 0; i < 3; i++) {
        good = complement_resolve(from->absorption[i], &to->clearness[i]) && good;
    }
    good = threshold_resolve(from, to) && good;
    if (!good) {
        messages_add(messages, "material %" PRIu32 ": its colour or transparency is out of range and was clamped",
                     index);
    }
    if (!numbers_usable(from->uv_matrix, 6)) {
        messages_add(messages, "material %" PRIu32 ": its uv_matrix is not finite and was left out", index);
    } else if (memcmp(from->uv_matrix, (float[6]){0}, sizeof from->uv_matrix) != 0) {
        memcpy(to->uv_matrix, from->uv_matrix, sizeof to->uv_matrix);
    }
    /* The handle is immutable for the host but counts its users. */
    if (from->base_color_texture) {
        to->base_color_texture = texture_retain((pnb_texture *)from->base_color_texture);
    }
    if (from->alpha_texture) {
        to->alpha_texture = texture_retain((pnb_texture *)from->alpha_texture);
    }
    if (from->emission_texture) {
        to->emission_texture = texture_retain((pnb_texture *)from->emission_texture);
    }
}

/* What the scene's materials are like together. */
static void note_traits(const struct scene_material *material, struct scene *scene) {
    const float *emission = material->emission, *clear = material->clearness;
    scene->emissive = scene->emissive || emission[0] > 0 || emission[1] > 0 || emission[2] > 0;
    if (material_is_translucent(material)) {
        scene->translucent = true;
        scene->colored =
            scene->colored || (material->shadow_threshold == 0 &&
                               (material_is_tinted(material) || clear[0] != clear[1] || clear[1] != clear[2]));
    }
}

static pnb_result copy_materials(const pnb_scene *from, struct messages *messages, struct scene *to) {
    to->materials = memory_array((size_t)from->material_count + 1, sizeof *to->materials);
    if (!to->materials) {
        return PNB_ERROR_OUT_OF_MEMORY;
    }
    for (uint32_t i = 0; i < from->material_count; i++) {
        material_resolve(&from->materials[i], i, messages, &to->materials[i]);
        note_traits(&to->materials[i], to);
    }
    to->materials[from->material_count] = default_material;
    to->material_count = from->material_count + 1;
    return PNB_OK;
}

static pnb_result copy_slots(const pnb_scene *from, struct messages *messages, struct scene *to) {
    to->slots = memory_array((size_t)from->slot_count + 1, sizeof *to->slots);
    if (!to->slots) {
        return PNB_ERROR_OUT_OF_MEMORY;
    }
    for (uint32_t i = 0; i < from->slot_count; i++) {
        uint32_t material = from->slots[i];
        if (material >= from->material_count) {
            messages_add(messages, "slot %" PRIu32 ": material %" PRIu32 " does not exist; the default is used", i,
                         material);
            material = from->material_count;
        }
        to->slots[i] = material;
    }
    to->slots[from->slot_count] = from->material_count;
    to->slot_count = from->slot_count + 1;
    return PNB_OK;
}

/* ---- Instances ---- */

/* Whether the mesh can be computed with where the matrix puts it. */
static bool instance_is_usable(const pnb_instance *instance) {
    const float *matrix = instance->matrix;
    if (!numbers_usable(matrix, 16)) {
        return false;
    }
    const struct pnb_mesh *mesh = instance->mesh;
    for (int row = 0; mesh->vertex_count > 0 && row < 3; row++) {
        double largest = fabs((double)matrix[12 + row]);
        for (int i = 0; i < 3; i++) {
            double extent = fmax(fabs((double)mesh->bounds[0][i]), fabs((double)mesh->bounds[1][i]));
            largest += fabs((double)matrix[4 * i + row]) * extent;
        }
        if (largest > (double)LARGEST_COORDINATE) {
            return false;
        }
    }
    return true;
}

/* Keeps the slots inside the host's; an instance without any gets the slot behind them, the default's. */
static void instance_resolve_slots(const pnb_instance *from, uint32_t slot_count, struct messages *messages,
                                   struct scene_instance *to) {
    uint32_t available = from->first_slot < slot_count ? slot_count - from->first_slot : 0;
    to->first_slot = from->first_slot;
    to->slot_count = from->slot_count < available ? from->slot_count : available;
    if (to->slot_count < from->slot_count) {
        messages_add(messages, "instance '%s': %" PRIu32 " of its %" PRIu32 " material slots do not exist", to->name,
                     from->slot_count - to->slot_count, from->slot_count);
    }
    if (to->slot_count == 0) {
        to->first_slot = slot_count;
        to->slot_count = 1;
    }
}

static pnb_result copy_instance(const pnb_instance *from, uint32_t slot_count, struct messages *messages,
                                struct scene *scene) {
    pnb_mesh *mesh = (pnb_mesh *)from->mesh;
    const char *name = from->name ? from->name : mesh->name;
    if (!instance_is_usable(from)) {
        messages_add(messages, "instance '%s': dropped: its matrix is not finite or leads too far away", name);
        return PNB_OK;
    }
    if (mesh->warning[0]) {
        messages_add(messages, "%s", mesh->warning);
    }
    struct scene_instance *to = &scene->instances[scene->instance_count];
    to->name = memory_string(name, "");
    if (!to->name) {
        return PNB_ERROR_OUT_OF_MEMORY;
    }
    scene->instance_count++;
    to->mesh = mesh_retain(mesh);
    to->flags = from->flags;
    to->unlit_by = from->unlit_by;
    to->unshadowed_by = from->unshadowed_by;
    scene->catches_shadows = scene->catches_shadows || (from->flags & PNB_INSTANCE_SHADOW_CATCHER);
    memcpy(to->matrix, from->matrix, sizeof to->matrix);
    matrix_make_affine(to->matrix);
    instance_resolve_slots(from, slot_count, messages, to);
    return PNB_OK;
}

static pnb_result copy_instances(const pnb_scene *from, struct messages *messages, struct scene *to) {
    to->instances = memory_array(from->instance_count, sizeof *to->instances);
    if (!to->instances) {
        return PNB_ERROR_OUT_OF_MEMORY;
    }
    pnb_result result = PNB_OK;
    for (uint32_t i = 0; result == PNB_OK && i < from->instance_count; i++) {
        result = copy_instance(&from->instances[i], from->slot_count, messages, to);
    }
    return result;
}

/* ---- Lights ---- */

static bool light_name_is_taken(const struct scene *scene, const char *name) {
    for (uint32_t i = 0; i < scene->light_count; i++) {
        if (strcmp(scene->lights[i].name, name) == 0) {
            return true;
        }
    }
    return false;
}

/* A copy of the name, with the first free number behind it if another light of the scene has it: "Lamp.001". */
static char *light_unique_name(const struct scene *scene, const char *name) {
    size_t size = strlen(name) + sizeof ".4294967295";
    char *unique = memory_array(size, 1);
    if (unique) {
        memcpy(unique, name, strlen(name));
        for (uint32_t number = 1; light_name_is_taken(scene, unique); number++) {
            snprintf(unique, size, "%s.%03" PRIu32, name, number);
        }
    }
    return unique;
}

/* Takes a light that is not used out of the links of the instances; those behind it move up. */
static void links_drop_light(struct scene *scene, uint32_t index) {
    const uint64_t below = ((uint64_t)1 << index) - 1;
    for (uint32_t i = 0; i < scene->instance_count; i++) {
        uint64_t *links[] = {&scene->instances[i].unlit_by, &scene->instances[i].unshadowed_by};
        for (int j = 0; j < 2; j++) {
            *links[j] = (*links[j] & below) | ((*links[j] >> 1) & ~below);
        }
    }
}

static void links_finish(struct scene *scene) {
    const uint64_t used = scene->light_count < 64 ? ((uint64_t)1 << scene->light_count) - 1 : UINT64_MAX;
    for (uint32_t i = 0; i < scene->instance_count; i++) {
        scene->light_linked = scene->light_linked || (scene->instances[i].unlit_by & used);
    }
}

static pnb_result copy_lights(const pnb_scene *from, struct messages *messages, struct scene *to) {
    to->lights = memory_array(from->light_count, sizeof *to->lights);
    if (!to->lights) {
        return PNB_ERROR_OUT_OF_MEMORY;
    }
    for (uint32_t i = 0; i < from->light_count; i++) {
        const char *name = from->lights[i].name ? from->lights[i].name : "light";
        struct scene_light *light = &to->lights[to->light_count];
        if (!light_resolve(&from->lights[i], name, messages, light)) {
            links_drop_light(to, to->light_count);
            continue;
        }
        const char *technique = from->lights[i].technique;
        light->name = light_unique_name(to, name);
        light->technique = technique && technique[0] ? memory_string(technique, "") : NULL;
        to->light_count++;
        if (!light->name || (technique && technique[0] && !light->technique)) {
            return PNB_ERROR_OUT_OF_MEMORY;
        }
        if (strcmp(light->name, name) != 0) {
            messages_add(messages, "light '%s': another light has this name; this one is called '%s'", name,
                         light->name);
        }
    }
    links_finish(to);
    return PNB_OK;
}

/* ---- World ---- */

static void copy_world(const pnb_scene *from, struct messages *messages, struct scene *to) {
    for (int i = 0; i < 3; i++) {
        float value = from->world_color[i];
        bool usable = numbers_usable(&value, 1) && value >= 0;
        to->world_color[i] = usable ? value : 0;
        if (!usable) {
            messages_add(messages, "world: its colour is negative or not finite and was set to 0");
        }
    }
}

static pnb_result scene_fill(const pnb_scene *from, struct messages *messages, struct scene *to) {
    copy_world(from, messages, to);
    camera_resolve(&from->camera, messages, &to->camera);
    pnb_result result = copy_materials(from, messages, to);
    if (result == PNB_OK) {
        result = copy_slots(from, messages, to);
    }
    if (result == PNB_OK) {
        result = copy_instances(from, messages, to);
    }
    if (result == PNB_OK) {
        result = copy_lights(from, messages, to);
    }
    return result;
}

pnb_result scene_create(const pnb_scene *from, struct messages *messages, struct scene **scene) {
    pnb_result result = scene_check(from);
    if (result != PNB_OK) {
        return result;
    }
    struct scene *made = memory_array(1, sizeof *made);
    if (!made) {
        return PNB_ERROR_OUT_OF_MEMORY;
    }
    result = scene_fill(from, messages, made);
    if (result != PNB_OK) {
        scene_destroy(&made);
        return result;
    }
    *scene = made;
    return PNB_OK;
}

void scene_destroy(struct scene **scene) {
    if (!scene || !*scene) {
        return;
    }
    struct scene *last = *scene;
    *scene = NULL;
    for (uint32_t i = 0; i < last->instance_count; i++) {
        memory_free(last->instances[i].name);
        pnb_mesh_destroy(&last->instances[i].mesh);
    }
    for (uint32_t i = 0; i < last->material_count; i++) {
        pnb_texture_destroy(&last->materials[i].base_color_texture);
        pnb_texture_destroy(&last->materials[i].alpha_texture);
        pnb_texture_destroy(&last->materials[i].emission_texture);
    }
    for (uint32_t i = 0; i < last->light_count; i++) {
        memory_free(last->lights[i].name);
        memory_free(last->lights[i].technique);
    }
    memory_free(last->instances);
    memory_free(last->materials);
    memory_free(last->slots);
    memory_free(last->lights);
    memory_free(last);
}
