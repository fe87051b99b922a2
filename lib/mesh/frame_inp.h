/* SPDX-License-Identifier: GPL-3.0-or-later */
/* frame_inp.h -- the keywords of an Abaqus deck that make a frame.
 *
 *     *BEAM SECTION          CIRC PIPE THICKPIPE RECT BOX I, with the direction n1
 *     *BEAM GENERAL SECTION  GENERAL CIRC PIPE RECT BOX I, with n1, and E and G of the third line
 *     *SOLID SECTION         area of trusses
 *     *MATERIAL with *ELASTIC and *DENSITY, *NSET, *BOUNDARY, *CLOAD, *RELEASE
 * Beams and pipes of three nodes are taken straight from end to end. All other keywords are counted. */
#ifndef FL_MESH_FRAME_INP_H
#define FL_MESH_FRAME_INP_H
#include "mesh/frame_model.h"
#include "mesh/inp_model.h"

/* A section of a set of elements; an entry of a set of nodes; a support or load; a release. */
typedef struct {
    int32_t set, scope, section;
    int truss, has_n1;
    fl_vec3 n1;
} fl_frame_inp_section;

typedef struct {
    int32_t set, scope; /* set: index in nset; scope: of the numbers */
    int64_t first, last, step;
} fl_frame_inp_nodes;

typedef struct {
    int32_t set, scope; /* set: index in nset, -1: the node of that number */
    int64_t node;
    int bits; /* held, 0: a load */
    fl_vec3 force, moment;
} fl_frame_inp_support;

typedef struct {
    int32_t set, scope; /* set: index in words of the sets, -1: the element of that number */
    int64_t element;
    int end;
    unsigned pins;
} fl_frame_inp_release;

typedef struct fl_frame_inp {
    fl_frame_model *model; /* borrowed */
    int32_t material;      /* current, -1 none */
    fl_string_table nset;  /* names in upper case */
    fl_frame_inp_section *section;
    fl_frame_inp_nodes *nodes;
    fl_frame_inp_support *support;
    fl_frame_inp_release *release;
    int32_t sections, entries, supports, releases;
    int32_t section_cap, nodes_cap, support_cap, release_cap;
} fl_frame_inp;

/* Takes up the keyword line just split, with its data: 1, or 0 if it is none of the above; -1 with an
 * error. */
int fl_frame_inp_keyword(fl_inp_model *r, fl_err *err);

/* Counts the keyword as one that is not carried over, unless it says nothing about the structure. */
int fl_frame_inp_count_skipped(fl_inp_model *r);

/* At the end of the deck: elements with their sections, nodes with supports and loads. */
int fl_frame_inp_finish(fl_inp_model *r, fl_err *err);

void fl_frame_inp_free(fl_frame_inp *f);

#endif
