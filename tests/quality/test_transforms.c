/* SPDX-License-Identifier: GPL-3.0-or-later
 * A shadow does not depend on where the scene lies, how large it is or how it is turned. */
#include "quality.h"

#define MOST_INSTANCES 1100

/* A copy of a procedural scene to be moved about. */
struct moved {
    pnb_scene scene;
    pnb_instance instances[MOST_INSTANCES];
    pnb_light lights[8];
};

static void copy_scene(const pnb_scene *from, struct moved *to) {
    to->scene = *from;
    if (from->instance_count > MOST_INSTANCES || from->light_count > 8)
        exit(1);
    memcpy(to->instances, from->instances, from->instance_count * sizeof *from->instances);
    memcpy(to->lights, from->lights, from->light_count * sizeof *from->lights);
    to->scene.instances = to->instances;
    to->scene.lights = to->lights;
}

typedef void (*matrix_change)(float matrix[16], const double *argument);

static void change_matrices(struct moved *moved, matrix_change change, const double *argument) {
    for (uint32_t i = 0; i < moved->scene.instance_count; i++)
        change(moved->instances[i].matrix, argument);
    for (uint32_t i = 0; i < moved->scene.light_count; i++)
        change(moved->lights[i].matrix, argument);
    change(moved->scene.camera.matrix, argument);
}

/* Numbers that are still exact when a million is added to them. */
static void round_position(float matrix[16], const double *argument) {
    (void)argument;
    for (int i = 12; i < 15; i++)
        matrix[i] = roundf(matrix[i] * 16) / 16;
}

static void move(float matrix[16], const double *offset) {
    for (int i = 0; i < 3; i++)
        matrix[12 + i] = (float)((double)matrix[12 + i] + offset[i]);
}

static void scale_position(float matrix[16], const double *factor) {
    for (int i = 12; i < 15; i++)
        matrix[i] = (float)((double)matrix[i] * *factor);
}

/* rotation: 3 x 3, column-major. */
static void rotate(float matrix[16], const double *rotation) {
    for (int column = 0; column < 4; column++) {
        double result[3] = {0};
        for (int row = 0; row < 3; row++)
            for (int k = 0; k < 3; k++)
                result[row] += rotation[3 * k + row] * (double)matrix[4 * column + k];
        for (int row = 0; row < 3; row++)
            matrix[4 * column + row] = (float)result[row];
    }
}

static void scale_scene(struct moved *moved, float factor) {
    change_matrices(moved, scale_position, &(double){(double)factor});
    for (uint32_t i = 0; i < moved->scene.instance_count; i++)
        for (int k = 0; k < 12; k++)
            moved->instances[i].matrix[k] *= factor;
    for (uint32_t i = 0; i < moved->scene.light_count; i++) {
        moved->lights[i].size[0] *= factor;
        moved->lights[i].size[1] *= factor;
        moved->lights[i].radius *= factor;
    }
    pnb_camera *camera = &moved->scene.camera;
    for (int i = 0; i < 4 && camera->projection == PNB_ORTHOGRAPHIC; i++)
        camera->window[i] *= factor;
    camera->clip_start = 0.1f * factor;
    camera->clip_end = 1000 * factor;
}

/* How far the second scene's visibility is from the first's. */
static double difference(const struct moved *a, const struct moved *b, const pnb_settings *settings) {
    struct render first = quality_render(&a->scene, settings), second = quality_render(&b->scene, settings);
    const double rmse = render_rmse(&first, &second);
    render_free(&first);
    render_free(&second);
    return rmse;
}

/* Turned, the maps' texels lie elsewhere: the difference is that of two maps of the same size. It may be as large as
 * what a map moved by half a texel makes, a few per cent of the pixels at edges. */
#define TURNED 0.06

static void check_scene(const char *name, enum test_light light, const char *technique) {
    static struct moved base, other;
    struct test_scene *test = quality_scene(name, light, 0, NAN);
    pnb_settings settings = quality_scene_settings(technique, test, 108);
    /* Half of a sphere's points are in view, and which ones changes when it is turned. */
    settings.light_samples = light == TEST_LIGHT_POINT || light == TEST_LIGHT_SPOT ? 6 : 3;
    copy_scene(test_scene_get(test), &base);
    change_matrices(&base, round_position, NULL);
    other = base;
    other.scene.instances = other.instances;
    other.scene.lights = other.lights;
    change_matrices(&other, move, (const double[3]){1e6, -1e6, 5e5});
    const double far_away = difference(&base, &other, &settings);
    copy_scene(&base.scene, &other);
    scale_scene(&other, 1000);
    const double large = difference(&base, &other, &settings);
    copy_scene(&base.scene, &other);
    scale_scene(&other, 1e-3f);
    const double small = difference(&base, &other, &settings);
    copy_scene(&base.scene, &other);
    change_matrices(&other, rotate, (const double[9]){0.36, 0.48, -0.8, -0.8, 0.6, 0, 0.48, 0.64, 0.6});
    const double turned = difference(&base, &other, &settings);
    printf("%-9s %-9s under %-9s RMSE 1000 km away %.2g, 1000 times as large %.2g, as small %.2g, turned %.2g\n",
           technique, name, test_light_names[light], far_away, large, small, turned);
    /* All matrices are exact there, so only the rounding of differences is left, which flips a few texels' tests. */
    CHECK_AT_MOST(far_away, 2e-3);
    CHECK_AT_MOST(large, 0.01);
    CHECK_AT_MOST(small, 0.01);
    CHECK_AT_MOST(turned, TURNED);
    test_scene_destroy(&test);
}

int main(void) {
    quality_open();
    static const char *const techniques[] = {"HARD", "PCSS", "REFERENCE"};
    for (int t = 0; t < 3; t++)
        for (int light = 0; light < TEST_LIGHT_COUNT; light++) {
            check_scene("stairs", (enum test_light)light, techniques[t]);
            if (t > 0)
                check_scene("discs", (enum test_light)light, techniques[t]);
        }
    return quality_close();
}
