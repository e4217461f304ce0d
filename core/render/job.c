/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "job.h"

#include "../gl/thread.h"
#include "../memory.h"
#include "context.h"

#include <errno.h>
#include <string.h>
#include <time.h>

/* ---- Life ------------------------------------------------------------------------------------------------- */

static struct pnb_job *job_create(void) {
    struct pnb_job *job = memory_array(1, sizeof *job);
    if (!job) {
        return NULL;
    }
    pthread_condattr_t attributes;
    pthread_condattr_init(&attributes);
    pthread_condattr_setclock(&attributes, CLOCK_MONOTONIC);
    pthread_cond_init(&job->finished, &attributes);
    pthread_condattr_destroy(&attributes);
    pthread_mutex_init(&job->lock, NULL);
    messages_init(&job->messages);
    job->references = 1;
    text_format(job->progress.text, sizeof job->progress.text, "Waiting");
    return job;
}

static void drop_images(struct pnb_job *job) {
    for (uint32_t i = 0; i < job->image_count; ++i) {
        memory_free(job->images[i].name);
        memory_free(job->images[i].pixels);
        memory_free(job->images[i].published);
    }
    memory_free(job->images);
    job->images = NULL;
    job->image_count = 0;
    job->published_samples = 0;
}

static void job_free(struct pnb_job *job) {
    drop_images(job);
    memory_free(job->timings);
    scene_destroy(&job->scene);
    messages_free(&job->messages);
    pthread_cond_destroy(&job->finished);
    pthread_mutex_destroy(&job->lock);
    memory_free(job);
}

/* Gives back one reference and unlocks the job, which must be locked. */
static void release_locked(struct pnb_job *job) {
    uint32_t left = --job->references;
    pthread_mutex_unlock(&job->lock);
    if (left == 0) {
        job_free(job);
    }
}

static void release(struct pnb_job *job) {
    pthread_mutex_lock(&job->lock);
    release_locked(job);
}

bool job_is_done(const struct pnb_job *job) {
    pthread_mutex_t *lock = &((struct pnb_job *)job)->lock; /* reading a job does not change it for its owner */
    pthread_mutex_lock(lock);
    bool done = job->state == JOB_DONE;
    pthread_mutex_unlock(lock);
    return done;
}

pnb_result job_check(const struct pnb_job *job) {
    return job ? process_check_fork() : error_set(PNB_ERROR_INVALID_ARGUMENT, "the job is NULL");
}

size_t job_image_floats(const struct pnb_job *job, const struct job_image *image) {
    return (size_t)job->settings.crop[2] * job->settings.crop[3] * image->channels;
}

/* With the job's lock held. */
static void end(struct pnb_job *job, pnb_result result, const char *error) {
    job->state = JOB_DONE;
    job->result = result;
    text_format(job->error, sizeof job->error, "%s", error);
    pthread_cond_broadcast(&job->finished);
}

/* ---- The OpenGL thread ------------------------------------------------------------------------------------ */

bool job_begin(struct pnb_job *job) {
    pthread_mutex_lock(&job->lock);
    bool begins = job->state == JOB_QUEUED;
    if (begins) {
        job->state = JOB_RUNNING;
    }
    pthread_mutex_unlock(&job->lock);
    return begins;
}

/* With the job's lock held. */
static void finish_locked(struct pnb_job *job, pnb_result result) {
    if (job_is_cancelled(job)) {
        result = error_set(PNB_ERROR_CANCELLED, "the render was cancelled");
    }
    if (result == PNB_OK) {
        job->progress.fraction = 1.0f;
        job->progress.sample = job->progress.samples;
        text_format(job->progress.text, sizeof job->progress.text, "Finished");
    } else {
        drop_images(job);
    }
    end(job, result, result == PNB_OK ? "" : pnb_last_error());
}

void job_finish(struct pnb_job *job, pnb_result result) {
    pthread_mutex_lock(&job->lock);
    if (job->state != JOB_DONE) {
        finish_locked(job, result);
    }
    release_locked(job);
}

void job_set_progress(struct pnb_job *job, float fraction, uint32_t sample, const char *text) {
    pthread_mutex_lock(&job->lock);
    pnb_progress *progress = &job->progress;
    if (fraction > progress->fraction) {
        progress->fraction = fraction < 1.0f ? fraction : 1.0f;
    }
    if (sample > progress->sample) {
        progress->sample = sample < progress->samples ? sample : progress->samples;
    }
    text_format(progress->text, sizeof progress->text, "%s", text);
    pthread_mutex_unlock(&job->lock);
}

float *job_add_image(struct pnb_job *job, const char *name, uint32_t channels) {
    size_t pixel_count = (size_t)job->settings.crop[2] * job->settings.crop[3];
    struct job_image *images = memory_resize(job->images, job->image_count + 1, sizeof *images);
    if (!images) {
        return NULL;
    }
    job->images = images;
    struct job_image image = {.name = memory_string(name, ""), .channels = channels};
    image.pixels = image.name ? memory_array(pixel_count, channels * sizeof *image.pixels) : NULL;
    if (!image.pixels) {
        memory_free(image.name);
        return NULL;
    }
    images[job->image_count++] = image;
    return image.pixels;
}

static pnb_result publish_image(const struct pnb_job *job, struct job_image *image) {
    const size_t count = job_image_floats(job, image);
    if (!image->published)
        image->published = memory_array(count, sizeof *image->published);
    if (!image->published)
        return PNB_ERROR_OUT_OF_MEMORY;
    memcpy(image->published, image->pixels, count * sizeof *image->published);
    return PNB_OK;
}

pnb_result job_publish(struct pnb_job *job, uint32_t samples) {
    pnb_result result = PNB_OK;
    pthread_mutex_lock(&job->lock);
    for (uint32_t i = 0; i < job->image_count && result == PNB_OK; ++i)
        result = publish_image(job, &job->images[i]);
    job->published_samples = result == PNB_OK ? samples : 0;
    pthread_mutex_unlock(&job->lock);
    return result;
}

static struct job_timing *find_timing(struct pnb_job *job, const char *name) {
    for (uint32_t i = 0; i < job->timing_count; ++i) {
        if (strcmp(job->timings[i].name, name) == 0) {
            return &job->timings[i];
        }
    }
    struct job_timing *timings = memory_resize(job->timings, job->timing_count + 1, sizeof *timings);
    if (!timings) {
        return NULL;
    }
    job->timings = timings;
    struct job_timing *timing = &timings[job->timing_count++];
    *timing = (struct job_timing){0};
    text_format(timing->name, sizeof timing->name, "%s", name);
    return timing;
}

pnb_result job_add_timing(struct pnb_job *job, const char *name, double gpu_ms, double cpu_ms, uint64_t bytes) {
    struct job_timing *timing = find_timing(job, name);
    if (!timing) {
        return PNB_ERROR_OUT_OF_MEMORY;
    }
    timing->count += 1;
    timing->gpu_ms += gpu_ms;
    timing->cpu_ms += cpu_ms;
    timing->bytes = bytes > timing->bytes ? bytes : timing->bytes;
    return PNB_OK;
}

/* ---- The host --------------------------------------------------------------------------------------------- */

static pnb_result start(pnb_context *context, const pnb_scene *scene, const pnb_settings *settings,
                        pnb_job **result_job) {
    struct pnb_job *job = job_create();
    if (!job) {
        return PNB_ERROR_OUT_OF_MEMORY;
    }
    pnb_result result = settings_resolve(settings, context_max_texture_size(context), &job->messages, &job->settings);
    if (result == PNB_OK) {
        result = scene_create(scene, &job->messages, &job->scene);
    }
    if (result == PNB_OK) {
        result = settings_check_lights(job->scene, context_max_texture_size(context));
    }
    if (result == PNB_OK) {
        scene_camera_fit(&job->scene->camera, job->settings.width, job->settings.height);
    }
    if (result != PNB_OK) {
        release(job);
        return result;
    }
    job->progress.samples = job->settings.samples;
    job->references += 1;
    context_queue(context, job);
    *result_job = job;
    return PNB_OK;
}

pnb_result pnb_render_start(pnb_context *context, const pnb_scene *scene, const pnb_settings *settings, pnb_job **job) {
    pnb_result result = context_check(context);
    if (result != PNB_OK) {
        return result;
    }
    if (!job) {
        return error_set(PNB_ERROR_INVALID_ARGUMENT, "pnb_render_start: job is NULL");
    }
    result = start(context, scene, settings, job);
    if (result != PNB_OK) {
        context_log(context, PNB_LOG_ERROR, "%s", pnb_last_error());
    }
    return result;
}

static struct timespec deadline_after(uint32_t milliseconds) {
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    time.tv_sec += milliseconds / 1000;
    time.tv_nsec += (long)(milliseconds % 1000) * 1000000;
    if (time.tv_nsec >= 1000000000) {
        time.tv_sec += 1;
        time.tv_nsec -= 1000000000;
    }
    return time;
}

/* Waits with the job's lock held; false when the time is over. */
static bool wait_until_done(struct pnb_job *job, uint32_t timeout_ms) {
    struct timespec deadline = deadline_after(timeout_ms);
    int error = 0;
    while (job->state != JOB_DONE && error != ETIMEDOUT) {
        error = timeout_ms == UINT32_MAX ? pthread_cond_wait(&job->finished, &job->lock)
                                         : pthread_cond_timedwait(&job->finished, &job->lock, &deadline);
    }
    return job->state == JOB_DONE;
}

pnb_result pnb_job_wait(pnb_job *job, uint32_t timeout_ms, pnb_progress *progress) {
    pnb_result result = job_check(job);
    if (result == PNB_OK && progress) {
        result = CHECK_STRUCT(progress, pnb_progress);
    }
    if (result != PNB_OK) {
        return result;
    }
    pthread_mutex_lock(&job->lock);
    /* A log function may call this on the OpenGL thread, which would wait for itself. */
    bool done = wait_until_done(job, gl_thread_is_current() ? 0 : timeout_ms);
    result = !done ? PNB_TIMEOUT : job->result == PNB_OK ? PNB_OK : error_set(job->result, "%s", job->error);
    if (progress && result >= PNB_OK) {
        *progress = job->progress;
        progress->struct_size = sizeof *progress;
    }
    pthread_mutex_unlock(&job->lock);
    return result;
}

void pnb_job_cancel(pnb_job *job) {
    if (job_check(job) != PNB_OK) {
        return;
    }
    pthread_mutex_lock(&job->lock);
    if (job->state != JOB_DONE) {
        atomic_store(&job->cancelled, true);
    }
    if (job->state == JOB_QUEUED) {
        end(job, PNB_ERROR_CANCELLED, "the render was cancelled before it began");
    }
    pthread_mutex_unlock(&job->lock);
}

void pnb_job_destroy(pnb_job **job) {
    if (!job || !*job) {
        return;
    }
    if (!process_is_forked()) {
        pnb_job_cancel(*job);
        (void)pnb_job_wait(*job, UINT32_MAX, NULL);
        release(*job);
    }
    *job = NULL;
}

pnb_result pnb_render(pnb_context *context, const pnb_scene *scene, const pnb_settings *settings, pnb_job **job) {
    if (!job) {
        return error_set(PNB_ERROR_INVALID_ARGUMENT, "pnb_render: job is NULL");
    }
    pnb_job *started;
    pnb_result result = pnb_render_start(context, scene, settings, &started);
    if (result != PNB_OK) {
        return result;
    }
    result = pnb_job_wait(started, UINT32_MAX, NULL);
    if (result == PNB_OK) {
        *job = started;
    } else {
        pnb_job_destroy(&started);
    }
    return result;
}
