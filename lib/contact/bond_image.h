/* SPDX-License-Identifier: GPL-3.0-or-later */
/* bond_image.h -- which periodic image of its second body a bond of an ice field joins. */
#ifndef FL_CONTACT_BOND_IMAGE_H
#define FL_CONTACT_BOND_IMAGE_H
#include <math.h>
#include "world/world.h"

static inline double fl_bond_nearest_cell(double apart, double length)
{
    return length > 0.0 ? round(apart / length) : 0.0;
}

/* Offset of x from body i in lengths of the cell. */
static inline fl_vec3 fl_bond_cells_between(const fl_world *w, int32_t i, fl_vec3 x)
{
    const fl_vec3 L = w->cell.length, off = v3_sub(x, w->b.x[i]);
    if (!w->cell.periodic) return v3(0, 0, 0);
    return v3(fl_bond_nearest_cell(off.x, L.x), fl_bond_nearest_cell(off.y, L.y),
              fl_bond_nearest_cell(off.z, L.z));
}

/* Image of j of a bond at x, seen from i. */
static inline fl_vec3 fl_bond_image_of(const fl_world *w, int32_t i, int32_t j, fl_vec3 x)
{
    return v3_sub(fl_bond_cells_between(w, j, x), fl_bond_cells_between(w, i, x));
}

#endif
