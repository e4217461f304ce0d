/* SPDX-License-Identifier: GPL-3.0-or-later
 * Lamps: what an area light is mounted on, behind its plane, hides none of its light, and must not even be noticed by
 * techniques that look for blockers near the light. */
#include "quality.h"

#define SIDE 192

/* A disc close above the floor under a light so low that its map has five faces; with a lid over the
 * light, or a speck close before it, or nothing. */
enum { NOTHING, LID, SPECK };

static struct render render_lamp(const char *technique, int what) {
    struct test_scene *test = quality_scene("hover", TEST_LIGHT_RECTANGLE, 0.3f, 0.1f);
    pnb_scene scene = *test_scene_get(test);
    pnb_light lamp = scene.lights[0];
    pnb_instance instances[3] = {scene.instances[0], scene.instances[1], scene.instances[1]};
    const float low[16] = {0.4f, 0, 0, 0, 0, 0.4f, 0, 0, 0, 0, 1, 0, 0.4f, 0, 0.1f, 1};
    const float high[16] = {6, 0, 0, 0, 0, 6, 0, 0, 0, 0, 1, 0, 0, 0, 0.305f, 1};
    memcpy(instances[1].matrix, low, sizeof low);
    const float near[16] = {4e-4f, 0, 0, 0, 0, 4e-4f, 0, 0, 0, 0, 1, 0, 0, 0, 0.299f, 1};
    memcpy(instances[2].matrix, what == LID ? high : near, sizeof high);
    lamp.matrix[14] = 0.3f;
    scene.lights = &lamp;
    scene.instances = instances;
    scene.instance_count = what == NOTHING ? 2 : 3;
    pnb_settings settings = quality_settings(technique, SIDE, SIDE);
    settings.shadow_map_size = 256;
    struct render render = quality_render(&scene, &settings);
    test_scene_destroy(&test);
    return render;
}

static void lids(void) {
    for (uint32_t t = 0; t < pnb_technique_count(); t++) {
        pnb_technique_info info = PNB_INIT(pnb_technique_info);
        CHECK_RESULT(pnb_technique_get_info(t, &info), PNB_OK);
        struct render without = render_lamp(info.id, NOTHING), with = render_lamp(info.id, LID);
        int different = 0, dark = 0;
        for (size_t i = 0; without.job && with.job && i < 3 * SIDE * SIDE; i++) {
            different += without.shadow[i] != with.shadow[i];
            dark += without.shadow[i] < 0.5f;
        }
        printf("%-10s %5d values in shadow, a lid over the light changes %d\n", info.id, dark, different);
        CHECK(dark > 300); /* the disc's shadow */
        CHECK_INT(different, 0);
        render_free(&without);
        render_free(&with);
    }
}

/* The kernel of a caster that close is larger than the map. It hides a millionth of the light. */
static void speck(void) {
    struct render without = render_lamp("ESSM", NOTHING), with = render_lamp("ESSM", SPECK);
    const double error = without.job && with.job ? render_rmse(&with, &without) : NAN;
    printf("ESSM, RMSE by a speck before the light: %.4f\n", error);
    CHECK_AT_MOST(error, 0.002); /* .0005; .017 where the search is not cut at the map's border */
    render_free(&without);
    render_free(&with);
}

int main(void) {
    quality_open();
    lids();
    speck();
    return quality_close();
}
