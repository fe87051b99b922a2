/* SPDX-License-Identifier: GPL-3.0-or-later */
/* pair_stiffness.h -- bounds of the highest frequency that a contact gives its two bodies, with its springs
 * of friction and rolling (patch/stiffness_bound.h). */
#ifndef FL_CONTACT_PAIR_STIFFNESS_H
#define FL_CONTACT_PAIR_STIFFNESS_H
#include "contact/pair_geometry.h"
#include "patch/force_sum.h"
#include "patch/patch_result.h"
#include "patch/stiffness_bound.h"

/* True in one step of four, by a hash: exact evaluations of contacts with a surrogate then compute stiffness
 * bounds.  A fixed period could coincide with that of the evaluations. */
static inline int fl_pair_stiffness_is_due(const fl_world *w)
{
    return (uint32_t)w->step * UINT32_C(2654435761) >> 30 == 0;
}

/* Adds the springs of friction and rolling to the stiffness of both bodies and bounds omega^2. */
void fl_pair_bound_stiffness(const fl_world *w, fl_pair *p, const fl_patch_result *q,
                             const fl_relative_pose *r, fl_stiffness *si, fl_stiffness *sj);

/* The same for a contact that pushes along n at one point. */
void fl_pair_bound_point_stiffness(const fl_world *w, fl_pair *p, const fl_patch_result *q, fl_vec3 n,
                                   const fl_relative_pose *r);

/* Stiffness of a patch: W'' = scale (U'' - U'^2/2U), of which the springs of the points are the first term.
 * ai, aj: the first point from the centres. */
void fl_pair_add_patch_stiffness(const fl_world *w, const fl_pair *p, const fl_spring_sums *q, fl_mat3 R,
                                 fl_vec3 ai, fl_vec3 aj, double scale, double U, fl_stiffness *si,
                                 fl_stiffness *sj);

#endif
