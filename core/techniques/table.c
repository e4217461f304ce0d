/* SPDX-License-Identifier: GPL-3.0-or-later
 * The list of techniques. Adding one: declare it, add it here; its order is the order in user interfaces. */
#include "technique.h"

#include <string.h>
#include <strings.h>

extern const struct technique technique_hard, technique_pcf, technique_pcss, technique_esm, technique_essm,
    technique_multilayer, technique_reference;

const struct technique *const techniques[] = {
    &technique_hard, &technique_pcf,        &technique_pcss,      &technique_esm,
    &technique_essm, &technique_multilayer, &technique_reference, NULL};
_Static_assert(sizeof techniques / sizeof *techniques - 1 <= MAX_TECHNIQUES, "settings hold the values of all");

const struct technique *technique_find(const char *id) {
    for (int i = 0; techniques[i]; i++)
        if (strcasecmp(techniques[i]->id, id) == 0)
            return techniques[i];
    return NULL;
}

int technique_index(const struct technique *technique) {
    int index = 0;
    while (techniques[index] != technique)
        index++;
    return index;
}

int technique_parameter(const struct technique *technique, const char *name) {
    for (int i = 0; technique->parameters[i].name; i++)
        if (strcmp(technique->parameters[i].name, name) == 0)
            return i;
    return -1;
}

static bool is_on(const struct technique *technique, const char *parameter, const double *parameters) {
    const int index = technique_parameter(technique, parameter);
    return index >= 0 && parameters[index] > 0.0;
}

bool technique_skips(const struct technique *technique, const double *parameters) {
    return is_on(technique, SKIP_PARAMETER, parameters);
}

bool technique_subsamples(const struct technique *technique, const double *parameters) {
    return is_on(technique, SUBSAMPLING_PARAMETER, parameters);
}

uint32_t pnb_technique_count(void) {
    uint32_t count = 0;
    while (techniques[count])
        count++;
    return count;
}

static uint32_t parameter_count(const struct technique *technique) {
    uint32_t count = 0;
    while (technique->parameters[count].name)
        count++;
    return count;
}

pnb_result pnb_technique_get_info(uint32_t index, pnb_technique_info *info) {
    pnb_result result = CHECK_STRUCT(info, pnb_technique_info);
    if (result != PNB_OK)
        return result;
    if (index >= pnb_technique_count())
        return error_set(PNB_ERROR_INVALID_ARGUMENT, "there are %u techniques, no number %u", pnb_technique_count(),
                         index);
    const struct technique *technique = techniques[index];
    *info = (pnb_technique_info){.struct_size = sizeof *info,
                                 .parameter_count = parameter_count(technique),
                                 .id = technique->id,
                                 .label = technique->label,
                                 .description = technique->description,
                                 .paper = technique->paper};
    return PNB_OK;
}

pnb_result pnb_technique_get_parameter(uint32_t index, uint32_t number, pnb_parameter_info *info) {
    pnb_result result = CHECK_STRUCT(info, pnb_parameter_info);
    if (result != PNB_OK)
        return result;
    if (index >= pnb_technique_count() || number >= parameter_count(techniques[index]))
        return error_set(PNB_ERROR_INVALID_ARGUMENT, "technique %u has no parameter %u", index, number);
    const struct parameter *parameter = &techniques[index]->parameters[number];
    *info = (pnb_parameter_info){.struct_size = sizeof *info,
                                 .type = parameter->type,
                                 .name = parameter->name,
                                 .label = parameter->label,
                                 .description = parameter->description,
                                 .unit = parameter->unit,
                                 .minimum = parameter->minimum,
                                 .maximum = parameter->maximum,
                                 .default_value = parameter->default_value,
                                 .items = parameter->items};
    while (parameter->items && parameter->items[info->item_count])
        info->item_count++;
    return PNB_OK;
}
