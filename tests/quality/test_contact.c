/* SPDX-License-Identifier: GPL-3.0-or-later
 * A shadow starts where its caster stands: no light under a box on a floor, at 1280 x 720 with a map of 1024 texels,
 * for every technique and every kind of light. */
#include "oracle.h"
#include "quality.h"

/* The part of the image around the box's base. */
#define X      360
#define Y      170
#define WIDTH  480
#define HEIGHT 300

enum region { OTHER, UMBRA, LIT };

/* Floor pixels that no point of the light reaches, and those that all reach, by brute force. */
static void find_regions(const struct render *render, const pnb_scene *scene, const pnb_settings *settings,
                         enum region *regions) {
    const double up[3] = {0, 0, 1};
    for (uint32_t y = 0; y < HEIGHT; y++)
        for (uint32_t x = 0; x < WIDTH; x++) {
            double position[3];
            render_position(render, &scene->camera, settings, x, y, position);
            const bool floor = render_covers(render, y * WIDTH + x) && fabs(position[2]) < 1e-3;
            const double visible =
                floor ? oracle_light(scene->lights, position, up, 6, box_blocks, scene->instances[1].matrix).visible
                      : 0.5;
            regions[y * WIDTH + x] = visible == 0 ? UMBRA : visible > 0.9999 ? LIT : OTHER;
        }
}

/* Pixels of a region that are wrong, and those that are the corner of a square of 2 x 2 such: of a line of them wider
 * than one pixel. */
struct wrong {
    int region, pixels, wide;
};

static bool is_wrong(const struct render *render, const enum region *regions, enum region region, uint32_t x,
                     uint32_t y) {
    const uint32_t i = y * WIDTH + x;
    return x < WIDTH && y < HEIGHT && regions[i] == region && (render->shadow[3 * i] > 0.5f) == (region == UMBRA);
}

static struct wrong count_wrong(const struct render *render, const enum region *regions, enum region region) {
    struct wrong wrong = {0};
    for (uint32_t y = 0; y < HEIGHT; y++)
        for (uint32_t x = 0; x < WIDTH; x++) {
            int square = 0;
            for (uint32_t k = 0; k < 4; k++)
                square += is_wrong(render, regions, region, x + k % 2, y + k / 2);
            wrong.region += regions[y * WIDTH + x] == region;
            wrong.pixels += is_wrong(render, regions, region, x, y);
            wrong.wide += square == 4;
        }
    return wrong;
}

static void contact(enum test_light light, float height) {
    struct test_scene *test = quality_scene("box", light, 0.3f, height);
    const pnb_scene *scene = test_scene_get(test);
    static enum region regions[WIDTH * HEIGHT];
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
            find_regions(&render, scene, &settings, regions);
        const struct wrong gap = count_wrong(&render, regions, UMBRA), line = count_wrong(&render, regions, LIT);
        printf("%-9s box %.2f m high under %-9s umbra of %d pixels, %d lit, %d in gaps wider than 1 pixel; of %d lit "
               "pixels "
               "%d dark, %d in lines wider than 1 pixel\n",
               info.id, (double)height, test_light_names[light], gap.region, gap.pixels, gap.wide, line.region,
               line.pixels, line.wide);
        CHECK(gap.region > 500 && line.region > 500);
        CHECK_INT(gap.wide, 0);
        CHECK_INT(line.wide, 0);
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
