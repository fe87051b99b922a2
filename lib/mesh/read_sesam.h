/* SPDX-License-Identifier: GPL-3.0-or-later */
/* read_sesam.h -- Input Interface Files of SESAM: T1.FEM, and the same records in R1.SIF. */
#ifndef FL_MESH_READ_SESAM_H
#define FL_MESH_READ_SESAM_H
#include "geom/surface.h"
#include "mesh/bytes.h"
#include "mesh/import_options.h"

/* True if a line of b begins with GNODE, GCOORD, GELMNT1 or GELMNT2 in eight columns and a number. */
int fl_sesam_is(const fl_bytes *b);

/* Add the members, plates and solids of the file to s, or its members to the frame of opt.
 *
 * A record is a name in columns 1 to 8 and numbers in columns of 16 from column 9 on; lines with blanks in
 * columns 1 to 8 continue it.  Fields that are not there are 0.  Lines of text behind TD..., DATE and TEXT
 * are not records, whatever they look like.  Read are
 *   GCOORD, GELMNT1, GELREF1, GECCEN, GUNIVEC        elements with sections, offsets and axes
 *   GPIPE, GBOX, GBARM                               outer diameter; outer sides
 *   GIORH GUSYI GCHAN GLSEC GTONP GDOBO and GBEAMG   no outline; a frame takes the constants of GBEAMG
 *   MISOSEL, BNBCD, BELFIX                           of frames
 *   TDSETNAM GSETMEMB                                sets; an element belongs to the smallest that holds it
 *   TDSECT; TDSCONC SCONCEPT SCONMESH                sets to ask for: sections, members of GeniE
 * and all else is ignored.  Elements of other types are counted.  A file of GELMNT2 alone is an assembly,
 * which is refused.
 * Source: DNV, Sesam Input Interface File, File Description; cards as ExtFEMIO comments them.
 * Returns 0, or -1 with FL_INPUT or FL_SYSTEM in err; s may then have new parts. */
int fl_sesam_read(fl_surface *s, fl_bytes *b, const char *name, fl_import_options *opt, fl_err *err);

#endif
