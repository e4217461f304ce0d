/* SPDX-License-Identifier: GPL-3.0-or-later
 * The calling thread's last error, and allocation that can fail on demand. */
#ifndef PNB_ERROR_H
#define PNB_ERROR_H

#include "penumbra.h"

#include <stdarg.h>

#define PNB_PRINTF(text, arguments) __attribute__((format(printf, text, arguments)))

/* Longest error or log message, with its terminator. */
#define ERROR_TEXT_SIZE 1024

/* Records why a call fails and returns `result`, so that a function can `return error_set(...)`. */
pnb_result error_set(pnb_result result, const char *format, ...) PNB_PRINTF(2, 3);

/* As snprintf and vsnprintf into `to`, but a text that is cut ends with a whole UTF-8 character. */
void text_format(char *to, size_t size, const char *format, ...) PNB_PRINTF(3, 4);
void text_format_list(char *to, size_t size, const char *format, va_list arguments) PNB_PRINTF(3, 0);
/* Puts spaces where control characters such as newlines are. */
void text_make_line(char *text);

/* pnb_result of a NULL or wrongly sized structure, naming it; PNB_OK if it is good. */
pnb_result error_check_struct(const char *name, const void *structure, size_t size);
#define CHECK_STRUCT(pointer, type) error_check_struct(#type, pointer, sizeof(type))

#endif
