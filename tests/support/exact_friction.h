/* SPDX-License-Identifier: GPL-3.0-or-later */
/* exact_friction.h -- Coulomb's friction of a flat face under an even pressure, and motion under it: what
 * law/tangent.h is compared with.
 *
 *     u(x) = v + w z x x,     F = mu int p u/|u| dA,     M = mu int p (x x u/|u|)_z dA,     P = mu int p |u|
 *     dA
 *
 * F and M oppose the motion; the signs here are those of v and w.  The gradient of P over (v, w) is (F, M),
 * so P = F.v + M w.  All three are over mu N. */
#ifndef FL_TESTS_EXACT_FRICTION_H
#define FL_TESTS_EXACT_FRICTION_H
#include "geom/sym3.h"

/* A wrench in the plane z = 0. */
typedef struct {
    double x, y, m;
} flat_wrench;

/* Disc of radius 1 at the ratio e = v/w, by elliptic integrals (Farkas, Bartels, Unger & Wolf, Phys. Rev.
 * Lett. 90 (2003) 248302): F along v and M. */
void exact_disc_friction(double e, double *F, double *M);

/* Polygon of n corners, counter-clockwise, z ignored; v, w about the origin. */
flat_wrench exact_polygon_friction(int n, const fl_vec3 *corner, fl_vec3 v, double w);

/* Mean distance of the points of a polygon from the origin. */
double polygon_mean_distance(int n, const fl_vec3 *corner);

/* Second moments over the area of a polygon about its centre; the centre. */
fl_sym3 polygon_second_moments(int n, const fl_vec3 *corner, fl_vec3 *centre);

/* What the law gives for steady motion of a contact with the second moments C across z. */
flat_wrench law_friction(fl_sym3 C, fl_vec3 v, double w);

/* A plate on a floor that slides and spins until it stops. */
typedef struct {
    double time, angle; /* of the stop [s], [rad] */
    fl_vec3 x;          /* way [m] */
    double ratio;       /* v/w where sqrt(v^2 + w^2 I/m) falls to `slow` [m] */
    fl_vec3 v;          /* at the time `look` */
    double w;
} plate_stop;

/* Integrates m dv/dt = -mu m g F, I dw/dt = -mu m g M by Runge and Kutta's method.
 *   friction   F and M of the motion in the axes of the plate, with `context`
 *   mu_g       mu g [m/s2]
 *   gyration2  I/m [m2] */
plate_stop stop_of_plate(flat_wrench (*friction)(const void *context, fl_vec3 v, double w),
                         const void *context, double mu_g, double gyration2, fl_vec3 v, double w, double look,
                         double slow);

#endif
