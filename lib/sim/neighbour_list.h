/* SPDX-License-Identifier: GPL-3.0-or-later */
/* neighbour_list.h -- the list of near pairs: a Verlet list with a skin.
 *
 * Boxes are those of the dilated cores, larger by half the skin on each side, so that no unlisted pair
 * can touch until two bodies have moved by more than the skin together.  The list is then rebuilt.  What
 * a pair remembers is carried over: the old and the new list, both sorted by (i, j) and image, are
 * merged. */
#ifndef FL_SIM_NEIGHBOUR_LIST_H
#define FL_SIM_NEIGHBOUR_LIST_H
#include "world/world.h"

/* Rebuild the list if it is due: any two odometers together have grown by more than the skin since the last
 * search, or run.search_every steps have passed.  Else add the pairs of bonds of spheres that have ended.
 * 0, or -1 with FL_SYSTEM. */
int fl_neighbour_list_update(fl_world *w, fl_err *err);

/* The same after the first half of a step, when w->blocks has the largest paths of the floes. */
int fl_neighbour_list_from_blocks(fl_world *w, fl_err *err);

/* 1 if fl_neighbour_list_from_blocks() would change the list. */
int fl_neighbour_list_due(const fl_world *w);

/* Rebuild all that depends on the list after it has changed: the pairs of each body in the order of the list,
 * next_check, pair_touches, touching_pairs.  -1 with FL_SYSTEM. */
int fl_neighbour_list_index(fl_world *w, fl_err *err);

/* Update touching_pairs, body_touches and the slots of contact_sums after pair_touches has changed. */
void fl_update_touching_pairs(fl_world *w);

#endif
