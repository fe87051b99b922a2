/* SPDX-License-Identifier: GPL-3.0-or-later */
/* pair_store.h -- memory of near pairs and of contacts. */
#ifndef FL_CONTACT_PAIR_STORE_H
#define FL_CONTACT_PAIR_STORE_H
#include "world/world.h"

/* A new pair that does not touch. */
void fl_pair_init(const fl_world *w, fl_pair *p, int32_t i, int32_t j);

/* Free what a pair has of its own. */
void fl_pair_free(fl_pair *p);

/* Two things are near, and do not touch. */
void fl_neighbour_pair_init(fl_neighbour_pair *q, int32_t i, int32_t j, const int32_t image[3]);

/* The pair that it is, where it has none of its own. */
void fl_neighbour_pair_expand(const fl_world *w, const fl_neighbour_pair *q, fl_pair *p);

/* Keep p, as it is now: a contact has room of its own, of others lasts what has to.  p is its own, or such as
 * fl_neighbour_pair_expand() made; any thread.  -1 when memory runs out: then p has been ended. */
int fl_neighbour_pair_store(fl_world *w, fl_neighbour_pair *q, fl_pair *p);

/* Free what it has of its own. */
void fl_neighbour_pair_free(fl_world *w, fl_neighbour_pair *q);

/* End all near pairs of a world. */
void fl_neighbour_pairs_free(fl_world *w);

#endif
