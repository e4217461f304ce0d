/* SPDX-License-Identifier: GPL-3.0-or-later
 * Times the passes of a job with OpenGL timer queries and the clock. */
#ifndef PNB_TIMER_H
#define PNB_TIMER_H

#include "../gl/gl.h"

struct pnb_job;

struct timer_span {
    const char *name; /* static */
    GLuint query;
    double cpu_ms;
    uint64_t bytes;
};

struct timer {
    const struct gl *gl;
    struct timer_span *spans;
    uint32_t count, capacity; /* queries are kept from job to job */
    double started;
};

void timer_init(struct timer *timer, const struct gl *gl);
void timer_free(struct timer *timer);
/* Spans do not nest. bytes: of the textures and buffers the pass owns. */
pnb_result timer_begin(struct timer *timer, const char *name);
void timer_end(struct timer *timer, uint64_t bytes);
/* Adds all spans to the job, by name, and forgets them. Waits for OpenGL. */
pnb_result timer_collect(struct timer *timer, struct pnb_job *job);

#endif
