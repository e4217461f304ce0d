/* SPDX-License-Identifier: GPL-3.0-or-later
 * Writes JSON with its commas and indentation. */
#ifndef JSON_H
#define JSON_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

struct json {
    FILE *file;
    int depth;
    bool follows; /* a value was written at this depth: a comma comes before the next */
};

/* `name` is the member's name inside an object, NULL inside an array and at the top. bracket: '{' or '['. */
void json_open(struct json *json, const char *name, char bracket);
void json_close(struct json *json, char bracket);
void json_string(struct json *json, const char *name, const char *value);
void json_number(struct json *json, const char *name, double value); /* not finite: null */
void json_count(struct json *json, const char *name, uint64_t value);
void json_bool(struct json *json, const char *name, bool value);

#endif
