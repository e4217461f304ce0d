/* SPDX-License-Identifier: GPL-3.0-or-later
 * OpenGL that fails while rendering: every glGetError of a render reports, in turn, that memory is out, that the
 * context is lost, or an error. */
#include "spawn.h"

#include <dlfcn.h>

static void (*set_faults)(const char *list);
static struct small_scene small;

static pnb_result render(pnb_context *context) {
    pnb_job *job = NULL;
    pnb_result result = pnb_render(context, small_scene_get(&small), &small.settings, &job);
    pnb_job_destroy(&job);
    return result;
}

/* Fails the n-th glGetError of a render with `code` until a render gets through; gives how many failed. */
static int fail_each(pnb_context **context, const char *code, pnb_result expected, const char *message) {
    enum { MOST = 1000 };
    for (int n = 1; n < MOST; ++n) {
        char fault[64];
        snprintf(fault, sizeof fault, "gl-error=%d:%s", n, code);
        set_faults(fault);
        pnb_result result = render(*context);
        char error[1024];
        snprintf(error, sizeof error, "%s", pnb_last_error());
        set_faults("");
        if (result == PNB_OK) {
            return n - 1;
        }
        CHECK_RESULT(result, expected);
        CHECK_CONTAINS(error, message);
        if (expected == PNB_ERROR_CONTEXT_LOST) {
            CHECK_RESULT(render(*context), PNB_ERROR_CONTEXT_LOST);
            pnb_context_destroy(context);
            CHECK_RESULT(create_context("egl", context), PNB_OK);
        }
        CHECK_RESULT(render(*context), PNB_OK);
    }
    return MOST;
}

/* Each glGetError while a context is created. */
static int fail_each_creation(const char *code, pnb_result expected) {
    enum { MOST = 1000 };
    for (int n = 1; n < MOST; ++n) {
        char fault[64];
        pnb_context *context = NULL;
        snprintf(fault, sizeof fault, "gl-error=%d:%s", n, code);
        set_faults(fault);
        pnb_result result = create_context("egl", &context);
        set_faults("");
        pnb_context_destroy(&context);
        if (result == PNB_OK) {
            return n - 1;
        }
        CHECK_RESULT(result, expected);
    }
    return MOST;
}

static int run_with_fakes(void) {
    pnb_context *context = NULL;
    void *library = dlopen("libEGL.so.1", RTLD_NOW | RTLD_LOCAL);
    *(void **)&set_faults = library ? dlsym(library, "fake_egl_set") : NULL;
    if (!set_faults || create_context("egl", &context) != PNB_OK) {
        printf("skipped: the fake libEGL is not in use: %s\n", pnb_last_error());
        return CHECK_SKIPPED;
    }
    CHECK_RESULT(small_scene_create(&small), PNB_OK);
    CHECK_RESULT(render(context), PNB_OK);
    int lost = fail_each(&context, "507", PNB_ERROR_CONTEXT_LOST, "lost");
    int memory = fail_each(&context, "505", PNB_ERROR_OUT_OF_MEMORY, "out of memory");
    int other = fail_each(&context, "502", PNB_ERROR_INTERNAL, "GL_INVALID_OPERATION");
    printf("render: %d context losses, %d out of memory, %d other errors\n", lost, memory, other);
    CHECK(lost > 0 && memory > 0 && other > 0);
    printf("create: %d out of memory\n", fail_each_creation("505", PNB_ERROR_OUT_OF_MEMORY));
    pnb_context_destroy(&context);
    small_scene_destroy(&small);
    CHECK_INT(memory_live_blocks(), 0);
    return check_report();
}

int main(int argc, char **argv) {
    (void)argv;
    if (argc > 1) {
        return run_with_fakes();
    }
    static char output[65536];
    struct spawn spawn = {.argument = "use", .variables = {"LD_LIBRARY_PATH=" FAKE_GL_FOLDER "/faulty"}};
    int status = spawn_self(&spawn, output, sizeof output);
    fputs(output, stdout);
    return WIFEXITED(status) ? WEXITSTATUS(status) : 1;
}
