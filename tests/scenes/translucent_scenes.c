/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "translucent_scenes.h"

#include <math.h>
#include <stdlib.h>

#define TEXELS 256

static const float ORIGIN[3] = {0, 0, 0};

/* Rectangle -0.5..0.5 facing up, of cells x cells x 2 triangles, with its texture once over it. */
static const pnb_mesh *sheet_mesh(struct scene_builder *builder, uint32_t cells, const char *name) {
    const uint32_t side = cells + 1;
    float *positions = malloc(sizeof *positions * side * side * 3), *uvs = malloc(sizeof *uvs * side * side * 2);
    uint32_t *triangles = malloc(sizeof *triangles * cells * cells * 6), count = 0;
    pnb_mesh *mesh = NULL;
    if (positions && uvs && triangles && builder->mesh_count < BUILDER_MAX_MESHES) {
        for (uint32_t i = 0; i < side * side; i++)
            for (uint32_t axis = 0; axis < 3; axis++) {
                const float u = (float)(axis == 0 ? i % side : i / side) / (float)cells;
                positions[3 * i + axis] = axis == 2 ? 0 : u - 0.5f;
                if (axis < 2)
                    uvs[2 * i + axis] = u;
            }
        for (uint32_t i = 0; i < cells * cells; i++) {
            const uint32_t a = i / cells * side + i % cells;
            const uint32_t corners[6] = {a, a + 1, a + side + 1, a, a + side + 1, a + side};
            for (uint32_t k = 0; k < 6; k++)
                triangles[count++] = corners[k];
        }
        pnb_mesh_desc desc = PNB_INIT(pnb_mesh_desc);
        desc.name = name;
        desc.vertex_count = desc.corner_count = side * side;
        desc.triangle_count = count / 3;
        desc.positions.data = positions;
        desc.corner_uvs.data = uvs;
        desc.triangles.data = triangles;
        if (pnb_mesh_create(&desc, &mesh) == PNB_OK)
            builder->meshes[builder->mesh_count++] = mesh;
    }
    builder->failed |= !mesh;
    free(positions);
    free(uvs);
    free(triangles);
    return mesh;
}

static const pnb_mesh *ball_mesh(struct scene_builder *builder) {
    struct shape shape = {0};
    shape_sphere(&shape, 48, 24);
    return builder_mesh(builder, &shape, "ball");
}

static void add_floor(struct scene_builder *builder) {
    struct shape shape = {0};
    shape_rectangle(&shape, -6, -6, 6, 6, 0);
    builder_instance(builder, builder_mesh(builder, &shape, "floor"), MATERIAL_WHITE, (struct placement){0});
}

/* Glass of this colour for light that passes once. */
static void make_clear(pnb_material *material, float red, float green, float blue) {
    const float color[3] = {red, green, blue};
    material->transparency = 1;
    for (int i = 0; i < 3; i++)
        material->absorption[i] = 1 - color[i];
}

static void add_hidden(struct scene_builder *builder, const pnb_mesh *mesh, enum builder_material material,
                       struct placement placement) {
    pnb_instance *instance = builder_instance(builder, mesh, material, placement);
    if (instance)
        instance->flags = PNB_INSTANCE_HIDDEN_FROM_CAMERA;
}

/* Alpha of a material by a function of u, v in 0..1. */
static void add_alpha_texture(struct scene_builder *builder, enum builder_material material,
                              float (*alpha)(float u, float v)) {
    float *pixels = malloc(sizeof *pixels * TEXELS * TEXELS);
    for (uint32_t i = 0; pixels && i < TEXELS * TEXELS; i++)
        pixels[i] = alpha(((float)(i % TEXELS) + 0.5f) / TEXELS, ((float)(i / TEXELS) + 0.5f) / TEXELS);
    pnb_texture_desc desc = PNB_INIT(pnb_texture_desc);
    desc.name = "alpha";
    desc.width = desc.height = TEXELS;
    desc.channels = 1;
    desc.pixels.data = pixels;
    pnb_texture *texture = NULL;
    if (pixels && pnb_texture_create(&desc, &texture) == PNB_OK)
        builder->textures[builder->texture_count++] = texture;
    builder->materials[material].alpha_texture = texture;
    builder->failed |= !texture;
    free(pixels);
}

/* Red, green and blue glass at three heights, overlapping, with a ball between them. */
void build_glass(struct scene_builder *builder) {
    add_floor(builder);
    const pnb_mesh *pane = sheet_mesh(builder, 1, "pane");
    make_clear(&builder->materials[MATERIAL_RED], 0.9f, 0.15f, 0.1f);
    make_clear(&builder->materials[MATERIAL_GREEN], 0.2f, 0.8f, 0.2f);
    make_clear(&builder->materials[MATERIAL_BLUE], 0.15f, 0.3f, 0.9f);
    const float side = 1.6f;
    for (int i = 0; i < 3; i++) {
        const float angle = 2.0944f * (float)i;
        struct placement placement = {.position = {0.6f * cosf(angle), 0.6f * sinf(angle), 0.3f + 0.7f * (float)i},
                                      .rotation = {0.1f * (float)i, 0, angle},
                                      .scale = {side, side, 1}};
        static const enum builder_material materials[] = {MATERIAL_RED, MATERIAL_GREEN, MATERIAL_BLUE};
        add_hidden(builder, pane, materials[i], placement);
    }
    add_hidden(builder, ball_mesh(builder), MATERIAL_GREY,
               (struct placement){.position = {0, 0, 0.7f}, .scale = {0.25f, 0.25f, 0.25f}});
    builder_key_light(builder, (const float[3]){0.8f, -0.6f, 5}, ORIGIN, builder->options.parameter);
    builder_camera_above(builder, 5);
}

/* Panes above each other, each a little smaller and darker in one channel. */
void build_panes(struct scene_builder *builder) {
    add_floor(builder);
    const pnb_mesh *pane = sheet_mesh(builder, 1, "pane");
    make_clear(&builder->materials[MATERIAL_YELLOW], 0.9f, 0.75f, 0.4f);
    const int count = (int)builder->options.parameter;
    for (int i = 0; i < count; i++) {
        const float side = 2.4f - 1.6f * (float)i / (float)count;
        struct placement placement = {.position = {0.1f * (float)i, 0, 0.3f + 0.12f * (float)i},
                                      .rotation = {0, 0, 0.2f * (float)i},
                                      .scale = {side, side, 1}};
        add_hidden(builder, pane, MATERIAL_YELLOW, placement);
    }
    builder_key_light(builder, (const float[3]){0.5f, -0.5f, 5}, ORIGIN, 1);
    builder_camera_above(builder, 5);
}

static float picket_alpha(float u, float v) {
    const float x = u * 16 - floorf(u * 16);
    const int rail = fabsf(v - 0.25f) < 0.03f || fabsf(v - 0.75f) < 0.03f;
    return rail || fabsf(x - 0.5f) < 0.2f ? 1.0f : 0.0f;
}

/* A picture of a fence on one quadrilateral, once near the floor and once far above it. */
void build_alpha_fence(struct scene_builder *builder) {
    add_floor(builder);
    const pnb_mesh *sheet = sheet_mesh(builder, 1, "fence");
    add_alpha_texture(builder, MATERIAL_YELLOW, picket_alpha);
    const float side = builder->options.parameter;
    add_hidden(builder, sheet, MATERIAL_YELLOW,
               (struct placement){.position = {-1.2f, 0, 0.15f}, .rotation = {0.2f, 0, 0}, .scale = {side, side, 1}});
    add_hidden(builder, sheet, MATERIAL_YELLOW,
               (struct placement){.position = {1.2f, 0, 1.6f}, .rotation = {0.2f, 0, 0}, .scale = {side, side, 1}});
    builder_key_light(builder, (const float[3]){0.3f, -1, 5}, ORIGIN, 0.5f);
    builder_camera_above(builder, 5);
}

/* An ellipse pointed at both ends, thin at its rim. */
static float leaf_alpha(float u, float v) {
    const float y = 2 * fabsf(v - 0.5f), width = 0.35f * (1 - y * y);
    return fminf(fmaxf((width - fabsf(u - 0.5f)) * 40, 0), 0.7f);
}

/* Numbers that look random and are the same everywhere, 0 <= x < 1. */
static float next_random(uint32_t *state) {
    *state = *state * 1664525u + 1013904223u;
    return (float)(*state >> 8) / 16777216.0f;
}

/* A crown of leaves, each a quadrilateral with its outline as alpha, through which green light shines. */
void build_foliage(struct scene_builder *builder) {
    add_floor(builder);
    const pnb_mesh *leaf = sheet_mesh(builder, 1, "leaf");
    add_alpha_texture(builder, MATERIAL_GREEN, leaf_alpha);
    make_clear(&builder->materials[MATERIAL_GREEN], 0.4f, 0.9f, 0.2f);
    builder->materials[MATERIAL_GREEN].transparency = 0;
    uint32_t random = 3;
    for (int i = 0; i < (int)builder->options.parameter; i++) {
        const float height = next_random(&random), angle = 6.2832f * next_random(&random),
                    radius = 0.9f * sqrtf(next_random(&random)) * sinf(3.1416f * (0.15f + 0.7f * height));
        struct placement placement = {.position = {radius * cosf(angle), radius * sinf(angle), 0.6f + 1.6f * height},
                                      .rotation = {2 * next_random(&random) - 1, 2 * next_random(&random) - 1, angle},
                                      .scale = {0.35f, 0.45f, 1}};
        builder_instance(builder, leaf, MATERIAL_GREEN, placement);
    }
    builder_key_light(builder, (const float[3]){1.5f, -1, 5}, ORIGIN, 0.6f);
    builder_camera(builder, (const float[3]){0, -7, 4}, (const float[3]){-0.2f, 0, 0.7f}, 0.5f);
}

/* Sheets above each other that together let 0.3 of the light through, of 6498 triangles each. */
void build_layers(struct scene_builder *builder) {
    add_floor(builder);
    const pnb_mesh *sheet = sheet_mesh(builder, 57, "layer");
    const int count = (int)builder->options.parameter;
    const float clear = powf(0.3f, 1.0f / (float)count);
    make_clear(&builder->materials[MATERIAL_GREY], clear, clear, clear);
    for (int i = 0; i < count; i++)
        add_hidden(builder, sheet, MATERIAL_GREY,
                   (struct placement){.position = {0, 0, 0.2f + 1.8f * (float)i / (float)count}, .scale = {2, 2, 1}});
    builder_key_light(builder, (const float[3]){0, 0, 5}, ORIGIN, 1);
    builder_camera_above(builder, 5);
}
