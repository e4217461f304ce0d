/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "json.h"

#include <math.h>

static void write_text(FILE *file, const char *text) {
    fputc('"', file);
    for (const unsigned char *c = (const unsigned char *)text; *c; c++) {
        if (*c == '"' || *c == '\\')
            fprintf(file, "\\%c", *c);
        else if (*c < 0x20)
            fprintf(file, "\\u%04x", *c);
        else
            fputc(*c, file);
    }
    fputc('"', file);
}

static void begin_value(struct json *json, const char *name) {
    if (json->depth)
        fprintf(json->file, "%s\n%*s", json->follows ? "," : "", 2 * json->depth, "");
    if (name) {
        write_text(json->file, name);
        fputs(": ", json->file);
    }
    json->follows = true;
}

void json_open(struct json *json, const char *name, char bracket) {
    begin_value(json, name);
    fputc(bracket, json->file);
    json->depth++;
    json->follows = false;
}

void json_close(struct json *json, char bracket) {
    json->depth--;
    if (json->follows)
        fprintf(json->file, "\n%*s", 2 * json->depth, "");
    fputc(bracket == '{' ? '}' : ']', json->file);
    if (json->depth == 0)
        fputc('\n', json->file);
    json->follows = true;
}

void json_string(struct json *json, const char *name, const char *value) {
    begin_value(json, name);
    write_text(json->file, value);
}

void json_number(struct json *json, const char *name, double value) {
    begin_value(json, name);
    if (isfinite(value))
        fprintf(json->file, "%.9g", value);
    else
        fputs("null", json->file);
}

void json_count(struct json *json, const char *name, uint64_t value) {
    begin_value(json, name);
    fprintf(json->file, "%llu", (unsigned long long)value);
}

void json_bool(struct json *json, const char *name, bool value) {
    begin_value(json, name);
    fputs(value ? "true" : "false", json->file);
}
