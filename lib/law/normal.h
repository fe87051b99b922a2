/* SPDX-License-Identifier: GPL-3.0-or-later */
/* normal.h -- normal force of one contact point: a spring, and damping in proportion to its force.
 *
 *     F = k s^n (1 + chi u) >= 0,     phi(s) = s^(n+1)/(n+1),     n = 1 or 3/2,
 *
 * s overlap [m], u approach speed [m/s], k stiffness [N/m^n], chi damping factor [s/m].  Damping in
 * proportion to the elastic force starts at zero and never pulls.  The restitution depends on chi u_impact
 * alone (damping.h).  Source: Hunt & Crossley, J. Appl. Mech. 42 (1975) 440. */
#ifndef FL_LAW_NORMAL_H
#define FL_LAW_NORMAL_H
#include <math.h>

/* s^n, s >= 0 */
static inline double fl_normal_power(double s, double n) { return n == 1.0 ? s : s * sqrt(s); }

/* phi(s) = s^(n+1)/(n+1); k phi(s) is the elastic energy of the point */
static inline double fl_normal_phi(double s, double n)
{
    return n == 1.0 ? 0.5 * s * s : 0.4 * s * s * sqrt(s);
}

/* d(s^n)/ds */
static inline double fl_normal_slope(double s, double n) { return n == 1.0 ? 1.0 : 1.5 * sqrt(s); }

/* Force with damping, >= 0, from the elastic force [N] */
static inline double fl_normal_damped_force(double elastic, double chi, double u)
{
    const double f = elastic * (1.0 + chi * u);
    return f > 0.0 ? f : 0.0;
}

#endif
