/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The same bits for any width of vectors.  Functions that are compiled for several (base/wide.h) are chosen
 * when a program is loaded, by what __cpu_model tells of the machine.  Here that is defined anew, as of a
 * machine that has nothing; prop_bits, beside this program, has what the machine has.  Elsewhere than on
 * x86-64 both are the same, and so is what is compared. */
#include <stdio.h>
#include <string.h>
#include "support/bits.h"
#include "support/near.h"

#if defined(__x86_64__) && defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__) &&                           \
    !defined(__SANITIZE_THREAD__)
struct processor {
    unsigned vendor, type, subtype, features[1];
};
extern struct processor __cpu_model;
struct processor __cpu_model = {1, 0, 0, {0}}; /* known, so that nobody asks the machine */
extern unsigned __cpu_features2[4];
unsigned __cpu_features2[4];
int __cpu_indicator_init(void);
int __cpu_indicator_init(void) { return 0; }
#endif

static char other[700]; /* prop_bits */

static void plain_is_as_wide(void **state)
{
    char mine[BITS_TEXT], got[BITS_TEXT] = "";
    (void)state;
    FILE *f = popen(other, "r");
    assert_non_null(f);
    got[fread(got, 1, sizeof got - 1, f)] = '\0';
    assert_int_equal(pclose(f), 0);
    bits_of_scenes(mine);
    assert_null(strstr(mine, "failed"));
    assert_string_equal(mine, got);
}

/* Nothing would be compared if the program took the wide functions all the same. */
static int width(void)
{
#if defined(__x86_64__)
    return __builtin_cpu_supports("avx2") ? 4 : 1;
#else
    return 1;
#endif
}

static void this_program_is_plain(void **state)
{
    (void)state;
    assert_int_equal(width(), 1);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(this_program_is_plain),
                                       cmocka_unit_test(plain_is_as_wide)};
    const char *slash = argc > 0 ? strrchr(argv[0], '/') : NULL;
    snprintf(other, sizeof other, "'%.*sprop_bits' --bits", slash ? (int)(slash - argv[0]) + 1 : 0, argv[0]);
    return cmocka_run_group_tests_name("width", tests, NULL, NULL);
}
