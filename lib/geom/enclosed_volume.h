/* SPDX-License-Identifier: GPL-3.0-or-later */
/* enclosed_volume.h -- the volume that bodies enclose, overlaps counted once, without any change of their
 * surfaces: a sum along lines by which repair is checked.
 *
 * On a line through a point (u, v) of the cross-section of the box, the winding number of body b at s is
 *     w_b(s) = sum over its triangles met at s' < s of +1 (entered) or -1 (left).
 * Bodies of a group overlap and are solid, so the group is at s if one of its w_b is not 0.  A group inside
 * another one, which it does not meet, bounds a cavity: s is inside where an odd number of groups is.  With
 * L(u, v) the length inside,
 *     V = integral of L du dv,   estimated on n lines as A / n sum L,
 * of which L is exact to rounding, so that V of a source and of its repaired surface on the same lines differ
 * only where the two do.  Lines that pass within rounding of an edge are left out of both.
 * Source: the lines are the additive sequence of Roberts (2018), of the plastic number. */
#ifndef FL_GEOM_ENCLOSED_VOLUME_H
#define FL_GEOM_ENCLOSED_VOLUME_H
#include "geom/surface.h"

typedef struct {
    double source, result; /* V of either [m^3] */
    int32_t bodies; /* of the source, at whose own lines the two differ by more than a tenth of its length */
} fl_volume_check;

/* Compare a repaired surface with the closed bodies it was made of.
 *   source  closed bodies, each wound outward or inward
 *   body    [source->nt] of each triangle, any number
 *   group   [source->nt] the same of the bodies that overlap or touch
 *   result  closed, cavities wound inward
 * The lines that are uniform give the volumes; in addition three lines go through each of up to a thousand
 * bodies, since a small one weighs nothing in the sum.
 * Returns 0, or -1 with FL_SYSTEM. */
int fl_check_volume(const fl_part *source, const int32_t *body, const int32_t *group, const fl_part *result,
                    fl_volume_check *c, fl_err *err);

/* Winding number of the closed triangles of p about x, by the solid angle of each: 1 inside a body wound
 * outward, 0 outside, n in n of them.  Of an open surface it is a number between.
 * Source: van Oosterom and Strackee, IEEE Trans. Biomed. Eng. 30 (1983) 125. */
double fl_part_winding(const fl_part *p, fl_vec3 x);

#endif
