/* SPDX-License-Identifier: GPL-3.0-or-later
 * The command-line tool. */
#include "tool.h"

#include <stdarg.h>
#include <string.h>

static const struct {
    const char *name;
    int (*run)(int count, char **arguments);
    const char *summary;
} commands[] = {
    {"info", command_info, "show backends, limits and techniques"},
    {"render", command_render, "render a capture to an image"},
    {"compare", command_compare, "measure the difference of two images"},
    {"bench", command_bench, "time techniques on a capture"},
};
#define COMMAND_COUNT (sizeof commands / sizeof *commands)

bool tool_error(const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    fputs("penumbra: ", stderr);
    vfprintf(stderr, format, arguments);
    fputc('\n', stderr);
    va_end(arguments);
    return false;
}

static void print_help(FILE *file) {
    fputs("usage: penumbra COMMAND [options]\n"
          "Soft shadow mapping on OpenGL, off screen, with or without a GPU.\n\n"
          "commands:\n",
          file);
    for (size_t i = 0; i < COMMAND_COUNT; i++)
        fprintf(file, "  %-9s %s\n", commands[i].name, commands[i].summary);
    fputs("\n'penumbra COMMAND --help' describes a command. A capture (.pnb) is one frame as the library\n"
          "saw it; the Blender add-on writes them.\n\n"
          "exit status:\n"
          "  0  success\n"
          "  1  images differ: by more than --max-rmse, in size, between repeats, or in not being finite\n"
          "  2  the command line is wrong\n"
          "  3  rendering, reading or writing failed\n\n"
          "environment:\n"
          "  PENUMBRA_BACKEND  egl, egl:N, surfaceless or osmesa: the OpenGL to use\n",
          file);
}

int main(int count, char **arguments) {
    if (count < 2) {
        print_help(stderr);
        return EXIT_USAGE;
    }
    const char *name = arguments[1];
    if (strcmp(name, "--help") == 0 || strcmp(name, "-h") == 0 || strcmp(name, "help") == 0) {
        print_help(stdout);
        return EXIT_OK;
    }
    if (strcmp(name, "--version") == 0) {
        printf("penumbra %s\n", pnb_version());
        return EXIT_OK;
    }
    for (size_t i = 0; i < COMMAND_COUNT; i++)
        if (strcmp(name, commands[i].name) == 0)
            return commands[i].run(count - 1, arguments + 1);
    tool_error("unknown command '%s'; there are info, render, compare and bench", name);
    return EXIT_USAGE;
}
