/* SPDX-License-Identifier: GPL-3.0-or-later */
/* hems.h -- edges of a core A over triangles and edges of a surface B, and edges of B over edges of A: the
 * places of strips.h, four matches at a time.
 *
 * Heights over the planes, what of an edge is beyond all of them, and its foot on the other edge are found
 * by registers; a match that is left with something has its places as in strips.h.  Each has them by itself
 * and in the order of the list: not a bit depends on what else is listed. */
#ifndef FL_NARROW_HEMS_H
#define FL_NARROW_HEMS_H
#include "narrow/matches.h"

typedef struct fl_hem fl_hem;

/* Zeroed to start. */
typedef struct {
    fl_hem *four;
    int32_t n, cap;
} fl_hems;

/* Take out of the matches l of A and B, whose rows begin at row[l->n], those of these kinds: taken[l->n] is
 * set to `mark` where it was 0.  -1 when memory runs out. */
int fl_hems_list(fl_hems *h, const fl_matches *l, const int32_t *row, const fl_side *A, const fl_side *B,
                 uint8_t *taken, uint8_t mark);

/* Their places now, added to w, where A has been entered; `behind` as in matches.h.  -1 when memory runs out.
 */
int fl_hems_places(const fl_hems *h, fl_places *w, const fl_side *A, const fl_side *B, double R,
                   double behind);

void fl_hems_free(fl_hems *h);

#endif
