/* SPDX-License-Identifier: GPL-3.0-or-later
 * What instances, materials and lights may be told: not to cast, not to receive, not to be seen; alpha; and matrices
 * that mirror or flatten. */
#include "quality.h"
#include "scene_builder.h"

#define SIDE    128
#define FLOOR_Z 1e-3

/* A floor of 12 m under a lamp 4 m above it and slightly aside, seen from straight above; casters are added to it. */
struct stage {
    struct scene_builder builder;
    struct render render;
};

static struct stage *stage_create(enum test_light light) {
    struct stage *stage = calloc(1, sizeof *stage);
    if (!stage)
        exit(1);
    builder_init(&stage->builder, &(struct test_scene_options){.light = light});
    struct shape shape = {0};
    shape_rectangle(&shape, -6, -6, 6, 6, 0);
    builder_instance(&stage->builder, builder_mesh(&stage->builder, &shape, "floor"), MATERIAL_WHITE,
                     (struct placement){0});
    builder_key_light(&stage->builder, (const float[3]){0.5f, 0.2f, 4}, (const float[3]){0, 0, 0}, 0.5f);
    builder_camera_above(&stage->builder, 4);
    return stage;
}

static void stage_destroy(struct stage **stage) {
    render_free(&(*stage)->render);
    builder_free(&(*stage)->builder);
    free(*stage);
    *stage = NULL;
}

static const pnb_mesh *box_mesh(struct stage *stage) {
    struct shape shape = {0};
    shape_box(&shape, (const float[3]){-0.5f, -0.5f, 0}, (const float[3]){0.5f, 0.5f, 1});
    return builder_mesh(&stage->builder, &shape, "box");
}

/* 0.8 x 0.8 m and 0.3 m high, 0.6 m above the floor. */
static pnb_instance *add_box(struct stage *stage) {
    return builder_instance(&stage->builder, box_mesh(stage), MATERIAL_RED,
                            (struct placement){.position = {0, 0, 0.6f}, .scale = {0.8f, 0.8f, 0.3f}});
}

static void stage_render(struct stage *stage) {
    CHECK(!stage->builder.failed);
    pnb_settings settings = quality_settings("PCSS", SIDE, SIDE);
    settings.shadow_map_size = 512;
    settings.passes |= PNB_PASS_COMBINED;
    stage->render = quality_render(&stage->builder.scene, &settings);
}

/* The camera is 50 m above the floor. */
static bool is_floor(const struct stage *stage, size_t pixel) {
    return fabs((double)stage->render.depth[pixel] - 50) < FLOOR_Z;
}

/* Mean visibility over the floor, or what is above it. */
static double mean_visibility(const struct stage *stage, bool floor) {
    double sum = 0, count = 0;
    for (size_t i = 0; stage->render.job && i < SIDE * SIDE; i++)
        if (is_floor(stage, i) == floor) {
            sum += (double)stage->render.shadow[3 * i];
            count++;
        }
    return count > 0 ? sum / count : NAN;
}

/* Root of the mean squared difference over pixels that are floor in both. */
static double floor_difference(const struct stage *a, const struct stage *b) {
    double sum = 0, count = 0;
    for (size_t i = 0; a->render.job && b->render.job && i < SIDE * SIDE; i++)
        if (is_floor(a, i) && is_floor(b, i)) {
            const double difference = (double)a->render.shadow[3 * i] - (double)b->render.shadow[3 * i];
            sum += difference * difference;
            count++;
        }
    return count > 0 ? sqrt(sum / count) : NAN;
}

static int floor_pixels(const struct stage *stage) {
    int count = 0;
    for (size_t i = 0; stage->render.job && i < SIDE * SIDE; i++)
        count += is_floor(stage, i);
    return count;
}

/* A post beside the box, higher than it, so that the camera must look that high. It casts no shadow. */
static void add_post(struct stage *stage) {
    struct placement corner = {.position = {1.7f, 1.7f, 0}, .scale = {0.2f, 0.2f, 1.2f}};
    builder_instance(&stage->builder, box_mesh(stage), MATERIAL_BLUE, corner)->flags = PNB_INSTANCE_NO_SHADOW;
}

static void instance_flags(enum test_light light) {
    struct stage *plain = stage_create(light), *no_shadow = stage_create(light), *hidden = stage_create(light),
                 *no_receive = stage_create(light), *bare = stage_create(light);
    add_box(plain);
    add_box(no_shadow)->flags = PNB_INSTANCE_NO_SHADOW;
    add_box(hidden)->flags = PNB_INSTANCE_HIDDEN_FROM_CAMERA;
    add_box(no_receive);
    no_receive->builder.instances[0].flags = PNB_INSTANCE_NO_RECEIVE;
    struct stage *stages[] = {plain, no_shadow, hidden, no_receive, bare};
    for (int i = 0; i < 5; i++) {
        add_post(stages[i]);
        stage_render(stages[i]);
    }
    printf("%-9s box on its own: floor %.4f; NO_SHADOW %.4f; NO_RECEIVE floor %.4f; HIDDEN_FROM_CAMERA %d of %d floor "
           "pixels, off by %.4f\n",
           test_light_names[light], mean_visibility(plain, true), mean_visibility(no_shadow, true),
           mean_visibility(no_receive, true), floor_pixels(hidden), floor_pixels(bare),
           floor_difference(plain, hidden));
    CHECK_AT_MOST(mean_visibility(plain, true), 0.995);
    CHECK(mean_visibility(no_shadow, true) == 1);
    CHECK_INT(floor_pixels(no_shadow), floor_pixels(plain));
    CHECK(mean_visibility(no_receive, true) == 1);
    CHECK_INT(floor_pixels(hidden), floor_pixels(bare));
    CHECK(floor_pixels(plain) < floor_pixels(bare));
    /* The map may be fitted a little differently, when the box is no receiver. */
    CHECK_AT_MOST(floor_difference(plain, hidden), 0.01);
    for (int i = 0; i < 5; i++)
        stage_destroy(&stages[i]);
}

/* A receiver that is told not to receive still casts, and the others still receive. */
static void no_receive_is_for_one(void) {
    struct stage *stage = stage_create(TEST_LIGHT_RECTANGLE);
    add_box(stage)->flags = PNB_INSTANCE_NO_RECEIVE;
    struct placement above = {.position = {0.1f, 0, 1.5f}, .scale = {0.4f, 0.4f, 0.1f}};
    builder_instance(&stage->builder, box_mesh(stage), MATERIAL_BLUE, above)->flags = PNB_INSTANCE_HIDDEN_FROM_CAMERA;
    stage_render(stage);
    const double not_receiving = mean_visibility(stage, false);
    stage->builder.instances[1].flags = 0;
    render_free(&stage->render);
    stage_render(stage);
    printf("a box below a smaller one: %.4f with NO_RECEIVE, else %.4f; floor %.4f\n", not_receiving,
           mean_visibility(stage, false), mean_visibility(stage, true));
    CHECK(not_receiving == 1);
    CHECK_AT_MOST(mean_visibility(stage, false), 0.9);
    CHECK_AT_MOST(mean_visibility(stage, true), 0.995);
    stage_destroy(&stage);
}

static void light_flag(void) {
    struct stage *stage = stage_create(TEST_LIGHT_SPOT);
    add_box(stage);
    stage->builder.lights[0].flags = PNB_LIGHT_NO_SHADOW;
    stage_render(stage);
    printf("NO_SHADOW light: floor %.4f\n", mean_visibility(stage, true));
    CHECK(mean_visibility(stage, true) == 1);
    CHECK(stage->render.combined && stage->render.combined[4 * (SIDE / 2)] > 0.1f);
    stage_destroy(&stage);
}

/* What is reflected at the middle of the picture, on the box. */
static double middle_light(const struct stage *stage) {
    return stage->render.combined ? (double)stage->render.combined[4 * (SIDE / 2 * SIDE + SIDE / 2)] : NAN;
}

/* A box and the floor under two lamps, the second of twice the first's light at the same place: what each lights and is
 * shadowed by. */
static void links(void) {
    static const uint64_t bits[] = {0, 1, 2, 3};
    double light[4];
    for (int i = 0; i < 4; i++) {
        struct stage *stage = stage_create(TEST_LIGHT_POINT);
        memset(stage->builder.scene.world_color, 0, sizeof stage->builder.scene.world_color);
        pnb_light *second =
            builder_key_light(&stage->builder, (const float[3]){0.5f, 0.2f, 4}, (const float[3]){0, 0, 0}, 0.5f);
        for (int c = 0; c < 3; c++)
            second->emission[c] = 2 * stage->builder.lights[0].emission[c];
        add_box(stage)->unlit_by = bits[i];
        stage_render(stage);
        light[i] = middle_light(stage);
        CHECK_AT_MOST(mean_visibility(stage, true), 0.995); /* what is unlit casts its shadow */
        if (i == 0) {
            stage->builder.instances[1].unshadowed_by = 3;
            render_free(&stage->render);
            stage_render(stage);
            CHECK(mean_visibility(stage, true) == 1);
        }
        stage_destroy(&stage);
    }
    printf("box lit by two lamps %.4f, without the first %.4f, the second %.4f, both %.4f\n", light[0], light[1],
           light[2], light[3]);
    CHECK_AT_MOST(0.1, light[0]);
    CHECK_NEAR(light[1], light[0] * 2 / 3, 1e-3);
    CHECK_NEAR(light[2], light[0] / 3, 1e-3);
    CHECK(light[3] == 0);
}

/* ---- Alpha ---- */

/* A sheet from -x to x whose alpha texture is opaque on the left and clear on the right. Interpolated between texels 31
 * and 32, alpha is one half exactly in the middle. channels 1: its grey is the alpha. */
static void add_half_clear_sheet(struct stage *stage, uint32_t channels, pnb_texture **texture) {
    static const float positions[] = {-3, -3, 1, 3, -3, 1, 3, 3, 1, -3, 3, 1}, uvs[] = {0, 0, 1, 0, 1, 1, 0, 1};
    static const uint32_t triangles[] = {0, 1, 2, 0, 2, 3};
    pnb_mesh_desc desc = PNB_INIT(pnb_mesh_desc);
    desc.vertex_count = desc.corner_count = 4;
    desc.triangle_count = 2;
    desc.positions.data = positions;
    desc.corner_uvs.data = uvs;
    desc.triangles.data = triangles;
    struct scene_builder *builder = &stage->builder;
    CHECK_RESULT(pnb_mesh_create(&desc, &builder->meshes[builder->mesh_count++]), PNB_OK);
    float pixels[64 * 4];
    for (uint32_t i = 0; i < 64; i++)
        for (uint32_t c = 0; c < channels; c++)
            pixels[i * channels + c] = channels == 4 && c < 3 ? 0.5f : i < 32 ? 1.0f : 0.0f;
    pnb_texture_desc image = PNB_INIT(pnb_texture_desc);
    image.width = 64;
    image.height = 1;
    image.channels = channels;
    image.pixels.data = pixels;
    CHECK_RESULT(pnb_texture_create(&image, texture), PNB_OK);
    builder->materials[MATERIAL_GREEN].alpha_texture = *texture;
    builder_instance(builder, builder->meshes[builder->mesh_count - 1], MATERIAL_GREEN, (struct placement){0})->flags =
        PNB_INSTANCE_HIDDEN_FROM_CAMERA;
}

static void alpha(void) {
    struct stage *cut = stage_create(TEST_LIGHT_RECTANGLE);
    struct shape shape = {0};
    shape_rectangle(&shape, -3, -3, 0, 3, 1);
    builder_instance(&cut->builder, builder_mesh(&cut->builder, &shape, "half"), MATERIAL_GREEN, (struct placement){0})
        ->flags = PNB_INSTANCE_HIDDEN_FROM_CAMERA;
    stage_render(cut);
    for (uint32_t channels = 1; channels <= 4; channels += 3) {
        struct stage *textured = stage_create(TEST_LIGHT_RECTANGLE);
        pnb_texture *texture = NULL;
        add_half_clear_sheet(textured, channels, &texture);
        stage_render(textured);
        printf("sheet half clear by a texture of %u channels: floor %.4f, off a sheet half as wide by %.4f\n", channels,
               mean_visibility(textured, true), floor_difference(textured, cut));
        CHECK_AT_MOST(floor_difference(textured, cut), 0.02); /* the edge may move by a texel of the map */
        CHECK_NEAR(mean_visibility(textured, true), mean_visibility(cut, true), 2e-3);
        pnb_texture_destroy(&texture);
        stage_destroy(&textured);
    }
    stage_destroy(&cut);
    struct stage *clear = stage_create(TEST_LIGHT_RECTANGLE);
    add_box(clear);
    clear->builder.materials[MATERIAL_RED].transparency = 1;
    stage_render(clear);
    printf("a wholly transparent box: floor %.4f\n", mean_visibility(clear, true));
    CHECK(mean_visibility(clear, true) == 1);
    stage_destroy(&clear);
}

/* ---- Culling ---- */

/* Mean visibility of the floor under a sheet whose back faces cast no shadow; unscaled its front is up. */
static double under_one_sided_sheet(enum test_light light, float scale_x, float scale_z) {
    struct stage *stage = stage_create(light);
    struct shape shape = {0};
    shape_rectangle(&shape, -0.5f, -0.5f, 0.5f, 0.5f, 0);
    pnb_instance *sheet = builder_instance(&stage->builder, builder_mesh(&stage->builder, &shape, "sheet"),
                                           MATERIAL_GREEN, (struct placement){.position = {0, 0, 1}});
    sheet->flags = PNB_INSTANCE_HIDDEN_FROM_CAMERA;
    sheet->matrix[0] *= scale_x;
    sheet->matrix[10] *= scale_z;
    stage->builder.materials[MATERIAL_GREEN].flags = PNB_MATERIAL_CULL_SHADOW;
    stage_render(stage);
    const double visibility = mean_visibility(stage, true);
    stage_destroy(&stage);
    return visibility;
}

/* Seen from the light. The front goes with the sheet: mirrored along x it is still up, along z it is down. */
static void back_faces_are_culled(enum test_light light) {
    const double front = under_one_sided_sheet(light, 1, 1), mirror = under_one_sided_sheet(light, -1, 1);
    const double back = under_one_sided_sheet(light, 1, -1), turned = under_one_sided_sheet(light, -1, -1);
    printf("%-9s one-sided sheet: floor %.4f and %.4f under its front, %.4f and %.4f under its back\n",
           test_light_names[light], front, mirror, back, turned);
    CHECK_AT_MOST(front, 0.995);
    CHECK_NEAR(mirror, front, 1e-6); /* the same triangles */
    CHECK(back == 1);
    CHECK(turned == 1);
}

/* ---- Matrices ---- */

static void mirrored(void) {
    struct stage *plain = stage_create(TEST_LIGHT_ELLIPSE), *mirror = stage_create(TEST_LIGHT_ELLIPSE);
    add_box(plain);
    pnb_instance *box = add_box(mirror);
    for (int i = 0; i < 4; i++)
        box->matrix[i] = -box->matrix[i];
    stage_render(plain);
    stage_render(mirror);
    const double difference = render_rmse(&plain->render, &mirror->render);
    double shading = 0;
    for (size_t i = 0; i < 4 * SIDE * SIDE && plain->render.job && mirror->render.job; i++)
        shading = fmax(shading, fabs((double)plain->render.combined[i] - (double)mirror->render.combined[i]));
    printf("mirrored box: visibility off by %.2g, Combined by up to %.2g\n", difference, shading);
    CHECK_AT_MOST(difference, 1e-6); /* the same triangles, wound the other way */
    CHECK_AT_MOST(shading, 1e-4);
    stage_destroy(&plain);
    stage_destroy(&mirror);
}

/* Through a mirrored camera: the same picture from right to left, with the front faces that it had. */
static void mirrored_camera(void) {
    struct stage *plain = stage_create(TEST_LIGHT_ELLIPSE), *mirror = stage_create(TEST_LIGHT_ELLIPSE);
    for (int i = 0; i < 2; i++) {
        struct stage *stage = i == 0 ? plain : mirror;
        add_box(stage)->matrix[12] = 0.7f;
        stage->builder.materials[MATERIAL_RED].flags |= PNB_MATERIAL_CULL_CAMERA;
    }
    for (int i = 0; i < 3; i++)
        mirror->builder.scene.camera.matrix[i] *= -1;
    stage_render(plain);
    stage_render(mirror);
    double difference = 0;
    for (size_t i = 0; i < 4 * SIDE * SIDE && plain->render.job && mirror->render.job; i++) {
        const size_t column = i / 4 % SIDE, opposite = i + 4 * (SIDE - 1) - 8 * column;
        difference = fmax(difference,
                          fabs((double)plain->render.combined[i] - (double)mirror->render.combined[opposite]));
    }
    printf("mirrored camera: %d of %d pixels of floor, Combined off by up to %.2g\n", floor_pixels(mirror),
           floor_pixels(plain), difference);
    CHECK_INT(floor_pixels(mirror), floor_pixels(plain));
    CHECK_AT_MOST(difference, 1e-4);
    stage_destroy(&plain);
    stage_destroy(&mirror);
}

static void flattened(void) {
    struct stage *sheet = stage_create(TEST_LIGHT_ELLIPSE), *flat = stage_create(TEST_LIGHT_ELLIPSE);
    struct shape shape = {0};
    shape_rectangle(&shape, -0.4f, -0.4f, 0.4f, 0.4f, 0.6f);
    builder_instance(&sheet->builder, builder_mesh(&sheet->builder, &shape, "sheet"), MATERIAL_RED,
                     (struct placement){0});
    pnb_instance *box = add_box(flat);
    for (int i = 8; i < 12; i++)
        box->matrix[i] = 0;
    stage_render(sheet);
    stage_render(flat);
    printf("box scaled to a sheet: floor %.4f, off that of a sheet by %.2g\n", mean_visibility(flat, true),
           floor_difference(flat, sheet));
    CHECK_AT_MOST(floor_difference(flat, sheet), 1e-6);
    render_free(&flat->render);
    for (int i = 0; i < 12; i++)
        box->matrix[i] = 0;
    stage_render(flat);
    printf("box scaled to a point: floor %.4f\n", mean_visibility(flat, true));
    CHECK(mean_visibility(flat, true) == 1);
    stage_destroy(&sheet);
    stage_destroy(&flat);
}

int main(void) {
    quality_open();
    for (int light = 0; light < TEST_LIGHT_COUNT; light++) {
        instance_flags((enum test_light)light);
        back_faces_are_culled((enum test_light)light);
    }
    no_receive_is_for_one();
    light_flag();
    links();
    alpha();
    mirrored();
    mirrored_camera();
    flattened();
    return quality_close();
}
