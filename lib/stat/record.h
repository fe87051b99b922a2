/* SPDX-License-Identifier: GPL-3.0-or-later */
/* record.h -- reads signals against time from a table, one time after the other, in constant memory.
 *
 * A row of a loads table is the mean over the interval that ends at its time.  A row of any other table is a
 * sample at its time; its interval reaches half-way to its neighbours (at the ends as far outward as inward).
 * All statistics weight a row with the length of its interval. */
#ifndef FL_STAT_RECORD_H
#define FL_STAT_RECORD_H
#include <stdint.h>
#include "base/err.h"

/* Larger values are rejected.  No load is near it, and squares and sums of any number of rows stay finite. */
#define FL_RECORD_LARGEST_VALUE 1e100

enum { FL_RUN_END_TEXT = 400 };

/* Signals and rows to read.
 *   signal[signals]  columns, or fh = sqrt(fx^2 + fy^2), or f = sqrt(fx^2 + fy^2 + fz^2), for the total of
 *                    the summed components, or resistance = -(fx vx + fy vy) / sqrt(vx^2 + vy^2) of a part
 *                    that moves, 0 while it is at rest, or the overturning moment mh = sqrt(mx^2 + my^2);
 *                    signals = 0 selects fx, fy, fz, fh of a loads table
 *   part             one part or "total"; NULL selects all parts and the total
 *   about            point to which moments of loads are moved, from the reference of each part, M - p x F
 *                    [m]; NULL: none
 *   reduction        how several rows at one time are combined, fl_time_reduction
 *   where[wheres]    "COLUMN=WORD": only rows with that word in the column
 *   patience         time to wait for an ended file to grow [s], see fl_in_patience()
 *   from, to         only rows with an interval within [s]; -INFINITY and INFINITY for all
 *   last             only the rows of the last so many seconds; 0 for all
 *   after_first_load only rows at least so many seconds after the start of the first row with a non-zero
 *                    signal; 0 for all */
typedef struct {
    const char *const *signal;
    int32_t signals;
    const char *part;
    const double *about; /* [3] */
    double from, to, last, after_first_load;
    int reduction;
    const char *const *where;
    int32_t wheres;
    double patience;
} fl_record_selection;

/* Rows of one time are distinguished by their part, or combined to one value: their sum, mean, smallest,
 * largest, or count.  There is then one part, "-". */
enum fl_time_reduction {
    FL_REDUCE_NONE,
    FL_REDUCE_SUM,
    FL_REDUCE_MEAN,
    FL_REDUCE_MIN,
    FL_REDUCE_MAX,
    FL_REDUCE_COUNT,
    FL_REDUCTIONS
};

/* "sum", "mean", "min", "max", "count" for 1 .. FL_REDUCTIONS - 1. */
const char *fl_reduction_name(int reduction);

typedef struct fl_record_reader fl_record_reader;

typedef struct {
    fl_record_reader *reader;
    const char *kind; /* of the table */
    int32_t parts, signals;
    const char *const *part; /* [parts] the sum over the parts is the last one, "total"; see below */
    const char *const *signal, *const *unit; /* [signals] */
    const unsigned char *defined; /* [parts * signals] 0 where the sum over the parts is meaningless */
    int64_t n;                    /* times read so far */
    int has_motion;               /* the table has velocities of the parts */
    double t, edge[2];            /* the time as written, and the interval of its row [s] */
    const double *x;              /* [parts * signals] of part p and signal s at x[p * signals + s] */
} fl_record;

/* Open a table that has a column t and, where rows share a time, a column part or body that distinguishes
 * them. Every part must have one row at each time.  A table without such a column has one part, "-".  The
 * total is the sum over the parts of fx, fy, fz, mx, my, mz and contacts; other columns have none.  from,
 * to, last and after_first_load are left to the caller.  The parts are known after the first
 * fl_record_next(). 0, or -1 with FL_INPUT, FL_USAGE (a total that does not exist, or no signals chosen) or
 * FL_SYSTEM in err. */
int fl_record_open(fl_record *r, const char *path, const fl_record_selection *selection, fl_err *err);

/* The next time.  1, or 0 at the end, or -1 with err: FL_INPUT for no row at all, a missing, new or repeated
 * part, time that does not rise, a field that is not a number or beyond FL_RECORD_LARGEST_VALUE. A loads
 * table returns a time as soon as its last row has been read.  Any other table returns it with the first row
 * after it, and so does any table whose rows are combined: their number is not known. */
int fl_record_next(fl_record *r, fl_err *err);

/* The history of the table, its "#by" and "#stopped" lines, or NULL; and the "#set" and "#report" lines of
 * its run.  Complete at the end of the table.  Borrowed. */
const char *fl_record_history(const fl_record *r);
const char *fl_record_run_lines(const fl_record *r);

/* How the run of a record ended, known at the end of the table. */
enum fl_run_end {
    FL_RUN_ENDED,   /* as it should, or the table does not say: it is of another program */
    FL_RUN_STOPPED, /* early: why is the rest of its line "#stopped " */
    FL_RUN_OPEN /* the loads of a run have a scene at their head and no report at the end: the run was killed,
                    * or goes on */
};
enum fl_run_end fl_record_end(const fl_record *r, char why[FL_RUN_END_TEXT]);

/* Name for messages. */
const char *fl_record_name(const fl_record *r);

/* Accepts a zeroed struct and leaves one. */
void fl_record_close(fl_record *r);

#endif
