/* SPDX-License-Identifier: GPL-3.0-or-later */
/* plot_response.h -- the picture response: response of oscillators against time, or amplification against
 * frequency. */
#ifndef LOADSTATS_PLOT_RESPONSE_H
#define LOADSTATS_PLOT_RESPONSE_H
#include "picture.h"

extern const struct picture_kind response_picture;

#endif
