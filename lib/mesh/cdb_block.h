/* SPDX-License-Identifier: GPL-3.0-or-later */
/* cdb_block.h -- the blocks of an ANSYS archive, and the state that blocks and commands share. */
#ifndef FL_MESH_CDB_BLOCK_H
#define FL_MESH_CDB_BLOCK_H
#include "base/string_table.h"
#include "mesh/cdb_component.h"
#include "mesh/cdb_routine.h"
#include "mesh/cdb_section.h"
#include "mesh/deck_lines.h"
#include "mesh/frame_cdb.h"

enum {
    FL_CDB_WORDS = 64, /* per command */
    FL_CDB_NODES = 40, /* per element, nodes that its shape ignores included */
};

/* An element type, as ET and KEYOPT define it. */
typedef struct {
    int32_t routine, key;
    fl_cdb_family family;
} fl_cdb_type;

typedef struct {
    fl_elements e;
    fl_deck d;
    int32_t part;               /* of elements in no component */
    fl_id_map slot;             /* numbers of element types */
    fl_cdb_type *type;          /* [slot.n] */
    char *word[FL_CDB_WORDS];   /* words of the current command, none NULL */
    int64_t node[FL_CDB_NODES]; /* nodes of the current element */
    int32_t nodes;              /* their number */
    fl_cdb_sections sections;
    fl_frame_cdb *frame; /* NULL: beams are not asked for */
    int64_t material;    /* current */
    fl_cdb_components components;
    int32_t node_sets, other_sets, type_cap; /* components skipped: of nodes, of the solid model */
} fl_cdb;

/* Assign a routine to an element type.  -1 with FL_SYSTEM. */
int fl_cdb_set_type(fl_cdb *c, int64_t slot, int32_t routine, int32_t key, fl_err *err);

/* Add the element with the nodes c->node[0 .. c->nodes), or count it if its type has no surface.  -1 with
 * FL_INPUT (undefined type, too few nodes) or FL_SYSTEM. */
int fl_cdb_add_element(fl_cdb *c, int64_t id, int64_t type, int64_t section, int64_t real, fl_err *err);

/* Read the block that follows the command in c->word: a format line, then rows in its columns.  Rows may be
 * short.  A block ends with a row of -1 or at the next command; components and real constants may also end
 * with the file.  A remark reports a number of entries that differs from the one announced.
 *     nblock    nodes: number, ..., and behind all integers x y z
 *     eblock    elements.  With the key SOLID: material, type, real, section, system, 3 more, nodes, one
 *               more, number, then the nodes, over as many rows as needed; without: number, type, real,
 *               material, system, nodes
 *     etblock   element types: slot, routine, first key
 *     rlblock   real constants, of which the first is used; a second format line describes continuation rows
 *     cmblock   a component: numbers; a negative one ends the range begun by the number before it.  Those of
 *               nodes, key points, lines, areas and volumes are counted and skipped
 *
 * 0, or -1 with FL_INPUT or FL_SYSTEM. */
int fl_cdb_nblock(fl_cdb *c, fl_err *err);
int fl_cdb_eblock(fl_cdb *c, fl_err *err);
int fl_cdb_etblock(fl_cdb *c, fl_err *err);
int fl_cdb_rlblock(fl_cdb *c, fl_err *err);
int fl_cdb_cmblock(fl_cdb *c, fl_err *err);

#endif
