/* SPDX-License-Identifier: GPL-3.0-or-later */
/* grading.h -- the sizes of the bodies of a packing: a sieve curve by mass, a law, or a list.
 *
 * P(d) is the part of the solid volume in bodies with a size up to d.  It consists of pieces in each of which
 *     dP/dd = c d^(m - 1),   d_1 < d < d_2,
 * m = 0 between sieves (straight in log d), m = 1 straight in d, m = n for the curve of Fuller,
 *     P = (d^n - d_1^n) / (d_2^n - d_1^n),
 * and m = D + 1 for a number of bodies uniform in d.  The volume of a body goes with d^D, D = 2 for discs and
 * 3 for spheres and polyhedra, so the number density is dP/dd / d^D.  Number of a piece per solid volume, for
 * bodies of volume v d^D:
 *     n = share / v * int d^(m-1-D) / int d^(m-1).
 *
 * The draw of N bodies is stratified: in each piece body k of n has the size at which the number curve of the
 * piece is (k + 1/2)/n.  Pieces are filled from the coarsest to the finest; what the whole number of bodies
 * of a piece has too much or too little of its volume goes to the next finer one, and the sizes of the finest
 * are scaled to the total.  Then the number curve is met to 1/(2 N) per piece, and the solid volume to
 * rounding; independent draws would miss the number curve by 1.36/sqrt(N) (Kolmogorov and Smirnov, 5 %).
 * Limits: a piece of less than half a body gets none; fl_grading_draw() counts these. */
#ifndef FL_PACK_GRADING_H
#define FL_PACK_GRADING_H
#include <stdint.h>
#include "base/err.h"

typedef struct {
    double lo, hi; /* d_1, d_2 [m] */
    double share;  /* of the solid volume */
    double m;
} fl_grading_piece;

/* A curve of pieces in ascending order, or a list of sizes. */
typedef struct {
    int32_t pieces, piece_cap;
    fl_grading_piece *piece; /* [pieces] shares add up to 1; gaps between pieces hold nothing */
    int32_t n, size_cap;
    double *size; /* [n] of a list [m]; n = 0: a curve */
} fl_grading;

/* Laws, for D = dim: "uniform:A,B", "uniform:A,B,number", "fuller:N,A,B" and "single:D".
 * Returns 1 and sets *g; 0 if the text is no law; -1 with FL_USAGE (a number that is not one, sizes not above
 * 0 or not rising) or FL_SYSTEM. */
int fl_grading_law(fl_grading *g, const char *text, int dim, fl_err *err);

/* Read a file of kind `grading`, grading(5): columns d[m] and passing, or d[m] alone for a list.
 *   linear  1: straight in d between two sieves, 0: in log d
 * 0, or -1 with FL_INPUT (a curve that decreases or does not end at 1, sizes that do not rise or are not
 * above 0) or FL_SYSTEM. */
int fl_grading_read(fl_grading *g, const char *path, int linear, fl_err *err);

/* Number of bodies per unit of v times solid volume, sum of n v above [1/m^D]; mean of d^D is its inverse. */
double fl_grading_number(const fl_grading *g, int dim);

/* P(d), and the number curve F(d): the part of the bodies with a size up to d. */
double fl_grading_mass(const fl_grading *g, int dim, double d);
double fl_grading_count(const fl_grading *g, int dim, double d);

/* Size at which the number curve is u, 0 < u < 1 [m]. */
double fl_grading_quantile(const fl_grading *g, int dim, double u);

double fl_grading_least(const fl_grading *g); /* [m] */
double fl_grading_most(const fl_grading *g);  /* [m] */

/* Draw the sizes of bodies of the volume `volume`, in descending order.
 *   v       a body of size d has the volume v d^D
 *   number  > 0: so many bodies, sizes of the curve unscaled; 0: as many as the volume needs
 *   size    out: allocated, [*n]
 *   empty   out: pieces that got no body
 * 0, or -1 with FL_INPUT (not one body, or more than 2^27) or FL_SYSTEM. */
int fl_grading_draw(const fl_grading *g, int dim, double v, double volume, int32_t number, double **size,
                    int32_t *n, int32_t *empty, fl_err *err);

void fl_grading_free(fl_grading *g); /* accepts a zeroed struct, leaves one */

#endif
