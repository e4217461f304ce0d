/* SPDX-License-Identifier: GPL-3.0-or-later
 * 16 host threads that call at once, on one context and each on its own. */
#include "support.h"

#include <pthread.h>

#define THREADS      16
#define ROUNDS       25
#define OWN_CONTEXTS 2
#define MANY_SAMPLES 4096

static struct small_scene small;
static pnb_context *shared;

struct worker {
    pthread_t thread;
    unsigned number;
    int rendered, cancelled;
};

/* Some renders are waited for, some polled and cancelled, some destroyed while queued or running. */
static void one_round(struct worker *worker, unsigned round) {
    pnb_job *job = NULL;
    pnb_progress progress = PNB_INIT(pnb_progress);
    struct small_scene copy = small;
    unsigned kind = (worker->number + round) % 5;
    copy.settings.samples = kind < 2 ? 1 : MANY_SAMPLES;
    if (!CHECK_RESULT(pnb_render_start(shared, small_scene_get(&copy), &copy.settings, &job), PNB_OK)) {
        return;
    }
    if (kind < 2) {
        CHECK_RESULT(pnb_job_wait(job, UINT32_MAX, &progress), PNB_OK);
        CHECK(pnb_job_image_count(job) >= 1);
        worker->rendered += 1;
    } else if (kind < 4) {
        pnb_job_wait(job, kind - 2, &progress);
        pnb_job_cancel(job);
        CHECK_RESULT(pnb_job_wait(job, UINT32_MAX, NULL), PNB_ERROR_CANCELLED);
        CHECK_CONTAINS(pnb_last_error(), "cancelled");
        worker->cancelled += 1;
    }
    pnb_job_destroy(&job);
}

static void *use_shared(void *user) {
    struct worker *worker = user;
    for (unsigned round = 0; round < ROUNDS; ++round) {
        pnb_context_info info = PNB_INIT(pnb_context_info);
        one_round(worker, round);
        CHECK_RESULT(pnb_context_get_info(shared, &info), PNB_OK);
        /* Every thread has its own last error. */
        info.struct_size = worker->number;
        CHECK_RESULT(pnb_context_get_info(shared, &info), PNB_ERROR_INVALID_ARGUMENT);
        char expected[64];
        snprintf(expected, sizeof expected, "struct_size is %u,", worker->number);
        CHECK_CONTAINS(pnb_last_error(), expected);
    }
    return NULL;
}

static void *use_own(void *user) {
    struct worker *worker = user;
    for (int i = 0; i < OWN_CONTEXTS; ++i) {
        struct small_scene copy = small;
        pnb_context *context = NULL;
        pnb_job *job = NULL, *abandoned = NULL;
        const char *backend = backend_kinds[worker->number % BACKEND_KINDS];
        if (!CHECK_RESULT(create_context(backend, &context), PNB_OK)) {
            continue;
        }
        CHECK_RESULT(pnb_render(context, small_scene_get(&copy), &copy.settings, &job), PNB_OK);
        copy.settings.samples = MANY_SAMPLES;
        CHECK_RESULT(pnb_render_start(context, small_scene_get(&copy), &copy.settings, &abandoned), PNB_OK);
        pnb_context_destroy(&context);
        CHECK_RESULT(pnb_job_wait(abandoned, 0, NULL), PNB_ERROR_CANCELLED);
        pnb_job_destroy(&abandoned);
        pnb_job_destroy(&job);
        worker->rendered += 1;
    }
    return NULL;
}

static void run_threads(const char *what, void *(*function)(void *)) {
    struct worker workers[THREADS] = {0};
    int rendered = 0, cancelled = 0;
    for (unsigned i = 0; i < THREADS; ++i) {
        workers[i].number = i;
        CHECK_INT(pthread_create(&workers[i].thread, NULL, function, &workers[i]), 0);
    }
    for (unsigned i = 0; i < THREADS; ++i) {
        pthread_join(workers[i].thread, NULL);
        rendered += workers[i].rendered;
        cancelled += workers[i].cancelled;
    }
    printf("%d threads, %s: %d renders, %d cancelled\n", THREADS, what, rendered, cancelled);
}

int main(void) {
    for (int i = 0; i < BACKEND_KINDS; ++i) {
        if (!backend_works(backend_kinds[i])) {
            printf("skipped: needs every backend: %s\n", pnb_last_error());
            return CHECK_SKIPPED;
        }
    }
    CHECK_RESULT(small_scene_create(&small), PNB_OK);
    CHECK_RESULT(create_context(NULL, &shared), PNB_OK);
    run_threads("one context", use_shared);
    pnb_context_destroy(&shared);
    run_threads("a context each", use_own);
    small_scene_destroy(&small);
    CHECK_INT(memory_live_blocks(), 0);
    return check_report();
}
