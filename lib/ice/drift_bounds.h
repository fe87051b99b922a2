/* SPDX-License-Identifier: GPL-3.0-or-later */
/* drift_bounds.h -- what bounds the load of drifting broken ice, and when it jams: closed forms to put beside
 * a run, ice-scenes(7).
 *
 * Symbols: C concentration, W width of the field across the drift [m], D width of the structure there [m], L
 * size of a floe [m], h thickness [m], v speed of the ice against the structure [m/s], e restitution.
 *
 * Jam.  Beside the structure the ice has a width W - D and a concentration C W / (W - D).  From 0.85 on, the
 * random packing of broken shapes, it does not pass: it stands, and the load is that of the walls and of the
 * inflow.  The edge of the jam goes upstream at v C / (0.85 - C).
 *
 * Drag on ice that is held up, area A:          F = rho_w C_w v^2 A / 2.
 * Momentum of ice that hits and passes, as in free drift, with s = rho_i h C the mass of ice over the area of
 * the sea:                                      F = (1 + e) s v^2 (D + L).
 * One floe of mass m that meets a narrow structure at an arm b, radius of gyration r about the vertical:
 *                                               I = (1 + e) m v / (1 + b^2 / r^2).
 * Brash of thickness H_M in a channel, a hull of length L, breadth B and draught T at 5 knots, by the
 * Finnish-Swedish ice class rules, in N and metres:
 *     R = 845 C_m (H_F + H_M)^2 (B + C_p H_F) + 42 L_p H_F^2 + 825 q A_wf / L,  H_F = 0.26 + sqrt(H_M B),
 * with C_m of at least 0.45, C_p = max(0, 0.047 psi - 2.115), q = (L T / B^2)^3 in 5 .. 20, L_p the length of
 * the parallel midbody, A_wf the water plane of the bow.
 * A load above the momentum of passing ice comes from ice that is held up: a jam, an arch between legs.
 *
 * Source: balances of momentum; 0.85 and the gaps that hold floes up are those of this product's runs and of
 * the literature of ice in channels, and uncertain by a tenth and a third. */
#ifndef FL_ICE_DRIFT_BOUNDS_H
#define FL_ICE_DRIFT_BOUNDS_H
#include <stdint.h>

/* Concentration from which broken ice does not pass. */
#define FL_JAM_CONCENTRATION 0.85

/* Gaps of the structure up to this many floe sizes hold the ice up: between 3 and 5 in model tests. */
#define FL_ARCH_SIZES 4.0

typedef struct {
    double lo, hi; /* [m] */
} fl_obstacle;

/* Join intervals that overlap or are less than `gap` apart; they are sorted and shortened in place.  Returns
 * their number, *width: the sum of their lengths. */
int32_t fl_join_intervals(int32_t n, fl_obstacle *a, double gap, double *width);

/* C W / (W - D); infinite where D is not below W. */
double fl_concentration_beside(double concentration, double field_width, double structure_width);

/* Width of the field above which it does not jam, D / (1 - C / 0.85) [m]; infinite from 0.85 on. */
double fl_width_needed(double concentration, double structure_width);

/* The loads above [N]; mass_per_area: s [kg/m2]. */
double fl_drag_of_held_ice(double water_density, double coef, double speed, double area);
double fl_momentum_load(double restitution, double mass_per_area, double speed, double width);

/* R [N]; C_m, C_p, q and L_p, A_wf / L [m] as above.  C_m = 0.45 and the others 0 give the least that any
 * hull of this breadth has. */
double fl_brash_load(double thickness, double breadth, double cm, double cp, double parallel, double q,
                     double bow_area_over_length);

/* I [N s]. */
double fl_floe_impulse(double restitution, double mass, double speed, double arm, double gyration);

#endif
