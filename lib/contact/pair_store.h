/* SPDX-License-Identifier: GPL-3.0-or-later */
/* pair_store.h -- memory of near pairs and of contacts.
 *
 * The neighbour list has a short record for each near pair, fl_neighbour_pair.  Only pairs that touch, or
 * keep more than fits into that record, have an fl_pair, taken from a free list. */
#ifndef FL_CONTACT_PAIR_STORE_H
#define FL_CONTACT_PAIR_STORE_H
#include "world/world.h"

/* Initialises p as a pair that does not touch, without an image. */
void fl_pair_init(const fl_world *w, fl_pair *p, int32_t i, int32_t j);

/* Frees the memory that a pair owns: feature pairs, surrogate, rolling spring, strip, record of
 * crushing. */
void fl_pair_free(fl_pair *p);

/* Initialises q as a near pair that does not touch. */
void fl_neighbour_pair_init(fl_neighbour_pair *q, int32_t i, int32_t j, const int32_t image[3]);

/* Makes the pair p of a near pair q that has no contact record. */
void fl_neighbour_pair_expand(const fl_world *w, const fl_neighbour_pair *q, fl_pair *p);

/* Puts p, as it is now, back into q: into a contact record if it needs one, else into q itself, which
 * releases the record.  p is the contact record of q or was made by fl_neighbour_pair_expand().  Any thread
 * may call it.  -1 when memory runs out; p is then freed. */
int fl_neighbour_pair_put_back(fl_world *w, fl_neighbour_pair *q, fl_pair *p);

/* Frees the contact record of q. */
void fl_neighbour_pair_free(fl_world *w, fl_neighbour_pair *q);

/* Frees all near pairs of a world. */
void fl_neighbour_pairs_free(fl_world *w);

#endif
