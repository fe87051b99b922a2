/* SPDX-License-Identifier: GPL-3.0-or-later */
/* plot_regimes.h -- speed of the ice, displacement and regime over time. */
#ifndef LOADSTATS_PLOT_REGIMES_H
#define LOADSTATS_PLOT_REGIMES_H
#include "picture.h"

extern const struct picture_kind regimes_picture;

#endif
