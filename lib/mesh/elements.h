/* SPDX-License-Identifier: GPL-3.0-or-later */
/* elements.h -- a finite element mesh: nodes and elements with their numbers, parts and named sets.
 *
 * A reader adds rows in the order of its file and ends with fl_elements_surface() (element_surface.h). */
#ifndef FL_MESH_ELEMENTS_H
#define FL_MESH_ELEMENTS_H
#include <stdint.h>
#include "base/string_table.h"
#include "geom/surface.h"
#include "mesh/bytes.h"
#include "mesh/id_map.h"
#include "mesh/import_options.h"

/* Shapes of elements.  Corners come first, then the mid-side nodes, as in Abaqus and VTK:
 *     LINE3     0 1, mid 01
 *     TRI6      0 1 2, mids 01 12 20
 *     QUAD8     0 1 2 3, mids 01 12 23 30;  QUAD9 with the centre behind them
 *     TET10     0 1 2 and the apex 3, mids 01 12 20 03 13 23
 *     PYRAMID13 base 0 1 2 3 and the apex 4, mids 01 12 23 30 04 14 24 34
 *     WEDGE15   0 1 2 under 3 4 5, mids 01 12 20 34 45 53 03 14 25
 *     HEX20     0 1 2 3 under 4 5 6 7, mids 01 12 23 30 45 56 67 74 04 15 26 37
 * (Nastran swaps the last two groups of mids of WEDGE15 and HEX20.)  A solid may be right-handed or
 * left-handed.  Nodes may repeat: the element then collapses to a simpler shape. */
enum fl_shape {
    FL_LINE2,
    FL_LINE3,
    FL_TRI3,
    FL_TRI6,
    FL_QUAD4,
    FL_QUAD8,
    FL_QUAD9,
    FL_TET4,
    FL_TET10,
    FL_PYRAMID5,
    FL_PYRAMID13,
    FL_WEDGE6,
    FL_WEDGE15,
    FL_HEX8,
    FL_HEX20,
    FL_SHAPES
};

typedef struct {
    int32_t first;   /* its nodes are connectivity[first .. first + fl_shape_nodes(shape)) */
    int32_t part;    /* index in parts; -1: not structure, counted in skipped */
    int32_t section; /* index in section, -1 for none; lines only */
    int32_t line;    /* of its definition, for messages; 0 in binary data */
    int32_t file;    /* index in files */
    uint8_t shape;
} fl_element;

/* An element of a set: the whole element, one of its faces, or its free faces, which no other solid of the
 * file has.  A shell or a line is always taken whole. */
enum { FL_PICK_WHOLE = -1, FL_PICK_FREE = -2 };
typedef struct {
    int32_t element, set;
    int8_t face;     /* >= 0, or one of the above */
    int8_t reversed; /* a shell seen from its other side */
} fl_pick;

typedef struct {
    fl_id_map node_id;     /* number of each node */
    fl_vec3 *x;            /* [node_id.n] position; x.x is nan for a node that is used but not yet defined */
    fl_id_map element_id;  /* number of each element */
    fl_element *element;   /* [element_id.n] */
    int32_t *connectivity; /* nodes of elements, -1 for an omitted mid-side node */
    int32_t connectivity_n;
    fl_string_table parts, sets, files, skipped;
    fl_pick *pick; /* [picks] */
    int32_t picks;
    int32_t *skip_count;  /* [skipped.n] number of elements of that type */
    double (*section)[2]; /* [sections] radius at either end */
    int32_t sections;
    int32_t own_nodes;       /* nodes that the reader made, which are not counted in the report */
    int32_t moved, replaced; /* nodes moved and elements replaced by a later definition */
    int32_t file, line;      /* position of the next addition, set by the reader; file 0 is the deck itself */
    int32_t x_cap, element_cap, connectivity_cap, pick_cap, skip_cap, section_cap;
} fl_elements;

/* Name ("hex8") of a shape. */
const char *fl_shape_name(enum fl_shape shape);

/* Number of nodes of a shape: 2 for FL_LINE2 ... 20 for FL_HEX20; of its corners alone. */
int fl_shape_nodes(enum fl_shape shape);
int fl_shape_corners(enum fl_shape shape);

/* Number of faces of a solid (0 for lines and shells).  fl_shape_face() gives the corners of one as indices
 * in the element and returns their number, 3 or 4.  Faces are numbered as in Abaqus, S1 first:
 *     tet      012 031 132 230            wedge  012 354 0341 1452 2530
 *     hex      0123 4765 0451 1562 2673 3740
 *     pyramid  0123 041 142 243 340
 * In a right-handed element they wind inward. */
int fl_shape_faces(enum fl_shape shape);
int fl_shape_face(enum fl_shape shape, int face, int corner[4]);

/* Initialise e; file names it in messages.  -1 with FL_SYSTEM. */
int fl_elements_start(fl_elements *e, const char *file, fl_err *err);

/* Set e->file to the (included) file of that name, which is added if new.  -1 with FL_SYSTEM. */
int fl_elements_set_file(fl_elements *e, const char *file, fl_err *err);

/* Fail with "file:line: " before the message.  Returns -1. */
int fl_elements_fail(const fl_elements *e, int32_t file, int32_t line, fl_err *err, const char *fmt, ...)
    __attribute__((format(printf, 5, 6)));

/* Define node (scope, id) at x.  A second, different definition moves the node and is counted in moved.
 * Returns its index, or -1 with FL_INPUT (x is not finite) or FL_SYSTEM. */
int32_t fl_elements_add_node(fl_elements *e, int32_t scope, int64_t id, fl_vec3 x, fl_err *err);

/* Add an element to a part.  An element of the same number is replaced, and counted.  Its nodes may be
 * defined later.
 *   id     its number, or -1 if nothing refers to it by number
 *   part   index in e->parts: fl_string_table_add(&e->parts, "name", err)
 *   node   [fl_shape_nodes(shape)] numbers of nodes in that scope, >= 1; < 1, or the
 *          number of a corner, omits a mid-side node
 * Returns its index, or -1 with FL_INPUT (a corner below 1) or FL_SYSTEM. */
int32_t fl_elements_add(fl_elements *e, int32_t scope, int64_t id, enum fl_shape shape, int32_t part,
                        const int64_t *node, fl_err *err);

/* Set the section of a line element: a solid truncated cone of radii r0 and r1 >= 0, in the unit of the file.
 * -1 with FL_SYSTEM. */
int fl_elements_set_radius(fl_elements *e, int32_t element, double r0, double r1, fl_err *err);

/* Add an element, or faces of it, to a set: fl_string_table_add(&e->sets, "name", err).  A set is used only
 * if the user selects it by name.  An element may be in any number of sets; a face that it does not have is
 * ignored.  -1 with FL_SYSTEM. */
int fl_elements_pick(fl_elements *e, fl_pick pick, fl_err *err);

/* Count an element of a type that is unknown or has no surface.  -1 with FL_SYSTEM. */
int fl_elements_skip(fl_elements *e, const char *type, fl_err *err);

void fl_elements_free(fl_elements *e); /* accepts a zeroed struct, leaves one */

#endif
