/* SPDX-License-Identifier: GPL-3.0-or-later */
/* inp_type.h -- shapes of the element types of Abaqus and CalculiX. */
#ifndef FL_MESH_INP_TYPE_H
#define FL_MESH_INP_TYPE_H
#include "mesh/elements.h"

typedef struct {
    enum fl_shape shape;
    int nodes;    /* minimum on the data line */
    int optional; /* further ones it may have: orientation of a beam, nodes inside a solid */
    int middle;   /* a line of three nodes has its middle node second */
} fl_inp_type;

/* Look up a type by name in any case: a family, the number of nodes, and letters for the formulation, which
 * do not matter here (C3D10MHT is a C3D10).
 *     solids     C3D DC3D C3D..E Q3D with 4 5 6 8 10 15 20 27 nodes; SC6 SC8
 *     triangles  S3 STRI3 R3D3 M3D3 SFM3D3 DS3 CPS3 CPE3 DC2D3, and those of six nodes (STRI65)
 *     quads      S4 R3D4 M3D4 SFM3D4 DS4 CPS4 CPE4 DC2D4, and those of eight and nine
 *     lines      B31 B32 B33 T3D2 T3D3 PIPE31 PIPE32 ELBOW31 ELBOW32 FRAME3D RB3D2, and the plane ones
 * Returns 1, or 0 for a type that is unknown, has no surface (springs, masses, axisymmetric ones ...) or is
 * not structure: acoustic media (AC), flow (FC, DCC), Eulerian ones (EC). */
int fl_inp_type_of(const char *name, fl_inp_type *type);

#endif
