/* SPDX-License-Identifier: GPL-3.0-or-later */
/* vtk_cells.h -- the cells of VTK, whichever file they come from, as finite elements. */
#ifndef FL_MESH_VTK_CELLS_H
#define FL_MESH_VTK_CELLS_H
#include <stdint.h>
#include "mesh/elements.h"

/* Numbers of an array of any type.  Whole numbers up to 2^53 are exact. */
typedef struct {
    double *x; /* [n] */
    int64_t n;
    int32_t cap;
} fl_vtk_array;

/* One mesh: points, and cells c whose corners are corner.x[last(c - 1) .. last(c)), last being offset.x[c]
 * and last(-1) = 0.  The faces of polyhedron c are face.x[.. face_last.x[c]): their count, then for each the
 * number of its corners and these; face_last.x[c] is -1 for any other cell. */
typedef struct {
    fl_vtk_array point;  /* [3 points] */
    fl_vtk_array corner; /* indices of points, from 0 */
    fl_vtk_array offset; /* [cells] */
    fl_vtk_array type;   /* [cells] */
    fl_vtk_array face, face_last;
    fl_vtk_array part;  /* [cells] numbers of parts, or none */
    char part_word[40]; /* what these numbers are called */
} fl_vtk_grid;

/* What a number of a part is called in the file. */
typedef struct {
    fl_string_table name;
    int64_t *id; /* [name.n] */
    int32_t cap;
} fl_vtk_names;

/* Names of cell data that number parts, the best first, NULL at the end. */
extern const char *const FL_VTK_PART_ARRAYS[];

/* The place of name in FL_VTK_PART_ARRAYS, -1 when it is not there. */
int fl_vtk_part_rank(const char *name);

/* Remember that part id is called name.  -1 with FL_SYSTEM. */
int fl_vtk_names_add(fl_vtk_names *v, int64_t id, const char *name, fl_err *err);

/* Add the points and cells of g to e, their nodes in a scope of their own.
 *   scope   0 for the first mesh of a file, and so on
 *   v       names of parts, which g->part numbers; without one the part is called part_word_N
 *   name    the part of everything when g->part is empty
 * Polygons are split as fl_facet_polygon() does, strips and voxels by their corners.  Where there are
 * polyhedra, the faces that no other solid of g has become shells, outward as seen from the mean of the
 * corners of their cell.  Vertices and unknown types are counted as passed over; of cells of higher order the
 * corners are taken, and *coarse counts them.
 * Returns 0, or -1 with FL_INPUT (an index, an offset or a count that does not fit) or FL_SYSTEM. */
int fl_vtk_add_cells(fl_elements *e, const fl_vtk_grid *g, int32_t scope, const fl_vtk_names *v,
                     const char *name, int32_t *coarse, fl_err *err);

void fl_vtk_grid_free(fl_vtk_grid *g);
void fl_vtk_names_free(fl_vtk_names *v); /* both accept a zeroed struct and leave one */

#endif
