/* SPDX-License-Identifier: GPL-3.0-or-later */
/* sphere_pair.h -- which pairs are sphere contacts, and helpers for a single one. */
#ifndef FL_SPHERE_SPHERE_PAIR_H
#define FL_SPHERE_SPHERE_PAIR_H
#include "world/world.h"

/* Kinds of sphere contacts (world/sphere_contacts.h), for laws that have them: two spheres, that is
 * isotropic bodies, or one and a rigid wall of the boundary.  All other pairs are in w->pair. */
enum fl_sphere_kind { FL_SPHERE_NONE, FL_SPHERE_SPHERE, FL_SPHERE_WALL };

/* Kind of the pair i < n, j < total. */
enum fl_sphere_kind fl_sphere_pair_kind(const fl_world *w, int32_t i, int32_t j);

/* Exponent of all sphere contacts. */
static inline double fl_round_exponent(const fl_world *w) { return w->law[0].round_exponent; }

/* Adds to the number of contacts that touch body i; any thread. */
static inline void fl_sphere_add_contact_count(fl_sphere_contacts *s, int32_t i, int32_t by)
{
#pragma omp atomic
    s->contact_count[i] += by;
}

/* Energy of the springs of friction and rolling of a sphere contact [J]. */
static inline double fl_sphere_spring_energy(const fl_sphere_contact *r, const fl_rolling_spring *roll)
{
    return (r->spring_stiffness > 0.0 ? 0.5 * v3_norm2(r->spring_force) / r->spring_stiffness : 0.0) +
           (roll ? fl_rolling_energy(*roll) : 0.0);
}

/* Converts a sphere contact to an fl_pair, at the overlap `over` along n, from j to i: all but its image
 * and the forces on j. */
void fl_sphere_contact_to_pair(const fl_world *w, int32_t i, int32_t j, const fl_sphere_contact *r,
                               const fl_rolling_spring *roll, int touches, fl_vec3 n, double over,
                               fl_pair *p);

/* One past the last body of chunk a. */
static inline int32_t fl_chunk_end(const fl_sphere_contacts *s, int32_t a)
{
    const int32_t end = (a + 1) * FL_SPHERE_CHUNK;
    return end < s->bodies ? end : s->bodies;
}

/* D = x_i - x_j of contact c, with the image of j, mostly the one in the same cell. */
static inline fl_vec3 fl_sphere_separation(const fl_world *w, int32_t c)
{
    const fl_sphere_contacts *s = &w->spheres;
    const fl_vec3 d = v3_sub(w->b.x[s->i[c]], w->b.x[s->j[c]]);
    const int32_t *e = s->image ? &s->image[3 * c] : NULL;
    return e && (e[0] | e[1] | e[2]) ? v3_sub(d, fl_periodic_cell_offset(&w->cell, v3(e[0], e[1], e[2]))) : d;
}

#endif
