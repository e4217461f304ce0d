/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "options.h"

#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

bool parse_count(const char *option, const char *text, uint32_t minimum, uint32_t maximum, uint32_t *value) {
    char *end;
    errno = 0;
    unsigned long long number = strtoull(text, &end, 10);
    if (!isdigit((unsigned char)text[0]) || *end || errno || number < minimum || number > maximum)
        return tool_error("%s wants a whole number from %u to %u, not '%s'", option, minimum, maximum, text);
    *value = (uint32_t)number;
    return true;
}

static bool read_real(const char *text, double *value) {
    char *end;
    *value = strtod(text, &end);
    return end != text && !*end && isfinite(*value);
}

bool parse_real(const char *option, const char *text, double minimum, double maximum, double *value) {
    double number;
    if (!read_real(text, &number) || number < minimum || number > maximum)
        return tool_error("%s wants a number from %g to %g, not '%s'", option, minimum, maximum, text);
    *value = number;
    return true;
}

/* `count` whole numbers with the given separator and nothing else. */
static bool read_counts(const char *text, char separator, uint32_t *values, int count) {
    for (int i = 0; i < count; i++) {
        char *end;
        errno = 0;
        unsigned long long number = strtoull(text, &end, 10);
        if (!isdigit((unsigned char)text[0]) || errno || number > UINT32_MAX)
            return false;
        values[i] = (uint32_t)number;
        if (*end != (i + 1 < count ? separator : '\0'))
            return false;
        text = end + 1;
    }
    return true;
}

bool parse_size(const char *option, const char *text, uint32_t size[2]) {
    if (!read_counts(text, 'x', size, 2) || !size[0] || !size[1])
        return tool_error("%s wants WIDTHxHEIGHT in pixels, such as 1280x720, not '%s'", option, text);
    return true;
}

bool parse_crop(const char *option, const char *text, uint32_t crop[4]) {
    if (!read_counts(text, ',', crop, 4) || !crop[2] || !crop[3])
        return tool_error("%s wants X,Y,WIDTH,HEIGHT in pixels from the lower left, not '%s'", option, text);
    return true;
}

bool parse_pass(const char *option, const char *text, uint32_t *passes) {
    static const struct {
        const char *name;
        uint32_t flag;
    } names[] =
        {
            {"Combined", PNB_PASS_COMBINED},
            {"Depth", PNB_PASS_DEPTH},
            {"Normal", PNB_PASS_NORMAL},
            {"Shadow", PNB_PASS_SHADOW},
        },
      of_lights[] = {
          {"Shadow.", PNB_PASS_LIGHT_SHADOWS},
          {"Blocker.", PNB_PASS_BLOCKERS},
          {"Penumbra.", PNB_PASS_PENUMBRAE},
          {"Map.", PNB_PASS_SHADOW_MAPS},
      };
    *passes = 0;
    for (size_t i = 0; i < sizeof of_lights / sizeof *of_lights; i++)
        if (strncmp(text, of_lights[i].name, strlen(of_lights[i].name)) == 0)
            *passes = of_lights[i].flag;
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (strcmp(text, names[i].name) == 0)
            *passes = names[i].flag;
    return *passes ||
           tool_error("%s wants Combined, Depth, Normal, Shadow or Shadow., Blocker., Penumbra. or Map.<name of a "
                      "light>, not '%s'",
                      option, text);
}

/* ---- Techniques, by reflection ---- */

static pnb_technique_info technique_info(uint32_t technique) {
    pnb_technique_info info = PNB_INIT(pnb_technique_info);
    pnb_technique_get_info(technique, &info);
    return info;
}

const char *technique_id(uint32_t technique) {
    return technique_info(technique).id;
}

bool parse_technique(const char *option, const char *text, uint32_t *technique) {
    for (uint32_t i = 0; i < pnb_technique_count(); i++) {
        if (strcasecmp(technique_id(i), text) == 0) {
            *technique = i;
            return true;
        }
    }
    fprintf(stderr, "penumbra: %s: there is no technique '%s'; there are", option, text);
    for (uint32_t i = 0; i < pnb_technique_count(); i++)
        fprintf(stderr, "%s %s", i ? "," : "", technique_id(i));
    fputc('\n', stderr);
    return false;
}

static bool find_parameter(uint32_t technique, const char *name, size_t length, pnb_parameter_info *info) {
    uint32_t count = technique_info(technique).parameter_count;
    for (uint32_t i = 0; i < count; i++) {
        *info = (pnb_parameter_info)PNB_INIT(pnb_parameter_info);
        if (pnb_technique_get_parameter(technique, i, info) == PNB_OK && strlen(info->name) == length &&
            strncmp(info->name, name, length) == 0)
            return true;
    }
    return false;
}

static bool read_bool(const char *text, double *value) {
    bool yes = strcasecmp(text, "true") == 0 || strcmp(text, "1") == 0;
    bool no = strcasecmp(text, "false") == 0 || strcmp(text, "0") == 0;
    *value = yes;
    return yes || no;
}

static bool read_item(const pnb_parameter_info *info, const char *text, double *value) {
    for (uint32_t i = 0; i < info->item_count; i++) {
        if (strcasecmp(info->items[i], text) == 0) {
            *value = i;
            return true;
        }
    }
    return false;
}

static bool report_bad_value(const pnb_parameter_info *info, const char *text) {
    fprintf(stderr, "penumbra: -p %s wants ", info->name);
    if (info->type == PNB_BOOL)
        fputs("true or false", stderr);
    else if (info->type == PNB_ENUM)
        for (uint32_t i = 0; i < info->item_count; i++)
            fprintf(stderr, "%s%s", i ? (i + 1 < info->item_count ? ", " : " or ") : "", info->items[i]);
    else
        fprintf(stderr, "%s from %g to %g", info->type == PNB_INT ? "a whole number" : "a number", info->minimum,
                info->maximum);
    fprintf(stderr, ", not '%s'\n", text);
    return false;
}

bool parse_assignment(const char *text, uint32_t technique, pnb_value *value, bool *known) {
    *known = true;
    const char *equals = strchr(text, '=');
    if (!equals)
        return tool_error("-p wants NAME=VALUE, not '%s'", text);
    pnb_parameter_info info;
    if (!find_parameter(technique, text, (size_t)(equals - text), &info))
        return *known = false;
    const char *right = equals + 1;
    double number;
    bool good;
    if (info.type == PNB_BOOL)
        good = read_bool(right, &number);
    else if (info.type == PNB_ENUM)
        good = read_item(&info, right, &number);
    else
        good = read_real(right, &number) && number >= info.minimum && number <= info.maximum &&
               (info.type != PNB_INT || number == floor(number));
    if (!good)
        return report_bad_value(&info, right);
    *value = (pnb_value){.name = info.name, .value = number};
    return true;
}

bool report_unknown_parameter(const char *assignment, uint32_t technique) {
    pnb_technique_info technique_row = technique_info(technique);
    fprintf(stderr, "penumbra: -p %s: %s has no such parameter; it has", assignment, technique_row.id);
    for (uint32_t i = 0; i < technique_row.parameter_count; i++) {
        pnb_parameter_info info = PNB_INIT(pnb_parameter_info);
        pnb_technique_get_parameter(technique, i, &info);
        fprintf(stderr, "%s %s", i ? "," : "", info.name);
    }
    fputs(technique_row.parameter_count ? "\n" : " none\n", stderr);
    return false;
}
