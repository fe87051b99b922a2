/* SPDX-License-Identifier: GPL-3.0-or-later */
/* damping.h -- from a coefficient of restitution to the damping of a contact, for three laws.
 * Below FL_MIN_RESTITUTION the closures diverge; smaller values are taken as that. */
#ifndef FL_LAW_DAMPING_H
#define FL_LAW_DAMPING_H
#include <math.h>

#define FL_MIN_RESTITUTION 0.01

/* Hunt-Crossley, F = k s^n (1 + chi s'): D = chi v_impact is the root of D (1 + e) = ln[(1 + D)/(1 - e D)],
 * for every exponent, stiffness, mass and number of places.  0 for e >= 1. */
double fl_damping_hunt_crossley(double e);

/* The most that an impact of D stores, as the speed it amounts to over that of the impact: sqrt(2 W_max/M)/v.
 * From u du/(1 + chi u) = -dW/M: its square is 2 (1/D - ln(1 + D)/D^2), whatever the potential; 1 for D = 0.
 */
double fl_damping_stored_speed(double D);

/* A contact that is pressed together slowly is no impact: with chi = D/max(v_touch, c sqrt(2 W/M)) its
 * damping ratio is D/(2 c), which the step must follow but under fl_damping_end_speed().  So c = 1 up to a
 * ratio of 2.5, that is down to e = 0.2; below the ratio stays there, or is that which the impact itself
 * reaches, D fl_damping_stored_speed(D)/2, where that is more.  c fl_damping_stored_speed(D) <= 1, so that in an impact
 * v_touch is the larger one, and e holds. */
double fl_damping_slow_factor(double D);

/* chi of an impact that has approached by `touch` at the most, D and c of its law, W stored, M reduced. */
static inline double fl_damping_chi(double D, double c, double touch, double energy, double mass)
{
    const double stored = c * sqrt(2.0 * energy / mass), speed = touch > stored ? touch : stored;
    return speed > 0.0 ? D / speed : 0.0;
}

/* What Hunt and Crossley leave of the largest step 2/omega where damping goes by fl_damping_end_speed(): as an
 * impact begins, the stiffness is 1 + D times that of the springs. */
static inline double fl_damping_impact_share(double D) { return 1.0 / sqrt(1.0 + D); }

/* What damping leaves of the largest stable step 2/omega of a scheme that has the speed of half a step ago:
 * K dt^2 + 2 C dt <= 4.  Of a ratio z: sqrt(1 + z^2) - z.  Of Hunt and Crossley with c as above: the least of
 * that at rest, and of an impact, where with s and u in shares of v/omega and v the stiffness is 1 + D u, the
 * damping D s, and s^2 = 2 (1 - u)/D - 2 ln[(1 + D)/(1 + D u)]/D^2.  times: of what is so many times as stiff
 * and as damped, what that leaves of its own 2/omega. */
double fl_damping_stable_share(double z);
double fl_hunt_crossley_stable_share(double D, double times);

/* How many contacts one stands for that is damped by y = h C, of n that damp one body: for itself where all
 * of them change little of a speed in a step, a = 2 n y of it; for `most` where they would shake. */
static inline double fl_damping_implicit_weight(double y, double n, double most)
{
    const double a = 2.0 * n * y, much = a * a;
    return 1.0 + (most - 1.0) * (much / (1.0 + much));
}

/* Forces are found at the end of a step, where speeds are known of its middle.  What its first half has
 * changed foretells the end, c, but for what forces change by from the step before; of the contact itself
 * that is known, so with h = dt/2M its damping C d goes by
 *     d = c - h ((E - E_before) + (C d - D_before)),
 * the speed at the end of the step, to order 2.  For a contact by itself that is the trapezoidal rule,
 * stable for all damping.  Of n contacts that damp one body each knows its own part alone; and explicit as
 * they are among one another they would shake where n h C is not small.  There damping changes by no more
 * than if 2n - 1 did what this one does: stable, again for all damping of bodies that are free to yield as M
 * has it, up to 0.7 of what the springs alone would leave (verify_step).  Where n h C is small each stands
 * for itself; what the others bear on d by is of order 4 there.
 *
 * What is held back lags behind the motion: rather than drive it, it forgets what was before.  As time begins
 * there is no step before: damping is taken to have been what it is, and held back where it would shake, and
 * nothing has grown.
 *
 *   c        approach foreseen for the end [m/s]
 *   grew     E - E_before, elastic force   [N]
 *   damped   D_before, that of damping     [N]
 *   begins   1 as time begins, else 0 */
static inline double fl_damping_end_speed(double c, double C, double h, double n, double grew, double damped,
                                          double begins)
{
    const double holds = (fl_damping_implicit_weight(h * C, n, 2.0 * n - 1.0 + begins) - begins) * h;
    const double d = (c - h * grew + holds * damped) / (1.0 + holds * C);
    return n > 1.0 && c * d < 0.0 ? c / (1.0 + holds * C) : d;
}

/* Of one contact, of n_i on a body that yields by y_i and n_j on one by y_j, as many as would be on a body
 * that alone yields by what both do: what else presses on a body moves it no more than that yields.  p =
 * (n - 1) y of both; as the eigenvalues of how contacts yield to each other are bounded by Gershgorin. */
static inline double fl_effective_contact_count(double pi, double pj, double y)
{
    return y > 0.0 ? 1.0 + (pi + pj) / y : 1.0;
}

/* Linear, F = k s + 2 zeta sqrt(M k) s', the contact ending when F reaches 0: zeta of restitution e.
 * Source: Schwager & Poeschel, Granular Matter 9 (2007) 465. */
double fl_damping_linear(double e);
/* The restitution that zeta gives; the inverse of the above. */
double fl_damping_linear_restitution(double zeta);

/* Tsuji, F = k s^(3/2) + alpha sqrt(M k) s^(1/4) s', never pulling: alpha of restitution e, by the fit of
 * Thornton, Cummins & Cleary, Powder Technology 233 (2013) 30; within 0.2 %. */
double fl_damping_tsuji(double e);

#endif
