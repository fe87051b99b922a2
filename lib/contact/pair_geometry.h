/* SPDX-License-Identifier: GPL-3.0-or-later */
/* pair_geometry.h -- how two things stand to one another: where they touch, or how far apart they are. */
#ifndef FL_CONTACT_PAIR_GEOMETRY_H
#define FL_CONTACT_PAIR_GEOMETRY_H
#include "world/world.h"

/* Everything is computed relative to B, so that nothing depends on where the world's origin is: o and M take
 * A's frame to B's, R B's to the world's, off is the world vector from A's centre to B's. */
typedef struct {
    fl_mat3 M, R;
    fl_vec3 o, off;
} fl_relative_pose;

/* How the two of p stand now.  M is left out where A is a point: nothing of it turns. */
fl_relative_pose fl_relative_pose_of(const fl_world *w, const fl_pair *p);

/* Fill the scratch of that thread, w->scratch, with the places of the pair, in the frame of B; none: they do
 * not touch.  *distance: a lower bound of the distance of the cores [m].  -1 when memory runs out. */
int fl_pair_find_points(fl_world *w, fl_pair *p, int32_t thread, const fl_relative_pose *r, double *distance);

/* The one contact of the pair that the manual's laws ask for, by narrow/contact.h, in the frame of B.  -1
 * when memory runs out. */
int fl_pair_find_contact(fl_world *w, fl_pair *p, int32_t thread, const fl_relative_pose *r, fl_contact *out);

/* p has been found not to touch, its cores being so far apart or farther, its reach R [m]: until when it
 * sleeps.  What has gone far enough forgets its features. */
void fl_pair_set_free_travel(const fl_world *w, fl_pair *p, double distance, double R);

/* Whether the direction of the last look, or that of a rigid wall, still keeps two that do not touch farther
 * apart than they reach, as it does most often; then nothing else of them has to be known, and q->asleep is
 * renewed.  A contact that has let go is renewed as well, and forgets its features where it has gone far
 * enough. */
int fl_pair_still_apart(const fl_world *w, fl_neighbour_pair *q);

/* The signed contact of a pair as the probe tells it: gap and mode by narrow/contact.h, in world axes
 * relative to the world's origin, the point inside the cell; on a shell the deepest place, or where it is
 * nearest, without a mode.  Returns 0 where there is none within reach. */
int fl_pair_probe(fl_world *w, const fl_pair *p, double reach, fl_contact *out);

#endif
