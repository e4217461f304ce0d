/* SPDX-License-Identifier: GPL-3.0-or-later
 * What the fitted views of shadow maps must show: every direction, by one face, and every caster that can stand between
 * a receiver and the emitter. */
#include "check.h"

#include "render/light.h"

static uint32_t random_state = 1;

/* Numbers that look random and are the same everywhere. */
static float random_between(float low, float high) {
    random_state = random_state * 1664525u + 1013904223u;
    return low + (high - low) * (float)(random_state >> 8) / 16777216.0f;
}

static void random_direction(vec3 direction) {
    do
        for (int i = 0; i < 3; i++)
            direction[i] = random_between(-1, 1);
    while (glm_vec3_norm2(direction) > 1 || glm_vec3_norm2(direction) < 0.01f);
    glm_vec3_normalize(direction);
}

static void random_light(pnb_light_type type, struct scene_light *light) {
    *light = (struct scene_light){.type = type,
                                  .shape = random_between(0, 1) < 0.5f ? PNB_AREA_RECTANGLE : PNB_AREA_ELLIPSE,
                                  .size = {random_between(0.01f, 1.5f), random_between(0.01f, 1.5f)},
                                  .radius = random_between(0, 0.5f),
                                  .angle = random_between(0, 0.5f),
                                  .spot_angle = random_between(0.1f, 3.1f),
                                  .spot_blend = 0.2f};
    mat4 rotation;
    vec3 axis;
    random_direction(axis);
    glm_rotate_make(rotation, random_between(0, 3.1f), axis);
    for (int column = 0; column < 3; column++)
        for (int row = 0; row < 3; row++)
            light->matrix[4 * column + row] = rotation[column][row];
    light->matrix[15] = 1;
}

static void random_box(struct box *box) {
    for (int i = 0; i < 3; i++) {
        const float center = random_between(-5, 5), half = random_between(0.02f, 1);
        box->minimum[i] = center - half;
        box->maximum[i] = center + half;
    }
}

static void point_in_box(const struct box *box, vec3 point) {
    for (int i = 0; i < 3; i++)
        point[i] = random_between(box->minimum[i], box->maximum[i]);
}

/* ---- Faces ---- */

static void faces_cover_all_directions_once(void) {
    struct scene_light light = {
        .type = PNB_LIGHT_POINT, .radius = 0.1f, .matrix = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1, 2, 3, 1}};
    struct emitter emitter;
    struct light_views views;
    emitter_init(&emitter, &light, (const vec3){0, 0, 0});
    const struct box room = {{-10, -10, -10}, {10, 10, 10}};
    struct hull receivers;
    hull_of_box(&room, &receivers);
    light_views_fit(&views, &emitter, &receivers, 1, &room, 1, 512);
    CHECK_INT(views.count, 6);
    CHECK(!views.single);
    double crooked = 0;
    for (int i = 0; i < views.count; i++) {
        mat3 axes, product;
        glm_mat4_pick3(views.views[i].from_world, axes);
        glm_mat3_mul(axes,
                     (vec3[3]){{axes[0][0], axes[1][0], axes[2][0]},
                               {axes[0][1], axes[1][1], axes[2][1]},
                               {axes[0][2], axes[1][2], axes[2][2]}},
                     product);
        for (int k = 0; k < 9; k++)
            crooked = fmax(crooked, fabs((double)product[k / 3][k % 3] - (k % 4 == 0)));
        crooked = fmax(crooked, fabs((double)glm_mat3_det(axes) - 1));
    }
    CHECK_AT_MOST(crooked, 1e-6);
    int wrong = 0;
    for (int k = 0; k < 20000; k++) {
        vec3 direction, point;
        random_direction(direction);
        glm_vec3_add(emitter.position, direction, point);
        int seen = 0, face_seen = -1;
        for (int face = 0; face < 6; face++) {
            vec3 local;
            glm_mat4_mulv3(views.views[views.layer_of_face[face]].from_world, point, 1, local);
            if (local[2] > 0 && fabsf(local[0]) < local[2] && fabsf(local[1]) < local[2]) {
                seen++;
                face_seen = face;
            }
        }
        /* The face of the longest component, in the documented order. */
        int axis = fabsf(direction[0]) > fabsf(direction[1]) ? 0 : 1;
        axis = fabsf(direction[2]) > fabsf(direction[axis]) ? 2 : axis;
        static const int faces[3][2] = {{1, 2}, {3, 4}, {0, 5}};
        wrong += seen != 1 || face_seen != faces[axis][direction[axis] < 0];
    }
    printf("cube: 20000 directions, %d not seen by exactly the one right face; axes within %.2g\n", wrong, crooked);
    CHECK_INT(wrong, 0);
}

/* ---- Casters ---- */

/* A point of the emitter as the receiver sees it, relative world. */
static void emitter_point(const struct emitter *emitter, const vec3 receiver, vec3 point) {
    float s = random_between(-1, 1), t = random_between(-1, 1);
    while (emitter->ellipse && s * s + t * t > 1) {
        s = random_between(-1, 1);
        t = random_between(-1, 1);
    }
    glm_vec3_copy((float *)emitter->position, point);
    if (emitter->type == PNB_LIGHT_AREA) {
        glm_vec3_muladds((float *)emitter->half_u, s, point);
        glm_vec3_muladds((float *)emitter->half_v, t, point);
    } else if (emitter->type == PNB_LIGHT_SUN) {
        glm_vec3_copy((float *)receiver, point);
        glm_vec3_muladds((float *)emitter->frame[2], -50, point);
        glm_vec3_muladds((float *)emitter->frame[0], 50 * s * emitter->tan_half_angle, point);
        glm_vec3_muladds((float *)emitter->frame[1], 50 * t * emitter->tan_half_angle, point);
    } else {
        vec3 axis, u, v;
        glm_vec3_sub((float *)receiver, (float *)emitter->position, axis);
        glm_vec3_normalize(axis);
        glm_vec3_ortho(axis, u);
        glm_vec3_normalize(u);
        glm_vec3_cross(axis, u, v);
        glm_vec3_muladds(u, s * emitter->radius, point);
        glm_vec3_muladds(v, t * emitter->radius, point);
    }
}

/* A random point of the segment inside the box; false if it misses the box. */
static bool point_on_segment(const vec3 from, const vec3 to, const struct box *box, vec3 point) {
    float low = 1e-4f, high = 1;
    for (int i = 0; i < 3; i++) {
        const float step = to[i] - from[i], a = (box->minimum[i] - from[i]) / step,
                    b = (box->maximum[i] - from[i]) / step;
        low = fmaxf(low, fminf(a, b));
        high = fminf(high, fmaxf(a, b));
    }
    if (!(low < high))
        return false;
    const float t = random_between(low, high);
    for (int i = 0; i < 3; i++)
        point[i] = from[i] + t * (to[i] - from[i]);
    return true;
}

static int face_of(const struct emitter *emitter, const vec3 point) {
    vec3 offset, local;
    glm_vec3_sub((float *)point, (float *)emitter->position, offset);
    for (int i = 0; i < 3; i++)
        local[i] = glm_vec3_dot(offset, (float *)emitter->frame[i]);
    int axis = fabsf(local[0]) > fabsf(local[1]) ? 0 : 1;
    axis = fabsf(local[2]) > fabsf(local[axis]) ? 2 : axis;
    static const int faces[3][2] = {{1, 2}, {3, 4}, {0, 5}};
    return faces[axis][local[axis] < 0];
}

static bool is_lit(const struct emitter *emitter, const vec3 receiver) {
    vec3 offset, local;
    glm_vec3_sub((float *)receiver, (float *)emitter->position, offset);
    for (int i = 0; i < 3; i++)
        local[i] = glm_vec3_dot(offset, (float *)emitter->frame[i]);
    if (emitter->type == PNB_LIGHT_AREA)
        return local[2] > 0;
    if (emitter->type == PNB_LIGHT_SPOT)
        return local[2] > emitter->cos_cone * glm_vec3_norm(local);
    return true;
}

struct tally {
    int segments, outside, too_near, too_wide, no_view;
    double worst;
};

/* Longest of the components across the view over that along it: how wide a view must be to show the point. */
static float view_tangent(const struct emitter *emitter, int face, const vec3 point) {
    static const int axes[6] = {2, 0, 0, 1, 1, 2};
    static const float signs[6] = {1, 1, -1, 1, -1, -1};
    vec3 offset;
    float local[3], across = 0;
    glm_vec3_sub((float *)point, (float *)emitter->position, offset);
    for (int i = 0; i < 3; i++) {
        local[i] = glm_vec3_dot(offset, (float *)emitter->frame[i]);
        if (i != axes[face])
            across = fmaxf(across, fabsf(local[i]));
    }
    const float along = local[axes[face]] * signs[face];
    return along > 0 ? across / along : INFINITY;
}

/* Whether the blocker lies in the receiver's view. Two limits are the design's own: a view is no wider than a
 * half-width of 2.5 (the face of a cube: 1.5), and nothing nearer than 1e-4 of its far plane is drawn. */
static void check_blocker(const struct emitter *emitter, const struct light_views *views, const vec3 receiver,
                          const vec3 blocker, struct tally *tally) {
    const int face = views->single ? 0 : face_of(emitter, receiver), layer = views->layer_of_face[face];
    const bool perspective = emitter->type != PNB_LIGHT_SUN;
    tally->segments++;
    if (perspective && view_tangent(emitter, face, blocker) > (views->single ? 2.5f : 1.5f)) {
        tally->too_wide++;
        return;
    }
    if (layer < 0) {
        tally->no_view++;
        return;
    }
    const struct light_view *view = &views->views[layer];
    vec3 local;
    glm_mat4_mulv3((vec4 *)view->from_world, (float *)blocker, 1, local);
    const float depth = local[2];
    if (perspective && depth <= 1e-4f * view->far_depth) {
        tally->too_near++;
        return;
    }
    double outside = 0;
    for (int i = 0; i < 2; i++) {
        const double q = perspective ? (double)local[i] / (double)depth : (double)local[i];
        const double uv = (q - (double)view->rect[i]) * (double)view->rect[i + 2];
        outside = fmax(outside, fmax(-uv, uv - 1));
    }
    const double d = ((double)depth - (double)view->near_depth) / ((double)view->far_depth - (double)view->near_depth);
    outside = fmax(outside, fmax(-d, d - 1));
    tally->outside += outside > 0;
    tally->worst = fmax(tally->worst, outside);
}

static void blockers_lie_in_the_view(pnb_light_type type, const char *name) {
    struct tally tally = {0};
    for (int i = 0; i < 3000; i++) {
        struct scene_light light;
        struct emitter emitter;
        struct light_views views;
        struct box receivers[4], casters[4];
        struct hull hulls[4];
        random_light(type, &light);
        emitter_init(&emitter, &light, (const vec3){0, 0, 0});
        for (int k = 0; k < 4; k++) {
            random_box(&receivers[k]);
            random_box(&casters[k]);
            hull_of_box(&receivers[k], &hulls[k]);
        }
        light_views_fit(&views, &emitter, hulls, 4, casters, 4, 1024);
        for (int k = 0; k < 400; k++) {
            vec3 receiver, point, blocker;
            point_in_box(&receivers[k % 4], receiver);
            emitter_point(&emitter, receiver, point);
            if (is_lit(&emitter, receiver) && point_on_segment(receiver, point, &casters[k / 4 % 4], blocker))
                check_blocker(&emitter, &views, receiver, blocker, &tally);
        }
    }
    printf("%-5s %d blocked segments: %d without a view, %d outside their view (by up to %.2g of its side), beyond the "
           "design's limits %d too wide, %d too near\n",
           name, tally.segments, tally.no_view, tally.outside, tally.worst, tally.too_wide, tally.too_near);
    CHECK(tally.segments > 1000);
    CHECK_INT(tally.no_view, 0);
    CHECK_INT(tally.outside, 0);
}

int main(void) {
    faces_cover_all_directions_once();
    blockers_lie_in_the_view(PNB_LIGHT_AREA, "AREA");
    blockers_lie_in_the_view(PNB_LIGHT_POINT, "POINT");
    blockers_lie_in_the_view(PNB_LIGHT_SPOT, "SPOT");
    blockers_lie_in_the_view(PNB_LIGHT_SUN, "SUN");
    return check_report();
}
