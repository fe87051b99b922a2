/* SPDX-License-Identifier: GPL-3.0-or-later */
/* plot_response.h -- the picture response: the motion of an oscillator, or the amplification of many. */
#ifndef LOADSTATS_PLOT_RESPONSE_H
#define LOADSTATS_PLOT_RESPONSE_H
#include "picture.h"

/* Write data and script for plot_make().  0, or -1 with FL_INPUT or FL_SYSTEM in err. */
int plot_response(picture *p, fl_err *err);

#endif
