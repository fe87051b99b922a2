/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/decimal.h"
#include "base/number_text.h"

static int text_reads_as(const char *text, double x)
{
    double y;
    return fl_decimal_read(text, &y) && y == x;
}

/* Formats with the C library: always correct, but slow. */
static char *format_by_library(double x, char *buf)
{
    for (int digits = 15; digits <= 17; digits++) {
        snprintf(buf, FL_NUMBER_LEN, "%.*g", digits, x);
        if (digits == 17 || text_reads_as(buf, x)) break;
    }
    return buf;
}

/* --- decimal digits by integer arithmetic --------------------------------------------------------------- */

enum { MOST_DIGITS = 17 };
static const uint64_t TEN_16 = UINT64_C(10000000000000000);

/* Rounds whole + fraction / 2^64 to the nearest multiple of unit and returns it in units; ties go to even.
 * The true value is exact, or larger by less than 2 units of fraction.  unit is 1, 10 or 100.  Returns 0 when
 * the missing part decides.  Inline, so that unit is a compile-time constant. */
static inline int round_to_unit(uint64_t whole, uint64_t fraction, int exact, uint64_t unit, uint64_t *out)
{
    const uint64_t half = UINT64_C(1) << 63, rest = whole % unit, middle = unit / 2, down = whole / unit;
    const uint64_t missing = exact ? 0 : 2;
    uint64_t up;
    if (unit == 1) {
        up = fraction > half || (exact && fraction == half && (down & 1));
        if (!up && fraction <= half && fraction + missing > half) return 0;
    } else if (rest == middle) {
        if (fraction == 0 && !exact) return 0; /* halfway or just above */
        up = fraction > 0 || (down & 1);
    } else {
        if (rest + 1 == middle && fraction + missing < fraction) return 0; /* just below halfway or not */
        up = rest > middle;
    }
    *out = down + up;
    return 1;
}

static const char PAIR[] =
    "00010203040506070809101112131415161718192021222324252627282930313233343536373839404142434445"
    "46474849505152535455565758596061626364656667686970717273747576777879808182838485868788899091"
    "9293949596979899";

/* Writes the digits of d, two at a time from the last. */
static void write_digits(uint64_t d, int digits, char *to)
{
    while (digits > 1) {
        memcpy(to + (digits -= 2), PAIR + 2 * (d % 100), 2);
        d /= 100;
    }
    if (digits) to[0] = (char)('0' + d);
}

/* Writes d 10^(ten - digits + 1), where d has that many digits, as "%.*g" does. */
static void write_decimal(char *p, int minus, uint64_t d, int digits, int ten)
{
    char digit[MOST_DIGITS + 1];
    int n = digits;
    write_digits(d, digits, digit);
    while (n > 1 && digit[n - 1] == '0') n--;
    if (minus) *p++ = '-';
    if (ten < -4 || ten >= digits) {
        *p++ = digit[0];
        if (n > 1) *p++ = '.';
        for (int k = 1; k < n; k++) *p++ = digit[k];
        *p++ = 'e';
        *p++ = ten < 0 ? '-' : '+';
        if (ten < 0) ten = -ten;
        if (ten >= 100) *p++ = (char)('0' + ten / 100);
        *p++ = (char)('0' + ten / 10 % 10);
        *p++ = (char)('0' + ten % 10);
    } else if (ten < 0) {
        memcpy(p, "0.000", 5);
        p += 1 - ten;
        memcpy(p, digit, (size_t)n);
        p += n;
    } else {
        const int whole = ten + 1; /* trailing zeros stripped above are still in digit[] */
        memcpy(p, digit, (size_t)whole);
        p += whole;
        if (n > whole) {
            *p++ = '.';
            memcpy(p, digit + whole, (size_t)(n - whole));
            p += n - whole;
        }
    }
    *p = '\0';
}

/* Does d, without the last `unit` of whole, read back as x = m 2^e, given as whole and fraction?  It does
 * within half the distance between doubles, whole / 2 m, known here to a few 2^-53 of itself.  Returns 1, 0,
 * or -1 where the margin is too small or where the doubles below x lie closer. */
static inline int digits_read_back(uint64_t d, uint64_t unit, uint64_t whole, uint64_t fraction, uint64_t m)
{
    static const double CLOSE = 1e-9; /* millions of these units */
    const double half = (double)whole / (2.0 * (double)m);
    const double off = fabs((double)(int64_t)(whole - d * unit) + (double)fraction * 0x1p-64);
    if (off > half + CLOSE * (half + 1.0)) return 0;
    return m != UINT64_C(1) << 52 && off < half - CLOSE * (half + 1.0) ? 1 : -1;
}

/* Writes x with the given number of digits if that reads back.  Returns 1, 0 if it does not, -1 if 128 bits
 * do not decide. */
static inline int try_digits(double x, uint64_t whole, uint64_t fraction, int exact, uint64_t m, int ten,
                             int digits, uint64_t unit, char *buf)
{
    uint64_t d;
    double y;
    int how = 1;
    if (!round_to_unit(whole, fraction, exact, unit, &d)) return -1;
    if (digits < MOST_DIGITS) how = digits_read_back(d, unit, whole, fraction, m);
    if (d == 10 * TEN_16 / unit) { /* 9.99... rounded up to 10 */
        d /= 10;
        ten++;
    }
    if (how < 0) {
        if (!fl_decimal_nearest(d, ten - digits + 1, &y)) return -1;
        how = y == fabs(x);
    }
    if (how) write_decimal(buf, x < 0.0, d, digits, ten);
    return how;
}

/* Returns 0 for numbers that 128 bits do not decide: subnormal numbers, some exact ties, few others. */
static int format_fast(double x, char *buf)
{
    uint64_t bits, whole, fraction;
    memcpy(&bits, &x, sizeof bits);
    const int exponent = (int)(bits >> 52 & 0x7ff);
    const uint64_t m = (bits & ((UINT64_C(1) << 52) - 1)) | UINT64_C(1) << 52;
    if (exponent == 0 || exponent == 0x7ff) return 0;
    /* floor(log10 x) or one less: the slope is log10(2) rounded down, within 1e-6 over all exponents */
    int ten = (int)floor((exponent - 1023) * 0.30102999);
    int scaled = fl_decimal_scaled(m, exponent - 1075, 16 - ten, &whole, &fraction);
    if (scaled && whole >= 10 * TEN_16) {
        ten++;
        scaled = fl_decimal_scaled(m, exponent - 1075, 16 - ten, &whole, &fraction);
    }
    if (!scaled) return 0;
    if (whole < TEN_16 || whole >= 10 * TEN_16) return 0;
    int how = try_digits(x, whole, fraction, scaled == 2, m, ten, 15, 100, buf);
    if (how == 0) how = try_digits(x, whole, fraction, scaled == 2, m, ten, 16, 10, buf);
    if (how == 0) how = try_digits(x, whole, fraction, scaled == 2, m, ten, 17, 1, buf);
    return how > 0;
}

char *fl_number_text(double x, char buf[FL_NUMBER_LEN])
{
    if (x == 0.0) return memcpy(buf, "0", 2);
    return format_fast(x, buf) ? buf : format_by_library(x, buf);
}

int fl_number_f64(const char *s, double *x)
{
    double v;
    const char *end = fl_decimal_read(s, &v);
    if (!end || *end || !isfinite(v)) return -1;
    *x = v + 0.0; /* -0 becomes 0, as it is printed */
    return 0;
}

/* Indices come in millions, so the C library is not used. */
int fl_number_i32(const char *s, int32_t lo, int32_t hi, int32_t *x)
{
    const int minus = *s == '-';
    const char *digit = s + (minus || *s == '+');
    int64_t v = 0;
    if (*digit == '\0') return -1;
    for (; *digit >= '0' && *digit <= '9'; digit++) {
        v = 10 * v + (*digit - '0');
        if (v > (int64_t)INT32_MAX + 1) return -1;
    }
    if (minus) v = -v;
    if (*digit || v < lo || v > hi) return -1;
    *x = (int32_t)v;
    return 0;
}

int fl_number_u64(const char *s, uint64_t *x)
{
    char *end;
    unsigned long long v;
    if (s[0] == '\0' || s[strspn(s, "0123456789")] != '\0') return -1;
    errno = 0;
    v = strtoull(s, &end, 10);
    if (*end || errno) return -1;
    *x = v;
    return 0;
}
