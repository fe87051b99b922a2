/* SPDX-License-Identifier: GPL-3.0-or-later */
/* gstruct.h -- the structure file g_struct.dat (kind g_struct, version 1); see g_struct(5). */
#ifndef FL_MESH_GSTRUCT_H
#define FL_MESH_GSTRUCT_H
#include <stdio.h>
#include "base/text.h"
#include "base/tool.h"
#include "geom/surface.h"
#include "mesh/bytes.h"
#include "mesh/import_options.h"

enum { FL_GSTRUCT_VERSION = 1 };

/* Column of loads(5) that holds the sum over all parts: not allowed as the name of a part. */
#define FL_GSTRUCT_TOTAL "total"

/* Read path ("-" is standard input; gzip is unpacked).  s is zeroed or freed before, and unchanged on
 * failure.  Checked, each with file and line: kind and version, known records, finite numbers, distinct
 * vertices of a triangle that precede it, cones of positive length with radii >= 0 and not both 0, part ids
 * >= 0, unique ids and names, no part without a triangle or a cone, at least one part.  Returns 0, or -1 with
 * FL_INPUT or FL_SYSTEM in err. */
int fl_gstruct_read(fl_surface *s, const char *path, fl_err *err);

/* The same from an open text, which is closed. */
int fl_gstruct_read_text(fl_surface *s, fl_text *in, fl_err *err);

/* True if b begins with "#g_struct". */
int fl_gstruct_is(const fl_bytes *b);

/* The same from a mesh file whose head has been read; b gives up its stream.  name and opt are not used:
 * parts have names, and the caller selects them. */
int fl_gstruct_read_bytes(fl_surface *s, fl_bytes *b, const char *name, fl_import_options *opt, fl_err *err);

/* Write s with its history and the history line of this run.  Write errors show in fl_out_close(). */
void fl_gstruct_write(FILE *f, const fl_surface *s, const fl_history_line *by);

#endif
