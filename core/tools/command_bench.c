/* SPDX-License-Identifier: GPL-3.0-or-later
 * `penumbra bench`: times of techniques, per pass. */
#include "json.h"
#include "options.h"
#include "output.h"
#include "replay.h"
#include "statistics.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const char help[] =
    "usage: penumbra bench CAPTURE.pnb [options]\n"
    "Times techniques on a capture. They take turns within each round, so that their times are\n"
    "comparable as ratios. Prints medians with minimum and maximum, in milliseconds: `wall` from\n"
    "asking for a render to its images, and for each pass the OpenGL timer queries (gpu) and the CPU\n"
    "time to record (cpu), with the bytes it owns.\n\n"
    "  -t, --technique ID          technique to time; repeatable; default: the capture's\n"
    "      --all                   all techniques\n"
    "  -n, --runs N                measured renders of each technique (default 5)\n"
    "      --warmup N              renders before that (default 1)\n"
    "      --json FILE             also write the result as JSON\n";

/* Passes of one technique, in the order of their first appearance. */
#define MAX_TIMED_PASSES 64
#define MAX_TECHNIQUES   64
#define MAX_RUNS         1000

struct bench_options {
    struct replay_options replay;
    const char *capture, *json;
    uint32_t techniques[MAX_TECHNIQUES];
    uint32_t technique_count;
    bool all;
    uint32_t runs, warmup;
};

struct pass_times {
    char name[64];
    uint32_t count; /* times it runs in one render */
    uint64_t bytes;
    double *gpu, *cpu; /* per run */
};

struct technique_times {
    uint32_t technique;
    pnb_settings settings;
    pnb_value values[MAX_VALUES];
    double *wall;
    struct pass_times passes[MAX_TIMED_PASSES];
    uint32_t pass_count;
};

/* ---- Command line ---- */

static bool add_technique(struct bench_options *options, uint32_t technique) {
    for (uint32_t i = 0; i < options->technique_count; i++)
        if (options->techniques[i] == technique)
            return true;
    if (options->technique_count == MAX_TECHNIQUES)
        return tool_error("at most %d techniques", MAX_TECHNIQUES);
    options->techniques[options->technique_count++] = technique;
    return true;
}

static bool take_option(struct bench_options *options, int option) {
    uint32_t technique;
    switch (option) {
    case 't':
        return parse_technique("-t", optarg, &technique) && add_technique(options, technique);
    case 'A':
        options->all = true;
        return true;
    case 'n':
        return parse_count("--runs", optarg, 1, MAX_RUNS, &options->runs);
    case 'W':
        return parse_count("--warmup", optarg, 0, MAX_RUNS, &options->warmup);
    case 'J':
        options->json = optarg;
        return true;
    default:
        return replay_option(&options->replay, option, optarg);
    }
}

/* -1: help was shown; else an exit code. */
static int parse_options(int count, char **arguments, struct bench_options *options) {
    static const struct option long_options[] = {
        {"technique", required_argument, NULL, 't'},
        {"all", no_argument, NULL, 'A'},
        {"runs", required_argument, NULL, 'n'},
        {"warmup", required_argument, NULL, 'W'},
        {"json", required_argument, NULL, 'J'},
        REPLAY_LONG_OPTIONS,
        {0},
    };
    int option;
    while ((option = getopt_long(count, arguments, "t:n:" REPLAY_SHORT_OPTIONS, long_options, NULL)) != -1) {
        if (option == 'h') {
            fputs(help, stdout);
            fputs(replay_help, stdout);
            return -1;
        }
        if (!take_option(options, option))
            return EXIT_USAGE;
    }
    if (count - optind != 1) {
        tool_error("bench wants one capture; see 'penumbra bench --help'");
        return EXIT_USAGE;
    }
    options->capture = arguments[optind];
    for (uint32_t i = 0; options->all && i < pnb_technique_count(); i++)
        if (!add_technique(options, i))
            return EXIT_USAGE;
    return EXIT_OK;
}

/* A parameter must belong to one of the techniques at least. */
static bool check_parameters(const struct bench_options *options) {
    for (uint32_t i = 0; i < options->replay.assignment_count; i++) {
        bool known = false;
        for (uint32_t t = 0; t < options->technique_count && !known; t++) {
            pnb_value value;
            if (!parse_assignment(options->replay.assignments[i], options->techniques[t], &value, &known) && known)
                return false;
        }
        if (!known)
            return report_unknown_parameter(options->replay.assignments[i], options->techniques[0]);
    }
    return true;
}

/* ---- Measuring ---- */

static struct pass_times *find_pass(struct technique_times *times, const char *name, uint32_t runs) {
    for (uint32_t i = 0; i < times->pass_count; i++)
        if (strcmp(times->passes[i].name, name) == 0)
            return &times->passes[i];
    if (times->pass_count == MAX_TIMED_PASSES)
        return NULL;
    struct pass_times *pass = &times->passes[times->pass_count];
    pass->gpu = calloc(runs, sizeof *pass->gpu);
    pass->cpu = calloc(runs, sizeof *pass->cpu);
    if (!pass->gpu || !pass->cpu)
        return NULL;
    snprintf(pass->name, sizeof pass->name, "%s", name);
    times->pass_count++;
    return pass;
}

static bool take_timings(struct technique_times *times, const pnb_job *job, uint32_t run, uint32_t runs) {
    for (uint32_t i = 0; i < pnb_job_timing_count(job); i++) {
        pnb_timing timing = PNB_INIT(pnb_timing);
        if (pnb_job_get_timing(job, i, &timing) != PNB_OK)
            return tool_error("%s", pnb_last_error());
        struct pass_times *pass = find_pass(times, timing.name, runs);
        if (!pass)
            return tool_error("too many passes, or out of memory");
        pass->count = timing.count;
        pass->bytes = timing.bytes;
        pass->gpu[run] = timing.gpu_ms;
        pass->cpu[run] = timing.cpu_ms;
    }
    return true;
}

/* One technique's turn; run below 0 is a warm-up. */
static bool measure(struct replay *replay, struct technique_times *times, int64_t run, uint32_t runs) {
    double wall;
    pnb_job *job = replay_run(replay, &times->settings, &wall);
    if (!job)
        return false;
    bool good = true;
    if (run >= 0) {
        times->wall[run] = wall;
        good = take_timings(times, job, (uint32_t)run, runs);
    }
    pnb_job_destroy(&job);
    return good;
}

static bool measure_all(const struct bench_options *options, struct replay *replay, struct technique_times *all) {
    for (int64_t run = -(int64_t)options->warmup; run < options->runs; run++)
        for (uint32_t t = 0; t < options->technique_count; t++)
            if (!measure(replay, &all[t], run, options->runs))
                return false;
    return true;
}

static bool prepare(const struct bench_options *options, const struct replay *replay, struct technique_times *all) {
    for (uint32_t t = 0; t < options->technique_count; t++) {
        all[t].technique = options->techniques[t];
        if (!replay_settings(replay, &options->replay, options->techniques[t], true, all[t].values, &all[t].settings))
            return false;
        all[t].wall = calloc(options->runs, sizeof *all[t].wall);
        if (!all[t].wall)
            return tool_error("out of memory");
    }
    return true;
}

static void free_times(struct technique_times *all, uint32_t count) {
    for (uint32_t t = 0; all && t < count; t++) {
        free(all[t].wall);
        for (uint32_t p = 0; p < MAX_TIMED_PASSES; p++) {
            free(all[t].passes[p].gpu);
            free(all[t].passes[p].cpu);
        }
    }
    free(all);
}

/* ---- Report ---- */

static uint64_t total_bytes(const struct technique_times *times) {
    uint64_t bytes = 0;
    for (uint32_t p = 0; p < times->pass_count; p++)
        bytes += times->passes[p].bytes;
    return bytes;
}

static void print_table(const struct bench_options *options, struct technique_times *all) {
    printf("%-14s %-22s %5s %10s %10s %10s %10s %12s\n", "technique", "pass", "count", "median ms", "min", "max",
           "cpu ms", "bytes");
    for (uint32_t t = 0; t < options->technique_count; t++) {
        struct technique_times *times = &all[t];
        struct statistics wall = statistics_of(times->wall, options->runs);
        printf("%-14s %-22s %5s %10.2f %10.2f %10.2f %10s %12llu\n", technique_id(times->technique), "wall", "",
               wall.median, wall.minimum, wall.maximum, "", (unsigned long long)total_bytes(times));
        for (uint32_t p = 0; p < times->pass_count; p++) {
            struct pass_times *pass = &times->passes[p];
            struct statistics gpu = statistics_of(pass->gpu, options->runs);
            struct statistics cpu = statistics_of(pass->cpu, options->runs);
            printf("%-14s %-22s %5u %10.2f %10.2f %10.2f %10.2f %12llu\n", "", pass->name, pass->count, gpu.median,
                   gpu.minimum, gpu.maximum, cpu.median, (unsigned long long)pass->bytes);
        }
    }
}

static void write_statistics(struct json *json, const char *name, double *values, uint32_t count) {
    struct statistics statistics = statistics_of(values, count);
    json_open(json, name, '{');
    json_number(json, "median", statistics.median);
    json_number(json, "minimum", statistics.minimum);
    json_number(json, "maximum", statistics.maximum);
    json_close(json, '{');
}

/* "model name" of the first processor, or "". */
static void processor_name(char *name, size_t size) {
    name[0] = 0;
    FILE *file = fopen("/proc/cpuinfo", "r");
    char line[512];
    while (file && !name[0] && fgets(line, sizeof line, file)) {
        char *colon = strchr(line, ':');
        if (colon && strncmp(line, "model name", 10) == 0)
            snprintf(name, size, "%.*s", (int)strcspn(colon + 2, "\n"), colon + 2);
    }
    if (file)
        fclose(file);
}

static void write_machine(struct json *json, const struct replay *replay) {
    char processor[256];
    processor_name(processor, sizeof processor);
    pnb_context_info info = PNB_INIT(pnb_context_info);
    pnb_context_get_info(replay->context, &info);
    json_open(json, "machine", '{');
    json_string(json, "processor", processor);
    json_count(json, "processors", (uint64_t)sysconf(_SC_NPROCESSORS_ONLN));
    json_string(json, "backend", info.backend);
    json_string(json, "vendor", info.vendor);
    json_string(json, "renderer", info.renderer);
    json_string(json, "version", info.version);
    json_bool(json, "is_software", info.is_software != 0);
    json_close(json, '{');
}

static void write_technique(struct json *json, struct technique_times *times, uint32_t runs) {
    json_open(json, NULL, '{');
    json_string(json, "id", technique_id(times->technique));
    write_statistics(json, "wall_ms", times->wall, runs);
    json_count(json, "bytes", total_bytes(times));
    json_open(json, "passes", '[');
    for (uint32_t p = 0; p < times->pass_count; p++) {
        struct pass_times *pass = &times->passes[p];
        json_open(json, NULL, '{');
        json_string(json, "name", pass->name);
        json_count(json, "count", pass->count);
        write_statistics(json, "gpu_ms", pass->gpu, runs);
        write_statistics(json, "cpu_ms", pass->cpu, runs);
        json_count(json, "bytes", pass->bytes);
        json_close(json, '{');
    }
    json_close(json, '[');
    json_close(json, '{');
}

/* What is rendered with: fields that the capture leaves open are at their defaults. */
static void write_settings(struct json *json, const pnb_settings *settings) {
    json_open(json, "settings", '{');
    json_count(json, "width", settings->width);
    json_count(json, "height", settings->height);
    json_count(json, "samples", settings->samples ? settings->samples : PNB_DEFAULT_SAMPLES);
    json_count(json, "shadow_map_size", settings->shadow_map_size ? settings->shadow_map_size : PNB_DEFAULT_MAP_SIZE);
    json_count(json, "light_samples", settings->light_samples ? settings->light_samples : PNB_DEFAULT_LIGHT_SAMPLES);
    json_close(json, '{');
}

static void write_report(struct json *json, const struct bench_options *options, const struct replay *replay,
                         struct technique_times *all) {
    json_open(json, NULL, '{');
    json_string(json, "penumbra", pnb_version());
    json_string(json, "capture", options->capture);
    write_machine(json, replay);
    write_settings(json, &replay->settings);
    json_count(json, "runs", options->runs);
    json_count(json, "warmup", options->warmup);
    json_number(json, "context_ms", replay->context_ms);
    json_open(json, "techniques", '[');
    for (uint32_t t = 0; t < options->technique_count; t++)
        write_technique(json, &all[t], options->runs);
    json_close(json, '[');
    json_close(json, '{');
}

static bool write_json(const struct bench_options *options, const struct replay *replay, struct technique_times *all) {
    struct output output;
    if (!output_begin(&output, options->json))
        return false;
    FILE *file = fopen(output.temporary, "w");
    bool good = file != NULL;
    if (file) {
        struct json json = {.file = file};
        write_report(&json, options, replay, all);
        good = !ferror(file);
        good = fclose(file) == 0 && good;
    }
    if (!good)
        tool_error("cannot write %s: %s", options->json, strerror(errno));
    return output_end(&output, good);
}

static int bench(const struct bench_options *options, struct replay *replay) {
    struct technique_times *all = calloc(options->technique_count, sizeof *all);
    int code = EXIT_RENDER;
    if (!all)
        tool_error("out of memory");
    else if (!check_parameters(options) || !prepare(options, replay, all))
        code = EXIT_USAGE;
    else if ((code = replay_start(replay, &options->replay)) == EXIT_OK) {
        bool good = measure_all(options, replay, all);
        if (good)
            print_table(options, all);
        if (!good || (options->json && !write_json(options, replay, all)))
            code = EXIT_RENDER;
    }
    free_times(all, options->technique_count);
    return code;
}

int command_bench(int count, char **arguments) {
    struct bench_options options = {.runs = 5, .warmup = 1};
    int code = parse_options(count, arguments, &options);
    if (code)
        return code < 0 ? EXIT_OK : code;
    if (options.json && !output_check(options.json))
        return EXIT_RENDER;
    struct replay replay;
    options.replay.one_technique = options.technique_count > 0;
    code = replay_open(&replay, options.capture, &options.replay);
    if (code == EXIT_OK && options.technique_count == 0)
        add_technique(&options, replay.technique);
    if (code == EXIT_OK)
        code = bench(&options, &replay);
    replay_close(&replay);
    return code;
}
