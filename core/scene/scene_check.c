/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "scene_parts.h"

#include <inttypes.h>

static pnb_result check_size(const char *what, uint32_t index, uint32_t found, size_t expected) {
    if (found == expected) {
        return PNB_OK;
    }
    return error_set(PNB_ERROR_INVALID_ARGUMENT, "%s %" PRIu32 ": struct_size is %" PRIu32 ", this library expects %zu",
                     what, index, found, expected);
}

static pnb_result check_array(const char *name, uint32_t count, const void *array) {
    if (count > INT32_MAX) {
        return error_set(PNB_ERROR_INVALID_ARGUMENT, "pnb_scene.%s: %" PRIu32 " are too many", name, count);
    }
    if (count == 0 || array) {
        return PNB_OK;
    }
    return error_set(PNB_ERROR_INVALID_ARGUMENT, "pnb_scene.%s is NULL, but there are %" PRIu32, name, count);
}

static pnb_result check_instance(const pnb_instance *instance, uint32_t index) {
    const uint32_t known = PNB_INSTANCE_HIDDEN_FROM_CAMERA | PNB_INSTANCE_NO_SHADOW | PNB_INSTANCE_NO_RECEIVE |
                           PNB_INSTANCE_HOLDOUT | PNB_INSTANCE_SHADOW_CATCHER;
    pnb_result result = check_size("instance", index, instance->struct_size, sizeof *instance);
    if (result != PNB_OK) {
        return result;
    }
    const char *name = instance->name ? instance->name : "";
    if (!instance->mesh) {
        return error_set(PNB_ERROR_INVALID_ARGUMENT, "instance %" PRIu32 " '%s': its mesh is NULL", index, name);
    }
    if (instance->flags & ~known) {
        return error_set(PNB_ERROR_INVALID_ARGUMENT, "instance %" PRIu32 " '%s': unknown flags 0x%" PRIx32, index, name,
                         instance->flags & ~known);
    }
    return PNB_OK;
}

static pnb_result check_material(const pnb_material *material, uint32_t index) {
    const uint32_t known = PNB_MATERIAL_CULL_CAMERA | PNB_MATERIAL_CULL_SHADOW | PNB_MATERIAL_HOLDOUT |
                           PNB_MATERIAL_TINTED | PNB_MATERIAL_NO_SHADOW | PNB_MATERIAL_OPAQUE_SHADOW |
                           PNB_MATERIAL_VERTEX_COLOR;
    pnb_result result = check_size("material", index, material->struct_size, sizeof *material);
    if (result == PNB_OK && (material->flags & ~known)) {
        return error_set(PNB_ERROR_INVALID_ARGUMENT, "material %" PRIu32 ": unknown flags 0x%" PRIx32, index,
                         material->flags & ~known);
    }
    return result;
}

static pnb_result check_light(const pnb_light *light, uint32_t index) {
    const uint32_t known = PNB_LIGHT_NO_SHADOW | PNB_LIGHT_COSINE_SPOT;
    pnb_result result = check_size("light", index, light->struct_size, sizeof *light);
    if (result != PNB_OK) {
        return result;
    }
    const char *name = light->name ? light->name : "";
    if ((uint32_t)light->type > PNB_LIGHT_SUN || (uint32_t)light->shape > PNB_AREA_ELLIPSE) {
        return error_set(PNB_ERROR_INVALID_ARGUMENT, "light %" PRIu32 " '%s': unknown type %d or shape %d", index, name,
                         (int)light->type, (int)light->shape);
    }
    if (light->flags & ~known) {
        return error_set(PNB_ERROR_INVALID_ARGUMENT, "light %" PRIu32 " '%s': unknown flags 0x%" PRIx32, index, name,
                         light->flags & ~known);
    }
    return PNB_OK;
}

static pnb_result check_camera(const pnb_camera *camera) {
    pnb_result result = CHECK_STRUCT(camera, pnb_camera);
    if (result == PNB_OK && (uint32_t)camera->projection > PNB_ORTHOGRAPHIC) {
        return error_set(PNB_ERROR_INVALID_ARGUMENT, "camera: unknown projection %d", (int)camera->projection);
    }
    return result;
}

static pnb_result check_arrays(const pnb_scene *scene) {
    pnb_result result = check_array("instances", scene->instance_count, scene->instances);
    if (result == PNB_OK) {
        result = check_array("materials", scene->material_count, scene->materials);
    }
    if (result == PNB_OK) {
        result = check_array("slots", scene->slot_count, scene->slots);
    }
    if (result == PNB_OK) {
        result = check_array("lights", scene->light_count, scene->lights);
    }
    if (result == PNB_OK && scene->light_count > MAX_LIGHTS) {
        return error_set(PNB_ERROR_INVALID_ARGUMENT, "%" PRIu32 " lights are more than %d", scene->light_count,
                         MAX_LIGHTS);
    }
    return result;
}

pnb_result scene_check(const pnb_scene *scene) {
    pnb_result result = CHECK_STRUCT(scene, pnb_scene);
    if (result == PNB_OK) {
        result = check_camera(&scene->camera);
    }
    if (result == PNB_OK) {
        result = check_arrays(scene);
    }
    for (uint32_t i = 0; result == PNB_OK && i < scene->instance_count; i++) {
        result = check_instance(&scene->instances[i], i);
    }
    for (uint32_t i = 0; result == PNB_OK && i < scene->material_count; i++) {
        result = check_material(&scene->materials[i], i);
    }
    for (uint32_t i = 0; result == PNB_OK && i < scene->light_count; i++) {
        result = check_light(&scene->lights[i], i);
    }
    return result;
}
