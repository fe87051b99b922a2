/* SPDX-License-Identifier: GPL-3.0-or-later */
/* wall_contact.h -- spheres that lean on rigid walls of the boundary: rows as those of two spheres, sphere_contacts.h, with the
 * wall in place of the second.  To law/sphere_batch.h a wall that stands still is a sphere of no radius at the foot
 * of the centre x_i, D = z n with the height z of the centre over the wall and its normal n. */
#ifndef FL_SPHERE_WALL_CONTACT_H
#define FL_SPHERE_WALL_CONTACT_H
#include "world/world.h"

/* Rows for those of w->near that are such, n of them; what a row of before remembers goes over.  -1 with
 * FL_SYSTEM. */
int fl_wall_list_build(fl_world *w, int64_t n, fl_err *err);

/* A row behind all others, roll being read where w->rolls; fl_wall_list_index() afterwards.  -1 with
 * FL_SYSTEM. */
int fl_wall_list_append(fl_world *w, int32_t i, int32_t j, int hit, const fl_sphere_contact *row,
                        const fl_rolling_spring *roll, fl_err *err);

/* End the rows of bodies that are away; whether there were any. */
int fl_wall_list_remove_absent(fl_world *w);

/* Which are of which chunk. */
void fl_wall_list_index(fl_sphere_contacts *s);

/* Those of chunk a over a step of dt [s], dt < 0: placed again, by what they hold; into the sums, the tally
 * and, for a survey, the stiffness of the chunk. */
void fl_wall_chunk_evaluate(fl_world *w, int32_t a, double dt, int survey);

/* Add what those that lean on wall j do to it. */
void fl_wall_add_forces(const fl_world *w, int32_t j, fl_vec3 *f, fl_vec3 *t);

/* Elastic energy of those of chunk a, that of their springs of friction with it, and that of the springs
 * alone, added [J]. */
void fl_wall_chunk_energy(const fl_world *w, int32_t a, double *all, double *springs);

/* Row c as a pair like all others, with its forces of the last touch. */
void fl_wall_contact_to_pair(const fl_world *w, int32_t c, fl_pair *p);

#endif
