/* SPDX-License-Identifier: GPL-3.0-or-later
 * What MULTILAYER is for: occluders that overlap at different depths, few layers, and wide penumbrae without the texels
 * of coarse levels. test_fragment_lists checks its lists, test_transparency its transparent casters. */
#include "quality.h"

#define HEIGHT 144

static double error_of(const char *scene, const char *technique, double layers, const struct render *truth) {
    struct test_scene *test = quality_scene(scene, TEST_LIGHT_RECTANGLE, 0, NAN);
    pnb_settings settings = quality_scene_settings(technique, test, HEIGHT);
    const pnb_value value = {"depth_layers", layers};
    settings.values = &value;
    settings.value_count = isnan(layers) ? 0u : 1u;
    struct render render = quality_render(test_scene_get(test), &settings);
    const double error = render_rmse(truth, &render);
    render_free(&render);
    test_scene_destroy(&test);
    return error;
}

/* Crossing slats at several heights: one layer is as good as one map, two are all there is. */
static void overlapping_occluders(void) {
    struct test_scene *test = quality_scene("slats", TEST_LIGHT_RECTANGLE, 0, NAN);
    pnb_settings settings = quality_scene_settings("REFERENCE", test, HEIGHT);
    settings.light_samples = 10;
    struct render truth = quality_render(test_scene_get(test), &settings);
    const double pcss = error_of("slats", "PCSS", NAN, &truth), one = error_of("slats", "MULTILAYER", 1, &truth);
    const double two = error_of("slats", "MULTILAYER", 2, &truth), all = error_of("slats", "MULTILAYER", 0, &truth);
    printf("slats: PCSS %.4f, MULTILAYER with one layer %.4f, two %.4f, all %.4f\n", pcss, one, two, all);
    CHECK_AT_MOST(all, 0.6 * pcss); /* the aim */
    CHECK_AT_MOST(two, all + 1e-6);
    CHECK(one > 1.5 * two); /* the lower slats are lost where the upper hide them from the light's centre */
    render_free(&truth);
    test_scene_destroy(&test);
}

/* Error in a wide penumbra on a plane. The texels of a MIP map are then as wide as the penumbra, so that a shadow lies
 * where they do; those of a Y-map are not. */
static double wide_penumbra(double pyramid, const struct render *truth) {
    struct test_scene *test = quality_scene("half-plane", TEST_LIGHT_RECTANGLE, 2, NAN);
    pnb_settings settings = quality_scene_settings("MULTILAYER", test, HEIGHT);
    const pnb_value value = {"pyramid", pyramid};
    settings.values = &value;
    settings.value_count = 1;
    struct render render = quality_render(test_scene_get(test), &settings);
    const double error = render_rmse(truth, &render);
    if (render.job)
        quality_show(pyramid > 0 ? "multilayer-y-map" : "multilayer-mip-map", render.shadow, 3, render.width,
                     render.height);
    render_free(&render);
    test_scene_destroy(&test);
    return error;
}

static void y_map_has_no_texels(void) {
    struct test_scene *test = quality_scene("half-plane", TEST_LIGHT_RECTANGLE, 2, NAN);
    pnb_settings settings = quality_scene_settings("REFERENCE", test, HEIGHT);
    settings.light_samples = 10;
    struct render truth = quality_render(test_scene_get(test), &settings);
    const double mip = wide_penumbra(0, &truth), y = wide_penumbra(1, &truth);
    printf("wide penumbra: error %.4f with a MIP map, %.4f with a Y-map\n", mip, y);
    CHECK_AT_MOST(y, 0.6 * mip); /* 0.52 on llvmpipe: the rest is the shape of the filter, which both have */
    render_free(&truth);
    test_scene_destroy(&test);
}

/* Bytes of the lists, and the error, with all faces or only back faces. */
static double fragment_bytes(double faces, const struct render *truth, double *error) {
    struct test_scene *test = quality_scene("tall-box", TEST_LIGHT_RECTANGLE, 0, NAN);
    pnb_settings settings = quality_scene_settings("MULTILAYER", test, HEIGHT);
    const pnb_value value = {"faces", faces};
    settings.values = &value;
    settings.value_count = 1;
    struct render render = quality_render(test_scene_get(test), &settings);
    double bytes = 0;
    for (uint32_t i = 0; render.job && i < pnb_job_timing_count(render.job); i++) {
        pnb_timing timing = PNB_INIT(pnb_timing);
        CHECK_RESULT(pnb_job_get_timing(render.job, i, &timing), PNB_OK);
        if (strcmp(timing.name, "Fragment collect") == 0)
            bytes = (double)timing.bytes;
    }
    *error = render_rmse(truth, &render);
    render_free(&render);
    test_scene_destroy(&test);
    return bytes;
}

/* Nearly all that the map sees is the floor, which stays. */
static void back_faces_shorten_lists(void) {
    struct test_scene *test = quality_scene("tall-box", TEST_LIGHT_RECTANGLE, 0, NAN);
    pnb_settings settings = quality_scene_settings("REFERENCE", test, HEIGHT);
    settings.light_samples = 10;
    struct render truth = quality_render(test_scene_get(test), &settings);
    double errors[2];
    const double all = fragment_bytes(0, &truth, &errors[0]), back = fragment_bytes(1, &truth, &errors[1]);
    printf("tall box: lists of all faces %.0f bytes, error %.4f; of back faces %.0f, %.4f\n", all, errors[0], back,
           errors[1]);
    CHECK(back < all);
    CHECK_AT_MOST(errors[1], 0.03); /* its shadow is still there: without it the error is above 0.1 */
    render_free(&truth);
    test_scene_destroy(&test);
}

int main(void) {
    quality_open();
    overlapping_occluders();
    y_map_has_no_texels();
    back_faces_shorten_lists();
    return quality_close();
}
