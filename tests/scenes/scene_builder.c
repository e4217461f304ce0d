/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "scene_builder.h"

#include <math.h>
#include <string.h>

static const float colors[][3] = {
    [MATERIAL_WHITE] = {0.8f, 0.8f, 0.8f},    [MATERIAL_GREY] = {0.4f, 0.4f, 0.4f},
    [MATERIAL_RED] = {0.7f, 0.12f, 0.08f},    [MATERIAL_BLUE] = {0.1f, 0.2f, 0.6f},
    [MATERIAL_GREEN] = {0.15f, 0.45f, 0.15f}, [MATERIAL_YELLOW] = {0.8f, 0.55f, 0.1f},
};

void builder_init(struct scene_builder *builder, const struct test_scene_options *options) {
    memset(builder, 0, sizeof *builder);
    builder->options = *options;
    pnb_scene *scene = &builder->scene;
    scene->struct_size = sizeof *scene;
    scene->instances = builder->instances;
    scene->materials = builder->materials;
    scene->slots = builder->slots;
    scene->lights = builder->lights;
    scene->material_count = scene->slot_count = sizeof colors / sizeof *colors;
    for (uint32_t i = 0; i < scene->material_count; i++) {
        builder->materials[i].struct_size = sizeof(pnb_material);
        memcpy(builder->materials[i].base_color, colors[i], sizeof colors[i]);
        builder->slots[i] = i;
    }
    for (int i = 0; i < 3; i++)
        scene->world_color[i] = 0.05f;
    builder->settings.struct_size = sizeof builder->settings;
}

void builder_free(struct scene_builder *builder) {
    for (uint32_t i = 0; i < builder->mesh_count; i++)
        pnb_mesh_destroy(&builder->meshes[i]);
    for (uint32_t i = 0; i < builder->texture_count; i++)
        pnb_texture_destroy(&builder->textures[i]);
}

const pnb_mesh *builder_mesh(struct scene_builder *builder, struct shape *shape, const char *name) {
    if (builder->mesh_count == BUILDER_MAX_MESHES)
        shape->failed = 1;
    pnb_mesh *mesh = shape_finish(shape, name);
    if (!mesh) {
        builder->failed = 1;
        return NULL;
    }
    builder->meshes[builder->mesh_count++] = mesh;
    return mesh;
}

static void placement_matrix(const struct placement *placement, float matrix[16]) {
    float cx = cosf(placement->rotation[0]), sx = sinf(placement->rotation[0]);
    float cy = cosf(placement->rotation[1]), sy = sinf(placement->rotation[1]);
    float cz = cosf(placement->rotation[2]), sz = sinf(placement->rotation[2]);
    const float axes[3][3] = {
        {cz * cy, sz * cy, -sy},
        {cz * sy * sx - sz * cx, sz * sy * sx + cz * cx, cy * sx},
        {cz * sy * cx + sz * sx, sz * sy * cx - cz * sx, cy * cx},
    };
    for (int column = 0; column < 3; column++) {
        float scale = placement->scale[column] != 0 ? placement->scale[column] : 1;
        for (int row = 0; row < 3; row++)
            matrix[4 * column + row] = scale * axes[column][row];
        matrix[4 * column + 3] = 0;
        matrix[12 + column] = placement->position[column];
    }
    matrix[15] = 1;
}

pnb_instance *builder_instance(struct scene_builder *builder, const pnb_mesh *mesh, enum builder_material material,
                               struct placement placement) {
    if (!mesh || builder->scene.instance_count == BUILDER_MAX_INSTANCES) {
        builder->failed = 1;
        return NULL;
    }
    pnb_instance *instance = &builder->instances[builder->scene.instance_count++];
    instance->struct_size = sizeof *instance;
    instance->mesh = mesh;
    instance->first_slot = material;
    instance->slot_count = 1;
    placement_matrix(&placement, instance->matrix);
    return instance;
}

static float normalize(float vector[3]) {
    float length = sqrtf(vector[0] * vector[0] + vector[1] * vector[1] + vector[2] * vector[2]);
    for (int i = 0; i < 3; i++)
        vector[i] /= length;
    return length;
}

static void cross(const float a[3], const float b[3], float result[3]) {
    for (int i = 0; i < 3; i++)
        result[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}

/* Local -Z looks from position to target, +Y is up (world Y when looking straight up or down). Returns the distance. */
static float look_at(const float position[3], const float target[3], float matrix[16]) {
    float x[3], y[3], z[3];
    for (int i = 0; i < 3; i++)
        z[i] = position[i] - target[i];
    float distance = normalize(z);
    int vertical = fabsf(z[2]) > 0.9999f;
    const float up[3] = {0, vertical ? 1.0f : 0.0f, vertical ? 0.0f : 1.0f};
    cross(up, z, x);
    normalize(x);
    cross(z, x, y);
    for (int i = 0; i < 3; i++) {
        matrix[i] = x[i];
        matrix[4 + i] = y[i];
        matrix[8 + i] = z[i];
        matrix[12 + i] = position[i];
    }
    matrix[3] = matrix[7] = matrix[11] = 0;
    matrix[15] = 1;
    return distance;
}

pnb_light *builder_light(struct scene_builder *builder, enum test_light kind, const float position[3],
                         const float target[3], float size, float irradiance) {
    if (builder->scene.light_count == BUILDER_MAX_LIGHTS) {
        builder->failed = 1;
        return NULL;
    }
    pnb_light *light = &builder->lights[builder->scene.light_count++];
    light->struct_size = sizeof *light;
    float distance = look_at(position, target, light->matrix);
    float emission = irradiance;
    switch (kind) {
    case TEST_LIGHT_RECTANGLE:
    case TEST_LIGHT_ELLIPSE:
        light->type = PNB_LIGHT_AREA;
        light->shape = kind == TEST_LIGHT_ELLIPSE ? PNB_AREA_ELLIPSE : PNB_AREA_RECTANGLE;
        light->size[0] = light->size[1] = size;
        emission *= distance * distance / (size * size * (kind == TEST_LIGHT_ELLIPSE ? 0.78539816f : 1.0f));
        break;
    case TEST_LIGHT_POINT:
    case TEST_LIGHT_SPOT:
        light->type = kind == TEST_LIGHT_SPOT ? PNB_LIGHT_SPOT : PNB_LIGHT_POINT;
        light->radius = size / 2;
        light->spot_angle = 1.2f;
        light->spot_blend = 0.15f;
        emission *= distance * distance;
        break;
    case TEST_LIGHT_SUN:
        light->type = PNB_LIGHT_SUN;
        light->angle = 2 * atanf(size / (2 * distance));
        break;
    }
    light->name = test_light_names[kind];
    for (int i = 0; i < 3; i++)
        light->emission[i] = emission;
    return light;
}

pnb_light *builder_key_light(struct scene_builder *builder, const float position[3], const float target[3],
                             float size) {
    if (builder->options.light_size > 0)
        size = builder->options.light_size;
    return builder_light(builder, builder->options.light, position, target, size, 2);
}

static void set_window(pnb_camera *camera, float half_width, float half_height) {
    camera->window[0] = -half_width;
    camera->window[1] = half_width;
    camera->window[2] = -half_height;
    camera->window[3] = half_height;
}

void builder_camera(struct scene_builder *builder, const float position[3], const float target[3], float field) {
    pnb_camera *camera = &builder->scene.camera;
    camera->struct_size = sizeof *camera;
    camera->projection = PNB_PERSPECTIVE;
    look_at(position, target, camera->matrix);
    float half_height = tanf(field / 2);
    set_window(camera, half_height * 16 / 9, half_height);
    builder->settings.width = 640;
    builder->settings.height = 360;
}

void builder_camera_above(struct scene_builder *builder, float side) {
    pnb_camera *camera = &builder->scene.camera;
    camera->struct_size = sizeof *camera;
    camera->projection = PNB_ORTHOGRAPHIC;
    look_at((const float[3]){0, 0, 50}, (const float[3]){0, 0, 0}, camera->matrix);
    set_window(camera, side / 2, side / 2);
    builder->settings.width = builder->settings.height = 512;
}
