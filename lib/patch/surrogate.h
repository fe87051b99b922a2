/* SPDX-License-Identifier: GPL-3.0-or-later */
/* surrogate.h -- force of a contact that has moved little, from its last exact evaluation.
 *
 * Finding the patch points of two faces takes microseconds, and they hardly change from step to step.  Their
 * force is the gradient of one energy W, which depends on six numbers only: the pose of A relative to B.
 * Between two exact evaluations a contact is therefore replaced by an expansion of W about the last one.  The
 * expansion is a potential too and conserves energy as the law does, but for the jump of W at the next exact
 * evaluation.  In the frame of B:
 *
 *     q = (u, l w)       u: path of a point of A in the contact since the exact evaluation, w: rotation of A,
 *                        half the skew part of D = M M0^T, l: a length of the contact                  [m]
 *     z = 1 + g.q + q.H q/2 + s^2 (t.q)/2 - s^3 (e.t)/3 + b s^2,     s = e.q,     W = W0 z^p
 *     e                  direction of the path, a unit vector;  t: third order along it;  W0: W at q = 0
 *     force on A -dW/du,  moment about the point -J^T dW/dw,  J = (tr D - D)/2 maps rotations to w
 *
 * Power p.  W grows with the power p of the overlap: 2 under a face, 9/4 along an edge, 5/2 at a corner.  It
 * follows from W W''/W'^2 = (p - 1)/p along the force.  Then z is nearly the overlap over that of the exact
 * evaluation and nearly linear in q, so the error is of high order in the curvature of z alone.
 *
 * Second order H.  The patch points give one part of H (fl_force_sum_springs()).  The rest comes from points
 * that move along the surfaces.  It is learnt from the slopes of z at the last exact evaluations, and
 * so is the third order t.  Bodies continue nearly along one line, with the direction e.  The last path was
 * h e, the one before it h' e.  Along them the slopes changed by r h and r' h' more than H predicts.  Where H
 * changes linearly
 *     t = 2 (r - r')/(h + h'),     H e lacks r + h t/2.
 * The third-order term above is the smallest symmetric tensor that maps (e, e) to t.  The smallest symmetric
 * matrix that maps e to what is lacking, r e^T + e r^T - (r.e) e e^T, is added to H (Powell 1970, in Rosen,
 * Mangasarian & Ritter, Nonlinear Programming, 31).  Where the two paths are not along one line t = 0 and H
 * lacks r.
 *
 * Range.  The path until the next exact evaluation follows from the error found at the last one.  The next
 * path may be reach s0 long, s0 the overlap at its start.  The force error grows as path^3, so
 *     reach = (path/s0) (0.15 tolerance/error)^(3/8),
 * path and s0 of the last path.  3/8 stands for 1/3 because it needs square roots only.  Where t is not known
 * the error grows as path^2 and the exponent is 1/2.  One evaluation changes reach by a factor from 0.2 to 3.
 *     error: (force error, moment error / l), divided by the force.  While the bodies approach or separate,
 *            divided by the force at the energy of the contact plus that of this motion.
 * The error is measured at the end of each path, where it is largest.  Besides:
 *   - z changes by 3/2 tolerance^(1/4) at most.
 *   - A rotation brings a corner without pressure nearer by at most FREE_TURN_SHARE (surrogate.c) of the
 *     radii.  Sliding convex bodies have no point deeper than predicted; rotating ones may have.
 *   - A path along a plane does not count: it changes nothing.
 *   - Where an error is far above the tolerance the contact has become another one: what was learnt is
 *     dropped, and the earlier evaluations too, unless the error is explained by a path beyond the range.
 *   - A contact has no surrogate where its pressures oppose each other, as in a slot: their sum is not their
 *     force.
 *
 * Energy defect.  At an exact evaluation W jumps by the error of the surrogate, as a rule with the same sign
 * in every impact, since the omitted terms are of even order.  The jumps since the bodies touched are
 * returned over the next path, together with the jump expected at its end (from the last path, by the fourth
 * power): b = defect/(p W0 (reach s0)^2), limited to half of the tolerance of the force.  The surrogate gives
 * no force at the step of an exact evaluation.  In a path of n steps this overstates the defect by the
 * fraction 2/n.
 *
 * Stiffness for friction.  dF/ds = p (p - 1) W (dz/ds)^2/z^2 along the force and F = p W (dz/ds)/z, so dF/ds
 * goes as F^2/W.  It is multiplied by 1 + c s, at least 1/2, c from the error found at the last exact
 * evaluation over the path.  Friction springs lose energy wherever dF/ds is predicted too high; without c the
 * loss over a path does not shrink with the number of evaluations.
 *
 * Damping and friction use the points of the last exact evaluation, with all their pressures times one factor
 * that gives the surrogate's force.  These points rotate with the force and move to its line of action.
 * Damping is then linear in the motion of A, six by six numbers, unless it would turn pressures into
 * tension.  For that correction mean and variance are known; width and skewness of the distribution are those
 * of the exact evaluation (no_tension.h). */
#ifndef FL_PATCH_SURROGATE_H
#define FL_PATCH_SURROGATE_H
#include <stddef.h>
#include <stdint.h>
#include "geom/lanes.h"
#include "geom/mat3.h"
#include "law/tangent.h"
#include "patch/force_sum.h"

/* Three numbers of a force or a path, three of a moment or a rotation; the last two are 0. */
typedef double fl_vec6[8];

/* Index of entry (r, c) of a symmetric 6 by 6 matrix in its upper triangle, row by row. */
static const uint8_t FL_UPPER[6][6] = {{0, 1, 2, 3, 4, 5},     {1, 6, 7, 8, 9, 10},
                                       {2, 7, 11, 12, 13, 14}, {3, 8, 12, 15, 16, 17},
                                       {4, 9, 13, 16, 18, 19}, {5, 10, 14, 17, 19, 20}};

#define FL_SURROGATE_MAX_REACH 1000.0 /* largest reach */
#define FL_SURROGATE_TURN_WEIGHT 4.0  /* weight of rotations in a path */

/* An earlier exact evaluation. */
typedef struct {
    fl_vec6 slope, path; /* of W over q [N]; from there to the next exact evaluation [m] */
    double energy;       /* W [J]; 0: none */
} fl_surrogate_record;

/* The surrogate of one contact.  Zeroed: none. */
typedef struct {
    int valid; /* may be evaluated */
    int used;  /* has been evaluated since the last exact evaluation */
    /* Of the last exact evaluation.  Doubles only from here on, which fl_surrogate_pack() reads in a row. */
    double g[6], H[21];                       /* H: upper triangle                         [1/m], [1/m2] */
    double path_direction[6], third_order[6]; /* e, t                                        [1], [1/m3] */
    double slope_trend;                       /* c                                                 [1/m] */
    fl_mat3 M;                                /* axes of A                                               */
    fl_vec3 o;                                /* origin of A                                         [m] */
    fl_vec3 point;                            /* point of A in the contact, frame of B               [m] */
    double counts_along_plane; /* 1, or 0 where B is a plane: then the path along it does not count */
    double overlap, energy, force, slope; /* largest overlap [m], W [J], |dW/du| [N], dF/ds [N/m] */
    double power;                         /* p                                                       */
    fl_vec3 first_point; /* first patch point, frame of B                                 [m] */
    fl_vec3 centre;      /* from there to the centre of the force, in its plane           [m] */
    fl_vec3 other_force; /* part of the force that is not pressure                        [N] */
    double pressure;     /* sum of the pressures                                      [N] */
    double inv_mass;     /* as in fl_exact_contact                                     [1/kg] */
    fl_sym3 compliance;
    double turn_compliance;             /*                              [1/(kg m2)] */
    fl_vec3 direction, torque;          /* as in fl_pressure_moments, times dW/dU  */
    double damping[FL_PRESSURE_MATRIX]; /* likewise                                */
    double arm;                         /* shape of the pressures, patch_result.h, [m] */
    fl_vec3 elongation;                 /* in the frame of B                           */
    fl_vec3 centre_offset;              /* of the mean of the pressures from where they act      [m] */
    double half_width, skewness;        /* of no_tension.h; half width over the standard deviation */
    /* Since the bodies touched. */
    fl_vec3 point_a;                 /* the point, frame of A                             [m] */
    double length;                   /* l                                                 [m] */
    double reach;                    /* largest path until the next exact evaluation, over the overlap */
    double max_change;               /* largest change of z                                   */
    double stiffness_i, stiffness_j; /* as in fl_pair, over the slope, when last computed [1/kg] */
    /* Not packed. */
    fl_vec6 learnt[6];            /* learnt part of H, times p W over the force         [1/m] */
    fl_surrogate_record previous; /* the exact evaluation before the last one                 */
    double energy_defect;         /* sum of the jumps of W not yet returned               [J] */
    double defect_return;         /* b                                                 [1/m2] */
    double free_path;             /* path before another wall of B may carry load         [m] */
    double free_turn;             /* l |w| before another corner of A may touch           [m] */
} fl_surrogate;

/* Value of a surrogate in one pose. */
typedef struct {
    fl_vec6 q, slope_z; /* q [m]; dz/dq [1/m] */
    double path;        /* |u| + FL_SURROGATE_TURN_WEIGHT l |w| [m] */
    double turn;        /* l |w| [m] */
    double z;
    fl_vec3 point, w;
    fl_wrench gradient;         /* force and moment on A, about `point`, frame of B */
    double energy, force_ratio; /* W; force over that of the exact evaluation */
    double slope;               /* dF/ds along the force [N/m] */
} fl_surrogate_value;

/* A batch of surrogates, one array a number. */
enum {
    FL_SURROGATE_BATCH = FL_LANE_COUNT,
    /* rounded up to groups of four, the last of which may reach into `learnt` */
    FL_SURROGATE_ROWS =
        ((offsetof(fl_surrogate, learnt) - offsetof(fl_surrogate, g)) / sizeof(double) + 3) / 4 * 4
};
typedef struct {
    _Alignas(64) fl_lane s[FL_SURROGATE_ROWS]; /* the surrogates */
    fl_lane M[9], o[3];                        /* in: pose of A in the frame of B, M row by row */
    /* out: fl_surrogate_value */
    fl_lane q[6], slope_z[6], path, turn, z, point[3], w[3], f[3], m[3], energy, force_ratio, slope;
} fl_surrogate_lanes;

/* Row of a member in fl_surrogate_lanes.s. */
#define FL_SURROGATE_ROW(member)                                                                             \
    ((offsetof(fl_surrogate, member) - offsetof(fl_surrogate, g)) / sizeof(double))

/* Result of an exact evaluation.  The gradient in `sums` includes the couple of the points. */
typedef struct {
    const fl_mat3 *M; /* pose of A in the frame of B */
    fl_vec3 o;
    fl_vec3 first;                       /* the first point, about which moments are [m] */
    const fl_pressure_moments *pressing; /* of the points */
    const fl_force_sum *sums;
    const fl_spring_sums *springs; /* of the points */
    double scale, energy, slope;   /* dW/dU; W and slope as in fl_surrogate */
    double inv_mass;               /* fl_pair_compliance() where both bodies are free [1/kg] */
    fl_sym3 compliance;            /* as in fl_friction_contact, at the centre of the pressures, frame of B */
    double turn_compliance;
    double radii;                    /* sum of the dilation radii [m] */
    double free_path;                /* fl_mesh_contact_free_travel(); INFINITY where B is convex [m] */
    double radius_a;                 /* of A about o [m] */
    int b_is_plane;                  /* B is a plane across z */
    double motion_force;             /* force that the energy of the motion gives, over the force */
    double stiffness_i, stiffness_j; /* 0: not computed [1/s2] */
    fl_vec3 v, spin;                 /* of A relative to B at the first point, frame of B [m/s], [rad/s] */
    /* arguments of fl_force_sum_damping() [s/m], [m/s]; 0 where damping is not that of points */
    double impact_damping, speed_offset;
} fl_exact_contact;

/* Statistics, one for each thread. */
typedef struct {
    _Alignas(64) int64_t hits; /* evaluations by the surrogate */
    int64_t checks;            /* exact evaluations within twice the reach */
    int64_t misses;            /* checks with an error above the tolerance */
    double worst_error;        /* largest error of a check */
} fl_surrogate_count;

/* Vector, in the plane across the force f, to the line on which f acts, from the point of the moment m [m].
 */
static inline fl_vec3 fl_surrogate_force_centre(fl_vec3 f, fl_vec3 m)
{
    return v3_scale(1.0 / v3_norm2(f), v3_cross(f, m));
}

/* Largest change of z for a tolerance of the force. */
static inline double fl_surrogate_max_change(double tolerance) { return 1.5 * sqrt(sqrt(tolerance)); }

/* Sum of the statistics of all threads. */
fl_surrogate_count fl_surrogate_count_sum(const fl_surrogate_count *count, int32_t threads);

/* Packs n <= FL_SURROGATE_BATCH surrogates; further lanes repeat the first. */
void fl_surrogate_pack(fl_surrogate_lanes *b, const fl_surrogate *const *s, int n);

/* Evaluates the batch at the poses b->M, b->o, given as in fl_patch_points_transform(). */
void fl_surrogate_evaluate(fl_surrogate_lanes *b);

/* Value of lane k. */
fl_surrogate_value fl_surrogate_unpack(const fl_surrogate_lanes *b, int k);

/* True if a value is within `reaches` times the range of the surrogate; 1: it may be used. */
static inline int fl_surrogate_in_range(const fl_surrogate *s, double path, double turn, double z,
                                        double reaches)
{
    const double far = s->reach * s->overlap;
    return path <= reaches * (far < s->free_path ? far : s->free_path) && turn <= reaches * s->free_turn &&
           z > 1.0 - s->max_change && z < 1.0 + s->max_change;
}

/* True if the error of this value allows an estimate of the error within the range. */
static inline int fl_surrogate_in_double_range(const fl_surrogate *s, const fl_surrogate_value *value)
{
    return fl_surrogate_in_range(s, value->path, value->turn, value->z, 2.0);
}

/* Updates the surrogate after an exact evaluation.
 *   value       of s in this pose, NULL where it was not valid
 *   tolerance   of the force, relative
 * Returns the error of the value, relative to the force. */
double fl_surrogate_update(fl_surrogate *s, const fl_surrogate_value *value, const fl_exact_contact *seen,
                           double tolerance);

/* Sets the members that follow from the exact evaluation alone.  point_a, length, reach, what was learnt,
 * path, third_order, defect_return and the stiffness are given: for a snapshot that is read. */
void fl_surrogate_set(fl_surrogate *s, const fl_exact_contact *seen);

#endif
