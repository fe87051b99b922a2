/* SPDX-License-Identifier: GPL-3.0-or-later */
/* areas.h -- the places of faces: 1/2 int s^4 dA of one face over another (places.h).
 *
 * Face F is projected along the normal n_f of f onto the plane of f and cut with f and with s > 0; there
 * s = R - h, h the height of F over that plane, is linear.  Six points to a triangle integrate the fourth
 * power exactly (Dunavant, Int. J. Numer. Meth. Eng. 21 (1985) 1129).  Where F's own rim is the border,
 * moving F moves the border: two more terms of the gradient, which have no energy of their own. */
#ifndef FL_NARROW_AREAS_H
#define FL_NARROW_AREAS_H
#include "narrow/places.h"

#define FL_AREAS_COS 0.86602540378443865 /* of the angle between faces beyond which there is no area */

/* The rim of f fades out linearly over `rim` (less where f is small): a face that leaves the rim of an equal
 * one all at once would bend W. Face F of `own` over face f of `other`.  -1 when memory runs out. */
int fl_areas_face(fl_places *w, const fl_side *own, int32_t F, const fl_side *other, int32_t f, double R,
                  double behind, double rim);

/* Face F of `own` over the plane z = 0, whole: no other half of it is seen from the plane. */
int fl_areas_plane(fl_places *w, const fl_side *own, int32_t F, double R);

#endif
