/* SPDX-License-Identifier: GPL-3.0-or-later
 * Jobs on one thread: waiting, progress, cancelling, results, and jobs that outlive their context. */
#include "render/job.h"
#include "support.h"

#include <time.h>

/* Enough samples that a job is still running when the host does the next thing, however fast the machine is: it is
 * always cancelled, never waited for. */
#define MANY_SAMPLES 4096

static struct small_scene small;
static pnb_context *context;

static pnb_result start(uint32_t samples, pnb_job **job) {
    pnb_settings settings = small.settings;
    settings.samples = samples;
    return pnb_render_start(context, small_scene_get(&small), &settings, job);
}

static void images_come_out(void) {
    pnb_job *job = NULL;
    pnb_image image = PNB_INIT(pnb_image);
    pnb_timing timing = PNB_INIT(pnb_timing);
    CHECK_RESULT(pnb_render(context, small_scene_get(&small), &small.settings, &job), PNB_OK);
    CHECK(pnb_job_image_count(job) >= 1);
    for (uint32_t i = 0; i < pnb_job_image_count(job); ++i) {
        CHECK_RESULT(pnb_job_get_image(job, i, &image), PNB_OK);
        CHECK_INT(image.width, 64);
        CHECK_INT(image.height, 48);
        CHECK(image.channels == 1 || image.channels == 3 || image.channels == 4);
        CHECK(image.name && image.name[0]);
        bool finite = true;
        for (size_t j = 0; j < (size_t)image.width * image.height * image.channels; ++j) {
            finite = finite && isfinite(image.pixels[j]);
        }
        CHECK(finite);
    }
    CHECK(pnb_job_timing_count(job) >= 1);
    for (uint32_t i = 0; i < pnb_job_timing_count(job); ++i) {
        CHECK_RESULT(pnb_job_get_timing(job, i, &timing), PNB_OK);
        CHECK(timing.name[0] && timing.count >= 1 && timing.gpu_ms >= 0 && timing.cpu_ms >= 0);
    }
    pnb_job_destroy(&job);
    CHECK(job == NULL);
    pnb_job_destroy(&job);
    pnb_job_destroy(NULL);
}

static void results_check_their_arguments(void) {
    pnb_job *job = NULL;
    pnb_image image = PNB_INIT(pnb_image);
    pnb_timing timing = PNB_INIT(pnb_timing);
    pnb_progress progress = PNB_INIT(pnb_progress);
    CHECK_RESULT(pnb_render(context, small_scene_get(&small), &small.settings, &job), PNB_OK);
    CHECK_RESULT(pnb_job_get_image(job, pnb_job_image_count(job), &image), PNB_ERROR_INVALID_ARGUMENT);
    CHECK_RESULT(pnb_job_get_image(job, UINT32_MAX, &image), PNB_ERROR_INVALID_ARGUMENT);
    CHECK_RESULT(pnb_job_get_timing(job, pnb_job_timing_count(job), &timing), PNB_ERROR_INVALID_ARGUMENT);
    CHECK_RESULT(pnb_job_get_image(job, 0, NULL), PNB_ERROR_INVALID_ARGUMENT);
    CHECK_RESULT(pnb_job_get_timing(job, 0, NULL), PNB_ERROR_INVALID_ARGUMENT);
    CHECK_RESULT(pnb_job_get_image(NULL, 0, &image), PNB_ERROR_INVALID_ARGUMENT);
    CHECK_RESULT(pnb_job_get_timing(NULL, 0, &timing), PNB_ERROR_INVALID_ARGUMENT);
    CHECK_RESULT(pnb_job_wait(NULL, 0, NULL), PNB_ERROR_INVALID_ARGUMENT);
    image.struct_size = timing.struct_size = progress.struct_size = 3;
    CHECK_RESULT(pnb_job_get_image(job, 0, &image), PNB_ERROR_INVALID_ARGUMENT);
    CHECK_CONTAINS(pnb_last_error(), "pnb_image");
    CHECK_RESULT(pnb_job_get_timing(job, 0, &timing), PNB_ERROR_INVALID_ARGUMENT);
    CHECK_CONTAINS(pnb_last_error(), "pnb_timing");
    CHECK_RESULT(pnb_job_wait(job, 0, &progress), PNB_ERROR_INVALID_ARGUMENT);
    CHECK_CONTAINS(pnb_last_error(), "pnb_progress");
    CHECK_INT(pnb_job_image_count(NULL) + pnb_job_timing_count(NULL) + pnb_job_message_count(NULL), 0);
    CHECK_STRING(pnb_job_message(NULL, 0), "");
    CHECK_STRING(pnb_job_message(job, UINT32_MAX), "");
    pnb_job_cancel(NULL);
    pnb_job_destroy(&job);
}

static void bad_renders_are_refused(void) {
    pnb_job *const untouched = (pnb_job *)&small;
    pnb_job *job = untouched;
    const pnb_scene *scene = small_scene_get(&small);
    pnb_settings settings = small.settings;
    pnb_scene broken = *scene;
    CHECK_RESULT(pnb_render_start(NULL, scene, &settings, &job), PNB_ERROR_INVALID_ARGUMENT);
    CHECK_RESULT(pnb_render_start(context, NULL, &settings, &job), PNB_ERROR_INVALID_ARGUMENT);
    CHECK_RESULT(pnb_render_start(context, scene, NULL, &job), PNB_ERROR_INVALID_ARGUMENT);
    CHECK_RESULT(pnb_render_start(context, scene, &settings, NULL), PNB_ERROR_INVALID_ARGUMENT);
    CHECK_RESULT(pnb_render(context, scene, &settings, NULL), PNB_ERROR_INVALID_ARGUMENT);
    CHECK_RESULT(pnb_render(NULL, scene, &settings, &job), PNB_ERROR_INVALID_ARGUMENT);
    broken.struct_size -= 8;
    CHECK_RESULT(pnb_render(context, &broken, &settings, &job), PNB_ERROR_INVALID_ARGUMENT);
    CHECK_CONTAINS(pnb_last_error(), "pnb_scene");
    settings.struct_size += 8;
    CHECK_RESULT(pnb_render(context, scene, &settings, &job), PNB_ERROR_INVALID_ARGUMENT);
    CHECK_CONTAINS(pnb_last_error(), "pnb_settings");
    CHECK(job == untouched);
}

static void progress_never_falls(void) {
    pnb_job *job = NULL;
    pnb_progress progress = PNB_INIT(pnb_progress);
    float fraction = 0;
    uint32_t sample = 0, falls = 0;
    pnb_result result;
    CHECK_RESULT(start(16, &job), PNB_OK);
    while ((result = pnb_job_wait(job, 1, &progress)) == PNB_TIMEOUT) {
        falls += progress.fraction < fraction || progress.sample < sample || progress.fraction > 1;
        fraction = progress.fraction;
        sample = progress.sample;
    }
    CHECK_RESULT(result, PNB_OK);
    CHECK_INT(falls, 0);
    CHECK_NEAR(progress.fraction, 1, 0);
    CHECK_INT(progress.sample, 16);
    CHECK_INT(progress.samples, 16);
    CHECK(progress.text[0]);
    CHECK_RESULT(pnb_job_wait(job, UINT32_MAX, NULL), PNB_OK);
    pnb_job_destroy(&job);
}

/* Copies image 0 of a progressive job until more than `before` samples are in it; their number. */
static uint32_t copy_more(pnb_job *job, uint32_t before, float *pixels, size_t count) {
    uint32_t samples = 0;
    while (samples <= before) {
        const pnb_result result = pnb_job_copy_image(job, 0, NULL, 0, &samples);
        if (result < PNB_OK)
            return 0;
        (void)pnb_job_wait(job, 1, NULL);
    }
    CHECK_RESULT(pnb_job_copy_image(job, 0, pixels, count, &samples), PNB_OK);
    return samples;
}

static double mean_of(const float *pixels, size_t count) {
    double sum = 0;
    for (size_t i = 0; i < count; ++i)
        sum += (double)pixels[i];
    return sum / (double)count;
}

/* Images of a running job: means of a power of two of samples, as bright as the finished image. */
static void progressive_jobs_show_their_samples(void) {
    enum { FLOATS = 64 * 48 * 4 };
    static float first[FLOATS], later[FLOATS], last[FLOATS];
    pnb_job *job = NULL;
    pnb_settings settings = small.settings;
    settings.samples = MANY_SAMPLES, settings.flags = PNB_SETTINGS_PROGRESSIVE, settings.passes = PNB_PASS_COMBINED;
    CHECK_RESULT(pnb_render_start(context, small_scene_get(&small), &settings, &job), PNB_OK);
    const uint32_t one = copy_more(job, 0, first, FLOATS), more = copy_more(job, 31, later, FLOATS);
    CHECK(one >= 1 && (one & (one - 1)) == 0);
    CHECK(more >= 32 && (more & (more - 1)) == 0 && more < MANY_SAMPLES);
    CHECK_RESULT(pnb_job_copy_image(job, 1, later, FLOATS, NULL), PNB_ERROR_INVALID_ARGUMENT);
    CHECK_RESULT(pnb_job_copy_image(job, 0, later, FLOATS - 1, NULL), PNB_ERROR_INVALID_ARGUMENT);
    pnb_job_cancel(job);
    CHECK_RESULT(pnb_job_wait(job, UINT32_MAX, NULL), PNB_ERROR_CANCELLED);
    CHECK_RESULT(pnb_job_copy_image(job, 0, later, FLOATS, NULL), PNB_ERROR_CANCELLED);
    pnb_job_destroy(&job);
    settings.samples = 64;
    CHECK_RESULT(pnb_render(context, small_scene_get(&small), &settings, &job), PNB_OK);
    uint32_t all = 0;
    CHECK_RESULT(pnb_job_copy_image(job, 0, last, FLOATS, &all), PNB_OK);
    CHECK_INT(all, 64);
    const double wanted = mean_of(last, FLOATS);
    printf("means of %u, %u and 64 samples: %.4f %.4f %.4f\n", one, more, mean_of(first, FLOATS),
           mean_of(later, FLOATS), wanted);
    CHECK_NEAR(mean_of(first, FLOATS), wanted, 0.05 * wanted); /* edges of one sample are steps */
    CHECK_NEAR(mean_of(later, FLOATS), wanted, 0.01 * wanted);
    pnb_job_destroy(&job);
    CHECK_RESULT(pnb_job_copy_image(NULL, 0, last, FLOATS, NULL), PNB_ERROR_INVALID_ARGUMENT);
}

static void progress_is_kept_in_range(void) {
    pnb_job *job = NULL;
    pnb_progress progress = PNB_INIT(pnb_progress);
    CHECK_RESULT(start(8, &job), PNB_OK);
    pnb_job_cancel(job); /* the renderer reports no more of it */
    pnb_job_wait(job, UINT32_MAX, NULL);
    job->result = PNB_OK;
    float before = job->progress.fraction;
    const struct {
        float fraction, expected;
        uint32_t sample, expected_sample;
    } rows[] = {{NAN, before, 0, job->progress.sample},
                {0.9f, 0.9f, 5, 5},
                {0.5f, 0.9f, 3, 5},
                {-INFINITY, 0.9f, 7, 7},
                {7.0f, 1.0f, 99, 8}};
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; ++i) {
        job_set_progress(job, rows[i].fraction, rows[i].sample, "Testing");
        CHECK_RESULT(pnb_job_wait(job, 0, &progress), PNB_OK);
        CHECK_NEAR(progress.fraction, rows[i].expected, 0);
        CHECK_INT(progress.sample, rows[i].expected_sample);
        CHECK_STRING(progress.text, "Testing");
    }
    pnb_job_destroy(&job);
}

static void timings_of_one_name_are_added(void) {
    pnb_job *job = NULL;
    pnb_timing timing = PNB_INIT(pnb_timing);
    CHECK_RESULT(pnb_render(context, small_scene_get(&small), &small.settings, &job), PNB_OK);
    uint32_t count = pnb_job_timing_count(job);
    CHECK_RESULT(job_add_timing(job, "a pass", 1.0, 10.0, 100), PNB_OK);
    CHECK_RESULT(job_add_timing(job, "another", 7.0, 7.0, 7), PNB_OK);
    CHECK_RESULT(job_add_timing(job, "a pass", 2.0, 20.0, 50), PNB_OK);
    CHECK_INT(pnb_job_timing_count(job), count + 2);
    CHECK_RESULT(pnb_job_get_timing(job, count, &timing), PNB_OK);
    CHECK_STRING(timing.name, "a pass");
    CHECK_INT(timing.count, 2);
    CHECK_NEAR(timing.gpu_ms, 3, 0);
    CHECK_NEAR(timing.cpu_ms, 30, 0);
    CHECK(timing.bytes == 100);
    pnb_job_destroy(&job);
}

/* Waits until the job has left the queue. */
static void wait_until_running(pnb_job *job) {
    pnb_progress progress = PNB_INIT(pnb_progress);
    while (pnb_job_wait(job, 1, &progress) == PNB_TIMEOUT && progress.fraction <= 0) {
    }
}

static void running_jobs_are_cancelled(void) {
    pnb_job *job = NULL;
    pnb_image image = PNB_INIT(pnb_image);
    CHECK_RESULT(start(MANY_SAMPLES, &job), PNB_OK);
    CHECK_RESULT(pnb_job_get_image(job, 0, &image), PNB_ERROR_INVALID_ARGUMENT);
    CHECK_INT(pnb_job_image_count(job), 0);
    wait_until_running(job);
    pnb_job_cancel(job);
    pnb_job_cancel(job);
    CHECK_RESULT(pnb_job_wait(job, UINT32_MAX, NULL), PNB_ERROR_CANCELLED);
    CHECK_CONTAINS(pnb_last_error(), "cancelled");
    CHECK_INT(pnb_job_image_count(job), 0);
    pnb_job_destroy(&job);
}

static void queued_jobs_are_cancelled_at_once(void) {
    pnb_job *running = NULL, *queued = NULL, *last = NULL;
    CHECK_RESULT(start(MANY_SAMPLES, &running), PNB_OK);
    CHECK_RESULT(start(1, &queued), PNB_OK);
    CHECK_RESULT(start(1, &last), PNB_OK);
    pnb_job_cancel(queued);
    CHECK_RESULT(pnb_job_wait(queued, 0, NULL), PNB_ERROR_CANCELLED);
    CHECK_RESULT(pnb_job_wait(running, 0, NULL), PNB_TIMEOUT);
    pnb_job_destroy(&queued);
    CHECK_RESULT(pnb_job_wait(running, 0, NULL), PNB_TIMEOUT);
    pnb_job_destroy(&running);
    CHECK_RESULT(pnb_job_wait(last, UINT32_MAX, NULL), PNB_OK);
    pnb_job_destroy(&last);
}

/* A finished job stays finished. */
static void done_jobs_cannot_be_cancelled(void) {
    pnb_job *job = NULL;
    CHECK_RESULT(start(1, &job), PNB_OK);
    CHECK_RESULT(pnb_job_wait(job, UINT32_MAX, NULL), PNB_OK);
    pnb_job_cancel(job);
    CHECK_RESULT(pnb_job_wait(job, UINT32_MAX, NULL), PNB_OK);
    CHECK(pnb_job_image_count(job) >= 1);
    pnb_job_destroy(&job);
}

static void jobs_run_in_order(void) {
    enum { COUNT = 8 };
    pnb_job *jobs[COUNT];
    for (int i = 0; i < COUNT; ++i) {
        CHECK_RESULT(start(1, &jobs[i]), PNB_OK);
    }
    CHECK_RESULT(pnb_job_wait(jobs[COUNT - 1], UINT32_MAX, NULL), PNB_OK);
    for (int i = 0; i < COUNT; ++i) {
        CHECK_RESULT(pnb_job_wait(jobs[i], 0, NULL), PNB_OK);
        pnb_job_destroy(&jobs[i]);
    }
}

static double milliseconds(void) {
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return (double)time.tv_sec * 1e3 + (double)time.tv_nsec * 1e-6;
}

static void timeouts_are_kept(void) {
    pnb_job *job = NULL;
    CHECK_RESULT(start(MANY_SAMPLES, &job), PNB_OK);
    double before = milliseconds();
    CHECK_RESULT(pnb_job_wait(job, 50, NULL), PNB_TIMEOUT);
    CHECK(milliseconds() - before >= 50);
    pnb_job_destroy(&job);
}

static void jobs_outlive_their_context(void) {
    pnb_context *closing = NULL;
    pnb_job *done = NULL, *running = NULL, *queued = NULL;
    pnb_image image = PNB_INIT(pnb_image);
    pnb_settings settings = small.settings;
    CHECK_RESULT(create_context(NULL, &closing), PNB_OK);
    CHECK_RESULT(pnb_render(closing, small_scene_get(&small), &settings, &done), PNB_OK);
    settings.samples = MANY_SAMPLES;
    CHECK_RESULT(pnb_render_start(closing, small_scene_get(&small), &settings, &running), PNB_OK);
    CHECK_RESULT(pnb_render_start(closing, small_scene_get(&small), &settings, &queued), PNB_OK);
    wait_until_running(running);
    pnb_context_destroy(&closing);
    CHECK_RESULT(pnb_job_wait(running, 0, NULL), PNB_ERROR_CANCELLED);
    CHECK_RESULT(pnb_job_wait(queued, 0, NULL), PNB_ERROR_CANCELLED);
    CHECK_RESULT(pnb_job_get_image(done, 0, &image), PNB_OK);
    CHECK(isfinite(image.pixels[64 * 48 - 1]));
    pnb_job_destroy(&done);
    pnb_job_destroy(&running);
    pnb_job_destroy(&queued);
}

/* The mesh, the arrays and the strings may go as soon as pnb_render_start returns. */
static void scenes_are_copied(void) {
    struct small_scene own;
    pnb_job *job = NULL;
    CHECK_RESULT(small_scene_create(&own), PNB_OK);
    CHECK_RESULT(pnb_render_start(context, small_scene_get(&own), &own.settings, &job), PNB_OK);
    small_scene_destroy(&own);
    memset(&own, 0xff, sizeof own);
    CHECK_RESULT(pnb_job_wait(job, UINT32_MAX, NULL), PNB_OK);
    pnb_job_destroy(&job);
}

static void warnings_name_objects_and_are_logged(void) {
    struct log_record log;
    pnb_context *logged = NULL;
    pnb_job *job = NULL;
    struct small_scene broken;
    CHECK_RESULT(small_scene_create(&broken), PNB_OK);
    const pnb_scene *scene = small_scene_get(&broken);
    broken.instance.name = "Broken instance";
    broken.instance.matrix[5] = NAN;
    CHECK_RESULT(create_logged(NULL, PNB_LOG_WARNING, &log, &logged), PNB_OK);
    CHECK_RESULT(pnb_render(logged, scene, &broken.settings, &job), PNB_OK);
    CHECK(pnb_job_message_count(job) >= 1);
    CHECK_CONTAINS(pnb_job_message(job, 0), "Broken instance");
    CHECK_INT(log.count[PNB_LOG_WARNING], pnb_job_message_count(job));
    CHECK_CONTAINS(log.text, "Broken instance");
    pnb_job_destroy(&job);
    pnb_context_destroy(&logged);
    small_scene_destroy(&broken);
}

static pnb_job *waited_for;
static pnb_result wait_result, render_result;
static pnb_context *logging;

/* Calls back into the library from the thread that renders, which must neither hang nor crash. */
static void call_from_log(void *user, pnb_log_level level, const char *message) {
    (void)user;
    (void)level;
    (void)message;
    if (logging) {
        pnb_job *job = NULL;
        wait_result = pnb_job_wait(waited_for, UINT32_MAX, NULL);
        render_result = pnb_render(logging, small_scene_get(&small), &small.settings, &job);
        pnb_context_destroy(&logging);
    }
}

static void log_functions_cannot_hang(void) {
    pnb_context_desc desc = PNB_INIT(pnb_context_desc);
    desc.log = call_from_log;
    desc.log_level = PNB_LOG_WARNING;
    pnb_context *owned = NULL;
    struct small_scene broken;
    CHECK_RESULT(small_scene_create(&broken), PNB_OK);
    const pnb_scene *scene = small_scene_get(&broken);
    broken.instance.matrix[5] = NAN;
    CHECK_RESULT(pnb_context_create(&desc, &owned), PNB_OK);
    logging = owned;
    CHECK_RESULT(pnb_render_start(owned, scene, &broken.settings, &waited_for), PNB_OK);
    CHECK_RESULT(pnb_job_wait(waited_for, UINT32_MAX, NULL), PNB_OK);
    CHECK_RESULT(wait_result, PNB_TIMEOUT);
    CHECK_RESULT(render_result, PNB_TIMEOUT);
    CHECK(logging == owned);
    logging = NULL;
    pnb_job_destroy(&waited_for);
    pnb_context_destroy(&owned);
    small_scene_destroy(&broken);
}

/* Warnings are logged when the render is done and its job is not yet. */
static void cancel_from_log(void *user, pnb_log_level level, const char *message) {
    (void)level;
    (void)message;
    pnb_job_cancel(*(pnb_job **)user);
}

static void cancelling_counts_until_the_end(void) {
    pnb_job *first = NULL, *job = NULL;
    pnb_context *logged = NULL;
    pnb_context_desc desc = PNB_INIT(pnb_context_desc);
    desc.log = cancel_from_log;
    desc.log_level = PNB_LOG_WARNING;
    desc.log_user = &job;
    struct small_scene broken;
    pnb_settings many = small.settings;
    many.samples = MANY_SAMPLES;
    CHECK_RESULT(small_scene_create(&broken), PNB_OK);
    const pnb_scene *scene = small_scene_get(&broken);
    broken.instance.matrix[5] = NAN;
    CHECK_RESULT(pnb_context_create(&desc, &logged), PNB_OK);
    /* Holds the thread until `job` is written. */
    CHECK_RESULT(pnb_render_start(logged, small_scene_get(&small), &many, &first), PNB_OK);
    CHECK_RESULT(pnb_render_start(logged, scene, &broken.settings, &job), PNB_OK);
    pnb_job_destroy(&first);
    CHECK_RESULT(pnb_job_wait(job, UINT32_MAX, NULL), PNB_ERROR_CANCELLED);
    CHECK_INT(pnb_job_image_count(job), 0);
    pnb_job_destroy(&job);
    pnb_context_destroy(&logged);
    small_scene_destroy(&broken);
}

int main(void) {
    if (create_context(NULL, &context) != PNB_OK) {
        printf("skipped: %s\n", pnb_last_error());
        return CHECK_SKIPPED;
    }
    CHECK_RESULT(small_scene_create(&small), PNB_OK);
    images_come_out();
    results_check_their_arguments();
    bad_renders_are_refused();
    progress_never_falls();
    progressive_jobs_show_their_samples();
    progress_is_kept_in_range();
    timings_of_one_name_are_added();
    running_jobs_are_cancelled();
    queued_jobs_are_cancelled_at_once();
    done_jobs_cannot_be_cancelled();
    jobs_run_in_order();
    timeouts_are_kept();
    jobs_outlive_their_context();
    scenes_are_copied();
    warnings_name_objects_and_are_logged();
    log_functions_cannot_hang();
    cancelling_counts_until_the_end();
    pnb_context_destroy(&context);
    small_scene_destroy(&small);
    CHECK_INT(memory_live_blocks(), 0);
    return check_report();
}
