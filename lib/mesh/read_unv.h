/* SPDX-License-Identifier: GPL-3.0-or-later */
/* read_unv.h -- universal files (.unv) of I-DEAS, as Salome and others write them. */
#ifndef FL_MESH_READ_UNV_H
#define FL_MESH_READ_UNV_H
#include "geom/surface.h"
#include "mesh/bytes.h"
#include "mesh/import_options.h"

/* True if the first line with words is -1 alone and a later one, behind another -1, the number 2411 or
 * 2412. */
int fl_unv_is(const fl_bytes *b);

/* Add the shells and solids of the file to s.  A dataset stands between lines of -1, its number first:
 *   2411   nodes: label ..., then x y z
 *   2412   elements: label, type, ..., number of nodes; of beams a line of orientation; nodes, eight a line
 *   2467 2477 2452 2435   groups; an element belongs to the smallest that holds it
 *   164    units, of which a remark is made where they are not metres
 * and all others are skipped.  Nodes of second order go round each face.  Beams and other types are counted.
 * Source: SDRC I-DEAS, Universal dataset formats.
 * Returns 0, or -1 with FL_INPUT or FL_SYSTEM in err; s may then have new parts. */
int fl_unv_read(fl_surface *s, fl_bytes *b, const char *name, fl_import_options *opt, fl_err *err);

#endif
