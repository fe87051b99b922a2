/* SPDX-License-Identifier: GPL-3.0-or-later */
/* gjk.h -- distance of two convex cores, their closest points and the direction between them. */
#ifndef FL_NARROW_GJK_H
#define FL_NARROW_GJK_H
#include "narrow/simplex.h"

/* Distance of the convex hulls of a and b,
 *     d = min |x - y|, x in hull(a), y in hull(b),   n = (x - y) / |x - y|,
 * by the algorithm of Gilbert, Johnson & Keerthi (1988) in three stages.
 *
 * 1. In doubles (gjk_double.h).  Vertices enter as differences only, so the result does not depend on the
 *    origin.  A triangle without area falls back to its sides, a flat tetrahedron to its faces; "the
 *    origin is inside" is only a suspicion.  It ends when no vertex lies beyond the supporting plane by
 *    more than rounding, or after 64 supports.
 * 2. In double-double arithmetic, 106 bits (gjk_dd.h), with all 15 sub-simplices tried.  It runs when stage 1
 *    suspects an overlap, did not end, or found d below 1e-4 of the extent, where rounding would turn the
 *    normal.  The right sub-simplex is recognised by its plane, which leaves nothing of the simplex beyond
 *    it, not by its distance, which depends on the square of an angle only.  Below 2^-50 of the extent the
 *    cores touch.
 * 3. From the vertices within 1e-10 of the extent of the two supporting planes alone, by closed formulae
 *    (closest_simplex.h) or from a fixed start.  Doubles are used where rounding does not change n: where a
 *    disc of 1e-3 of the extent about the closest points fits into the common part of the features, seen
 *    along n.  Double-doubles are used elsewhere: edges and outlines nearly on one line, slivers.  The
 *    result is therefore a function of the cores: cold, warm and stale starts give the same bits, except
 *    for a vertex within rounding of the 1e-10 border, about 1 in 1 000 000 of hostile pairs.
 *
 * Termination.  Let E be the sum of the extents (largest distances from vertex 0).  The simplex after a step
 * contains the old closest point v and the new vertex difference w, so its distance falls at least as far as
 * along the segment from v to w:
 *   - as long as w lies below the plane through v the distance falls strictly, no simplex repeats, and of
 *     finitely many simplices the last is the closest;
 *   - after k supports d_k^2 - d^2 <= 16 E^2 / (k + 2), the bound of the Frank-Wolfe method for |v|^2 / 2
 *     over a set of diameter 2 E (Jaggi 2013, theorem 1).
 * Rounding could break the first.  So stage 1 stops at 64 supports, stage 2 at 16 steps that gain less than
 * 4e-16 of d^2 and at 4096 in all, and stage 3 after 4 rounds of each: below 9000 supports in any case (105
 * is the most seen for the pairs of prop_gjk).
 *
 * Error, with L the larger of d and the sizes of the cores (extents, or largest sides of their boxes): 1e-13
 * L in d, 1e-12 rad in n for d from 1e-9 L up.  Where the closest points are not unique one pair is returned.
 *     cache   in: where to start; out: where the next query should start.  NULL: cold
 * Cannot fail; all coordinates finite and below 1e100 in magnitude. */
void fl_gjk(fl_core a, fl_core b, fl_gjk_cache *cache, fl_gap *out);

/* Stage 1 alone: a unit vector n from b to a that separates the cores by nearly their distance.  Returns 0
 * where doubles cannot find one. */
int fl_gjk_direction(fl_core a, fl_core b, fl_gjk_cache *cache, fl_vec3 *n);

#endif
