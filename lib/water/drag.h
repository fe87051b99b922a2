/* SPDX-License-Identifier: GPL-3.0-or-later */
/* drag.h -- quadratic drag of water or air on a whole body. */
#ifndef FL_WATER_DRAG_H
#define FL_WATER_DRAG_H
#include "geom/poly.h"

/* A fluid: water on the wetted surface, air on the dry one. */
typedef struct {
    double density;            /* rho [kg/m^3] */
    double force_coefficient;  /* C_f, 0.005 for skin friction in water [-] */
    double moment_coefficient; /* C_m [-] */
} fl_fluid;

/* r_eff, the radius in the drag moment: that of the smallest sphere about the centre of mass that contains
 * the body, max |x_v| + dilation. (A 10 x 10 x 1 m box: sqrt(50.25) = 7.088723 m.)
 *   p   origin at the centre of mass [m];   dilation   0 for a sharp body [m] */
double fl_drag_radius(const fl_poly *p, double dilation);

/* Drag force and moment,
 *     F = -1/2 C_f rho A u |u|,   M = -1/2 C_m rho A r_eff^3 w |w|,
 * as decay: m du/dt = -c |u| u with c = C_f rho A / 2 [kg/m], and I dw/dt = -c |w| w with c = C_m rho A
 * r_eff^3 / 2 [kg m2] for rotation about an axis of moment of inertia I.
 *   area     surface in contact with the fluid              [m^2]
 *   radius   r_eff                                             [m]
 *   u        velocity of the body relative to the fluid      [m/s]
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

/* The factor from u(t) to u(t + dt) under m du/dt = -c |u| u alone, exact:
 *     m / (m + c |u| dt).
 * It lies in (0, 1] for any m > 0 and c |u| dt >= 0: drag slows a motion and never reverses it, for any step
 * and coefficient. It costs one division; the step calls it four times per body.
 *   m   mass or moment of inertia [kg] or [kg m2];   c   [kg/m] or [kg m2]
 *   speed   |u| [m/s] or [rad/s];                    dt  [s] */
static inline double fl_drag_decay_factor(double m, double c, double speed, double dt)
{
    return m / (m + c * speed * dt);
}

#endif
