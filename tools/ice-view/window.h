/* SPDX-License-Identifier: GPL-3.0-or-later */
/* window.h -- the window: play, turn, colour, click, record.  Keys and mouse: ice-view(1). */
#ifndef ICE_VIEW_WINDOW_H
#define ICE_VIEW_WINDOW_H
#include "subject.h"

/* Runs until it is closed.  -1 with FL_SYSTEM (no display, no OpenGL) or what a frame gave. */
int window_run(struct subject *s, const struct options *o, fl_err *err);

#endif
