/* SPDX-License-Identifier: GPL-3.0-or-later
 * Crops: the same pixels as those of the full image, bit by bit, for any rectangle, camera, technique and number of
 * anti-aliasing samples. */
#include "quality.h"

#define CROPS 20

static uint32_t random_state = 1;

static uint32_t random_below(uint32_t limit) {
    random_state = random_state * 1664525u + 1013904223u;
    return (random_state >> 8) % limit;
}

/* Any rectangle of the image, single pixels, single rows and the whole among them. */
static void random_crop(int index, uint32_t width, uint32_t height, uint32_t crop[4]) {
    crop[2] = index == 1 ? width : 1 + random_below(index < 5 ? 3 : width);
    crop[3] = index == 2 ? height : 1 + random_below(index < 5 ? 3 : height);
    crop[0] = random_below(width - crop[2] + 1);
    crop[1] = random_below(height - crop[3] + 1);
}

/* Pixels of any pass that differ from the full image's. */
static int different_pixels(const struct render *full, const struct render *part, const uint32_t crop[4]) {
    int different = 0;
    for (uint32_t i = 0; i < pnb_job_image_count(full->job); i++) {
        pnb_image whole = PNB_INIT(pnb_image), cut = PNB_INIT(pnb_image);
        if (!CHECK_RESULT(pnb_job_get_image(full->job, i, &whole), PNB_OK) ||
            !CHECK_RESULT(pnb_job_get_image(part->job, i, &cut), PNB_OK) || !CHECK_STRING(cut.name, whole.name) ||
            !CHECK_INT(cut.width, crop[2]) || !CHECK_INT(cut.height, crop[3]))
            return -1;
        const size_t row_bytes = sizeof(float) * cut.channels * cut.width;
        for (uint32_t y = 0; y < cut.height; y++) {
            const float *expected = whole.pixels + ((size_t)(y + crop[1]) * whole.width + crop[0]) * whole.channels;
            different += memcmp(cut.pixels + (size_t)y * cut.width * cut.channels, expected, row_bytes) != 0;
        }
    }
    return different;
}

/* parameter: one to switch on, or NULL. */
static void crops(const char *scene_name, enum test_light light, const char *technique, uint32_t samples,
                  const char *parameter) {
    struct test_scene *test = quality_scene(scene_name, light, 0, NAN);
    const pnb_scene *scene = test_scene_get(test);
    pnb_settings settings = quality_scene_settings(technique, test, 101);
    settings.samples = samples;
    const pnb_value on = {parameter, 1};
    settings.values = &on;
    settings.value_count = parameter ? 1 : 0;
    settings.light_samples = 2;
    settings.shadow_map_size = 256;
    settings.passes = PNB_PASS_COMBINED | PNB_PASS_DEPTH | PNB_PASS_NORMAL | PNB_PASS_SHADOW | PNB_PASS_LIGHT_SHADOWS;
    struct render full = quality_render(scene, &settings);
    int different = 0;
    for (int i = 0; i < CROPS && full.job; i++) {
        random_crop(i, settings.width, settings.height, settings.crop);
        struct render part = quality_render(scene, &settings);
        const int rows = part.job ? different_pixels(&full, &part, settings.crop) : -1;
        if (!CHECK_INT(rows, 0))
            printf("  crop %u,%u %u x %u\n", settings.crop[0], settings.crop[1], settings.crop[2], settings.crop[3]);
        different += rows != 0;
        render_free(&part);
    }
    printf("%-9s %s, %s, %s camera, %u samples: %d crops of %u x %u, %d differ\n", technique, scene_name,
           test_light_names[light], scene->camera.projection == PNB_PERSPECTIVE ? "perspective" : "orthographic",
           samples, CROPS, settings.width, settings.height, different);
    render_free(&full);
    test_scene_destroy(&test);
}

/* A larger image than what is listed at once of pixels that are not interpolated (pixel_list.c): 576 rows at a time. */
static void rows_of_lists(void) {
    struct test_scene *test = quality_scene("lantern", TEST_LIGHT_RECTANGLE, 0, NAN);
    pnb_settings settings = quality_scene_settings("MULTILAYER", test, 1024);
    const pnb_value on = {"subsampling", 1};
    settings.values = &on;
    settings.value_count = 1;
    settings.shadow_map_size = 64;
    struct render full = quality_render(test_scene_get(test), &settings);
    memcpy(settings.crop, (uint32_t[4]){0, 500, 1024, 200}, sizeof settings.crop);
    struct render part = quality_render(test_scene_get(test), &settings);
    if (full.job && part.job)
        CHECK_INT(different_pixels(&full, &part, settings.crop), 0);
    render_free(&full);
    render_free(&part);
    test_scene_destroy(&test);
}

int main(void) {
    quality_open();
    static const char *const techniques[] = {"PCSS", "REFERENCE"};
    for (int i = 0; i < 2; i++)
        for (uint32_t samples = 1; samples <= 3; samples += 2) {
            crops("lantern", TEST_LIGHT_RECTANGLE, techniques[i], samples, NULL);
            crops("stairs", TEST_LIGHT_SUN, techniques[i], samples, NULL);
            crops("slats", TEST_LIGHT_POINT, techniques[i], samples, NULL);
            crops("discs", TEST_LIGHT_ELLIPSE, techniques[i], samples, NULL);
        }
    /* Which interpolates from pixels beside the crop. */
    crops("lantern", TEST_LIGHT_RECTANGLE, "MULTILAYER", 3, "subsampling");
    rows_of_lists();
    return quality_close();
}
