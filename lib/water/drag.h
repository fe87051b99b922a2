/* SPDX-License-Identifier: GPL-3.0-or-later */
/* drag.h -- drag of water or air on one body: the manual's quadratic laws. */
#ifndef FL_WATER_DRAG_H
#define FL_WATER_DRAG_H
#include "geom/poly.h"

/* What drags: water on the wetted surface, air on the dry one. */
typedef struct {
    double density;            /* rho                                     [kg/m^3] */
    double force_coefficient;  /* C of the force, 0.005 for skin on water      [-] */
    double moment_coefficient; /* C of the moment                              [-] */
} fl_fluid;

/* r_eff, the radius at which spin meets the fluid: that of the smallest sphere about the centre of mass that
 * holds the body, max |x_v| + dilation.  (A 10 x 10 x 1 m box: sqrt(50.25) = 7.088723 m.)
 *   p   origin at the centre of mass [m];   dilation   0 for a sharp body [m] */
double fl_drag_radius(const fl_poly *p, double dilation);

/* Force and moment of the manual's equations (8) and (9),
 *     F = -1/2 C_f rho A u |u|,   M = -1/2 C_m rho A r_eff^3 w |w|,
 * as decay: m du/dt = -c |u| u with c = C_f rho A / 2 [kg/m], and I dw/dt = -c |w| w with
 * c = C_m rho A r_eff^3 / 2 [kg m2] for spin about an axis of moment of inertia I.
 *   area     of the surface that touches the fluid          [m^2]
 *   radius   r_eff                                             [m]
 *   u        velocity of the body in the fluid, v - v_w      [m/s]
 *   w        angular velocity                              [rad/s]
 * Source: DilatedDEM manual (2016), eqs. (8), (9). */
static inline double fl_drag_force_constant(const fl_fluid *fluid, double area)
{
    return 0.5 * fluid->force_coefficient * fluid->density * area;
}
static inline double fl_drag_moment_constant(const fl_fluid *fluid, double area, double radius)
{
    return 0.5 * fluid->moment_coefficient * fluid->density * area * radius * radius * radius;
}

/* The factor that takes u(t) to u(t + dt) under m du/dt = -c |u| u alone, exactly:
 *     m / (m + c |u| dt).
 * It lies in (0, 1] for any m > 0 and c |u| dt >= 0: drag slows a motion and never turns it round, however
 * large the step or the coefficient.  (One division: it is asked for four times a step.)
 *   m   what is slowed down [kg] or [kg m2];   c   [kg/m] or [kg m2]
 *   speed   |u| [m/s] or [rad/s];              dt  [s] */
static inline double fl_drag_decay_factor(double m, double c, double speed, double dt)
{
    return m / (m + c * speed * dt);
}

#endif
