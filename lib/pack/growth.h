/* SPDX-License-Identifier: GPL-3.0-or-later */
/* growth.h -- growth of all bodies from the scale they were thrown at to 1, by quasi-static relaxation; the
 * densest packing without force; trimming.
 *
 * Growth.  s rises by 1 %, less where bodies resist, and by more and more, up to 8 %, where spheres part in a
 * few steps; after each rise the overlaps are relaxed (overlap_energy.h) as far as a few steps go.  Where as
 * many contacts as freedoms are left, the bodies are relaxed until they are free or until forces balance.
 * Forces that balance while overlaps remain mean jamming: growth ends there.  The last relaxation is made at
 * a scale larger by MARGIN, so that the packing at s = 1 is free of overlap after a finite number of steps;
 * where that jams, at s itself.
 *
 * Densest packing.  The pressure p(s), the sum of overlap times distance, vanishes linearly at s_J.  From a
 * jammed state the scale follows the secant of the last two states to near p = 0, relaxes, and so on until
 * the mean overlap is below `overlap` of the mean distance; from a scale at which spheres part it goes half
 * way back.  s_J is where the last secant reaches p = 0; the packing is compressed against it by that
 * fraction at most, and
 *     phi_J = phi(1) s_J^D.
 * Source: O'Hern, Silbert, Liu & Nagel, Phys. Rev. E 68 (2003) 011306.
 *
 * Trimming.  Of all bodies: the densest packing, radii times s_J.  Near helper walls: the radii of bodies
 * within `layers` mean sizes of a helper wall alone shrink, by TRIM each time, until the force on each helper
 * is below `share` of what a mean contact transmits.
 *
 * The run goes by stages, and all that a stage reads is in the packing and the state: it may be written after
 * any of them and read again. */
#ifndef FL_PACK_GROWTH_H
#define FL_PACK_GROWTH_H
#include "pack/overlap_energy.h"

enum fl_growth_phase {
    FL_GROWTH_RISE,    /* s rises */
    FL_GROWTH_SETTLE,  /* the last relaxation at s = 1 */
    FL_GROWTH_DENSEST, /* secants of the pressure */
    FL_GROWTH_BALANCE, /* the balance of every single body */
    FL_GROWTH_TRIM,    /* near helper walls */
    FL_GROWTH_DONE,
    FL_GROWTH_PHASES
};
extern const char *const fl_growth_phase_name[FL_GROWTH_PHASES];

enum fl_growth_trim { FL_TRIM_ALL, FL_TRIM_NEAR, FL_TRIM_NONE };

typedef struct {
    double rise;    /* relative rise of s of bodies that touch, 0.01 */
    double overlap; /* mean overlap over the distance of the densest packing, 5e-5 */
    enum fl_growth_trim trim;
    double layers, share; /* of FL_TRIM_NEAR: 2, 1e-2 */
} fl_growth_options;

fl_growth_options fl_growth_defaults(void);

typedef struct {
    int32_t phase;             /* enum fl_growth_phase */
    int32_t jammed;            /* at or before s = 1 */
    int32_t stage;             /* of this phase */
    double rise;               /* the next relative rise of s */
    double s_before, p_before; /* the last state of the secant */
    double strain;             /* mean overlap over the mean distance there */
    double jam_scale;          /* s_J; 0: not jammed */
    double reached;            /* the scale at which the bodies jammed, before decompression */
    double trimmed;            /* FL_TRIM_NEAR: smallest radius over that before; 1 */
} fl_growth;

/* State at the start, of bodies that were thrown. */
fl_growth fl_growth_start(const fl_growth_options *opt);

/* Runs the next stage; phase is FL_GROWTH_DONE after the last.  -1 with FL_SYSTEM, or FL_NUMERIC (bodies that
 * neither part nor balance). */
int fl_growth_stage(fl_growth *g, fl_overlaps *o, const fl_growth_options *opt, fl_err *err);

#endif
