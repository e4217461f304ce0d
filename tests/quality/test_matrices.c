/* SPDX-License-Identifier: GPL-3.0-or-later
 * The library's camera and light matrices against those of GLM. */
#include "check.h"
#include "glm_oracle.h"

#include "render/frame.h"

#include <stdlib.h>

/* Floats carry 6e-8; a few roundings of products and sums stay well below. */
#define TOLERANCE 1e-6

static uint32_t random_state = 1;

/* Numbers that look random and are the same everywhere. */
static float random_between(float low, float high) {
    random_state = random_state * 1664525u + 1013904223u;
    return low + (high - low) * (float)(random_state >> 8) / 16777216.0f;
}

/* Largest difference of an element. The linear part is measured against the largest element of its row; the
 * translation against the largest of its column, and 1: in clip space that is half the image. */
static double matrix_error(mat4 actual, const double expected[16]) {
    double worst = 0, translation = 1;
    for (int row = 0; row < 4; row++)
        translation = fmax(translation, fabs(expected[12 + row]));
    for (int row = 0; row < 4; row++) {
        double largest = 0, error = 0;
        for (int column = 0; column < 3; column++) {
            largest = fmax(largest, fabs(expected[4 * column + row]));
            error = fmax(error, fabs((double)actual[column][row] - expected[4 * column + row]));
        }
        worst = fmax(worst, largest > 0 ? error / largest : error);
        worst = fmax(worst, fabs((double)actual[3][row] - expected[12 + row]) / translation);
    }
    return worst;
}

/* Rotation, of each axis by its scale, and place. */
static void random_matrix(const float scale[3], float matrix[16]) {
    mat4 rotation;
    const vec3 axis = {random_between(-1, 1), random_between(-1, 1), random_between(-1, 1)};
    glm_rotate_make(rotation, random_between(-3.1f, 3.1f), (float *)axis);
    for (int column = 0; column < 3; column++)
        for (int row = 0; row < 3; row++)
            matrix[4 * column + row] = scale[column] * rotation[column][row];
    for (int row = 0; row < 3; row++)
        matrix[12 + row] = random_between(-10, 10);
    matrix[3] = matrix[7] = matrix[11] = 0;
    matrix[15] = 1;
}

/* ---- Camera ---- */

static double camera_error(pnb_projection projection, bool shifted) {
    struct scene_camera camera = {.projection = projection};
    random_matrix((const float[3]){1, 1, 1}, camera.matrix);
    const float half_width = random_between(0.1f, 2), half_height = random_between(0.1f, 2);
    const float x = shifted ? random_between(-2, 2) : 0, y = shifted ? random_between(-2, 2) : 0;
    const float window[4] = {x - half_width, x + half_width, y - half_height, y + half_height};
    memcpy(camera.window, window, sizeof window);
    const struct settings settings = {
        .width = 640, .height = 360, .crop = {20, 30, 40, 50}, .samples = 1, .filter_width = 1.5f};
    const float near_depth = random_between(0.01f, 1), far_depth = near_depth * random_between(2, 1000);
    struct camera_block block;
    mat4 clip;
    double expected[16];
    camera_block_init(&block, &camera, &settings, 0);
    camera_projection(&block, near_depth, far_depth, clip);
    glm_camera(camera.matrix, window, projection == PNB_PERSPECTIVE, near_depth, far_depth, expected);
    return matrix_error(clip, expected);
}

static void cameras(void) {
    static const char *const names[] = {"perspective", "orthographic"};
    for (int projection = 0; projection < 2; projection++)
        for (int shifted = 0; shifted < 2; shifted++) {
            double worst = 0;
            for (int i = 0; i < 200; i++)
                worst = fmax(worst, camera_error((pnb_projection)projection, shifted));
            printf("camera, %s%s: 200 matrices within %.2g of GLM's\n", names[projection], shifted ? ", shifted" : "",
                   worst);
            CHECK_AT_MOST(worst, TOLERANCE);
        }
}

/* ---- Lights ---- */

static void random_light(pnb_light_type type, bool mirrored, struct scene_light *light) {
    *light = (struct scene_light){
        .type = type, .size = {1, 2}, .radius = 0.2f, .angle = 0.1f, .spot_angle = random_between(0.2f, 3.1f)};
    const float scale[3] = {random_between(0.2f, 3) * (mirrored ? -1.0f : 1.0f), random_between(0.2f, 3),
                            random_between(0.2f, 3)};
    random_matrix(scale, light->matrix);
}

/* Receivers and casters all around the light, so that every view it can have exists. */
static void fit_around(const struct emitter *emitter, bool wide, struct light_views *views) {
    struct box room;
    const float side = wide ? 20.0f : 1.0f;
    for (int i = 0; i < 3; i++) {
        const float center = emitter->position[i] + (wide ? 0.0f : 5.0f * emitter->frame[2][i]);
        room.minimum[i] = center - side;
        room.maximum[i] = center + side;
    }
    struct hull receivers;
    hull_of_box(&room, &receivers);
    light_views_fit(views, emitter, &receivers, 1, &room, 1, 1024);
}

/* The documented directions of the faces, in the emitter's frame. */
static const int face_axis[MAX_LIGHT_VIEWS] = {2, 0, 0, 1, 1, 2};
static const float face_sign[MAX_LIGHT_VIEWS] = {1, 1, -1, 1, -1, -1};

static double view_error(const struct emitter *emitter, const struct light_view *view, int face) {
    vec3 forward, eye;
    glm_vec3_scale((float *)emitter->frame[face_axis[face]], face_sign[face], forward);
    glm_vec3_copy((float *)emitter->position, eye);
    if (emitter->type == PNB_LIGHT_SUN)
        glm_vec3_zero(eye);
    /* The direction of a face is documented; how it is turned around that direction is its own matter. */
    const float up[3] = {view->from_world[0][1], view->from_world[1][1], view->from_world[2][1]};
    double space[16], projection[16];
    mat4 clip;
    glm_light_space(eye, forward, up, space);
    glm_light_projection(view->rect, view->near_depth, view->far_depth, view->perspective != 0.0f, projection);
    light_view_projection(view, clip);
    return fmax(matrix_error((vec4 *)view->from_world, space), matrix_error(clip, projection));
}

static void lights(void) {
    static const char *const names[] = {"AREA", "POINT", "SPOT", "SUN"};
    for (int type = PNB_LIGHT_AREA; type <= PNB_LIGHT_SUN; type++) {
        double worst = 0, tilt = 0;
        int faces[MAX_LIGHT_VIEWS] = {0}, singles = 0;
        for (int i = 0; i < 200; i++) {
            struct scene_light light;
            struct emitter emitter;
            struct light_views views;
            random_light((pnb_light_type)type, i % 2 == 1, &light);
            emitter_init(&emitter, &light, (const vec3){1, 2, 3});
            for (int row = 0; row < 3; row++) /* it shines along its local -Z */
                tilt = fmax(tilt, type == PNB_LIGHT_POINT
                                      ? 0
                                      : fabs((double)emitter.frame[2][row] +
                                             (double)light.matrix[8 + row] / (double)glm_vec3_norm(&light.matrix[8])));
            fit_around(&emitter, i % 4 < 2, &views);
            singles += views.single;
            for (int face = 0; face < MAX_LIGHT_VIEWS; face++) {
                if (views.layer_of_face[face] < 0)
                    continue;
                faces[face] += !views.single;
                worst = fmax(worst, view_error(&emitter, &views.views[views.layer_of_face[face]], face));
            }
        }
        printf(
            "light %s: %d single views, faces +Z +X -X +Y -Y -Z %d %d %d %d %d %d: within %.2g of GLM's, axis %.2g\n",
            names[type], singles, faces[0], faces[1], faces[2], faces[3], faces[4], faces[5], worst, tilt);
        CHECK_AT_MOST(worst, TOLERANCE);
        CHECK_AT_MOST(tilt, TOLERANCE);
        CHECK(singles > 0 || type == PNB_LIGHT_POINT);
        CHECK(type == PNB_LIGHT_SUN || (faces[0] > 0 && faces[1] > 0 && faces[2] > 0 && faces[3] > 0 && faces[4] > 0));
        CHECK_INT(faces[5] > 0, type == PNB_LIGHT_POINT);
    }
}

int main(void) {
    cameras();
    lights();
    return check_report();
}
