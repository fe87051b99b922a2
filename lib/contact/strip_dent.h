/* SPDX-License-Identifier: GPL-3.0-or-later */
/* strip_dent.h -- what ice keeps of a wall that has left it (contact/strip_contact.h).
 *
 * An element whose wall sector leaves the outline of the floe at e < 0 has ice missing before it, -e along
 * the normal n_k of the sector. Once all sectors have left, the floe gets a dent (fl_dent of
 * world/crushing_state.h) in its own axes: at the sector with the largest depth d, along its normal m, with
 * half width a up to the edge of the farthest, and the depth
 *     d (1 - |u/a|^q),   q so that its area is sum -e_k b_k:   q = g/(1 - g),  g = sum/(2 a d), at most 50,
 * at the distance u aside. A pile makes q near 2, a flat wall q = 50. A sector that enters a floe starts at
 *     e = -r - (depth - s) m.n_k,
 * s how deep it is in the dent already; before its own strip has ended, within its width of where it left, at
 * the e with which it left. A floe keeps FL_DENTS dents; a deeper and wider one takes the place of one at the
 * same place, then of the shallowest. failure.wear = false keeps none.
 * Limits: a dent is a curve of two numbers. Where a pile has gone in at one side and out at another, the
 * channel is known at the side where it left. */
#ifndef FL_CONTACT_STRIP_DENT_H
#define FL_CONTACT_STRIP_DENT_H
#include "contact/pair_geometry.h"
#include "world/access.h"

/* Element k leaves the floe. Less than `least` missing is a gap after a break, and forgotten [m]. */
void fl_strip_leave(fl_strip *q, const fl_wall *wall, const fl_relative_pose *r, int32_t k, double least);

/* Ice missing before element k, which enters the floe, along its normal [m]. */
double fl_strip_missing_ice(const fl_world *w, const fl_pair *p, const fl_relative_pose *r, int32_t k);

/* True if elements have left the floe with ice missing. */
int fl_strip_has_left(fl_strip *q);

/* Gives floe i the dent of a strip that has ended. By one thread. -1 with FL_SYSTEM. */
int fl_strip_keep_dent(fl_world *w, int32_t i, fl_strip *q, const fl_wall *wall, fl_err *err);

#endif
