/* SPDX-License-Identifier: GPL-3.0-or-later */
/* table_rainflow.h -- rows of the tables rainflow and damage: load cycles by range and mean, and their
 * fatigue damage. */
#ifndef LOADSTATS_TABLE_RAINFLOW_H
#define LOADSTATS_TABLE_RAINFLOW_H
#include "stat/rainflow.h"
#include "cell.h"
#include "settings.h"

/* Rows of all views of a signal.  The views share the classes of the matrix.  0, or -1 with FL_SYSTEM in
 * err. */
int rainflow_rows(FILE *f, const struct record_views *r, const struct options *o, int32_t part,
                  int32_t signal, fl_err *err);
int damage_rows(FILE *f, const struct record_views *r, const struct options *o, int32_t part, int32_t signal,
                fl_err *err);

/* The cells rule and residue of all tables of cycles; the residue of ASTM is half cycles. */
void rainflow_write_rule(FILE *f, int rule, int residue);

/* Rows of the table damage for known cycles, one for each S-N curve.
 *   span   duration of the cycles [s] */
typedef struct {
    const char *part, *signal, *unit, *view;
    int rule, residue;
    int32_t n;
    const fl_cycle *cycle;
    double span;
} damage_case;
void damage_write(FILE *f, const damage_case *c, const struct options *o);

#endif
