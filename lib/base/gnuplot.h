/* SPDX-License-Identifier: GPL-3.0-or-later */
/* gnuplot.h -- run gnuplot, which need not be there. */
#ifndef FL_BASE_GNUPLOT_H
#define FL_BASE_GNUPLOT_H
#include "base/err.h"

enum { FL_GNUPLOT_STEM = 80 };

/* Run gnuplot in the folder dir on STEM.gp, which must write to the file named in the variable out, and name
 * what it drew STEM.FORMAT when it is complete; stem has less than FL_GNUPLOT_STEM bytes.  A start-up file of
 * the user's does not count.
 * Returns 0, or -1 with FL_SYSTEM: gnuplot was not found, or failed (with the last line it said). */
int fl_gnuplot_draw(const char *dir, const char *stem, const char *format, fl_err *err);

#endif
