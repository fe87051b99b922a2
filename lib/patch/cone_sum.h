/* SPDX-License-Identifier: GPL-3.0-or-later */
/* cone_sum.h -- sums over a face or an edge near a truncated cone, the intervals and nodes of the
 * integration, and the patch points that the sums become. */
#ifndef FL_PATCH_CONE_SUM_H
#define FL_PATCH_CONE_SUM_H
#include "patch/patch_types.h"

/* Sums over a face or an edge: u, du, ddu and largest s; du times s and, along x and y from o, the first and
 * second moments of du; force, its moment about o, couple. */
typedef struct {
    fl_vec3 o, x, y;
    double u, du, ddu, most, ds, sx, sy, sxx, sxy, syy;
    fl_vec3 f, m, couple;
} fl_cone_sums;

/* Adds a node at `at` with overlap s and direction n. */
void fl_cone_sum_add(fl_cone_sums *q, fl_vec3 at, fl_vec3 n, double s, double u, double du, double ddu);

/* Adds n patch points with the force of the sums to w; the rest of the moment becomes a couple.
 *   n    3: spread as a pressure on a face, 2: as one along x
 *   ra   dilation radius of A [m] */
int fl_cone_sum_to_points(fl_patch_points *w, const fl_cone_sums *q, int n, double ra);

/* Intervals of a line, in each of which one part of the cone is nearest, the zone. */
enum { FL_CONE_INTERVALS = 12 };

typedef struct {
    double from, to;
    int zone;
} fl_cone_interval;

typedef struct {
    fl_cone_interval s[FL_CONE_INTERVALS];
    int n;
} fl_cone_intervals;

/* Splits [lo, hi] where zone(what, t) changes, also where several zones follow closely. */
void fl_cone_split_interval(fl_cone_intervals *out, int (*zone)(const void *, double), const void *what,
                            double lo, double hi);

/* Clusters the node u of [0, 1] towards ends with s = 0 (zero[]), so that the integrand has no root there.
 * *t: the node; returns dt/du. */
double fl_cone_cluster_node(double u, const int zero[2], double *t);

/* Sets zero[] also for ends where s is nearly 0.  s: at both ends and in the middle, s[1]. */
void fl_cone_mark_zero_ends(const double s[3], int zero[2]);

void fl_cone_sort_ascending(double *x, int32_t n);

#endif
