/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdio.h> /* first: gmp.h declares its output functions only after it */

#include <gmp.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "base/number_text.h"
#include "stat/exact_sum.h"

__extension__ typedef unsigned __int128 uint128;

/* Bits of a product w x^4: the lowest 2^(5 * -1074), the highest below 2^(5 * 334 + 63).  Words are counted
 * from 2^(64 * LEAST), so that word numbers are not negative. */
enum {
    LEAST = -84,
    BITS_MAX = 5 * 334 + 64,
    WORDS_MAX = BITS_MAX / 64 + 1 - LEAST,
    TERM_MAX = 5,
    DIGITS_MAX = 16 * WORDS_MAX
};

/* x = sign m 2^e */
typedef struct {
    uint64_t m;
    int32_t e;
    int minus;
} double_parts;

static double_parts split_double(double x)
{
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    const uint64_t fraction = bits & ((UINT64_C(1) << 52) - 1);
    const int32_t e = (int32_t)(bits >> 52 & 2047);
    return (double_parts){e ? fraction | UINT64_C(1) << 52 : fraction, (e ? e : 1) - 1075, (int)(bits >> 63)};
}

/* Extend the sum to words from lo to hi, and one above for carries. */
static int grow_words(fl_exact_sum *s, int32_t lo, int32_t hi, fl_err *err)
{
    const int32_t from = s->n && s->lo < lo ? s->lo : lo,
                  to = s->n && s->lo + s->n > hi + 2 ? s->lo + s->n : hi + 2, n = to - from;
    uint64_t *word = fl_alloc(2 * (int64_t)n, sizeof *word, err);
    if (!word) return -1;
    for (int32_t k = 0; k < s->n; k++) {
        word[s->lo - from + k] = s->word[k];
        word[n + s->lo - from + k] = s->word[s->n + k];
    }
    free(s->word);
    *s = (fl_exact_sum){word, from, n};
    return 0;
}

/* Add (or subtract) term[0 .. k) 2^e.  Inline: k is a constant of the caller, which unrolls the loop. */
static inline __attribute__((always_inline)) int add_term(fl_exact_sum *s, const uint64_t *term, int k,
                                                          int32_t e, int minus, fl_err *err)
{
    const int32_t place = e - 64 * LEAST, lo = place / 64 + LEAST;
    const int shift = place % 64;
    if ((s->n == 0 || lo < s->lo || lo + k + 1 >= s->lo + s->n) && grow_words(s, lo, lo + k, err)) return -1;
    uint64_t *word = s->word + (minus ? s->n : 0) + (lo - s->lo), over = 0;
    unsigned carry = 0;
    for (int i = 0; i < k; i++) {
        const uint128 v = (uint128)term[i] << shift | over, sum = (uint128)word[i] + (uint64_t)v + carry;
        word[i] = (uint64_t)sum;
        carry = (unsigned)(sum >> 64);
        over = (uint64_t)(v >> 64);
    }
    const uint128 sum = (uint128)word[k] + over + carry;
    word[k] = (uint64_t)sum;
    /* The word above every term counts carries; 2^63 of them do not overflow it. */
    if (sum >> 64)
        while (++word[++k] == 0) {}
    return 0;
}

int fl_exact_add(fl_exact_sum *s, double x, fl_err *err)
{
    const double_parts p = split_double(x);
    return p.m ? add_term(s, &p.m, 1, p.e, p.minus, err) : 0;
}

/* Multiply term[0 .. k) by m; the result has one word more. */
static inline __attribute__((always_inline)) void multiply_word(uint64_t *term, int k, uint64_t m)
{
    uint64_t carry = 0;
    for (int i = 0; i < k; i++) {
        const uint128 product = (uint128)term[i] * m + carry;
        term[i] = (uint64_t)product;
        carry = (uint64_t)(product >> 64);
    }
    term[k] = carry;
}

int fl_exact_add_powers(fl_exact_sum s[5], double w, double x, fl_err *err)
{
    const double_parts pw = split_double(w), px = split_double(x);
    uint64_t term[TERM_MAX] = {pw.m};
    const int32_t e = pw.e;
    if (pw.m == 0) return 0;
    if (add_term(&s[0], term, 1, e, 0, err)) return -1;
    if (px.m == 0) return 0;
    if (multiply_word(term, 1, px.m), add_term(&s[1], term, 2, e + px.e, px.minus, err)) return -1;
    if (multiply_word(term, 2, px.m), add_term(&s[2], term, 3, e + 2 * px.e, 0, err)) return -1;
    if (multiply_word(term, 3, px.m), add_term(&s[3], term, 4, e + 3 * px.e, px.minus, err)) return -1;
    multiply_word(term, 4, px.m);
    return add_term(&s[4], term, 5, e + 4 * px.e, 0, err);
}

int fl_exact_merge(fl_exact_sum *s, const fl_exact_sum *t, fl_err *err)
{
    if (t->n == 0) return 0;
    if ((s->n == 0 || t->lo < s->lo || t->lo + t->n > s->lo + s->n) &&
        grow_words(s, t->lo, t->lo + t->n - 1, err))
        return -1;
    for (int half = 0; half < 2; half++) {
        uint64_t *word = s->word + (half ? s->n : 0);
        unsigned carry = 0;
        for (int32_t k = t->lo - s->lo, i = 0; i < t->n || carry; k++, i++) {
            const uint128 sum = (uint128)word[k] + (i < t->n ? t->word[(half ? t->n : 0) + i] : 0) + carry;
            word[k] = (uint64_t)sum;
            carry = (unsigned)(sum >> 64);
        }
    }
    return 0;
}

/* z 2^(64 lo) is the sum.  GMP ends the program when it has no memory.  Its numbers have a few kilobytes;
 * everything that grows with the data is allocated here. */
static void to_integer(mpz_t z, const fl_exact_sum *s, int32_t lo)
{
    mpz_t negative;
    mpz_set_ui(z, 0);
    if (s->n == 0) return;
    mpz_init(negative);
    mpz_import(z, (size_t)s->n, -1, sizeof *s->word, 0, 0, s->word);
    mpz_import(negative, (size_t)s->n, -1, sizeof *s->word, 0, 0, s->word + s->n);
    mpz_sub(z, z, negative);
    mpz_mul_2exp(z, z, (mp_bitcnt_t)(64 * (s->lo - lo)));
    mpz_clear(negative);
}

/* a / b = f 2^e with 1 <= |f| < 2, f rounded to nearest, or f = 0; b > 0. */
static double nearest_quotient(const mpz_t a, const mpz_t b, int64_t *e)
{
    mpz_t q, r;
    *e = 0;
    if (mpz_sgn(a) == 0) return 0.0;
    mpz_init(q);
    mpz_init(r);
    mpz_abs(q, a);
    const int64_t shift = 66 - (int64_t)mpz_sizeinbase(a, 2) + (int64_t)mpz_sizeinbase(b, 2);
    if (shift > 0) {
        mpz_mul_2exp(q, q, (mp_bitcnt_t)shift);
        mpz_tdiv_qr(q, r, q, b);
    } else {
        mpz_t big;
        mpz_init(big);
        mpz_mul_2exp(big, b, (mp_bitcnt_t)-shift);
        mpz_tdiv_qr(q, r, q, big);
        mpz_clear(big);
    }
    /* 66 or 67 bits; the lowest is a sticky bit for all that follow, which decides ties. */
    if (mpz_sgn(r)) mpz_setbit(q, 0);
    const int64_t bits = (int64_t)mpz_sizeinbase(q, 2), drop = bits - 53;
    uint64_t m;
    mpz_tdiv_q_2exp(r, q, (mp_bitcnt_t)drop);
    m = mpz_get_ui(r);
    const int half = mpz_tstbit(q, (mp_bitcnt_t)drop - 1);
    if (half && ((m & 1) || mpz_scan1(q, 0) < (mp_bitcnt_t)drop - 1)) m++;
    mpz_clear(q);
    mpz_clear(r);
    *e = bits - 1 - shift;
    return copysign(ldexp((double)m, -52), mpz_sgn(a));
}

double fl_exact_value(const fl_exact_sum *s)
{
    mpz_t z, one;
    int64_t e;
    mpz_init(z);
    mpz_init_set_ui(one, 1);
    to_integer(z, s, s->lo);
    const double f = nearest_quotient(z, one, &e);
    mpz_clear(z);
    mpz_clear(one);
    return ldexp(f, (int)(e + 64 * (int64_t)s->lo));
}

void fl_exact_print(FILE *f, const fl_exact_sum *s)
{
    mpz_t z;
    mpz_init(z);
    to_integer(z, s, s->lo);
    if (mpz_sgn(z) == 0) {
        fputs("0", f);
    } else {
        const mp_bitcnt_t zeros = mpz_scan1(z, 0);
        fputs(mpz_sgn(z) < 0 ? "-0x" : "0x", f);
        mpz_abs(z, z);
        mpz_tdiv_q_2exp(z, z, zeros);
        mpz_out_str(f, 16, z);
        fprintf(f, "p%lld", (long long)zeros + 64 * (long long)s->lo);
    }
    mpz_clear(z);
}

static int digit_of(char c)
{
    if (c >= '0' && c <= '9') return c - '0';
    return c >= 'a' && c <= 'f' ? c - 'a' + 10 : -1;
}

int fl_exact_read(fl_exact_sum *s, const char *text, fl_err *err)
{
    const int minus = text[0] == '-';
    const char *p = text + minus;
    int32_t e;
    size_t n = 0;
    if (strcmp(text, "0") == 0) return 0;
    if (strncmp(p, "0x", 2) == 0)
        for (p += 2; digit_of(p[n]) >= 0; n++) {}
    if (n == 0 || p[0] == '0' || p[n] != 'p' || fl_number_i32(p + n + 1, 64 * LEAST, BITS_MAX, &e) ||
        digit_of(p[n - 1]) % 2 == 0)
        return fl_fail(err, FL_INPUT,
                       "\"%.40s\" is not an exact sum, expected 0xHEXpEXPONENT with HEX odd, or 0", text);
    if (n > DIGITS_MAX || e + 4 * (int64_t)n > BITS_MAX)
        return fl_fail(err, FL_INPUT, "the exact sum \"%.20s...\" is out of range", text);
    /* One word of 16 digits at a time, from the lowest. */
    while (n > 0) {
        const size_t k = n < 16 ? n : 16;
        uint64_t word = 0;
        for (size_t i = n - k; i < n; i++) word = word << 4 | (uint64_t)digit_of(p[i]);
        if (add_term(s, &word, 1, e, minus, err)) return -1;
        e += 64;
        n -= k;
    }
    return 0;
}

void fl_exact_moments(const fl_exact_sum s[5], double out[4])
{
    enum { M2, M3, M4, A, B, WORK };
    mpz_t z[5], t[WORK];
    mpz_t *const w = &z[0];
    int32_t lo[5], base, unit = 0;
    int64_t e;
    double f;
    for (int k = 0; k < 4; k++) out[k] = NAN;
    for (int k = 0; k < 5; k++) {
        mpz_init(z[k]);
        lo[k] = s[k].n ? s[k].lo : 0;
        to_integer(z[k], &s[k], lo[k]);
    }
    for (int k = 0; k < WORK; k++) mpz_init(t[k]);
    if (mpz_sgn(*w) <= 0) goto done;
    /* All as integers: time in units of 2^(64 base), x in units of 2^(64 unit). */
    base = lo[0];
    for (int k = 1; k < 5; k++)
        while (lo[k] < base + k * unit) unit--;
    for (int k = 1; k < 5; k++) mpz_mul_2exp(z[k], z[k], (mp_bitcnt_t)(64 * (lo[k] - base - k * unit)));
    f = nearest_quotient(z[1], *w, &e);
    out[0] = ldexp(f, (int)(e + 64 * unit));
    /* m2 w^2 = s2 w - s1^2 */
    mpz_mul(t[M2], z[2], *w);
    mpz_submul(t[M2], z[1], z[1]);
    mpz_mul(t[A], *w, *w);
    f = nearest_quotient(t[M2], t[A], &e);
    if (e % 2) { /* the square root needs an even exponent */
        f *= 2.0;
        e--;
    }
    out[1] = ldexp(sqrt(f), (int)(e / 2 + 64 * unit));
    if (mpz_sgn(t[M2]) <= 0) goto done;
    /* m3 w^3 = s3 w^2 - 3 s2 s1 w + 2 s1^3, and the w cancel in (m3 w^3)^2 / (m2 w^2)^3 = skew^2 */
    mpz_mul(t[M3], z[3], t[A]);
    mpz_mul(t[B], z[1], z[2]);
    mpz_mul(t[B], t[B], *w);
    mpz_submul_ui(t[M3], t[B], 3);
    mpz_pow_ui(t[B], z[1], 3);
    mpz_addmul_ui(t[M3], t[B], 2);
    mpz_mul(t[B], t[M3], t[M3]);
    mpz_pow_ui(t[M4], t[M2], 3);
    f = nearest_quotient(t[B], t[M4], &e);
    out[2] = copysign(sqrt(ldexp(f, (int)e)), mpz_sgn(t[M3]));
    /* m4 w^4 = s4 w^3 - 4 s3 s1 w^2 + 6 s2 s1^2 w - 3 s1^4 */
    mpz_mul(t[A], t[A], *w);
    mpz_mul(t[M4], z[4], t[A]);
    mpz_mul(t[B], z[3], z[1]);
    mpz_mul(t[B], t[B], *w);
    mpz_mul(t[B], t[B], *w);
    mpz_submul_ui(t[M4], t[B], 4);
    mpz_mul(t[B], z[1], z[1]);
    mpz_mul(t[B], t[B], z[2]);
    mpz_mul(t[B], t[B], *w);
    mpz_addmul_ui(t[M4], t[B], 6);
    mpz_pow_ui(t[B], z[1], 4);
    mpz_submul_ui(t[M4], t[B], 3);
    mpz_mul(t[B], t[M2], t[M2]);
    f = nearest_quotient(t[M4], t[B], &e);
    out[3] = ldexp(f, (int)e) - 3.0;
done:
    for (int k = 0; k < 5; k++) mpz_clear(z[k]);
    for (int k = 0; k < WORK; k++) mpz_clear(t[k]);
}

void fl_exact_free(fl_exact_sum *s)
{
    free(s->word);
    *s = (fl_exact_sum){0};
}
