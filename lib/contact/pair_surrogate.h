/* SPDX-License-Identifier: GPL-3.0-or-later */
/* pair_surrogate.h -- the surrogate (patch/surrogate.h) of a pair, built from its exact evaluations. */
#ifndef FL_CONTACT_PAIR_SURROGATE_H
#define FL_CONTACT_PAIR_SURROGATE_H
#include "contact/pair_geometry.h"

/* The exact contact of a patch, W = k sqrt(U), from the sums q over its points s; the couple of the points
 * is added to q. */
void fl_exact_contact_find(const fl_world *w, const fl_pair *p, const fl_patch_points *s,
                           const fl_relative_pose *r, fl_force_sum *q, fl_exact_contact *exact);

/* Adds to `exact` the free path of A until another wall of a non-convex surface may touch it.  -1 when
 * memory runs out. */
int fl_exact_contact_free_path(fl_world *w, const fl_pair *p, int32_t thread, fl_exact_contact *exact);

/* Updates the surrogate of p from an exact evaluation.  t: its value for this pose, or NULL.  -1 when
 * memory runs out. */
int fl_pair_update_surrogate(fl_world *w, fl_pair *p, int32_t thread, const fl_surrogate_value *t,
                             const fl_exact_contact *exact);

/* Rebuilds the surrogate of a pair from an exact evaluation at the pose of the last one, M and o taking i
 * to j, after a checkpoint has been read.  What it has learnt is there already.  -1 when memory runs out. */
int fl_pair_rebuild_surrogate(fl_world *w, fl_pair *p, const fl_mat3 *M, fl_vec3 o);

#endif
