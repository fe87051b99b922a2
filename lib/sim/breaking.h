/* SPDX-License-Identifier: GPL-3.0-or-later */
/* breaking.h -- floes that bend (failure/bending.h) and split (failure/splitting.h) under their contacts.
 *
 * After each step the floes that touch the structure are looked at: one whose vertical load is above the
 * gate of bending,
 *     min(0.1, 0.35 tan(theta/2), W/(2 l_b)) s_f h^2
 *   theta, W, h   its sharpest corner, its least width, its thickness
 *   s_f, l_b      flexural strength; length of a beam on water
 * or whose load is above 0.2 K_IC h sqrt(L) for splitting, is checked; and again when the load has grown by
 * 2 %. A floe that breaks is cut (floe_cut.h) across the direction, or along the line, that is loaded most:
 * in the order of floe ids, one cut a floe and step, bending before splitting.
 *
 * A strip that is wider than 1.5 times what bent is cut twice more, from the ends of the contact to the ends
 * of that width: the cusp between comes off, and the two side pieces are free.
 *
 * Floes with fixed rotations about z do not split, and driven or guided floes do not break, nor do shapes
 * that are no upright prisms in the ice file. Nothing of less than fragment_min, or too light for the step,
 * is cut off; such breaks are counted. A rigid floe stores no bending energy, so none is released: it is in
 * failures(5) only.
 *
 * Limits.  The static field of bending is linear: a deck awash or a bottom in the air is in it only for long
 * floes, as the end of the foundation. Bending faster than the wave speed of the plate is not
 * distinguished. */
#ifndef FL_SIM_BREAKING_H
#define FL_SIM_BREAKING_H
#include "world/world.h"

/* Checks the floes after the contacts of a step and cuts those that break. -1 with FL_SYSTEM or
 * FL_NUMERIC. */
int fl_breaking_step(fl_world *w, fl_err *err);

/* Largest over the floes that break [m2]: least plan area of a fragment, and what the step bears of it
 * (critical_step.h). -1 with FL_SYSTEM. */
int fl_breaking_least_area(const fl_world *w, double *given, double *borne, fl_err *err);

#endif
