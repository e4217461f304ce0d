/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "axes.h"
#include "numbers.h"
#include "scene_parts.h"

#include <math.h>
#include <string.h>

static const float PI = 3.14159265f;
#define DEFAULT_SPOT_ANGLE (PI / 4)
#define MIN_SPOT_ANGLE     1e-3f
/* A narrower cone has nothing to integrate, a wider one is none. */
#define MIN_SPREAD 0.0174533f
#define MAX_SPREAD 3.14f

/* Brings a value into its range; a message tells what was changed. `what` names the member with its unit. */
static float clamped(float value, float minimum, float maximum, const char *name, const char *what,
                     struct messages *messages) {
    float result = value < minimum ? minimum : value > maximum ? maximum : value;
    if (result != value) {
        messages_add(messages, "light '%s': its %s of %g is taken as %g", name, what, (double)value, (double)result);
    }
    return result;
}

/* Makes sizes positive. */
static void light_resolve_signs(struct scene_light *light, const char *name, struct messages *messages) {
    const struct {
        float *value;
        const char *what;
    } sizes[] = {{&light->size[0], "width"},
                 {&light->size[1], "height"},
                 {&light->radius, "radius"},
                 {&light->angle, "angle"},
                 {&light->spot_angle, "cone angle"}};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        float size = fabsf(*sizes[i].value);
        *sizes[i].value = clamped(*sizes[i].value, size, size, name, sizes[i].what, messages);
    }
}

/* Makes both sides wide enough to be an emitter. */
static void light_resolve_size(struct scene_light *light) {
    for (int i = 0; i < 2; i++) {
        float scale = axis_length(light->matrix + 4 * i), smallest = SCENE_MIN_EMITTER / scale;
        light->size[i] = light->size[i] < smallest ? smallest : light->size[i];
    }
}

/* A scale of 0 leaves a direction at most: the emitter is then as small as can be, and the cone is not scaled. */
static void light_resolve_axes(struct scene_light *light, const char *name, struct messages *messages) {
    unsigned replaced = axes_complete(light->matrix);
    if (!replaced) {
        return;
    }
    messages_add(messages, "light '%s': its matrix is singular (a scale of 0?); the missing axes are made up", name);
    for (int i = 0; i < 2; i++) {
        if (replaced & 1u << i) {
            light->size[i] = 0;
        }
    }
    if (light->type == PNB_LIGHT_SPOT) {
        axes_orthonormalize(light->matrix);
    }
}

/* Copies what belongs to the light's type. */
static void light_copy(const pnb_light *from, struct scene_light *to) {
    to->type = from->type;
    to->flags = from->flags;
    memcpy(to->matrix, from->matrix, sizeof to->matrix);
    matrix_make_affine(to->matrix);
    memcpy(to->emission, from->emission, sizeof to->emission);
    to->shadow_map_size = from->shadow_map_size;
    if (from->type == PNB_LIGHT_AREA) {
        to->shape = from->shape;
        memcpy(to->size, from->size, sizeof to->size);
        to->spread = from->spread;
    }
    if (from->type == PNB_LIGHT_POINT || from->type == PNB_LIGHT_SPOT) {
        to->radius = from->radius;
    }
    if (from->type == PNB_LIGHT_SUN) {
        to->angle = from->angle;
    }
    if (from->type == PNB_LIGHT_SPOT) {
        to->spot_angle = from->spot_angle != 0 ? from->spot_angle : DEFAULT_SPOT_ANGLE;
        to->spot_blend = from->spot_blend;
    }
}

static void light_resolve_shadow_color(const float from[3], const char *name, struct messages *messages, float to[3]) {
    bool good = true;
    for (int i = 0; i < 3; i++) {
        to[i] = from[i] > 0 ? fminf(from[i], 1) : 0; /* NaN: 0 */
        good = good && to[i] == from[i];
    }
    if (!good) {
        messages_add(messages, "light '%s': its shadow colour is out of range and is taken as (%g, %g, %g)", name,
                     (double)to[0], (double)to[1], (double)to[2]);
    }
}

static bool light_is_usable(const struct scene_light *light) {
    const float others[] = {light->size[0],    light->size[1],    light->radius, light->angle,
                            light->spot_angle, light->spot_blend, light->spread};
    bool usable = numbers_usable(light->matrix, 16) && numbers_usable(light->emission, 3) &&
                  numbers_within(light->matrix + 12, 3, LARGEST_COORDINATE) &&
                  numbers_within(others, sizeof others / sizeof *others, LARGEST_COORDINATE);
    for (int i = 0; usable && i < 2; i++) {
        float width = light->size[i] * axis_length(light->matrix + 4 * i);
        usable = numbers_within(&width, 1, LARGEST_COORDINATE);
    }
    return usable;
}

bool light_resolve(const pnb_light *from, const char *name, struct messages *messages, struct scene_light *to) {
    *to = (struct scene_light){0};
    light_copy(from, to);
    if (!light_is_usable(to)) {
        messages_add(messages, "light '%s': dropped: its matrix, emission or size is not finite or too large", name);
        return false;
    }
    for (int i = 0; i < 3; i++) {
        to->emission[i] = clamped(to->emission[i], 0, LARGEST_NUMBER, name, "emission", messages);
    }
    light_resolve_signs(to, name, messages);
    light_resolve_shadow_color(from->shadow_color, name, messages, to->shadow_color);
    light_resolve_axes(to, name, messages);
    if (to->type == PNB_LIGHT_AREA) {
        light_resolve_size(to);
        to->spread = clamped(to->spread, 0, PI, name, "spread", messages);
        to->spread = to->spread > 0 ? fmaxf(to->spread, MIN_SPREAD) : 0;
        to->spread = to->spread < MAX_SPREAD ? to->spread : 0;
    }
    if (to->type == PNB_LIGHT_SPOT) {
        to->spot_angle = clamped(to->spot_angle, MIN_SPOT_ANGLE, PI, name, "cone angle", messages);
        to->spot_blend = clamped(to->spot_blend, 0, 1, name, "cone blend", messages);
    }
    to->angle = clamped(to->angle, 0, SCENE_MAX_SUN_ANGLE, name, "angle", messages);
    return true;
}
