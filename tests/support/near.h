/* SPDX-License-Identifier: GPL-3.0-or-later */
/* near.h -- what unit and property tests start with: cmocka, comparison of doubles, the seed. */
#ifndef FL_TESTS_NEAR_H
#define FL_TESTS_NEAR_H
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

/* Fail the test, with both numbers, unless |value - expected| <= tol |expected|.  An expected value of 0 so
 * asks for 0 itself: where the sum of cancelling terms is wanted, assert_near_of() takes their size. */
#define assert_near(value, expected, tol)                                                                    \
    near_check((value), (expected), (tol), -1.0, #value, __FILE__, __LINE__)

/* The same with |value - expected| <= tol |scale|; scale is a length, force ... of the problem. */
#define assert_near_of(value, expected, tol, scale)                                                          \
    near_check((value), (expected), (tol), (scale), #value, __FILE__, __LINE__)

/* Behind the two above: scale < 0 stands for |expected|.  A nan or an infinity is never near. */
void near_check(double value, double expected, double tol, double scale, const char *what, const char *file,
                int line);

/* Seed of every random test: 1, or what the environment variable FLOE_SEED says.  A property test prints it
 * together with the number of the case that failed: print_error("seed %llu case %d\n", ...). */
uint64_t test_seed(void);

/* How many cases to try: n, times the number in the environment variable FLOE_TIMES for long runs; never
 * less than one. */
long test_times(long n);

/* A path for a scratch file of this process, in TMPDIR or /tmp: "<tmp>/floe-<pid>-<name>".  The text is
 * borrowed and good until the fourth call after this one. */
const char *test_path(const char *name);

/* Write n bytes to test_path(name) and return that path; the test is failed where that cannot be done. */
const char *test_file(const char *name, const void *data, size_t n);

#endif
