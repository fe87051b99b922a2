/* SPDX-License-Identifier: GPL-3.0-or-later */
/* joint_closure.h -- open parts that are closed together, as the plates of a hull. */
#ifndef STRUCT_IMPORT_JOINT_CLOSURE_H
#define STRUCT_IMPORT_JOINT_CLOSURE_H
#include "cleanup.h"

/* Find out whether the open parts among m[s->n] together bound a body, with vertices joined within the
 * tolerance of welding.  If so, orient their triangles outward by a flood fill over all of them, count the
 * reversed triangles, and set m[i].closes_jointly for each part.  Otherwise nothing changes.  0, or -1 with
 * FL_SYSTEM. */
int close_jointly(fl_surface *s, struct cleanup *m, fl_err *err);

#endif
