/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "error.h"

#include <pthread.h>
#include <string.h>

static void *last_error_of_new_thread(void *copy) {
    strcpy(copy, pnb_last_error());
    error_set(PNB_ERROR_FILE, "of the other thread");
    return NULL;
}

static void each_thread_has_its_own(void **state) {
    (void)state;
    char other[ERROR_TEXT_SIZE] = "unset";
    pthread_t thread;
    error_set(PNB_ERROR_FILE, "of this thread");
    pthread_create(&thread, NULL, last_error_of_new_thread, other);
    pthread_join(thread, NULL);
    assert_string_equal(other, "");
    assert_string_equal(pnb_last_error(), "of this thread");
}

static void returns_the_result(void **state) {
    (void)state;
    assert_int_equal(error_set(PNB_ERROR_CANCELLED, "value %d", 7), PNB_ERROR_CANCELLED);
    assert_string_equal(pnb_last_error(), "value 7");
}

static void may_quote_itself(void **state) {
    (void)state;
    error_set(PNB_ERROR_FILE, "inner");
    error_set(PNB_ERROR_FILE, "outer: %s", pnb_last_error());
    assert_string_equal(pnb_last_error(), "outer: inner");
}

static void long_texts_are_cut(void **state) {
    (void)state;
    char text[2 * ERROR_TEXT_SIZE];
    memset(text, 'x', sizeof text - 1);
    text[sizeof text - 1] = '\0';
    error_set(PNB_ERROR_FILE, "%s", text);
    assert_int_equal(strlen(pnb_last_error()), ERROR_TEXT_SIZE - 1);
}

/* Room for 7 bytes: characters of 1 to 4 bytes, ending before, at and after the cut. */
static void cut_between_characters(void **state) {
    (void)state;
    static const char *const rows[][2] = {
        {"abcdefgh", "abcdefg"},
        {"abcdef\xc3\xa9", "abcdef"},                    /* 2 bytes, second cut */
        {"abcde\xc3\xa9z", "abcde\xc3\xa9"},             /* 2 bytes, whole */
        {"abcdef\xe2\x82\xac", "abcdef"},                /* 3 bytes, two cut */
        {"abcde\xe2\x82\xac", "abcde"},                  /* 3 bytes, one cut */
        {"abcd\xe2\x82\xacz", "abcd\xe2\x82\xac"},       /* 3 bytes, whole */
        {"abcd\xf0\x9f\x98\x80", "abcd"},                /* 4 bytes, one cut */
        {"abc\xf0\x9f\x98\x80z", "abc\xf0\x9f\x98\x80"}, /* 4 bytes, whole */
        {"\xc3\xa9", "\xc3\xa9"},                        /* nothing cut */
        {"", ""},
    };
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; ++i) {
        char text[8];
        text_format(text, sizeof text, "%s", rows[i][0]);
        assert_string_equal(text, rows[i][1]);
    }
}

static void names_wrong_structures(void **state) {
    (void)state;
    pnb_camera camera = PNB_INIT(pnb_camera);
    assert_int_equal(CHECK_STRUCT(&camera, pnb_camera), PNB_OK);
    assert_int_equal(CHECK_STRUCT((pnb_camera *)NULL, pnb_camera), PNB_ERROR_INVALID_ARGUMENT);
    assert_string_equal(pnb_last_error(), "pnb_camera is NULL");
    static const uint32_t sizes[] = {0, 1, sizeof(pnb_camera) - 1, sizeof(pnb_camera) + 1, UINT32_MAX};
    for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; ++i) {
        camera.struct_size = sizes[i];
        assert_int_equal(CHECK_STRUCT(&camera, pnb_camera), PNB_ERROR_INVALID_ARGUMENT);
        assert_non_null(strstr(pnb_last_error(), "pnb_camera.struct_size"));
    }
}

static void results_have_names(void **state) {
    (void)state;
    assert_string_equal(pnb_result_name(PNB_OK), "PNB_OK");
    assert_string_equal(pnb_result_name(PNB_TIMEOUT), "PNB_TIMEOUT");
    for (int i = PNB_ERROR_INTERNAL; i < 0; ++i) {
        assert_int_equal(strncmp(pnb_result_name((pnb_result)i), "PNB_ERROR_", 10), 0);
    }
    assert_string_equal(pnb_result_name((pnb_result)-42), "unknown");
    assert_string_equal(pnb_result_name((pnb_result)2), "unknown");
}

static void versions_match_the_header(void **state) {
    (void)state;
    assert_int_equal(pnb_api_version(), PNB_API_VERSION);
    assert_string_equal(pnb_version(), PNB_VERSION);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_thread_has_its_own), cmocka_unit_test(returns_the_result),
        cmocka_unit_test(may_quote_itself),        cmocka_unit_test(long_texts_are_cut),
        cmocka_unit_test(cut_between_characters),  cmocka_unit_test(names_wrong_structures),
        cmocka_unit_test(results_have_names),      cmocka_unit_test(versions_match_the_header),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
