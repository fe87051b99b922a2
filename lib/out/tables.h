/* SPDX-License-Identifier: GPL-3.0-or-later */
/* tables.h -- the tables that a run writes: loads(5), state(5), contacts(5), bonds(5), panels(5),
 * member_forces(5), hash(5).
 *
 * A table is a list of columns.  A column is one row of that list: its name, its unit, when the table has
 * it, and the member of the row struct that it prints.  Header and rows are written from the list, and
 * test_tables.c checks the manual page against it.  The table energy(5) has its columns in
 * sim/energy_balance.c, beside the ledger that it prints.
 *
 * A header has kind, version, history, scene and column names.  A row is one line, tab-separated, with
 * numbers that read back to the same double.  Every table begins with the column t[s].  Write errors stay in
 * the stream. */
#ifndef FL_OUT_TABLES_H
#define FL_OUT_TABLES_H
#include <stddef.h>
#include <stdio.h>
#include "base/tool.h"
#include "geom/vec3.h"
#include "out/poses.h"

enum fl_column_type {
    FL_COLUMN_REAL,         /* double */
    FL_COLUMN_VEC3,         /* fl_vec3: three columns NAMEx NAMEy NAMEz */
    FL_COLUMN_VEC3_DEGREES, /* the same, in radians, written in degrees */
    FL_COLUMN_QUAT,         /* fl_quat: four columns NAMEw NAMEx NAMEy NAMEz */
    FL_COLUMN_INT,          /* int32_t */
    FL_COLUMN_TEXT,         /* const char * */
    FL_COLUMN_NAME,         /* fl_numbered_name */
    FL_COLUMN_HASH          /* uint64_t, 16 hexadecimal digits */
};

/* A name with a number behind it, written as NAME.NUMBER. */
typedef struct {
    const char *name;
    int32_t number;
} fl_numbered_name;

typedef struct {
    const char *name, *unit; /* unit "": none */
    enum fl_column_type type;
    unsigned when; /* 0: always; else a bit of `options`: the table has the column if that bit is set */
    size_t offset; /* of the value in the row struct */
} fl_column;

typedef struct {
    const char *kind;
    const fl_column *column;
    int columns;
} fl_table_format;

#define FL_TABLE_COLUMNS(list) list, (int)(sizeof(list) / sizeof *(list))

/* sets: the lines "#set ..." of the scene, or NULL.  start: when the first interval begins [s]; a line
 * "#start T" if above 0, as in a run that was resumed. */
void fl_table_write_header(FILE *f, const fl_table_format *table, unsigned options, const char *history,
                           const fl_history_line *by, const char *sets, double start);

/* Write each line of a text after "#report ", as a comment that readers pass over; the word `program`, where
 * a line begins with it, is left out. */
void fl_table_write_report(FILE *f, const char *text, const char *program);

/* The last line of the table of a run that ended early: "#stopped STATUS at t = 1.5 s: why". */
void fl_table_write_stopped(FILE *f, int status, double t, const char *why);

/* Columns that depend on the scene: PREFIX NAME[UNIT], numbers, after all others. */
typedef struct {
    int32_t n;
    const char *prefix, *unit;
    const char *const *name; /* [n] */
    const double *value;     /* [n] not read for the header */
} fl_more_columns;

/* The same with further columns; more NULL: none. */
void fl_table_write_header_more(FILE *f, const fl_table_format *table, unsigned options, const char *history,
                                const fl_history_line *by, const char *sets, double start,
                                const fl_more_columns *more);
void fl_table_write_row_more(FILE *f, const fl_table_format *table, unsigned options, double t,
                             const void *row, const fl_more_columns *more);

/* row: the row struct of the table; t [s]. */
void fl_table_write_row(FILE *f, const fl_table_format *table, unsigned options, double t, const void *row);

/* --- loads(5) ----------------------------------------------------------------------------------- */

/* Motion of a part at the end of an interval: its reference point has displacement u, velocity v and
 * acceleration a; the part has rotation vector r [rad], angular velocity w and acceleration e. */
typedef struct {
    fl_vec3 u, v, a, r, w, e;
} fl_loads_motion;

/* The columns of motion that a table of loads has: the `options` of fl_loads_table. */
enum fl_loads_motion_kind { FL_LOADS_FIXED = 0, FL_LOADS_TRANSLATION = 1, FL_LOADS_ROTATION = 3 };
enum {
    FL_LOADS_RATE = 4,
    FL_LOADS_PLATFORM = 8
}; /* columns of crushing by speed, and in platform axes; to be
                                                   * added to the above */

typedef struct {
    const char *part;
    fl_vec3 force, moment;  /* means over the interval that ends at t; moment about the reference point */
    double peak;            /* largest |force| of any step in it [N] */
    int32_t contacts;       /* bodies that touch the part at t */
    fl_loads_motion motion; /* not read with FL_LOADS_FIXED */
    double closing;         /* mean speed of the ice against the part along its load [m/s] */
    double breaks;          /* of elements of ice in the interval */
    double platform[4];     /* fx, fy, mx, my in the axes of the platform */
} fl_loads_row;
extern const fl_table_format fl_loads_table;

/* --- state(5) ----------------------------------------------------------------------------------- */

typedef struct {
    int32_t body;
    fl_vec3 x; /* centre of mass [m] */
    fl_quat q; /* rotation since the start */
    fl_vec3 v, w;
} fl_state_row;
extern const fl_table_format fl_state_table;

/* The rows of all bodies in the domain. */
void fl_state_write_rows(FILE *f, double t, const fl_poses *p);

/* --- contacts(5): output.contacts, output.events, --probe --------------------------------------- */

typedef struct {
    int32_t i, j;
    const char *mode;
    double gap;
    fl_vec3 n, p; /* normal; point [m] */
    double length, area;
    double normal;      /* component of the force on i along n [N] */
    fl_vec3 tangential; /* the rest of that force [N] */
} fl_contacts_row;
extern const fl_table_format fl_contacts_table;

/* --- bonds(5) ----------------------------------------------------------------------------------- */

typedef struct {
    int32_t i, j;
    const char *state; /* whole, damaged, broken or ended; of a joint elastic, slip or open */
    double damage, tension, shear, moment, area;
    fl_vec3 x;
    const char *joint; /* name of its joint, - for a bonded face */
} fl_bonds_row;
enum { FL_BONDS_JOINTS = 1 }; /* the table has the column joint */
extern const fl_table_format fl_bonds_table;

/* --- panels(5) ---------------------------------------------------------------------------------- */

typedef struct {
    fl_numbered_name panel; /* name of the part, number of the panel in it */
    fl_vec3 centroid;
    double area;
    fl_vec3 force; /* mean over the interval that ends at t */
} fl_panels_row;
extern const fl_table_format fl_panels_table;

/* --- member_forces(5) --------------------------------------------------------------------------- */

/* Section forces at the middle of a piece of a member, in its axes: (N, Qy, Qz) and (T, My, Mz). */
typedef struct {
    const char *member;
    int32_t piece;         /* of the member, from 1 */
    double at;             /* distance from its first node [m] */
    fl_vec3 force, moment; /* [N], [N m] */
    fl_vec3 u;             /* displacement from the unstrained state [m] */
} fl_member_forces_row;
extern const fl_table_format fl_member_forces_table;

/* --- zones(5) ----------------------------------------------------------------------------------- */

/* Stress of a zone, compression positive [Pa]. */
typedef struct {
    int32_t body, zone; /* id of the body; zone of it, from 0 */
    fl_vec3 x;          /* centroid [m] */
    double volume;      /* [m3] */
    double s[6];        /* xx yy zz xy yz zx */
    fl_vec3 principal;  /* largest first */
    double yielded;     /* plastic work per volume [J/m3] */
} fl_zones_row;
extern const fl_table_format fl_zones_table;

/* --- failures(5) -------------------------------------------------------------------------------- */

typedef struct {
    const char *mode; /* bend, split or cusp */
    int32_t parent, child;
    fl_vec3 x, n;
    double length, load, ratio, mass, child_mass, energy; /* world/breaking_state.h */
} fl_failures_row;
extern const fl_table_format fl_failures_table;

/* --- hash(5) ------------------------------------------------------------------------------------ */

typedef struct {
    uint64_t hash;
} fl_hash_row;
extern const fl_table_format fl_hash_table;

#endif
