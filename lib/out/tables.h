/* SPDX-License-Identifier: GPL-3.0-or-later */
/* tables.h -- the tables a run leaves: loads, state, energy, contacts, hash.  Each header function writes
 * kind, version, history and column names; each row function one line, tab-separated, numbers that read back
 * to the same double. Write errors stay in the stream.  Formats: loads(5), state(5), energy(5), contacts(5),
 * hash(5). */
#ifndef FL_OUT_TABLES_H
#define FL_OUT_TABLES_H
#include <stdio.h>
#include "base/tool.h"
#include "narrow/contact.h"
#include "out/poses.h"

/* Motion of a part at the end of an interval: of its reference point, displacement [m], velocity and
 * acceleration, and of its turn, rotation vector [rad] (told in degrees), angular velocity and acceleration.
 */
typedef struct {
    fl_vec3 u, v, a, r, w, e;
} fl_loads_motion;

/* Which columns of motion a table of loads has. */
enum fl_loads_motion_kind { FL_LOADS_FIXED, FL_LOADS_TRANSLATION, FL_LOADS_ROTATION };

/* start: when the first interval begins [s]; above 0 where a run is gone on with. */
void fl_loads_header(FILE *f, const char *history, const fl_history_line *by, double start,
                     enum fl_loads_motion_kind moving);
/* force, moment: mean over the interval that ends at t, the moment about the reference point; peak: largest
 * |force| of any step in it; contacts: bodies that touch the part at t; motion: NULL where FL_LOADS_FIXED. */
void fl_loads_row(FILE *f, double t, const char *part, fl_vec3 force, fl_vec3 moment, double peak,
                  int32_t contacts, enum fl_loads_motion_kind moving, const fl_loads_motion *motion);

void fl_state_header(FILE *f, const char *history, const fl_history_line *by);
/* The bodies that are there: position of the centre of mass; orientation against the pose at the start, q
 * q0^-1. */
void fl_state_rows(FILE *f, double t, const fl_poses *p);

/* A row of any table of doubles. */
void fl_values_header(FILE *f, const char *kind, const char *history, const fl_history_line *by,
                      const char *columns);
void fl_values_row(FILE *f, int n, const double *x);

void fl_hash_header(FILE *f, const char *history, const fl_history_line *by);
void fl_hash_row(FILE *f, double t, uint64_t hash);

#define FL_ENERGY_COLUMNS                                                                                    \
    "t[s]\tkinetic[J]\tgravity[J]\telastic[J]\thydrostatic[J]\tfriction[J]\tdamping[J]\tdrag[J]\twind[J]"    \
    "\tdrive[J]\tcarried[J]\t"                                                                               \
    "residual[J]"
/* and behind it, of a structure that moves by itself */
#define FL_ENERGY_WAVES "\twaves[J]"
#define FL_ENERGY_MOVING "\tstructure[J]\tspring[J]\tdamper[J]"
/* and behind all that, where floes are frozen together */
#define FL_ENERGY_BONDS "\tbond[J]\tfracture[J]"

/* Frozen faces: bonds(5).  state: whole, damaged, broken or ended. */
typedef struct {
    int32_t i, j;
    const char *state;
    double damage, tension, shear, moment, area;
    fl_vec3 x;
} fl_bonds_record;
void fl_bonds_header(FILE *f, const char *history, const fl_history_line *by);
void fl_bonds_row(FILE *f, double t, const fl_bonds_record *b);

/* Loads on panels: panels(5).  name: of the part, then what tells its panels apart. */
void fl_panels_header(FILE *f, const char *history, const fl_history_line *by, double start);
void fl_panels_row(FILE *f, double t, const char *part, const char *name, fl_vec3 middle, double area,
                   fl_vec3 force);

void fl_contacts_header(FILE *f, const char *history, const fl_history_line *by);
/* normal: component of the force on i along n, slide: the rest of it [N]. */
void fl_contacts_row(FILE *f, double t, int32_t i, int32_t j, const fl_contact *c, double normal,
                     fl_vec3 slide);

#endif
