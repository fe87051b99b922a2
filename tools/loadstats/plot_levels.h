/* SPDX-License-Identifier: GPL-3.0-or-later */
/* plot_levels.h -- the picture levels: values, laws and the interval of the best one, by return period. */
#ifndef LOADSTATS_PLOT_LEVELS_H
#define LOADSTATS_PLOT_LEVELS_H
#include "picture.h"

/* Make the picture p->what of the part p->part, where a law can be fitted to one of its signals; *made counts
 * it.  0, or -1 with FL_SYSTEM in err. */
int plot_levels(picture *p, int *made, fl_err *err);

#endif
