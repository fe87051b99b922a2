/* SPDX-License-Identifier: GPL-3.0-or-later */
/* gnuplot.h -- runs gnuplot, if it is installed. */
#ifndef FL_BASE_GNUPLOT_H
#define FL_BASE_GNUPLOT_H
#include "base/err.h"

enum { FL_GNUPLOT_STEM = 80 };

/* 1 if a program gnuplot can be started. */
int fl_gnuplot_is_there(void);

/* Runs gnuplot in the folder dir on STEM.gp, which must write to the file named by its variable `out`.  The
 * complete picture gets the name STEM.FORMAT.  stem has less than FL_GNUPLOT_STEM bytes.  The user's start-up
 * file is ignored.
 * Returns 0, or -1 with FL_SYSTEM if gnuplot is missing or failed (with its last message). */
int fl_gnuplot_draw(const char *dir, const char *stem, const char *format, fl_err *err);

#endif
