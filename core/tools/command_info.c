/* SPDX-License-Identifier: GPL-3.0-or-later
 * `penumbra info`: everything the library can tell about itself and the machine. */
#include "json.h"
#include "tool.h"

#include <getopt.h>
#include <string.h>

#define MAX_ATTEMPTS 32

static const char help[] = "usage: penumbra info [--json]\n"
                           "Shows every OpenGL backend and why it failed, the limits of the one that is used, and\n"
                           "all techniques with their parameters. Succeeds if one backend works.\n\n"
                           "      --json  the same as JSON\n"
                           "  -h, --help  show this text\n";

static const char *const type_names[] = {
    [PNB_FLOAT] = "float", [PNB_INT] = "int", [PNB_BOOL] = "bool", [PNB_ENUM] = "enum"};

/* ---- Text ---- */

static void print_attempts(const pnb_backend_attempt *attempts, uint32_t count) {
    puts("backends:");
    for (uint32_t i = 0; i < count; i++) {
        const pnb_backend_attempt *attempt = &attempts[i];
        if (attempt->result == PNB_OK)
            printf("  %-12s works: %s, OpenGL %s\n", attempt->backend, attempt->renderer, attempt->version);
        else
            printf("  %-12s %s: %s\n", attempt->backend, pnb_result_name(attempt->result), attempt->message);
    }
}

static void print_context(const pnb_context_info *info) {
    printf("in use:\n"
           "  backend      %s\n"
           "  vendor       %s\n"
           "  renderer     %s%s\n"
           "  version      %s\n"
           "  GLSL         %s\n"
           "  OpenGL       %u.%u\n"
           "  max texture  %u x %u texels\n",
           info->backend, info->vendor, info->renderer, info->is_software ? " (on the CPU)" : "", info->version,
           info->shading_language, info->gl_major, info->gl_minor, info->max_texture_size, info->max_texture_size);
}

static void print_default(const pnb_parameter_info *parameter) {
    if (parameter->type == PNB_BOOL)
        fputs(parameter->default_value != 0 ? "true" : "false", stdout);
    else if (parameter->type == PNB_ENUM && parameter->default_value < parameter->item_count)
        fputs(parameter->items[(uint32_t)parameter->default_value], stdout);
    else
        printf("%g", parameter->default_value);
}

static void print_parameter(const pnb_parameter_info *parameter) {
    printf("      %s (%s", parameter->name, type_names[parameter->type]);
    if (parameter->type == PNB_ENUM)
        for (uint32_t i = 0; i < parameter->item_count; i++)
            printf("%s %s", i ? "," : ":", parameter->items[i]);
    else if (parameter->type != PNB_BOOL)
        printf(", %g to %g%s%s", parameter->minimum, parameter->maximum, parameter->unit[0] ? " " : "",
               parameter->unit);
    fputs("; default ", stdout);
    print_default(parameter);
    printf(")\n        %s\n", parameter->description);
}

static void print_techniques(void) {
    puts("techniques:");
    for (uint32_t i = 0; i < pnb_technique_count(); i++) {
        pnb_technique_info technique = PNB_INIT(pnb_technique_info);
        if (pnb_technique_get_info(i, &technique) != PNB_OK)
            continue;
        printf("  %s: %s\n    %s\n    %s\n", technique.id, technique.label, technique.description, technique.paper);
        for (uint32_t p = 0; p < technique.parameter_count; p++) {
            pnb_parameter_info parameter = PNB_INIT(pnb_parameter_info);
            if (pnb_technique_get_parameter(i, p, &parameter) == PNB_OK)
                print_parameter(&parameter);
        }
    }
}

/* ---- JSON ---- */

static void write_attempts(struct json *json, const pnb_backend_attempt *attempts, uint32_t count) {
    json_open(json, "backends", '[');
    for (uint32_t i = 0; i < count; i++) {
        json_open(json, NULL, '{');
        json_string(json, "backend", attempts[i].backend);
        json_string(json, "result", pnb_result_name(attempts[i].result));
        json_string(json, "message", attempts[i].message);
        json_string(json, "renderer", attempts[i].renderer);
        json_string(json, "version", attempts[i].version);
        json_close(json, '{');
    }
    json_close(json, '[');
}

static void write_context(struct json *json, const pnb_context_info *info) {
    json_open(json, "context", '{');
    json_string(json, "backend", info->backend);
    json_string(json, "vendor", info->vendor);
    json_string(json, "renderer", info->renderer);
    json_string(json, "version", info->version);
    json_string(json, "shading_language", info->shading_language);
    json_bool(json, "is_software", info->is_software != 0);
    json_count(json, "gl_major", info->gl_major);
    json_count(json, "gl_minor", info->gl_minor);
    json_count(json, "max_texture_size", info->max_texture_size);
    json_close(json, '{');
}

static void write_parameter(struct json *json, const pnb_parameter_info *parameter) {
    json_open(json, NULL, '{');
    json_string(json, "name", parameter->name);
    json_string(json, "label", parameter->label);
    json_string(json, "description", parameter->description);
    json_string(json, "unit", parameter->unit);
    json_string(json, "type", type_names[parameter->type]);
    json_number(json, "minimum", parameter->minimum);
    json_number(json, "maximum", parameter->maximum);
    json_number(json, "default", parameter->default_value);
    json_open(json, "items", '[');
    for (uint32_t i = 0; i < parameter->item_count; i++)
        json_string(json, NULL, parameter->items[i]);
    json_close(json, '[');
    json_close(json, '{');
}

static void write_techniques(struct json *json) {
    json_open(json, "techniques", '[');
    for (uint32_t i = 0; i < pnb_technique_count(); i++) {
        pnb_technique_info technique = PNB_INIT(pnb_technique_info);
        if (pnb_technique_get_info(i, &technique) != PNB_OK)
            continue;
        json_open(json, NULL, '{');
        json_string(json, "id", technique.id);
        json_string(json, "label", technique.label);
        json_string(json, "description", technique.description);
        json_string(json, "paper", technique.paper);
        json_open(json, "parameters", '[');
        for (uint32_t p = 0; p < technique.parameter_count; p++) {
            pnb_parameter_info parameter = PNB_INIT(pnb_parameter_info);
            if (pnb_technique_get_parameter(i, p, &parameter) == PNB_OK)
                write_parameter(json, &parameter);
        }
        json_close(json, '[');
        json_close(json, '{');
    }
    json_close(json, '[');
}

static int parse_options(int count, char **arguments, bool *as_json) {
    static const struct option options[] = {{"json", no_argument, NULL, 'j'}, {"help", no_argument, NULL, 'h'}, {0}};
    int option;
    while ((option = getopt_long(count, arguments, "h", options, NULL)) != -1) {
        if (option == 'h') {
            fputs(help, stdout);
            return -1;
        }
        if (option != 'j')
            return EXIT_USAGE;
        *as_json = true;
    }
    if (optind < count) {
        tool_error("info takes no argument '%s'", arguments[optind]);
        return EXIT_USAGE;
    }
    return EXIT_OK;
}

int command_info(int count, char **arguments) {
    bool as_json = false;
    int code = parse_options(count, arguments, &as_json);
    if (code)
        return code < 0 ? EXIT_OK : code;

    pnb_backend_attempt attempts[MAX_ATTEMPTS];
    memset(attempts, 0, sizeof attempts);
    for (uint32_t i = 0; i < MAX_ATTEMPTS; i++)
        attempts[i].struct_size = sizeof *attempts;
    uint32_t attempt_count = 0;
    if (pnb_probe_backends(attempts, MAX_ATTEMPTS, &attempt_count) != PNB_OK)
        tool_error("%s", pnb_last_error());
    if (attempt_count > MAX_ATTEMPTS)
        attempt_count = MAX_ATTEMPTS;

    pnb_context *context = NULL;
    pnb_context_info info = PNB_INIT(pnb_context_info);
    bool works = pnb_context_create(NULL, &context) == PNB_OK && pnb_context_get_info(context, &info) == PNB_OK;
    if (!works)
        tool_error("%s", pnb_last_error());
    pnb_context_destroy(&context);

    struct json json = {.file = stdout};
    if (as_json) {
        json_open(&json, NULL, '{');
        json_string(&json, "version", pnb_version());
        json_count(&json, "api_version", pnb_api_version());
        write_attempts(&json, attempts, attempt_count);
        if (works)
            write_context(&json, &info);
        write_techniques(&json);
        json_close(&json, '{');
    } else {
        printf("penumbra %s, API version %u\n", pnb_version(), pnb_api_version());
        print_attempts(attempts, attempt_count);
        if (works)
            print_context(&info);
        print_techniques();
    }
    return works ? EXIT_OK : EXIT_RENDER;
}
