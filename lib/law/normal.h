/* SPDX-License-Identifier: GPL-3.0-or-later */
/* normal.h -- the spring of one place along its normal, and the damping that follows it.
 *
 *     F = k s^n (1 + chi u) >= 0,     phi(s) = s^(n+1)/(n+1),     n = 1 or 3/2,
 *
 * s overlap, u approach speed.  Damping by a factor starts at zero, never pulls, and its restitution depends
 * on chi u_impact alone (damping.h).  Source: Hunt & Crossley, J. Appl. Mech. 42 (1975) 440. */
#ifndef FL_LAW_NORMAL_H
#define FL_LAW_NORMAL_H
#include <math.h>

/* s^n, s >= 0 */
static inline double fl_normal_power(double s, double n) { return n == 1.0 ? s : s * sqrt(s); }

/* phi(s) = s^(n+1)/(n+1): the energy of a place is k times this */
static inline double fl_normal_phi(double s, double n)
{
    return n == 1.0 ? 0.5 * s * s : 0.4 * s * s * sqrt(s);
}

/* d(s^n)/ds */
static inline double fl_normal_slope(double s, double n) { return n == 1.0 ? 1.0 : 1.5 * sqrt(s); }

/* Force from the elastic part, >= 0 */
static inline double fl_normal_damped_force(double elastic, double chi, double u)
{
    const double f = elastic * (1.0 + chi * u);
    return f > 0.0 ? f : 0.0;
}

#endif
