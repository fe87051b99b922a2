/* SPDX-License-Identifier: GPL-3.0-or-later */
/* cdb_section.h -- the radii of the lines of an ANSYS archive, from their sections or their real constants,
 * which may come before the elements or after them. */
#ifndef FL_MESH_CDB_SECTION_H
#define FL_MESH_CDB_SECTION_H
#include "mesh/elements.h"

enum { FL_CDB_SECTION_WORD = 16 };

/* A line that waits for its radius. */
typedef struct {
    int32_t element, routine;
    int64_t section, real;
} fl_cdb_line;

typedef struct {
    fl_id_map id;      /* scope 0: sections, 1: real constants */
    double *radius;    /* [id.n] 0 for none */
    fl_cdb_line *line; /* [lines] */
    int64_t current;   /* the section that SECDATA speaks of, 0 for none */
    char type[FL_CDB_SECTION_WORD], subtype[FL_CDB_SECTION_WORD];
    int32_t lines, radius_cap, line_cap;
} fl_cdb_sections;

/* SECTYPE: what follows is of section id, of a type like PIPE or BEAM and a subtype like CTUBE. */
void fl_cdb_section_open(fl_cdb_sections *s, int64_t id, const char *type, const char *subtype);

/* SECDATA: a pipe has its outer diameter and its wall, a tube its two radii, a rod its radius; sections of
 * other types have no radius.  -1 with FL_SYSTEM. */
int fl_cdb_section_data(fl_cdb_sections *s, const double x[2], fl_err *err);

/* The first of the real constants id: an outer diameter.  -1 with FL_SYSTEM. */
int fl_cdb_section_real(fl_cdb_sections *s, int64_t id, double diameter, fl_err *err);

/* Remember that an element is a line of that routine, section and set of real constants.  -1 with FL_SYSTEM.
 */
int fl_cdb_section_line(fl_cdb_sections *s, fl_cdb_line line, fl_err *err);

/* Give the lines their radii: BEAM188 and 189, PIPE288, 289 and 290 by their section, PIPE16, 20 and 59 by
 * their real constants.  -1 with FL_SYSTEM. */
int fl_cdb_section_apply(const fl_cdb_sections *s, fl_elements *e, fl_err *err);

void fl_cdb_section_free(fl_cdb_sections *s); /* accepts a zeroed struct, leaves one */

#endif
