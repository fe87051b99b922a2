/* SPDX-License-Identifier: GPL-3.0-or-later */
/* plot_spectrum.h -- the picture spectrum: power spectral density of each signal. */
#ifndef LOADSTATS_PLOT_SPECTRUM_H
#define LOADSTATS_PLOT_SPECTRUM_H
#include "picture.h"

extern const struct picture_kind spectrum_picture;

#endif
