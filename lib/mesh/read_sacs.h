/* SPDX-License-Identifier: GPL-3.0-or-later */
/* read_sacs.h -- input files of SACS (SACINP). */
#ifndef FL_MESH_READ_SACS_H
#define FL_MESH_READ_SACS_H
#include "geom/surface.h"
#include "mesh/bytes.h"
#include "mesh/import_options.h"

/* True if b has a JOINT with numbers in its columns, and one of MEMBER, GRUP, PLATE with text behind it. */
int fl_sacs_is(const fl_bytes *b);

/* Add the members and plates of the file to s, or its members to the frame of opt.  Lines are of 80 columns,
 * counted from 1:
 *   JOINT    7-10 name; 12-18 19-25 26-32 coordinates [m, ft], 33-39 40-46 47-53 what is added [cm, in];
 *            55-60 fixity of a frame, PILEHD is clamped, ELASTI a spring, which is passed over
 *   MEMBER   8-11 12-15 joints, 17-19 group; 7 says whether the next line has offsets in global (1) or local
 *            (2) axes; MEMBER OFFSETS 36-53, 54-71 three each.  Local ones are ignored, with a remark
 *   GRUP     6-8 name, 9 taper, 10-16 section, or 18-23 outer diameter and 24-29 wall; 31-35 36-40 E and G;
 *            77-80 length of a segment.  Several lines are segments from the first joint on; one without a
 *            length takes the rest.  A line with B and one with E in column 9 are one cone
 *   SECT     6-12 name, 16-18 kind: TUB D t, CON D t at A and at B, from column 50 on; others are not round
 *   PLATE    12-27 three or four joints
 *   OPTIONS  14-15 MN, ME metric; EN feet and inches, which become metres
 *   LDOPT    25-32 density of steel
 * END ends the file; * is a comment; a bare word is a heading; all else is ignored.  Members of a joint
 * that is not there, and of a section of a library, are counted.  The name of its group is the part of a
 * member.
 * Source: SACS Precede and IV User's Manuals, input line formats.
 * Returns 0, or -1 with FL_INPUT or FL_SYSTEM in err; s may then have new parts. */
int fl_sacs_read(fl_surface *s, fl_bytes *b, const char *name, fl_import_options *opt, fl_err *err);

#endif
