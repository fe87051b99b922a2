/* SPDX-License-Identifier: GPL-3.0-or-later */
/* force_sum.h -- sums over the patch points of a contact from which its force and torque follow, four points
 * at a time.
 *
 * For each point, in the frame of B: arm is its offset from the first point; n and du as in fl_patch_point, t
 * the unit normal; e = du n.t its share of the pressure; c its approach speed.
 *     gradient              sum of du n and of arm x du n: force and moment over dW/dU
 *     du, du_approach       sum of du, and of du c where c > 0: their ratio is the approach speed for damping
 *     pressure, .._moment   sums of e and of e arm;  second: of e arm arm^T;  pressure_rate: of e c
 *     f                     max(0, e (1 + chi (c + speed_offset))): damped pressure of a point, never tension
 *     damped_pressure, ..   sums of f, f t and f arm
 *     damping               sum of (f - e) t and of arm x (f - e) t: what damping adds
 * Rim forces (u = 0) count in `gradient` alone.
 *
 * An area is represented by three points, any three with its sum, mean and second moments.  Sums that are
 * linear in c are the same for all such points.  The others must not depend on the choice.  So du_approach,
 * where an area approaches only in part, and f, where it would pull in part, use four points: two with the
 * largest and the least c, two with the mean. */
#ifndef FL_PATCH_FORCE_SUM_H
#define FL_PATCH_FORCE_SUM_H
#include "base/simd.h"
#include "geom/sym3.h"
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

/* The sums; over dW/dU they are forces and moments.  Moments are about the first point. */
typedef struct {
    double u, ddu;           /* sums of u and of ddu                          [m6], [m4] */
    double overlap;          /* the largest                                          [m] */
    double du, du_approach;  /* sum of du, and of du c where c > 0          [m5], [m6/s] */
    double pressure;         /* sum of e                                            [m5] */
    fl_vec3 pressure_moment; /* sum of e arm                                        [m6] */
    fl_sym3 second;          /* sum of e arm arm^T                                  [m7] */
    double pressure_rate;    /* sum of e c                                        [m6/s] */
    fl_wrench gradient;      /* force and moment                              [m5], [m6] */
    double damped_pressure;  /* sum of f                                            [m5] */
    fl_vec3 direction;       /* sum of f t                                          [m5] */
    fl_vec3 damped_moment;   /* sum of f arm                                        [m6] */
    fl_wrench damping;       /* what damping adds                             [m5], [m6] */
} fl_force_sum;

/* Sets the sums that do not depend on motion.  -1 when memory runs out. */
int fl_force_sum_elastic(fl_patch_points *s, fl_force_sum *q);

/* Sets du_approach and pressure_rate of the same points.
 *   v, spin   velocity and angular velocity of A relative to B at the first point [m/s], [rad/s]
 * -1 when memory runs out. */
int fl_force_sum_motion(fl_patch_points *s, fl_vec3 v, fl_vec3 spin, fl_force_sum *q);

/* Sum of e c^2, after fl_force_sum_motion() [m7/s2]. */
double fl_force_sum_square(const fl_patch_points *s);

/* Sets damped_pressure, direction, damped_moment and damping, after fl_force_sum_motion().
 *   chi            damping coefficient [s/m]
 *   speed_offset   added to the approach speed of every point [m/s]
 *   whole_share    lambda of law/damping.h: the share of the approach `whole`, in place of its own, that a
 *   point has
 */
void fl_force_sum_damping(const fl_patch_points *s, double chi, double speed_offset, double whole_share,
                          double whole, fl_force_sum *q);

/* Springs ddu along the unit normal of each point, rim forces left out, after fl_force_sum_elastic() [m4]. */
void fl_force_sum_springs(const fl_patch_points *s, fl_spring_sums *q);

/* Moments of the pressures e, whatever the motion; t unit normal, m = arm x t. */
enum { FL_PRESSURE_MATRIX = 21 };
typedef struct {
    double pressure;           /* sum of e [m5] */
    fl_vec3 direction, torque; /* sums of e t and of e m */
    fl_vec3 centre;            /* mean of arm, weighted by e [m] */
    /* Sum of e (t, m) (t, m)^T, the upper triangle row by row.  For the velocity v of A at the first point
     * and its spin, and without tension, damping adds -chi damping (v, spin). */
    double damping[FL_PRESSURE_MATRIX];
    double radius; /* root mean square of |arm - centre|, weighted by e [m] */
} fl_pressure_moments;

/* After fl_force_sum_elastic(). */
void fl_force_sum_pressure(const fl_patch_points *s, fl_pressure_moments *q);

/* Approach speed at point k, after fl_force_sum_motion() [m/s]. */
double fl_force_sum_approach_speed(const fl_patch_points *s, int32_t k);

#endif
