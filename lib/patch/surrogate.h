/* SPDX-License-Identifier: GPL-3.0-or-later */
/* surrogate.h -- the force of a contact that has moved little, from what it was when last looked at.
 *
 * The places of a contact of faces take microseconds, and from one step to the next hardly anything about
 * them changes.  What they give, though, is the gradient of one energy W, and W hangs on six numbers alone:
 * on how A stands to B.  So between two looks a contact may be carried by an expansion of W, which is a
 * potential as well and keeps energy as the law does, but for what W differs by at the next look.
 *
 *     q = (u, a w)     way of a point of A in the contact since the look, and the turn of A: w is half the
 *                      skew part of D = M M0^T, a a length of the contact; frame of B            [m]
 *     z = 1 + g.q + q.H q/2 + s^2 (t.q)/2 - s^3 (e.t)/3 + b s^2,     s = e.q,     W = W0 z^p
 *     force on A -dW/du,  moment about the point -J^T dW/dw,  J = (tr D - D)/2 turns turns into w
 *
 * p is the power of the overlap that W grows with: 2 under a face, 9/4 along an edge, 5/2 at a corner, by
 * W W''/W'^2 = (p - 1)/p along the force.  Then z is nearly the overlap over that of the look and straight in
 * q, and what is left out is of a high order in the bends of z alone.
 *
 * H is what the places tell (fl_force_sum_springs()), and what they do not: how they move over the two bodies
 * as these slide and turn, some with A, some with B, some with where two edges cross.  That part is learnt,
 * as a part of the force, from the slopes of z at the last looks, and so is the third order.  Bodies go on in
 * nearly one line, along e: over the way h e to the last look, and h' e to it from the one before, slopes
 * changed by r h and r' h' more than H tells, and so
 *     t = 2 (r - r')/(h + h'),     H e misses r + h t/2,     where H changes linearly,
 * of which t takes the mixed part of the third order with it: the smallest symmetric tensor that takes
 * (e, e) to t is the one above.  To H the smallest symmetric matrix is added that takes e to what is missed,
 * r e^T + e r^T - (r.e) e e^T (Powell 1970, in Rosen, Mangasarian & Ritter, Nonlinear Programming, 31).
 * Where the two ways are not one line t is 0, and H misses r.
 *
 * How far a contact goes until the next look is chosen by what the last one found: the force is off as the
 * third power of the way, so reach = way (0.15 tolerance / off)^(3/8), 3/8 for 1/3; as its square, and 1/2,
 * where t is not known.  Off is the error of force and moment over a, over the force; while the bodies
 * approach or part, over the force that the energy of this motion would give.  It is measured at the end of
 * each way, where it is largest.  Besides, z changes by 3/2 tolerance^(1/4) at the most, and a turn brings
 * no corner that does not press nearer by more than a part of the radii: sliding convex bodies have no place
 * that is deeper than is foretold, turning ones may have.  What lies along a plane is no way: where over it A
 * stands changes nothing.  Where a look finds far more than was asked for, the contact has become another
 * one, and what was learnt is forgotten; so are the looks before it, unless it has only gone far past what it
 * might.  Nothing is told where pressures oppose each other, as in a slot: their sum is not their force.
 *
 * At a look W takes a step, by what was told wrong: as a rule with the same sign in every bounce, for what is
 * left out is of an even order.  So what has come together since the bodies touch is given back over the way
 * to come, forth or back, and what will come on that with it, as of the last way by its fourth power: b =
 * owed/(p W0 reach^2), by no more than half of the tolerance of the force.  No step
 * has felt the force that is told where a look is made instead, so that of a way of n steps 2/n too much is
 * counted as owed.
 *
 * dF/ds along the force is p (p - 1) W (dz/ds)^2 / z^2, and F = p W (dz/ds) / z: it goes as F^2/W, and
 * besides as 1 + c s, 1/2 at least, with c by what the last look found it told too low by, over the way.
 * Springs of friction lose something wherever it was told too high: without c as much over a path however
 * many looks this is cut by.  A second order of it changes nothing that can be seen.
 *
 * Damping and friction go by the places of the last look, all pressing as then, times one factor that gives
 * them the force that is told; as the force has turned since they all turn, and where force and moment put
 * the centre of the pressure elsewhere they are all moved there.  Then damping is linear in how A moves, six
 * by six numbers, but where it would turn pressures into pulls.  Of those mean and variance are known,
 * and how wide and how lopsided they are spread is that of the look (no_tension.h). */
#ifndef FL_PATCH_SURROGATE_H
#define FL_PATCH_SURROGATE_H
#include <stddef.h>
#include <stdint.h>
#include "geom/lanes.h"
#include "geom/mat3.h"
#include "law/tangent.h"
#include "patch/force_sum.h"

/* Three of a force or a way, three of a moment or a turn; the last two are 0. */
typedef double fl_vec6[8];

/* Where the entries of a symmetric matrix of six rows are in its upper triangle, row by row. */
static const uint8_t FL_UPPER[6][6] = {{0, 1, 2, 3, 4, 5},     {1, 6, 7, 8, 9, 10},
                                       {2, 7, 11, 12, 13, 14}, {3, 8, 12, 15, 16, 17},
                                       {4, 9, 13, 16, 18, 19}, {5, 10, 14, 17, 19, 20}};

#define FL_SURROGATE_MAX_REACH 1000.0 /* of reach */
#define FL_SURROGATE_TURN_WEIGHT 4.0  /* turns count so many times in a way */

/* A look that was. */
typedef struct {
    fl_vec6 slope, path; /* of W over q [N]; from there to the next look [m] */
    double energy;       /* W [J]; 0: none */
} fl_surrogate_record;

typedef struct {
    int valid; /* there is something to be asked */
    int used;  /* and it has been, since the last look */
    /* of the last look; from here on in doubles, which fl_surrogate_pack() takes in a row */
    double g[6], H[21];                   /* [1/m], [1/m2]; the upper triangle            */
    double path[6], third_order[6];       /* e, t                          [1], [1/m3]    */
    double slope_trend;                   /* c                                     [1/m] */
    fl_mat3 M;                            /* how A stood to B,                            */
    fl_vec3 o;                            /* and where                                [m] */
    fl_vec3 point;                        /* the point, frame of B                    [m] */
    double in_plane;                      /* 0 where B is a plane across z, else 1         */
    double overlap, energy, force, slope; /* the largest [m], W [J], its slope [N], dF/ds along it [N/m] */
    double power;                         /* p, by quarters                               */
    fl_vec3 first_point, centre;          /* the first place of what pressed, frame of B; from there, where
                                           * the force acts in its plane              [m] */
    fl_vec3 other_force;                  /* of the force, what is not pressures      [N] */
    double pressure;                      /* sum of its e                             [N] */
    double inv_mass;                      /* as in fl_exact_contact, with                   [1/kg] */
    fl_sym3 compliance;                   /* and                                          */
    double turn_compliance;               /*                                    [1/kg m2] */
    fl_vec3 direction, torque;            /* as in fl_pressure_moments, times dW/dU               */
    double damping[FL_PRESSURE_MATRIX], radius;
    fl_vec3 centre_offset;       /* of its mean over where they act              */
    double half_width, skewness; /* no_tension.h: a over the root of the variance, lean */
    /* since the bodies touch */
    fl_vec3 point_a;                 /* the point, frame of A                                 [m] */
    double length;                   /* a                                                     [m] */
    double reach;                    /* how far A may go until the next look, over the overlap    */
    double max_change;               /* by how much z may fall or rise                            */
    double stiffness_i, stiffness_j; /* as in fl_pair, over the slope; of the last survey  [1/kg] */
    /* what is not taken along */
    fl_vec6 learnt[6];            /* of H, times p W over the force                      [1/m] */
    fl_surrogate_record previous; /* the one before the last                                   */
    double energy_defect;         /* what looks found W to be more than it went by         [J] */
    double defect_return;         /* b                                                    [1/m2] */
    double free_path;             /* it may go as far before another wall of B may bear    [m] */
    double free_turn;             /* a |w| may become that before another corner of A may  [m] */
} fl_surrogate;

/* What one tells for a pose. */
typedef struct {
    fl_vec6 q, slope_z; /* [m]; dz/dq [1/m] */
    double path;        /* |u| + FL_SURROGATE_TURN_WEIGHT a |w| [m]  */
    double turn;        /* a |w| of it [m]  */
    double z;
    fl_vec3 point, w;
    fl_wrench gradient;         /* on A, about at, frame of B */
    double energy, force_ratio; /* force over that of the look */
    double slope;               /* dF/ds along it, as F^2/W [N/m] */
} fl_surrogate_value;

/* Several side by side, one array a number. */
enum {
    FL_SURROGATE_BATCH = FL_LANE_COUNT,
    /* of fours; of the last one some are of what is not asked for */
    FL_SURROGATE_ROWS =
        ((offsetof(fl_surrogate, learnt) - offsetof(fl_surrogate, g)) / sizeof(double) + 3) / 4 * 4
};
typedef struct {
    _Alignas(64) fl_lane s[FL_SURROGATE_ROWS]; /* surrogates, number by number     */
    fl_lane M[9], o[3];                        /* in: the pose of A in the frame of B, M row by row */
    fl_lane q[6], slope_z[6], path, turn, z, point[3], w[3], f[3], m[3], energy, force_ratio,
        slope; /* out: fl_surrogate_value */
} fl_surrogate_lanes;

/* Its place among the rows of s. */
#define FL_SURROGATE_ROW(member)                                                                             \
    ((offsetof(fl_surrogate, member) - offsetof(fl_surrogate, g)) / sizeof(double))

/* What a look has found.  The gradient has the couple of the places, too. */
typedef struct {
    const fl_mat3 *M; /* of A to B, with */
    fl_vec3 o;
    const fl_patch_points *points; /* after fl_force_sum_elastic() */
    const fl_force_sum *sums;
    const fl_spring_sums *springs; /* of the places */
    double scale, energy, slope;   /* dW/dU, W, and as in fl_surrogate */
    double inv_mass;               /* fl_pair_compliance() where both are free, [1/kg]; and */
    fl_sym3 compliance; /* as in fl_friction_contact, where the pressures have their middle; frame of B */
    double turn_compliance;
    double radii; /* sum of the two [m] */
    double free_path,
        radius_a;        /* of fl_mesh_contact_free_travel(), INFINITY where B is convex; of A about o [m] */
    int b_is_plane;      /* B is a plane across z */
    double motion_force; /* the force that its motion comes to, over the force */
    double stiffness_i, stiffness_j;     /* 0: not asked [1/s2] */
    fl_vec3 v, spin;                     /* of A against B at the first place [m/s], [rad/s], frame of B, */
    double impact_damping, speed_offset; /* and how it was damped by fl_force_sum_damping() [s/m], [m/s] */
} fl_exact_contact;

/* How often one was asked, and how well it told; one for each thread. */
typedef struct {
    _Alignas(64) int64_t hits; /* contact-steps without a look              */
    int64_t checks;            /* looks within twice its reach              */
    int64_t misses;            /* that found more than the tolerance        */
    double worst_error;        /* most that was found                       */
} fl_surrogate_count;

/* Where along the plane of the pressures a force acts, from the point that the moment is about [m]. */
static inline fl_vec3 fl_surrogate_force_centre(fl_vec3 f, fl_vec3 m)
{
    return v3_scale(1.0 / v3_norm2(f), v3_cross(f, m));
}

/* By how much z may fall or rise. */
static inline double fl_surrogate_max_change(double tolerance) { return 1.5 * sqrt(sqrt(tolerance)); }

/* Those of all threads. */
fl_surrogate_count fl_surrogate_count_sum(const fl_surrogate_count *count, int32_t threads);

/* n <= FL_SURROGATE_BATCH of them side by side; all lanes are filled, what is behind the last is one of them.
 */
void fl_surrogate_pack(fl_surrogate_lanes *b, const fl_surrogate *const *s, int n);

/* What they tell for the poses M, o of A in the frame of B, as fl_patch_points_transform() has them. */
void fl_surrogate_evaluate(fl_surrogate_lanes *b);

/* What the k-th has told. */
fl_surrogate_value fl_surrogate_unpack(const fl_surrogate_lanes *b, int k);

/* Whether that is within so many times of what it may go, 1: near enough to be told. */
static inline int fl_surrogate_in_range(const fl_surrogate *s, double way, double turn, double z,
                                        double reaches)
{
    const double far = s->reach * s->overlap;
    return way <= reaches * (far < s->free_path ? far : s->free_path) && turn <= reaches * s->free_turn &&
           z > 1.0 - s->max_change && z < 1.0 + s->max_change;
}

/* Or so near that the error there tells of that where it held. */
static inline int fl_surrogate_in_double_range(const fl_surrogate *s, const fl_surrogate_value *t)
{
    return fl_surrogate_in_range(s, t->path, t->turn, t->z, 2.0);
}

/* Begin anew from what was found; t: what s had told for this pose, NULL where it could not be asked.
 * Returns by how much it was off. */
double fl_surrogate_update(fl_surrogate *s, const fl_surrogate_value *t, const fl_exact_contact *seen,
                           double tolerance);

/* The rest of that: what follows from what was found, where own, arm, reach, what was learnt, also of the
 * way, back and the stiffness are known. */
void fl_surrogate_set(fl_surrogate *s, const fl_exact_contact *seen);

#endif
