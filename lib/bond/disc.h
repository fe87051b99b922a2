/* SPDX-License-Identifier: GPL-3.0-or-later */
/* disc.h -- a bonded disc between two spheres (parallel bond): elasticity, damage, fracture, friction.
 *
 * The disc of radius R joins two spheres whose centres are l apart at the start.  With A = pi R^2,
 * I = pi R^4/4 and J = 2 I its springs are
 *     k_n = E A/l,     k_s = k_n G/E,     k_b = E I/l = k_n R^2/4,     k_t = G J/l = k_s R^2/2.
 * N = k_n (|d| - l) follows from the centres, d = x_j - x_i, e = d/|d|.  S across e and the moment M, both in
 * world axes, turn with the mean rotation of the two spheres and grow by
 *     dS = k_s dt (u - (u.e) e),     u = v_j - v_i - (a w_i + (1 - a) w_j) x (d - dt/2 (v_j - v_i)),
 *     dM = dt (k_b (w - (w.e) e) + k_t (w.e) e),     w = w_j - w_i.
 * a is the share of i in |d|, and v, w are those of the middle of the step, like d - dt/2 (v_j - v_i).
 * Neither needs the attitude of a sphere.  Force on i: F = N e + S; couples on i and j: a |d| e x F + M and
 * (1 - a) |d| e x F - M.  So forces and couples balance, and their power is that of N, S and M exactly.
 *
 * Strength, at the rim of the disc:
 *     sigma = N/A + beta |M_b| R/I,     tau = |S|/A + beta |M_t| R/J,
 *     lambda^2 = (<sigma>/(s sigma_t))^2 + (tau/(s c + mu_i p))^2,     p = <-N/A>.
 * M_t is the part of M along e, M_b the rest; beta = 1 is the parallel bond, 0 leaves moments out; mu_i is 0
 * unless asked for, as ice held at its sides then could not fail in its plane; s is the scatter of this bond.
 * Sources: Potyondy & Cundall, Int. J. Rock Mech. Min. Sci. 41 (2004) 1329; beta: Potyondy, Geosystem Eng. 18
 * (2015) 1.
 *
 * Damage.  From lambda = 1 on tension, shear and moments are multiplied by
 *     g = (f - L)/((f - 1) L),     L = largest lambda so far,
 * the whole disc at once: the force falls linearly with the separation up to f times that of the peak, where
 * the bond breaks for good; unloading follows the secant.  Pressing is never damaged.  The fracture energy
 * per area is f sigma_t^2 l/(2 E).  Where f <= 1 the bond breaks at lambda = 1.  Source of f = 1.5: Di & Ji,
 * Chin. J. Theor. Appl. Mech. 46 (2014) 561, with the factor corrected to 1 at the peak.
 * Shear never falls below friction mu p A.  After the break the two are ordinary spheres in contact.
 *
 * Damping: a dashpot parallel to each spring, h times as large [s].
 *
 * Energy: (N^2/k_n + S^2/k_s + M_b^2/k_b + M_t^2/k_t)/2, all but N < 0 times g.  A step does the work
 * (F0 + F1).du/2; damage by g0 - g1 removes half of it times N0 N1/k_n + S0.S1/k_s + ..., the loss of the
 * store.  S and M are sums over steps: of order 2 in dt, but not a function of the pose as the face of
 * bond.h is. */
#ifndef FL_BOND_DISC_H
#define FL_BOND_DISC_H
#include "bond/disc_types.h"

/* Updates the memory over a step of dt [s] (0: only the forces) and returns the forces.  scatter: s.  The
 * disc is broken if m->lambda >= ductility (or >= 1) afterwards: then the forces are pressing and friction
 * alone. */
fl_disc_wrench fl_disc_force(const fl_disc_law *law, const fl_disc_class *c, double scatter,
                             const fl_disc_pose *at, double dt, fl_disc_memory *m);

/* Integrity g of the disc: the factor of tension, shear and moments, 1 without damage. */
double fl_disc_integrity(const fl_disc_class *c, double lambda);

/* True if the disc is broken. */
static inline int fl_disc_is_broken(const fl_disc_class *c, double lambda)
{
    return lambda >= 1.0 && lambda >= c->ductility;
}

/* Stored energy [J]. */
double fl_disc_energy(const fl_disc_class *c, const fl_disc_memory *m, fl_vec3 d);

/* N, |S|, |M| with damage, and the middle of the disc seen from the centre of i. */
typedef struct {
    double tension, shear, moment;
    fl_vec3 x;
} fl_disc_load;
fl_disc_load fl_disc_section_load(const fl_disc_law *law, const fl_disc_class *c, const fl_disc_memory *m,
                                  fl_vec3 d);

#endif
