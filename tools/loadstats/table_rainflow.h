/* SPDX-License-Identifier: GPL-3.0-or-later */
/* table_rainflow.h -- the tables rainflow and damage: load cycles by range and mean, and the fatigue they do. */
#ifndef LOADSTATS_TABLE_RAINFLOW_H
#define LOADSTATS_TABLE_RAINFLOW_H
#include "stat/rainflow.h"
#include "table_stats.h"

/* The names of the columns after those that all tables have. */
void rainflow_header(FILE *f, const struct options *o);

/* The rows of one signal of one part in all its views, of TABLE_RAINFLOW or TABLE_DAMAGE; both views of a
 * signal share the classes of the matrix.  0, or -1 with FL_SYSTEM in err. */
int rainflow_write(FILE *f, const struct result *r, const struct options *o, int32_t part, int32_t signal,
                   fl_err *err);

/* The rule and what became of the residue, as all tables of cycles name them: the residue of ASTM is half
 * cycles. */
void rainflow_write_rule(FILE *f, int rule, int residue);

/* Rows of the table damage for cycles that are known, after their labels, one for each S-N line:
 *   span   how long it took to come to them [s] */
typedef struct {
    const char *part, *signal, *unit, *view;
    int rule, residue;
    int32_t n;
    const fl_cycle *cycle;
    double span;
} damage_case;
void damage_write(FILE *f, const damage_case *c, const struct options *o);

#endif
