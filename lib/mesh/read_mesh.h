/* SPDX-License-Identifier: GPL-3.0-or-later */
/* read_mesh.h -- reading a mesh file of any known format; the content of the file decides which. */
#ifndef FL_MESH_READ_MESH_H
#define FL_MESH_READ_MESH_H
#include "geom/surface.h"
#include "mesh/bytes.h"
#include "mesh/import_options.h"

/* A format of mesh files.  To add one, write a reader (read_x.[ch]) and add its row to the table. */
typedef struct {
    const char *name;    /* in messages, --help and README.md */
    const char *heading; /* of its entry in FORMATS of struct-import(1) */

    /* True if the head of a file (bytes.h) is of this format. */
    int (*is)(const fl_bytes *b);

    /* Add the parts of a file to s, which is empty before.  name is that of a part without one in the file.
     * 0, or -1 with FL_INPUT or FL_SYSTEM; s may then have new parts. */
    int (*read)(fl_surface *s, fl_bytes *b, const char *name, fl_import_options *opt, fl_err *err);

    int needs_all; /* the whole file must be in memory before read() */
    int selects;   /* read() selects parts and sets itself; otherwise fl_mesh_read() selects parts after it */

    const char *reads, *passes, *refuses; /* what is read, passed over and refused: struct-import(1) */
} fl_mesh_format;

/* All formats in the order in which they are tried; ends with a row whose name is NULL. */
extern const fl_mesh_format FL_MESH_FORMATS[];

/* Add the parts of a mesh file to s.
 *   path                 "-" is standard input; gzip is unpacked.  The format is recognised by content, never
 *                        by name
 *   opt                  selects parts and sets (import_options.h), NULL selects all; where it selects by
 *                        name, no part at all is a valid result
 *   note[FL_MESH_NOTE]   out: remarks for the user, each with its newline; set on failure too
 * A part without a name in the file gets the base name of the file up to its last dot ("stdin" for the
 * stream).  Parts without triangles and cones are dropped with a remark.  The history of a g_struct file is
 * appended to that of s.  Coordinates stay as in the file: nothing is scaled, welded or turned.
 * Returns 0, or -1 with FL_INPUT or FL_SYSTEM in err and s unchanged. */
int fl_mesh_read(fl_surface *s, const char *path, fl_import_options *opt, char *note, fl_err *err);

#endif
