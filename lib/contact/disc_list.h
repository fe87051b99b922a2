/* SPDX-License-Identifier: GPL-3.0-or-later */
/* disc_list.h -- the bonds between spheres of a world (bond/disc.h): forces in a step, and sums.
 *
 * While a bond stands its two spheres have no contact.  In the step in which it breaks it still presses and
 * rubs; from the next one on the two are an ordinary pair, whose spring of friction begins with the shear
 * that friction held.  With contact.round_law = linear the stiffness is that of the bond, and no force jumps;
 * the difference of the energies, which is not 0 for Hertz, counts as fracture.
 *
 * Bonded spheres stay isotropic: a disc does not need their attitude. */
#ifndef FL_CONTACT_DISC_LIST_H
#define FL_CONTACT_DISC_LIST_H
#include "world/world.h"

/* The bond of i < j with that image of j (NULL: no periodic cell), -1: none. */
int32_t fl_disc_list_find(const fl_world *w, int32_t i, int32_t j, const int32_t image[3]);

static inline int fl_body_has_discs(const fl_world *w, int32_t k)
{
    const fl_disc_list *s = &w->discs;
    return s->n && k < w->n && (s->first_i[k] < s->first_i[k + 1] || s->first_j[k] < s->first_j[k + 1]);
}

/* Evaluates bonds [from, to) over a step of dt [s] at the present poses; from is a multiple of FL_DISC_RUN.
 */
void fl_disc_list_evaluate(fl_world *w, int32_t from, int32_t to, double dt);

/* Adds the forces of the bonds of bodies [from, to), each in their order, to f[0], t[0] and on; of body k. */
void fl_disc_list_add_forces_of(const fl_world *w, int32_t from, int32_t to, fl_vec3 *f, fl_vec3 *t);
void fl_disc_list_add_forces(const fl_world *w, int32_t k, fl_vec3 *f, fl_vec3 *t);

/* True if a bond stands between the two. */
static inline int fl_disc_list_is_bonded(const fl_world *w, int32_t i, int32_t j, const int32_t image[3])
{
    if (!w->discs.n) return 0;
    const int32_t k = fl_disc_list_find(w, i, j, image);
    return k >= 0 && !w->discs.has_ended[k];
}

/* Sets the spring of friction of a new contact whose bond has ended in the last step. */
void fl_disc_list_init_contact(const fl_world *w, int32_t i, int32_t j, const int32_t image[3],
                               fl_sphere_contact *c);

/* Marks all ended bonds as listed.  Called after the neighbour list has taken up their pairs. */
void fl_disc_list_forget_ended(fl_world *w);

/* Bounds of omega^2 of body k by all of its bonds at the start, and by those that stand [1/s2]. */
double fl_disc_list_max_omega2(const fl_world *w, int32_t k);
double fl_disc_list_omega2(const fl_world *w, int32_t k);

/* Ends bond k, one body of which leaves the domain: its stored energy leaves with it. */
void fl_disc_list_end_leaving(fl_world *w, int32_t k);

/* Ends the bonds of bodies that have left the domain. */
void fl_disc_list_end_absent(fl_world *w);

/* Reads and writes the memory of bond k. */
fl_disc_memory fl_disc_list_memory(const fl_disc_list *s, int32_t k);
void fl_disc_list_set_memory(fl_disc_list *s, int32_t k, const fl_disc_memory *m);

/* Vector from the centre of i to that of j of bond k [m]. */
fl_vec3 fl_disc_list_separation(const fl_world *w, int32_t k);

/* The section load of bond k; the point is inside the periodic cell. */
fl_disc_load fl_disc_list_load(const fl_world *w, int32_t k);

/* Energies of all bonds [J]: stored, dissipated by damage, dashpots and friction. */
typedef struct {
    double store, dissipated, damped, friction_loss;
} fl_disc_energies;
fl_disc_energies fl_disc_list_energies(const fl_world *w);

/* Sum of |F| of the last evaluation [N]. */
double fl_disc_list_force_sum(const fl_world *w);

/* Memory of all arrays [B]. */
double fl_disc_list_bytes(const fl_world *w);

#endif
