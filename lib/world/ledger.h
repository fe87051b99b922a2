/* SPDX-License-Identifier: GPL-3.0-or-later */
/* ledger.h -- the energy ledger [J]: stores, sinks and sources.
 *
 *     residual = stores - start + sinks - sources,
 * 0 but for the error of the time integration.  sim/energy_ledger.h books the works of each step,
 * sim/energy_balance.h fills in the rest and has the columns of the table energy(5). */
#ifndef FL_WORLD_LEDGER_H
#define FL_WORLD_LEDGER_H

typedef struct {
    double kinetic, gravity, elastic, hydrostatic; /* stores; elastic: contacts with their friction springs */
    double friction_now, damping_now, drag;        /* sinks since the start */
    double wind, drive_now;                        /* sources: wind; work of prescribed motions */
    double waves;                                  /* source: waves, with the work of buoyancy */
    double structure, spring,
        damper;            /* parts that move freely: kinetic and spring energy (stores), dashpots */
    double zones;          /* store: strain of deformable blocks */
    double plastic;        /* sink: zones and sections of members that yield, members that part */
    double bond, fracture; /* bonds: store; sink by damage */
    double crushing;       /* sink: ice that yields under pressure */
    double carried;        /* source: floes that came in, less those that left */
    double push, push_impulse, push_way; /* of what pushes with a limited force: its work, which is in
                                          * drive_now; impulse [N s], way [m]; information */
    double start, residual; /* sum of the stores, and of what joints lost before the first step; see above */
    double throughput;      /* largest sum so far of kinetic energies, |sinks| and |sources|: the
                                       * scale of the residual */
    double friction, damping, drive; /* works booked so far, with those of the half kick to come */
} fl_ledger;

#endif
