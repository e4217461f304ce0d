/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "error.h"
#include "memory.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdint.h>
#include <string.h>

#define THREADS     8
#define ALLOCATIONS 1000

static void arrays_are_zero(void **state) {
    (void)state;
    unsigned char *block = memory_array(1000, 3);
    assert_non_null(block);
    for (size_t i = 0; i < 3000; ++i) {
        assert_int_equal(block[i], 0);
    }
    memory_free(block);
}

static void empty_arrays_are_blocks(void **state) {
    (void)state;
    void *none = memory_array(0, 16), *no_size = memory_array(16, 0);
    assert_non_null(none);
    assert_non_null(no_size);
    none = memory_resize(none, 0, 4);
    assert_non_null(none);
    memory_free(none);
    memory_free(no_size);
    memory_free(NULL);
}

static void products_that_overflow_fail(void **state) {
    (void)state;
    error_set(PNB_ERROR_FILE, "before");
    assert_null(memory_array(SIZE_MAX / 2, 3));
    assert_non_null(strstr(pnb_last_error(), "out of memory"));
    assert_null(memory_array(SIZE_MAX, 1));
    int *block = memory_array(4, sizeof *block);
    block[3] = 42;
    assert_null(memory_resize(block, SIZE_MAX / 2, 3));
    assert_int_equal(block[3], 42);
    memory_free(block);
}

static void resizing_keeps_content(void **state) {
    (void)state;
    int *block = memory_resize(NULL, 2, sizeof *block);
    block[0] = 1;
    block[1] = 2;
    block = memory_resize(block, 10000, sizeof *block);
    assert_int_equal(block[0], 1);
    assert_int_equal(block[1], 2);
    memory_free(block);
}

static void strings_are_copied(void **state) {
    (void)state;
    char text[] = "lamp";
    char *copy = memory_string(text, "light"), *fallback = memory_string(NULL, "light");
    text[0] = 'd';
    assert_string_equal(copy, "lamp");
    assert_string_equal(fallback, "light");
    memory_free(copy);
    memory_free(fallback);
}

static void live_blocks_are_counted(void **state) {
    (void)state;
    int64_t before = memory_live_blocks();
    void *first = memory_array(1, 1), *second = memory_resize(NULL, 1, 1);
    char *third = memory_string("x", "");
    assert_int_equal(memory_live_blocks(), before + 3);
    second = memory_resize(second, 100, 1);
    assert_int_equal(memory_live_blocks(), before + 3);
    memory_free(first);
    memory_free(second);
    memory_free(third);
    assert_int_equal(memory_live_blocks(), before);
}

static void only_the_nth_fails(void **state) {
    (void)state;
    int64_t before = memory_live_blocks();
    memory_fail_at(3);
    void *blocks[4];
    blocks[0] = memory_array(1, 1);
    blocks[1] = memory_resize(NULL, 1, 1);
    blocks[2] = memory_array(1, 1);
    blocks[3] = memory_array(1, 1);
    assert_non_null(blocks[0]);
    assert_non_null(blocks[1]);
    assert_null(blocks[2]);
    assert_non_null(blocks[3]);
    for (size_t i = 0; i < 4; ++i) {
        memory_free(blocks[i]);
    }
    assert_int_equal(memory_fail_at(2), 0);
    assert_int_equal(memory_fail_at(0), 2);
    void *block = memory_array(1, 1);
    assert_non_null(block);
    memory_free(block);
    assert_int_equal(memory_live_blocks(), before);
}

static void *allocate_often(void *failures) {
    for (int i = 0; i < ALLOCATIONS; ++i) {
        void *block = memory_array(1, 16);
        if (!block) {
            atomic_fetch_add((atomic_int *)failures, 1);
        }
        memory_free(block);
    }
    return NULL;
}

static void one_fails_among_threads(void **state) {
    (void)state;
    int64_t before = memory_live_blocks();
    atomic_int failures = 0;
    pthread_t threads[THREADS];
    memory_fail_at(THREADS * ALLOCATIONS / 2);
    for (int i = 0; i < THREADS; ++i) {
        pthread_create(&threads[i], NULL, allocate_often, &failures);
    }
    for (int i = 0; i < THREADS; ++i) {
        pthread_join(threads[i], NULL);
    }
    assert_int_equal(failures, 1);
    assert_int_equal(memory_live_blocks(), before);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(arrays_are_zero),
        cmocka_unit_test(empty_arrays_are_blocks),
        cmocka_unit_test(products_that_overflow_fail),
        cmocka_unit_test(resizing_keeps_content),
        cmocka_unit_test(strings_are_copied),
        cmocka_unit_test(live_blocks_are_counted),
        cmocka_unit_test(only_the_nth_fails),
        cmocka_unit_test(one_fails_among_threads),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
