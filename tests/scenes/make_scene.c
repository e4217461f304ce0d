/* SPDX-License-Identifier: GPL-3.0-or-later
 * Writes a procedural scene as a capture. */
#include "test_scenes.h"

#include <getopt.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void print_help(FILE *file) {
    fputs("usage: make_scene [options] SCENE OUTPUT.pnb\n"
          "  --light KIND       rectangle (default), ellipse, point, spot or sun\n"
          "  --light-size M     full width of the light in metres\n"
          "  --parameter VALUE  what it means depends on the scene\n"
          "  --size WxH         image size\n"
          "  --list             only print the names of the scenes\n"
          "scenes:\n",
          file);
    const struct test_scene_info *info;
    for (uint32_t i = 0; (info = test_scene_info(i)); i++) {
        fprintf(file, "  %-15s %s", info->name, info->description);
        if (info->parameter)
            fprintf(file, " (parameter: %s; %g)", info->parameter, (double)info->parameter_default);
        fputc('\n', file);
    }
}

static void print_list(void) {
    const struct test_scene_info *info;
    for (uint32_t i = 0; (info = test_scene_info(i)); i++)
        puts(info->name);
}

/* 0, or -1 for an unknown name. */
static int parse_light(const char *name, enum test_light *light) {
    for (int i = 0; i < TEST_LIGHT_COUNT; i++) {
        if (strcmp(name, test_light_names[i]) == 0) {
            *light = (enum test_light)i;
            return 0;
        }
    }
    fprintf(stderr, "make_scene: unknown light '%s'\n", name);
    return -1;
}

static int write_scene(const char *name, const struct test_scene_options *options, uint32_t width, uint32_t height,
                       const char *path) {
    struct test_scene *scene = test_scene_create(name, options);
    if (!scene) {
        fprintf(stderr, "make_scene: no scene '%s', or it cannot be built so: %s\n", name, pnb_last_error());
        return 2;
    }
    pnb_settings settings = *test_scene_settings(scene);
    if (width) {
        settings.width = width;
        settings.height = height;
    }
    pnb_result result = pnb_capture_write(path, test_scene_get(scene), &settings);
    test_scene_destroy(&scene);
    if (result != PNB_OK) {
        fprintf(stderr, "make_scene: %s: %s\n", path, pnb_last_error());
        return 1;
    }
    return 0;
}

int main(int count, char **arguments) {
    static const struct option long_options[] = {
        {"light", required_argument, NULL, 'l'},
        {"light-size", required_argument, NULL, 'w'},
        {"parameter", required_argument, NULL, 'p'},
        {"size", required_argument, NULL, 's'},
        {"list", no_argument, NULL, 'L'},
        {"help", no_argument, NULL, 'h'},
        {0},
    };
    struct test_scene_options options = {0};
    uint32_t width = 0, height = 0;
    int option;
    while ((option = getopt_long(count, arguments, "h", long_options, NULL)) != -1) {
        switch (option) {
        case 'l':
            if (parse_light(optarg, &options.light) < 0)
                return 2;
            break;
        case 'w':
            options.light_size = strtof(optarg, NULL);
            break;
        case 'p':
            options.parameter = strtof(optarg, NULL);
            options.has_parameter = 1;
            break;
        case 's':
            if (sscanf(optarg, "%ux%u", &width, &height) != 2) {
                fprintf(stderr, "make_scene: --size wants WIDTHxHEIGHT, not '%s'\n", optarg);
                return 2;
            }
            break;
        case 'L':
            print_list();
            return 0;
        case 'h':
            print_help(stdout);
            return 0;
        default:
            return 2;
        }
    }
    if (count - optind != 2) {
        print_help(stderr);
        return 2;
    }
    return write_scene(arguments[optind], &options, width, height, arguments[optind + 1]);
}
