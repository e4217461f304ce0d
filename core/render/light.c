/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "light.h"

#include <math.h>

/* World matrix columns without their lengths, made orthonormal with Z = -column 2, the direction of emission. */
static void emitter_frame(const float matrix[16], mat3 frame) {
    vec3 x = {matrix[0], matrix[1], matrix[2]}, y = {matrix[4], matrix[5], matrix[6]};
    vec3 z = {-matrix[8], -matrix[9], -matrix[10]};
    if (glm_vec3_norm2(z) < 1e-30f)
        glm_vec3_cross(y, x, z); /* a light squashed flat along Z still shines along -Z */
    if (glm_vec3_norm2(z) < 1e-30f)
        glm_vec3_copy((vec3){0, 0, -1}, z);
    glm_vec3_normalize(z);
    glm_vec3_muladds(z, -glm_vec3_dot(x, z), x);
    if (glm_vec3_norm2(x) < 1e-12f * glm_vec3_norm2((vec3){matrix[0], matrix[1], matrix[2]}) ||
        glm_vec3_norm2(x) < 1e-30f)
        glm_vec3_ortho(z, x);
    glm_vec3_normalize(x);
    glm_vec3_copy(x, frame[0]);
    glm_vec3_cross(z, x, frame[1]);
    glm_vec3_copy(z, frame[2]);
}

static float column_length(const float matrix[16], int column) {
    return glm_vec3_norm((vec3){matrix[4 * column], matrix[4 * column + 1], matrix[4 * column + 2]});
}

void emitter_init(struct emitter *emitter, const struct scene_light *light, const vec3 origin) {
    *emitter = (struct emitter){.type = light->type,
                                .ellipse = light->type != PNB_LIGHT_AREA || light->shape == PNB_AREA_ELLIPSE,
                                .casts_shadow = !(light->flags & PNB_LIGHT_NO_SHADOW),
                                .blend = light->spot_blend,
                                .cosine_spot = light->flags & PNB_LIGHT_COSINE_SPOT};
    const float *m = light->matrix;
    for (int i = 0; i < 3; i++) {
        /* In double: the difference of two large numbers. */
        emitter->position[i] = (float)((double)m[12 + i] - (double)origin[i]);
        emitter->half_u[i] = 0.5f * light->size[0] * m[i];
        emitter->half_v[i] = 0.5f * light->size[1] * m[4 + i];
        emitter->emission[i] = light->emission[i];
    }
    emitter_frame(m, emitter->frame);
    emitter->tan_half_spread = tanf(0.5f * light->spread);
    if (light->type == PNB_LIGHT_POINT)
        glm_mat3_identity(emitter->frame); /* shines everywhere: its rotation must not change the shadow */
    if (light->type == PNB_LIGHT_POINT || light->type == PNB_LIGHT_SPOT)
        emitter->radius = light->radius;
    if (light->type == PNB_LIGHT_SPOT)
        emitter->cone_offset = light->radius; /* each point of the bulb shines into a cone of its own */
    if (light->type == PNB_LIGHT_SUN)
        emitter->tan_half_angle = tanf(fminf(0.5f * light->angle, 1.5f));
    emitter->cos_cone = cosf(0.5f * light->spot_angle);
    const float z = fmaxf(column_length(m, 2), 1e-12f);
    emitter->cone_scale[0] = column_length(m, 0) / z;
    emitter->cone_scale[1] = column_length(m, 1) / z;
}
