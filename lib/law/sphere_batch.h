/* SPDX-License-Identifier: GPL-3.0-or-later */
/* sphere_batch.h -- the contact of two spheres, many at a time: Hertz with the damping of Hunt and Crossley along
 * the normal (normal.h), and the spring of tangent.h across it for a contact that is a point.
 *
 *     D = x_i - x_j,  n = D/|D|,  overlap s = r_i + r_j - |D| > 0,
 *     arms a_i = r_i - s/2, a_j = r_j - s/2 from the centres to the middle of the overlap,
 *     F_e = k s^(3/2),  W = 2/5 k s^(5/2),  chi = D_0 / max(v_touch, c sqrt(2 W / M)),
 *     F_n = F_e (1 + chi d) >= 0,  d the speed of approach,
 *     v_t = (v_i - v_j) - (a_i w_i + a_j w_j) x n,
 *     k_t = c 3/2 k sqrt(s),  g = c chi F_e,  F_t by tangent.h with the twist 1/2 n.(w_i + w_j),
 * force on i F_n n + F_t, torques -a_i n x F_t and -a_j n x F_t.
 *
 * Damping goes by the speeds of the end of the step: d by fl_damping_end_speed(), what rubs as in
 * fl_tangent_damping(), whose P is a number here, 1/m + a^2/I of both.  Of both a is taken to be the same
 * part of the radius.  F_e of the step before is that of the overlap which the approach in the mean of the
 * step has come from. */
#ifndef FL_LAW_SPHERE_BATCH_H
#define FL_LAW_SPHERE_BATCH_H
#include <stdalign.h>
#include <stdint.h>
#include "law/rolling.h"

/* What is written one by one is read eight at a time: by then it should have reached the fastest cache, and
 * all of it should still be there. */
enum { FL_SPHERE_BATCH = 24 };

/* One array a quantity.  Vectors are x, y, z. */
typedef struct {
    /* in */
    alignas(64) double d[3][FL_SPHERE_BATCH]; /* D                             [m]     */
    double u[3][FL_SPHERE_BATCH];             /* v_i - v_j                                [m/s]   */
    double wi[3][FL_SPHERE_BATCH];            /* angular velocities                       [rad/s] */
    double wj[3][FL_SPHERE_BATCH];
    double ri[FL_SPHERE_BATCH]; /* radii                                    [m]     */
    double rj[FL_SPHERE_BATCH];
    double du[3][FL_SPHERE_BATCH];  /* by how much u, and r_i w_i + r_j w_j, are foreseen to  */
    double rdw[3][FL_SPHERE_BATCH]; /* have changed by the end of the step, velocity_predictor.h    [m/s]   */
    double inv_mass[FL_SPHERE_BATCH];         /* 1/M = 1/m_i + 1/m_j                      [1/kg]  */
    double inv_mass_tangent[FL_SPHERE_BATCH]; /* the same across n                         [1/kg]  */
    double inv_inertia[FL_SPHERE_BATCH];      /* r_i^2/I_i + r_j^2/I_j                    [1/kg]  */
    double contact_count[FL_SPHERE_BATCH];    /* so many contacts in line, fl_effective_contact_count() */
    double slow_inv_mass[FL_SPHERE_BATCH];    /* c^2/M, damping.h                         [1/kg]  */
    double k[FL_SPHERE_BATCH];                /*                                          [N/m^1.5] */
    double friction[FL_SPHERE_BATCH];         /* mu                                               */
    double tangential[FL_SPHERE_BATCH];       /* c                                                */
    double impact_damping[FL_SPHERE_BATCH];   /* D_0                                              */
    /* in and out */
    double max_approach_speed[FL_SPHERE_BATCH]; /* v_touch, renewed with u_n                [m/s]   */
    double spring_force[3][FL_SPHERE_BATCH];    /* remembered force of the spring           [N]     */
    double spring_stiffness[FL_SPHERE_BATCH];   /* k_t that it was built with               [N/m]   */
    double friction_force[3][FL_SPHERE_BATCH];  /* F_t                                      [N]     */
    double normal_damping[FL_SPHERE_BATCH];     /* F_n - F_e                                [N]     */
    /* out */
    double n[3][FL_SPHERE_BATCH];             /* n; (0, 0, 1) where the centres are one           */
    double overlap[FL_SPHERE_BATCH];          /* s                                        [m]     */
    double slope[FL_SPHERE_BATCH];            /* 3/2 k sqrt(s)                            [N/m]   */
    double elastic[FL_SPHERE_BATCH];          /* F_e                                      [N]     */
    double damping_factor[FL_SPHERE_BATCH];   /* chi                                      [s/m]   */
    double elastic_force[3][FL_SPHERE_BATCH]; /* F_e n                                    [N]     */
    double damping_force[3][FL_SPHERE_BATCH]; /* (F_n - F_e) n                            [N]     */
    double ti[3][FL_SPHERE_BATCH];            /* torques of F_t, on i and j               [N m]   */
    double tj[3][FL_SPHERE_BATCH];
    double magnitude[FL_SPHERE_BATCH]; /* |F|                                            [N]     */
} fl_sphere_batch;

/* What such contacts need beside where something keeps them from rolling, rolling.h. */
typedef struct {
    alignas(64) double arm[FL_SPHERE_BATCH]; /* R*                                       [m]     */
    double rolling[FL_SPHERE_BATCH];         /* mu_r                                             */
    double dw[3][FL_SPHERE_BATCH];           /* by how much w_i - w_j is foreseen to change  [rad/s] */
    double inv_mass[FL_SPHERE_BATCH];        /* R*^2 (1/I_i + 1/I_j)                     [1/kg]  */
    double elastic[3][FL_SPHERE_BATCH];      /* in and out, as in fl_rolling_spring                        */
    double spring_stiffness[FL_SPHERE_BATCH];
    double total[3][FL_SPHERE_BATCH];
} fl_sphere_rolling_batch;

/* The first m contacts, over a step of dt [s]; half: of the step that damping is held back for [s].  Each has
 * bits of its own, whatever stands beside it and however wide the registers are. */
void fl_sphere_batch_evaluate(fl_sphere_batch *b, int32_t m, double dt, double half);

/* Where they stand alone: n, overlap, slope, elastic, push, damping, torques and size from d, radii, k, rub
 * and damped; the same bits. */
void fl_sphere_batch_restore(fl_sphere_batch *b, int32_t m);

/* Behind either: what keeps them from rolling, and its moments added to the torques; and these alone. */
void fl_sphere_batch_rolling(fl_sphere_batch *b, fl_sphere_rolling_batch *r, int32_t m, double dt,
                             double half);
void fl_sphere_batch_add_rolling(fl_sphere_batch *b, const fl_sphere_rolling_batch *r, int32_t m);

#endif
