/* SPDX-License-Identifier: GPL-3.0-or-later */
/* damping.h -- damping of a contact from its coefficient of restitution, for three laws; the share of the
 * stable step that damping leaves; and the approach speed at the end of a step, by which damping acts.
 *
 *     Hunt & Crossley   F = k s^n (1 + chi s'),  chi = D / v_impact
 *     linear            F = k s + 2 zeta sqrt(M k) s'
 *     Tsuji             F = k s^(3/2) + alpha sqrt(M k) s^(1/4) s'
 *
 * s overlap [m], s' approach speed [m/s], M reduced mass [kg], e restitution.  Restitutions below
 * FL_MIN_RESTITUTION are taken as that value: the formulae diverge there. */
#ifndef FL_LAW_DAMPING_H
#define FL_LAW_DAMPING_H
#include <math.h>

#define FL_MIN_RESTITUTION 0.01

/* Damping number D = chi v_impact of Hunt and Crossley: the root of D (1 + e) = ln[(1 + D)/(1 - e D)].  It
 * holds for every exponent, stiffness, mass and number of contact points.  0 for e >= 1. */
double fl_damping_hunt_crossley(double e);

/* Largest stored energy of an impact, as a speed over the impact speed: sqrt(2 W_max/M)/v.  From
 * u du/(1 + chi u) = -dW/M its square is 2 (1/D - ln(1 + D)/D^2) for every potential; 1 for D = 0. */
double fl_damping_stored_speed(double D);

/* Factor c of the stored speed in chi = D/max(v_touch, c sqrt(2 W/M)), for contacts pressed together slowly.
 *
 * Such a contact has the damping ratio D/(2 c), which the time step has to resolve unless
 * fl_damping_end_speed() is used.  c = 1 up to a ratio of 2.5, that is down to e = 0.2.  Below e = 0.2 the
 * ratio stays at the larger of 2.5 and the ratio that the impact itself reaches, D
 * fl_damping_stored_speed(D)/2. Since c fl_damping_stored_speed(D) <= 1, v_touch is the larger speed in an
 * impact, and e holds. */
double fl_damping_slow_factor(double D);

/* chi [s/m] of a contact.
 *   D, c    of its law
 *   touch   largest approach speed since the contact began [m/s]
 *   energy  stored energy W [J]
 *   mass    reduced mass M [kg] */
static inline double fl_damping_chi(double D, double c, double touch, double energy, double mass)
{
    const double stored = c * sqrt(2.0 * energy / mass), speed = touch > stored ? touch : stored;
    return speed > 0.0 ? D / speed : 0.0;
}

/* --- sustained loads ---------------------------------------------------------------------------------
 *
 * A body that rolls or slides over a corner of a surface transfers its load from one face to the next: the
 * points of one approach, those of the other part, and the load as a whole does not change.  Damping of each
 * point by its own speed would then cost far more than the corner itself, m (v dphi)^2/2, as the load would
 * be built up anew at every corner.  So damping acts on
 *
 *     c' = c - lambda (c - C),
 *
 * c being the approach speeds of the points, and C that of the contact as a whole.  C is the mean
 * sum e c/sum e over the pressures e, or the rate of the stored energy over sum e, or 0, whichever is between
 * the other two: where pressures travel along the faces their mean approach is no rate of the load.  lambda
 * is the product of
 *   - the sustained share of the load: F behind a low pass over F.  The time of the low pass is
 *     FL_SUSTAINED_PERIODS/omega, omega^2 = K/M.  The share is 1 for a load that rests, and 0 in an impact,
 *     whose restitution stays;
 *   - u^2/(u^2 + (sigma/FL_SUSTAINED_SLOPE)^2), with u the speed across the normal of the points of the cores
 *     that touch, and sigma the deviation of c: 1 for a body that moves along the surface over small bends, 0
 *     for one that rocks on the spot, and little in a groove;
 *   - w.w'/max(w^2, w'^2) >= 0, with w the spin across the normal and w' the same behind the low pass: 1
 *     for a body that rolls or pitches steadily, 0 for one that rocks to and fro.
 * sum e c' c >= 0, so that damping dissipates. */
#define FL_SUSTAINED_PERIODS 2.0
#define FL_SUSTAINED_SLOPE 0.2

/* C from the mean and from the rate of the energy over the load. */
static inline double fl_damping_whole_approach(double mean, double rate)
{
    const double same = mean * rate > 0.0 ? rate : 0.0;
    return same * same < mean * mean ? same : mean;
}

/* First factor of lambda. */
static inline double fl_damping_sustained_share(double sustained, double load)
{
    return sustained < load ? sustained / load : load > 0.0 ? 1.0 : 0.0;
}

/* Second factor, from u^2 and sigma^2. */
static inline double fl_damping_passing_share(double u2, double sigma2)
{
    const double all = u2 + sigma2 * (1.0 / (FL_SUSTAINED_SLOPE * FL_SUSTAINED_SLOPE));
    return all > 0.0 ? u2 / all : 0.0;
}

/* Third factor, from w.w', w^2 and w'^2. */
static inline double fl_damping_steady_share(double product, double now2, double before2)
{
    const double most = now2 > before2 ? now2 : before2;
    return !(most > 0.0) ? 1.0 : product > 0.0 ? product / most : 0.0;
}

/* The low pass y' = r (x - y), r = omega/FL_SUSTAINED_PERIODS, over dt [s]: by the trapezoidal rule, so that
 * forces keep the order of the step, and by backward Euler over stretches longer than 1/r. */
typedef struct {
    double part, rate; /* share of the new x; r [1/s] */
    int trapezoid;
} fl_low_pass;

/* dt = 0: of a contact that begins.  omega2: stiffness over mass [1/s2]. */
static inline fl_low_pass fl_damping_low_pass(double dt, double omega2)
{
    const double rate = sqrt(omega2) * (1.0 / FL_SUSTAINED_PERIODS), x = dt * rate;
    const double half = 0.5 * x;
    return x > 1.0 ? (fl_low_pass){x / (1.0 + x), rate, 0} : (fl_low_pass){half / (1.0 + half), rate, 1};
}

/* y after dt.  gradient: y' before. */
static inline double fl_low_pass_after(const fl_low_pass *f, double y, double gradient, double x, double dt)
{
    const double from = f->trapezoid ? y + 0.5 * dt * gradient : y;
    return from + f->part * (x - from);
}

/* Share of the largest step 2/omega that Hunt and Crossley leave when damping uses fl_damping_end_speed(): at
 * the start of an impact the stiffness is 1 + D times that of the springs. */
static inline double fl_damping_impact_share(double D) { return 1.0 / sqrt(1.0 + D); }

/* Share of the largest stable step 2/omega that damping leaves in a scheme that uses the speed of half a step
 * ago, K dt^2 + 2 C dt <= 4.  For a damping ratio z it is sqrt(1 + z^2) - z. */
double fl_damping_stable_share(double z);

/* The same for Hunt and Crossley with the factor c above, of a contact that is `times` as stiff and as
 * damped. It is the smaller of the share at rest and the least share during an impact.  In the impact, with
 * s and u in units of v/omega and v, the stiffness is 1 + D u, the damping D s, and s^2 = 2 (1 - u)/D - 2
 * ln[(1 + D)/(1 + D u)]/D^2. */
double fl_hunt_crossley_stable_share(double D, double times);

/* Weight of the implicit treatment of one contact among n that damp the same body, y = h C.  It is 1 where
 * all of them change a speed little in a step, a = 2 n y << 1, and tends to `most` where they would
 * oscillate. */
static inline double fl_damping_implicit_weight(double y, double n, double most)
{
    const double a = 2.0 * n * y, much = a * a;
    return 1.0 + (most - 1.0) * (much / (1.0 + much));
}

/* Approach speed at the end of a step, by which a contact is damped [m/s].
 *
 * Forces are evaluated at the end of a step, but speeds are known in its middle.  The change of speed in the
 * first half of the step predicts the speed c of the end, except for the change of forces since the step
 * before.  For the contact itself that change is known.  With h = dt/2M its damping force is C d, where
 *     d = c - h ((E - E_before) + (C d - D_before))
 * is the speed at the end of the step to order 2.  For a single contact that is the trapezoidal rule, stable
 * for all damping.
 *
 * Each of n contacts that damp one body knows only its own change.  Explicit among one another, they would
 * oscillate where n h C is not small.  There the damping changes by no more than if 2n - 1 contacts changed
 * like this one.  That is stable, again for all damping of bodies free to move as M says, up to 0.7 of the
 * step that the springs alone allow (verify_step).  Where n h C is small each contact counts once; the
 * effect of the others on d is of order 4 there.
 *
 * The held-back part lags behind the motion.  Where it would drive the motion, the previous step is
 * ignored. At the start of a run there is no previous step: damping is taken as unchanged and is held back
 * where it would oscillate, and the elastic force as unchanged.
 *
 *   c         predicted approach speed at the end [m/s]
 *   C         damping coefficient [N s/m]
 *   h         dt/2M [s/kg]
 *   n         contacts that damp the body
 *   grew      E - E_before, elastic force [N]
 *   damped    D_before, damping force     [N]
 *   at_start  1 at the start of a run, else 0 */
static inline double fl_damping_end_speed(double c, double C, double h, double n, double grew, double damped,
                                          double at_start)
{
    const double weight = (fl_damping_implicit_weight(h * C, n, 2.0 * n - 1.0 + at_start) - at_start) * h;
    const double d = (c - h * grew + weight * damped) / (1.0 + weight * C);
    return n > 1.0 && c * d < 0.0 ? c / (1.0 + weight * C) : d;
}

/* Number of contacts in line to which the contacts of both bodies amount.  Body i has n_i contacts and the
 * inverse mass y_i, body j n_j and y_j; the result is the number on one body of the inverse mass y = y_i +
 * y_j. Another contact moves its body by that body's own inverse mass only.  Like Gershgorin's bound of the
 * eigenvalues of the compliance matrix of the contacts.
 *   pi, pj  (n - 1) times the inverse mass, of either body */
static inline double fl_effective_contact_count(double pi, double pj, double y)
{
    return y > 0.0 ? 1.0 + (pi + pj) / y : 1.0;
}

/* zeta of the linear law for the restitution e; the contact ends when F reaches 0.
 * Source: Schwager & Poeschel, Granular Matter 9 (2007) 465. */
double fl_damping_linear(double e);

/* Restitution of the ratio zeta: the inverse of fl_damping_linear(). */
double fl_damping_linear_restitution(double zeta);

/* alpha of Tsuji's law, which never pulls, for the restitution e: the fit of Thornton, Cummins & Cleary,
 * Powder Technology 233 (2013) 30; within 0.2 %. */
double fl_damping_tsuji(double e);

#endif
