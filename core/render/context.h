/* SPDX-License-Identifier: GPL-3.0-or-later
 * What a job needs of its context. Callable on any thread. */
#ifndef PNB_CONTEXT_H
#define PNB_CONTEXT_H

#include "job.h"

/* Whether the context can take jobs: INVALID_ARGUMENT for NULL, FORKED, CONTEXT_LOST. */
pnb_result context_check(const pnb_context *context);
uint32_t context_max_texture_size(const pnb_context *context);
/* Queues the job; the queue takes over one reference. */
void context_queue(pnb_context *context, struct pnb_job *job);
/* Passes a message to the host, if it wants messages of this level. */
void context_log(pnb_context *context, pnb_log_level level, const char *format, ...) PNB_PRINTF(3, 4);

#endif
