/* SPDX-License-Identifier: GPL-3.0-or-later
 * What one can look at behind a shadow: average blocker, width of the penumbra and the shadow map, against what
 * geometry says. A plate lies below a light and above a floor, all of them parallel. */
#include "support.h"

#include "scenes/shapes.h"

#include <math.h>

#define WIDTH  60
#define HEIGHT 40
#define LIGHT  4.0f /* heights */
#define PLATE  1.0f
#define PASSES (PNB_PASS_BLOCKERS | PNB_PASS_PENUMBRAE | PNB_PASS_SHADOW_MAPS)

struct stage {
    pnb_mesh *square;
    pnb_instance instances[2];
    pnb_light light;
    pnb_scene scene;
    pnb_settings settings;
};

static void stage_make(struct stage *stage, pnb_light_type type) {
    *stage = (struct stage){
        .instances = {{.struct_size = sizeof(pnb_instance), .matrix = {3, 0, 0, 0, 0, 3, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}},
                      {.struct_size = sizeof(pnb_instance),
                       .flags = PNB_INSTANCE_HIDDEN_FROM_CAMERA,
                       .matrix = IDENTITY_AT(0, 0, PLATE)}},
        .light = {.struct_size = sizeof(pnb_light),
                  .type = type,
                  .name = "Lamp",
                  .matrix = IDENTITY_AT(0, 0, LIGHT),
                  .emission = {1, 1, 1},
                  .size = {0.5f, 0.5f},
                  .radius = 0.25f,
                  .angle = 0.2f,
                  .spot_angle = 1.5f},
        .scene = {.struct_size = sizeof(pnb_scene),
                  .instance_count = 2,
                  .light_count = 1,
                  .camera = {.struct_size = sizeof(pnb_camera),
                             .projection = PNB_ORTHOGRAPHIC,
                             .window = {-3, 3, -2, 2},
                             .matrix = IDENTITY_AT(0, 0, 5)}},
        .settings = {.struct_size = sizeof(pnb_settings), .width = WIDTH, .height = HEIGHT, .shadow_map_size = 512},
    };
    struct shape square = {0};
    shape_rectangle(&square, -1, -1, 1, 1, 0);
    stage->square = shape_finish(&square, "square");
    CHECK(stage->square != NULL);
    stage->instances[0].mesh = stage->instances[1].mesh = stage->square;
    stage->scene.instances = stage->instances;
    stage->scene.lights = &stage->light;
}

static const float *pixels_of(const pnb_job *job, const char *name) {
    pnb_image image = PNB_INIT(pnb_image);
    for (uint32_t i = 0; i < pnb_job_image_count(job); ++i)
        if (pnb_job_get_image(job, i, &image) == PNB_OK && strcmp(image.name, name) == 0)
            return image.pixels;
    CHECK_CONTAINS("", name);
    return NULL;
}

/* Where the floor is in full shadow or in none, whatever the light: the plate's shadow ends at 1.34, its penumbra lies
 * within 0.1 of that. */
static bool is_dark(float x, float y) {
    return fabsf(x) < 0.85f && fabsf(y) < 0.85f;
}
static bool is_lit(float x, float y) {
    return fabsf(x) > 1.6f || fabsf(y) > 1.6f;
}

/* Metres to the plate along the ray from the light to a point of the floor. */
static float expected_blocker(pnb_light_type type, float x, float y) {
    return type == PNB_LIGHT_SUN ? 0 : sqrtf(x * x + y * y + LIGHT * LIGHT) * (LIGHT - PLATE) / LIGHT;
}

static float expected_width(pnb_light_type type, float x, float y) {
    const float across =
        sqrtf(x * x + y * y + LIGHT * LIGHT) / LIGHT; /* a disk that faces the receiver is foreshortened */
    if (type == PNB_LIGHT_SUN)
        return 2 * tanf(0.1f) * PLATE;
    return 0.5f * PLATE / (LIGHT - PLATE) * (type == PNB_LIGHT_AREA ? 1 : across);
}

static void check_pixels(const pnb_job *job, pnb_light_type type) {
    const float *blocker = pixels_of(job, "Blocker.Lamp"), *width = pixels_of(job, "Penumbra.Lamp");
    double blocker_error = 0, width_error = 0, lit = 0;
    int dark = 0;
    for (int i = 0; i < WIDTH * HEIGHT && blocker && width; ++i) {
        const float x = ((float)(i % WIDTH) + 0.5f) / 10 - 3, y = ((float)(i / WIDTH) + 0.5f) / 10 - 2;
        if (is_lit(x, y))
            lit = fmax(lit, fmax((double)blocker[i], (double)width[i]));
        if (!is_dark(x, y))
            continue;
        ++dark;
        blocker_error = fmax(blocker_error, fabs((double)(blocker[i] - expected_blocker(type, x, y))));
        width_error = fmax(width_error, fabs((double)(width[i] / expected_width(type, x, y) - 1)));
    }
    printf("type %d: %d pixels in the umbra, blocker off by %.2g m, width by %.2g of itself; where lit %g\n", (int)type,
           dark, blocker_error, width_error, lit);
    CHECK(dark > 100);
    /* The near end of a SUN's map lies a little before the first caster. */
    CHECK_AT_MOST(blocker_error, type == PNB_LIGHT_SUN ? 0.02 : 1e-4);
    CHECK_AT_MOST(width_error,
                  type == PNB_LIGHT_AREA || type == PNB_LIGHT_SUN ? 1e-4 : 0.05); /* tilted: to first order */
    CHECK_NEAR(lit, 0, 0);
}

/* The plate in the middle, nothing or the floor around it, and nothing beside the square map. */
static void check_map(const pnb_job *job, pnb_light_type type) {
    const float *map = pixels_of(job, "Map.Lamp");
    const float middle = map[HEIGHT / 2 * WIDTH + WIDTH / 2], edge = map[0];
    const int beside = type == PNB_LIGHT_POINT ? 0 : WIDTH * HEIGHT - HEIGHT * HEIGHT;
    int outside = 0;
    for (int i = 0; i < WIDTH * HEIGHT; ++i)
        outside += map[i] < 0;
    printf("type %d: map %g in its middle, %g at the corner, %d pixels beside it\n", (int)type, (double)middle,
           (double)edge, outside);
    if (type != PNB_LIGHT_POINT) {
        CHECK(middle >= 0 && middle < 0.5f);
        CHECK_NEAR((double)edge, -1, 0);
        CHECK_INT(outside, beside);
    }
}

static uint64_t hash(const pnb_job *job, const char *name) {
    const float *pixels = pixels_of(job, name);
    uint64_t sum = 14695981039346656037u;
    for (size_t i = 0; i < sizeof(float) * WIDTH * HEIGHT; ++i)
        sum = (sum ^ ((const unsigned char *)pixels)[i]) * 1099511628211u;
    return sum;
}

static void every_technique_shows_the_same(pnb_context *context, struct stage *stage) {
    uint64_t first[3] = {0};
    static const char *const names[] = {"Blocker.Lamp", "Penumbra.Lamp", "Map.Lamp"};
    for (uint32_t t = 0; t < pnb_technique_count(); ++t) {
        pnb_technique_info info = PNB_INIT(pnb_technique_info);
        pnb_job *job = NULL;
        pnb_technique_get_info(t, &info);
        stage->settings.technique = info.id;
        stage->settings.passes = PASSES;
        stage->settings.light_samples = 2;
        CHECK_RESULT(pnb_render(context, &stage->scene, &stage->settings, &job), PNB_OK);
        for (int i = 0; i < 3 && job; ++i) {
            first[i] = t ? first[i] : hash(job, names[i]);
            CHECK(hash(job, names[i]) == first[i]);
        }
        pnb_job_destroy(&job);
    }
}

/* Passes to look at leave the others as they are. */
static void others_stay(pnb_context *context, struct stage *stage) {
    pnb_job *with = NULL, *without = NULL;
    stage->settings.technique = "PCSS";
    stage->settings.samples = 5;
    stage->settings.passes = PNB_PASS_DEPTH | PNB_PASS_COMBINED;
    CHECK_RESULT(pnb_render(context, &stage->scene, &stage->settings, &without), PNB_OK);
    stage->settings.passes |= PASSES;
    CHECK_RESULT(pnb_render(context, &stage->scene, &stage->settings, &with), PNB_OK);
    const float *a = pixels_of(with, "Combined"), *b = pixels_of(without, "Combined");
    CHECK_INT(memcmp(a, b, sizeof(float) * 4 * WIDTH * HEIGHT), 0);
    pnb_job_destroy(&with);
    pnb_job_destroy(&without);
}

int main(void) {
    pnb_context *context = NULL;
    if (create_context(NULL, &context) != PNB_OK) {
        printf("skipped: %s\n", pnb_last_error());
        return CHECK_SKIPPED;
    }
    for (int type = PNB_LIGHT_AREA; type <= PNB_LIGHT_SUN; ++type) {
        struct stage stage;
        pnb_job *job = NULL;
        stage_make(&stage, (pnb_light_type)type);
        stage.settings.passes = PASSES;
        CHECK_RESULT(pnb_render(context, &stage.scene, &stage.settings, &job), PNB_OK);
        check_pixels(job, (pnb_light_type)type);
        check_map(job, (pnb_light_type)type);
        pnb_job_destroy(&job);
        if (type == PNB_LIGHT_AREA) {
            every_technique_shows_the_same(context, &stage);
            others_stay(context, &stage);
        }
        pnb_mesh_destroy(&stage.square);
    }
    pnb_context_destroy(&context);
    CHECK_INT(memory_live_blocks(), 0);
    return check_report();
}
