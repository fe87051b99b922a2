/* SPDX-License-Identifier: GPL-3.0-or-later */
/* floe_cut.h -- cut a floe in two by a plane, between two steps.
 *
 * The outer sharp shape of the floe, its core moved outward by r, is cut; the cores of the halves are these
 * moved inward by r (by r/2, r/4, ... r/16 where a face would vanish), so the halves stand apart by nothing
 * and their cores by 2r: no overlap and no force. Mass and inertia partition exactly, and with
 *     v_h = v + w x (x_h - x),    w_h = w
 * so do momentum, spin and kinetic energy.  Added mass does not: the difference is `carried` in the ledger.
 *
 * The larger half keeps the place, id and history of the floe; the other takes the first free place and the
 * next id. A contact with the structure goes to the half where its centre of pressure is, with all its
 * memory; what is crushed there, and dents, go to both. A contact with another floe keeps its memory where
 * it stays with the larger half. Elastic energy of contacts that end is `fracture`. */
#ifndef FL_SIM_FLOE_CUT_H
#define FL_SIM_FLOE_CUT_H
#include "world/world.h"

/* Cut floe i at n.x = c; n and c in its body axes, n of unit length.  *child: the place of the smaller half.
 * Returns 1, 0 if it was not cut (a half is too thin for the radius, or no place is free: w->breaking counts
 * it), or -1 with FL_SYSTEM or FL_NUMERIC. */
int fl_floe_cut(fl_world *w, int32_t i, fl_vec3 n, double c, int32_t *child, fl_err *err);

/* Number of places for fragments, 0 where floes do not break. */
int32_t fl_fragment_places(const fl_scene *s, const fl_ice_field *field);

/* Builds w->breaking once the bodies are there; -1 with FL_SYSTEM. */
int fl_breaking_make(fl_world *w, fl_err *err);
void fl_breaking_free(fl_world *w);

/* Makes the core, in the axes of the ice file, that of the floe in place i. It moves into w, also on
 * failure: -1 with FL_SYSTEM or FL_INPUT. */
int fl_breaking_set_shape(fl_world *w, int32_t i, fl_poly *core, double r, fl_err *err);

/* Forgets what is known of the floe in place i, which has left. */
void fl_breaking_forget(fl_world *w, int32_t i);

#endif
