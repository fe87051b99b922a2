/* SPDX-License-Identifier: GPL-3.0-or-later */
/* cycleplot.h -- the picture rainflow: cycles by range and mean, and how many reach which range. */
#ifndef LOADSTATS_CYCLEPLOT_H
#define LOADSTATS_CYCLEPLOT_H
#include "picture.h"

/* Write data and script for plot_make().  0, or -1 with FL_INPUT or FL_SYSTEM in err. */
int cycleplot(picture *p, fl_err *err);

#endif
