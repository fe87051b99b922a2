/* SPDX-License-Identifier: GPL-3.0-or-later */
/* cone_sum.h -- what is summed over a face or an edge beside a truncated cone, where the sums are cut, and
 * the places they become. */
#ifndef FL_PATCH_CONE_SUM_H
#define FL_PATCH_CONE_SUM_H
#include "patch/patch_types.h"

/* What is summed over a face or an edge: u and its derivatives; the force, its moment about o, and the
 * couple; places weighed by du, along x and y. */
typedef struct {
    fl_vec3 o, x, y;
    double u, du, ddu, most, ds, sx, sy, sxx, sxy, syy;
    fl_vec3 f, m, couple;
} fl_cone_sums;

/* A point at `at` with the overlap s and the direction n. */
void fl_cone_sum_add(fl_cone_sums *q, fl_vec3 at, fl_vec3 n, double s, double u, double du, double ddu);

/* n places with the force of all; what they lack of its moment goes to the couple.  n = 3: spread as a
 * pressure on a face, 2: as one along x. */
int fl_cone_sum_to_points(fl_patch_points *w, const fl_cone_sums *q, int n, double ra);

/* Pieces of a line in each of which one thing is nearest, its zone. */
enum { FL_CONE_INTERVALS = 12 };

typedef struct {
    double from, to;
    int zone;
} fl_cone_interval;

typedef struct {
    fl_cone_interval s[FL_CONE_INTERVALS];
    int n;
} fl_cone_intervals;

/* Cut [lo, hi] where the zone changes, also where several zones follow closely. */
void fl_cone_split_interval(fl_cone_intervals *out, int (*zone)(const void *, double), const void *what,
                            double lo, double hi);

/* Where a rule has its nodes: u of [0, 1], bunched towards an end where s is 0 so that its power has no root
 * there.  Returns dt/du. */
double fl_cone_cluster_node(double u, const int zero[2], double *t);

/* An end that is nearly nothing is one that is: s at both ends and in the middle. */
void fl_cone_mark_zero_ends(const double s[3], int zero[2]);

/* x[n] in rising order. */
void fl_cone_sort_ascending(double *x, int32_t n);

#endif
