/* SPDX-License-Identifier: GPL-3.0-or-later */
/* table_rows.h -- the rows of each table, from the state of the world at time t. */
#ifndef DEM_SOLVE_TABLE_ROWS_H
#define DEM_SOLVE_TABLE_ROWS_H
#include "out/packed_frames.h"
#include "out/poses.h"
#include "out/tables.h"
#include "run_context.h"

/* The bodies in the order of the tables. */
fl_poses poses_of(const struct run *r);

/* interval: length of the interval that ends at t; its sums are cleared. */
void write_loads(struct run *r, FILE *f, double t, double interval);
void write_panels(struct run *r, FILE *f, double t, double interval);
void write_events(struct run *r, FILE *f, double t, double interval);

void write_state(struct run *r, FILE *f, double t, double interval);
void write_energy(struct run *r, FILE *f, double t, double interval);
void write_contacts(struct run *r, FILE *f, double t, double interval);
void write_hash(struct run *r, FILE *f, double t, double interval);
void write_bonds(struct run *r, FILE *f, double t, double interval);
void write_members(struct run *r, FILE *f, double t, double interval);
void write_zones(struct run *r, FILE *f, double t, double interval);
void write_failures(struct run *r, FILE *f, double t, double interval);

/* The columns of loads(5) that depend on the scene. */
unsigned loads_options(const fl_world *w);

/* The columns of modes in loads(5), for a row of a part (-1: the header), and in energy(5). NULL: no modes.
 * */
enum { MODE_COLUMNS = 256 };
struct mode_columns {
    fl_more_columns more;
    const char *name[MODE_COLUMNS];
    double value[MODE_COLUMNS];
};
const fl_more_columns *mode_displacements(const fl_world *w, int32_t part, struct mode_columns *c);
const fl_more_columns *mode_energies(const fl_world *w, struct mode_columns *c);

/* The contacts of all pairs nearer than `within` [m], with force 0: --probe. */
void write_near_pairs(struct run *r, FILE *f, double within);

/* One frame, as text where packed is NULL; shapes of floes that came in from step `since` on first, -1: none.
 * Returns -1 with FL_SYSTEM, or FL_INPUT for a place beyond what packed frames hold. */
int write_frame(const struct run *r, FILE *f, fl_packed_writer *packed, double t, int ice, int64_t since,
                fl_err *err);

#endif
