/* SPDX-License-Identifier: GPL-3.0-or-later */
/* pressure_area.h -- the pressure at which ice crushes on a nominal area.
 *
 *     p = p0 (A/A0)^-e,  at most p_max,        y = p A
 *
 *   A      nominal area: S.n of area_vector.h, n the direction of the force            [m2]
 *   p0     pressure on A0                                                                [Pa]
 *   y      force at which the contact yields                                              [N]
 *
 * Laws by name, p in MPa and A in m2:
 *   polar-class-1 .. 7  p0 = 6.0 4.2 3.0 2.45 2.0 1.5 1.3, e = 0.1: a process, ship on the edge of a floe.
 *                       From the class factors CFD = p0^0.389 of IACS UR I2
 *   iso-local           7.40 A^-0.70, 1.48 from 10 m2 on (ISO 19906; Masterson et al. 2007)
 *   api                 8.1 A^-0.5 to 29 m2, then 1.5 (API RP 2N)
 * The last two are envelopes of local design pressures, measured on windows inside a larger contact. */
#ifndef FL_FAILURE_PRESSURE_AREA_H
#define FL_FAILURE_PRESSURE_AREA_H
#include "scene/scene_types.h"

typedef struct {
    double p0, area, exponent; /* p0 [Pa], A0 [m2], e */
    double least, most;        /* bounds of p [Pa] */
} fl_pressure_area;

/* The law of a scene. */
fl_pressure_area fl_pressure_area_of(const fl_scene_failure *s);

/* p on area A > 0 [Pa]. */
double fl_crushing_pressure(const fl_pressure_area *law, double A);

#endif
