/* SPDX-License-Identifier: GPL-3.0-or-later */
/* plot_levels.h -- the picture levels: values, fitted distributions and the interval of the best one, by
 * return period. */
#ifndef LOADSTATS_PLOT_LEVELS_H
#define LOADSTATS_PLOT_LEVELS_H
#include "picture.h"

extern const struct picture_kind levels_picture;

#endif
