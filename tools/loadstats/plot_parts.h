/* SPDX-License-Identifier: GPL-3.0-or-later */
/* plot_parts.h -- the picture legs: mean, significant and largest value of each part, signal by signal. */
#ifndef LOADSTATS_PLOT_PARTS_H
#define LOADSTATS_PLOT_PARTS_H
#include "picture.h"

extern const struct picture_kind parts_picture;

#endif
