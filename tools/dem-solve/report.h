/* SPDX-License-Identifier: GPL-3.0-or-later */
/* report.h -- the closing report: speed beside error.  Rows: dem-solve(1), CLOSING REPORT. */
#ifndef DEM_SOLVE_REPORT_H
#define DEM_SOLVE_REPORT_H
#include "run_context.h"

void write_report(const struct run *r, FILE *f);

/* A note before the run about bonds that are too long for their fracture energy; nothing without such
 * bonds. */
void note_long_bonds(const fl_world *w, FILE *f);

#endif
