/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "thread.h"

#include <fenv.h>
#include <signal.h>
#include <stdatomic.h>
#include <string.h>

/* llvmpipe compiles shaders on the thread that draws, and LLVM needs more than a small `ulimit -s` gives by default. */
#define STACK_SIZE ((size_t)16 << 20)

static pthread_mutex_t opening = PTHREAD_MUTEX_INITIALIZER;
static pthread_once_t fork_handler_once = PTHREAD_ONCE_INIT;
static int fork_handler_error;
static atomic_bool forked;
static _Thread_local bool is_gl_thread;

static void mark_child(void) {
    atomic_store(&forked, true);
}

static void install_fork_handler(void) {
    fork_handler_error = pthread_atfork(NULL, NULL, mark_child);
}

bool process_is_forked(void) {
    return atomic_load(&forked);
}

pnb_result process_check_fork(void) {
    if (process_is_forked()) {
        return error_set(PNB_ERROR_FORKED, "OpenGL was opened before this process was forked and cannot be used in it; "
                                           "start the process afresh (spawn, or fork and exec)");
    }
    return PNB_OK;
}

void gl_thread_lock(void) {
    pthread_mutex_lock(&opening);
}

void gl_thread_unlock(void) {
    pthread_mutex_unlock(&opening);
}

bool gl_thread_is_current(void) {
    return is_gl_thread;
}

/* Every signal the host may handle on its own threads; those that a fault raises stay with the faulting thread. */
static void fill_host_signals(sigset_t *signals) {
    static const int faults[] = {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGTRAP, SIGSYS};
    sigfillset(signals);
    for (size_t i = 0; i < sizeof faults / sizeof faults[0]; ++i) {
        sigdelset(signals, faults[i]);
    }
}

pnb_result gl_thread_start(pthread_t *thread, void *(*run)(void *user), void *user) {
    pthread_once(&fork_handler_once, install_fork_handler);
    int error = fork_handler_error;
    if (error == 0) {
        pthread_attr_t attributes;
        sigset_t blocked, before;
        fill_host_signals(&blocked);
        pthread_attr_init(&attributes);
        pthread_attr_setstacksize(&attributes, STACK_SIZE);
        pthread_sigmask(SIG_BLOCK, &blocked, &before); /* inherited by the thread and by the driver's threads */
        error = pthread_create(thread, &attributes, run, user);
        pthread_sigmask(SIG_SETMASK, &before, NULL);
        pthread_attr_destroy(&attributes);
    }
    if (error != 0) {
        return error_set(PNB_ERROR_OUT_OF_MEMORY, "cannot start the OpenGL thread: %s", strerror(error));
    }
    return PNB_OK;
}

void gl_thread_begin(void) {
    is_gl_thread = true;
    pthread_setname_np(pthread_self(), "penumbra-gl");
    fesetenv(FE_DFL_ENV);
}
