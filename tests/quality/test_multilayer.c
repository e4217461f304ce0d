/* SPDX-License-Identifier: GPL-3.0-or-later
 * What MULTILAYER is for: occluders that overlap at different depths, few layers, and wide penumbrae without the texels
 * of coarse levels. test_fragment_lists checks its lists, test_transparency its transparent casters. */
#include "quality.h"
#include "support.h"

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

/* What single-layer maps fail at. */
static void overlapping_occluders(void) {
    static const char *const scenes[] = {"slats", "discs"};
    for (int i = 0; i < 2; i++) {
        struct render truth = render_scene(scenes[i], 0, "REFERENCE", NULL, 0);
        const double pcss = error_of(render_scene(scenes[i], 0, "PCSS", NULL, 0), &truth);
        const double essm = error_of(render_scene(scenes[i], 0, "ESSM", NULL, 0), &truth);
        const double all = error_of(render_scene(scenes[i], 0, "MULTILAYER", NULL, 0), &truth);
        printf("%s: PCSS %.4f, ESSM %.4f, MULTILAYER %.4f\n", scenes[i], pcss, essm, all);
        CHECK_AT_MOST(all, 0.6 * pcss); /* the aim */
        CHECK_AT_MOST(all, 0.6 * essm);
        if (i == 0) { /* of the slats, one layer is as good as one map, two are all there is */
            const double one = error_of(render_scene(scenes[i], 0, "MULTILAYER", "depth_layers", 1), &truth);
            const double two = error_of(render_scene(scenes[i], 0, "MULTILAYER", "depth_layers", 2), &truth);
            printf("  with one layer %.4f, two %.4f\n", one, two);
            CHECK_AT_MOST(two, all + 1e-6);
            CHECK(one > 1.5 * two); /* the lower slats are lost where the upper hide them from the light's centre */
        }
        render_free(&truth);
    }
}

/* Root mean square of the second difference along a scanline across a wide penumbra on a plane. In theory it is 0, for
 * the edge is parallel to the light's side; interpolation between texels bends at each of them. */
static double texel_structure(double pyramid, double lookups) {
    struct test_scene *test = quality_scene("half-plane", TEST_LIGHT_RECTANGLE, 2, NAN);
    pnb_settings settings = quality_scene_settings("MULTILAYER", test, 360);
    const pnb_value values[] = {{"pyramid", pyramid}, {"lookups", lookups}};
    settings.values = values;
    settings.value_count = 2;
    const uint32_t row[4] = {0, settings.height / 2, settings.width, 1};
    memcpy(settings.crop, row, sizeof row);
    struct render render = quality_render(test_scene_get(test), &settings);
    double sum = 0, count = 0;
    for (size_t x = 1; render.job && x + 1 < render.width; x++) {
        const float *s = render.shadow + 3 * x;
        const double difference = (double)s[-3] - 2 * (double)s[0] + (double)s[3];
        const bool penumbra = s[0] > 0.02f && s[0] < 0.98f;
        sum += penumbra ? difference * difference : 0;
        count += penumbra;
    }
    CHECK(count > 50);
    render_free(&render);
    test_scene_destroy(&test);
    return sqrt(sum / count);
}

static void y_map_has_no_texels(void) {
    for (int lookups = 1; lookups <= 2; lookups++) {
        const double mip = texel_structure(0, lookups), y = texel_structure(1, lookups);
        printf("second difference in a wide penumbra, %d lookups a side: MIP map %.5f, Y-map %.5f\n", lookups, mip,
               y);
        /* The stack's texels have at most half the width of the MIP map's there. Bends are then half as strong and
         * twice as many. */
        CHECK_AT_MOST(y, mip * sqrt(0.5));
    }
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

/* Pickets far away, whose shadows are finer than pixels: one sample of each pixel against many. */
static void shadows_are_antialiased(void) {
    struct test_scene *test = quality_scene("grazing-fence", TEST_LIGHT_RECTANGLE, 0, NAN);
    pnb_settings settings = quality_scene_settings("MULTILAYER", test, 72);
    settings.samples = 24;
    struct render truth = quality_render(test_scene_get(test), &settings);
    settings.samples = 1;
    const double without = error_of(quality_render(test_scene_get(test), &settings), &truth);
    const pnb_value on = {"antialiasing", 1};
    settings.values = &on;
    settings.value_count = 1;
    const double with = error_of(quality_render(test_scene_get(test), &settings), &truth);
    printf("grazing fence: off by %.4f, with shadow anti-aliasing %.4f\n", without, with);
    CHECK_AT_MOST(with, 0.85 * without); /* the outlines of the pickets stay as they are */
    render_free(&truth);
    test_scene_destroy(&test);
}

/* Filters are square, so a long light is cut into parts that nearly are. */
static void long_lights_are_cut(void) {
    struct test_scene *test = quality_scene("discs", TEST_LIGHT_RECTANGLE, 0, NAN);
    pnb_scene scene = *test_scene_get(test);
    pnb_light light = scene.lights[0];
    scene.lights = &light;
    light.size[0] *= 4;
    light.size[1] /= 4;
    pnb_settings settings = quality_scene_settings("REFERENCE", test, HEIGHT);
    settings.light_samples = 16;
    struct render truth = quality_render(&scene, &settings);
    settings.technique = "MULTILAYER";
    const double error = error_of(quality_render(&scene, &settings), &truth);
    printf("discs under a light 16 times as long as wide: off by %.4f\n", error);
    CHECK_AT_MOST(error, 0.03);
    render_free(&truth);
    test_scene_destroy(&test);
}

/* test_fragment_lists checks which faces are left out; here that the parameter does it. */
static void back_faces_are_an_option(void) {
    struct render all = render_scene("tall-box", 0, "MULTILAYER", NULL, 0);
    const double difference = error_of(render_scene("tall-box", 0, "MULTILAYER", "faces", 1), &all);
    printf("tall box: off by %.4f without its front faces\n", difference);
    CHECK(difference > 0.01); /* its lower face lies in the floor's plane and hides nothing of it */
    render_free(&all);
}

static void render_layers(const char *technique, uint32_t map_size) {
    struct test_scene *test = quality_scene("layers", TEST_LIGHT_RECTANGLE, 0, NAN);
    pnb_settings settings = quality_scene_settings(technique, test, HEIGHT);
    settings.shadow_map_size = map_size;
    struct render render = quality_render(test_scene_get(test), &settings);
    render_free(&render);
    test_scene_destroy(&test);
}

/* Lists of a map of 2048 texels take 316 MiB here, of which a driver must hold none once another technique has drawn.
 * What shaders and allocators take on the way is 30 to 47 MiB. */
static void freed_lists_are_let_go(void) {
    render_layers("MULTILAYER", 256);
    render_layers("HARD", 256);
    const long before = resident_kib();
    render_layers("MULTILAYER", 2048);
    render_layers("HARD", 256);
    const long growth = resident_kib() - before;
    printf("memory after MULTILAYER with a map of 2048 texels: %+ld KiB\n", growth);
    if (!UNDER_ADDRESS_SANITIZER) /* which keeps freed memory for a while */
        CHECK_AT_MOST((double)growth, 64 << 10);
}

int main(void) {
    quality_open();
    freed_lists_are_let_go();
    overlapping_occluders();
    y_map_has_no_texels();
    every_other_pixel_suffices();
    shadows_are_antialiased();
    back_faces_are_an_option();
    long_lights_are_cut();
    return quality_close();
}
