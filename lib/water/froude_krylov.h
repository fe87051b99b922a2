/* SPDX-License-Identifier: GPL-3.0-or-later */
/* froude_krylov.h -- what the water of a sea does to one body: the pressure of the undisturbed wave, integrated over
 * the wetted surface,
 *     F = - int p n dA,   M = - int x x p n dA,   p = rho g (P(s, zeta) - z),
 * with P of wave.h, which falls off with depth.  The faces are cut into panels, triangles that are small
 * against the waves; each is clipped where the surface of the wave passes between its corners, and what is
 * wet is summed by a rule exact for polynomials of degree 5 (7 points), or of degree 2 (3 points) where the
 * body is small against the waves.  All bodies go this way, small ones too: it costs a few microseconds, and
 * has no border at which one formula becomes another.  p is 0 on the wave, so what the clipping misses, the
 * bend of the wave within a panel, is of second order.  In still water it is hydrostatics to rounding.
 *
 * Volume and its centre come from the same sum,
 *     V = int (z - eta) n_z dA,  V x_B = int x (z - eta) n_z dA for the horizontal part,
 *     V z_B = 1/2 int (z^2 - eta^2) n_z dA,
 * by the divergence theorem with fields that vanish on the wave.
 *
 * What is round (a sphere, a capsule) takes the tangent plane of the wave over its centre,
 *     F = rho V (g e_z + a),   a the acceleration of the water at the centre of the wetted part,
 * which is off by (k r)^2/10 of the wave's part. */
#ifndef FL_WATER_FROUDE_KRYLOV_H
#define FL_WATER_FROUDE_KRYLOV_H
#include "water/buoyancy.h"
#include "water/wave.h"

/* The panels of one body. */
typedef struct {
    int32_t n;
    int32_t *face; /* [n] its face                                 */
    fl_vec3 *v;    /* [3 n] its corners, body axes [m]             */
    int degree5;   /* the rule of degree 5                         */
} fl_hull_panels;

/* Of a body; more would take seconds a step, and mean nothing. */
enum { FL_HULL_PANELS_MAX = 1000000 };

/* Cut the faces of a hull so that no side of a panel is longer than 3/k, k the wave's `most`.  t is freed
 * first.  -1 with FL_SYSTEM, or FL_INPUT where these would be too many. */
int fl_hull_panels_make(fl_hull_panels *t, const fl_hull *hull, const fl_waves *w, fl_err *err);
void fl_hull_panels_free(fl_hull_panels *t); /* accepts a zeroed struct, leaves one */

/* The wave around one body: columns along s, and in each a series for every stretch of depth. */
typedef struct {
    double s0, width;        /* start of the first column, and width of one [m] */
    double half;             /* of the height of a row; the first reaches so far below still water [m] */
    int columns, rows, row0; /* rows below the first that are filled: row0 .. row0 + rows - 1 */
    fl_wave_expansion *cell; /* [columns][1 + rows] borrowed scratch */
} fl_wave_field;

/* How many cells a body that reaches so far from its centre may need [m]. */
int32_t fl_wave_field_cells(const fl_waves *w, double reach);

/* Fill the cells for a body between s_lo and s_hi, and from z_hi down to z_lo, at time t. */
void fl_wave_field_fill(const fl_waves *w, double s_lo, double s_hi, double z_lo, double z_hi, double t,
                        fl_wave_expansion *cell, fl_wave_field *a);

/* Elevation, slope (may be NULL) at s; the cell for a place below. */
double fl_wave_field_elevation(const fl_wave_field *a, double s, double *slope);
const fl_wave_expansion *fl_wave_field_cell(const fl_wave_field *a, double s, double zeta);

/* Where a body floats: its origin, and the world seen from it. */
typedef struct {
    fl_vec3 up, along; /* transpose(R) of e_z and of the direction of the waves   */
    double s, z;       /* of the origin: along the waves, over still water   [m]  */
} fl_hull_pose;

typedef struct {
    fl_vec3 force, moment; /* in body axes, about the origin [N], [N m]         */
    double volume;         /* submerged [m3]                                    */
    fl_vec3 centre;        /* of it, body axes; 0 when dry [m]                  */
    double wetted;         /* [m2]                                              */
} fl_water_load;

/* Force, moment and the rest of a solid in the wave around it.  weight: rho g [N/m3].  Cannot fail. */
void fl_froude_krylov_solid(const fl_hull_panels *tiles, const fl_hull *h, const fl_waves *w,
                            const fl_wave_field *a, const fl_hull_pose *at, double weight,
                            fl_water_load *push);

/* The same of what is round. */
void fl_froude_krylov_round(const fl_hull *h, const fl_waves *w, const fl_wave_field *a,
                            const fl_hull_pose *at, double weight, fl_water_load *push);

/* The tangent plane of the wave over the origin, as buoyancy.h wants it: up.x = level. */
void fl_wave_field_plane(const fl_wave_field *a, const fl_hull_pose *at, fl_vec3 *up, double *level);

#endif
