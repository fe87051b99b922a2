/* SPDX-License-Identifier: GPL-3.0-or-later */
/* pair_law.h -- the contact law of a pair of materials, and the stiffness of a pair of bodies. */
#ifndef FL_CONTACT_PAIR_LAW_H
#define FL_CONTACT_PAIR_LAW_H
#include "world/world.h"

/* Resolve the laws of all pairs of materials in the scene, w->law. -1 with FL_SYSTEM. */
int fl_pair_law_make_table(fl_world *w, fl_err *err);

/* The law of bodies i and j. */
const fl_pair_law *fl_pair_law_of(const fl_world *w, int32_t i, int32_t j);

/* The spring of one contact point: F = k s^n, or of a patch W = k sqrt(U). */
typedef struct {
    double k;                      /* [N/m^n]; of a patch, c [N/m2] */
    double exponent;               /* n; 0 of a patch */
    enum fl_contact_points points; /* FL_POINTS_NEAREST or FL_POINTS_PATCH */
} fl_pair_spring;

/* Stiffness of one place between i and j [N/m^n], and n.  Where a core is a point, and in `core` a segment,
 * places are Hertz's with exponent 3/2; between others they are what the scene says: of `patch` n is 0, and
 * this is its c [N/m2].  What a scene gives is kappa of a whole face, or of Hertz where one of the two is
 * round: a capsule has the c that makes its end as stiff. */
fl_pair_spring fl_pair_stiffness(const fl_world *w, int32_t i, int32_t j);

/* What is evaluated for the pair with that spring: the law of features, where it applies, in its place. */
enum fl_contact_points fl_pair_points(const fl_world *w, int32_t i, int32_t j, fl_pair_spring spring);

#endif
