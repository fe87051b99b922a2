/* SPDX-License-Identifier: GPL-3.0-or-later */
/* force_sum.h -- the sums over the places of a contact that its forces are made of, several places at a time.
 *
 * With du the pull of a place on U along n, e = du n.across its share of the pressure, c the speed at which
 * the bodies approach there, and arm its offset from the first place, all in the frame of B:
 *     gradient      sum of du n and of arm x du n: the force of W over dW/dU
 *     pressed, met  sum of du, and of du c where c > 0: the speed that damping asks for
 *     middle, rate  sums of e arm and of e c
 *     f(e)          sum of f, f across, f arm and f |arm|^2, f = max(0, e (1 + chi (c + more))): what
 *                   presses, approaching everywhere by so much more than as it moves
 *     damping       sum of f - e times across and arm x across: what damping adds
 * The pull of rims, u = 0, is part of the gradient alone.
 *
 * Three places stand for an area, any three with its sum, mean and second moments, and sums that are linear
 * in c are the same for all of them.  What is not is made to hang on the area alone: `met`, where it
 * approaches in part, and f, where it would be pulled in part, are of four places, two where c is most and
 * least and two where it is the mean; of `spread` the third moment is left out. */
#ifndef FL_PATCH_FORCE_SUM_H
#define FL_PATCH_FORCE_SUM_H
#include "base/simd.h"
#include "patch/patch_types.h"
#include "patch/stiffness_bound.h"

/* Force and moment. */
typedef struct {
    fl_vec3 f, m;
} fl_wrench;

FL_SIMD_INLINE fl_wrench fl_wrench_madd(fl_wrench a, double s, fl_wrench b)
{
    return (fl_wrench){v3_madd(a.f, s, b.f), v3_madd(a.m, s, b.m)};
}

typedef struct {
    double u, ddu;           /* sums of u and of ddu                                    [m6], [m4] */
    double overlap;          /* the largest                                                    [m] */
    double du, du_approach;  /* [m5], [m6/s] */
    double pressure;         /* sum of e                                                      [m5] */
    fl_vec3 pressure_moment; /* sum of e arm                                                  [m6] */
    double pressure_rate;    /* sum of e c                                                  [m6/s] */
    fl_wrench gradient;      /* [m5], [m6] */
    double damped_pressure;  /* sum of f                                                      [m5] */
    fl_vec3 direction;       /* sum of f across                                               [m5] */
    fl_vec3 damped_moment;   /* sum of f arm                                                  [m6] */
    double damped_spread;    /* sum of f |arm|^2                                              [m7] */
    fl_wrench damping;       /* [m5], [m6] */
} fl_force_sum;

/* All but `met`, `rate` and the last five.  -1 when memory runs out. */
int fl_force_sum_elastic(fl_patch_points *s, fl_force_sum *q);

/* `met` and `rate` of the same places; v, turn: velocities of A against B at the first of them.  -1 when
 * memory runs out. */
int fl_force_sum_motion(fl_patch_points *s, fl_vec3 v, fl_vec3 turn, fl_force_sum *q);

/* The last five, after that; chi [s/m], more [m/s]. */
void fl_force_sum_damping(const fl_patch_points *s, double chi, double more, fl_force_sum *q);

/* ddu along `across` at arm of the places that press, after fl_force_sum_elastic() [m4]. */
void fl_force_sum_springs(const fl_patch_points *s, fl_spring_sums *q);

/* What presses, whatever moves: of e, n = across and t = arm x n
 *     direction, turning   sums of e n and of e t
 *     damping              of e (n, t) (n, t)^T, its upper triangle row by row: where A moves by v at the
 *                          first place and turns, and nothing would pull, damping adds -chi damping (v, turn)
 *     mean, wide           mean of arm, by e, and the root of that of |arm - mean|^2 */
enum { FL_PRESSURE_MATRIX = 21 };
typedef struct {
    double pressure; /* sum of e */
    fl_vec3 direction, torque, centre;
    double damping[FL_PRESSURE_MATRIX], radius;
} fl_pressure_moments;

/* After fl_force_sum_elastic(). */
void fl_force_sum_pressure(const fl_patch_points *s, fl_pressure_moments *q);

/* The speed at which the bodies approach at place k, after fl_force_sum_motion() [m/s]. */
double fl_force_sum_approach_speed(const fl_patch_points *s, int32_t k);

#endif
