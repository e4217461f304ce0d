/* SPDX-License-Identifier: GPL-3.0-or-later
 * The light that arrives where nothing is in between: Combined of a white plane against irradiance summed over points
 * of the emitter, for every type and shape, tilted, off the plane's centre, and partly below its horizon. */
#include "oracle.h"
#include "quality.h"

/* Pixels of the image, and points along each side of an emitter for the oracle. */
#define SIDE   12
#define POINTS 96

/* One light over the plane z = 0. The rotation (degrees around X, then Y) tips its axis, which is down to begin with.
 */
struct light_case {
    const char *name;
    pnb_light light;
    float tip_x, tip_y, position[3], scale[3];
};

/* Of the error, as a share of the brightest; 0: 1 % of that and of each pixel. The edge of a cone is averaged over
 * seven parts of the bulb. Soft, with bulbs of a fifth of the distance and of a hundredth, it is off by .0053 and
 * .00006 (by one part by .062 and .0005); hard, with one of a fifth, by .0186 (.055); with a bulb wider than the cone
 * by .038 (.505). */
static double limit_of(const pnb_light *light) {
    if (light->type != PNB_LIGHT_SPOT || light->radius == 0)
        return 0;
    if (light->spot_blend == 0)
        return 0.02;
    return light->radius > light->spot_angle ? 0.042 : light->radius > 0.1f ? 0.006 : 0.0001;
}

#define LIGHT(...)                                                                                                     \
    { .struct_size = sizeof(pnb_light), __VA_ARGS__ }

static const struct light_case cases[] = {
    {"rectangle", LIGHT(.size = {1, 0.5f}), 0, 0, {0, 0, 2}, {1, 1, 1}},
    {"rectangle, near", LIGHT(.size = {2, 2}), 0, 0, {0.3f, 0.1f, 0.4f}, {1, 1, 1}},
    {"rectangle, tilted 40 degrees", LIGHT(.size = {1, 0.5f}), 40, 0, {0.5f, -1, 1.5f}, {1, 1, 1}},
    {"rectangle, scaled", LIGHT(.size = {1, 1}), 20, -30, {0.5f, -1, 1.5f}, {0.4f, 1.5f, 3}},
    {"rectangle through the plane", LIGHT(.size = {1, 2}), -90, 0, {0, 2.6f, 0.3f}, {1, 1, 1}},
    {"rectangle, 1 mm", LIGHT(.size = {1e-3f, 1e-3f}), 30, 0, {0, -1, 2}, {1, 1, 1}},
    {"ellipse", LIGHT(.shape = PNB_AREA_ELLIPSE, .size = {1, 0.5f}), 0, 0, {0, 0, 2}, {1, 1, 1}},
    {"ellipse, near", LIGHT(.shape = PNB_AREA_ELLIPSE, .size = {2, 2}), 0, 0, {0.3f, 0.1f, 0.4f}, {1, 1, 1}},
    {"ellipse, tilted 40 degrees",
     LIGHT(.shape = PNB_AREA_ELLIPSE, .size = {1, 0.5f}),
     0,
     40,
     {-1, 0.2f, 1.5f},
     {1, 1, 1}},
    {"ellipse through the plane", LIGHT(.shape = PNB_AREA_ELLIPSE, .size = {1, 2}), -90, 0, {0, 2.6f, 0.3f}, {1, 1, 1}},
    {"point, hard", LIGHT(.type = PNB_LIGHT_POINT), 0, 0, {0.5f, 0, 1}, {1, 1, 1}},
    {"point, radius 0.5", LIGHT(.type = PNB_LIGHT_POINT, .radius = 0.5f), 0, 0, {0.5f, 0, 1}, {1, 1, 1}},
    {"point, radius 1, near", LIGHT(.type = PNB_LIGHT_POINT, .radius = 1), 0, 0, {2, 0, 0.5f}, {1, 1, 1}},
    {"spot", LIGHT(.type = PNB_LIGHT_SPOT, .spot_angle = 1.2f, .spot_blend = 0.4f), 20, 0, {0, -0.5f, 2}, {1, 1, 1}},
    {"spot, radius 0.4, scaled",
     LIGHT(.type = PNB_LIGHT_SPOT, .radius = 0.4f, .spot_angle = 1.2f, .spot_blend = 1),
     0,
     25,
     {-0.5f, 0, 2},
     {2, 1, 1}},
    {"spot, radius 0.02, scaled",
     LIGHT(.type = PNB_LIGHT_SPOT, .radius = 0.02f, .spot_angle = 1.57f, .spot_blend = 0.8f),
     0,
     25,
     {-0.5f, 0, 2},
     {2, 1, 3}},
    {"spot, radius 0.4, hard edge, scaled",
     LIGHT(.type = PNB_LIGHT_SPOT, .radius = 0.4f, .spot_angle = 0.9f),
     0,
     10,
     {0, 0, 2},
     {1, 1.5f, 1}},
    {"spot, radius 0.4, wider than its cone",
     LIGHT(.type = PNB_LIGHT_SPOT, .radius = 0.4f, .spot_angle = 0.3f, .spot_blend = 0.5f),
     0,
     0,
     {0, 0, 2},
     {1, 1, 1}},
    {"spot that falls with the cosine",
     LIGHT(.type = PNB_LIGHT_SPOT, .flags = PNB_LIGHT_COSINE_SPOT, .spot_angle = 2),
     0,
     0,
     {0.2f, 0, 1},
     {1, 1, 1}},
    {"sun, hard", LIGHT(.type = PNB_LIGHT_SUN), 50, 0, {0, 0, 5}, {1, 1, 1}},
    {"sun, 10 degrees", LIGHT(.type = PNB_LIGHT_SUN, .angle = 0.1745f), 50, 10, {0, 0, 5}, {1, 1, 1}},
    {"sun, 20 degrees, half set", LIGHT(.type = PNB_LIGHT_SUN, .angle = 0.349f), 87, 0, {0, 0, 5}, {1, 1, 1}},
};
#define CASES (sizeof cases / sizeof *cases)

static pnb_light placed(const struct light_case *light_case) {
    pnb_light light = light_case->light;
    const float degree = 3.14159265f / 180;
    const float cx = cosf(light_case->tip_x * degree), sx = sinf(light_case->tip_x * degree);
    const float cy = cosf(light_case->tip_y * degree), sy = sinf(light_case->tip_y * degree);
    const float axes[3][3] = {{cy, 0, -sy}, {sy * sx, cx, cy * sx}, {sy * cx, -sx, cy * cx}};
    for (int column = 0; column < 3; column++)
        for (int row = 0; row < 3; row++)
            light.matrix[4 * column + row] = light_case->scale[column] * axes[column][row];
    for (int row = 0; row < 3; row++)
        light.matrix[12 + row] = light_case->position[row];
    light.matrix[15] = 1;
    light.name = light_case->name;
    for (int i = 0; i < 3; i++) /* the area of the smallest is a millionth */
        light.emission[i] = light.type == PNB_LIGHT_AREA && light.size[0] < 0.01f ? 3e6f : 3;
    return light;
}

/* A white floor of 4 m seen from straight above, without a world and lights. */
static void build_floor(struct test_scene *test, pnb_scene *scene, pnb_material *white) {
    *scene = *test_scene_get(test);
    *white = scene->materials[0];
    white->base_color[0] = white->base_color[1] = white->base_color[2] = 1;
    scene->materials = white;
    scene->material_count = scene->slot_count = 1;
    memset(scene->world_color, 0, sizeof scene->world_color);
}

static void sum_radiance(const pnb_light *light, const pnb_scene *scene, double expected[SIDE * SIDE]) {
    const float *window = scene->camera.window;
    for (uint32_t i = 0; i < SIDE * SIDE; i++) {
        const double x = (i % SIDE + 0.5) / SIDE, y = (i / SIDE + 0.5) / SIDE;
        const double position[3] = {window[0] + x * ((double)window[1] - (double)window[0]),
                                    window[2] + y * ((double)window[3] - (double)window[2]), 0};
        const struct oracle oracle = oracle_light(light, position, (double[3]){0, 0, 1}, POINTS, NULL, NULL);
        expected[i] = oracle.irradiance / 3.14159265358979;
    }
}

static void check_lights(const char *name, const pnb_light *lights, uint32_t count, const pnb_scene *from,
                         const double expected[SIDE * SIDE], double limit) {
    pnb_scene scene = *from;
    scene.lights = lights;
    scene.light_count = count;
    pnb_settings settings = quality_settings("PCSS", SIDE, SIDE);
    settings.passes = PNB_PASS_COMBINED | PNB_PASS_DEPTH;
    struct render render = quality_render(&scene, &settings);
    if (!render.job)
        return;
    double worst = 0, largest = 0, absolute = 0;
    for (int i = 0; i < SIDE * SIDE; i++)
        largest = fmax(largest, expected[i]);
    for (int i = 0; i < SIDE * SIDE; i++) {
        const double error = fabs((double)render.combined[4 * i] - expected[i]);
        absolute = fmax(absolute, error);
        /* Below a thousandth of the brightest pixel the sum over points is the worse of the two. */
        if (expected[i] > 1e-3 * largest)
            worst = fmax(worst, error / expected[i]);
    }
    printf("%-34s up to %.4f W/(m2 sr), off by up to %.3f %% of itself, %.3f %% of the brightest\n", name, largest,
           100 * worst, 100 * absolute / largest);
    CHECK(largest > 0);
    if (limit == 0) {
        CHECK_AT_MOST(worst, 0.01);
    }
    CHECK_AT_MOST(absolute, (limit > 0 ? limit : 0.01) * largest);
    render_free(&render);
}

int main(void) {
    quality_open();
    struct test_scene *test = quality_scene("plane", TEST_LIGHT_RECTANGLE, 0, NAN);
    pnb_scene scene;
    pnb_material white;
    build_floor(test, &scene, &white);
    pnb_light lights[CASES];
    double sum[SIDE * SIDE] = {0};
    for (size_t i = 0; i < CASES; i++) {
        double expected[SIDE * SIDE];
        lights[i] = placed(&cases[i]);
        sum_radiance(&lights[i], &scene, expected);
        check_lights(cases[i].name, &lights[i], 1, &scene, expected, limit_of(&lights[i]));
        for (int k = 0; k < SIDE * SIDE; k++)
            sum[k] += expected[k];
    }
    check_lights("all of them together", lights, CASES, &scene, sum, 0);
    test_scene_destroy(&test);
    return quality_close();
}
