/* SPDX-License-Identifier: GPL-3.0-or-later
 * One render: what the host asked for, how far it is, what came out. Made by a host thread, worked on by the
 * context's OpenGL thread, read by host threads. */
#ifndef PNB_JOB_H
#define PNB_JOB_H

#include "../messages.h"
#include "../scene/scene.h"
#include "settings.h"

#include <stdatomic.h>
#include <stdbool.h>

enum job_state { JOB_QUEUED, JOB_RUNNING, JOB_DONE };

struct job_image {
    char *name;
    uint32_t channels;
    float *pixels;
    float *published; /* what a host may copy while the job runs, guarded by the job's lock; NULL: nothing yet */
};

struct job_timing {
    char name[64];
    uint32_t count;
    double gpu_ms, cpu_ms;
    uint64_t bytes;
};

struct pnb_job {
    /* Set before the job is queued, constant afterwards. */
    struct scene *scene;
    struct settings settings;
    struct messages messages;

    /* Guarded by `lock`; `finished` is signalled when state becomes DONE. */
    pthread_mutex_t lock;
    pthread_cond_t finished;
    enum job_state state;
    pnb_result result;
    char error[ERROR_TEXT_SIZE];
    pnb_progress progress;
    uint32_t published_samples; /* that the images' `published` are the mean of */
    uint32_t references;  /* the host's handle and the queue's */

    atomic_bool cancelled;

    /* Written by the OpenGL thread while RUNNING, readable when DONE. */
    struct job_image *images;
    uint32_t image_count;
    struct job_timing *timings;
    uint32_t timing_count;

    struct pnb_job *next; /* in the context's queue, guarded by its lock */
};

/* For the renderer, on the OpenGL thread. */
static inline bool job_is_cancelled(struct pnb_job *job) {
    return atomic_load_explicit(&job->cancelled, memory_order_relaxed);
}
/* fraction 0..1; text is copied. */
void job_set_progress(struct pnb_job *job, float fraction, uint32_t sample, const char *text);
/* Adds an image of the settings' crop size and returns its pixels, or NULL (out of memory, error set). */
float *job_add_image(struct pnb_job *job, const char *name, uint32_t channels);
/* Lets the host copy the images as they are now, the mean of so many samples. */
pnb_result job_publish(struct pnb_job *job, uint32_t samples);
/* Adds to the times of that name; bytes are what the pass owns, so the largest counts. */
pnb_result job_add_timing(struct pnb_job *job, const char *name, double gpu_ms, double cpu_ms, uint64_t bytes);

/* INVALID_ARGUMENT or FORKED; a forked child's copy of a job may be locked for ever. */
pnb_result job_check(const struct pnb_job *job);
/* Takes the lock. */
bool job_is_done(const struct pnb_job *job);
size_t job_image_floats(const struct pnb_job *job, const struct job_image *image);

/* For the context. A job that is cancelled while queued is DONE at once; job_begin is then false. */
bool job_begin(struct pnb_job *job);
/* Ends the job, if it is not DONE, with the thread's last error, or CANCELLED if that was asked for; and gives back the
 * queue's reference at the same moment, so that a host that destroys the job then knows its memory is free. */
void job_finish(struct pnb_job *job, pnb_result result);

#endif
