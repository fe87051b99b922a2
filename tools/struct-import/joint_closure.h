/* SPDX-License-Identifier: GPL-3.0-or-later */
/* joint_closure.h -- parts that are open, each by itself, and close together: as the plates of a hull. */
#ifndef STRUCT_IMPORT_JOINT_CLOSURE_H
#define STRUCT_IMPORT_JOINT_CLOSURE_H
#include "cleanup.h"

/* Where the open parts among m[s->n] bound a body together, their vertices being one within the tolerance of
 * welding, turn their triangles outward as the flood over all of them says, and set m[i].fits for each; what
 * is turned is counted.  Anything else is left as it is.  0, or -1 with FL_SYSTEM. */
int unite(fl_surface *s, struct mended *m, fl_err *err);

#endif
