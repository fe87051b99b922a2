/* SPDX-License-Identifier: GPL-3.0-or-later */
/* run_summary.h -- computes the summary of one run while its record is read. */
#ifndef FL_STAT_RUN_SUMMARY_H
#define FL_STAT_RUN_SUMMARY_H
#include "stat/record.h"
#include "stat/summary.h"

/* The line that the summary of an unfinished table has in its history. */
#define FL_RUN_OPEN_LINE "#stopped at an unknown time: the table has no closing report\n"

/* A run being read. */
typedef struct fl_run_state fl_run_state;
typedef struct {
    fl_record record;
    fl_summary sum;      /* of the rows so far: blocks and cycles as they end; see fl_run_update() */
    fl_run_state *state; /* [states] of each summarised signal, in the order of the record */
    int32_t states;
    fl_record_selection selection;
    double end;                 /* end of the last row that counts [s] */
    enum fl_run_end end_of_run; /* set by fl_run_finish() */
    char why[FL_RUN_END_TEXT];
} fl_run;

/* Open a record as a run.  selection->last must be 0.  0, or -1 with the errors of fl_record_open(). */
int fl_run_open(fl_run *r, const char *path, const fl_record_selection *selection,
                const fl_summary_settings *settings, fl_err *err);

/* Add the next time.  1, 0 at the end, -1 with the errors of fl_record_next() or FL_INPUT for an interval
 * above FL_LOG_HISTOGRAM_LONGEST. */
int fl_run_next(fl_run *r, fl_err *err);

/* Bring r->sum up to date: the total of a structure of one part equals that part and is summarised only once.
 * fl_run_finish() does it too.  0, or -1 with FL_SYSTEM in err. */
int fl_run_update(fl_run *r, fl_err *err);

/* End of the record: close peaks, blocks and cycles.  by is the "#by" line of this summary, which ends the
 * chain of the record.  0, or -1 with FL_INPUT (no row lies within the cut, or all have no duration) or
 * FL_SYSTEM. */
int fl_run_finish(fl_run *r, const char *by, fl_err *err);

/* Accepts a zeroed struct and leaves one. */
void fl_run_close(fl_run *r);

#endif
