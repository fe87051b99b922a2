/* SPDX-License-Identifier: GPL-3.0-or-later */
/* frozen.h -- the bonds of a world, bond/bond.h: which there are, and what they do in a step.
 *
 * While a bond stands its two bodies have no contact of their own.  When it is ended, which is when it bears
 * nothing, they are an ordinary pair again, whose radii are at first so much smaller that it touches nothing
 * either: the overlap of that moment is its zero.  As the overlap falls the radii come back, and never by
 * more than keeps the contact without force, so neither force nor energy jumps.  Bodies without a radius have
 * nothing to spare: what energy their contact begins with is taken from the books of the bond.
 *
 * A bonded sphere is a body like all others: its turn counts, and its pairs are of w->pair. */
#ifndef FL_STEP_FROZEN_H
#define FL_STEP_FROZEN_H
#include "world/world.h"

/* The bonds of the field whose section [bond] is on; the bodies stand as in the field, body k of it in place
 * k.  The face is the common one of the sharp shapes at the record's centroid, with the record's area; where
 * there is none, as of spheres, a disc across the line of the centres.  l is the distance of the centres
 * along the normal.  -1 with FL_SYSTEM, or FL_INPUT where the field has no bonds, or one that has no length.
 */
int fl_frozen_make(fl_world *w, const fl_field *field, fl_err *err);
void fl_frozen_free(fl_frozen *s);

/* The bond of i < j where j is in that image, -1: none. */
int32_t fl_frozen_find(const fl_world *w, int32_t i, int32_t j, const int32_t image[3]);

/* Whether that pair has no contact, as a bond stands. */
static inline int fl_frozen_stands(const fl_world *w, int32_t i, int32_t j, const int32_t image[3])
{
    if (!w->frozen.n) return 0;
    const int32_t k = fl_frozen_find(w, i, j, image);
    return k >= 0 && w->frozen.bond[k].state != FL_BOND_ENDED;
}

/* A new pair with its image: what an ended bond has left it. */
void fl_frozen_enter(const fl_world *w, fl_pair *p);

/* After a look at a pair that an ended bond left: R of the radii and `distance` of the cores, or touching
 * with what it did not before. */
void fl_frozen_return(fl_world *w, fl_pair *p, double R, double distance);
void fl_frozen_meet(fl_world *w, fl_pair *p);

/* Bonds [from, to), at the poses and velocities of now, after a step; where one ends the
 * next search finds the pair. */
enum { FL_FROZEN_LOT = 64 };
void fl_frozen_touch(fl_world *w, int32_t from, int32_t to);

/* Whether thing k has bonds. */
static inline int fl_frozen_at(const fl_world *w, int32_t k)
{
    return w->frozen.n && k < w->n && w->frozen.first[k] < w->frozen.first[k + 1];
}

/* Add what the bonds of body k do to it, in their order; and to its sink alone. */
void fl_frozen_press(const fl_world *w, int32_t k, fl_vec3 *f, fl_vec3 *t, fl_sink *sink);
void fl_frozen_sink(const fl_world *w, int32_t k, fl_sink *sink);

/* Bounds of omega^2 of body k by its bonds: all that there were, those that stand [1/s2]. */
double fl_frozen_most(const fl_world *w, int32_t k);
double fl_frozen_now(const fl_world *w, int32_t k);

/* End the bonds of those that are away. */
void fl_frozen_drop(fl_world *w);

/* What acts across bond k; the place in the cell, where there is one. */
fl_bond_load fl_frozen_load(const fl_world *w, int32_t k);

/* Separations at the poses of now, after a state has been read. */
void fl_frozen_look(fl_world *w);

/* What they store, those of friction among it; what they have spent; what damage gave to the springs of
 * friction [J]. */
typedef struct {
    double store, spring, spent, handed;
} fl_frozen_books;
fl_frozen_books fl_frozen_ledger(const fl_world *w);

/* How many are in each state; how many take more energy than G_I; of all, what they take by area in mode I
 * [J/m2], the largest l, the smallest l without snap-back [m]; the area that is broken or ended [m2]. */
typedef struct {
    int32_t state[FL_BOND_ENDED + 1], coarse;
    double energy, longest, limit, area;
} fl_frozen_count;
fl_frozen_count fl_frozen_counted(const fl_world *w);

#endif
