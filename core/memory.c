/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "memory.h"

#include "error.h"

#include <stdatomic.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>

static atomic_int_fast64_t live_blocks;
static atomic_uint_fast64_t allocations_until_failure;

uint64_t memory_fail_at(uint64_t n) {
    return atomic_exchange(&allocations_until_failure, n);
}

int64_t memory_live_blocks(void) {
    return atomic_load(&live_blocks);
}

/* Counts down for one allocation; true if it is the one that shall fail. */
static bool must_fail(void) {
    uint_fast64_t left = atomic_load_explicit(&allocations_until_failure, memory_order_relaxed);
    while (left != 0) {
        if (atomic_compare_exchange_weak(&allocations_until_failure, &left, left - 1)) {
            return left == 1;
        }
    }
    return false;
}

/* malloc, calloc and realloc may return NULL for size 0, which would look like a failure. */
static size_t at_least_one(size_t size) {
    return size ? size : 1;
}

/* Large blocks come in huge pages where the system has them: a page fault for every 4 KiB takes longer than writing an
 * image there. */
#define HUGE_PAGE   ((size_t)2 << 20)
#define LARGE_BLOCK (2 * HUGE_PAGE)

static void *zeroed_block(size_t bytes) {
#ifdef MADV_HUGEPAGE
    void *block;
    if (bytes >= LARGE_BLOCK) {
        if (posix_memalign(&block, HUGE_PAGE, bytes) != 0)
            return NULL;
        madvise(block, bytes, MADV_HUGEPAGE); /* advice: without it the block is as good */
        return memset(block, 0, bytes);
    }
#endif
    return calloc(at_least_one(bytes), 1);
}

void *memory_array(size_t count, size_t size) {
    size_t bytes;
    bool fails = __builtin_mul_overflow(count, size, &bytes) || must_fail();
    void *block = fails ? NULL : zeroed_block(bytes);
    if (!block) {
        error_set(PNB_ERROR_OUT_OF_MEMORY, "out of memory: %zu x %zu bytes", count, size);
        return NULL;
    }
    atomic_fetch_add(&live_blocks, 1);
    return block;
}

void *memory_resize(void *block, size_t count, size_t size) {
    size_t bytes;
    bool fails = __builtin_mul_overflow(count, size, &bytes) || must_fail();
    void *resized = fails ? NULL : realloc(block, at_least_one(bytes));
    if (!resized) {
        error_set(PNB_ERROR_OUT_OF_MEMORY, "out of memory: %zu x %zu bytes", count, size);
        return NULL;
    }
    if (!block) {
        atomic_fetch_add(&live_blocks, 1);
    }
    return resized;
}

char *memory_string(const char *text, const char *fallback) {
    const char *from = text ? text : fallback;
    size_t size = strlen(from) + 1;
    char *copy = memory_array(size, 1);
    if (copy) {
        memcpy(copy, from, size);
    }
    return copy;
}

void memory_free(void *block) {
    if (block) {
        atomic_fetch_sub(&live_blocks, 1);
        free(block);
    }
}
