/* SPDX-License-Identifier: GPL-3.0-or-later */
/* sea.h -- water and wind on all bodies: buoyancy as a force, drag as a decay of velocity. */
#ifndef FL_WATER_SEA_H
#define FL_WATER_SEA_H
#include "body/integrate.h"
#include "water/buoyancy.h"
#include "water/current.h"
#include "water/drag.h"
#include "water/facet_drag.h"

/* In the order of the choices of water.drag and wind.drag. */
enum fl_drag_law { FL_DRAG_MANUAL, FL_DRAG_FACET };

typedef struct {
    int water, wind; /* which of the two there is; neither: nothing below is allocated or run */
    double level;    /* z of the still water           [m]   */
    double weight;   /* rho g                        [N/m3]  */
    fl_fluid sea, air;
    int sea_law, air_law;      /* enum fl_drag_law */
    double sea_form, air_form; /* C_f of facet; its C_s is sea_skin, air.force */
    double sea_skin;
    fl_current current;
    fl_vec3 breeze; /* velocity of the wind [m/s] */
    int32_t n;
    fl_poly *outer;  /* [n] sharp outer shapes, body frames; empty where the core floats as it is */
    fl_hull *hull;   /* [n]                                  */
    double *reach;   /* [n] r_eff of equation (9)     [m]    */
    double *wetted;  /* [n] at the last fl_sea_force() [m2]  */
    double *lift;    /* [n] buoyancy, at the last fl_sea_force() [N] */
    double *centre;  /* [n] height of the submerged centre over still water, at the last fl_sea_force() [m] */
    fl_vec3 *flow;   /* [n] velocity of the water there [m/s] */
    double *energy;  /* [n] hydrostatic, at the last fl_sea_force() [J] */
    double *drained; /* [n] work that drag of the water has taken out [J] */
    double *blown;   /* [n] work that the wind has put in    [J] */
    /* with the law facet alone */
    int64_t *first;           /* [n + 1] pieces of body i at first[i]    */
    fl_skin_piece *wet, *dry; /* those below and above the water, flow against flow[i], 0; NULL: none */
    int32_t *wets, *dries;    /* [n] how many there are now              */
} fl_sea;

/* Arrays for n bodies; hulls are made by the caller.  -1 with FL_SYSTEM. */
int fl_sea_alloc(fl_sea *s, int32_t n, fl_err *err);
void fl_sea_free(fl_sea *s);

/* Room for the pieces of the law facet, once the hulls are made.  -1 with FL_SYSTEM. */
int fl_sea_alloc_pieces(fl_sea *s, fl_err *err);

/* Add buoyancy to b->f[i], b->t[i]; renews wetted[i] and energy[i]. */
void fl_sea_force(fl_sea *s, fl_bodies *b, int32_t i);

/* What fl_sea_force() keeps for the drag, without the force: of a body that has been put somewhere. */
void fl_sea_renew(fl_sea *s, fl_bodies *b, int32_t i);

/* Let the drag of water and wind act on body i for h seconds, position held: the decay of its
 * velocities by equations (8), (9) alone, exact, or by facet_drag.h, first of the one fluid, then of the
 * other.  Adds the work to drained[i], blown[i].
 *   back  0: water first, 1: wind first, so that two halves of a step are each other's mirror image and the
 *         splitting has order 2 */
void fl_sea_drag(fl_sea *s, fl_bodies *b, int32_t i, double h, int back);

#endif
