/* SPDX-License-Identifier: GPL-3.0-or-later */
/* exact_sum.h -- sums of doubles and of their powers without rounding.
 *
 * The result does not depend on the order of the terms: parts of a record, and parts of parts, may be added
 * in any order and give the same bits.
 *
 * A double is an integer of 53 bits times a power of two; a product of doubles is one with more bits.  A sum
 * stores all bits as 64-bit words, from the lowest to the highest bit ever added, positive and negative
 * terms apart.  Terms of similar size need only a few words. */
#ifndef FL_STAT_EXACT_SUM_H
#define FL_STAT_EXACT_SUM_H
#include <stdint.h>
#include <stdio.h>
#include "base/err.h"

/* sum = (word[0 .. n) - word[n .. 2 n)) 2^(64 lo); n = 0 for an empty sum.  Holds up to 2^63 terms. */
typedef struct {
    uint64_t *word;
    int32_t lo, n;
} fl_exact_sum;

/* Add a finite number.  0, or -1 with FL_SYSTEM in err. */
int fl_exact_add(fl_exact_sum *s, double x, fl_err *err);

/* Add s[0] += w, s[1] += w x, ... s[4] += w x^4, each exactly.
 *   w   finite, >= 0;  x finite.  |x| and w below 2^334, which bounds the number of words.
 * 0, or -1 with FL_SYSTEM in err. */
int fl_exact_add_powers(fl_exact_sum s[5], double w, double x, fl_err *err);

/* s += t.  0, or -1 with FL_SYSTEM in err. */
int fl_exact_merge(fl_exact_sum *s, const fl_exact_sum *t, fl_err *err);

/* The double nearest to the sum (subnormal results to one unit); 0 for an empty sum, +-INFINITY beyond the
 * largest double.  Cannot fail, as fl_exact_moments(): without memory for a few kilobytes GMP ends the
 * program. */
double fl_exact_value(const fl_exact_sum *s);

/* Print and read the sum as a hexadecimal constant of C, [-]0xHEXp[-]EXPONENT, an odd integer times a power
 * of two, or 0.  Equal sums print equally.  Reading adds to s: 0, or -1 with FL_INPUT in err (not a constant
 * of this form, or beyond the digits and exponents of a sum; one clause, without file and line) or
 * FL_SYSTEM. */
void fl_exact_print(FILE *f, const fl_exact_sum *s);
int fl_exact_read(fl_exact_sum *s, const char *text, fl_err *err);

/* Moments of values that last for times w, from s[k] = sum w x^k:
 *     mean = s1/s0,  std^2 = s2/s0 - mean^2,  skew = m3 / std^3,  kurtosis = m4 / std^4 - 3
 * Each central moment is formed as one exact fraction, so nothing cancels: a std of 1 on a mean of 10^15 is
 * exact to the last digit.
 *   out   mean, std, skew, kurtosis; the last two NAN when std = 0, all of them when s0 = 0 */
void fl_exact_moments(const fl_exact_sum s[5], double out[4]);

/* Accepts a zeroed struct and leaves one. */
void fl_exact_free(fl_exact_sum *s);

#endif
