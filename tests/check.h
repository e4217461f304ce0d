/* SPDX-License-Identifier: GPL-3.0-or-later
 * Checks for test programs that run OpenGL threads, which frameworks that jump or fork do not mix with.
 * A check prints both values when it fails, goes on, and gives whether it passed. Callable on any thread.
 * A program ends with `return check_report();`. */
#ifndef CHECK_H
#define CHECK_H

#include <math.h>
#include <penumbra.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

/* Exit code of a test that cannot run here. */
#define CHECK_SKIPPED 77

static int checks_passed, checks_failed;

__attribute__((format(printf, 4, 5))) static inline bool check_count(bool passed, const char *file, int line,
                                                                     const char *format, ...) {
    __atomic_fetch_add(passed ? &checks_passed : &checks_failed, 1, __ATOMIC_RELAXED);
    if (!passed) {
        char text[2048];
        va_list arguments;
        va_start(arguments, format);
        vsnprintf(text, sizeof text, format, arguments);
        va_end(arguments);
        printf("%s:%d: FAILED: %s\n", file, line, text);
        fflush(stdout);
    }
    return passed;
}

static inline bool check_int(long long actual, long long expected, const char *what, const char *file, int line) {
    return check_count(actual == expected, file, line, "%s is %lld, expected %lld", what, actual, expected);
}

static inline bool check_at_most(double actual, double limit, const char *what, const char *file, int line) {
    return check_count(actual <= limit, file, line, "%s is %.9g, expected at most %.9g", what, actual, limit);
}

static inline bool check_near(double actual, double expected, double tolerance, const char *what, const char *file,
                              int line) {
    return check_count(fabs(actual - expected) <= tolerance, file, line, "%s is %.9g, expected %.9g within %.3g", what,
                       actual, expected, tolerance);
}

static inline bool check_result(pnb_result actual, pnb_result expected, const char *what, const char *file, int line) {
    return check_count(actual == expected, file, line, "%s is %s, expected %s; last error: \"%s\"", what,
                       pnb_result_name(actual), pnb_result_name(expected), pnb_last_error());
}

static inline bool check_string(const char *actual, const char *expected, const char *what, const char *file,
                                int line) {
    return check_count(actual && strcmp(actual, expected) == 0, file, line, "%s is \"%s\", expected \"%s\"", what,
                       actual ? actual : "(null)", expected);
}

static inline bool check_contains(const char *actual, const char *part, const char *what, const char *file, int line) {
    return check_count(actual && strstr(actual, part), file, line, "%s is \"%s\", which lacks \"%s\"", what,
                       actual ? actual : "(null)", part);
}

#define CHECK(condition)                        check_count(condition, __FILE__, __LINE__, "%s", #condition)
#define CHECK_INT(actual, expected)             check_int(actual, expected, #actual, __FILE__, __LINE__)
#define CHECK_AT_MOST(actual, limit)            check_at_most(actual, limit, #actual, __FILE__, __LINE__)
#define CHECK_NEAR(actual, expected, tolerance) check_near(actual, expected, tolerance, #actual, __FILE__, __LINE__)
#define CHECK_RESULT(actual, expected)          check_result(actual, expected, #actual, __FILE__, __LINE__)
#define CHECK_STRING(actual, expected)          check_string(actual, expected, #actual, __FILE__, __LINE__)
#define CHECK_CONTAINS(actual, part)            check_contains(actual, part, #actual, __FILE__, __LINE__)

static inline int check_report(void) {
    printf("%d passed, %d failed\n", checks_passed, checks_failed);
    return checks_failed > 0 ? 1 : 0;
}

#endif
