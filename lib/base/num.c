/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/decimal.h"
#include "base/num.h"

static int reads_as(const char *text, double x)
{
    double y;
    return fl_decimal(text, &y) && y == x;
}

/* The same by way of the C library, which is always right, and slow. */
static char *library_text(double x, char *buf)
{
    for (int digits = 15; digits <= 17; digits++) {
        snprintf(buf, FL_NUM_LEN, "%.*g", digits, x);
        if (digits == 17 || reads_as(buf, x)) break;
    }
    return buf;
}

/* --- decimal digits by whole numbers -------------------------------------------------------------------- */

enum { MOST_DIGITS = 17 };
static const uint64_t TEN_16 = UINT64_C(10000000000000000);

/* whole + fraction / 2^64, short by less than 2 units of fraction, to the nearest multiple of unit, in units;
 * unit is 1, 10 or 100.  Returns 0 when what is missing decides. */
static int rounded(uint64_t whole, uint64_t fraction, uint64_t unit, uint64_t *out)
{
    const uint64_t half = UINT64_C(1) << 63, rest = whole % unit, middle = unit / 2;
    uint64_t up;
    if (unit == 1) {
        if (fraction <= half && fraction + 2 > half) return 0;
        up = fraction > half;
    } else if (rest == middle) {
        if (fraction == 0) return 0; /* halfway, or just above */
        up = 1;
    } else {
        if (rest + 1 == middle && fraction + 2 < fraction) return 0; /* just below halfway, or not */
        up = rest > middle;
    }
    *out = whole / unit + up;
    return 1;
}

/* As "%.*g" prints d 10^(ten - digits + 1), d having that many digits. */
static void put_text(char *p, int minus, uint64_t d, int digits, int ten)
{
    char digit[MOST_DIGITS];
    int n = digits;
    for (int k = digits - 1; k >= 0; k--, d /= 10) digit[k] = (char)('0' + d % 10);
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
        *p++ = '0';
        *p++ = '.';
        for (int k = ten; k < -1; k++) *p++ = '0';
        for (int k = 0; k < n; k++) *p++ = digit[k];
    } else {
        for (int k = 0; k < n || k <= ten; k++) {
            if (k == ten + 1) *p++ = '.';
            *p++ = k < n ? digit[k] : '0';
        }
    }
    *p = '\0';
}

/* Returns 0 for numbers that 128 bits do not settle: subnormal ones, some exact halves, and few others. */
static int quick_text(double x, char *buf)
{
    uint64_t bits, whole, fraction, unit = 100;
    memcpy(&bits, &x, sizeof bits);
    const int exponent = (int)(bits >> 52 & 0x7ff);
    const uint64_t m = (bits & ((UINT64_C(1) << 52) - 1)) | UINT64_C(1) << 52;
    const double size = fabs(x);
    if (exponent == 0 || exponent == 0x7ff) return 0;
    /* floor(log10 x), or one less: the slope is log10(2) from below, within 1e-6 over all exponents */
    int ten = (int)floor((exponent - 1023) * 0.30102999);
    if (!fl_decimal_scaled(m, exponent - 1075, 16 - ten, &whole, &fraction)) return 0;
    if (whole >= 10 * TEN_16) {
        ten++;
        if (!fl_decimal_scaled(m, exponent - 1075, 16 - ten, &whole, &fraction)) return 0;
    }
    if (whole < TEN_16 || whole >= 10 * TEN_16) return 0;
    for (int digits = 15; digits <= MOST_DIGITS; digits++, unit /= 10) {
        uint64_t d;
        double y;
        int at = ten;
        if (!rounded(whole, fraction, unit, &d)) return 0;
        if (d == 10 * TEN_16 / unit) { /* 9.99... to 10 */
            d /= 10;
            at++;
        }
        if (digits < MOST_DIGITS) {
            if (!fl_decimal_nearest(d, at - digits + 1, &y)) return 0;
            if (y != size) continue;
        }
        put_text(buf, x < 0.0, d, digits, at);
        return 1;
    }
    return 0;
}

char *fl_num_text(double x, char buf[FL_NUM_LEN])
{
    if (x == 0.0) return memcpy(buf, "0", 2);
    return quick_text(x, buf) ? buf : library_text(x, buf);
}

int fl_num_f64(const char *s, double *x)
{
    double v;
    const char *end = fl_decimal(s, &v);
    if (!end || *end || !isfinite(v)) return -1;
    *x = v + 0.0; /* -0 becomes 0, as it prints */
    return 0;
}

/* Indices come in millions: no detour by the C library. */
int fl_num_i32(const char *s, int32_t lo, int32_t hi, int32_t *x)
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

int fl_num_u64(const char *s, uint64_t *x)
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
