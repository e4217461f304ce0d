/* SPDX-License-Identifier: GPL-3.0-or-later
 * Every host allocation of the library, so that tests can count them and make the n-th one fail. */
#ifndef PNB_MEMORY_H
#define PNB_MEMORY_H

#include <stddef.h>
#include <stdint.h>

/* Zeroed memory of count * size bytes (at least 1); NULL, with PNB_ERROR_OUT_OF_MEMORY as the thread's error, when
 * there is none or the product overflows. */
void *memory_array(size_t count, size_t size);
/* As realloc of an array; the old block stays valid on failure. New elements are not zeroed. */
void *memory_resize(void *block, size_t count, size_t size);
/* Copy of a string; NULL gives a copy of `fallback`. */
char *memory_string(const char *text, const char *fallback);
void memory_free(void *block);

/* Test hooks. The n-th allocation from now fails (1: the next), once; 0: none. Returns the n that was left of the call
 * before, 0 if that one has failed. */
uint64_t memory_fail_at(uint64_t n);
/* Live allocations of the process. */
int64_t memory_live_blocks(void);

#endif
