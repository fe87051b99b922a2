/* SPDX-License-Identifier: GPL-3.0-or-later */
/* contact_list.h -- the list of sphere contacts: pairs of spheres, and spheres on rigid walls
 * (wall_contact.h).  Its data and their order are described in world/sphere_contacts.h, the forces in
 * law/sphere_batch.h. */
#ifndef FL_SPHERE_CONTACT_LIST_H
#define FL_SPHERE_CONTACT_LIST_H
#include "world/world.h"

/* Image of j in candidate k. */
typedef void fl_pair_image(const fl_world *w, int64_t k, int32_t i, int32_t j, int32_t image[3]);

/* Builds the list from w->candidates: pairs of spheres whose distance is below the skin, and walls.
 * Contacts that were listed before keep their memory.
 *   others  out: number of candidates that are no sphere contacts
 * -1 with FL_SYSTEM. */
int fl_contact_list_build(fl_world *w, fl_pair_image *image, int64_t *others, fl_err *err);

/* Adds the pairs of bonds of spheres that have ended since the list was made.  All other pairs stay: the list
 * is as long valid as before.  Called where contacts have been listed before.  -1 with FL_SYSTEM. */
int fl_contact_list_add_ended(fl_world *w, fl_err *err);

/* Appends a contact, when a checkpoint is read: sorted by i, then j.  fl_contact_list_index() must follow.
 * Walls have no image; roll is read where w->has_rolling.  -1 with FL_SYSTEM. */
int fl_contact_list_append(fl_world *w, int32_t i, int32_t j, const int32_t image[3], int touches,
                           const fl_sphere_contact *contact, const fl_rolling_spring *roll, fl_err *err);

/* Removes the contacts of bodies that have left the domain, and recomputes the sums.  -1 with FL_SYSTEM. */
int fl_contact_list_remove_absent(fl_world *w, fl_err *err);

/* Removes those of two spheres; 1 if there were some: offsets and sums are old then. */
int fl_contact_list_drop_absent(fl_world *w);

/* Computes offsets and slots, and the sums from the stored forces.  -1 with FL_SYSTEM. */
int fl_contact_list_index(fl_world *w, fl_err *err);

/* Where a device makes the rows of spheres (gpu/gpu_lists.h): the list of walls from the candidates; n
 * contacts whose arrays the caller fills; their offsets and slots.  -1 with FL_SYSTEM. */
int fl_contact_list_build_walls(fl_world *w, fl_err *err);
int fl_contact_list_resize(fl_world *w, int32_t n, fl_err *err);
int fl_contact_list_offsets(fl_world *w, fl_err *err);

/* --- sums -------------------------------------------------------------------------------------- */

/* Sum of bounds of omega^2 of the contacts of body k, at the last survey [1/s2]. */
double fl_sphere_omega2(const fl_world *w, int32_t k);

/* Adds the contact force and torque of body k to f and t. */
static inline void fl_sphere_add_forces(const fl_world *w, int32_t k, fl_vec3 *f, fl_vec3 *t)
{
    const fl_sphere_sum *s = &w->spheres.sum[k];
    *f = v3_add(*f, v3_add(v3_add(s->elastic, s->damping), s->friction));
    *t = v3_add(*t, s->torque);
}

/* Adds the elastic energy of all contacts with their friction springs, and that of the springs alone [J]. */
void fl_contact_list_energy(const fl_world *w, double *elastic, double *spring);

/* Totals of the last evaluation. */
typedef struct {
    double force_sum;   /* sum of |F| [N] */
    double max_overlap; /* largest overlap over the sum of the radii */
    int64_t touching;   /* contacts that touch */
    int32_t i, j;       /* of the largest overlap, -1: none */
} fl_sphere_totals;
fl_sphere_totals fl_contact_list_totals(const fl_world *w);

/* Number of contacts in the list. */
static inline int32_t fl_contact_list_size(const fl_world *w) { return w->spheres.n + w->spheres.walls; }

/* Iterates over all contacts by (i, j, image), from {0} on: returns the next, c of two spheres or ~c of a
 * sphere and a wall.  There are fl_contact_list_size() of them. */
typedef struct {
    int32_t sphere, wall;
} fl_contact_iterator;
int32_t fl_contact_list_next(const fl_world *w, fl_contact_iterator *at);

/* Iterates over all near pairs and sphere contacts by (i, j, image), from {.w = w} on; NULL at the end.
 * The result is valid until the next call. */
typedef struct {
    const fl_world *w;
    int32_t pair;
    fl_contact_iterator spheres;
    fl_pair converted;
} fl_pair_iterator;
const fl_pair *fl_pair_next(fl_pair_iterator *at);

/* Memory of contacts, sums and slots [B]. */
double fl_contact_list_bytes(const fl_world *w);

void fl_contact_list_free(fl_sphere_contacts *s);

#endif
