/* SPDX-License-Identifier: GPL-3.0-or-later
 * Shadows whose form is known: the penumbra of a straight edge and the umbra of a sphere, with every kind of light,
 * that is for perspective and for orthographic shadow maps. */
#include "oracle.h"
#include "quality.h"

#include <math.h>

/* Pixels of a scan line across the shadow; the scenes' cameras show `window` metres from left to right. */
#define LINE 512
#define ROWS 4

/* Where an edge lies and how wide it is, in pixels: mean and spread of the change of visibility along the line, which
 * no noise or banding can hide. The width of an even ramp is sqrt(12) times its standard deviation. */
struct edge {
    double position, width;
};

static struct edge measure_edge(const double visibility[LINE]) {
    double weight = 0, mean = 0, square = 0;
    for (int x = 1; x < LINE; x++) {
        const double change = visibility[x] - visibility[x - 1];
        weight += change;
        mean += change * x;
        square += change * x * x;
    }
    mean /= weight;
    return (struct edge){mean, sqrt(12 * fmax(square / weight - mean * mean, 0))};
}

static void theory(const pnb_scene *scene, const pnb_settings *settings, oracle_blocker blocker, const void *user,
                   double weighted[LINE], double plain[LINE]) {
    const float *window = scene->camera.window;
    const double y = (settings->crop[1] + 0.5 * ROWS) / settings->height;
    for (int x = 0; x < LINE; x++) {
        const double position[3] = {window[0] + (x + 0.5) / LINE * ((double)window[1] - (double)window[0]),
                                    window[2] + y * ((double)window[3] - (double)window[2]), 0};
        const struct oracle oracle = oracle_light(scene->lights, position, (double[3]){0, 0, 1}, 48, blocker, user);
        weighted[x] = oracle.visibility;
        plain[x] = oracle.visible;
    }
}

static void read_row(const struct render *render, uint32_t row, double visibility[LINE]) {
    for (uint32_t x = 0; x < LINE; x++)
        visibility[x] = render->shadow[3 * ((size_t)row * LINE + x)];
}

static pnb_settings line_settings(const char *technique) {
    pnb_settings settings = quality_settings(technique, LINE, LINE);
    settings.light_samples = 8;
    settings.crop[1] = LINE / 2 - ROWS / 2;
    settings.crop[2] = LINE;
    settings.crop[3] = ROWS;
    return settings;
}

/* Worst of the rows; slack: of the edge, in shares of the penumbra's width. */
static void check_rows(const struct render *render, const double expected[LINE], const char *technique,
                       const char *what, double slack) {
    const struct edge truth = measure_edge(expected);
    double offset = 0, widening = 0, difference = 0;
    for (uint32_t row = 0; row < ROWS; row++) {
        double visibility[LINE];
        read_row(render, row, visibility);
        const struct edge edge = measure_edge(visibility);
        offset = fmax(offset, fabs(edge.position - truth.position));
        widening = fmax(widening, fabs(edge.width / truth.width - 1));
        for (int x = 0; x < LINE; x++)
            difference = fmax(difference, fabs(visibility[x] - expected[x]));
    }
    printf("%-9s %-28s edge at %6.2f px, off by %.3f; width %6.2f px, off by %.2f %%; largest difference %.3f\n",
           technique, what, truth.position, offset, truth.width, 100 * widening, difference);
    CHECK_AT_MOST(offset, 0.5 + slack * truth.width);
    CHECK_AT_MOST(widening, 0.03);
}

static void half_plane(enum test_light light, float height, float light_x) {
    struct test_scene *test = quality_scene("half-plane", light, 0, height);
    pnb_scene scene = *test_scene_get(test);
    pnb_light lamp = scene.lights[0];
    lamp.matrix[12] = light_x;
    if (light == TEST_LIGHT_SUN) { /* turned instead of moved */
        const float angle = atanf(light_x / 4);
        const float matrix[16] = {cosf(angle), 0, -sinf(angle), 0, 0, 1, 0, 0,
                                  sinf(angle), 0, cosf(angle),  0, 0, 0, 4, 1};
        memcpy(lamp.matrix, matrix, sizeof matrix);
    }
    scene.lights = &lamp;
    double weighted[LINE], plain[LINE];
    const struct half_plane plane = {0, height};
    pnb_settings settings = line_settings(NULL);
    theory(&scene, &settings, half_plane_blocks, &plane, weighted, plain);
    /* Of a sphere's points, half face away. */
    if (light == TEST_LIGHT_POINT || light == TEST_LIGHT_SPOT)
        settings.light_samples = 12;
    static const char *const techniques[] = {"REFERENCE", "PCSS"};
    for (int i = 0; i < 2; i++) {
        settings.technique = techniques[i];
        struct render render = quality_render(&scene, &settings);
        char what[64];
        snprintf(what, sizeof what, "%s, %.1f m high, %+.1f m", test_light_names[light], (double)height,
                 (double)light_x);
        /* Off the axis a disk that faces the surface is tilted against the map. PCSS projects it to first order, which
         * leaves out how much nearer one half of it is: 0.9 % of the width here, with a light 1.5 m wide 4 m away. */
        const bool tilted = i == 1 && light_x != 0 && (light == TEST_LIGHT_POINT || light == TEST_LIGHT_SPOT);
        if (render.job)
            check_rows(&render, i == 0 ? weighted : plain, techniques[i], what, tilted ? 0.01 : 0);
        render_free(&render);
    }
    test_scene_destroy(&test);
}

/* Distance of the level from the centre of the line, both ways, where visibility first falls below it from outside. */
static double shadow_width(const double visibility[LINE], double level) {
    double ends[2] = {0, 0};
    for (int side = 0; side < 2; side++)
        for (int i = 0; i + 1 < LINE / 2; i++) {
            const int outer = side ? LINE - 1 - i : i, inner = side ? outer - 1 : outer + 1;
            if (visibility[inner] >= level)
                continue;
            const double t = (visibility[outer] - level) / fmax(visibility[outer] - visibility[inner], 1e-9);
            ends[side] = outer + (side ? -t : t);
            break;
        }
    return ends[1] - ends[0];
}

/* Umbra and outer limit of a sphere's shadow. They are measured a little inside the penumbra, where visibility has left
 * 0 and 1 by one in fifty, since the very limit is approached with slope 0. */
static void ball(enum test_light light) {
    struct test_scene *test = quality_scene("ball", light, 0, NAN);
    const pnb_scene *scene = test_scene_get(test);
    const struct ball shape = {{0, 0, 1.5}, 0.5};
    pnb_settings settings = line_settings("REFERENCE");
    double weighted[LINE], plain[LINE], visibility[LINE];
    theory(scene, &settings, ball_blocks, &shape, weighted, plain);
    struct render render = quality_render(scene, &settings);
    for (uint32_t row = 0; render.job && row < ROWS; row += ROWS - 1) {
        read_row(&render, row, visibility);
        const double umbra = shadow_width(weighted, 0.02), outline = shadow_width(weighted, 0.98);
        const double umbra_error = (shadow_width(visibility, 0.02) - umbra) / 2;
        const double outline_error = (shadow_width(visibility, 0.98) - outline) / 2;
        printf("REFERENCE sphere under %-9s umbra %6.2f px across, radius off by %+.3f px; outline %6.2f px, off by "
               "%+.3f px\n",
               test_light_names[light], umbra, umbra_error, outline, outline_error);
        CHECK_AT_MOST(fabs(umbra_error), 1);
        CHECK_AT_MOST(fabs(outline_error), 1);
    }
    render_free(&render);
    test_scene_destroy(&test);
}

int main(void) {
    quality_open();
    for (int light = 0; light < TEST_LIGHT_COUNT; light++) {
        half_plane((enum test_light)light, 1, 0);
        half_plane((enum test_light)light, 0.3f, 0);
        half_plane((enum test_light)light, 1, 1.1f);
        ball((enum test_light)light);
    }
    return quality_close();
}
