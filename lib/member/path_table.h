/* SPDX-License-Identifier: GPL-3.0-or-later */
/* path_table.h -- rows of the table of kind `path`, path(5): a point of an equilibrium path each, with chosen
 * displacements, and below them the maxima and minima of the load factor. */
#ifndef FL_MEMBER_PATH_TABLE_H
#define FL_MEMBER_PATH_TABLE_H
#include <stdio.h>
#include "base/tool.h"
#include "member/member_path.h"

/* A displacement or rotation of a node, 0 .. 5 for x y z rx ry rz; or the force or moment that its support or
 * load exerts on it, 6 .. 11 for fx fy fz mx my mz. */
typedef struct {
    int32_t node;
    int dof;
} fl_path_watch;

enum { FL_PATH_WATCH_MAX = 64 };

typedef struct {
    fl_path_watch watch[FL_PATH_WATCH_MAX];
    int watches;
    double value[4][FL_PATH_WATCH_MAX]; /* at the last four points, as the history of the path */
    int known;
    char *text; /* header apart, all that was written */
    int64_t len;
    int32_t cap;
    int limits;
} fl_path_table;

/* "NODE.x" to "NODE.rz", "NODE.fx" to "NODE.mz".  -1 with FL_USAGE. */
int fl_path_watch_parse(fl_path_watch *w, const fl_member_model *m, const char *text, fl_err *err);

/* Adds the displacement along the force of every loaded node, as long as there is room.  -1 with FL_SYSTEM.
 * */
void fl_path_table_watch_loads(fl_path_table *t, const fl_member_model *m);

/* Present value of a watched freedom; a rotation as the rotation vector since the start [rad]. */
double fl_path_watch_value(const fl_path_watch *w, const fl_member_chain *c);

/* Name of column k of the watched ones. */
const char *fl_path_watch_name(const fl_path_watch *w, const fl_member_model *m, char *buf, size_t size);

void fl_path_table_header(FILE *f, const fl_path_table *t, const fl_member_model *m,
                          const fl_history_line *by);

/* Adds the row of the present point to text, and after it a line `#limit` where a maximum or minimum was
 * passed. The start of the path has no row: call with p->point.number = 0 once before.  -1 with FL_SYSTEM. */
int fl_path_table_add(fl_path_table *t, const fl_path *p, const fl_member_model *m, fl_err *err);

void fl_path_table_free(fl_path_table *t); /* accepts a zeroed struct, leaves one */

#endif
