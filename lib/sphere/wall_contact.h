/* SPDX-License-Identifier: GPL-3.0-or-later */
/* wall_contact.h -- contacts of spheres with rigid walls of the boundary, stored like those of two spheres
 * (world/sphere_contacts.h) with the wall as j.  For law/sphere_batch.h a wall is a sphere of radius 0 at
 * the foot of the centre x_i: D = z n, with the height z of the centre over the wall and its normal n.
 *
 * Other contacts of a floe with a wall or with the structure are evaluated as pairs:
 *   elastic wall                        contact/pair_force.c, evaluate_elastic_wall()
 *   flat or convex piece                contact/pair_geometry.c, then point_force.c or patch_force.c
 *   mesh                                structure/mesh_contact.c, for a sphere persistence_contact.c
 *   laws manual and manual-si           contact/point_force.c */
#ifndef FL_SPHERE_WALL_CONTACT_H
#define FL_SPHERE_WALL_CONTACT_H
#include "world/world.h"

/* Builds the list from w->candidates, n of which are wall contacts.  Contacts that were listed before keep
 * their memory.  -1 with FL_SYSTEM. */
int fl_wall_list_build(fl_world *w, int64_t n, fl_err *err);

/* Appends a contact; roll is read where w->has_rolling.  fl_wall_list_index() must follow.  -1 with
 * FL_SYSTEM. */
int fl_wall_list_append(fl_world *w, int32_t i, int32_t j, int touches, const fl_sphere_contact *contact,
                        const fl_rolling_spring *roll, fl_err *err);

/* Removes the contacts of bodies that have left the domain; true if there were any. */
int fl_wall_list_remove_absent(fl_world *w);

/* Computes the first contact of each chunk and counts those that touch. */
void fl_wall_list_index(fl_sphere_contacts *s);

/* Evaluates the contacts of chunk a over a step of dt [s], or for dt < 0 restores their forces; adds to the
 * sums, the totals and, for a survey, the stiffness of the chunk. */
void fl_wall_chunk_evaluate(fl_world *w, int32_t a, double dt, int survey);

/* Adds the forces of the spheres on wall j to f and t. */
void fl_wall_add_forces(const fl_world *w, int32_t j, fl_vec3 *f, fl_vec3 *t);

/* Adds the elastic energy of the contacts of chunk a with their springs, and that of the springs alone [J].
 */
void fl_wall_chunk_energy(const fl_world *w, int32_t a, double *all, double *springs);

/* Converts contact c to an fl_pair, with the forces of its last evaluation. */
void fl_wall_contact_to_pair(const fl_world *w, int32_t c, fl_pair *p);

#endif
