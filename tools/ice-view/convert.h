/* SPDX-License-Identifier: GPL-3.0-or-later */
/* convert.h -- what ice-view writes without drawing: frames as text or packed, files for ParaView, what a
 * file holds. */
#ifndef ICE_VIEW_CONVERT_H
#define ICE_VIEW_CONVERT_H
#include "subject.h"

/* --text and --packed.  -1 with FL_INPUT or FL_SYSTEM. */
int convert_frames(struct subject *s, const struct options *o, fl_err *err);

/* --vtk.  -1 with FL_INPUT or FL_SYSTEM. */
int convert_vtk(struct subject *s, const struct options *o, fl_err *err);

/* --html.  -1 with FL_INPUT, FL_USAGE or FL_SYSTEM. */
int convert_html(struct subject *s, const struct options *o, fl_err *err);

/* --info. */
int convert_info(const struct subject *s, const struct options *o, fl_err *err);

#endif
