/* SPDX-License-Identifier: GPL-3.0-or-later */
/* bearing.h -- the sums over the places of a contact that its forces are made of, several places at a time.
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
#ifndef FL_STEP_BEARING_H
#define FL_STEP_BEARING_H
#include "base/wide.h"
#include "narrow/places.h"
#include "step/stiff.h"

/* Force and moment. */
typedef struct {
    fl_vec3 f, m;
} fl_wrench;

FL_WIDE_PART fl_wrench fl_wrench_madd(fl_wrench a, double s, fl_wrench b)
{
    return (fl_wrench){v3_madd(a.f, s, b.f), v3_madd(a.m, s, b.m)};
}

typedef struct {
    double u, ddu;       /* sums of u and of ddu                                    [m6], [m4] */
    double overlap;      /* the largest                                                    [m] */
    double pressed, met; /* [m5], [m6/s] */
    double elastic;      /* sum of e                                                      [m5] */
    fl_vec3 middle;      /* sum of e arm                                                  [m6] */
    double rate;         /* sum of e c                                                  [m6/s] */
    fl_wrench gradient;  /* [m5], [m6] */
    double normal;       /* sum of f                                                      [m5] */
    fl_vec3 direction;   /* sum of f across                                               [m5] */
    fl_vec3 moment;      /* sum of f arm                                                  [m6] */
    double spread;       /* sum of f |arm|^2                                              [m7] */
    fl_wrench damping;   /* [m5], [m6] */
} fl_bearing;

/* All but `met`, `rate` and the last five.  -1 when memory runs out. */
int fl_bearing_sum(fl_places *s, fl_bearing *q);

/* `met` and `rate` of the same places; v, turn: velocities of A against B at the first of them.  -1 when
 * memory runs out. */
int fl_bearing_move(fl_places *s, fl_vec3 v, fl_vec3 turn, fl_bearing *q);

/* The last five, after that; chi [s/m], more [m/s]. */
void fl_bearing_damp(const fl_places *s, double chi, double more, fl_bearing *q);

/* ddu along `across` at arm of the places that press, after fl_bearing_sum() [m4]. */
void fl_bearing_springs(const fl_places *s, fl_springs *q);

/* What presses, whatever moves: of e, n = across and t = arm x n
 *     direction, turning   sums of e n and of e t
 *     damping              of e (n, t) (n, t)^T, its upper triangle row by row: where A moves by v at the
 *                          first place and turns, and nothing would pull, damping adds -chi damping (v, turn)
 *     mean, wide           mean of arm, by e, and the root of that of |arm - mean|^2 */
enum { FL_PRESSING = 21 };
typedef struct {
    double elastic; /* sum of e */
    fl_vec3 direction, turning, mean;
    double damping[FL_PRESSING], wide;
} fl_pressing;

/* After fl_bearing_sum(). */
void fl_bearing_pressing(const fl_places *s, fl_pressing *q);

/* The speed at which the bodies approach at place k, after fl_bearing_move() [m/s]. */
double fl_bearing_closing(const fl_places *s, int32_t k);

#endif
