/* SPDX-License-Identifier: GPL-3.0-or-later
 * After fork() the drivers' threads are gone, so that any wait for OpenGL would last for ever. The child must get an
 * error at once; the parent must not notice. */
#include "support.h"

#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

/* What one call may take; here all calls of a child together. */
#define LIMIT_MS 100

static struct small_scene small;
static pnb_context *context;
static pnb_job *running;

static double milliseconds(void) {
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return (double)time.tv_sec * 1e3 + (double)time.tv_nsec * 1e-6;
}

/* Runs checks in a forked child, which ends without the parent's exit handlers. */
static void in_child(const char *what, void (*checks)(void)) {
    fflush(stdout);
    pid_t child = fork();
    if (child == 0) {
        checks_passed = checks_failed = 0;
        alarm(60); /* a hang is a failure, not a test that never ends */
        double before = milliseconds();
        checks();
        double elapsed = milliseconds() - before;
        printf("%s: %d passed, %d failed in %.2f ms\n", what, checks_passed, checks_failed, elapsed);
        fflush(stdout);
        _exit(checks_failed > 0 ? 1 : 0);
    }
    int status = -1;
    waitpid(child, &status, 0);
    CHECK(WIFEXITED(status) && WEXITSTATUS(status) == 0);
}

static void child_is_refused(void) {
    pnb_context *const mine = context;
    pnb_context *fresh = NULL;
    pnb_job *job = NULL;
    pnb_context_info info = PNB_INIT(pnb_context_info);
    pnb_image image = PNB_INIT(pnb_image);
    pnb_timing timing = PNB_INIT(pnb_timing);
    uint32_t count = 7;
    double before = milliseconds();
    CHECK_RESULT(pnb_context_create(NULL, &fresh), PNB_ERROR_FORKED);
    CHECK_CONTAINS(pnb_last_error(), "fork");
    CHECK_RESULT(pnb_probe_backends(NULL, 0, &count), PNB_ERROR_FORKED);
    CHECK_INT(count, 7);
    CHECK_RESULT(pnb_context_get_info(context, &info), PNB_ERROR_FORKED);
    CHECK_RESULT(pnb_render_start(context, small_scene_get(&small), &small.settings, &job), PNB_ERROR_FORKED);
    CHECK_RESULT(pnb_render(context, small_scene_get(&small), &small.settings, &job), PNB_ERROR_FORKED);
    CHECK_RESULT(pnb_job_wait(running, UINT32_MAX, NULL), PNB_ERROR_FORKED);
    CHECK_RESULT(pnb_job_get_image(running, 0, &image), PNB_ERROR_FORKED);
    CHECK_RESULT(pnb_job_get_timing(running, 0, &timing), PNB_ERROR_FORKED);
    CHECK_INT(pnb_job_image_count(running) + pnb_job_timing_count(running) + pnb_job_message_count(running), 0);
    CHECK_STRING(pnb_job_message(running, 0), "");
    pnb_job_cancel(running);
    pnb_job_destroy(&running);
    pnb_context_destroy(&context);
    CHECK(mine && !context && !running && !fresh && !job);
    CHECK_AT_MOST(milliseconds() - before, LIMIT_MS);
}

/* The driver's threads outlive the last context. */
static void child_without_context_is_refused(void) {
    pnb_context *fresh = NULL;
    double before = milliseconds();
    CHECK_RESULT(pnb_context_create(NULL, &fresh), PNB_ERROR_FORKED);
    CHECK_AT_MOST(milliseconds() - before, LIMIT_MS);
}

/* What needs no context works in the child. */
static void child_may_make_meshes(void) {
    struct small_scene own;
    CHECK_RESULT(small_scene_create(&own), PNB_OK);
    small_scene_destroy(&own);
    CHECK(pnb_technique_count() > 0);
}

static void grandchild_is_refused(void) {
    in_child("grandchild", child_is_refused);
}

/* Of a process that never opened OpenGL. */
static void child_may_open_its_own(void) {
    pnb_context *own = NULL;
    pnb_job *job = NULL;
    CHECK_RESULT(small_scene_create(&small), PNB_OK);
    CHECK_RESULT(pnb_context_create(NULL, &own), PNB_OK);
    CHECK_RESULT(pnb_render(own, small_scene_get(&small), &small.settings, &job), PNB_OK);
    pnb_job_destroy(&job);
    pnb_context_destroy(&own);
    small_scene_destroy(&small);
    CHECK_INT(memory_live_blocks(), 0);
}

static void start_long_job(void) {
    pnb_settings settings = small.settings;
    settings.samples = 4096;
    CHECK_RESULT(pnb_render_start(context, small_scene_get(&small), &settings, &running), PNB_OK);
}

int main(void) {
    in_child("forked before OpenGL was opened", child_may_open_its_own);

    CHECK_RESULT(small_scene_create(&small), PNB_OK);
    if (create_context(NULL, &context) != PNB_OK) {
        printf("skipped: %s\n", pnb_last_error());
        return CHECK_SKIPPED;
    }
    start_long_job();
    in_child("forked during a render", child_is_refused);
    in_child("forked during a render, without OpenGL", child_may_make_meshes);
    in_child("forked twice", grandchild_is_refused);
    pnb_job_destroy(&running);

    pnb_job *job = NULL;
    CHECK_RESULT(pnb_render(context, small_scene_get(&small), &small.settings, &job), PNB_OK);
    pnb_job_destroy(&job);
    pnb_context_destroy(&context);
    in_child("forked after the context was destroyed", child_without_context_is_refused);
    small_scene_destroy(&small);
    CHECK_INT(memory_live_blocks(), 0);
    return check_report();
}
