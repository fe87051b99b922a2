/* SPDX-License-Identifier: GPL-3.0-or-later */
/* near.h -- common part of unit and property tests: cmocka, comparison of doubles, the seed. */
#ifndef FL_TESTS_NEAR_H
#define FL_TESTS_NEAR_H
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

/* Fails the test, with both numbers, unless |value - expected| <= tol |expected|.  An expected value of 0
 * therefore requires 0 itself; for sums that cancel, assert_near_of() takes the size of their terms. */
#define assert_near(value, expected, tol)                                                                    \
    near_check((value), (expected), (tol), -1.0, #value, __FILE__, __LINE__)

/* The same with |value - expected| <= tol |scale|; scale is a length, force ... of the problem. */
#define assert_near_of(value, expected, tol, scale)                                                          \
    near_check((value), (expected), (tol), (scale), #value, __FILE__, __LINE__)

/* Implementation of the two above: scale < 0 stands for |expected|.  A nan or an infinity is never near. */
void near_check(double value, double expected, double tol, double scale, const char *what, const char *file,
                int line);

/* Seed of every random test: 1, or the environment variable FLOE_SEED.  A property test prints it together
 * with the number of the failed case: print_error("seed %llu case %d\
 * ", ...). */
uint64_t test_seed(void);

/* Number of cases: n times the number in the environment variable FLOE_TIMES, for long runs; at least one. */
long test_times(long n);

/* Path of a scratch file of this process, in TMPDIR or /tmp: "<tmp>/floe-<pid>-<name>".  The text is
 * borrowed and valid until the fourth call after this one. */
const char *test_path(const char *name);

/* Writes n bytes to test_path(name) and returns that path; the test fails if that is not possible. */
const char *test_file(const char *name, const void *data, size_t n);

#endif
