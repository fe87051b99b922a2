/* SPDX-License-Identifier: GPL-3.0-or-later */
/* inp_model.h -- an Abaqus deck while it is being read: what is in its place, parts that wait for their
 * instances, sets and sections by name, and where what comes next goes. */
#ifndef FL_MESH_INP_MODEL_H
#define FL_MESH_INP_MODEL_H
#include "geom/affine.h"
#include "mesh/inp_line.h"
#include "mesh/element_sets.h"

/* The radius of the lines of a set. */
typedef struct {
    int32_t set, scope; /* set: of words */
    double radius;
} fl_inp_section;

/* A part, as it is defined; parts are never placed twice in one room. */
typedef struct {
    int32_t name, scope;         /* name: of words */
    int32_t node[2], element[2]; /* its own in the store of parts, from and to */
    int32_t used;
} fl_inp_part;

typedef struct {
    fl_elements e, part_defs; /* what is in its place; parts that wait for their instances */
    fl_element_sets sets;
    fl_inp_part *part;       /* [parts] */
    fl_inp_section *section; /* [sections] */
    int32_t parts, part_cap, sections, section_cap, scopes, generated;
    int32_t extra_nodes; /* elements with more nodes than their type has */
    const char *name;    /* of elements without a set; borrowed */
    /* where what comes next goes */
    fl_elements *store; /* e or defs */
    int32_t scope, instance;
    fl_affine transform, system; /* of the instance; of *SYSTEM */
    fl_inp_line line;
} fl_inp_model;

/* Let the store that is filled know where the line stands.  -1 with FL_SYSTEM. */
int fl_inp_set_location(fl_inp_model *r, fl_err *err);

/* x moved and turned: q x + t. */
fl_vec3 fl_inp_transform(const fl_affine *m, fl_vec3 x);

/* From here on, elements and nodes belong to the deck itself. */
void fl_inp_leave_part(fl_inp_model *r);

/* INPUT=: the data stand in a file, which is gone on with.  -1 with FL_INPUT or FL_SYSTEM. */
int fl_inp_follow_input(fl_inp_model *r, fl_err *err);

/* Step over data that are of no use.  0, or -1. */
int fl_inp_skip_data(fl_inp_model *r, fl_err *err);

/* May n more nodes or elements be made from a line?  A deck is read within what its bytes allow.  0, or -1
 * with FL_INPUT beyond FL_INP_GENERATED_MAX in all. */
enum { FL_INP_GENERATED_MAX = 2000000 };
int fl_inp_count_generated(fl_inp_model *r, int64_t n, fl_err *err);

void fl_inp_model_free(fl_inp_model *r); /* accepts a zeroed struct, leaves one */

#endif
