/* SPDX-License-Identifier: GPL-3.0-or-later */
/* decimal.h -- from decimal text to the nearest double, at the speed of reading. */
#ifndef FL_BASE_DECIMAL_H
#define FL_BASE_DECIMAL_H
#include <stdint.h>

/* Read the number that s begins with,
 *     [+|-] digits [. digits] [e|E [+|-] digits],
 * at least one digit before or after the point, no blanks, no inf, nan or 0x.  The text may end in any
 * character that does not go on with the number.
 *   x   out: the double nearest to the decimal, ties to even: bit for bit that of strtod() in the C locale.
 *       A number too large is +-INFINITY, one too small +-0.
 * Returns the first character after the number, or NULL when there is none (x is then untouched).
 *
 * With w the first 19 digits and q the exponent of ten that belongs to them, w 10^q = (w 5^q) 2^q is formed
 * from w and the leading 128 bits of 5^q: of the product 128 bits are known up to less than two units of
 * their last place, and unless a halfway point between two doubles lies within these, they decide.  What they
 * leave open (about one text in 2^73, exact ties with q < 0, subnormal numbers) goes to strtod().
 * Source: the idea of D. Lemire and M. Eisel, Software: Practice and Experience 51 (2021) 1700. */
const char *fl_decimal_read(const char *s, double *x);

/* The other way, for x = m 2^e > 0 with m < 2^53: the whole part and the fraction of  x 10^q,
 *     x 10^q = whole + (fraction + d) / 2^64,   0 <= d < 2.
 * Returns 0 when q lies beyond -300 .. 308 or the whole part is not between 2^50 and 2^62; 2 when d is 0 for
 * certain; else 1. */
int fl_decimal_scaled(uint64_t m, int e, int q, uint64_t *whole, uint64_t *fraction);

/* *x = the double nearest to w 10^q, w > 0.  Returns 0 when 128 bits do not decide which it is; else 1. */
int fl_decimal_nearest(uint64_t w, int q, double *x);

#endif
