/* SPDX-License-Identifier: GPL-3.0-or-later
 * What a host reads of a job: images, times, messages. */
#include "job.h"

#include "../gl/thread.h"

#include <string.h>

static bool is_readable(const pnb_job *job) {
    return job && !process_is_forked() && job_is_done(job);
}

static pnb_result check_readable(const pnb_job *job, const char *what, uint32_t index, uint32_t count) {
    pnb_result result = job_check(job);
    if (result == PNB_OK && !job_is_done(job)) {
        result =
            error_set(PNB_ERROR_INVALID_ARGUMENT, "the job is not finished: wait for it before reading a %s", what);
    }
    if (result == PNB_OK && index >= count) {
        result = error_set(PNB_ERROR_INVALID_ARGUMENT, "%s %u does not exist, the job has %u", what, index, count);
    }
    return result;
}

uint32_t pnb_job_image_count(const pnb_job *job) {
    return is_readable(job) ? job->image_count : 0;
}

pnb_result pnb_job_get_image(const pnb_job *job, uint32_t index, pnb_image *image) {
    pnb_result result = CHECK_STRUCT(image, pnb_image);
    if (result == PNB_OK) {
        result = check_readable(job, "image", index, pnb_job_image_count(job));
    }
    if (result != PNB_OK) {
        return result;
    }
    const struct job_image *from = &job->images[index];
    *image = (pnb_image){.struct_size = sizeof *image,
                         .width = job->settings.crop[2],
                         .height = job->settings.crop[3],
                         .channels = from->channels,
                         .name = from->name,
                         .pixels = from->pixels};
    return PNB_OK;
}

/* With the job's lock held. */
static pnb_result copy_image(const pnb_job *job, uint32_t index, float *pixels, uint64_t capacity, uint32_t *samples) {
    const bool done = job->state == JOB_DONE;
    if (done && job->result != PNB_OK)
        return error_set(job->result, "%s", job->error);
    if (!done && job->published_samples == 0)
        return PNB_TIMEOUT;
    if (index >= job->image_count)
        return error_set(PNB_ERROR_INVALID_ARGUMENT, "image %u does not exist, the job has %u", index,
                         job->image_count);
    const struct job_image *image = &job->images[index];
    const size_t count = job_image_floats(job, image);
    if (pixels && capacity < count)
        return error_set(PNB_ERROR_INVALID_ARGUMENT, "image '%s' has %zu floats, there is room for %llu", image->name,
                         count, (unsigned long long)capacity);
    if (pixels)
        memcpy(pixels, done ? image->pixels : image->published, count * sizeof *pixels);
    if (samples)
        *samples = done ? job->settings.samples : job->published_samples;
    return PNB_OK;
}

pnb_result pnb_job_copy_image(const pnb_job *job, uint32_t index, float *pixels, uint64_t capacity, uint32_t *samples) {
    pnb_result result = job_check(job);
    if (result != PNB_OK)
        return result;
    pthread_mutex_t *lock = &((pnb_job *)job)->lock;
    pthread_mutex_lock(lock);
    result = copy_image(job, index, pixels, capacity, samples);
    pthread_mutex_unlock(lock);
    return result;
}

uint32_t pnb_job_timing_count(const pnb_job *job) {
    return is_readable(job) ? job->timing_count : 0;
}

pnb_result pnb_job_get_timing(const pnb_job *job, uint32_t index, pnb_timing *timing) {
    pnb_result result = CHECK_STRUCT(timing, pnb_timing);
    if (result == PNB_OK) {
        result = check_readable(job, "timing", index, pnb_job_timing_count(job));
    }
    if (result != PNB_OK) {
        return result;
    }
    const struct job_timing *from = &job->timings[index];
    *timing = (pnb_timing){.struct_size = sizeof *timing,
                           .count = from->count,
                           .name = from->name,
                           .gpu_ms = from->gpu_ms,
                           .cpu_ms = from->cpu_ms,
                           .bytes = from->bytes};
    return PNB_OK;
}

uint32_t pnb_job_message_count(const pnb_job *job) {
    if (!job || process_is_forked()) {
        return 0;
    }
    struct messages *messages = &((pnb_job *)job)->messages;
    pthread_mutex_lock(&messages->lock);
    uint32_t count = messages->count;
    pthread_mutex_unlock(&messages->lock);
    return count;
}

const char *pnb_job_message(const pnb_job *job, uint32_t index) {
    if (index >= pnb_job_message_count(job)) {
        return "";
    }
    struct messages *messages = &((pnb_job *)job)->messages;
    pthread_mutex_lock(&messages->lock);
    const char *text = messages->texts[index]; /* the array may move while rendering, its texts do not */
    pthread_mutex_unlock(&messages->lock);
    return text;
}
