/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdint.h>
#include <string.h>
#include "base/fast_math.h"

/* Adding and subtracting 1.5 * 2^52 rounds to the nearest whole number, ties to even, up to 2^51. */
#define ROUND 6755399441055744.0

static double round_to_integer(double x) { return x + ROUND - ROUND; }

/* 2^k for -1022 <= k <= 1023 */
static double power_of_two(int64_t k)
{
    const uint64_t bits = (uint64_t)(k + 1023) << 52;
    double x;
    memcpy(&x, &bits, sizeof x);
    return x;
}

/* ln 2 in two parts; the first has 21 zero bits at its end, so that k times it is exact */
#define LN2_HIGH 6.93147180369123816490e-01
#define LN2_LOW 1.90821492927058770002e-10

/* x = k ln 2 + r, |r| <= ln 2 / 2.  Series of e^r to r^13; the next term is below 5e-18. */
double fl_exp(double x)
{
    if (x < -708.0) return 0.0;
    if (x > 709.78) return INFINITY;
    const double k = round_to_integer(x * 1.4426950408889634);
    const double high = x - k * LN2_HIGH, r = high - k * LN2_LOW;
    double p = 1.0 / 6227020800.0;
    p = p * r + 1.0 / 479001600;
    p = p * r + 1.0 / 39916800;
    p = p * r + 1.0 / 3628800;
    p = p * r + 1.0 / 362880;
    p = p * r + 1.0 / 40320;
    p = p * r + 1.0 / 5040;
    p = p * r + 1.0 / 720;
    p = p * r + 1.0 / 120;
    p = p * r + 1.0 / 24;
    p = p * r + 1.0 / 6;
    p = p * r + 1.0 / 2;
    /* 2^1024 overflows, so the power is applied in two factors */
    const int64_t n = (int64_t)k, half = n / 2;
    return (1.0 + (r + r * r * p)) * power_of_two(half) * power_of_two(n - half);
}

/* x = 2^k m, sqrt(1/2) < m <= sqrt 2; ln m = 2 artanh u, u = (m - 1) / (m + 1), |u| < 0.1716.  Series to
 * u^21; the next term is below 1e-17 of the sum. */
double fl_log(double x)
{
    uint64_t bits;
    double m;
    memcpy(&bits, &x, sizeof bits);
    int64_t k = (int64_t)(bits >> 52) - 1023;
    bits = (bits & 0xfffffffffffffu) | (uint64_t)1023 << 52;
    memcpy(&m, &bits, sizeof m);
    if (m > 1.4142135623730951) {
        m *= 0.5;
        k++;
    }
    const double u = (m - 1.0) / (m + 1.0), v = u * u;
    double p = 1.0 / 21;
    p = p * v + 1.0 / 19;
    p = p * v + 1.0 / 17;
    p = p * v + 1.0 / 15;
    p = p * v + 1.0 / 13;
    p = p * v + 1.0 / 11;
    p = p * v + 1.0 / 9;
    p = p * v + 1.0 / 7;
    p = p * v + 1.0 / 5;
    p = p * v + 1.0 / 3;
    const double n = (double)k;
    return n * LN2_HIGH + (2.0 * u + (2.0 * u * v * p + n * LN2_LOW));
}

double fl_pow(double x, double y) { return x > 0.0 ? fl_exp(y * fl_log(x)) : 0.0; }

/* pi/2 in three parts of 33 bits: n times the first two is exact up to n = 2^20 */
#define HALF_PI_1 1.57079632673412561417e+00
#define HALF_PI_2 6.07710050630396597660e-11
#define HALF_PI_3 2.02226624879595063154e-21

/* x = n pi/2 + r, |r| <= pi/4.  Series to r^17 and r^16; the next terms are below 1e-19 and 2e-18. */
void fl_cos_sin(double x, double *c, double *s)
{
    const double n = round_to_integer(x * 0.63661977236758134);
    const double r = x - n * HALF_PI_1 - n * HALF_PI_2 - n * HALF_PI_3, v = r * r;
    double p = 1.0 / 355687428096000.0, q = 1.0 / 20922789888000.0;
    p = p * v - 1.0 / 1307674368000.0;
    p = p * v + 1.0 / 6227020800.0;
    p = p * v - 1.0 / 39916800;
    p = p * v + 1.0 / 362880;
    p = p * v - 1.0 / 5040;
    p = p * v + 1.0 / 120;
    p = p * v - 1.0 / 6;
    q = q * v - 1.0 / 87178291200.0;
    q = q * v + 1.0 / 479001600;
    q = q * v - 1.0 / 3628800;
    q = q * v + 1.0 / 40320;
    q = q * v - 1.0 / 720;
    q = q * v + 1.0 / 24;
    const double sine = r + r * v * p, cosine = 1.0 - (0.5 * v - v * v * q);
    const int64_t k = (int64_t)n & 3;
    const double a = k & 1 ? sine : cosine, b = k & 1 ? cosine : sine;
    *c = k == 1 || k == 2 ? -a : a;
    *s = k & 2 ? -b : b;
}

/* atan c for c = 0, 1/4, 1/2, 3/4, 1 */
static const double ATAN[5] = {0.0, 0.24497866312686414, 0.46364760900080609, 0.64350110879328437,
                               0.78539816339744828};

/* t = c + the rest, c the nearest quarter: atan t = atan c + atan u, u = (t - c)/(1 + t c), |u| <= 1/8.
 * Series of atan u to u^17; the next term is below 3e-18 of u. */
static double atan_of_unit(double t)
{
    const int k = (int)(4.0 * t + 0.5);
    const double c = 0.25 * k, u = (t - c) / (1.0 + t * c), v = u * u;
    double p = 1.0 / 17;
    p = p * v - 1.0 / 15;
    p = p * v + 1.0 / 13;
    p = p * v - 1.0 / 11;
    p = p * v + 1.0 / 9;
    p = p * v - 1.0 / 7;
    p = p * v + 1.0 / 5;
    p = p * v - 1.0 / 3;
    return ATAN[k] + (u + u * v * p);
}

#define PI_HIGH 3.141592653589793116
#define PI_LOW 1.2246467991473532e-16

double fl_atan2(double y, double x)
{
    const double a = fabs(x), b = fabs(y),
                 t = b > a     ? atan_of_unit(a / b)
                     : b > 0.0 ? atan_of_unit(b / a)
                               : 0.0;
    double angle = t;
    if (b > a) angle = 0.5 * PI_HIGH - ((signbit(x) ? -t : t) - 0.5 * PI_LOW);
    else if (signbit(x)) angle = PI_HIGH - (t - PI_LOW);
    return signbit(y) ? -angle : angle;
}
