/* SPDX-License-Identifier: GPL-3.0-or-later */
/* decimal.h -- fast conversion of decimal text to the nearest double. */
#ifndef FL_BASE_DECIMAL_H
#define FL_BASE_DECIMAL_H
#include <stdint.h>

/* Reads the number at the start of s,
 *     [+|-] digits [. digits] [e|E [+|-] digits],
 * with at least one digit before or after the point; no blanks, inf, nan or 0x.  Any character that does not
 * continue the number ends it.
 *   x   out: the double nearest to the decimal, ties to even; the same bits as strtod() in the C locale.
 *       Overflow gives +-INFINITY, underflow +-0.
 * Returns the first character after the number, or NULL if there is none (x is then untouched).
 *
 * With w the first 19 digits and q the exponent of ten, w 10^q = (w 5^q) 2^q is formed from w and the leading
 * 128 bits of 5^q.  The product is known to 128 bits with an error below two units in the last place.  These
 * bits decide unless a halfway point between two doubles lies within the error.  The remaining cases (about
 * one text in 2^73, exact ties with q < 0, subnormal numbers) use strtod().
 * Source: the idea of D. Lemire and M. Eisel, Software: Practice and Experience 51 (2021) 1700. */
const char *fl_decimal_read(const char *s, double *x);

/* The inverse, for x = m 2^e > 0 with m < 2^53: whole part and fraction of x 10^q,
 *     x 10^q = whole + (fraction + d) / 2^64,   0 <= d < 2.
 * Returns 0 if q lies outside -300 .. 308 or the whole part is not between 2^50 and 2^62; 2 if d is certainly
 * 0; else 1. */
int fl_decimal_scaled(uint64_t m, int e, int q, uint64_t *whole, uint64_t *fraction);

/* *x = the double nearest to w 10^q, w > 0.  Returns 1, or 0 if 128 bits do not decide. */
int fl_decimal_nearest(uint64_t w, int q, double *x);

#endif
