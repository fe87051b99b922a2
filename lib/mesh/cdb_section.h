/* SPDX-License-Identifier: GPL-3.0-or-later */
/* cdb_section.h -- radii of the lines of an ANSYS archive, from sections or real constants.  These may
 * precede or follow the elements. */
#ifndef FL_MESH_CDB_SECTION_H
#define FL_MESH_CDB_SECTION_H
#include "mesh/elements.h"

enum { FL_CDB_SECTION_WORD = 16 };

/* A line element whose radius is set later. */
typedef struct {
    int32_t element, routine;
    int64_t section, real;
} fl_cdb_line;

typedef struct {
    fl_id_map id;      /* scope 0: sections, 1: real constants */
    double *radius;    /* [id.n] 0 for none */
    fl_cdb_line *line; /* [lines] */
    int64_t current;   /* the section that SECDATA applies to, 0 for none */
    char type[FL_CDB_SECTION_WORD], subtype[FL_CDB_SECTION_WORD];
    int32_t lines, radius_cap, line_cap;
} fl_cdb_sections;

/* SECTYPE: begin section id of a type like PIPE or BEAM and a subtype like CTUBE. */
void fl_cdb_section_open(fl_cdb_sections *s, int64_t id, const char *type, const char *subtype);

/* SECDATA: x holds the outer diameter and the wall thickness of a pipe, the two radii of a tube, or the
 * radius of a rod.  Other sections have no radius.  -1 with FL_SYSTEM. */
int fl_cdb_section_data(fl_cdb_sections *s, const double x[2], fl_err *err);

/* Set the outer diameter, the first of the real constants id.  -1 with FL_SYSTEM. */
int fl_cdb_section_real(fl_cdb_sections *s, int64_t id, double diameter, fl_err *err);

/* Record a line element with its routine, section and real constants.  -1 with FL_SYSTEM. */
int fl_cdb_section_line(fl_cdb_sections *s, fl_cdb_line line, fl_err *err);

/* Set the radii of all lines: BEAM188 and 189, PIPE288, 289 and 290 by section, PIPE16, 20 and 59 by real
 * constants.  -1 with FL_SYSTEM. */
int fl_cdb_section_apply(const fl_cdb_sections *s, fl_elements *e, fl_err *err);

void fl_cdb_section_free(fl_cdb_sections *s); /* accepts a zeroed struct, leaves one */

#endif
