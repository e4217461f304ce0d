/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "../gl/backend.h"
#include "passes.h"

pnb_result check_cancel(struct frame *frame) {
    frame->gl->Finish();
    return job_is_cancelled(frame->job) ? error_set(PNB_ERROR_CANCELLED, "the render was cancelled") : PNB_OK;
}

pnb_result pass_begin(struct frame *frame, const char *name) {
    const bool interactive = frame->settings->flags & PNB_SETTINGS_PROGRESSIVE;
    pnb_result result = interactive ? check_cancel(frame) : PNB_OK;
    if (result == PNB_OK)
        result = backend_check_address_space(ADDRESS_SPACE_TO_COMPILE); /* llvmpipe compiles when it draws */
    return result == PNB_OK ? timer_begin(&frame->renderer->timer, name) : result;
}

void pass_end(struct frame *frame, uint64_t bytes) {
    timer_end(&frame->renderer->timer, bytes);
}
