/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "memory.h"
#include "messages.h"

#include <string.h>

#define THREADS 8

static void are_kept_in_order_and_once(void **state) {
    (void)state;
    struct messages messages;
    messages_init(&messages);
    messages_add(&messages, "%s: %d bad", "Cube", 1);
    messages_add(&messages, "%s: %d bad", "Lamp", 2);
    messages_add(&messages, "%s: %d bad", "Cube", 1);
    assert_int_equal(messages.count, 2);
    assert_string_equal(messages.texts[0], "Cube: 1 bad");
    assert_string_equal(messages.texts[1], "Lamp: 2 bad");
    messages_free(&messages);
    assert_int_equal(messages.count, 0);
}

/* Hosts print one line per message; names of objects may hold anything. */
static void are_single_lines(void **state) {
    (void)state;
    struct messages messages;
    messages_init(&messages);
    messages_add(&messages, "Box '%s': %d\r\n", "two\nlines\tand a \x1b[31mcolour\x7f", 1);
    assert_string_equal(messages.texts[0], "Box 'two lines and a  [31mcolour ': 1  ");
    messages_free(&messages);
}

static void are_limited_to_1000(void **state) {
    (void)state;
    struct messages messages;
    messages_init(&messages);
    for (int i = 0; i < 1100; ++i) {
        messages_add(&messages, "message %d", i);
    }
    assert_int_equal(messages.count, 1000);
    assert_string_equal(messages.texts[999], "message 999");
    messages_free(&messages);
}

/* Whichever allocation fails, a message is lost and nothing else. */
static void are_dropped_without_memory(void **state) {
    (void)state;
    for (uint64_t n = 1; n <= 4; ++n) {
        struct messages messages;
        messages_init(&messages);
        memory_fail_at(n);
        messages_add(&messages, "first");
        messages_add(&messages, "second");
        messages_add(&messages, "third");
        memory_fail_at(0);
        assert_int_equal(messages.count, 2);
        messages_free(&messages);
    }
}

static void *add_ten(void *messages) {
    for (int i = 0; i < 10; ++i) {
        messages_add(messages, "message %d", i);
    }
    return NULL;
}

static void may_come_from_any_thread(void **state) {
    (void)state;
    struct messages messages;
    pthread_t threads[THREADS];
    messages_init(&messages);
    for (int i = 0; i < THREADS; ++i) {
        pthread_create(&threads[i], NULL, add_ten, &messages);
    }
    for (int i = 0; i < THREADS; ++i) {
        pthread_join(threads[i], NULL);
    }
    assert_int_equal(messages.count, 10);
    messages_free(&messages);
}

static int nothing_is_left(void **state) {
    (void)state;
    return memory_live_blocks() == 0 ? 0 : -1;
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_teardown(are_kept_in_order_and_once, nothing_is_left),
        cmocka_unit_test_teardown(are_single_lines, nothing_is_left),
        cmocka_unit_test_teardown(are_limited_to_1000, nothing_is_left),
        cmocka_unit_test_teardown(are_dropped_without_memory, nothing_is_left),
        cmocka_unit_test_teardown(may_come_from_any_thread, nothing_is_left),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
