/* SPDX-License-Identifier: GPL-3.0-or-later
 * The same scene gives the same bits: again and again, on EGL and OSMesa, and with any number of llvmpipe threads. Each
 * environment is a process of its own, because drivers read theirs once. */
#include "fault/spawn.h"
#include "test_scenes.h"

#include <inttypes.h>

#define REPEATS 20

static const char *const scene_names[] = {"all-lights", "perforated", "fence"};
#define SCENES (sizeof scene_names / sizeof scene_names[0])

/* FNV-1a */
static uint64_t hash(uint64_t state, const void *data, size_t size) {
    for (const unsigned char *byte = data; size > 0; ++byte, --size) {
        state = (state ^ *byte) * UINT64_C(0x100000001b3);
    }
    return state;
}

static uint64_t hash_images(uint64_t state, const pnb_job *job) {
    pnb_image image = PNB_INIT(pnb_image);
    for (uint32_t i = 0; i < pnb_job_image_count(job); ++i) {
        CHECK_RESULT(pnb_job_get_image(job, i, &image), PNB_OK);
        size_t values = (size_t)image.width * image.height * image.channels;
        state = hash(state, image.name, strlen(image.name));
        state = hash(state, image.pixels, values * sizeof *image.pixels);
    }
    return state;
}

/* One number for all passes of the scene by every technique. */
static uint64_t hash_scene(pnb_context *context, const struct test_scene *scene) {
    uint64_t state = UINT64_C(0xcbf29ce484222325);
    for (uint32_t i = 0; i < pnb_technique_count(); ++i) {
        pnb_technique_info technique = PNB_INIT(pnb_technique_info);
        pnb_job *job = NULL;
        pnb_settings settings = *test_scene_settings(scene);
        pnb_technique_get_info(i, &technique);
        settings.technique = technique.id;
        settings.width = 161; /* odd, so that rows do not end with a tile */
        settings.height = 91;
        settings.samples = 3;
        settings.shadow_map_size = 200;
        settings.light_samples = 3;
        settings.passes =
            PNB_PASS_COMBINED | PNB_PASS_DEPTH | PNB_PASS_NORMAL | PNB_PASS_SHADOW | PNB_PASS_LIGHT_SHADOWS;
        CHECK_RESULT(pnb_render(context, test_scene_get(scene), &settings, &job), PNB_OK);
        state = hash_images(state, job);
        pnb_job_destroy(&job);
    }
    return state;
}

/* In the new process: prints the renderer and one hash per scene, each found REPEATS times. */
static int print_hashes(int repeats) {
    pnb_context *context = NULL;
    pnb_context_info info = PNB_INIT(pnb_context_info);
    if (pnb_context_create(NULL, &context) != PNB_OK) {
        printf("none\n");
        return 0;
    }
    pnb_context_get_info(context, &info);
    printf("%s:", info.renderer);
    for (size_t i = 0; i < SCENES; ++i) {
        struct test_scene *scene = test_scene_create(scene_names[i], NULL);
        uint64_t first = scene ? hash_scene(context, scene) : 0;
        CHECK(scene != NULL);
        for (int j = 1; scene && j < repeats; ++j) {
            CHECK(hash_scene(context, scene) == first);
        }
        printf(" %016" PRIx64, first);
        test_scene_destroy(&scene);
    }
    printf("\n");
    pnb_context_destroy(&context);
    CHECK_INT(memory_live_blocks(), 0);
    return checks_failed > 0;
}

static void hashes_of(const char *backend, const char *threads, const char *argument, char *output, size_t size) {
    char backend_variable[64], threads_variable[64];
    snprintf(backend_variable, sizeof backend_variable, "PENUMBRA_BACKEND=%s", backend);
    snprintf(threads_variable, sizeof threads_variable, "LP_NUM_THREADS=%s", threads);
    struct spawn spawn = {.argument = argument, .variables = {backend_variable, threads_variable}};
    int status = spawn_self(&spawn, output, size);
    CHECK(WIFEXITED(status) && WEXITSTATUS(status) == 0);
    printf("%s, LP_NUM_THREADS=%s: %s", backend, threads, output);
}

int main(int argc, char **argv) {
    if (argc > 1) {
        return print_hashes(strcmp(argv[1], "repeat") == 0 ? REPEATS : 1);
    }
    static const char *const thread_counts[] = {"0", "1", "2", "16"};
    char expected[1024], output[1024];
    hashes_of("surfaceless", "2", "repeat", expected, sizeof expected);
    if (strcmp(expected, "none\n") == 0) {
        printf("skipped: needs EGL\n");
        return CHECK_SKIPPED;
    }
    size_t renderer_length = strcspn(expected, ":");
    for (int i = 0; i < BACKEND_KINDS; ++i) {
        for (size_t j = 0; j < sizeof thread_counts / sizeof thread_counts[0]; ++j) {
            hashes_of(backend_kinds[i], thread_counts[j], "once", output, sizeof output);
            if (strncmp(output, expected, renderer_length + 1) == 0) { /* another renderer may differ */
                CHECK_STRING(output, expected);
            }
        }
    }
    return check_report();
}
