/* SPDX-License-Identifier: GPL-3.0-or-later
 * What the commands of the tool share. */
#ifndef TOOL_H
#define TOOL_H

#include <penumbra.h>

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

enum exit_code {
    EXIT_OK = 0,
    EXIT_DIFFERENT = 1, /* a comparison failed */
    EXIT_USAGE = 2,     /* the command line is wrong */
    EXIT_RENDER = 3     /* rendering, reading or writing failed */
};

/* Prints "penumbra: " and the message to stderr. Returns false, so that a function can `return tool_error(...)`. */
bool tool_error(const char *format, ...) __attribute__((format(printf, 1, 2)));

/* Each command gets its own name as arguments[0]. */
int command_info(int count, char **arguments);
int command_render(int count, char **arguments);
int command_compare(int count, char **arguments);
int command_bench(int count, char **arguments);

#endif
