/* SPDX-License-Identifier: GPL-3.0-or-later */
/* plot_rainflow.h -- the picture rainflow: cycles by range and mean, and how many reach which range. */
#ifndef LOADSTATS_PLOT_RAINFLOW_H
#define LOADSTATS_PLOT_RAINFLOW_H
#include "picture.h"

/* Write data and script for plot_make().  0, or -1 with FL_INPUT or FL_SYSTEM in err. */
int plot_rainflow(picture *p, fl_err *err);

#endif
