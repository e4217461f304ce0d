/* SPDX-License-Identifier: GPL-3.0-or-later
 * A shadow starts where its caster stands: no light under a box on a floor, at 1280 x 720 with a map of 1024 texels, for
 * every technique and every kind of light. */
#include "oracle.h"
#include "quality.h"

/* The part of the image around the box's base. */
#define X      360
#define Y      170
#define WIDTH  480
#define HEIGHT 300

/* Floor pixels that no point of the light reaches, by brute force. */
static void find_umbra(const struct render *render, const pnb_scene *scene, const pnb_settings *settings, bool *umbra) {
    const double up[3] = {0, 0, 1};
    for (uint32_t y = 0; y < HEIGHT; y++)
        for (uint32_t x = 0; x < WIDTH; x++) {
            double position[3];
            render_position(render, &scene->camera, settings, x, y, position);
            umbra[y * WIDTH + x] = render_covers(render, y * WIDTH + x) && fabs(position[2]) < 1e-3 &&
                                   oracle_light(scene->lights, position, up, 6, box_blocks,
                                                scene->instances[1].matrix).visible == 0;
        }
}

/* Lit pixels of the umbra, and those that are the corner of a square of 2 x 2 such: a gap wider than one pixel. */
static void count_gaps(const struct render *render, const bool *umbra, int *lit, int *wide) {
    *lit = *wide = 0;
    for (uint32_t y = 0; y < HEIGHT; y++)
        for (uint32_t x = 0; x < WIDTH; x++) {
            int square = 0;
            for (uint32_t k = 0; k < 4; k++) {
                const uint32_t i = (y + k / 2) * WIDTH + x + k % 2;
                const bool inside = x + k % 2 < WIDTH && y + k / 2 < HEIGHT;
                const bool gap = inside && umbra[i] && render->shadow[3 * i] > 0.5f;
                square += gap;
                *lit += k == 0 && gap;
            }
            *wide += square == 4;
        }
}

static int umbra_size(const bool *umbra) {
    int size = 0;
    for (int i = 0; i < WIDTH * HEIGHT; i++)
        size += umbra[i];
    return size;
}

static void contact(enum test_light light, float height) {
    struct test_scene *test = quality_scene("box", light, 0.3f, height);
    const pnb_scene *scene = test_scene_get(test);
    static bool umbra[WIDTH * HEIGHT];
    for (uint32_t t = 0; t < pnb_technique_count(); t++) {
        pnb_technique_info info = PNB_INIT(pnb_technique_info);
        CHECK_RESULT(pnb_technique_get_info(t, &info), PNB_OK);
        pnb_settings settings = quality_settings(info.id, 1280, 720);
        const uint32_t crop[4] = {X, Y, WIDTH, HEIGHT};
        memcpy(settings.crop, crop, sizeof crop);
        settings.passes = PNB_PASS_DEPTH | PNB_PASS_SHADOW;
        settings.light_samples = 3;
        struct render render = quality_render(scene, &settings);
        if (!render.job)
            continue;
        if (t == 0)
            find_umbra(&render, scene, &settings, umbra);
        int lit, wide;
        count_gaps(&render, umbra, &lit, &wide);
        printf("%-9s box %.2f m high under %-9s umbra of %d pixels, %d lit, %d in gaps wider than 1 pixel\n", info.id,
               (double)height, test_light_names[light], umbra_size(umbra), lit, wide);
        CHECK(umbra_size(umbra) > 500);
        CHECK_INT(wide, 0);
        char name[64];
        snprintf(name, sizeof name, "contact-%s-%s-%.0f", info.id, test_light_names[light], (double)height * 100);
        quality_show(name, render.shadow, 3, WIDTH, HEIGHT);
        render_free(&render);
    }
    test_scene_destroy(&test);
}

int main(void) {
    quality_open();
    for (int light = 0; light < TEST_LIGHT_COUNT; light++) {
        contact((enum test_light)light, 1);
        contact((enum test_light)light, 0.2f);
    }
    return quality_close();
}
