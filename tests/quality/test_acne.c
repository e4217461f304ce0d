/* SPDX-License-Identifier: GPL-3.0-or-later
 * Surfaces must not shadow themselves, and shadows must start where their casters stand: for every technique in the
 * library's table at its default settings, and every kind of light. */
#include "oracle.h"
#include "quality.h"
#include "scenes/shapes.h"

/* A pixel that sees the whole light counts as acne when it is darker than this ... */
#define DARK 0.99f
/* ... and so many of them may be, in per cent. */
#define ALLOWED 0.1

/* Share of acne, over every lit pixel of the Shadow pass that `counts`. */
struct acne {
    uint64_t pixels, dark;
    float darkest;
};

static void acne_add(struct acne *acne, float visibility) {
    acne->pixels++;
    acne->dark += visibility < DARK;
    acne->darkest = fminf(acne->darkest, visibility);
}

static double acne_percent(const struct acne *acne) {
    return acne->pixels ? 100.0 * (double)acne->dark / (double)acne->pixels : 100;
}

/* REFERENCE sums hard shadows of light samples; 9 of them show their acne as well as its default of 256. */
static pnb_settings technique_settings(const char *technique, uint32_t width, uint32_t height) {
    pnb_settings settings = quality_settings(technique, width, height);
    settings.light_samples = 3;
    settings.passes = PNB_PASS_DEPTH | PNB_PASS_SHADOW;
    return settings;
}

static const char *technique_name(uint32_t index) {
    pnb_technique_info info = PNB_INIT(pnb_technique_info);
    CHECK_RESULT(pnb_technique_get_info(index, &info), PNB_OK);
    return info.id;
}

/* ---- Planes ---- */

static const float angles[] = {0, 15, 30, 45, 60, 70, 75, 80, 85};
#define ANGLES (sizeof angles / sizeof *angles)

/* The whole image is floor; wherever all of the light is above it, nothing is in between. */
static struct acne plane_acne(const char *technique, const pnb_scene *scene, pnb_settings *settings) {
    struct acne acne = {.darkest = 1};
    settings->technique = technique;
    struct render render = quality_render(scene, settings);
    for (uint32_t i = 0; render.job && i < render.width * render.height; i++)
        if (render_covers(&render, i))
            acne_add(&acne, render.shadow[3 * i]);
    render_free(&render);
    return acne;
}

static void planes(void) {
    for (uint32_t t = 0; t < pnb_technique_count(); t++) {
        const char *technique = technique_name(t);
        for (int light = 0; light < TEST_LIGHT_COUNT; light++) {
            printf("%-9s plane under %-9s at", technique, test_light_names[light]);
            for (size_t a = 0; a < ANGLES; a++) {
                struct test_scene *test = quality_scene("plane", (enum test_light)light, 0, angles[a]);
                pnb_settings settings = technique_settings(technique, 160, 160);
                const struct acne acne = plane_acne(technique, test_scene_get(test), &settings);
                printf(" %.0f: %.3f %%", (double)angles[a], acne_percent(&acne));
                if (!CHECK_AT_MOST(acne_percent(&acne), ALLOWED))
                    printf("  darkest %.3f\n", (double)acne.darkest);
                test_scene_destroy(&test);
            }
            printf("\n");
        }
    }
}

/* A floor of a hundred metres, seen up to its horizon: pixels far larger than the map's texels and far smaller. */
static void wide_plane(void) {
    for (int light = 0; light < TEST_LIGHT_COUNT; light++) {
        struct test_scene *test = quality_scene("plane", (enum test_light)light, 0, 75);
        pnb_scene scene = *test_scene_get(test);
        pnb_instance floor = scene.instances[0];
        for (int i = 0; i < 8; i++)
            floor.matrix[i] *= 16;
        scene.instances = &floor;
        const pnb_camera camera = {
            .struct_size = sizeof camera,
            .matrix = {1, 0, 0, 0, 0, 0.2588f, 0.9659f, 0, 0, -0.9659f, 0.2588f, 0, 0, -8, 1.5f, 1},
            .window = {-0.5f, 0.5f, -0.28f, 0.28f}};
        scene.camera = camera;
        for (uint32_t t = 0; t < pnb_technique_count(); t++) {
            pnb_settings settings = technique_settings(NULL, 256, 144);
            const struct acne acne = plane_acne(technique_name(t), &scene, &settings);
            printf("%-9s wide plane under %-9s %.3f %% of %llu pixels, darkest %.3f\n", technique_name(t),
                   test_light_names[light], acne_percent(&acne), (unsigned long long)acne.pixels, (double)acne.darkest);
            CHECK_AT_MOST(acne_percent(&acne), ALLOWED);
        }
        test_scene_destroy(&test);
    }
}

/* ---- Sphere ---- */

/* Radius 1 around (0, 0, 1), 128 x 64 smooth-shaded quadrilaterals. */
static const struct ball sphere = {{0, 0, 1}, 1};

/* Whether a pixel sees the whole light: the floor, if no point of the light is behind the sphere; the sphere, if all of
 * the light is above the plane of the pixel's facet. A facet's normal differs from the sphere's by up to 2.1 degrees.
 */
static bool sees_whole_light(const pnb_light *light, const double position[3]) {
    double normal[3] = {0, 0, 1};
    if (position[2] < 2e-3)
        return oracle_light(light, position, normal, 8, ball_blocks, &sphere).visible > 0.9999;
    for (int i = 0; i < 3; i++)
        normal[i] = position[i] - sphere.center[i];
    const struct oracle oracle = oracle_light(light, position, normal, 8, NULL, NULL);
    return oracle.lowest > sin(2.1 * 3.14159265 / 180);
}

static void spheres(void) {
    for (int light = 0; light < TEST_LIGHT_COUNT; light++) {
        struct test_scene *test = quality_scene("sphere", (enum test_light)light, 0, NAN);
        const pnb_scene *scene = test_scene_get(test);
        for (uint32_t t = 0; t < pnb_technique_count(); t++) {
            pnb_settings settings = technique_settings(technique_name(t), 320, 180);
            struct render render = quality_render(scene, &settings);
            struct acne on_sphere = {.darkest = 1}, on_floor = {.darkest = 1};
            for (uint32_t i = 0; render.job && i < render.width * render.height; i++) {
                double position[3];
                render_position(&render, &scene->camera, &settings, i % render.width, i / render.width, position);
                if (render_covers(&render, i) && sees_whole_light(scene->lights, position))
                    acne_add(position[2] < 2e-3 ? &on_floor : &on_sphere, render.shadow[3 * i]);
            }
            printf("%-9s sphere under %-9s %.3f %% of %llu pixels, darkest %.3f; floor around it %.3f %% of %llu\n",
                   technique_name(t), test_light_names[light], acne_percent(&on_sphere),
                   (unsigned long long)on_sphere.pixels, (double)on_sphere.darkest, acne_percent(&on_floor),
                   (unsigned long long)on_floor.pixels);
            CHECK(on_sphere.pixels > 1000 && on_floor.pixels > 1000);
            CHECK_AT_MOST(acne_percent(&on_sphere), ALLOWED);
            render_free(&render);
        }
        test_scene_destroy(&test);
    }
}

/* ---- Bowl ---- */

static void bowl_point(float u, float v, float position[3]) {
    position[0] = 4 * u - 2;
    position[1] = 4 * v - 2;
    position[2] = 0.2f * (position[0] * position[0] + position[1] * position[1]);
}

/* A coarse smooth mesh that light falls into: every facet's neighbours rise above it, by 15 degrees, and no facet hides
 * the light, which stands above the rim for all of them. PCF and ESM darken whatever rises within their kernels, which
 * are as wide for a near blocker as for a far one. */
static void bowl(void) {
    struct shape shape = {0};
    shape_surface(&shape, 6, 6, bowl_point);
    pnb_mesh *mesh = shape_finish(&shape, "bowl");
    for (int light = 0; light < TEST_LIGHT_COUNT; light++) {
        struct test_scene *test = quality_scene("plane", (enum test_light)light, 0, 15);
        pnb_scene scene = *test_scene_get(test);
        pnb_instance instance = scene.instances[0];
        instance.mesh = mesh;
        scene.instances = &instance;
        for (uint32_t t = 0; t < pnb_technique_count(); t++) {
            if (strcmp(technique_name(t), "PCF") == 0 || strcmp(technique_name(t), "ESM") == 0)
                continue;
            pnb_settings settings = technique_settings(NULL, 320, 320);
            settings.shadow_map_size = 256;
            const struct acne acne = plane_acne(technique_name(t), &scene, &settings);
            printf("%-9s bowl under %-9s %.3f %% of %llu pixels, darkest %.3f\n", technique_name(t),
                   test_light_names[light], acne_percent(&acne), (unsigned long long)acne.pixels, (double)acne.darkest);
            CHECK(acne.pixels > 10000);
            CHECK_AT_MOST(acne_percent(&acne), ALLOWED);
        }
        test_scene_destroy(&test);
    }
    pnb_mesh_destroy(&mesh);
}

int main(void) {
    quality_open();
    planes();
    wide_plane();
    bowl();
    spheres();
    return quality_close();
}
