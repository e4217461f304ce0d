/* SPDX-License-Identifier: GPL-3.0-or-later
 * `penumbra compare`: how far two images are apart. */
#include "image.h"
#include "json.h"
#include "metrics.h"
#include "options.h"
#include "output.h"

#include <getopt.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char help[] =
    "usage: penumbra compare A B [options]\n"
    "Measures the difference of two images of one size (.exr, .pfm or .png), on linear values.\n"
    "Prints the root mean square error, SSIM, the largest error and the share of pixels off by more\n"
    "than 0.2 and by more than 1/64. Where a file has a Depth pass, background pixels (1e10) do not\n"
    "count; alpha never does. SSIM: " SSIM_TEXT ".\n\n"
    "      --pass NAME      pass to compare; the default is Shadow, then Combined, then the first\n"
    "      --mask-from FILE count only pixels where FILE has geometry, by its Depth pass, or, if it\n"
    "                       has none, where it is not 0; repeatable\n"
    "  -o, --output FILE    write the error of each pixel as a .png: black is 0, then blue, green,\n"
    "                       pink, and white is --error-range or more; grey does not count\n"
    "      --error-range X  error shown as white (default 0.2)\n"
    "      --max-rmse X     exit status 1 if the root mean square error is above X\n"
    "      --json           print JSON\n"
    "  -h, --help           show this text\n";

#define MAX_MASKS 8

struct compare_options {
    const char *paths[2], *pass, *output;
    const char *masks[MAX_MASKS];
    int mask_count;
    double error_range, max_rmse;
    bool has_limit, as_json;
};

/* ---- Command line ---- */

static bool take_option(struct compare_options *options, int option) {
    switch (option) {
    case 'P':
        options->pass = optarg;
        return true;
    case 'm':
        if (options->mask_count == MAX_MASKS)
            return tool_error("--mask-from can be given %d times", MAX_MASKS);
        options->masks[options->mask_count++] = optarg;
        return true;
    case 'o':
        options->output = optarg;
        return image_format_of(optarg) == IMAGE_PNG ||
               tool_error("-o wants a name that ends with .png, not '%s'", optarg);
    case 'r':
        return parse_real("--error-range", optarg, 1e-9, 1e9, &options->error_range);
    case 'x':
        options->has_limit = true;
        return parse_real("--max-rmse", optarg, 0, 1e9, &options->max_rmse);
    case 'j':
        options->as_json = true;
        return true;
    default:
        return false;
    }
}

/* -1: help was shown; else an exit code. */
static int parse_options(int count, char **arguments, struct compare_options *options) {
    static const struct option long_options[] = {
        {"pass", required_argument, NULL, 'P'},     {"mask-from", required_argument, NULL, 'm'},
        {"output", required_argument, NULL, 'o'},   {"error-range", required_argument, NULL, 'r'},
        {"max-rmse", required_argument, NULL, 'x'}, {"json", no_argument, NULL, 'j'},
        {"help", no_argument, NULL, 'h'},           {0},
    };
    int option;
    while ((option = getopt_long(count, arguments, "o:h", long_options, NULL)) != -1) {
        if (option == 'h') {
            fputs(help, stdout);
            return -1;
        }
        if (!take_option(options, option))
            return EXIT_USAGE;
    }
    if (count - optind != 2) {
        tool_error("compare wants two images; see 'penumbra compare --help'");
        return EXIT_USAGE;
    }
    options->paths[0] = arguments[optind];
    options->paths[1] = arguments[optind + 1];
    return EXIT_OK;
}

/* ---- What is compared ---- */

static const struct image *find_pass(const struct image_set *set, const char *path, const char *pass) {
    const struct image *image = image_set_find(set, pass);
    if (!image) {
        fprintf(stderr, "penumbra: %s has no pass %s; it has ", path, pass);
        image_set_print_names(set, stderr);
        fputc('\n', stderr);
    }
    return image;
}

static const char *default_pass(const struct image_set sets[2]) {
    static const char *const preferred[] = {"Shadow", "Combined"};
    for (int i = 0; i < 2; i++)
        if (image_set_find(&sets[0], preferred[i]) && image_set_find(&sets[1], preferred[i]))
            return preferred[i];
    return sets[0].images[0].name;
}

/* Clears the mask where the file has no geometry. */
static bool apply_mask(const struct image_set *set, const char *path, bool only_depth, const struct image *like,
                       bool *mask) {
    const struct image *depth = image_set_get(set, "Depth");
    for (uint32_t i = 0; !depth && i < set->count; i++) {
        const char *dot = strrchr(set->images[i].name, '.');
        if (dot && strcmp(dot, ".Depth") == 0)
            depth = &set->images[i];
    }
    if (!depth && only_depth)
        return true;
    const struct image *image = depth ? depth : &set->images[0];
    if (image->width != like->width || image->height != like->height)
        return tool_error("the mask of %s has another size", path);
    for (size_t i = 0; i < (size_t)image->width * image->height; i++) {
        float value = image->pixels[i * image->channels];
        mask[i] = mask[i] && (depth ? value < 1e10f : value != 0);
    }
    return true;
}

static bool make_mask(const struct compare_options *options, const struct image_set sets[2], const struct image *like,
                      bool *mask) {
    memset(mask, true, (size_t)like->width * like->height);
    for (int i = 0; i < 2; i++)
        if (!apply_mask(&sets[i], options->paths[i], true, like, mask))
            return false;
    for (int i = 0; i < options->mask_count; i++) {
        struct image_set set;
        if (!image_read(options->masks[i], &set))
            return false;
        bool good = apply_mask(&set, options->masks[i], false, like, mask);
        image_set_free(&set);
        if (!good)
            return false;
    }
    return true;
}

/* ---- Error map ---- */

/* Green's cubehelix: brightness rises evenly from black to white while the hue turns. */
static void ramp_color(float value, float color[3]) {
    const float start = 0.5f, turns = -1.5f, saturation = 1;
    float angle = 2 * 3.14159265f * (start / 3 + turns * value);
    float amplitude = saturation * value * (1 - value) / 2;
    static const float weights[3][2] = {{-0.14861f, 1.78277f}, {-0.29227f, -0.90649f}, {1.97294f, 0}};
    for (int i = 0; i < 3; i++)
        color[i] = value + amplitude * (weights[i][0] * cosf(angle) + weights[i][1] * sinf(angle));
}

static bool write_error_map(const struct compare_options *options, const struct image *like, const float *error) {
    struct image_set set = {0};
    struct image *map = image_set_add(&set, "Error", 5, like->width, like->height, 3);
    struct output output;
    if (!map)
        return false;
    for (size_t i = 0; i < (size_t)like->width * like->height; i++) {
        float *color = map->pixels + 3 * i;
        if (error[i] < 0)
            color[0] = color[1] = color[2] = 0.3f;
        else
            ramp_color(fminf(error[i] / (float)options->error_range, 1), color);
    }
    bool good = output_begin(&output, options->output);
    if (good)
        good = output_end(&output, image_write_png(output.temporary, map, IMAGE_ENCODE_RAW));
    image_set_free(&set);
    return good;
}

/* ---- Result ---- */

static void print_text(const struct compare_options *options, const char *pass, const struct metrics *metrics,
                       uint64_t total) {
    printf("pass        %s\n", pass[0] ? pass : "(unnamed)");
    printf("pixels      %llu of %llu\n", (unsigned long long)metrics->pixels, (unsigned long long)total);
    if (metrics->not_finite)
        printf("not finite  %llu pixels\n", (unsigned long long)metrics->not_finite);
    printf("RMSE        %.6f\n", metrics->rmse);
    printf("mean        %.6f\n", metrics->mean);
    printf("SSIM        %.6f  (" SSIM_TEXT ")\n", metrics->ssim);
    printf("max         %.6f  at %u, %u from the lower left\n", metrics->max, metrics->max_x, metrics->max_y);
    printf("above 0.2   %.4f %%\n", 100 * metrics->above_fifth);
    printf("above 1/64  %.4f %%\n", 100 * metrics->above_64th);
    if (options->output)
        printf("error map   %s: black 0 to white %g or more, grey not compared\n", options->output,
               options->error_range);
}

static void print_json(const struct compare_options *options, const char *pass, const struct metrics *metrics,
                       uint64_t total) {
    struct json json = {.file = stdout};
    json_open(&json, NULL, '{');
    json_string(&json, "a", options->paths[0]);
    json_string(&json, "b", options->paths[1]);
    json_string(&json, "pass", pass);
    json_count(&json, "pixels", metrics->pixels);
    json_count(&json, "pixels_total", total);
    json_count(&json, "pixels_not_finite", metrics->not_finite);
    json_number(&json, "rmse", metrics->rmse);
    json_number(&json, "mean", metrics->mean);
    json_number(&json, "ssim", metrics->ssim);
    json_string(&json, "ssim_constants", SSIM_TEXT);
    json_number(&json, "max", metrics->max);
    json_count(&json, "max_x", metrics->max_x);
    json_count(&json, "max_y", metrics->max_y);
    json_number(&json, "share_above_0.2", metrics->above_fifth);
    json_number(&json, "share_above_1/64", metrics->above_64th);
    json_close(&json, '{');
}

static int judge(const struct compare_options *options, const struct metrics *metrics) {
    if (metrics->not_finite) {
        tool_error("%llu pixels are not finite", (unsigned long long)metrics->not_finite);
        return EXIT_DIFFERENT;
    }
    if (options->has_limit && metrics->rmse > options->max_rmse) {
        tool_error("the RMSE %.6f is above %g", metrics->rmse, options->max_rmse);
        return EXIT_DIFFERENT;
    }
    return EXIT_OK;
}

static int compare_images(const struct compare_options *options, const struct image_set sets[2], const char *pass,
                          const struct image *a, const struct image *b) {
    size_t total = (size_t)a->width * a->height;
    bool *mask = calloc(total, sizeof *mask);
    float *error = calloc(total, sizeof *error);
    struct metrics metrics;
    bool good = (mask && error) || tool_error("out of memory");
    good = good && make_mask(options, sets, a, mask) && metrics_compute(a, b, mask, &metrics, error) &&
           (!options->output || write_error_map(options, a, error));
    free(mask);
    free(error);
    if (!good)
        return EXIT_RENDER;
    if (options->as_json)
        print_json(options, pass, &metrics, total);
    else
        print_text(options, pass, &metrics, total);
    if (!metrics.pixels) {
        tool_error("there is no pixel to compare");
        return EXIT_DIFFERENT;
    }
    return judge(options, &metrics);
}

static int compare_sets(const struct compare_options *options, const struct image_set sets[2]) {
    const char *pass = options->pass ? options->pass : default_pass(sets);
    const struct image *a = find_pass(&sets[0], options->paths[0], pass);
    const struct image *b = find_pass(&sets[1], options->paths[1], pass);
    if (!a || !b)
        return EXIT_USAGE;
    if (a->width != b->width || a->height != b->height) {
        tool_error("the sizes differ: %s has %u x %u pixels, %s has %u x %u", options->paths[0], a->width, a->height,
                   options->paths[1], b->width, b->height);
        return EXIT_DIFFERENT;
    }
    return compare_images(options, sets, a->name[0] ? a->name : b->name, a, b);
}

int command_compare(int count, char **arguments) {
    struct compare_options options = {.error_range = 0.2};
    int code = parse_options(count, arguments, &options);
    if (code)
        return code < 0 ? EXIT_OK : code;
    struct image_set sets[2] = {0};
    code = EXIT_RENDER;
    if (image_read(options.paths[0], &sets[0]) && image_read(options.paths[1], &sets[1]))
        code = compare_sets(&options, sets);
    image_set_free(&sets[0]);
    image_set_free(&sets[1]);
    return code;
}
