/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "emitter_samples.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static float dot(const float a[3], const float b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(const float a[3], const float b[3], float result[3]) {
    for (int i = 0; i < 3; i++)
        result[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}

static void normalize(float vector[3]) {
    float length = sqrtf(dot(vector, vector));
    for (int i = 0; i < 3; i++)
        vector[i] /= length;
}

/* ---- Points ---- */

static float next_random(uint32_t *state) {
    *state ^= *state << 13;
    *state ^= *state >> 17;
    *state ^= *state << 5;
    return (float)(*state >> 8) / 16777216.0f;
}

/* Concentric map of the square -1..1 onto the unit disk, which keeps areas (Shirley and Chiu 1997). */
static void square_to_disk(float point[2]) {
    float x = point[0], y = point[1];
    if (x == 0 && y == 0)
        return;
    bool wide = fabsf(x) > fabsf(y);
    float radius = wide ? x : y;
    float angle = wide ? 0.78539816f * (y / x) : 1.57079633f - 0.78539816f * (x / y);
    point[0] = radius * cosf(angle);
    point[1] = radius * sinf(angle);
}

static void fill_set(float *points, uint32_t count, bool disk, uint32_t *random) {
    uint32_t columns = (uint32_t)sqrtf((float)count);
    while (count % columns)
        columns--;
    uint32_t rows = count / columns;
    for (uint32_t i = 0; i < count; i++) {
        float *point = points + 2 * (size_t)i;
        point[0] = 2 * ((float)(i % columns) + next_random(random)) / (float)columns - 1;
        point[1] = 2 * ((float)(i / columns) + next_random(random)) / (float)rows - 1;
        if (disk)
            square_to_disk(point);
    }
}

/* ---- Lights ---- */

static void set_area(struct emitter_samples *samples, const struct scene_light *light) {
    const float *m = light->matrix;
    bool ellipse = light->shape == PNB_AREA_ELLIPSE;
    float normal[3];
    for (int i = 0; i < 3; i++) {
        samples->axis_u[i] = m[i] * light->size[0] / 2;
        samples->axis_v[i] = m[4 + i] * light->size[1] / 2;
    }
    cross(samples->axis_u, samples->axis_v, normal);
    float area = sqrtf(dot(normal, normal)) * (ellipse ? 3.14159265f : 4);
    for (int i = 0; i < 3; i++)
        samples->emission[i] *= area;
    samples->one_sided = true;
}

static void set_spot(struct emitter_samples *samples, const struct scene_light *light) {
    const float *m = light->matrix;
    float z_length = sqrtf(dot(m + 8, m + 8));
    for (int axis = 0; axis < 2; axis++) {
        float square = dot(m + 4 * axis, m + 4 * axis);
        for (int i = 0; i < 3; i++)
            samples->cone_axes[axis][i] = m[4 * axis + i] * z_length / square;
    }
    samples->cos_cone = cosf(light->spot_angle / 2);
    samples->blend = light->spot_blend;
}

bool emitter_samples_create(struct emitter_samples *samples, const struct scene_light *light, uint32_t count,
                            uint32_t seed) {
    *samples = (struct emitter_samples){.type = light->type, .radius = light->radius, .count = count};
    samples->shadows = !(light->flags & PNB_LIGHT_NO_SHADOW);
    memcpy(samples->emission, light->emission, sizeof samples->emission);
    for (int i = 0; i < 3; i++) {
        samples->position[i] = light->matrix[12 + i];
        samples->direction[i] = -light->matrix[8 + i];
    }
    normalize(samples->direction);
    if (light->type == PNB_LIGHT_AREA)
        set_area(samples, light);
    if (light->type == PNB_LIGHT_SPOT)
        set_spot(samples, light);
    if (light->type == PNB_LIGHT_SUN)
        samples->radius = tanf(light->angle / 2);
    bool disk = light->type != PNB_LIGHT_AREA || light->shape == PNB_AREA_ELLIPSE;
    samples->points = malloc(SAMPLE_SETS * (size_t)count * 2 * sizeof(float));
    if (!samples->points)
        return false;
    uint32_t random = 0x9e3779b9u * (seed + 1);
    for (uint32_t set = 0; set < SAMPLE_SETS; set++)
        fill_set(samples->points + 2 * (size_t)set * count, count, disk, &random);
    return true;
}

void emitter_samples_free(struct emitter_samples *samples) {
    free(samples->points);
    samples->points = NULL;
}

/* ---- As a receiver sees it ---- */

/* Two vectors of length `radius` across `axis` (unit). */
static void disk_axes(const float axis[3], float radius, float u[3], float v[3]) {
    const float other[3] = {fabsf(axis[0]) < 0.7f ? 1.0f : 0.0f, fabsf(axis[0]) < 0.7f ? 0.0f : 1.0f, 0};
    cross(other, axis, u);
    normalize(u);
    cross(axis, u, v);
    for (int i = 0; i < 3; i++) {
        u[i] *= radius;
        v[i] *= radius;
    }
}

/* Smooth edge of the cone: the cosine to the axis in a space where the cone is round. */
static float cone_share(const struct emitter_samples *samples, const float way[3]) {
    float x = dot(way, samples->cone_axes[0]), y = dot(way, samples->cone_axes[1]), z = dot(way, samples->direction);
    float cosine = z / sqrtf(x * x + y * y + z * z);
    float width = (1 - samples->cos_cone) * samples->blend;
    if (cosine <= samples->cos_cone)
        return 0;
    float t = width > 0 ? fminf((cosine - samples->cos_cone) / width, 1) : 1;
    return t * t * (3 - 2 * t);
}

struct emitter_view emitter_view(const struct emitter_samples *samples, const float position[3]) {
    struct emitter_view view = {.attenuation = 1};
    if (samples->type == PNB_LIGHT_AREA) {
        memcpy(view.axis_u, samples->axis_u, sizeof view.axis_u);
        memcpy(view.axis_v, samples->axis_v, sizeof view.axis_v);
        return view;
    }
    float way[3];
    for (int i = 0; i < 3; i++)
        way[i] = samples->type == PNB_LIGHT_SUN ? samples->direction[i] : position[i] - samples->position[i];
    normalize(way);
    disk_axes(way, samples->radius, view.axis_u, view.axis_v);
    if (samples->type == PNB_LIGHT_SPOT)
        view.attenuation = cone_share(samples, way);
    return view;
}
