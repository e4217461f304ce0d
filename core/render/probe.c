/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tries every backend, on a thread of its own so that the caller's OpenGL is not touched. */
#include "../gl/backend.h"
#include "../gl/thread.h"

#include <string.h>

struct probe {
    pnb_backend_attempt *attempts;
    uint32_t capacity, count;
};

static void probe_candidate(const struct candidate *candidate, pnb_backend_attempt *attempt) {
    static const struct context_options options = {.debug = false};
    struct backend backend;
    *attempt = (pnb_backend_attempt){.struct_size = sizeof *attempt};
    text_format(attempt->backend, sizeof attempt->backend, "%s", candidate->name);
    attempt->result = backend_try(candidate, &options, &backend);
    if (attempt->result != PNB_OK) {
        text_format(attempt->message, sizeof attempt->message, "%s", pnb_last_error());
        return;
    }
    const struct gl *gl = &backend.gl;
    text_format(attempt->renderer, sizeof attempt->renderer, "%s", (const char *)gl->GetString(GL_RENDERER));
    text_format(attempt->version, sizeof attempt->version, "%s", (const char *)gl->GetString(GL_VERSION));
    backend_close(&backend);
}

static void *probe_thread(void *user) {
    static const struct backend_choice all = {.devices = true, .surfaceless = true, .osmesa = true, .device = -1};
    struct probe *probe = user;
    struct ladder ladder;
    gl_thread_begin();
    gl_thread_lock();
    ladder_list(&all, &ladder);
    for (uint32_t i = 0; i < ladder.count && i < probe->capacity; ++i) {
        probe_candidate(&ladder.candidates[i], &probe->attempts[i]);
    }
    gl_thread_unlock();
    probe->count = ladder.count;
    return NULL;
}

static pnb_result check_attempts(const pnb_backend_attempt *attempts, uint32_t capacity, const uint32_t *count) {
    if (!count || (!attempts && capacity > 0)) {
        return error_set(PNB_ERROR_INVALID_ARGUMENT, "pnb_probe_backends: %s is NULL", count ? "attempts" : "count");
    }
    for (uint32_t i = 0; i < capacity; ++i) {
        pnb_result result = CHECK_STRUCT(&attempts[i], pnb_backend_attempt);
        if (result != PNB_OK) {
            return result;
        }
    }
    return PNB_OK;
}

pnb_result pnb_probe_backends(pnb_backend_attempt *attempts, uint32_t capacity, uint32_t *count) {
    pnb_result result = process_check_fork();
    if (result == PNB_OK) {
        result = check_attempts(attempts, capacity, count);
    }
    if (result == PNB_OK) {
        result = backend_check_address_space(ADDRESS_SPACE_TO_START);
    }
    struct probe probe = {.attempts = attempts, .capacity = capacity};
    pthread_t thread;
    if (result == PNB_OK) {
        result = gl_thread_start(&thread, probe_thread, &probe);
    }
    if (result == PNB_OK) {
        pthread_join(thread, NULL);
        *count = probe.count;
    }
    return result;
}
