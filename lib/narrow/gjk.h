/* SPDX-License-Identifier: GPL-3.0-or-later */
/* gjk.h -- the distance of two convex cores, their nearest points and the direction between them. */
#ifndef FL_NARROW_GJK_H
#define FL_NARROW_GJK_H
#include "narrow/simplex.h"

/* Distance of the convex hulls of a and b,
 *     d = min |x - y|, x in hull(a), y in hull(b),   n = (x - y) / |x - y|,
 * by the algorithm of Gilbert, Johnson & Keerthi (1988) in three stages.
 *
 * 1. In double: simplices of vertex differences, every one taken as a difference before anything else is
 *    done with it, so that nothing depends on where the origin is.  A triangle without area falls back to
 *    its sides, a flat tetrahedron to its faces, and "the origin is inside" is only a suspicion.  Ends
 *    when no vertex lies beyond the supporting plane by more than its rounding, or after 64 supports.
 * 2. In pairs of doubles (106 bits), with all 15 parts of the simplex tried, when stage 1 suspects an
 *    overlap, did not end, or found d below 1e-4 of the extent, where rounding would turn the normal.  The
 *    right part is told by its plane, which leaves nothing of the simplex beyond it, not by its distance,
 *    which sees the square of an angle only.  Below 2^-50 of the extent the cores touch.
 * 3. From the vertices within 1e-10 of the extent of the two supporting planes alone, by closed formulae
 *    or from a fixed start; in doubles where rounding leaves n as it is (a disc of 1e-3 of the extent fits
 *    about the nearest points into what the features have in common, seen along n), in pairs where it
 *    might not: edges and outlines that nearly lie on one line, slivers.  The result is therefore a
 *    function of the cores: cold, warm and stale starts give the same bits, but for a vertex within
 *    rounding of that border, some 1 in 1 000 000 of hostile pairs.
 *
 * It ends.  Let E be the sum of the extents: of the largest distances from vertex 0.  The simplex after a
 * step holds the old nearest point v and the new vertex difference w, so its distance falls at least as far
 * as along the segment from v to w:
 *   - as long as w lies below the plane through v the distance falls strictly, no simplex comes back, and of
 *     finitely many simplices the last is the nearest;
 *   - after k supports d_k^2 - d^2 <= 16 E^2 / (k + 2), the bound of the method of Frank and Wolfe for
 *     |v|^2 / 2 over a set of diameter 2 E (Jaggi 2013, theorem 1).
 * Rounding could break the first; so stage 1 stops at 64 supports, a walk in pairs at 16 steps that gain
 * less than 4e-16 of d^2 and at 4096 altogether, and stage 3 after 4 walks of each: below 9000 supports
 * in any case (105 are the most that the pairs of prop_gjk took).
 *
 * Error, with L the larger of d and the sizes of the cores (extents, or largest sides of their boxes): 1e-13
 * L in d, 1e-12 rad in n for d from 1e-9 L up.  Where the nearest points are not unique one is returned.
 *   cache  in: where to start; out: where the next query should.  NULL starts cold.
 * Cannot fail; all coordinates finite and below 1e100 in magnitude. */
void fl_gjk(fl_core a, fl_core b, fl_gjk_cache *cache, fl_gap *out);

/* Stage 1 alone, for whom a direction will do that separates the cores by nearly their distance: n, unit
 * vector from b to a.  Returns 0 where doubles cannot tell one. */
int fl_gjk_direction(fl_core a, fl_core b, fl_gjk_cache *cache, fl_vec3 *n);

#endif
