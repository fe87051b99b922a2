/* SPDX-License-Identifier: GPL-3.0-or-later */
/* read_genie.h -- straight beams of concept models of GeniE (.xml). */
#ifndef FL_MESH_READ_GENIE_H
#define FL_MESH_READ_GENIE_H
#include "geom/surface.h"
#include "mesh/bytes.h"
#include "mesh/import_options.h"

/* True if the head of b has the tag DNV_structure_concept_protocol. */
int fl_genie_is(const fl_bytes *b);

/* Add the beams of the model to s, a part for each, or to the frame of opt.  The whole file must be in
 * memory.
 *   model_units length             m, mm, cm, ft, in: other lengths become metres
 *   section name                   pipe_section od th, box_section h b tw tftop tfbot, bar_section h b; a
 *                                  cone_section runs from the diameter of the segment before to that of
 *                                  the one behind; others are counted
 *   material name                  isotropic_linear_material youngs_modulus poissons_ratio density
 *   straight_beam name             straight_segment section_ref material_ref, with position x y z end
 * Plates and curved beams lie in packed ACIS geometry and are counted: the FEM file has them.  Offsets of
 * curves are ignored, with a remark.
 * Source: DNV GeniE XML, as adapy writes and reads it.
 * Returns 0, or -1 with FL_INPUT or FL_SYSTEM in err; s may then have new parts. */
int fl_genie_read(fl_surface *s, fl_bytes *b, const char *name, fl_import_options *opt, fl_err *err);

#endif
