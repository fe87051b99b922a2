/* SPDX-License-Identifier: GPL-3.0-or-later */
/* member_model.h -- a structure of bars and beams as the file of kind `members` states it, members(5):
 * nodes, sections, members, supports, loads, imperfections.  member_chain.h makes the chain of balls of it.
 * */
#ifndef FL_MEMBER_MEMBER_MODEL_H
#define FL_MEMBER_MEMBER_MODEL_H
#include <stdint.h>
#include <stdio.h>
#include "base/err.h"
#include "base/string_table.h"
#include "base/text.h"
#include "base/tool.h"
#include "geom/vec3.h"
#include "member/member_section.h"

enum { FL_MEMBERS_VERSION = 1, FL_MEMBER_PIECES_MAX = 100000 };

/* Freedoms of a node as bits: x y z rx ry rz. */
enum { FL_MEMBER_DOFS = 6, FL_MEMBER_TRANSLATIONS = 7, FL_MEMBER_ALL = 63 };

typedef struct {
    fl_vec3 x;
    fl_vec3 offset;        /* imperfection without stress */
    fl_vec3 force, moment; /* reference load: times the load factor */
    double mass;           /* without inertia of its own, besides that of the members */
    fl_vec3 move, turn;    /* imposed displacement and rotation vector, times the load factor */
    int hinge;             /* no member is clamped to the node */
    int fixed;             /* freedoms that are held, bits */
    int imposed;           /* freedoms with an imposed displacement, bits; they are fixed too */
    int64_t line;          /* of the file */
} fl_member_node;

typedef struct {
    int32_t end[2], section, pieces, part;
    int released[2]; /* the end transmits no moment */
    fl_vec3 arm[2];  /* rigid, from the node to the end, at the start */
    int has_ref;
    fl_vec3 ref;       /* lies in the plane of e1 and e3 */
    double bow;        /* amplitude of a half sine wave without stress */
    int bow_axis;      /* 1: along e2, 2: along e3 */
    int32_t cylinders; /* that ice meets, each rigid and of equal length; 0: one */
    int64_t line;
} fl_member;

typedef struct {
    fl_string_table node_name, section_name, member_name, part_name;
    fl_member_node *node;
    fl_member_section *section;
    fl_member *member;
    int32_t node_cap, section_cap, member_cap;
    char *file;    /* that it was read from, for messages */
    char *history; /* its "#by" lines, NULL for none */
} fl_member_model;

/* Place of an end: 0 for i, 1 for j. */
static inline fl_vec3 fl_member_end(const fl_member_model *m, int32_t k, int end)
{
    const fl_member_node *n = &m->node[m->member[k].end[end]];
    return v3_add(v3_add(n->x, n->offset), m->member[k].arm[end]);
}

/* Frame of a member from end to end: e[0] along it, e[2] the part of `ref` at right angles to it, which is z
 * where none was given, and x for a member along z.  0, or -1 with FL_INPUT: no length, or ref along the
 * member. */
int fl_member_frame(const fl_member_model *m, int32_t k, fl_vec3 e[3], double *length, fl_err *err);

/* Reads a model.  -1 with FL_INPUT or FL_SYSTEM; the model is then free. */
int fl_member_model_read(fl_member_model *m, const char *path, fl_err *err);
int fl_member_model_read_text(fl_member_model *m, fl_text *in, fl_err *err);

/* True if the file begins as one of kind `members`; it is closed again. Standard input is none. */
int fl_member_model_is(const char *path);

/* Writes a model with its history and, unless by is NULL, that of this run; it reads back as it is. */
void fl_member_model_write(FILE *f, const fl_member_model *m, const fl_history_line *by);

void fl_member_model_free(fl_member_model *m); /* accepts a zeroed struct, leaves one */

#endif
