/* SPDX-License-Identifier: GPL-3.0-or-later */
/* fast_math.h -- exponential, logarithm, power, sine, cosine and arc tangent for the time step.  They are
 * fixed polynomials in IEEE operations, so the bits do not depend on the C library. */
#ifndef FL_BASE_FAST_MATH_H
#define FL_BASE_FAST_MATH_H

/* e^x, error up to 2 units in the last place.  0 below -708, where the result is not a normal number;
 * infinite above 709.78.  x is not NaN. */
double fl_exp(double x);

/* ln x, error up to 2 units in the last place; x > 0, normal and finite. */
double fl_log(double x);

/* x^y = e^(y ln x), x >= 0, y > 0; 0^y is 0.  Relative error below 4e-16 (1 + |y ln x|). */
double fl_pow(double x, double y);

/* cos x and sin x, x in rad, |x| <= 1e6.  Error 2e-16, and 1e-16 |x| for large |x|, as that of x itself. */
void fl_cos_sin(double x, double *c, double *s);

/* Angle of the point (x, y), in [-pi, pi], signs of zero as atan2() of C; error up to 4e-16, and 2 units in
 * the last place for small angles.  x and y are finite. */
double fl_atan2(double y, double x);

#endif
