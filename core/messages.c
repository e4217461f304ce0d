/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "messages.h"

#include "memory.h"

#include <stdbool.h>
#include <string.h>

#define MAX_MESSAGES 1000u

void messages_init(struct messages *messages) {
    *messages = (struct messages){0};
    pthread_mutex_init(&messages->lock, NULL);
}

void messages_free(struct messages *messages) {
    for (uint32_t i = 0; i < messages->count; ++i) {
        memory_free(messages->texts[i]);
    }
    memory_free(messages->texts);
    pthread_mutex_destroy(&messages->lock);
    *messages = (struct messages){0};
}

static bool is_known(const struct messages *messages, const char *text) {
    for (uint32_t i = 0; i < messages->count; ++i) {
        if (strcmp(messages->texts[i], text) == 0) {
            return true;
        }
    }
    return false;
}

static bool reserve_one(struct messages *messages) {
    if (messages->count < messages->capacity) {
        return true;
    }
    uint32_t capacity = messages->capacity ? 2 * messages->capacity : 8;
    char **texts = memory_resize(messages->texts, capacity, sizeof *texts);
    if (!texts) {
        return false;
    }
    messages->texts = texts;
    messages->capacity = capacity;
    return true;
}

void messages_add(struct messages *messages, const char *format, ...) {
    char text[ERROR_TEXT_SIZE];
    va_list arguments;
    va_start(arguments, format);
    text_format_list(text, sizeof text, format, arguments);
    va_end(arguments);
    text_make_line(text);

    pthread_mutex_lock(&messages->lock);
    if (messages->count < MAX_MESSAGES && !is_known(messages, text) && reserve_one(messages)) {
        char *copy = memory_string(text, "");
        if (copy) {
            messages->texts[messages->count++] = copy;
        }
    }
    pthread_mutex_unlock(&messages->lock);
}
