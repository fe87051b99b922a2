/* SPDX-License-Identifier: GPL-3.0-or-later */
/* profile_matrix.h -- a symmetric matrix of which each row is kept from its first column on, and its factors
 * K = L D L^T, which fill no other places.
 *
 *     fl_profile_begin(p, n), fl_profile_join() for each group of unknowns, fl_profile_allocate(),
 *     fl_profile_add_form(), fl_profile_factor(), fl_profile_solve()
 *
 * A column that rows to come do not reach costs nothing: number the chains of a structure first, its nodes
 * last. Source: Jennings, Matrix Computation for Engineers and Scientists (1977), ch. 4. */
#ifndef FL_MEMBER_PROFILE_MATRIX_H
#define FL_MEMBER_PROFILE_MATRIX_H
#include <stdint.h>
#include "base/err.h"

typedef struct {
    int32_t n;
    int32_t *low;     /* [n] first column of row i */
    int64_t *start;   /* [n + 1] of row i in k */
    double *k;        /* row i: columns low[i] .. i */
    double *diagonal; /* [n] of the matrix before it is factored */
} fl_profile;

int fl_profile_begin(fl_profile *p, int32_t n, fl_err *err);
void fl_profile_free(fl_profile *p); /* accepts a zeroed struct, leaves one */

/* Adds the unknowns of one element to the profile; a number below 0 is none. */
void fl_profile_join(fl_profile *p, int count, const int32_t *which);

/* Allocates the profile, all zero.  1 if it would have more than `most` numbers; -1 with FL_SYSTEM. */
int fl_profile_allocate(fl_profile *p, int64_t most, fl_err *err);

/* Adds stiff (g.u)2/2. */
void fl_profile_add_form(fl_profile *p, int count, const int32_t *which, const double *g, double stiff);

/* Row i from column 0 on, of which those below low[i] are not there. */
static inline double *fl_profile_row(const fl_profile *p, int32_t i)
{
    return p->k + p->start[i] - p->low[i];
}

/* Factors row i, those before it are factored: below the diagonal L, on it D.  0 if D is not above `pivot`
 * times the diagonal element: the row moves without resistance; fl_profile_hold() keeps it where it is. */
int fl_profile_factor_row(fl_profile *p, int32_t i, double pivot);
void fl_profile_hold(fl_profile *p, int32_t i);

/* x <- K^-1 x. */
void fl_profile_solve(const fl_profile *p, double *x);

#endif
