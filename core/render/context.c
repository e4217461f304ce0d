/* SPDX-License-Identifier: GPL-3.0-or-later
 * A context is one thread that owns OpenGL and works through a queue of jobs. */
#include "context.h"

#include "../gl/backend.h"
#include "../gl/thread.h"
#include "../memory.h"
#include "renderer.h"

#include <string.h>

struct pnb_context {
    /* Constant once the context is created. */
    pthread_t thread;
    struct backend_choice choice;
    pnb_context_info info;
    pnb_log_level log_level;
    pnb_log_function log;
    void *log_user;

    pthread_mutex_t log_lock; /* one message at a time */
    atomic_bool lost;

    /* Guarded by `lock`; `changed` is signalled when any of it changes. */
    pthread_mutex_t lock;
    pthread_cond_t changed;
    struct pnb_job *first, *last; /* the queue */
    struct pnb_job *running;
    bool closing;
    bool opened; /* or failed to: open_result says which */
    pnb_result open_result;
    char open_error[ERROR_TEXT_SIZE];

    /* Of the OpenGL thread alone. */
    struct backend backend;
    struct renderer *renderer;
    PFNGLGETGRAPHICSRESETSTATUSPROC get_reset_status; /* NULL before OpenGL 4.5 */
};

void context_log(pnb_context *context, pnb_log_level level, const char *format, ...) {
    if (!context->log || level > context->log_level) {
        return;
    }
    char text[ERROR_TEXT_SIZE];
    va_list arguments;
    va_start(arguments, format);
    text_format_list(text, sizeof text, format, arguments);
    va_end(arguments);
    text_make_line(text);
    pthread_mutex_lock(&context->log_lock);
    context->log(context->log_user, level, text);
    pthread_mutex_unlock(&context->log_lock);
}

/* ---- Opening and closing, on the OpenGL thread ------------------------------------------------------------- */

static void APIENTRY log_debug_message(GLenum source, GLenum type, GLuint id, GLenum severity, GLsizei length,
                                       const GLchar *message, const void *user) {
    (void)source;
    (void)type;
    (void)id;
    (void)severity;
    (void)length;
    context_log((pnb_context *)user, PNB_LOG_DEBUG, "OpenGL: %s", message);
}

static void copy_gl_string(const struct gl *gl, GLenum name, char *to, size_t size) {
    const char *text = (const char *)gl->GetString(name);
    text_format(to, size, "%s", text ? text : "");
}

static void fill_info(const struct backend *backend, pnb_context_info *info) {
    const struct gl *gl = &backend->gl;
    GLint major = 0, minor = 0;
    gl->GetIntegerv(GL_MAJOR_VERSION, &major);
    gl->GetIntegerv(GL_MINOR_VERSION, &minor);
    *info = (pnb_context_info){.struct_size = sizeof *info,
                               .is_software = backend->gl.is_software,
                               .gl_major = (uint32_t)major,
                               .gl_minor = (uint32_t)minor,
                               .max_texture_size = (uint32_t)gl->max_texture_size};
    text_format(info->backend, sizeof info->backend, "%s", backend->name);
    copy_gl_string(gl, GL_VENDOR, info->vendor, sizeof info->vendor);
    copy_gl_string(gl, GL_RENDERER, info->renderer, sizeof info->renderer);
    copy_gl_string(gl, GL_VERSION, info->version, sizeof info->version);
    copy_gl_string(gl, GL_SHADING_LANGUAGE_VERSION, info->shading_language, sizeof info->shading_language);
}

static void report_backend(pnb_context *context, const struct backend_report *report) {
    const pnb_context_info *info = &context->info;
    context_log(context, PNB_LOG_INFO, "OpenGL %s by %s: %s", info->version, info->backend, info->renderer);
    if (info->is_software && report->hardware_failed) {
        context_log(context, PNB_LOG_WARNING, "rendering on the CPU, because a graphics device failed: %s",
                    report->failures);
    }
}

static void close_gl(pnb_context *context) {
    context->backend.gl.Disable(GL_DEBUG_OUTPUT); /* no call of the host while others may wait for the lock */
    gl_thread_lock();
    renderer_destroy(&context->renderer);
    backend_close(&context->backend);
    gl_thread_unlock();
}

static pnb_result open_gl(pnb_context *context) {
    struct backend *backend = &context->backend;
    struct context_options options = {.debug = context->log && context->log_level >= PNB_LOG_DEBUG};
    struct backend_report report;
    gl_thread_lock();
    pnb_result result = backend_open(&context->choice, &options, backend, &report);
    gl_thread_unlock();
    if (result != PNB_OK) {
        return result;
    }
    fill_info(backend, &context->info);
    report_backend(context, &report);
    if (context->info.gl_major > 4 || context->info.gl_minor >= 5) {
        context->get_reset_status =
            (PFNGLGETGRAPHICSRESETSTATUSPROC)backend->lookup(backend->state, "glGetGraphicsResetStatus");
    }
    if (options.debug) {
        backend->gl.Enable(GL_DEBUG_OUTPUT);
        backend->gl.Enable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
        backend->gl.DebugMessageCallback(log_debug_message, context);
    }
    result = renderer_create(&backend->gl, &context->renderer);
    if (result != PNB_OK) {
        close_gl(context);
    }
    return result;
}

static void publish_open(pnb_context *context, pnb_result result) {
    pthread_mutex_lock(&context->lock);
    context->opened = true;
    context->open_result = result;
    text_format(context->open_error, sizeof context->open_error, "%s", pnb_last_error());
    pthread_cond_broadcast(&context->changed);
    pthread_mutex_unlock(&context->lock);
}

/* ---- Jobs, on the OpenGL thread ---------------------------------------------------------------------------- */

static pnb_result run(pnb_context *context, struct pnb_job *job) {
    if (atomic_load(&context->lost)) {
        return error_set(PNB_ERROR_CONTEXT_LOST, "the OpenGL context was lost in an earlier render");
    }
    pnb_result result = renderer_run(context->renderer, job);
    if (context->get_reset_status && context->get_reset_status() != GL_NO_ERROR) {
        result = error_set(PNB_ERROR_CONTEXT_LOST, "the graphics device was reset");
    }
    if (result == PNB_ERROR_CONTEXT_LOST) {
        atomic_store(&context->lost, true);
    }
    return result;
}

static pnb_result run_and_log(pnb_context *context, struct pnb_job *job) {
    pnb_result result = run(context, job);
    char error[ERROR_TEXT_SIZE]; /* what the host does in its log function must not replace it */
    text_format(error, sizeof error, "%s", pnb_last_error());
    for (uint32_t i = 0; i < pnb_job_message_count(job); ++i) {
        context_log(context, PNB_LOG_WARNING, "%s", pnb_job_message(job, i));
    }
    if (result != PNB_OK && !job_is_cancelled(job)) {
        context_log(context, PNB_LOG_ERROR, "%s", error);
        error_set(result, "%s", error);
    }
    return result;
}

/* The next job, or NULL when the context closes and its queue is empty. */
static struct pnb_job *next_job(pnb_context *context) {
    pthread_mutex_lock(&context->lock);
    while (!context->first && !context->closing) {
        pthread_cond_wait(&context->changed, &context->lock);
    }
    struct pnb_job *job = context->first;
    if (job) {
        context->first = job->next;
        context->last = context->first ? context->last : NULL;
    }
    context->running = job;
    pthread_mutex_unlock(&context->lock);
    return job;
}

static void forget_running(pnb_context *context) {
    pthread_mutex_lock(&context->lock);
    context->running = NULL;
    pthread_mutex_unlock(&context->lock);
}

static void *gl_thread(void *user) {
    pnb_context *context = user;
    gl_thread_begin();
    pnb_result result = open_gl(context);
    publish_open(context, result);
    if (result != PNB_OK) {
        return NULL;
    }
    for (struct pnb_job *job = next_job(context); job; job = next_job(context)) {
        result = job_begin(job) ? run_and_log(context, job) : PNB_ERROR_CANCELLED;
        forget_running(context);
        job_finish(job, result);
    }
    close_gl(context);
    return NULL;
}

/* ---- The host ---------------------------------------------------------------------------------------------- */

static void context_free(pnb_context *context) {
    pthread_cond_destroy(&context->changed);
    pthread_mutex_destroy(&context->lock);
    pthread_mutex_destroy(&context->log_lock);
    memory_free(context);
}

static pnb_result start_thread(pnb_context *context) {
    pnb_result result = gl_thread_start(&context->thread, gl_thread, context);
    if (result != PNB_OK) {
        return result;
    }
    pthread_mutex_lock(&context->lock);
    while (!context->opened) {
        pthread_cond_wait(&context->changed, &context->lock);
    }
    pthread_mutex_unlock(&context->lock);
    if (context->open_result != PNB_OK) {
        pthread_join(context->thread, NULL);
        context_log(context, PNB_LOG_ERROR, "%s", context->open_error);
        return error_set(context->open_result, "%s", context->open_error);
    }
    return PNB_OK;
}

static pnb_result check_create(const pnb_context_desc *desc, pnb_context **context) {
    pnb_result result = process_check_fork();
    if (result == PNB_OK && !context) {
        result = error_set(PNB_ERROR_INVALID_ARGUMENT, "pnb_context_create: context is NULL");
    }
    return result == PNB_OK && desc ? CHECK_STRUCT(desc, pnb_context_desc) : result;
}

pnb_result pnb_context_create(const pnb_context_desc *desc, pnb_context **context) {
    struct backend_choice choice;
    pnb_result result = check_create(desc, context);
    if (result == PNB_OK) {
        result = backend_choose(desc ? desc->backend : NULL, &choice);
    }
    if (result != PNB_OK) {
        return result;
    }
    pnb_context *created = memory_array(1, sizeof *created);
    if (!created) {
        return PNB_ERROR_OUT_OF_MEMORY;
    }
    created->choice = choice;
    if (desc) {
        created->log_level = desc->log_level;
        created->log = desc->log;
        created->log_user = desc->log_user;
    }
    pthread_mutex_init(&created->log_lock, NULL);
    pthread_mutex_init(&created->lock, NULL);
    pthread_cond_init(&created->changed, NULL);
    result = start_thread(created);
    if (result != PNB_OK) {
        context_free(created);
        return result;
    }
    *context = created;
    return PNB_OK;
}

/* With the context's lock held. */
static void cancel_all(pnb_context *context) {
    if (context->running) {
        pnb_job_cancel(context->running);
    }
    for (struct pnb_job *job = context->first; job; job = job->next) {
        pnb_job_cancel(job);
    }
}

void pnb_context_destroy(pnb_context **context) {
    if (!context || !*context) {
        return;
    }
    pnb_context *closing = *context;
    if (!process_is_forked() && pthread_equal(closing->thread, pthread_self())) {
        error_set(PNB_ERROR_INVALID_ARGUMENT, "a log function must not destroy its context");
        return; /* the thread would wait for its own end */
    }
    *context = NULL;
    if (process_is_forked()) {
        return;
    }
    pthread_mutex_lock(&closing->lock);
    cancel_all(closing);
    closing->closing = true;
    pthread_cond_broadcast(&closing->changed);
    pthread_mutex_unlock(&closing->lock);
    pthread_join(closing->thread, NULL);
    context_free(closing);
}

pnb_result pnb_context_get_info(const pnb_context *context, pnb_context_info *info) {
    pnb_result result = process_check_fork();
    if (result == PNB_OK && !context) {
        result = error_set(PNB_ERROR_INVALID_ARGUMENT, "the context is NULL");
    }
    if (result == PNB_OK) {
        result = CHECK_STRUCT(info, pnb_context_info);
    }
    if (result == PNB_OK) {
        *info = context->info;
    }
    return result;
}

pnb_result context_check(const pnb_context *context) {
    pnb_result result = process_check_fork();
    if (result == PNB_OK && !context) {
        result = error_set(PNB_ERROR_INVALID_ARGUMENT, "the context is NULL");
    }
    if (result == PNB_OK && atomic_load(&context->lost)) {
        result = error_set(PNB_ERROR_CONTEXT_LOST, "the OpenGL context was lost; create a new one");
    }
    return result;
}

uint32_t context_max_texture_size(const pnb_context *context) {
    return context->info.max_texture_size;
}

void context_queue(pnb_context *context, struct pnb_job *job) {
    pthread_mutex_lock(&context->lock);
    if (context->last) {
        context->last->next = job;
    } else {
        context->first = job;
    }
    context->last = job;
    pthread_cond_broadcast(&context->changed);
    pthread_mutex_unlock(&context->lock);
}
