/* SPDX-License-Identifier: GPL-3.0-or-later */
/* number_text.h -- lossless conversion between numbers and decimal text. */
#ifndef FL_BASE_NUMBER_TEXT_H
#define FL_BASE_NUMBER_TEXT_H
#include <stdint.h>
#include <stdio.h>

enum { FL_NUMBER_LEN = 32 };

/* Shortest decimal text (15, 16 or 17 digits) that reads back to the same double; -0 prints as 0.
 * Writes at most FL_NUMBER_LEN bytes with the closing nul.  Returns buf. */
char *fl_number_text(double x, char buf[FL_NUMBER_LEN]);

/* Read all of s as a finite number (-0 becomes 0), an integer in [lo, hi], or a 64-bit unsigned integer.
 * Return 0, or -1 if s is anything else (empty, trailing text, nan, inf, 0x.., out of range). */
int fl_number_f64(const char *s, double *x);
int fl_number_i32(const char *s, int32_t lo, int32_t hi, int32_t *x);
int fl_number_u64(const char *s, uint64_t *x);

#endif
