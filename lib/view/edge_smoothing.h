/* SPDX-License-Identifier: GPL-3.0-or-later */
/* edge_smoothing.h -- edges of a finished picture smoothed along their direction, in whole numbers: the
 * same bytes on every processor.  Source: after the idea of T. Lottes, FXAA, NVIDIA (2009): the direction
 * of least contrast from the four diagonal neighbours, two taps near, two further out that count where
 * their luminance stays within what the neighbourhood has. */
#ifndef FL_VIEW_EDGE_SMOOTHING_H
#define FL_VIEW_EDGE_SMOOTHING_H
#include "view/picture_rgba.h"

/* from: RGBA, w x h, both at least 2.  to: as from, all of it written.  luminance: room for w h bytes. */
void fl_smooth_edges(const unsigned char *restrict from, int w, int h, unsigned char *restrict luminance,
                     unsigned char *restrict to);

/* RGBA, rows from the top, as planes Y, U, V with a U and a V for 2 x 2 pixels (yuv420p): BT.709, limited
 * range; w and h even.  to: room for 3 w h / 2 bytes. */
void fl_picture_to_yuv(const unsigned char *restrict from, int w, int h, unsigned char *restrict to);

#endif
