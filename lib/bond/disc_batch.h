/* SPDX-License-Identifier: GPL-3.0-or-later */
/* disc_batch.h -- fl_disc_force() of whole discs several at a time, with the same bits. */
#ifndef FL_BOND_DISC_BATCH_H
#define FL_BOND_DISC_BATCH_H
#include "body/body.h"
#include "bond/disc.h"
#include "geom/lanes.h"

/* Memory of many discs, an array for each number; fl_disc_memory has their meaning.  Arrays hold a multiple
 * of FL_LANE_COUNT. */
typedef struct {
    int32_t *i, *j; /* bodies, i < j */
    double *S[3], *M[3];
    double *damping_force[3], *damping_couple[3], *damped; /* NULL without dashpots */
    double *scatter;                                       /* s; NULL: 1 */
    double *lambda, *dissipated, *friction_loss;
    uint8_t *is_whole;   /* not damaged */
    uint16_t *which;     /* class */
    fl_disc_wrench *out; /* of the last evaluation */
} fl_disc_arrays;

enum { FL_DISC_BATCH = 64 }; /* most discs of a batch */

/* |F| of each disc of a batch that is done, 0 for the others; and 1 for those that are done. */
typedef struct {
    double size[FL_DISC_BATCH];
    uint8_t done[FL_DISC_BATCH]; /* set only if some disc is not */
} fl_disc_batch_result;

/* Evaluates the discs [from, from + n) that are whole over a step of dt [s]; n is a multiple of
 * FL_LANE_COUNT.  shift: offsets that bring j beside i, NULL for none.  Returns how many are not done:
 * those that are not whole or may have reached their strength.  Their memory is unchanged, and the caller
 * computes their forces alone. */
int fl_disc_batch_force(const fl_disc_arrays *a, int32_t from, int n, const fl_disc_law *law,
                        const fl_disc_class *classes, const fl_bodies *b, const fl_vec3 *shift, double dt,
                        fl_disc_batch_result *out);

#endif
