/* SPDX-License-Identifier: GPL-3.0-or-later
 * Threads of the library that own an OpenGL context. Host threads never have one of ours current. */
#ifndef PNB_GL_THREAD_H
#define PNB_GL_THREAD_H

#include "../error.h"

#include <pthread.h>
#include <stdbool.h>

/* Starts a joinable thread that takes no signals of the host and has room for a shader compiler on its stack. */
pnb_result gl_thread_start(pthread_t *thread, void *(*run)(void *user), void *user);
/* To be called first on that thread: names it and undoes what it inherited of the host's floating-point modes. */
void gl_thread_begin(void);
/* Whether the caller is such a thread, where waiting for a render would wait for itself. */
bool gl_thread_is_current(void);

/* Held while OpenGL is opened or closed: drivers have races there. */
void gl_thread_lock(void);
void gl_thread_unlock(void);

/* Whether this process was forked from one that had started such a thread. OpenGL drivers have threads of their own,
 * which a child does not inherit: it would wait for them for ever. */
bool process_is_forked(void);
/* PNB_ERROR_FORKED, with a message, if it was. */
pnb_result process_check_fork(void);

#endif
