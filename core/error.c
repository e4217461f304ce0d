/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "error.h"

#include <stdio.h>
#include <string.h>

static _Thread_local char last_error[ERROR_TEXT_SIZE];

const char *pnb_last_error(void) {
    return last_error;
}

/* Removes the beginning of a UTF-8 character whose end was cut off. */
static void trim_partial_character(char *text) {
    size_t end = strlen(text), start = end;
    while (start > 0 && end - start < 3 && ((unsigned char)text[start - 1] & 0xC0) == 0x80) {
        --start;
    }
    if (start == 0) {
        return;
    }
    unsigned char lead = (unsigned char)text[start - 1];
    size_t following = lead >= 0xF0 ? 3 : lead >= 0xE0 ? 2 : lead >= 0xC0 ? 1 : 0;
    if (end - start < following) {
        text[start - 1] = '\0';
    }
}

void text_format_list(char *to, size_t size, const char *format, va_list arguments) {
    to[0] = '\0';
    int length = vsnprintf(to, size, format, arguments);
    if (length < 0 || (size_t)length >= size) {
        trim_partial_character(to);
    }
}

void text_make_line(char *text) {
    for (; *text; ++text) {
        if ((unsigned char)*text < ' ' || *text == '\x7f') {
            *text = ' ';
        }
    }
}

void text_format(char *to, size_t size, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    text_format_list(to, size, format, arguments);
    va_end(arguments);
}

pnb_result error_set(pnb_result result, const char *format, ...) {
    char text[ERROR_TEXT_SIZE]; /* the arguments may be the last error itself */
    va_list arguments;
    va_start(arguments, format);
    text_format_list(text, sizeof text, format, arguments);
    va_end(arguments);
    memcpy(last_error, text, sizeof text);
    return result;
}

pnb_result error_check_struct(const char *name, const void *structure, size_t size) {
    if (!structure) {
        return error_set(PNB_ERROR_INVALID_ARGUMENT, "%s is NULL", name);
    }
    uint32_t found;
    memcpy(&found, structure, sizeof found);
    if (found != size) {
        return error_set(PNB_ERROR_INVALID_ARGUMENT, "%s.struct_size is %u, this library expects %zu", name, found,
                         size);
    }
    return PNB_OK;
}
