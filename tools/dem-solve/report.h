/* SPDX-License-Identifier: GPL-3.0-or-later */
/* report.h -- the closing report: speed beside error.  Rows: dem-solve(1), CLOSING REPORT. */
#ifndef DEM_SOLVE_REPORT_H
#define DEM_SOLVE_REPORT_H
#include "run_context.h"

/* REPORT_OF_RECORD: the rows that belong to the run itself, for the end of the loads.  They are the same for
 * any number of threads, and for a run that was stopped and resumed. */
enum report_kind { REPORT_WHOLE, REPORT_OF_RECORD };
void write_report(const struct run *r, FILE *f, enum report_kind kind);

/* A note before the run about bonds that are too long for their fracture energy; nothing without such
 * bonds. */
void note_long_bonds(const fl_world *w, FILE *f);

#endif
