/* SPDX-License-Identifier: GPL-3.0-or-later */
/* contact_list.h -- pairs of spheres in a step, those with walls (wall_contact.h) among them; how they are kept is told in
 * sphere_contacts.h, their forces in law/sphere_batch.h. */
#ifndef FL_SPHERE_CONTACT_LIST_H
#define FL_SPHERE_CONTACT_LIST_H
#include "world/world.h"

/* Rows for those of w->near that are such, spheres that are no farther apart than the skin; image() tells
 * which image of j is meant.  What a row of before remembers goes over.
 *   others  out: how many of w->near are not such
 * -1 with FL_SYSTEM. */
typedef void fl_pair_image(const fl_world *w, int64_t k, int32_t i, int32_t j, int32_t image[3]);
int fl_contact_list_build(fl_world *w, fl_pair_image *image, int64_t *others, fl_err *err);

/* A row behind all others, for those who put together a world from what they read: i and then j do not fall;
 * fl_contact_list_index() afterwards.  Walls have no image.  roll: read where w->rolls.  -1 with FL_SYSTEM. */
int fl_contact_list_append(fl_world *w, int32_t i, int32_t j, const int32_t image[3], int hit,
                           const fl_sphere_contact *row, const fl_rolling_spring *roll, fl_err *err);

/* End the rows of bodies that are away, and renew the sums of the others.  -1 with FL_SYSTEM. */
int fl_contact_list_remove_absent(fl_world *w, fl_err *err);

/* Offsets, slots and sums of the rows at hand, from the forces that they hold.  -1 with FL_SYSTEM. */
int fl_contact_list_index(fl_world *w, fl_err *err);

/* --- their books ------------------------------------------------------------------------------- */

/* Sum of bounds of omega^2 of the contacts of body k, at the last survey [1/s2]. */
double fl_sphere_omega2(const fl_world *w, int32_t k);

/* Force and torque on body k, added to f and t. */
static inline void fl_sphere_add_forces(const fl_world *w, int32_t k, fl_vec3 *f, fl_vec3 *t)
{
    const fl_sphere_sum *s = &w->spheres.sum[k];
    *f = v3_add(*f, v3_add(v3_add(s->elastic, s->damping), s->friction));
    *t = v3_add(*t, s->torque);
}

/* Elastic energy of all rows, that of their springs of friction with it, and that of the springs alone [J].
 */
void fl_contact_list_energy(const fl_world *w, double *elastic, double *spring);

/* Sum of |F| [N], touching rows, and the largest overlap over the sum of the radii with whose it is (-1:
 * nobody's) of the last touch. */
typedef struct {
    double force_sum, max_overlap;
    int64_t touching;
    int32_t i, j;
} fl_sphere_totals;
fl_sphere_totals fl_contact_list_totals(const fl_world *w);

/* How many rows there are. */
static inline int32_t fl_contact_list_size(const fl_world *w) { return w->spheres.n + w->spheres.walls; }

/* All rows by (i, j, image), from {0} on: what comes next, of two spheres, or of a sphere and a wall ~c; none
 * are left after fl_contact_list_size() of them. */
typedef struct {
    int32_t sphere, wall;
} fl_contact_iterator;
int32_t fl_contact_list_next(const fl_world *w, fl_contact_iterator *at);

/* All near pairs, those of spheres in their place, by (i, j, image): from {.w = w} on, NULL at the end.  What
 * is returned holds until the next. */
typedef struct {
    const fl_world *w;
    int32_t pair;
    fl_contact_iterator spheres;
    fl_pair converted;
} fl_pair_iterator;
const fl_pair *fl_pair_next(fl_pair_iterator *at);

/* Memory of rows, sums and slots [B]. */
double fl_contact_list_bytes(const fl_world *w);

void fl_contact_list_free(fl_sphere_contacts *s);

#endif
