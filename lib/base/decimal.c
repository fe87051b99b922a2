/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include "base/decimal.h"

__extension__ typedef unsigned __int128 uint128;

/* Below 10^-342, 19 digits are less than half the smallest double; above 10^308 they exceed the largest. */
enum { EXPONENT_MIN = -342, EXPONENT_MAX = 308, DIGITS = 19, EXACT_POWER = 55, MANTISSA = 53, BIAS = 1023 };

/* 5^q = (hi 2^64 + lo + rest) 2^e with hi >= 2^63 and 0 <= rest < 1; rest = 0 for 0 <= q <= 55, as
 * 5^55 < 2^128. */
typedef struct {
    uint64_t hi, lo;
    int32_t e;
} power;

static power power_of_five[EXPONENT_MAX - EXPONENT_MIN + 1];

/* The leading 128 bits of the number word[0 .. n) 2^e, lowest word first. */
static power leading_bits(const uint64_t *word, int n, int32_t e)
{
    while (word[n - 1] == 0) n--;
    const int shift = __builtin_clzll(word[n - 1]);
    const uint64_t a = word[n - 1], b = n > 1 ? word[n - 2] : 0, c = n > 2 ? word[n - 3] : 0;
    power p = {a, b, e + 64 * (n - 2) - shift};
    if (shift) {
        p.hi = a << shift | b >> (64 - shift);
        p.lo = b << shift | c >> (64 - shift);
    }
    return p;
}

/* 5^308 has 716 bits.  2^1280 / 5^342 keeps 485 bits.  The remainder that a division drops never reaches the
 * leading ones: floor(floor(a/5)/5) = floor(a/25). */
__attribute__((constructor)) static void make_powers(void)
{
    enum { UP = 13, DOWN = 21 };
    uint64_t up[UP] = {1}, down[DOWN] = {0};
    for (int q = 0; q <= EXPONENT_MAX; q++) {
        power_of_five[q - EXPONENT_MIN] = leading_bits(up, UP, 0);
        uint128 carry = 0;
        for (int k = 0; k < UP; k++) {
            carry += (uint128)up[k] * 5;
            up[k] = (uint64_t)carry;
            carry >>= 64;
        }
    }
    down[DOWN - 1] = 1;
    for (int q = -1; q >= EXPONENT_MIN; q--) {
        uint128 rest = 0;
        for (int k = DOWN - 1; k >= 0; k--) {
            rest = rest << 64 | down[k];
            down[k] = (uint64_t)(rest / 5);
            rest %= 5;
        }
        power_of_five[q - EXPONENT_MIN] = leading_bits(down, DOWN, -64 * (DOWN - 1));
    }
}

/* The bits of the double nearest to w 10^q, w > 0.  Returns 0 when the product does not decide. */
static int nearest_bits(uint64_t w, int64_t q, uint64_t *bits)
{
    if (q < EXPONENT_MIN || q > EXPONENT_MAX) return 0;
    const power *p = &power_of_five[q - EXPONENT_MIN];
    const int shift = __builtin_clzll(w), exact = q >= 0 && q <= EXACT_POWER;
    w <<= shift;
    const uint128 low = (uint128)w * p->lo, product = (uint128)w * p->hi + (low >> 64);
    const int drop = (int)(product >> 127) + 127 - MANTISSA;
    const uint64_t mantissa = (uint64_t)(product >> drop);
    const uint128 rest = product & (((uint128)1 << drop) - 1), half = (uint128)1 << (drop - 1);
    /* w 10^q exceeds (mantissa + rest / 2^drop) 2^e by less than one unit of rest if exact, else two. */
    const int64_t e = drop + 64 + p->e - shift + q, exponent = e + MANTISSA - 1 + BIAS;
    uint64_t up;
    if (exponent < 1 || exponent > 2 * BIAS - 1) return 0; /* subnormal, or near the largest */
    if (exact) up = rest > half || (rest == half && ((uint64_t)low != 0 || (mantissa & 1)));
    else if (rest >= half) up = 1;
    else if (rest + 2 <= half) up = 0;
    else return 0;
    /* The leading bit of the mantissa is not stored.  A carry out of the mantissa increments the exponent. */
    *bits = ((uint64_t)exponent << (MANTISSA - 1)) + (mantissa & ((UINT64_C(1) << (MANTISSA - 1)) - 1)) + up;
    return 1;
}

static int is_digit(char c) { return (unsigned char)(c - '0') < 10; }

/* Reads "e+12" after the digits.  An e without digits is not part of the number. */
static const char *read_exponent(const char *s, int64_t *q)
{
    const char *p = s + 1;
    const int minus = *p == '-';
    int64_t e = 0;
    if (*p == '-' || *p == '+') p++;
    if (!is_digit(*p)) return s;
    for (; is_digit(*p); p++)
        if (e < 1000000000) e = 10 * e + (*p - '0'); /* far out of range already */
    *q += minus ? -e : e;
    return p;
}

static const char *read_digits(const char *p, uint64_t *w)
{
    for (; is_digit(*p); p++) *w = 10 * *w + (uint64_t)(*p - '0');
    return p;
}

/* Powers of ten that are exact doubles. */
static const double TEN[] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
                             1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};

const char *fl_decimal_read(const char *s, double *x)
{
    const char *p = s, *start, *point = NULL;
    const int minus = *p == '-';
    uint64_t w = 0, bits = 0, next = 0;
    int64_t q = 0, digits;
    double value;
    if (*p == '-' || *p == '+') p++;
    start = p;
    p = read_digits(p, &w);
    if (*p == '.') {
        point = p++;
        p = read_digits(p, &w);
        q = point + 1 - p;
    }
    digits = p - start - (point != NULL);
    if (digits == 0) return NULL;
    const char *const digits_end = p;
    int more = 0; /* set if a digit that did not fit into w is not zero */
    if (digits > DIGITS) {
        /* Leading zeros do not count.  w may have wrapped around, so the first 19 digits are read again. */
        const char *d = start;
        int64_t taken = 0;
        while (d < digits_end && (*d == '0' || *d == '.')) d++;
        for (w = 0; d < digits_end && taken < DIGITS; d++) {
            if (*d == '.') continue;
            w = 10 * w + (uint64_t)(*d - '0');
            taken++;
        }
        for (; d < digits_end; d++) {
            if (*d == '.') continue;
            q++;
            more |= *d != '0';
        }
    }
    if (*p == 'e' || *p == 'E') p = read_exponent(p, &q);
    if (w == 0) value = 0.0;
    else if (!more && w <= UINT64_C(1) << MANTISSA && q >= -22 && q <= 22) {
        /* Both operands are exact doubles, so a single operation rounds correctly. */
        value = q < 0 ? (double)w / TEN[-q] : (double)w * TEN[q];
    } else if (nearest_bits(w, q, &bits) && (!more || (nearest_bits(w + 1, q, &next) && next == bits))) {
        memcpy(&value, &bits, sizeof value);
    } else {
        *x = strtod(s, NULL);
        return p;
    }
    *x = minus ? -value : value;
    return p;
}

int fl_decimal_scaled(uint64_t m, int e, int q, uint64_t *whole, uint64_t *fraction)
{
    if (m == 0 || q < -300 || q > EXPONENT_MAX) return 0;
    const power *p = &power_of_five[q - EXPONENT_MIN];
    const int shift = __builtin_clzll(m);
    m <<= shift;
    const uint128 low = (uint128)m * p->lo, product = (uint128)m * p->hi + (low >> 64);
    /* x 10^q lies in (product .. product + 2) 2^-point: one unit for the dropped low word, one for the rest
     * of the power.  With at least 65 bits below the point both together are one unit of fraction; the
     * truncation of fraction is the second. */
    const int point = -(64 + p->e + e - shift + q);
    if (point < 65 || point > 127 || product >> point >> 62 || product >> point < (uint128)1 << 50) return 0;
    *whole = (uint64_t)(product >> point);
    *fraction = (uint64_t)(product >> (point - 64));
    const int exact = q >= 0 && q <= EXACT_POWER && (uint64_t)low == 0;
    return exact && (product & (((uint128)1 << (point - 64)) - 1)) == 0 ? 2 : 1;
}

int fl_decimal_nearest(uint64_t w, int q, double *x)
{
    uint64_t bits;
    if (w <= UINT64_C(1) << MANTISSA && q >= -22 && q <= 22) {
        *x = q < 0 ? (double)w / TEN[-q] : (double)w * TEN[q];
        return 1;
    }
    if (!nearest_bits(w, q, &bits)) return 0;
    memcpy(x, &bits, sizeof *x);
    return 1;
}
