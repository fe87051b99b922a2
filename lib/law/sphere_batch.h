/* SPDX-License-Identifier: GPL-3.0-or-later */
/* sphere_batch.h -- contacts of two spheres, evaluated many at a time: Hertz or linear with the damping of Hunt and
 * Crossley along the normal (normal.h), and a friction spring for a contact that is a point (tangent.h).
 *
 *     D = x_i - x_j,  n = D/|D|,  overlap s = r_i + r_j - |D| > 0,
 *     arms a_i = r_i - s/2, a_j = r_j - s/2 from the centres to the middle of the overlap,
 *     F_e = k s^n, n = 3/2 or 1,  W = k s^(n+1)/(n+1),  chi = D_0 / max(v_touch, c sqrt(2 W / M)),
 *     F_n = F_e (1 + chi d) >= 0,  d the approach speed,
 *     v_t = (v_i - v_j) - (a_i w_i + a_j w_j) x n,
 *     k_t = c_t dF_e/ds,  g = c_t chi F_e,  F_t by tangent.h with the spin 1/2 n.(w_i + w_j);
 *     force on i F_n n + F_t, torques -a_i n x F_t and -a_j n x F_t.
 *
 * Damping uses the speeds at the end of the step: d by fl_damping_end_speed(), friction as
 * fl_tangent_damping() with a number in place of its P, 1/m + a^2/I of both spheres.  Both arms a are taken
 * as the same fraction of the radius.  F_e of the step before is that of the overlap before the approach of
 * this step. */
#ifndef FL_LAW_SPHERE_BATCH_H
#define FL_LAW_SPHERE_BATCH_H
#include <stdalign.h>
#include <stdint.h>
#include "law/rolling.h"

/* Contacts of a batch.  Members are written one by one and read eight at a time: a batch is large enough that
 * the writes have reached the first-level cache by then, and small enough that all of it is still there. */
enum { FL_SPHERE_BATCH = 24 };

/* One array for each quantity; vectors are x, y, z. */
typedef struct {
    /* in */
    double exponent; /* n of F_e = k s^n: 3/2, or 1 */
    alignas(64) double d[3][FL_SPHERE_BATCH]; /* D                             [m]     */
    double u[3][FL_SPHERE_BATCH];             /* v_i - v_j                                [m/s]   */
    double wi[3][FL_SPHERE_BATCH];            /* angular velocities                       [rad/s] */
    double wj[3][FL_SPHERE_BATCH];
    double ri[FL_SPHERE_BATCH]; /* radii                                    [m]     */
    double rj[FL_SPHERE_BATCH];
    double du[3][FL_SPHERE_BATCH];            /* predicted change until the end of the step of u, and  */
    double rdw[3][FL_SPHERE_BATCH];           /* of r_i w_i + r_j w_j, velocity_predictor.h    [m/s]   */
    double inv_mass[FL_SPHERE_BATCH];         /* 1/M = 1/m_i + 1/m_j                      [1/kg]  */
    double inv_mass_tangent[FL_SPHERE_BATCH]; /* the same across n                         [1/kg]  */
    double inv_inertia[FL_SPHERE_BATCH];      /* r_i^2/I_i + r_j^2/I_j                    [1/kg]  */
    double contact_count[FL_SPHERE_BATCH];    /* number in line, fl_effective_contact_count() */
    double slow_inv_mass[FL_SPHERE_BATCH];    /* c^2/M, damping.h                         [1/kg]  */
    double k[FL_SPHERE_BATCH];                /*                                          [N/m^1.5] */
    double friction[FL_SPHERE_BATCH];         /* mu                                               */
    double tangential[FL_SPHERE_BATCH];       /* c_t                                              */
    double impact_damping[FL_SPHERE_BATCH];   /* D_0                                              */
    /* in and out */
    double max_approach_speed[FL_SPHERE_BATCH]; /* v_touch, updated                         [m/s]   */
    double spring_force[3][FL_SPHERE_BATCH];    /* force of the friction spring             [N]     */
    double spring_stiffness[FL_SPHERE_BATCH];   /* k_t at the last step                     [N/m]   */
    double friction_force[3][FL_SPHERE_BATCH];  /* F_t                                      [N]     */
    double normal_damping[FL_SPHERE_BATCH];     /* F_n - F_e                                [N]     */
    /* out */
    double n[3][FL_SPHERE_BATCH];             /* n; (0, 0, 1) where the centres coincide          */
    double overlap[FL_SPHERE_BATCH];          /* s                                        [m]     */
    double slope[FL_SPHERE_BATCH];            /* dF_e/ds                                  [N/m]   */
    double elastic[FL_SPHERE_BATCH];          /* F_e                                      [N]     */
    double damping_factor[FL_SPHERE_BATCH];   /* chi                                      [s/m]   */
    double elastic_force[3][FL_SPHERE_BATCH]; /* F_e n                                    [N]     */
    double damping_force[3][FL_SPHERE_BATCH]; /* (F_n - F_e) n                            [N]     */
    double ti[3][FL_SPHERE_BATCH];            /* torques of F_t, on i and j               [N m]   */
    double tj[3][FL_SPHERE_BATCH];
    double magnitude[FL_SPHERE_BATCH]; /* |F|                                            [N]     */
} fl_sphere_batch;

/* Additional input and state for rolling resistance, rolling.h. */
typedef struct {
    alignas(64) double arm[FL_SPHERE_BATCH]; /* R*                                       [m]     */
    double rolling[FL_SPHERE_BATCH];         /* mu_r                                             */
    double dw[3][FL_SPHERE_BATCH];           /* predicted change of w_i - w_j            [rad/s] */
    double inv_mass[FL_SPHERE_BATCH];        /* R*^2 (1/I_i + 1/I_j)                     [1/kg]  */
    double elastic[3][FL_SPHERE_BATCH];      /* in and out: as in fl_rolling_spring              */
    double spring_stiffness[FL_SPHERE_BATCH];
    double total[3][FL_SPHERE_BATCH];
} fl_sphere_rolling_batch;

/* Evaluates the first m contacts over a step of dt [s].  half: half of the step, for the implicit damping
 * [s]. The bits of a contact depend neither on the other contacts nor on the width of the registers. */
void fl_sphere_batch_evaluate(fl_sphere_batch *b, int32_t m, double dt, double half);

/* Restores n, overlap, slope, elastic, forces, torques and magnitude from d, radii, k, friction_force and
 * normal_damping, to the same bits. */
void fl_sphere_batch_restore(fl_sphere_batch *b, int32_t m);

/* After either of these: evaluates the rolling resistance and adds its moments to the torques; or only
 * adds. */
void fl_sphere_batch_rolling(fl_sphere_batch *b, fl_sphere_rolling_batch *r, int32_t m, double dt,
                             double half);
void fl_sphere_batch_add_rolling(fl_sphere_batch *b, const fl_sphere_rolling_batch *r, int32_t m);

#endif
