/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "replay.h"

#include "options.h"

#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

const char replay_help[] =
    "  -p, --parameter NAME=VALUE  set a parameter of the technique; repeatable. Items of a\n"
    "                              choice by name, booleans as true or false\n"
    "  -s, --size WxH              image size in pixels. The view keeps its height; a new shape\n"
    "                              of the image shows more or less at the sides\n"
    "      --crop X,Y,W,H          render only these pixels, from the lower left\n"
    "      --samples N             anti-aliasing samples per pixel\n"
    "      --map-size N            shadow map texels per side\n"
    "      --light-samples N       REFERENCE uses N x N samples of each light\n"
    "      --unshadowed            no light casts shadows\n"
    "      --clay                  every surface is white and opaque\n"
    "      --backend NAME          egl, egl:N, surfaceless or osmesa\n"
    "  -v, --verbose               show the library's log\n"
    "  -h, --help                  show this text\n";

bool replay_option(struct replay_options *options, int option, const char *argument) {
    switch (option) {
    case 'p':
        if (options->assignment_count == MAX_ASSIGNMENTS)
            return tool_error("-p can be given %d times", MAX_ASSIGNMENTS);
        options->assignments[options->assignment_count++] = argument;
        return true;
    case 's':
        return parse_size("--size", argument, options->size);
    case 'S':
        return parse_count("--samples", argument, 1, 4096, &options->samples);
    case 'M':
        return parse_count("--map-size", argument, 16, 65536, &options->shadow_map_size);
    case 'L':
        return parse_count("--light-samples", argument, 1, 64, &options->light_samples);
    case 'C':
        return parse_crop("--crop", argument, options->crop);
    case 'U':
        return options->unshadowed = true;
    case 'Y':
        return options->clay = true;
    case 'B':
        options->backend = argument;
        return true;
    case 'v':
        options->verbose = true;
        return true;
    default:
        return false;
    }
}

double milliseconds_now(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec * 1e3 + (double)now.tv_nsec * 1e-6;
}

/* The window keeps its centre and height; its width follows the image's shape. */
static void change_size(struct replay *replay, const uint32_t size[2]) {
    pnb_settings *settings = &replay->settings;
    float *window = replay->scene.camera.window;
    if (settings->width && settings->height) {
        float old_aspect = (float)settings->width / (float)settings->height;
        float ratio = (float)size[0] / (float)size[1] / old_aspect;
        float centre = (window[0] + window[1]) / 2, half_width = (window[1] - window[0]) / 2 * ratio;
        window[0] = centre - half_width;
        window[1] = centre + half_width;
    }
    settings->width = size[0];
    settings->height = size[1];
    memset(settings->crop, 0, sizeof settings->crop); /* the capture's was for its own size */
}

static void change_light(pnb_light *light, const struct replay_options *options) {
    if (options->unshadowed)
        light->flags |= PNB_LIGHT_NO_SHADOW;
    if (options->one_technique)
        light->technique = NULL;
    if (options->shadow_map_size)
        light->shadow_map_size = 0;
}

/* The scene is the capture's: what changes is copied. */
static bool change_scene(struct replay *replay, const struct replay_options *options) {
    pnb_scene *scene = &replay->scene;
    if ((options->unshadowed || options->one_technique || options->shadow_map_size) && scene->light_count) {
        replay->lights = calloc(scene->light_count, sizeof *replay->lights);
        if (!replay->lights)
            return tool_error("out of memory");
        memcpy(replay->lights, scene->lights, scene->light_count * sizeof *replay->lights);
        for (uint32_t i = 0; i < scene->light_count; i++)
            change_light(&replay->lights[i], options);
        scene->lights = replay->lights;
    }
    if (options->clay) {
        replay->slots = calloc(scene->slot_count + 1, sizeof *replay->slots);
        if (!replay->slots)
            return tool_error("out of memory");
        replay->clay = (pnb_material){.struct_size = sizeof replay->clay, .base_color = {1, 1, 1}};
        scene->materials = &replay->clay;
        scene->material_count = 1;
        scene->slots = replay->slots;
    }
    return true;
}

static bool apply_options(struct replay *replay, const struct replay_options *options) {
    pnb_settings *settings = &replay->settings;
    if (options->size[0] && (options->size[0] != settings->width || options->size[1] != settings->height))
        change_size(replay, options->size);
    if (options->samples)
        settings->samples = options->samples;
    if (options->shadow_map_size)
        settings->shadow_map_size = options->shadow_map_size;
    if (options->light_samples)
        settings->light_samples = options->light_samples;
    if (!change_scene(replay, options))
        return false;
    const uint32_t *crop = options->crop;
    if (!crop[2])
        return true;
    if ((uint64_t)crop[0] + crop[2] > settings->width || (uint64_t)crop[1] + crop[3] > settings->height)
        return tool_error("--crop %u,%u,%u,%u reaches beyond the image of %u x %u pixels", crop[0], crop[1], crop[2],
                          crop[3], settings->width, settings->height);
    memcpy(settings->crop, crop, sizeof settings->crop);
    return true;
}

int replay_open(struct replay *replay, const char *path, const struct replay_options *options) {
    *replay = (struct replay){0};
    if (pnb_capture_read(path, &replay->capture) != PNB_OK) {
        tool_error("%s", pnb_last_error());
        return EXIT_RENDER;
    }
    replay->scene = *pnb_capture_scene(replay->capture);
    replay->settings = *pnb_capture_settings(replay->capture);
    const char *technique = replay->settings.technique ? replay->settings.technique : "PCSS";
    if (!parse_technique(path, technique, &replay->technique))
        return EXIT_RENDER;
    return apply_options(replay, options) ? EXIT_OK : EXIT_USAGE;
}

static void print_log(void *user, pnb_log_level level, const char *message) {
    static const char *const names[] = {"", "error", "warning", "info", "debug"};
    (void)user;
    fprintf(stderr, "penumbra: %s: %s\n", names[level], message);
}

int replay_start(struct replay *replay, const struct replay_options *options) {
    pnb_context_desc desc = PNB_INIT(pnb_context_desc);
    desc.backend = options->backend;
    desc.log_level = options->verbose ? PNB_LOG_DEBUG : PNB_LOG_NONE;
    desc.log = print_log;
    double start = milliseconds_now();
    pnb_result result = pnb_context_create(&desc, &replay->context);
    replay->context_ms = milliseconds_now() - start;
    if (result == PNB_OK)
        return EXIT_OK;
    tool_error("%s", pnb_last_error());
    return result == PNB_ERROR_INVALID_ARGUMENT ? EXIT_USAGE : EXIT_RENDER;
}

void replay_close(struct replay *replay) {
    pnb_context_destroy(&replay->context);
    free(replay->lights);
    free(replay->slots);
    pnb_capture_destroy(&replay->capture);
}

bool replay_settings(const struct replay *replay, const struct replay_options *options, uint32_t technique,
                     bool lenient, pnb_value *values, pnb_settings *settings) {
    *settings = replay->settings;
    settings->technique = technique_id(technique);
    uint32_t count = 0;
    if (replay->settings.value_count > MAX_VALUES - MAX_ASSIGNMENTS)
        return tool_error("the capture sets %u parameters, at most %d can be replayed", replay->settings.value_count,
                          MAX_VALUES - MAX_ASSIGNMENTS);
    /* The capture's values belong to its own technique or to the one they name; the command line's come later and win.
     */
    for (uint32_t i = 0; i < replay->settings.value_count; i++)
        if (technique == replay->technique || strchr(replay->settings.values[i].name, '.'))
            values[count++] = replay->settings.values[i];
    for (uint32_t i = 0; i < options->assignment_count; i++) {
        pnb_value value;
        bool known;
        if (!parse_assignment(options->assignments[i], technique, &value, &known)) {
            if (known)
                return false;
            if (!lenient)
                return report_unknown_parameter(options->assignments[i], technique);
            continue;
        }
        uint32_t place = 0;
        while (place < count && strcmp(values[place].name, value.name) != 0)
            place++;
        values[place] = value;
        count += place == count;
    }
    settings->values = values;
    settings->value_count = count;
    return true;
}

/* ---- Running ---- */

static volatile sig_atomic_t interrupted;

static void interrupt(int signal_number) {
    (void)signal_number;
    interrupted = 1;
}

static pnb_result wait_for(pnb_job *job) {
    bool shows_progress = isatty(STDERR_FILENO);
    bool shown = false;
    pnb_result result;
    for (;;) {
        pnb_progress progress = PNB_INIT(pnb_progress);
        result = pnb_job_wait(job, 200, &progress);
        if (result != PNB_TIMEOUT)
            break;
        if (interrupted)
            pnb_job_cancel(job);
        if (shows_progress) {
            fprintf(stderr, "\r%3.0f %% %-60.60s", 100 * (double)progress.fraction, progress.text);
            shown = true;
        }
    }
    if (shown)
        fprintf(stderr, "\r%66s\r", "");
    return result;
}

pnb_job *replay_run(struct replay *replay, const pnb_settings *settings, double *milliseconds) {
    struct sigaction previous, action = {.sa_handler = interrupt};
    interrupted = 0;
    sigaction(SIGINT, &action, &previous);
    double start = milliseconds_now();
    pnb_job *job = NULL;
    pnb_result result = pnb_render_start(replay->context, &replay->scene, settings, &job);
    if (result == PNB_OK)
        result = wait_for(job);
    *milliseconds = milliseconds_now() - start;
    sigaction(SIGINT, &previous, NULL);
    if (result == PNB_OK)
        return job;
    tool_error("%s", pnb_last_error());
    pnb_job_destroy(&job);
    return NULL;
}
