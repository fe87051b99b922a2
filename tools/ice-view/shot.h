/* SPDX-License-Identifier: GPL-3.0-or-later */
/* shot.h -- pictures and films without a window. */
#ifndef ICE_VIEW_SHOT_H
#define ICE_VIEW_SHOT_H
#include "subject.h"

/* The picture of --at into --output; the film of --movie.  -1 with FL_INPUT, FL_USAGE or FL_SYSTEM. */
int shot_picture(struct subject *s, const struct options *o, fl_err *err);
int shot_movie(struct subject *s, const struct options *o, fl_err *err);

/* Writes a picture by the ending of its name. */
int shot_write(const char *path, const fl_picture *p, fl_err *err);

/* Checks the ending of a picture's name.  -1 with FL_USAGE. */
int shot_check_name(const char *path, fl_err *err);

#endif
