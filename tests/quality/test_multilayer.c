/* SPDX-License-Identifier: GPL-3.0-or-later
 * What MULTILAYER is for: occluders that overlap at different depths, few layers, and wide penumbrae without the texels
 * of coarse levels. test_fragment_lists checks its lists, test_transparency its transparent casters. */
#include "quality.h"

#define HEIGHT 144

/* parameter: NULL for the defaults. */
static struct render render_scene(const char *scene, float light_size, const char *technique, const char *parameter,
                                  double value) {
    struct test_scene *test = quality_scene(scene, TEST_LIGHT_RECTANGLE, light_size, NAN);
    pnb_settings settings = quality_scene_settings(technique, test, HEIGHT);
    const pnb_value values = {parameter, value};
    settings.values = &values;
    settings.value_count = parameter ? 1u : 0u;
    settings.light_samples = 10;
    struct render render = quality_render(test_scene_get(test), &settings);
    test_scene_destroy(&test);
    return render;
}

/* Frees the render. */
static double error_of(struct render render, const struct render *truth) {
    const double error = render_rmse(truth, &render);
    render_free(&render);
    return error;
}

/* Crossing slats at several heights: one layer is as good as one map, two are all there is. */
static void overlapping_occluders(void) {
    struct render truth = render_scene("slats", 0, "REFERENCE", NULL, 0);
    const double pcss = error_of(render_scene("slats", 0, "PCSS", NULL, 0), &truth);
    const double one = error_of(render_scene("slats", 0, "MULTILAYER", "depth_layers", 1), &truth);
    const double two = error_of(render_scene("slats", 0, "MULTILAYER", "depth_layers", 2), &truth);
    const double all = error_of(render_scene("slats", 0, "MULTILAYER", "depth_layers", 0), &truth);
    printf("slats: PCSS %.4f, MULTILAYER with one layer %.4f, two %.4f, all %.4f\n", pcss, one, two, all);
    CHECK_AT_MOST(all, 0.6 * pcss); /* the aim */
    CHECK_AT_MOST(two, all + 1e-6);
    CHECK(one > 1.5 * two); /* the lower slats are lost where the upper hide them from the light's centre */
    render_free(&truth);
}

/* Error in a wide penumbra on a plane. The texels of a MIP map are then as wide as the penumbra, so that a shadow lies
 * where they do; those of a Y-map are not. */
static double wide_penumbra(double pyramid, const struct render *truth) {
    struct render render = render_scene("half-plane", 2, "MULTILAYER", "pyramid", pyramid);
    if (render.job)
        quality_show(pyramid > 0 ? "multilayer-y-map" : "multilayer-mip-map", render.shadow, 3, render.width,
                     render.height);
    return error_of(render, truth);
}

static void y_map_has_no_texels(void) {
    struct render truth = render_scene("half-plane", 2, "REFERENCE", NULL, 0);
    const double mip = wide_penumbra(0, &truth), y = wide_penumbra(1, &truth);
    printf("wide penumbra: error %.4f with a MIP map, %.4f with a Y-map\n", mip, y);
    CHECK_AT_MOST(y, 0.6 * mip); /* 0.52 on llvmpipe: the rest is the shape of the filter, which both have */
    render_free(&truth);
}

/* Edges of shadows stay what they are, and the rest is all but linear from pixel to pixel. */
static void every_other_pixel_suffices(void) {
    struct render full = render_scene("slats", 0, "MULTILAYER", NULL, 0);
    struct render half = render_scene("slats", 0, "MULTILAYER", "subsampling", 1);
    double most = 0;
    for (size_t p = 0; full.job && half.job && p < (size_t)full.width * full.height; p++)
        most = fmax(most, fabs((double)full.shadow[3 * p] - (double)half.shadow[3 * p]));
    const double difference = error_of(half, &full);
    printf("slats, sub-sampled: off by %.4f, at most by %.4f\n", difference, most);
    CHECK(difference > 0);            /* it does something */
    CHECK_AT_MOST(difference, 0.003); /* 0.0017 on llvmpipe; 0.0068 if edges are interpolated, too */
    CHECK_AT_MOST(most, 0.1);         /* what is interpolated lies between its neighbours, which differ by less */
    render_free(&full);
}

/* test_fragment_lists checks which faces are left out; here that the parameter does it. */
static void back_faces_are_an_option(void) {
    struct render all = render_scene("tall-box", 0, "MULTILAYER", NULL, 0);
    const double difference = error_of(render_scene("tall-box", 0, "MULTILAYER", "faces", 1), &all);
    printf("tall box: off by %.4f without its front faces\n", difference);
    CHECK(difference > 0.01); /* its lower face lies in the floor's plane and hides nothing of it */
    render_free(&all);
}

int main(void) {
    quality_open();
    overlapping_occluders();
    y_map_has_no_texels();
    every_other_pixel_suffices();
    back_faces_are_an_option();
    return quality_close();
}
