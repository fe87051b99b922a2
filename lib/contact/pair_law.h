/* SPDX-License-Identifier: GPL-3.0-or-later */
/* pair_law.h -- the contact law of each pair of materials, and the stiffness of a contact of two bodies. */
#ifndef FL_CONTACT_PAIR_LAW_H
#define FL_CONTACT_PAIR_LAW_H
#include "world/world.h"

/* Makes the table w->law of all pairs of materials in the scene.  -1 with FL_SYSTEM, or FL_INPUT where
 * contact.round_law is not the same for all pairs. */
int fl_pair_law_make_table(fl_world *w, fl_err *err);

/* The law of bodies i and j. */
const fl_pair_law *fl_pair_law_of(const fl_world *w, int32_t i, int32_t j);

/* The spring of one contact point, F = k s^n, or of a patch, W = k sqrt(U). */
typedef struct {
    double k;                      /* [N/m^n]; of a patch, c [N/m2] */
    double exponent;               /* n; 0 of a patch */
    enum fl_contact_points points; /* FL_POINTS_NEAREST or FL_POINTS_PATCH */
} fl_pair_spring;

/* Stiffness of one contact point between i and j.  A point of a round core, and in `core` of a segment, is
 * Hertz's with n = 3/2, or linear by contact.round_law.  Between other cores the law decides: a patch, or n of the scene in `core`.  A
 * stiffness that the scene gives is kappa of a whole face, or of Hertz where one of the two is round; a
 * capsule in a patch gets the c that makes its end that stiff. */
fl_pair_spring fl_pair_stiffness(const fl_world *w, int32_t i, int32_t j);

/* What is evaluated for the pair with that spring: features, where the law has them and they apply, else
 * points or a patch. */
enum fl_contact_points fl_pair_points(const fl_world *w, int32_t i, int32_t j, fl_pair_spring spring);

#endif
