/* SPDX-License-Identifier: GPL-3.0-or-later */
/* cdb_block.h -- the blocks of an ANSYS archive, and what they share with its commands. */
#ifndef FL_MESH_CDB_BLOCK_H
#define FL_MESH_CDB_BLOCK_H
#include "base/string_table.h"
#include "mesh/cdb_component.h"
#include "mesh/cdb_routine.h"
#include "mesh/cdb_section.h"
#include "mesh/deck_lines.h"

enum {
    FL_CDB_WORDS = 64, /* of a command */
    FL_CDB_NODES = 40, /* of an element, those that have no meaning for its shape with it */
};

/* What ET and KEYOPT make of an element type. */
typedef struct {
    int32_t routine, key;
    fl_cdb_family family;
} fl_cdb_type;

typedef struct {
    fl_elements e;
    fl_deck d;
    int32_t part;               /* of what is in no component */
    fl_id_map slot;             /* of element types */
    fl_cdb_type *type;          /* [slot.n] */
    char *word[FL_CDB_WORDS];   /* of the command at hand, none NULL */
    int64_t node[FL_CDB_NODES]; /* of the element at hand */
    int32_t nodes;              /* so many */
    fl_cdb_sections sections;
    fl_cdb_components components;
    int32_t node_sets, type_cap;
} fl_cdb;

/* Say that element types of that number are of a routine.  -1 with FL_SYSTEM. */
int fl_cdb_set_type(fl_cdb *c, int64_t slot, int32_t routine, int32_t key, fl_err *err);

/* Add the element of c->node[0 .. c->nodes), or count it where its type has no surface.  -1 with FL_INPUT (a
 * type that is not defined, too few nodes) or FL_SYSTEM. */
int fl_cdb_add_element(fl_cdb *c, int64_t id, int64_t type, int64_t section, int64_t real, fl_err *err);

/* Read a block behind its command, whose words are in c->word: a format line, and rows in its columns.  Rows
 * may be short.  A block ends with a row of -1 or at the next command; a component and real constants also
 * at the end of the file.  A head that promises another number of entries is told in a remark.
 *     nblock    nodes: number, ..., and behind all whole numbers x y z
 *     eblock    elements.  With the key SOLID: material, type, real, section, system, 3 more, nodes, one
 *               more, number, then the nodes, over as many rows as they take; without: number, type, real,
 *               material, system, nodes
 *     etblock   element types: slot, routine, first key
 *     rlblock   real constants, of which the first counts; a second format line is for the rows that go on
 *     cmblock   a component: numbers, of which a negative one ends the range that the one before began
 * 0, or -1 with FL_INPUT or FL_SYSTEM. */
int fl_cdb_nblock(fl_cdb *c, fl_err *err);
int fl_cdb_eblock(fl_cdb *c, fl_err *err);
int fl_cdb_etblock(fl_cdb *c, fl_err *err);
int fl_cdb_rlblock(fl_cdb *c, fl_err *err);
int fl_cdb_cmblock(fl_cdb *c, fl_err *err);

#endif
