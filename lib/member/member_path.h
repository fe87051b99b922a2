/* SPDX-License-Identifier: GPL-3.0-or-later */
/* member_path.h -- the equilibrium path of a structure of members, point by point, by relaxation under a
 * constraint.
 *
 * The first point is found by load control.  Each further one starts from the last, moved on along the chord
 * of the last two until the constraint of arc_length.h holds, and is then relaxed to rest, with the load
 * factor of each step from the constraint.  It is accepted when the force that is not balanced, at its best
 * load factor, is below
 *     |lambda P0 - F| <= chi |P0| max |lambda|,    moments divided by the mean length of a piece.
 * The increment dl grows or shrinks with the steps that a point took and with how far the load
 * factor was from the line through the two points before; it is halved, and the point begun again, where the
 * quadratic has no root in more than 10 steps in succession, after max_steps, and where a number overflows.
 *
 * The iteration finds states that are stable under the constraint.  Past a bifurcation rounding errors grow,
 * and the path leaves the symmetric branch within some points; an imperfection decides which way.
 * Source: Ye & Xu, Engineering Mechanics 41(3), 2024; Lee & Han 2011; with the chord as predictor in place
 * of load steps, which FL_PATH_LOAD_STEPS makes for comparison. */
#ifndef FL_MEMBER_MEMBER_PATH_H
#define FL_MEMBER_MEMBER_PATH_H
#include "body/relaxation.h"
#include "member/arc_length.h"
#include "member/member_chain.h"

enum fl_path_predictor {
    FL_PATH_CHORD,
    FL_PATH_LOAD_STEPS /* the load factor rises by load_step in each of load_steps steps; then l = |d| */
};

typedef struct {
    double first;    /* load factor of the first point */
    double dl;       /* increment; 0: chosen, and changed from point to point */
    double dl_most;  /* 0: no limit */
    double dl_first; /* of the second point where dl = 0; 0: that of the first point */
    double last;     /* of load control: load factor that a point is made at, 0: none */
    enum fl_arc_constraint constraint;
    int32_t
        control; /* of FL_ARC_DISPLACEMENT: 0 the displacement along the loads; else that of one freedom */
    int32_t control_ball; /* ball and axis, along which a load acts */
    int32_t control_axis;
    enum fl_path_predictor predictor;
    double load_step;   /* detP/P0 */
    int64_t load_steps; /* eta */
    enum fl_relaxation_kind damping;
    double c;   /* of viscous damping */
    double chi; /* force that is not balanced, over |P0| max |lambda| */
    double
        resolution; /* distance of the load factor from the line of the last two points, over max |lambda| */
    int64_t max_steps; /* of a point; 0: chosen */
} fl_path_options;

fl_path_options fl_path_defaults(void);

enum {
    FL_PATH_HINT_MAXIMUM = 1,
    FL_PATH_HINT_MINIMUM = 2,
    FL_PATH_HINT_KINK = 4, /* the direction turned by more than 60 degrees */
    FL_PATH_HINT_JUMP = 8  /* of load control: the point is more than five times as far off as predicted */
};

typedef struct {
    int64_t number, steps, negative; /* steps without a root */
    double lambda, arc, length;      /* arc: sum of chords; length: |d| */
    double along;                    /* P0.d/|P0| with moments by their rotation */
    double residual;                 /* reached, over |P0| max |lambda| */
    double energy, work; /* stored, and dissipated by yielding; integral of lambda P0 along the path */
    double balance;      /* work - energy, over the greatest of both so far */
    int hint;            /* of a critical point between the last two points and this, bits */
    double limit, limit_error, limit_arc; /* load factor at the maximum or minimum, and where it is */
} fl_path_point;

typedef struct {
    fl_vec3 *d, *turned; /* [balls], [loads] */
    fl_quat *q;          /* [balls] */
} fl_path_state;

typedef struct {
    fl_member_chain *chain;
    fl_path_options options;
    enum fl_relaxation_kind damping;     /* in use */
    fl_path_state last, before;          /* the last point and the one before */
    fl_path_point point;                 /* the last */
    double dl, lambda_most, energy_most; /* greatest |lambda|, energy and work so far */
    double reaction_most;                /* greatest force at imposed displacements */
    int64_t first_steps, last_steps, total_steps;
    int known;                    /* points in the arrays, the start included */
    double s[4], lambda[4], w[4]; /* arc, load factor and P0.d of the last four, the last one at known - 1 */
} fl_path;

/* -1 with FL_SYSTEM. */
int fl_path_start(fl_path *p, fl_member_chain *chain, const fl_path_options *options, fl_err *err);
void fl_path_free(fl_path *p); /* accepts a zeroed struct, leaves one */

/* Finds the next point into p->point; the chain is left in that state.
 * 0; -1 with FL_NO where the arc cannot advance (the chain is left at the last point), with FL_INPUT where a
 * piece is turned by more than FL_MEMBER_ROTATION_MAX. */
int fl_path_next(fl_path *p, fl_err *err);

/* Puts the chain back into the state of the last point, at rest. */
void fl_path_return(fl_path *p);

#endif
