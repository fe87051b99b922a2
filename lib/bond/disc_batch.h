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

/* Evaluates the discs [from, from + FL_LANE_COUNT) that are whole over a step of dt [s].  shift: offsets that
 * bring j beside i, NULL for none.  done: 1 if the disc has its forces, 0 if it is not whole or may have
 * reached its strength; it is unchanged then.  Returns the sum of |F| of those that are done. */
double fl_disc_batch_force(const fl_disc_arrays *a, int32_t from, const fl_disc_law *law,
                           const fl_disc_class *classes, const fl_bodies *b, const fl_vec3 *shift, double dt,
                           uint8_t done[FL_LANE_COUNT]);

#endif
