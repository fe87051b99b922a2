/* SPDX-License-Identifier: GPL-3.0-or-later */
/* facet_drag.h -- skin and form drag on the wetted (or dry) surface of a solid, piece by piece.
 *
 * A piece of surface of area a and outward normal n that moves with u through the fluid feels
 *     skin   -1/2 rho C_s a |u_t| u_t,          u_t = u - (u.n) n
 *     form   -1/2 rho C_f a (u.n)^2 n           on the front side, u.n > 0
 * together -D(u) u with D = 1/2 rho a (C_s |u_t| (1 - n n^T) + C_f max(u.n, 0) n n^T), symmetric and positive
 * semidefinite. With y = (v, w) of the body, u = J y - U at each piece, J y = v + w x r,
 *     M dy/dt = - sum J^T D(u) (J y - U).
 * The step is implicit in y, with D at the start of the step:
 *     (M + h K) y' = M y + h sum J^T D U,   K = sum J^T D J.
 * K is positive semidefinite. So for any h and any coefficient the kinetic energy relative to the fluid
 * decreases, and no motion along one direction reverses. For a single direction y' = y / (1 + h kappa |y|) is
 * the exact decay. An explicit step would be unstable for thin floes, no exact step exists, and a symmetric
 * one (Crank and Nicolson) does not keep the sign. The order is 1 where several directions couple, and exact
 * along one.
 *
 * In the plane of a facet, r = c n + x e + y g (facet_cut.h), rows of J are (e, c g - y n), (g, x n - c e)
 * along it and (n, y e - x g) across. So K needs only moments: of s = 1/2 rho C_s a |u_t| up to the first and
 * that of x^2 + y^2, and of f = 1/2 rho C_f a max(u.n, 0) up to the second:
 *     vv   s (1 - n n) + f n n
 *     wv   (f_y e - f_x g) n - n (s_y e - s_x g) + c s [n]
 *     ww   c^2 s (1 - n n) + (s_xx + s_yy) n n - c (n q + q n),                    q = s_x e + s_y g
 *          + f_yy e e - f_xy (e g + g e) + f_xx g g
 * with a b the dyad a b^T and [n] a = n x a. The sums of D U likewise need those of s U_e, s U_g, f U_n, s (x
 * U_g - y U_e) and f U_n (x, y). Source: Hoerner, Fluid-Dynamic Drag (1965), for skin and form drag; the rest
 * is derived here. */
#ifndef FL_WATER_FACET_DRAG_H
#define FL_WATER_FACET_DRAG_H
#include "body/body_batch.h"
#include "water/facet_cut.h"

/* Drag along a facet and normal to it: 1/2 rho C_s, 1/2 rho C_f [kg/m3]. */
typedef struct {
    double skin, form;
} fl_facet_drag_law;

/* Rows of the sums: h sum D U and h sum r x D U, then h K, its lower half row by row. */
enum { FL_DRAG_MATRIX = 6, FL_DRAG_SUMS = FL_DRAG_MATRIX + 21 };

/* Bodies of a batch, one array per quantity. */
typedef struct {
    _Alignas(64) double sum[FL_DRAG_SUMS][FL_BODY_BATCH];
    double mass[6]
               /* mass along and inertia about the body axes, added mass included [kg], [kg m2] */
               [FL_BODY_BATCH];
    double y[6][FL_BODY_BATCH]; /* velocity and angular velocity, body axes [m/s], [rad/s] */
} fl_facet_drag_batch;

/* Sums over the surface of body i moving at y. h: the step [s]. */
void fl_facet_drag_sum(fl_facet_drag_batch *a, int32_t i, const fl_facet_cut *s, fl_facet_drag_law law,
                       double h);

/* Takes the step of the bodies in `lanes` lanes, a multiple of FL_SIMD_WIDTH: y becomes y'. */
void fl_facet_drag_step(fl_facet_drag_batch *a, int32_t lanes);

/* Both for one body.
 *   mass, inertia  as above
 *   v, w           in, out: y */
void fl_facet_drag(const fl_facet_cut *s, fl_facet_drag_law law, fl_vec3 mass, fl_vec3 inertia, double h,
                   fl_vec3 *v, fl_vec3 *w);

#endif
