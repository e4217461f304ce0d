/* SPDX-License-Identifier: GPL-3.0-or-later
 * `penumbra render`: a capture to an image. */
#include "image.h"
#include "options.h"
#include "output.h"
#include "replay.h"
#include "statistics.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char help[] =
    "usage: penumbra render CAPTURE.pnb -o OUTPUT [options]\n"
    "Renders a capture. The ending of OUTPUT chooses the format:\n"
    "  .exr  all passes as 32-bit floats, channels named PASS.R, PASS.G, ...\n"
    "  .png  one pass, 8 bits; colours are sRGB-encoded, Normal is mapped from -1..1, Depth from\n"
    "        far (black) to near (white), Blocker and Penumbra from 0 to their largest\n"
    "  .pfm  one pass, 32-bit floats, 1 or 3 channels\n"
    "OUTPUT is written completely or not at all.\n\n"
    "  -o, --output FILE           what to write\n"
    "  -t, --technique ID          shadow technique of all lights; 'penumbra info' lists them\n"
    "      --pass NAME             Combined (default), Depth, Normal, Shadow or Shadow.LIGHT; to\n"
    "                              look at: Blocker.LIGHT and Penumbra.LIGHT, metres, and\n"
    "                              Map.LIGHT, the shadow map; for an .exr: only this pass\n"
    "      --exposure STOPS        PNG: brighten by so many stops\n"
    "      --repeat N              render N times, report the median time and whether all images\n"
    "                              are identical (exit status 1 if not)\n";

struct render_options {
    struct replay_options replay;
    const char *capture, *output, *technique, *pass;
    double exposure;
    uint32_t repeat;
};

/* ---- Command line ---- */

static bool take_option(struct render_options *options, int option) {
    switch (option) {
    case 'o':
        options->output = optarg;
        return true;
    case 't':
        options->technique = optarg;
        return true;
    case 'P':
        options->pass = optarg;
        return true;
    case 'E':
        return parse_real("--exposure", optarg, -32, 32, &options->exposure);
    case 'R':
        return parse_count("--repeat", optarg, 1, 100000, &options->repeat);
    default:
        return replay_option(&options->replay, option, optarg);
    }
}

/* -1: help was shown; else an exit code. */
static int parse_options(int count, char **arguments, struct render_options *options) {
    static const struct option long_options[] = {
        {"output", required_argument, NULL, 'o'},
        {"technique", required_argument, NULL, 't'},
        {"pass", required_argument, NULL, 'P'},
        {"exposure", required_argument, NULL, 'E'},
        {"repeat", required_argument, NULL, 'R'},
        REPLAY_LONG_OPTIONS,
        {0},
    };
    int option;
    while ((option = getopt_long(count, arguments, "o:t:" REPLAY_SHORT_OPTIONS, long_options, NULL)) != -1) {
        if (option == 'h') {
            fputs(help, stdout);
            fputs(replay_help, stdout);
            return -1;
        }
        if (!take_option(options, option))
            return EXIT_USAGE;
    }
    if (count - optind != 1) {
        tool_error("render wants one capture; see 'penumbra render --help'");
        return EXIT_USAGE;
    }
    options->capture = arguments[optind];
    if (!options->output)
        tool_error("render wants -o OUTPUT");
    else if (image_format_of(options->output) == IMAGE_UNKNOWN)
        tool_error("-o wants a name that ends with .exr, .png or .pfm, not '%s'", options->output);
    else
        return EXIT_OK;
    return EXIT_USAGE;
}

/* ---- Images of a job ---- */

static struct image borrow_image(const pnb_image *image) {
    return (struct image){.name = (char *)image->name,
                          .width = image->width,
                          .height = image->height,
                          .channels = image->channels,
                          .pixels = (float *)image->pixels};
}

/* The job's images; the array is to be freed, the images belong to the job. */
static bool borrow_images(const pnb_job *job, struct image_set *set) {
    uint32_t count = pnb_job_image_count(job);
    set->images = calloc(count + 1, sizeof *set->images);
    if (!set->images)
        return tool_error("out of memory");
    for (uint32_t i = 0; i < count; i++) {
        pnb_image image = PNB_INIT(pnb_image);
        if (pnb_job_get_image(job, i, &image) != PNB_OK)
            return tool_error("%s", pnb_last_error());
        if (image_set_get(set, image.name))
            tool_error("warning: several passes are named %s; only the first is written", image.name);
        else
            set->images[set->count++] = borrow_image(&image);
    }
    return true;
}

static bool same_images(const pnb_job *a, const pnb_job *b) {
    struct image_set first = {0}, second = {0};
    bool same = borrow_images(a, &first) && borrow_images(b, &second) && first.count == second.count;
    for (uint32_t i = 0; same && i < first.count; i++) {
        size_t floats = (size_t)first.images[i].width * first.images[i].height * first.images[i].channels;
        same = memcmp(first.images[i].pixels, second.images[i].pixels, floats * sizeof(float)) == 0;
    }
    free(first.images);
    free(second.images);
    return same;
}

/* ---- Writing ---- */

static const float BACKGROUND_DEPTH = 1e10f;

static void depth_range(const struct image *image, float range[2]) {
    range[0] = INFINITY;
    range[1] = -INFINITY;
    for (size_t i = 0; i < (size_t)image->width * image->height; i++) {
        if (image->pixels[i] < BACKGROUND_DEPTH) {
            range[0] = fminf(range[0], image->pixels[i]);
            range[1] = fmaxf(range[1], image->pixels[i]);
        }
    }
}

/* Maps a pass to what a PNG can show. */
static enum image_encoding make_viewable(struct image *image, double exposure) {
    size_t pixels = (size_t)image->width * image->height, floats = pixels * image->channels;
    if (strcmp(image->name, "Depth") == 0) {
        float range[2];
        depth_range(image, range);
        float span = range[1] > range[0] ? range[1] - range[0] : 1;
        for (size_t i = 0; i < floats; i++)
            image->pixels[i] = (range[1] - image->pixels[i]) / span;
        return IMAGE_ENCODE_RAW;
    }
    if (strncmp(image->name, "Map.", 4) == 0)
        return IMAGE_ENCODE_RAW;
    if (strncmp(image->name, "Blocker.", 8) == 0 || strncmp(image->name, "Penumbra.", 9) == 0) {
        float most = 0;
        for (size_t i = 0; i < floats; i++)
            most = fmaxf(most, image->pixels[i]);
        for (size_t i = 0; i < floats && most > 0; i++)
            image->pixels[i] /= most;
        return IMAGE_ENCODE_RAW;
    }
    if (strcmp(image->name, "Normal") == 0) {
        for (size_t i = 0; i < floats; i++)
            image->pixels[i] = image->pixels[i] / 2 + 0.5f;
        return IMAGE_ENCODE_RAW;
    }
    float scale = (float)exp2(exposure);
    for (size_t i = 0; i < floats; i++)
        if (image->channels != 4 || i % 4 != 3)
            image->pixels[i] *= scale;
    return IMAGE_ENCODE_COLOR;
}

static bool write_png(const char *path, const struct image *image, double exposure) {
    struct image_set copies = {0};
    struct image *copy =
        image_set_add(&copies, image->name, strlen(image->name), image->width, image->height, image->channels);
    if (!copy)
        return false;
    memcpy(copy->pixels, image->pixels, (size_t)image->width * image->height * image->channels * sizeof(float));
    enum image_encoding encoding = make_viewable(copy, exposure);
    bool good = image_write_png(path, copy, encoding);
    image_set_free(&copies);
    return good;
}

static bool write_images(const struct render_options *options, const struct image_set *set, const char *path) {
    enum image_format format = image_format_of(options->output);
    if (format == IMAGE_EXR && !options->pass)
        return image_write_exr(path, set);
    const char *name = options->pass ? options->pass : "Combined";
    const struct image *image = image_set_get(set, name);
    if (!image)
        return tool_error("the library made no pass %s", name);
    if (format == IMAGE_EXR)
        return image_write_exr(path, &(struct image_set){.images = (struct image *)image, .count = 1});
    return format == IMAGE_PNG ? write_png(path, image, options->exposure) : image_write_pfm(path, image);
}

static bool write_job(const struct render_options *options, const pnb_job *job) {
    struct image_set set = {0};
    struct output output;
    bool good = borrow_images(job, &set) && output_begin(&output, options->output);
    if (good)
        good = output_end(&output, write_images(options, &set, output.temporary));
    free(set.images);
    return good;
}

/* ---- Rendering ---- */

static void print_messages(const pnb_job *job) {
    for (uint32_t i = 0; i < pnb_job_message_count(job); i++)
        fprintf(stderr, "penumbra: warning: %s\n", pnb_job_message(job, i));
}

static void print_summary(const struct replay *replay, const pnb_settings *settings, const pnb_job *job, double *times,
                          uint32_t repeat) {
    double gpu = 0;
    for (uint32_t i = 0; i < pnb_job_timing_count(job); i++) {
        pnb_timing timing = PNB_INIT(pnb_timing);
        if (pnb_job_get_timing(job, i, &timing) == PNB_OK)
            gpu += timing.gpu_ms;
    }
    pnb_context_info info = PNB_INIT(pnb_context_info);
    pnb_context_get_info(replay->context, &info);
    struct statistics time = statistics_of(times, repeat);
    printf("%s %ux%u, %u sample%s: %.1f ms", settings->technique, settings->width, settings->height,
           settings->samples ? settings->samples : 1, settings->samples > 1 ? "s" : "", time.median);
    if (repeat > 1)
        printf(" (median of %u; %.1f to %.1f)", repeat, time.minimum, time.maximum);
    printf(", OpenGL %.1f ms, start %.1f ms, on %s (%s)\n", gpu, replay->context_ms, info.backend, info.renderer);
}

/* Renders `repeat` times. *job is the first; *different counts those unlike it. */
static bool render_repeatedly(struct replay *replay, const pnb_settings *settings, uint32_t repeat, double *times,
                              pnb_job **job, uint32_t *different) {
    *different = 0;
    for (uint32_t i = 0; i < repeat; i++) {
        pnb_job *next = replay_run(replay, settings, &times[i]);
        if (!next)
            return false;
        if (i == 0) {
            *job = next;
            continue;
        }
        *different += !same_images(*job, next);
        pnb_job_destroy(&next);
    }
    return true;
}

static int render(const struct render_options *options, struct replay *replay, const pnb_settings *settings) {
    uint32_t repeat = options->repeat ? options->repeat : 1, different = 0;
    double *times = calloc(repeat, sizeof *times);
    pnb_job *job = NULL;
    bool good = times && render_repeatedly(replay, settings, repeat, times, &job, &different);
    if (good) {
        if (!options->replay.verbose) /* the log has shown them */
            print_messages(job);
        good = write_job(options, job);
    }
    if (good) {
        print_summary(replay, settings, job, times, repeat);
        if (different)
            tool_error("%u of %u renders differ from the first", different, repeat);
        else if (repeat > 1)
            printf("%u renders, bit-identical\n", repeat);
    }
    pnb_job_destroy(&job);
    free(times);
    return !good ? EXIT_RENDER : different ? EXIT_DIFFERENT : EXIT_OK;
}

static uint32_t passes_for(const struct render_options *options, uint32_t wanted) {
    if (wanted)
        return wanted;
    if (image_format_of(options->output) != IMAGE_EXR)
        return PNB_PASS_COMBINED;
    return PNB_PASS_COMBINED | PNB_PASS_DEPTH | PNB_PASS_NORMAL | PNB_PASS_SHADOW | PNB_PASS_LIGHT_SHADOWS;
}

/* Whether the pass of one light is that of a light of the scene. */
static bool check_light(const char *pass, const pnb_scene *scene) {
    const char *wanted = strchr(pass, '.') + 1;
    for (uint32_t i = 0; i < scene->light_count; i++)
        if (scene->lights[i].name && strcmp(scene->lights[i].name, wanted) == 0)
            return true;
    fprintf(stderr, "penumbra: --pass: there is no light '%s'; there are", wanted);
    for (uint32_t i = 0; i < scene->light_count; i++)
        fprintf(stderr, "%s %s", i ? "," : "", scene->lights[i].name ? scene->lights[i].name : "(unnamed)");
    fputs(scene->light_count ? "\n" : " none\n", stderr);
    return false;
}

int command_render(int count, char **arguments) {
    struct render_options options = {0};
    int code = parse_options(count, arguments, &options);
    if (code)
        return code < 0 ? EXIT_OK : code;
    uint32_t passes = 0, technique = 0;
    if (options.pass && !parse_pass("--pass", options.pass, &passes))
        return EXIT_USAGE;
    if (options.technique && !parse_technique("-t", options.technique, &technique))
        return EXIT_USAGE;
    if (!output_check(options.output))
        return EXIT_RENDER;

    struct replay replay;
    pnb_value values[MAX_VALUES];
    pnb_settings settings;
    options.replay.one_technique = options.technique;
    code = replay_open(&replay, options.capture, &options.replay);
    if (code == EXIT_OK && passes >= PNB_PASS_LIGHT_SHADOWS && !check_light(options.pass, &replay.scene))
        code = EXIT_USAGE;
    if (code == EXIT_OK && !options.technique)
        technique = replay.technique;
    if (code == EXIT_OK && !replay_settings(&replay, &options.replay, technique, false, values, &settings))
        code = EXIT_USAGE;
    if (code == EXIT_OK)
        code = replay_start(&replay, &options.replay);
    if (code == EXIT_OK) {
        settings.passes = passes_for(&options, passes);
        code = render(&options, &replay, &settings);
    }
    replay_close(&replay);
    return code;
}
