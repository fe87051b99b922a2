/* SPDX-License-Identifier: GPL-3.0-or-later */
/* ice_push.h -- ice that is pushed with at most a line load, and walls that move: boundary.line_load,
 * iso_pack_width, drive_of.
 *
 * A driven row, a wall, or the floes that an inflow guides move as one mass M along x or y.  With R the force
 * of the ice on it, v0 the speed wanted, P = p W the largest push, p the line load, W the width:
 *     M dv/dt = A + R,    A as large as v = v0 needs, but 0 <= A <= P.
 * While the ice pushes back with less than P the speed is v0; with more, it falls, and the mass may be driven
 * back.  It never pulls.  v is advanced by half kicks at both ends of a step, as bodies are.  Without a limit
 * v = v0 always, and a wall can follow a track.
 *
 *   M   mass of the driven floes; of a wall or an inflow that of one row of mean floes across W
 *   W   between the bounds beside the drift, else the width of the row or of the field
 *   R   all forces on driven or guided floes along the way but drag; on a wall, of contacts
 * Added mass and drag of what pushes are left out.
 *
 * By ISO 19906 (2019), A.8.2, p = R_iso h^1.25 w^-0.54 MN/m with the width w of the pack and the mean
 * thickness h of the ice in metres. */
#ifndef FL_SIM_ICE_PUSH_H
#define FL_SIM_ICE_PUSH_H
#include "world/world.h"

/* Sets w->push from the scene, at the end of the set-up of a world.  -1 with FL_INPUT: bonded spheres that
 * come in with a line load, a wall that spheres meet, a track of a wall that moves along another axis. */
int fl_ice_push_make(fl_world *w, const fl_ice_field *field, const fl_ice_field *feed, fl_err *err);

/* Before and after the contacts of a step of dt from time t; only where w->push.of. */
void fl_ice_push_first_half(fl_world *w, double t);
void fl_ice_push_second_half(fl_world *w);

/* Acceleration of what pushes along its way, now [m/s2]. */
double fl_ice_push_acceleration(const fl_world *w);

/* p of ISO [N/m]; coefficient: R_iso; thickness, pack_width [m]. */
double fl_iso_line_load(double coefficient, double thickness, double pack_width);

#endif
