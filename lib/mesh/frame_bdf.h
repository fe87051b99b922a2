/* SPDX-License-Identifier: GPL-3.0-or-later */
/* frame_bdf.h -- the entries of Nastran bulk data that make a frame.
 *
 *     CBAR CBEAM CROD CTUBE CONROD        with orientation vector or grid, pins
 *     PBAR PBARL PBEAM PBEAML PROD PTUBE  PBARL and PBEAML of the types ROD TUBE TUBE2 BAR BOX I
 *     MAT1, SPC, SPC1, GRID (field PS), CONM2, FORCE, MOMENT
 * Of a tapered PBEAM the end A is taken. All other entries are counted, frame_model.h. */
#ifndef FL_MESH_FRAME_BDF_H
#define FL_MESH_FRAME_BDF_H
#include "mesh/bdf_entry.h"
#include "mesh/frame_model.h"

/* Takes up the entry. Positions of grids come later. -1 with FL_INPUT or FL_SYSTEM. */
int fl_frame_bdf_entry(fl_frame_model *f, const fl_bdf_entry *a, fl_err *err);

#endif
