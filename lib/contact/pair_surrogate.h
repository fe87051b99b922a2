/* SPDX-License-Identifier: GPL-3.0-or-later */
/* pair_surrogate.h -- the surrogate (patch/surrogate.h) of a pair, built from its exact evaluations. */
#ifndef FL_CONTACT_PAIR_SURROGATE_H
#define FL_CONTACT_PAIR_SURROGATE_H
#include "contact/pair_geometry.h"

/* dF/ds of W = k sqrt(U), scale = k/(2 sqrt(U)), from U and its first two derivatives: positive, but for
 * rounding where the two barely touch; there F/s in its place.  overlap: s > 0 [m]. */
static inline double fl_patch_slope(double scale, double u, double du, double ddu, double overlap)
{
    const double slope = scale * (ddu - 0.5 * du * du / u);
    return slope > 0.0 ? slope : scale * du / overlap;
}

/* The exact contact of a patch, W = k sqrt(U), from the sums q over its points s; the couple of the points
 * is added to q.  `pressing` and `springs` are left out: only surrogates need them. */
void fl_exact_contact_find(const fl_world *w, const fl_pair *p, const fl_patch_points *s,
                           const fl_relative_pose *r, fl_force_sum *q, fl_exact_contact *exact);

/* What `exact` of a contact of the law `quick` refers to. */
typedef struct {
    fl_force_sum sums;
    fl_pressure_moments pressing;
    fl_spring_sums springs;
} fl_quick_exact;

/* The exact contact of the law `quick`: its pressures as even ones with the same sum, centre, second moments
 * and mean normal.  q: sums of the law; rest: receives what `exact` refers to. */
void fl_exact_contact_of_quick(const fl_world *w, const fl_pair *p, const fl_relative_pose *r,
                               const fl_quick_sums *q, fl_quick_exact *rest, fl_exact_contact *exact);

/* Springs of the terms of the law `quick` about their centre of pressure: k [m4] along the mean normal,
 * spread as the second moments of the pressure [m2].  Normals that differ leave |sum of e n| = e (1 - part):
 * part of the springs may act in any direction. */
fl_spring_sums fl_quick_springs(const fl_quick_sums *q, const fl_sym3 *second, double k);

/* Second moments of the pressure about its centre [m2]. */
static inline fl_sym3 fl_quick_second_moments(const fl_quick_sums *q)
{
    const double each = 1.0 / q->pressure;
    const fl_vec3 c = v3_scale(each, q->moment);
    return (fl_sym3){each * q->second.xx - c.x * c.x, each * q->second.xy - c.x * c.y,
                     each * q->second.xz - c.x * c.z, each * q->second.yy - c.y * c.y,
                     each * q->second.yz - c.y * c.z, each * q->second.zz - c.z * c.z};
}

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
