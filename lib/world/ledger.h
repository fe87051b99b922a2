/* SPDX-License-Identifier: GPL-3.0-or-later */
/* ledger.h -- the energy ledger: stores, sinks and sources. */
#ifndef FL_WORLD_LEDGER_H
#define FL_WORLD_LEDGER_H

/* Stores, sinks and sources of energy [J].  The residual is stores - start + taken out - put in: 0 but for
 * the error of the time integration. */
typedef struct {
    double kinetic, gravity, elastic, hydrostatic; /* stores now; elastic with the springs of friction */
    double friction_now, damping_now, drag;        /* taken out since the start                        */
    double wind, drive_now;                        /* put in: by the wind, by what is moved or held    */
    double waves;                                  /* and by waves, the work of buoyancy with it */
    double structure, spring,
        damper;            /* of a structure that moves by itself: in it, in its springs; taken out */
    double bond, fracture; /* in bonds; taken out by their damage */
    double carried;        /* put in by floes that came, less what left with others */
    double start, residual;
    double throughput; /* largest kinetic energy + |each of the works|: what the residual is held against */
    double friction, damping, drive; /* the works booked so far: with that of the half kick that lies ahead */
} fl_ledger;

#endif
