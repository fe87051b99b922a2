/* SPDX-License-Identifier: GPL-3.0-or-later */
/* vtk_cells.h -- conversion of VTK cells, from legacy and XML files, to finite elements. */
#ifndef FL_MESH_VTK_CELLS_H
#define FL_MESH_VTK_CELLS_H
#include <stdint.h>
#include "mesh/elements.h"

/* Numbers of an array of any type.  Integers up to 2^53 are exact. */
typedef struct {
    double *x; /* [n] */
    int64_t n;
    int32_t cap;
} fl_vtk_array;

/* One mesh.  The corners of cell c are corner.x[last(c - 1) .. last(c)), with last(c) = offset.x[c] and
 * last(-1) = 0.  The faces of polyhedron c are face.x[.. face_last.x[c]): their number, then for each its
 * number of corners and these; face_last.x[c] is -1 for any other cell. */
typedef struct {
    fl_vtk_array point;  /* [3 points] */
    fl_vtk_array corner; /* indices of points, from 0 */
    fl_vtk_array offset; /* [cells] */
    fl_vtk_array type;   /* [cells] */
    fl_vtk_array face, face_last;
    fl_vtk_array part;  /* [cells] numbers of parts, or empty */
    char part_word[40]; /* name of the array of these numbers */
} fl_vtk_grid;

/* Names of parts by their numbers. */
typedef struct {
    fl_string_table name;
    int64_t *id; /* [name.n] */
    int32_t cap;
} fl_vtk_names;

/* Names of arrays of cell data that identify parts, by preference, NULL at the end. */
extern const char *const FL_VTK_PART_ARRAYS[];

/* Index of name in FL_VTK_PART_ARRAYS, -1 if it is not there. */
int fl_vtk_part_rank(const char *name);

/* Set the name of part id.  -1 with FL_SYSTEM. */
int fl_vtk_names_add(fl_vtk_names *v, int64_t id, const char *name, fl_err *err);

/* Add the points and cells of g to e.
 *   scope   scope of its nodes: 0 for the first mesh of a file, and so on
 *   v       names of the parts that g->part numbers; a part without a name is called part_word_N
 *   name    the part of all cells if g->part is empty
 * Polygons are split as by fl_facet_polygon(), strips and voxels by their corners.  If there are polyhedra,
 * the faces that no other solid of g has become shells, oriented outward from the mean of the corners of
 * their cell.  Vertices and unknown types are counted as skipped.  Of cells of higher order only the corners
 * are used; *coarse counts them.
 * Returns 0, or -1 with FL_INPUT (an invalid index, offset or count) or FL_SYSTEM. */
int fl_vtk_add_cells(fl_elements *e, const fl_vtk_grid *g, int32_t scope, const fl_vtk_names *v,
                     const char *name, int32_t *coarse, fl_err *err);

void fl_vtk_grid_free(fl_vtk_grid *g);
void fl_vtk_names_free(fl_vtk_names *v); /* both accept a zeroed struct and leave one */

#endif
