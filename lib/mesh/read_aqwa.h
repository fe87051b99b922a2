/* SPDX-License-Identifier: GPL-3.0-or-later */
/* read_aqwa.h -- panels of AQWA (.dat). */
#ifndef FL_MESH_READ_AQWA_H
#define FL_MESH_READ_AQWA_H
#include "geom/surface.h"
#include "mesh/bytes.h"
#include "mesh/import_options.h"

/* True if b has a line JOB and a card COOR in columns 11 to 14. */
int fl_aqwa_is(const fl_bytes *b);

/* Add the bodies to s, a part for each ELM card with the name behind it.
 *   COOR   7-10 STRC and its number, then its nodes: 7-11 number, 21-30 31-40 41-50 x y z, blank is 0; END
 *          in 2-4
 *   ELMn   7-10 QPPL, TPPL: (1)(n1)(n2)(n3)(n4) behind column 15; other elements are counted; END
 *   SYMX and SYMY, both: x = 0 and y = 0; one of them: the plane that holds an open rim of the hull, and if
 *   that is not one plane the file is refused
 * Panels without DIFF in columns 12 to 15 are above the water and are taken.
 * Source: Ansys, Aqwa Reference Manual, data categories 1 and 2; cards as BEMRosetta reads them.
 * Returns 0, or -1 with FL_INPUT or FL_SYSTEM in err; s may then have new parts. */
int fl_aqwa_read(fl_surface *s, fl_bytes *b, const char *name, fl_import_options *opt, fl_err *err);

#endif
