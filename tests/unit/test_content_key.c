/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "scene/content_key.h"

#include <stdint.h>
#include <string.h>

static struct content_key key_of(const void *data, size_t size) {
    struct content_key key = {{0}};
    content_key_add(&key, data, size);
    return key;
}

static void any_bit_changes_the_key(void **state) {
    (void)state;
    unsigned char data[131];
    for (size_t size = 1; size <= sizeof data; size += 13) {
        memset(data, 0, sizeof data);
        struct content_key before = key_of(data, size);
        for (size_t bit = 0; bit < 8 * size; bit++) {
            data[bit / 8] ^= (unsigned char)(1u << bit % 8);
            struct content_key after = key_of(data, size);
            data[bit / 8] ^= (unsigned char)(1u << bit % 8);
            for (int word = 0; word < 2; word++) {
                /* Of 64 unbiased bits, fewer than 8 or more than 56 change once in 1e9 flips or less. */
                int changed = __builtin_popcountll(before.words[word] ^ after.words[word]);
                assert_in_range(changed, 8, 56);
            }
        }
    }
}

/* All pairs of flipped bits: changes that follow each other must not cancel. */
static void any_two_bits_change_the_key(void **state) {
    (void)state;
    unsigned char data[72] = {0};
    struct content_key before = key_of(data, sizeof data);
    for (size_t a = 0; a < 8 * sizeof data; a++) {
        data[a / 8] ^= (unsigned char)(1u << a % 8);
        for (size_t b = a + 1; b < 8 * sizeof data; b++) {
            data[b / 8] ^= (unsigned char)(1u << b % 8);
            struct content_key after = key_of(data, sizeof data);
            assert_true(before.words[0] != after.words[0] && before.words[1] != after.words[1]);
            data[b / 8] ^= (unsigned char)(1u << b % 8);
        }
        data[a / 8] ^= (unsigned char)(1u << a % 8);
    }
}

/* A high bit of a lane's word spreads least; no two bits of the lane's next word undo what it does. */
static void high_bits_do_not_cancel(void **state) {
    (void)state;
    for (size_t lane = 0; lane < 4; lane++) {
        uint64_t words[8] = {0};
        struct content_key before = key_of(words, sizeof words);
        words[lane] = (uint64_t)1 << 63;
        for (size_t a = 0; a < 64; a++) {
            for (size_t b = a + 1; b < 64; b++) {
                words[lane + 4] = (uint64_t)1 << a | (uint64_t)1 << b;
                struct content_key after = key_of(words, sizeof words);
                assert_true(before.words[0] != after.words[0] && before.words[1] != after.words[1]);
            }
        }
    }
}

static void order_and_length_change_the_key(void **state) {
    (void)state;
    unsigned char data[256];
    for (size_t i = 0; i < sizeof data; i++) {
        data[i] = (unsigned char)i;
    }
    struct content_key before = key_of(data, sizeof data);
    for (size_t step = 4; step <= 64; step *= 2) { /* words, lanes and blocks */
        for (size_t at = 0; at + 2 * step <= sizeof data; at += step) {
            unsigned char swapped[sizeof data];
            memcpy(swapped, data, sizeof data);
            memcpy(swapped + at, data + at + step, step);
            memcpy(swapped + at + step, data + at, step);
            struct content_key after = key_of(swapped, sizeof swapped);
            assert_false(content_key_equal(&before, &after));
        }
    }
    unsigned char zeros[100] = {0};
    for (size_t size = 0; size < sizeof zeros; size++) {
        struct content_key shorter = key_of(zeros, size), longer = key_of(zeros, size + 1);
        assert_true(shorter.words[0] != longer.words[0] && shorter.words[1] != longer.words[1]);
    }
    struct content_key split = {{0}}, whole = key_of(data, 64);
    content_key_add(&split, data, 32);
    content_key_add(&split, data + 32, 32);
    assert_false(content_key_equal(&split, &whole)); /* borders count */
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(any_bit_changes_the_key),
        cmocka_unit_test(any_two_bits_change_the_key),
        cmocka_unit_test(high_bits_do_not_cancel),
        cmocka_unit_test(order_and_length_change_the_key),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
