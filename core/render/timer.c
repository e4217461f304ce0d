/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "timer.h"
#include "../memory.h"
#include "job.h"

#include <time.h>

static double clock_ms(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return 1e3 * (double)now.tv_sec + 1e-6 * (double)now.tv_nsec;
}

void timer_init(struct timer *timer, const struct gl *gl) {
    *timer = (struct timer){.gl = gl};
}

void timer_free(struct timer *timer) {
    for (uint32_t i = 0; i < timer->capacity; i++)
        timer->gl->DeleteQueries(1, &timer->spans[i].query);
    memory_free(timer->spans);
    *timer = (struct timer){0};
}

static pnb_result timer_grow(struct timer *timer) {
    const uint32_t capacity = timer->capacity ? 2 * timer->capacity : 64;
    struct timer_span *spans = memory_resize(timer->spans, capacity, sizeof *spans);
    if (!spans)
        return PNB_ERROR_OUT_OF_MEMORY;
    timer->spans = spans;
    for (; timer->capacity < capacity; timer->capacity++)
        timer->gl->GenQueries(1, &spans[timer->capacity].query);
    return PNB_OK;
}

pnb_result timer_begin(struct timer *timer, const char *name) {
    if (timer->count == timer->capacity) {
        pnb_result result = timer_grow(timer);
        if (result != PNB_OK)
            return result;
    }
    timer->spans[timer->count].name = name;
    timer->gl->BeginQuery(GL_TIME_ELAPSED, timer->spans[timer->count].query);
    timer->started = clock_ms();
    return PNB_OK;
}

void timer_end(struct timer *timer, uint64_t bytes) {
    struct timer_span *span = &timer->spans[timer->count++];
    timer->gl->EndQuery(GL_TIME_ELAPSED);
    span->cpu_ms = clock_ms() - timer->started;
    span->bytes = bytes;
}

pnb_result timer_collect(struct timer *timer, struct pnb_job *job) {
    pnb_result result = PNB_OK;
    for (uint32_t i = 0; i < timer->count && result == PNB_OK; i++) {
        const struct timer_span *span = &timer->spans[i];
        GLuint64 nanoseconds = 0;
        timer->gl->GetQueryObjectui64v(span->query, GL_QUERY_RESULT, &nanoseconds);
        result = job_add_timing(job, span->name, 1e-6 * (double)nanoseconds, span->cpu_ms, span->bytes);
    }
    timer->count = 0;
    return result;
}
