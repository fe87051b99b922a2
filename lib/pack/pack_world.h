/* SPDX-License-Identifier: GPL-3.0-or-later */
/* pack_world.h -- a packing moved by the steps of the library (sim/step.h): growth with friction, and rest
 * under gravity behind all walls of the region.
 *
 * The bodies get masses and contacts with damping and friction, linear for growth and those of Hertz for
 * rest, and the region becomes the boundary of a scene: a box its walls or periods, an outline or a surface
 * thin plates behind its faces, a cylinder FACETS plates.
 *
 * Growth.  The radii of spheres rise in every step by RATE of themselves, which is below 0.1 delta omega for
 * overlaps delta of 1 % and the frequency omega of the stiffest contact, and lasts more than 50 collision
 * times; other shapes grow in the same time by stages of STAGE, with a new world for each.  Velocities lose
 * DAMPING of themselves in every step (body/relaxation.h, viscous).   Bodies jam where they have nearly (D
 * + 1)/2 contacts each and the mean overlap passes JAM of the mean distance, also after a pause of growth;
 * radii then shrink by that.
 *
 * Rest.  Steps under gravity with a drag of DRAG sqrt(g/d) m v, near the critical damping of a heap, until
 * the root mean square speed is below `rest` of sqrt(g d), d the mean size, ten times in a row 100 steps
 * apart. Limits: a region sphere:... has no walls here; energies are not booked. */
#ifndef FL_PACK_PACK_WORLD_H
#define FL_PACK_PACK_WORLD_H
#include "pack/overlap_energy.h"

typedef struct {
    double gravity; /* [m/s2], along -z, in two dimensions along -y */
    double friction, restitution;
    double young, density; /* [Pa], [kg/m3] */
    double rest;
    double longest; /* simulated time of rest at most [s]; 0: 1000 sqrt(d/g) */
} fl_pack_motion;

typedef struct {
    int64_t steps;
    double time;      /* simulated [s] */
    double speed;     /* root mean square at the end over sqrt(g d) */
    int settled;      /* came to rest in the time */
    int jammed;       /* of growth */
    double jam_scale; /* scale of the packing free of force; 0: not jammed */
} fl_pack_moved;

/* Called every 100 steps; 1 to stop. */
typedef int fl_pack_motion_call(void *with, const fl_packing *p, const fl_pack_moved *m);

/* Grow to s = 1, or until bodies jam.  o: of the packing, to measure overlaps.  -1 with FL_NUMERIC or
 * FL_SYSTEM. */
int fl_pack_grow_moving(fl_packing *p, const fl_pack_region *r, const fl_pack_motion *m, fl_overlaps *o,
                        fl_pack_motion_call *call, void *with, fl_pack_moved *out, fl_err *err);

/* Rest under gravity. */
int fl_pack_settle(fl_packing *p, const fl_pack_region *r, const fl_pack_motion *m, fl_pack_motion_call *call,
                   void *with, fl_pack_moved *out, fl_err *err);

/* The boundary of a region as plates behind its faces, a part each, for [structure] of a scene.
 *   height     above and below z = 0 of the plates of an outline or a circle [m]
 *   thickness  of the plates: less than any wall between two parts of the region [m]
 * -1 with FL_INPUT (a box or a sphere) or FL_SYSTEM. */
int fl_pack_region_surface(const fl_pack_region *r, double height, double thickness, fl_surface *out,
                           fl_err *err);

#endif
