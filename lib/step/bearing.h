/* SPDX-License-Identifier: GPL-3.0-or-later */
/* bearing.h -- the sums over the places of a contact that its forces are made of, several places at a time.
 *
 * With du the pull of a place on U along n, e = du n.across its share of the pressure, c the speed at which
 * the bodies approach there, and arm its offset from the first place, all in the frame of B:
 *     gradient      sum of du n and of arm x du n: the force of W over dW/dU
 *     pressed, met  sum of du, and of du c where c > 0: the speed that damping asks for
 *     f(e)          sum of f, f across, f arm and f |arm|^2, f = max(0, e (1 + chi c)): what presses
 *     damping       sum of f - e times across and arm x across: what damping adds
 * The pull of rims, u = 0, is part of the gradient alone. */
#ifndef FL_STEP_BEARING_H
#define FL_STEP_BEARING_H
#include "narrow/places.h"
#include "step/stiff.h"

/* Force and moment. */
typedef struct {
    fl_vec3 f, m;
} fl_wrench;

typedef struct {
    double u, ddu;       /* sums of u and of ddu                                    [m6], [m4] */
    double overlap;      /* the largest                                                    [m] */
    double pressed, met; /* [m5], [m6/s] */
    double elastic;      /* sum of e                                                      [m5] */
    fl_wrench gradient;  /* [m5], [m6] */
    double normal;       /* sum of f                                                      [m5] */
    fl_vec3 direction;   /* sum of f across                                               [m5] */
    fl_vec3 moment;      /* sum of f arm                                                  [m6] */
    double spread;       /* sum of f |arm|^2                                              [m7] */
    fl_wrench damping;   /* [m5], [m6] */
} fl_bearing;

/* All but the last five; v, turn: velocities of A against B at the first place.  -1 when memory runs out. */
int fl_bearing_sum(fl_places *s, fl_vec3 v, fl_vec3 turn, fl_bearing *q);

/* The last five, after fl_bearing_sum() of the same places; chi [s/m]. */
void fl_bearing_damp(const fl_places *s, double chi, fl_bearing *q);

/* ddu along `across` at arm of the places that press, after fl_bearing_sum() [m4]. */
void fl_bearing_springs(const fl_places *s, fl_springs *q);

/* The places of a look, to be asked again when A has moved a little: where and along what they press is kept,
 * how much follows from ddu.  Zeroed to start; pad is freed with free(). */
typedef struct {
    void *pad;
    int32_t n, cap;
} fl_pads;

/* After fl_bearing_sum().  -1 when memory runs out. */
int fl_bearing_keep(const fl_places *s, fl_pads *pads);

/* What fl_bearing_sum() and fl_bearing_damp() would say now that A has moved by `way` at the first place and
 * has `turned`, to the first order; u, ddu, overlap and gradient are left 0.  *at: the sum of e arm. */
void fl_bearing_recall(const fl_pads *pads, fl_vec3 way, fl_vec3 turned, fl_vec3 v, fl_vec3 turn, double chi,
                       fl_bearing *q, fl_vec3 *at);

double fl_pads_bytes(const fl_pads *pads);

/* The speed at which the bodies approach at place k, after fl_bearing_sum() [m/s]. */
double fl_bearing_closing(const fl_places *s, int32_t k);

#endif
