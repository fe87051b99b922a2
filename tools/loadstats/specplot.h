/* SPDX-License-Identifier: GPL-3.0-or-later */
/* specplot.h -- the picture spectrum: the power spectrum. */
#ifndef LOADSTATS_SPECPLOT_H
#define LOADSTATS_SPECPLOT_H
#include "picture.h"

/* Write data and script for plot_make().  0, or -1 with FL_INPUT or FL_SYSTEM in err. */
int specplot(picture *p, fl_err *err);

#endif
