/* SPDX-License-Identifier: GPL-3.0-or-later */
/* plot_history.h -- the pictures history and peaks: signals against time, classes and exceedance of their
 * peaks. */
#ifndef LOADSTATS_PLOT_HISTORY_H
#define LOADSTATS_PLOT_HISTORY_H
#include "picture.h"

extern const struct picture_kind history_picture, peaks_picture;

#endif
