/* SPDX-License-Identifier: GPL-3.0-or-later */
/* bond_list.h -- the bonds of a world, bond/bond.h: which there are, and what they do in a step.
 *
 * While a bond stands its two bodies have no contact of their own.  When it is ended, which is when it bears
 * nothing, they are an ordinary pair again, whose radii are at first so much smaller that it touches nothing
 * either: the overlap of that moment is its zero.  As the overlap falls the radii come back, and never by
 * more than keeps the contact without force, so neither force nor energy jumps.  Bodies without a radius have
 * nothing to spare: what energy their contact begins with is taken from the books of the bond.
 *
 * A bonded sphere is a body like all others: its turn counts, and its pairs are of w->pair. */
#ifndef FL_CONTACT_BOND_LIST_H
#define FL_CONTACT_BOND_LIST_H
#include "world/world.h"

/* The bonds of the field whose section [bond] is on; the bodies stand as in the field, body k of it in place
 * k.  The face is the common one of the sharp shapes at the record's centroid, with the record's area; where
 * there is none, as of spheres, a disc across the line of the centres.  l is the distance of the centres
 * along the normal.  -1 with FL_SYSTEM, or FL_INPUT where the field has no bonds, or one that has no length.
 */
int fl_bond_list_make(fl_world *w, const fl_ice_field *field, fl_err *err);
void fl_bond_list_free(fl_bond_list *s);

/* The bond of i < j where j is in that image, -1: none. */
int32_t fl_bond_list_find(const fl_world *w, int32_t i, int32_t j, const int32_t image[3]);

/* Whether that pair has no contact, as a bond stands. */
static inline int fl_bond_list_is_bonded(const fl_world *w, int32_t i, int32_t j, const int32_t image[3])
{
    if (!w->bonds.n) return 0;
    const int32_t k = fl_bond_list_find(w, i, j, image);
    return k >= 0 && w->bonds.bond[k].state != FL_BOND_ENDED;
}

/* A new pair with its image: what an ended bond has left it. */
void fl_bond_list_init_pair(const fl_world *w, fl_pair *p);

/* After a look at a pair that an ended bond left: R of the radii and `distance` of the cores, or touching
 * with what it did not before. */
void fl_bond_list_restore_radii(fl_world *w, fl_pair *p, double R, double distance);
void fl_bond_list_first_contact(fl_world *w, fl_pair *p);

/* Bonds [from, to), at the poses and velocities of now, after a step; where one ends the
 * next search finds the pair. */
enum { FL_BOND_LIST_RUN = 64 };
void fl_bond_list_evaluate(fl_world *w, int32_t from, int32_t to);

/* Whether thing k has bonds. */
static inline int fl_body_has_bonds(const fl_world *w, int32_t k)
{
    return w->bonds.n && k < w->n && w->bonds.first[k] < w->bonds.first[k + 1];
}

/* Add what the bonds of body k do to it, in their order; and to its sink alone. */
void fl_bond_list_add_forces(const fl_world *w, int32_t k, fl_vec3 *f, fl_vec3 *t, fl_contact_sum *sink);
void fl_bond_list_add_sums(const fl_world *w, int32_t k, fl_contact_sum *sink);

/* Bounds of omega^2 of body k by its bonds: all that there were, those that stand [1/s2]. */
double fl_bond_list_max_omega2(const fl_world *w, int32_t k);
double fl_bond_list_omega2(const fl_world *w, int32_t k);

/* End the bonds of those that are away. */
void fl_bond_list_end_absent(fl_world *w);

/* What acts across bond k; the place in the cell, where there is one. */
fl_bond_load fl_bond_list_load(const fl_world *w, int32_t k);

/* Separations at the poses of now, after a state has been read. */
void fl_bond_list_refresh(fl_world *w);

/* What they store, those of friction among it; what they have spent; what damage gave to the springs of
 * friction [J]. */
typedef struct {
    double store, spring, spent, transferred;
} fl_bond_energies;
fl_bond_energies fl_bond_list_energies(const fl_world *w);

/* How many are in each state; how many take more energy than G_I; of all, what they take by area in mode I
 * [J/m2], the largest l, the smallest l without snap-back [m]; the area that is broken or ended [m2]. */
typedef struct {
    int32_t state[FL_BOND_ENDED + 1], coarse;
    double energy, longest, limit, area;
} fl_bond_counts;
fl_bond_counts fl_bond_list_counts(const fl_world *w);

#endif
