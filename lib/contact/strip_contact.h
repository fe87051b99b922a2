/* SPDX-License-Identifier: GPL-3.0-or-later */
/* strip_contact.h -- a floe and a wall of the structure under failure.crushing_law = rate.
 *
 * Each sector of the wall (failure/strip_wall.h) that is inside the floe has an element of ice in front of it
 * (failure/strip.h), which is fixed to the wall. With S_i the area vector of sector i inside the floe, out of
 * the wall, the floe feels at the centre of S_i the force
 *     f_i = k z_i S_i,      k = R p(A)/delta,
 * p(A) of failure/pressure_area.h, times the strength along the drift. A is the largest of this contact of
 * |sum S_i|, or of sum max(0, S_i.d) with d against the motion of the ice, over sectors with e > -4 delta R:
 * of a pile D h, whether ice is in front of it or all around. In a step the wall closes by dq_i = -dt
 * v_i.n_i, v_i the velocity of the ice against the wall.
 *   - A sector that enters the floe has a gap e = -r, and more where a wall has been (contact/strip_dent.h).
 *     Behind a pile e falls: the channel bears no load.
 *   - Ice that slides by s along the wall is passed on, e_i -= |s|/b (e_i - e_upwind), and u alike, once per
 *     hundredth of a sector's width of motion.
 * The law of the pair is not evaluated; its friction acts at the centre of the forces.
 *
 * Energy. In a step sum (f_i0 + f_i1)/2 dq_i is what the bodies lose, to rounding and telescoping terms; what
 * of it is not stored afterwards is `work`, and goes to the column crushing of energy(5): creep, delayed
 * strain, breaks, changes of k and of areas. A floe must be thicker than it is tilted: areas are found anew
 * after a tenth of a sector's width of motion. */
#ifndef FL_CONTACT_STRIP_CONTACT_H
#define FL_CONTACT_STRIP_CONTACT_H
#include "contact/pair_geometry.h"
#include "patch/stiffness_bound.h"
#include "world/access.h"

/* True if pair p is such a contact. */
static inline int fl_pair_has_strip(const fl_world *w, int32_t j)
{
    return w->strips.wall && j >= w->n && j < w->n + w->strips.pieces && w->strips.wall[j - w->n].n > 0;
}

/* Results in the frame of the piece, on the floe. */
typedef struct {
    fl_wrench force;        /* about the origin of the frame */
    double normal;          /* sum of |f_i| [N] */
    fl_vec3 centre;         /* of the forces [m] */
    double slope;           /* sum of k |S_i| [N/m] */
    int touches;            /* a sector is in the floe */
    double max_depth;       /* largest z [m] */
    fl_spring_sums springs; /* of sectors near the ice, about the origin; only with survey */
} fl_strip_result;

/* A strip in front of a wall, no element of which is in ice; NULL when memory runs out. */
fl_strip *fl_strip_make(const fl_wall *wall);

/* Puts element k of the strip to the height of FL_STRIP_MIDDLE. */
void fl_strip_place(fl_strip *q, const fl_wall *wall, int32_t k);

/* Advances the strip of pair p by dt and evaluates it; makes p->strip. -1 when memory runs out. */
int fl_strip_contact_advance(fl_world *w, fl_pair *p, const fl_relative_pose *r, double dt, int survey,
                             fl_strip_result *out);

#endif
