/* SPDX-License-Identifier: GPL-3.0-or-later
 * 200 contexts, one after the other, on each backend: memory, threads and file descriptors must not grow. */
#include "support.h"

#include <dirent.h>

#define CONTEXTS 200
/* Drivers fill caches at first: memory was flat after 40 contexts with Mesa 22.3 on either backend. */
#define WARM_UP 40
/* A texture, a shader or a thread's stack left behind by every context would be far more. OSMesa itself leaks about
 * 200 bytes per context, 31 KiB here. */
#define GROWTH_LIMIT_KIB 1024

static int entries(const char *folder) {
    int count = 0;
    DIR *directory = opendir(folder);
    while (directory && readdir(directory)) {
        ++count;
    }
    if (directory) {
        closedir(directory);
    }
    return count;
}

static void open_render_close(const char *backend, struct small_scene *small) {
    pnb_context *context;
    pnb_job *job;
    if (!CHECK_RESULT(create_context(backend, &context), PNB_OK)) {
        return;
    }
    if (CHECK_RESULT(pnb_render(context, small_scene_get(small), &small->settings, &job), PNB_OK)) {
        pnb_job_destroy(&job);
    }
    pnb_context_destroy(&context);
}

static void nothing_grows(const char *backend) {
    struct small_scene small;
    CHECK_RESULT(small_scene_create(&small), PNB_OK);
    long memory = 0;
    int threads = 0, files = 0;
    for (int i = 0; i < CONTEXTS; ++i) {
        if (i == WARM_UP) {
            memory = resident_kib();
            threads = entries("/proc/self/task");
            files = entries("/proc/self/fd");
        }
        open_render_close(backend, &small);
    }
    long growth = resident_kib() - memory;
    printf("%s: %d contexts: %ld KiB after %d, %+ld KiB since\n", backend, CONTEXTS, memory, WARM_UP, growth);
    if (!UNDER_ADDRESS_SANITIZER) { /* which keeps freed memory for a while */
        CHECK_AT_MOST((double)growth, GROWTH_LIMIT_KIB);
    }
    CHECK_INT(entries("/proc/self/task"), threads);
    CHECK_INT(entries("/proc/self/fd"), files);
    small_scene_destroy(&small);
    CHECK_INT(memory_live_blocks(), 0);
}

int main(void) {
    int available = 0;
    for (int i = 1; i < BACKEND_KINDS; ++i) { /* a device is EGL as well */
        if (backend_works(backend_kinds[i])) {
            nothing_grows(backend_kinds[i]);
            ++available;
        }
    }
    return available ? check_report() : CHECK_SKIPPED;
}
