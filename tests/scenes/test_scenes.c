/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "test_scenes.h"

#include "receiver_scenes.h"
#include "scene_builder.h"
#include "translucent_scenes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

const char *const test_light_names[TEST_LIGHT_COUNT] = {"rectangle", "ellipse", "point", "spot", "sun"};

static const float ORIGIN[3] = {0, 0, 0};

/* ---- Meshes that several scenes use ---- */

static const pnb_mesh *rectangle_mesh(struct scene_builder *builder, const char *name, float x0, float y0, float x1,
                                      float y1) {
    struct shape shape = {0};
    shape_rectangle(&shape, x0, y0, x1, y1, 0);
    return builder_mesh(builder, &shape, name);
}

static const pnb_mesh *disc_mesh(struct scene_builder *builder, float radius) {
    struct shape shape = {0};
    shape_disc(&shape, 128, radius, 0);
    return builder_mesh(builder, &shape, "disc");
}

/* Unit box: -0.5..0.5 along x and y, standing on z = 0. */
static const pnb_mesh *box_mesh(struct scene_builder *builder) {
    struct shape shape = {0};
    shape_box(&shape, (const float[3]){-0.5f, -0.5f, 0}, (const float[3]){0.5f, 0.5f, 1});
    return builder_mesh(builder, &shape, "box");
}

static const pnb_mesh *sphere_mesh(struct scene_builder *builder, uint32_t columns, uint32_t rows) {
    struct shape shape = {0};
    shape_sphere(&shape, columns, rows);
    return builder_mesh(builder, &shape, "sphere");
}

static const pnb_mesh *tube_mesh(struct scene_builder *builder, uint32_t columns, uint32_t rows) {
    struct shape shape = {0};
    shape_tube(&shape, columns, rows);
    return builder_mesh(builder, &shape, "tube");
}

static void add_floor(struct scene_builder *builder, float half_side) {
    const pnb_mesh *mesh = rectangle_mesh(builder, "floor", -half_side, -half_side, half_side, half_side);
    builder_instance(builder, mesh, MATERIAL_WHITE, (struct placement){0});
}

/* An occluder that only its shadow shows. */
static void add_hidden(struct scene_builder *builder, const pnb_mesh *mesh, struct placement placement) {
    pnb_instance *instance = builder_instance(builder, mesh, MATERIAL_GREY, placement);
    if (instance)
        instance->flags = PNB_INSTANCE_HIDDEN_FROM_CAMERA;
}

/* ---- Shadows with a known form: camera above, the light straight above the origin at z = 4 ---- */

static void build_half_plane(struct scene_builder *builder) {
    add_floor(builder, 6);
    const pnb_mesh *mesh = rectangle_mesh(builder, "half-plane", -8, -8, 0, 8);
    add_hidden(builder, mesh, (struct placement){.position = {0, 0, builder->options.parameter}});
    builder_key_light(builder, (const float[3]){0, 0, 4}, ORIGIN, 1.5f);
    builder_camera_above(builder, 2);
}

static void build_ball(struct scene_builder *builder) {
    add_floor(builder, 6);
    struct placement placement = {.position = {0, 0, builder->options.parameter}, .scale = {0.5f, 0.5f, 0.5f}};
    add_hidden(builder, sphere_mesh(builder, 256, 128), placement);
    builder_key_light(builder, (const float[3]){0, 0, 4}, ORIGIN, 0.5f);
    builder_camera_above(builder, 3);
}

static void build_hover(struct scene_builder *builder) {
    add_floor(builder, 6);
    add_hidden(builder, disc_mesh(builder, 0.5f), (struct placement){.position = {0, 0, builder->options.parameter}});
    builder_key_light(builder, (const float[3]){0, 0, 4}, ORIGIN, 1);
    builder_camera_above(builder, 2);
}

static void build_slot(struct scene_builder *builder) {
    add_floor(builder, 6);
    const pnb_mesh *mesh = rectangle_mesh(builder, "edge", 0, -8, 8, 8);
    float half_gap = builder->options.parameter / 2;
    add_hidden(builder, mesh, (struct placement){.position = {half_gap, 0, 1}});
    add_hidden(builder, mesh, (struct placement){.position = {-half_gap, 0, 1}, .scale = {-1, 1, 1}});
    builder_key_light(builder, (const float[3]){0, 0, 4}, ORIGIN, 1);
    builder_camera_above(builder, 2);
}

static void build_discs(struct scene_builder *builder) {
    add_floor(builder, 6);
    const pnb_mesh *mesh = disc_mesh(builder, 0.5f);
    float offset = builder->options.parameter / 2;
    add_hidden(builder, mesh, (struct placement){.position = {-offset, 0, 0.8f}});
    add_hidden(builder, mesh, (struct placement){.position = {offset, 0, 1.6f}});
    builder_key_light(builder, (const float[3]){0, 0, 4}, ORIGIN, 1);
    builder_camera_above(builder, 3);
}

static void build_slats(struct scene_builder *builder) {
    add_floor(builder, 6);
    const pnb_mesh *mesh = rectangle_mesh(builder, "slat", -1.5f, -0.2f, 1.5f, 0.2f);
    int count = (int)builder->options.parameter;
    for (int i = 0; i < count; i++) {
        float step = count > 1 ? (float)i / (float)(count - 1) : 0;
        float angle = 3.14159265f * (float)i / (float)count;
        add_hidden(builder, mesh,
                   (struct placement){.position = {0, 0, 0.5f + 1.7f * step}, .rotation = {0, 0, angle}});
    }
    builder_key_light(builder, (const float[3]){0, 0, 4}, ORIGIN, 0.6f);
    builder_camera_above(builder, 3);
}

static void build_perforated(struct scene_builder *builder) {
    add_floor(builder, 6);
    struct shape shape = {0};
    shape_perforated_sheet(&shape, (uint32_t)builder->options.parameter);
    add_hidden(builder, builder_mesh(builder, &shape, "sheet"), (struct placement){.position = {0, 0, 0.5f}});
    builder_key_light(builder, (const float[3]){0, 0, 4}, ORIGIN, 0.5f);
    builder_camera_above(builder, 3);
}

static void build_slanted_sheet(struct scene_builder *builder) {
    add_floor(builder, 6);
    const pnb_mesh *mesh = rectangle_mesh(builder, "sheet", -1, -0.6f, 1, 0.6f);
    float tilt = builder->options.parameter * 3.14159265f / 180;
    add_hidden(builder, mesh, (struct placement){.position = {0, 0, 1.6f}, .rotation = {0, tilt, 0}});
    builder_key_light(builder, (const float[3]){0, 0, 4}, ORIGIN, 1);
    builder_camera_above(builder, 4);
}

/* ---- Nothing to be shadowed by but oneself ---- */

static void build_plane(struct scene_builder *builder) {
    add_floor(builder, 3);
    float angle = builder->options.parameter * 3.14159265f / 180;
    builder_key_light(builder, (const float[3]){4 * sinf(angle), 0, 4 * cosf(angle)}, ORIGIN, 0.4f);
    builder_camera_above(builder, 4);
}

static void build_sphere(struct scene_builder *builder) {
    add_floor(builder, 6);
    builder_instance(builder, sphere_mesh(builder, 128, 64), MATERIAL_WHITE, (struct placement){.position = {0, 0, 1}});
    builder_key_light(builder, (const float[3]){3, -2, 4}, (const float[3]){0, 0, 0.5f}, 0.8f);
    builder_camera(builder, (const float[3]){0, -7, 3}, (const float[3]){0, 0, 0.7f}, 0.45f);
}

/* ---- Objects on a floor, seen by a perspective camera ---- */

static void build_box(struct scene_builder *builder) {
    add_floor(builder, 6);
    struct placement placement = {.rotation = {0, 0, 0.5f}, .scale = {1, 1, builder->options.parameter}};
    builder_instance(builder, box_mesh(builder), MATERIAL_YELLOW, placement);
    builder_key_light(builder, (const float[3]){2.5f, -1, 4}, ORIGIN, 1.2f);
    builder_camera(builder, (const float[3]){0.5f, -6, 4}, (const float[3]){-0.3f, 0, 0.4f}, 0.5f);
}

static void build_fence(struct scene_builder *builder) {
    add_floor(builder, 6);
    const pnb_mesh *box = box_mesh(builder);
    float width = builder->options.parameter;
    int pickets = (int)(3 / (2 * width));
    for (int i = 0; i < pickets; i++) {
        float x = -1.5f + width * (0.5f + 2 * (float)i);
        builder_instance(builder, box, MATERIAL_BLUE,
                         (struct placement){.position = {x, 0, 0}, .scale = {width, 0.03f, 1}});
    }
    for (int i = 0; i < 2; i++) {
        struct placement rail = {.position = {0, 0.03f, 0.2f + 0.5f * (float)i}, .scale = {3, 0.03f, 0.06f}};
        builder_instance(builder, box, MATERIAL_BLUE, rail);
    }
    builder_key_light(builder, (const float[3]){1, 3, 3}, ORIGIN, 0.6f);
    builder_camera(builder, (const float[3]){0, -6, 3}, (const float[3]){0, -0.5f, 0.3f}, 0.45f);
}

static void build_stairs(struct scene_builder *builder) {
    add_floor(builder, 6);
    const pnb_mesh *box = box_mesh(builder);
    float depth = builder->options.parameter;
    for (int i = 0; i < 8; i++) {
        struct placement step = {.position = {0, depth * (float)i, 0},
                                 .scale = {2.4f, depth, depth * (float)(i + 1) / 2}};
        builder_instance(builder, box, MATERIAL_WHITE, step);
    }
    struct placement bar = {.position = {0, 0.8f, 1.6f}, .rotation = {0, 0.3f, 0.4f}, .scale = {2.4f, 0.25f, 0.25f}};
    builder_instance(builder, box, MATERIAL_RED, bar);
    builder_key_light(builder, (const float[3]){-1, -2, 5}, (const float[3]){0, 1, 0.5f}, 0.8f);
    builder_camera(builder, (const float[3]){3, -5, 4}, (const float[3]){0, 0.8f, 0.5f}, 0.5f);
}

static void build_lantern(struct scene_builder *builder) {
    add_floor(builder, 6);
    const pnb_mesh *disc = disc_mesh(builder, 1), *tube = tube_mesh(builder, 24, 1);
    builder_instance(builder, disc, MATERIAL_YELLOW,
                     (struct placement){.position = {0, 0, 2}, .scale = {0.8f, 0.8f, 1}});
    int bars = (int)builder->options.parameter;
    for (int i = 0; i < bars; i++) {
        float angle = 2 * 3.14159265f * (float)i / (float)bars;
        struct placement bar = {.position = {0.75f * cosf(angle), 0.75f * sinf(angle), 0.1f},
                                .scale = {0.03f, 0.03f, 1.9f}};
        builder_instance(builder, tube, MATERIAL_YELLOW, bar);
    }
    struct placement candle = {.position = {0, 0, 0.4f}, .scale = {0.2f, 0.2f, 0.2f}};
    builder_instance(builder, sphere_mesh(builder, 48, 24), MATERIAL_RED, candle);
    builder_key_light(builder, (const float[3]){1.5f, -0.5f, 5}, ORIGIN, 1);
    builder_camera(builder, (const float[3]){1, -7, 4}, (const float[3]){-0.3f, 0, 0.7f}, 0.5f);
}

static void build_tall_box(struct scene_builder *builder) {
    add_floor(builder, 6);
    builder_instance(builder, box_mesh(builder), MATERIAL_GREEN, (struct placement){.scale = {0.6f, 0.6f, 2}});
    builder_key_light(builder, (const float[3]){0.3f, 0.2f, 4}, ORIGIN, builder->options.parameter);
    builder_camera(builder, (const float[3]){3, -6, 5}, (const float[3]){0, 0, 0.6f}, 0.5f);
}

/* Numbers that look random and are the same everywhere, 0 <= x < 1. */
static float next_random(uint32_t *state) {
    *state = *state * 1664525u + 1013904223u;
    return (float)(*state >> 8) / 16777216.0f;
}

static void build_cubes(struct scene_builder *builder) {
    add_floor(builder, 8);
    const pnb_mesh *box = box_mesh(builder);
    uint32_t random = 1;
    for (int i = 0; i < (int)builder->options.parameter; i++) {
        float x = 6 * next_random(&random) - 3, y = 6 * next_random(&random) - 3, z = 1.5f * next_random(&random);
        float side = 0.04f + 0.12f * next_random(&random), turn = 6 * next_random(&random),
              tilt = 3 * next_random(&random);
        struct placement placement = {
            .position = {x, y, z * z}, .rotation = {tilt, turn, tilt + turn}, .scale = {side, side, side}};
        builder_instance(builder, box, (enum builder_material)(MATERIAL_RED + i % 4), placement);
    }
    builder_key_light(builder, (const float[3]){2, -2, 5}, ORIGIN, 0.8f);
    builder_camera(builder, (const float[3]){1, -8, 5}, ORIGIN, 0.6f);
}

/* ---- Larger compositions ---- */

static void add_columns(struct scene_builder *builder, uint32_t sides, uint32_t rows) {
    const pnb_mesh *tube = tube_mesh(builder, sides, rows), *box = box_mesh(builder);
    for (int i = 0; i < 8; i++) {
        float x = -3.5f + (float)i, y = 1.6f + 0.25f * (float)(i % 2);
        builder_instance(builder, tube, MATERIAL_WHITE,
                         (struct placement){.position = {x, y, 0.1f}, .scale = {0.14f, 0.14f, 2}});
        builder_instance(builder, box, MATERIAL_GREY,
                         (struct placement){.position = {x, y, 0}, .scale = {0.4f, 0.4f, 0.1f}});
        builder_instance(builder, box, MATERIAL_GREY,
                         (struct placement){.position = {x, y, 2.1f}, .scale = {0.4f, 0.4f, 0.1f}});
    }
}

/* 39,082 triangles: three rippled rings of 9,216, two spheres of 3,844, eight columns, forty boxes and a floor. */
static void build_benchmark(struct scene_builder *builder) {
    add_floor(builder, 8);
    struct shape shape = {0};
    shape_rippled_ring(&shape, 96, 48);
    const pnb_mesh *ring = builder_mesh(builder, &shape, "ring"), *sphere = sphere_mesh(builder, 62, 32);
    builder_instance(builder, ring, MATERIAL_RED, (struct placement){.position = {-1.6f, -0.2f, 0.45f}});
    struct placement standing = {
        .position = {0.9f, -0.4f, 1.2f}, .rotation = {1.45f, 0.2f, 0.5f}, .scale = {0.85f, 0.85f, 0.85f}};
    builder_instance(builder, ring, MATERIAL_BLUE, standing);
    struct placement floating = {
        .position = {-0.6f, 0.3f, 2}, .rotation = {0.5f, 0.3f, 0}, .scale = {0.45f, 0.45f, 0.45f}};
    builder_instance(builder, ring, MATERIAL_YELLOW, floating);
    builder_instance(builder, sphere, MATERIAL_GREEN,
                     (struct placement){.position = {2.6f, -0.6f, 0.5f}, .scale = {0.5f, 0.5f, 0.5f}});
    builder_instance(builder, sphere, MATERIAL_WHITE,
                     (struct placement){.position = {-0.2f, -1.6f, 0.3f}, .scale = {0.3f, 0.3f, 0.3f}});
    add_columns(builder, 24, 8);
    const pnb_mesh *box = box_mesh(builder);
    uint32_t random = 7;
    for (int i = 0; i < 40; i++) {
        float x = 7 * next_random(&random) - 3.5f, y = -2.6f + 1.2f * next_random(&random),
              turn = 3 * next_random(&random);
        struct placement placement = {
            .position = {x, y, 0}, .rotation = {0, 0, turn}, .scale = {0.1f, 0.1f, 0.1f + 0.2f * turn}};
        builder_instance(builder, box, (enum builder_material)(MATERIAL_RED + i % 4), placement);
    }
    builder_key_light(builder, (const float[3]){2, -3, 5}, (const float[3]){0, 0, 0.5f}, 1);
    builder_camera(builder, (const float[3]){0.5f, -9, 4.5f}, (const float[3]){0, -0.1f, 0.6f}, 0.5f);
}

static void build_all_lights(struct scene_builder *builder) {
    add_floor(builder, 8);
    builder_instance(builder, sphere_mesh(builder, 64, 32), MATERIAL_WHITE,
                     (struct placement){.position = {0.9f, 0, 0.6f}, .scale = {0.6f, 0.6f, 0.6f}});
    builder_instance(
        builder, box_mesh(builder), MATERIAL_WHITE,
        (struct placement){.position = {-0.8f, 0.3f, 0}, .rotation = {0, 0, 0.4f}, .scale = {0.7f, 0.7f, 1.2f}});
    static const float positions[TEST_LIGHT_COUNT][3] = {
        {3, -2, 4}, {-3, -2, 3}, {0.2f, -1.6f, 2.2f}, {-1, 3, 4}, {4, 3, 3}};
    static const float tints[TEST_LIGHT_COUNT][3] = {
        {1, 0.9f, 0.8f}, {0.4f, 0.6f, 1}, {1, 0.5f, 0.2f}, {0.5f, 1, 0.5f}, {1, 1, 0.9f}};
    float size = builder->options.light_size > 0 ? builder->options.light_size : 0.5f;
    for (int kind = 0; kind < TEST_LIGHT_COUNT; kind++) {
        pnb_light *light = builder_light(builder, (enum test_light)kind, positions[kind], ORIGIN, size, 0.7f);
        for (int i = 0; light && i < 3; i++)
            light->emission[i] *= tints[kind][i];
    }
    builder_camera(builder, (const float[3]){0, -7, 4}, (const float[3]){0, 0, 0.4f}, 0.5f);
}

/* ---- Table ---- */

struct test_scene_row {
    struct test_scene_info info;
    void (*build)(struct scene_builder *builder);
};

static const struct test_scene_row rows[] = {
    {{"half-plane", "straight edge above a floor; shadow boundary at x = 0", "height of the edge, m", 1, 0},
     build_half_plane},
    {{"ball", "sphere of radius 0.5 above a floor", "height of its centre, m", 1.5f, 0}, build_ball},
    {{"hover", "disc close above a floor: contact shadows", "height, m", 0.1f, 0}, build_hover},
    {{"slot", "gap between two edges", "width of the gap, m", 0.2f, 0}, build_slot},
    {{"discs", "two equal discs above each other: overlapping occluders", "horizontal distance, m", 0.3f, 0},
     build_discs},
    {{"slats", "crossing slats at several heights: light bleeding", "number of slats", 2, 0}, build_slats},
    {{"perforated", "sheet with fine square holes", "holes per side", 16, 0}, build_perforated},
    {{"slanted-sheet", "occluder that reaches from near the floor towards the light", "tilt, degrees", 55, 0},
     build_slanted_sheet},
    {{"plane", "empty floor under a tilted light: acne", "angle between normal and light, degrees", 60, 0},
     build_plane},
    {{"sphere", "sphere on a floor: terminator", NULL, 0, 0}, build_sphere},
    {{"box", "box standing on a floor: contact", "its height, m", 1, 0}, build_box},
    {{"fence", "picket fence in front of the light: thin occluders", "width of a picket, m", 0.05f, 0}, build_fence},
    {{"stairs", "receiver with steps under a bar", "depth of a step, m", 0.3f, 0}, build_stairs},
    {{"lantern", "small occluder below a large one, in a cage", "number of bars", 8, 0}, build_lantern},
    {{"tall-box", "tall box under a light larger than it", "width of the light, m", 1.2f, 0}, build_tall_box},
    {{"cubes", "many small floating cubes", "number of cubes", 1000, 0}, build_cubes},
    {{"benchmark", "about 40,000 triangles: rings, spheres, columns, boxes", NULL, 0, 0}, build_benchmark},
    {{"terraces", "lit platforms at every depth: precision of prefiltered maps", "height of the highest, m", 4, 0},
     build_terraces},
    {{"grazing-fence", "far fence at a grazing angle: aliasing", "width of a picket, m", 0.05f, 0},
     build_grazing_fence},
    {{"glass", "overlapping panes of red, green and blue glass, and a ball", "width of the light, m", 1, 1},
     build_glass},
    {{"panes", "stacked panes of glass", "number of panes", 4, 1}, build_panes},
    {{"alpha-fence", "fence by an alpha texture, near to the floor and far from it", "its side, m", 2, 1},
     build_alpha_fence},
    {{"foliage", "leaves by an alpha texture, through which light shines", "number of leaves", 150, 1}, build_foliage},
    {{"layers", "sheets above each other that let 0.3 of the light through", "number of sheets", 8, 1}, build_layers},
    {{"all-lights", "sphere and box under one light of each kind", NULL, 0, 0}, build_all_lights},
};

const struct test_scene_info *test_scene_info(uint32_t index) {
    return index < sizeof rows / sizeof *rows ? &rows[index].info : NULL;
}

struct test_scene {
    struct scene_builder builder;
};

struct test_scene *test_scene_create(const char *name, const struct test_scene_options *options) {
    for (uint32_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        if (strcmp(rows[i].info.name, name) != 0)
            continue;
        struct test_scene *scene = malloc(sizeof *scene);
        if (!scene)
            return NULL;
        struct test_scene_options filled = options ? *options : (struct test_scene_options){0};
        if (!filled.has_parameter)
            filled.parameter = rows[i].info.parameter_default;
        builder_init(&scene->builder, &filled);
        rows[i].build(&scene->builder);
        if (scene->builder.failed)
            test_scene_destroy(&scene);
        return scene;
    }
    return NULL;
}

void test_scene_destroy(struct test_scene **scene) {
    if (!scene || !*scene)
        return;
    builder_free(&(*scene)->builder);
    free(*scene);
    *scene = NULL;
}

const pnb_scene *test_scene_get(const struct test_scene *scene) {
    return &scene->builder.scene;
}

const pnb_settings *test_scene_settings(const struct test_scene *scene) {
    return &scene->builder.settings;
}
