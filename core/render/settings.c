/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "settings.h"
#include "../techniques/technique.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define DEFAULT_PASSES (PNB_PASS_COMBINED | PNB_PASS_DEPTH | PNB_PASS_NORMAL | PNB_PASS_SHADOW)
#define KNOWN_FLAGS  (PNB_SETTINGS_FILM_TRANSPARENT | PNB_SETTINGS_PROGRESSIVE | PNB_SETTINGS_QUICK)
#define KNOWN_PASSES                                                                                                   \
    (DEFAULT_PASSES | PNB_PASS_LIGHT_SHADOWS | PNB_PASS_BLOCKERS | PNB_PASS_PENUMBRAE | PNB_PASS_SHADOW_MAPS)

static uint32_t or_default(uint32_t value, uint32_t fallback) {
    return value ? value : fallback;
}

static pnb_result check_range(const char *name, uint32_t value, uint32_t minimum, uint32_t maximum) {
    if (value >= minimum && value <= maximum)
        return PNB_OK;
    return error_set(PNB_ERROR_INVALID_ARGUMENT, "%s is %u, allowed are %u to %u", name, value, minimum, maximum);
}

/* Sizes beyond the context's limit are a matter of the machine, not of the call. */
static pnb_result check_size(const char *name, uint32_t value, uint32_t minimum, uint32_t limit) {
    if (value > limit)
        return error_set(PNB_ERROR_UNSUPPORTED, "%s is %u, this OpenGL allows at most %u", name, value, limit);
    return check_range(name, value, minimum, limit);
}

static pnb_result check_bits(const char *name, uint32_t value, uint32_t known) {
    if (!(value & ~known))
        return PNB_OK;
    return error_set(PNB_ERROR_INVALID_ARGUMENT, "settings: unknown %s 0x%x", name, value & ~known);
}

static float resolve_filter_width(float width, struct messages *messages) {
    const float fallback = 1.5f;
    if (width > 0 && width < 100)
        return width;
    if (width != 0)
        messages_add(messages, "settings: filter_width is %g, taken as %g", (double)width, (double)fallback);
    return fallback;
}

static pnb_result resolve_crop(const pnb_settings *from, struct settings *to) {
    memcpy(to->crop, from->crop, sizeof to->crop);
    if (to->crop[2] == 0) {
        to->crop[0] = to->crop[1] = 0;
        to->crop[2] = to->width;
        to->crop[3] = to->height;
    }
    const uint32_t *c = to->crop;
    if (c[3] == 0 || c[0] >= to->width || c[2] > to->width - c[0] || c[1] >= to->height || c[3] > to->height - c[1])
        return error_set(PNB_ERROR_INVALID_ARGUMENT, "crop %u,%u %u x %u does not lie in the %u x %u image", c[0], c[1],
                         c[2], c[3], to->width, to->height);
    return PNB_OK;
}

/* "name" or "TECHNIQUE.name": sets *technique and gives the parameter's index, below 0 after error_set. */
static int find_parameter(const char *qualified, const struct technique **technique) {
    const char *name = qualified ? qualified : "(null)", *dot = strchr(name, '.');
    char id[32];
    if (dot) {
        const size_t length = (size_t)(dot - name);
        snprintf(id, sizeof id, "%.*s", (int)(length < sizeof id ? length : sizeof id - 1), name);
        *technique = technique_find(id);
        if (!*technique) {
            error_set(PNB_ERROR_INVALID_ARGUMENT, "parameter '%s': there is no technique '%s'", name, id);
            return -1;
        }
        name = dot + 1;
    }
    const int index = technique_parameter(*technique, name);
    if (index < 0)
        error_set(PNB_ERROR_INVALID_ARGUMENT, "technique %s has no parameter '%s'", (*technique)->id, name);
    return index;
}

static pnb_result resolve_value(const pnb_value *from, struct messages *messages, struct settings *to) {
    const struct technique *technique = to->technique;
    const int index = find_parameter(from->name, &technique);
    if (index < 0)
        return PNB_ERROR_INVALID_ARGUMENT;
    const struct parameter *parameter = &technique->parameters[index];
    if (!isfinite(from->value))
        return error_set(PNB_ERROR_INVALID_ARGUMENT, "parameter '%s' is not a finite number", from->name);
    double value = parameter->type == PNB_FLOAT ? from->value : round(from->value);
    const double clamped = fmin(fmax(value, parameter->minimum), parameter->maximum);
    if (clamped != value)
        messages_add(messages, "%s: parameter '%s' is %g, taken as %g", technique->id, parameter->name, value, clamped);
    to->parameters[technique_index(technique)][index] = clamped;
    return PNB_OK;
}

static pnb_result resolve_technique(const pnb_settings *from, struct messages *messages, struct settings *to) {
    const char *id = from->technique ? from->technique : "PCSS";
    to->technique = technique_find(id);
    if (!to->technique)
        return error_set(PNB_ERROR_INVALID_ARGUMENT, "there is no technique '%s'", id);
    for (int t = 0; techniques[t]; t++)
        for (int i = 0; techniques[t]->parameters[i].name; i++)
            to->parameters[t][i] = techniques[t]->parameters[i].default_value;
    if (from->value_count && !from->values)
        return error_set(PNB_ERROR_INVALID_ARGUMENT, "settings: values is NULL");
    for (uint32_t i = 0; i < from->value_count; i++) {
        pnb_result result = resolve_value(&from->values[i], messages, to);
        if (result != PNB_OK)
            return result;
    }
    return PNB_OK;
}

static pnb_result check_light(const struct scene_light *light, uint32_t max_texture_size) {
    if (light->technique && !technique_find(light->technique))
        return error_set(PNB_ERROR_INVALID_ARGUMENT, "light '%s': there is no technique '%s'", light->name,
                         light->technique);
    if (light->shadow_map_size == 0)
        return PNB_OK;
    char name[128];
    snprintf(name, sizeof name, "light '%.64s': its shadow_map_size", light->name);
    return check_size(name, light->shadow_map_size, 16, max_texture_size);
}

pnb_result settings_check_lights(const struct scene *scene, uint32_t max_texture_size) {
    pnb_result result = PNB_OK;
    for (uint32_t i = 0; i < scene->light_count && result == PNB_OK; i++)
        result = check_light(&scene->lights[i], max_texture_size);
    return result;
}

const struct technique *settings_technique(const struct settings *settings, const struct scene_light *light) {
    return light->technique ? technique_find(light->technique) : settings->technique;
}

uint32_t settings_map_size(const struct settings *settings, const struct scene_light *light) {
    return light->shadow_map_size ? light->shadow_map_size : settings->shadow_map_size;
}

pnb_result settings_resolve(const pnb_settings *from, uint32_t max_texture_size, struct messages *messages,
                            struct settings *to) {
    pnb_result result = CHECK_STRUCT(from, pnb_settings);
    if (result != PNB_OK)
        return result;
    *to = (struct settings){
        .flags = from->flags,
        .width = from->width,
        .height = from->height,
        .samples = or_default(from->samples, PNB_DEFAULT_SAMPLES),
        .filter_width = resolve_filter_width(from->filter_width, messages),
        .shadow_map_size = or_default(from->shadow_map_size, PNB_DEFAULT_MAP_SIZE),
        .light_samples = or_default(from->light_samples, PNB_DEFAULT_LIGHT_SAMPLES),
        .passes = or_default(from->passes, DEFAULT_PASSES),
    };
    if ((result = check_bits("flags", to->flags, KNOWN_FLAGS)) != PNB_OK ||
        (result = check_bits("passes", to->passes, KNOWN_PASSES)) != PNB_OK ||
        (result = check_size("width", to->width, 1, max_texture_size)) != PNB_OK ||
        (result = check_size("height", to->height, 1, max_texture_size)) != PNB_OK ||
        (result = check_size("shadow_map_size", to->shadow_map_size, 16, max_texture_size)) != PNB_OK ||
        (result = check_range("samples", to->samples, 1, 4096)) != PNB_OK ||
        (result = check_range("light_samples", to->light_samples, 1, 64)) != PNB_OK ||
        (result = resolve_crop(from, to)) != PNB_OK)
        return result;
    return resolve_technique(from, messages, to);
}
