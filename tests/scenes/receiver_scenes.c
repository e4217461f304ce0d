/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "receiver_scenes.h"

static const float ORIGIN[3] = {0, 0, 0};

static const pnb_mesh *box_mesh(struct scene_builder *builder) {
    struct shape shape = {0};
    shape_box(&shape, (const float[3]){-0.5f, -0.5f, 0}, (const float[3]){0.5f, 0.5f, 1});
    return builder_mesh(builder, &shape, "box");
}

static void add_floor(struct scene_builder *builder, float half_side) {
    struct shape shape = {0};
    shape_rectangle(&shape, -half_side, -half_side, half_side, half_side, 0);
    builder_instance(builder, builder_mesh(builder, &shape, "floor"), MATERIAL_WHITE, (struct placement){0});
}

/* Platform i is at i / 20 of the way from the highest one to the floor; neighbours are far apart in height. */
void build_terraces(struct scene_builder *builder) {
    add_floor(builder, 2);
    const pnb_mesh *box = box_mesh(builder);
    for (int i = 0; i < 20; i++) {
        const int cell = 7 * i % 20;
        struct placement placement = {
            .position = {-1.4f + 0.7f * (float)(cell % 5), -1.05f + 0.7f * (float)(cell / 5), 0},
            .scale = {0.7f, 0.7f, builder->options.parameter * (float)(20 - i) / 20}};
        builder_instance(builder, box, MATERIAL_WHITE, placement);
    }
    builder_key_light(builder, (const float[3]){0, 0, 8}, ORIGIN, 0.05f);
    builder_camera_above(builder, 4);
}

void build_grazing_fence(struct scene_builder *builder) {
    add_floor(builder, 12);
    const pnb_mesh *box = box_mesh(builder);
    float width = builder->options.parameter;
    int pickets = (int)(8 / (2 * width));
    for (int i = 0; i < pickets; i++) {
        float x = -4 + width * (0.5f + 2 * (float)i);
        builder_instance(builder, box, MATERIAL_BLUE,
                         (struct placement){.position = {x, 6, 0}, .scale = {width, 0.03f, 1}});
    }
    builder_key_light(builder, (const float[3]){1, 9, 3}, (const float[3]){0, 5, 0}, 0.1f);
    builder_camera(builder, (const float[3]){0, -6, 0.8f}, (const float[3]){0, 4, 0}, 0.2f);
}
