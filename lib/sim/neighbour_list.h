/* SPDX-License-Identifier: GPL-3.0-or-later */
/* neighbour_list.h -- which pairs are near, kept until something has moved far enough to make it untrue. */
#ifndef FL_SIM_NEIGHBOUR_LIST_H
#define FL_SIM_NEIGHBOUR_LIST_H
#include "world/world.h"

/* Renew the list of near pairs when it may be incomplete: when any two odometers together have grown by more
 * than the skin since the last search, or when the scene's search_every steps have passed.  Boxes are those
 * of the dilated cores, grown by half the skin each, so that no pair can touch unlisted.  What a pair
 * remembers is carried over by merging the two lists, both sorted by (i, j), then by image.  Returns 0, or -1
 * with FL_SYSTEM. */
int fl_neighbour_list_update(fl_world *w, fl_err *err);

/* The same behind the first half of a step, where groups of floes have told how far they have come. */
int fl_neighbour_list_from_blocks(fl_world *w, fl_err *err);

/* Whether that would search. */
int fl_neighbour_list_due(const fl_world *w);

/* Renew w->inc, the pairs of each body in the order of the list, w->hit and w->live, after the list has
 * changed.  -1 with FL_SYSTEM. */
int fl_neighbour_list_index(fl_world *w, fl_err *err);

/* Renew w->live, w->met and what w->sink has for them after w->hit has changed. */
void fl_update_touching_pairs(fl_world *w);

#endif
