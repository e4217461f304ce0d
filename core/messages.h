/* SPDX-License-Identifier: GPL-3.0-or-later
 * Warnings about the host's data, collected while a scene is checked and rendered. */
#ifndef PNB_MESSAGES_H
#define PNB_MESSAGES_H

#include "error.h"

#include <pthread.h>

struct messages {
    pthread_mutex_t lock;
    char **texts;
    uint32_t count, capacity;
};

void messages_init(struct messages *messages);
void messages_free(struct messages *messages);
/* Adds a warning unless the same text is there. Out of memory drops it silently: a lost warning must not fail a
 * render. At most 1000 are kept. */
void messages_add(struct messages *messages, const char *format, ...) PNB_PRINTF(2, 3);

#endif
