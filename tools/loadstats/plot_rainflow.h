/* SPDX-License-Identifier: GPL-3.0-or-later */
/* plot_rainflow.h -- the picture rainflow: cycles by range and mean, and the number of cycles above each
 * range. */
#ifndef LOADSTATS_PLOT_RAINFLOW_H
#define LOADSTATS_PLOT_RAINFLOW_H
#include "picture.h"

extern const struct picture_kind rainflow_picture;

#endif
