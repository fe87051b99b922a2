/* SPDX-License-Identifier: GPL-3.0-or-later */
/* pair_geometry.h -- the relative pose of two bodies, their contact points, or a lower bound of their
 * distance. */
#ifndef FL_CONTACT_PAIR_GEOMETRY_H
#define FL_CONTACT_PAIR_GEOMETRY_H
#include "patch/quick_law.h"
#include "world/world.h"

/* The pose of A relative to B, so that no result depends on the origin of the world.  o and M take A's
 * frame to B's, R takes B's to the world's, off is the world vector from A's centre to B's. */
typedef struct {
    fl_mat3 M, R;
    fl_vec3 o, off;
} fl_relative_pose;

/* The relative pose now.  M is the identity where the core of A is a point. */
fl_relative_pose fl_relative_pose_of(const fl_world *w, const fl_pair *p);

/* Finds the contact points of the pair in the frame of B and writes them to w->scratch[thread]; none if the
 * two do not touch.  *distance: a lower bound of the distance of the cores [m].  -1 when memory runs out. */
int fl_pair_find_points(fl_world *w, fl_pair *p, int32_t thread, const fl_relative_pose *r, double *distance);

/* True if the law `quick` applies: it is that of the pair, and both are floes with faces. */
static inline int fl_pair_is_quick(const fl_world *w, const fl_pair *p)
{
    return p->law->law->quick && p->j < w->n && w->quick_shape[p->i].faces > 0 &&
           w->quick_shape[p->j].faces > 0;
}

/* The terms of the law `quick`, in the frame of B; *distance as above.  -1 when memory runs out. */
int fl_pair_find_quick(fl_world *w, fl_pair *p, int32_t thread, const fl_relative_pose *r, double *distance,
                       fl_quick_sums *sums);

/* Finds the one contact of features of the laws manual and manual-si, by narrow/contact.h, in the frame of B.
 * -1 when memory runs out. */
int fl_pair_find_contact(fl_world *w, fl_pair *p, int32_t thread, const fl_relative_pose *r, fl_contact *out);

/* Sets the free travel of a pair that does not touch: `distance` is a lower bound of the distance of the
 * cores, R the sum of the radii [m].  A pair that is far enough apart releases its feature pairs. */
void fl_pair_set_free_travel(const fl_world *w, fl_pair *p, double distance, double R);

/* The same for near pair q, and for its contact if that has just opened. */
void fl_neighbour_pair_set_distance(const fl_world *w, fl_neighbour_pair *q, double distance);

/* True if the separating direction of the last evaluation, or the normal of a rigid wall, still separates
 * two bodies that do not touch, as it mostly does.  Then no evaluation is needed and q->free_travel is
 * updated, also for a contact that has just opened; that releases its feature pairs if it is far enough
 * apart. */
int fl_pair_still_apart(const fl_world *w, fl_neighbour_pair *q);

/* The contact of a pair for `--probe`: gap (negative: overlap) and mode by narrow/contact.h, in world axes,
 * the point inside the periodic cell.  On a mesh it is the deepest point, or else the nearest, without a
 * mode.  Returns 0 if there is none within reach [m]. */
int fl_pair_probe(fl_world *w, const fl_pair *p, double reach, fl_contact *out);

#endif
