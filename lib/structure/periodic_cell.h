/* SPDX-License-Identifier: GPL-3.0-or-later */
/* periodic_cell.h -- the periodic cell: directions in which space repeats itself.
 *
 * Coordinates of bodies are not wrapped: nothing changes, and no force, when a body crosses a border of the
 * cell. The neighbour search wraps boxes into the cell, and tables wrap positions. Of a pair (i, j) the one
 * image of j near i counts, x_j + image * length. */
#ifndef FL_STRUCTURE_PERIODIC_CELL_H
#define FL_STRUCTURE_PERIODIC_CELL_H
#include <stdint.h>
#include "geom/vec3.h"

typedef struct {
    int periodic;   /* 0: no direction is periodic, and the rest is not read */
    fl_vec3 lo;     /* lower corner [m] */
    fl_vec3 length; /* [m]; 0 in a direction that is not periodic */
} fl_periodic_cell;

/* Index of the cell that holds the coordinate: lengths above lo, rounded down. */
static inline double fl_periodic_cell_index(double x, double lo, double length)
{
    return length > 0.0 ? floor((x - lo) / length) : 0.0;
}

/* The same of a point. */
static inline fl_vec3 fl_periodic_cell_of(const fl_periodic_cell *c, fl_vec3 x)
{
    return v3(fl_periodic_cell_index(x.x, c->lo.x, c->length.x),
              fl_periodic_cell_index(x.y, c->lo.y, c->length.y),
              fl_periodic_cell_index(x.z, c->lo.z, c->length.z));
}

/* Offset of n lengths in each direction [m]. */
static inline fl_vec3 fl_periodic_cell_offset(const fl_periodic_cell *c, fl_vec3 n)
{
    return v3(n.x * c->length.x, n.y * c->length.y, n.z * c->length.z);
}

/* Image of x inside the cell. */
static inline fl_vec3 fl_periodic_cell_wrap(const fl_periodic_cell *c, fl_vec3 x)
{
    return c->periodic ? v3_sub(x, fl_periodic_cell_offset(c, fl_periodic_cell_of(c, x))) : x;
}

#endif
