/* SPDX-License-Identifier: GPL-3.0-or-later */
/* shards.h -- faces of a surface that s = 0 or a side of F cuts (tread.h): the parts of them that count, as
 * triangles, and sums over those, four triangles at a time. */
#ifndef FL_NARROW_SHARDS_H
#define FL_NARROW_SHARDS_H
#include "narrow/tread.h"

/* Force on F of what moves with its sides, and the moment about the origin, along x, y and n. */
typedef struct {
    fl_vec3 f, m;
} fl_shards_pull;

/* Faces list[k], k < count, of which a part may count; normal: of the surface.  *most rises to the largest s.
 */
void fl_shards_sum(const fl_tread *g, const fl_tread_tile *tile, const int32_t *corner, const fl_vec3 *normal,
                   const fl_tread_cut *list, int32_t count, fl_tread_sums *sum, fl_shards_pull *pull,
                   double *most);

#endif
