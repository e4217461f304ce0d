/* SPDX-License-Identifier: GPL-3.0-or-later
 * Soft shadows of a capture by ray tracing on the CPU: the Shadow pass as ground truth, and how long it takes. */
#include "tools/json.h"
#include "tools/statistics.h"
#include "tracer.h"

#include <getopt.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const char help[] =
    "usage: embree_baseline CAPTURE.pnb [options]\n"
    "Ray traces the Shadow pass of a capture: one camera ray through each pixel's centre, then N\n"
    "stratified shadow rays to each light, weighted by the light each would bring. All materials\n"
    "count as opaque.\n"
    "      --samples N        shadow rays per pixel and light (default 16)\n"
    "      --size WxH         image size (default: the capture's); the view is not changed\n"
    "  -t, --threads N        default: the processors of the machine\n"
    "      --build-quality Q  of the tree: low, medium (default) or high\n"
    "      --repeat N         trace N times and report the median (default 1)\n"
    "  -o, --output FILE.pfm  write the pass\n"
    "      --json             print JSON\n";

struct options {
    const char *capture, *output;
    uint32_t samples, threads, repeat, size[2];
    enum build_quality quality;
    bool as_json;
};

struct times {
    struct statistics camera, shadow, total;
};

/* ---- Command line ---- */

static bool read_count(const char *text, uint32_t *value) {
    char *end;
    unsigned long number = strtoul(text, &end, 10);
    *value = (uint32_t)number;
    if (*end == '\0' && number >= 1 && number <= 1000000)
        return true;
    fprintf(stderr, "embree_baseline: '%s' is not a whole number from 1 to 1000000\n", text);
    return false;
}

static bool read_quality(const char *text, enum build_quality *quality) {
    static const char *const names[] = {"low", "medium", "high"};
    for (int i = BUILD_LOW; i <= BUILD_HIGH; i++) {
        if (strcmp(text, names[i]) == 0) {
            *quality = (enum build_quality)i;
            return true;
        }
    }
    fprintf(stderr, "embree_baseline: the build quality is low, medium or high, not '%s'\n", text);
    return false;
}

static bool take_option(struct options *options, int option) {
    switch (option) {
    case 'S':
        return read_count(optarg, &options->samples);
    case 's':
        return sscanf(optarg, "%ux%u", &options->size[0], &options->size[1]) == 2;
    case 't':
        return read_count(optarg, &options->threads);
    case 'Q':
        return read_quality(optarg, &options->quality);
    case 'R':
        return read_count(optarg, &options->repeat);
    case 'o':
        options->output = optarg;
        return true;
    case 'j':
        options->as_json = true;
        return true;
    default:
        return false;
    }
}

static bool parse_options(int count, char **arguments, struct options *options) {
    static const struct option long_options[] = {
        {"samples", required_argument, NULL, 'S'}, {"size", required_argument, NULL, 's'},
        {"threads", required_argument, NULL, 't'}, {"build-quality", required_argument, NULL, 'Q'},
        {"repeat", required_argument, NULL, 'R'},  {"output", required_argument, NULL, 'o'},
        {"json", no_argument, NULL, 'j'},          {0},
    };
    int option;
    while ((option = getopt_long(count, arguments, "t:o:", long_options, NULL)) != -1)
        if (!take_option(options, option))
            return false;
    if (count - optind != 1)
        return false;
    options->capture = arguments[optind];
    return true;
}

/* ---- Output ---- */

static bool write_pfm(const char *path, const float *pixels, uint32_t width, uint32_t height) {
    FILE *file = fopen(path, "wb");
    size_t floats = (size_t)3 * width * height;
    bool good = file && fprintf(file, "PF\n%u %u\n-1.0\n", width, height) > 0 &&
                fwrite(pixels, sizeof *pixels, floats, file) == floats;
    good = file && fclose(file) == 0 && good;
    if (!good)
        perror(path);
    return good;
}

static void print_text(const struct options *options, const struct tracer *tracer, const struct times *times) {
    printf("%u x %u pixels, %llu triangles, %u shadow rays per pixel and light, %u threads\n", tracer->width,
           tracer->height, (unsigned long long)tracer->triangle_count, options->samples, tracer->threads);
    printf("transform  %9.2f ms\n", tracer->transform_ms);
    printf("build      %9.2f ms\n", tracer->build_ms);
    printf("camera     %9.2f ms (median of %u)\n", times->camera.median, options->repeat);
    printf("shadow     %9.2f ms\n", times->shadow.median);
    printf("trace      %9.2f ms (%.2f to %.2f)\n", times->total.median, times->total.minimum, times->total.maximum);
}

static void print_json(const struct options *options, const struct tracer *tracer, const struct times *times) {
    struct json json = {.file = stdout};
    json_open(&json, NULL, '{');
    json_string(&json, "capture", options->capture);
    json_count(&json, "width", tracer->width);
    json_count(&json, "height", tracer->height);
    json_count(&json, "triangles", tracer->triangle_count);
    json_count(&json, "samples", options->samples);
    json_count(&json, "threads", tracer->threads);
    json_count(&json, "runs", options->repeat);
    json_number(&json, "transform_ms", tracer->transform_ms);
    json_number(&json, "build_ms", tracer->build_ms);
    json_number(&json, "camera_ms", times->camera.median);
    json_number(&json, "shadow_ms", times->shadow.median);
    json_number(&json, "trace_ms", times->total.median);
    json_number(&json, "trace_ms_minimum", times->total.minimum);
    json_number(&json, "trace_ms_maximum", times->total.maximum);
    json_close(&json, '{');
}

/* ---- Tracing ---- */

static bool measure(const struct options *options, struct tracer *tracer, const struct emitter_samples *lights,
                    uint32_t light_count, float *visibility, struct times *times) {
    double *durations = calloc(options->repeat, 3 * sizeof *durations);
    if (!durations)
        return false;
    double *camera = durations, *shadow = camera + options->repeat, *total = shadow + options->repeat;
    for (uint32_t i = 0; i < options->repeat; i++) {
        double start = milliseconds_now();
        tracer_trace_camera(tracer);
        double middle = milliseconds_now();
        tracer_trace_shadows(tracer, lights, light_count, visibility);
        double end = milliseconds_now();
        camera[i] = middle - start;
        shadow[i] = end - middle;
        total[i] = end - start;
    }
    *times = (struct times){statistics_of(camera, options->repeat), statistics_of(shadow, options->repeat),
                            statistics_of(total, options->repeat)};
    free(durations);
    return true;
}

static bool trace(const struct options *options, const struct scene *scene) {
    struct emitter_samples lights[MAX_LIGHTS] = {0};
    struct tracer tracer = {0};
    struct times times;
    uint32_t width = options->size[0], height = options->size[1];
    float *visibility = calloc((size_t)width * height, 3 * sizeof *visibility);
    bool good = visibility != NULL;
    for (uint32_t i = 0; good && i < scene->light_count; i++)
        good = emitter_samples_create(&lights[i], &scene->lights[i], options->samples, i);
    good = good && tracer_create(&tracer, scene, width, height, options->threads, options->quality) &&
           measure(options, &tracer, lights, scene->light_count, visibility, &times) &&
           (!options->output || write_pfm(options->output, visibility, width, height));
    if (good && options->as_json)
        print_json(options, &tracer, &times);
    else if (good)
        print_text(options, &tracer, &times);
    tracer_free(&tracer);
    for (uint32_t i = 0; i < scene->light_count; i++)
        emitter_samples_free(&lights[i]);
    free(visibility);
    return good;
}

int main(int count, char **arguments) {
    struct options options = {
        .samples = 16, .repeat = 1, .threads = (uint32_t)sysconf(_SC_NPROCESSORS_ONLN), .quality = BUILD_MEDIUM};
    if (!parse_options(count, arguments, &options)) {
        fputs(help, stderr);
        return 2;
    }
    pnb_capture *capture = NULL;
    struct scene *scene = NULL;
    struct messages messages;
    messages_init(&messages);
    bool good = pnb_capture_read(options.capture, &capture) == PNB_OK &&
                scene_create(pnb_capture_scene(capture), &messages, &scene) == PNB_OK;
    if (good) {
        const pnb_settings *settings = pnb_capture_settings(capture);
        if (!options.size[0] || !options.size[1]) {
            options.size[0] = settings->width;
            options.size[1] = settings->height;
        }
        good = trace(&options, scene);
    } else {
        fprintf(stderr, "embree_baseline: %s\n", pnb_last_error());
    }
    scene_destroy(&scene);
    pnb_capture_destroy(&capture);
    messages_free(&messages);
    return good ? 0 : 1;
}
