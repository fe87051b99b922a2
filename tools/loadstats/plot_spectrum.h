/* SPDX-License-Identifier: GPL-3.0-or-later */
/* plot_spectrum.h -- the picture spectrum: the power spectrum. */
#ifndef LOADSTATS_PLOT_SPECTRUM_H
#define LOADSTATS_PLOT_SPECTRUM_H
#include "picture.h"

/* Write data and script for plot_make().  0, or -1 with FL_INPUT or FL_SYSTEM in err. */
int plot_spectrum(picture *p, fl_err *err);

#endif
