/* SPDX-License-Identifier: GPL-3.0-or-later */
/* froude_krylov.h -- Froude-Krylov force on one body: the pressure of the undisturbed wave integrated over
 * its wetted surface,
 *     F = - int p n dA,   M = - int x x p n dA,   p = rho g (P(s, zeta) - z),
 * with P of wave.h, which decays with depth. The faces are cut into panels, triangles that are small compared
 * with the waves. A panel is clipped where the wave surface passes between its corners. The wet part is
 * summed by a rule exact for polynomials of degree 5 (7 points), or of degree 2 (3 points) for bodies small
 * compared with the waves. Small bodies are treated alike: this costs a few microseconds, and no border
 * separates two formulae. p is 0 on the wave surface, so the error of the clipping, the curvature of the wave
 * within a panel, is of second order. In still water the result is hydrostatics to rounding.
 *
 * Volume and its centre come from the same sum,
 *     V = int (z - eta) n_z dA,  V x_B = int x (z - eta) n_z dA for the horizontal part,
 *     V z_B = 1/2 int (z^2 - eta^2) n_z dA,
 * by the divergence theorem with fields that vanish on the wave surface.
 *
 * A sphere or a capsule uses the tangent plane of the wave above its centre,
 *     F = rho V (g e_z + a),   a the acceleration of the water at the centre of the wetted part,
 * with an error of (k r)^2/10 of the wave's part. */
#ifndef FL_WATER_FROUDE_KRYLOV_H
#define FL_WATER_FROUDE_KRYLOV_H
#include "water/buoyancy.h"
#include "water/wave.h"

/* The panels of one body. */
typedef struct {
    int32_t n;
    int32_t *face; /* [n] face of each */
    fl_vec3 *v;    /* [3 n] corners, body axes [m] */
    int degree5;   /* 1: the rule of degree 5 */
} fl_hull_panels;

/* Most panels of a body; more would take seconds per step, and be of no use. */
enum { FL_HULL_PANELS_MAX = 1000000 };

/* Cuts the faces of a hull so that no side of a panel is longer than 3/k, k = k95 of the waves. Frees t
 * first. Returns -1 with FL_SYSTEM, or FL_INPUT if the panels are too many. */
int fl_hull_panels_make(fl_hull_panels *t, const fl_hull *hull, const fl_waves *w, fl_err *err);
void fl_hull_panels_free(fl_hull_panels *t); /* accepts a zeroed struct, leaves one */

/* The wave around one body: columns along s, each with an expansion for every range of depth. */
typedef struct {
    double s0, width; /* start of the first column, and width of a column [m] */
    /* half the height of a row; the first row reaches so far below still water [m] */
    double half;
    int columns, rows, row0; /* filled rows below the first: row0 .. row0 + rows - 1 */
    fl_wave_expansion *cell; /* [columns][1 + rows] borrowed scratch */
} fl_wave_field;

/* Number of cells that a body of this reach from its centre may need [m]. */
int32_t fl_wave_field_cells(const fl_waves *w, double reach);

/* Fills the cells for a body between s_lo and s_hi, and from z_hi down to z_lo, at time t. */
void fl_wave_field_fill(const fl_waves *w, double s_lo, double s_hi, double z_lo, double z_hi, double t,
                        fl_wave_expansion *cell, fl_wave_field *a);

/* Elevation and its slope (may be NULL) at s; the cell of a point below. */
double fl_wave_field_elevation(const fl_wave_field *a, double s, double *slope);
const fl_wave_expansion *fl_wave_field_cell(const fl_wave_field *a, double s, double zeta);

/* Pose of a hull in the wave. */
typedef struct {
    fl_vec3 up, along; /* e_z and the wave direction in body axes */
    double s, z;       /* of the origin: along the waves, above still water [m] */
} fl_hull_pose;

typedef struct {
    fl_vec3 force, moment; /* body axes, about the origin [N], [N m] */
    double volume;         /* submerged [m3] */
    fl_vec3 centre;        /* centre of that volume, body axes; 0 when dry [m] */
    double wetted;         /* wetted surface [m2] */
} fl_water_load;

/* Froude-Krylov load of a solid. weight: rho g [N/m3]. Cannot fail. */
void fl_froude_krylov_solid(const fl_hull_panels *tiles, const fl_hull *h, const fl_waves *w,
                            const fl_wave_field *a, const fl_hull_pose *at, double weight,
                            fl_water_load *push);

/* The same of a sphere or capsule. */
void fl_froude_krylov_round(const fl_hull *h, const fl_waves *w, const fl_wave_field *a,
                            const fl_hull_pose *at, double weight, fl_water_load *push);

/* Tangent plane of the wave above the origin, in the form of buoyancy.h: up.x = level. */
void fl_wave_field_plane(const fl_wave_field *a, const fl_hull_pose *at, fl_vec3 *up, double *level);

#endif
