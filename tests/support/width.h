/* SPDX-License-Identifier: GPL-3.0-or-later */
/* width.h -- common part of prop_width and prop_avx2: the same bits for any vector width.  Functions that
 * are compiled for several widths (base/simd.h) are selected when a program is loaded, by __cpu_model.
 * Here __cpu_model is defined anew, for a machine that has FEATURES, nothing or AVX2; prop_bits, beside
 * this program, uses those of the machine.  On other machines than x86-64 both are the same. */
#ifndef FL_TESTS_WIDTH_H
#define FL_TESTS_WIDTH_H
#include <stdio.h>
#include <string.h>
#include "support/bits.h"
#include "support/near.h"

#ifndef FEATURES
#define FEATURES 0 /* bits of __cpu_model */
#endif

#if defined(__x86_64__) && defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__) &&                           \
    !defined(__SANITIZE_THREAD__)
#include <cpuid.h>
struct processor {
    unsigned vendor, type, subtype, features[1];
};
extern struct processor __cpu_model;
struct processor __cpu_model = {1, 0, 0, {FEATURES}}; /* initialised, so that the machine is not queried */
extern unsigned __cpu_features2[4];
unsigned __cpu_features2[4];
int __cpu_indicator_init(void);
int __cpu_indicator_init(void) { return 0; }

/* Features that the selected wide functions need. */
static int machine_has(void)
{
    unsigned a, b, c, d;
    return FEATURES == 0 || (__get_cpuid_count(7, 0, &a, &b, &c, &d) && (b & bit_AVX2));
}

/* The comparison would be empty if the program selected other functions all the same. */
static int selected_as_declared(void)
{
    return (__builtin_cpu_supports("avx2") != 0) == (FEATURES != 0) && !__builtin_cpu_supports("avx512f");
}
#else
static int machine_has(void) { return 1; }
static int selected_as_declared(void) { return 1; }
#endif

static char other[700]; /* prop_bits */

static void bits_equal_those_of_the_machine(void **state)
{
    char mine[BITS_TEXT], got[BITS_TEXT] = "";
    (void)state;
    if (!machine_has()) skip();
    FILE *f = popen(other, "r");
    assert_non_null(f);
    got[fread(got, 1, sizeof got - 1, f)] = '\0';
    assert_int_equal(pclose(f), 0);
    bits_of_scenes(mine);
    assert_null(strstr(mine, "failed"));
    assert_string_equal(mine, got);
}

static void width_is_as_declared(void **state)
{
    (void)state;
    assert_true(selected_as_declared());
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(width_is_as_declared),
                                       cmocka_unit_test(bits_equal_those_of_the_machine)};
    const char *slash = argc > 0 ? strrchr(argv[0], '/') : NULL;
    snprintf(other, sizeof other, "'%.*sprop_bits' --bits", slash ? (int)(slash - argv[0]) + 1 : 0, argv[0]);
    return cmocka_run_group_tests_name("width", tests, NULL, NULL);
}

#endif
