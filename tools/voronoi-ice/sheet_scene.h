/* SPDX-License-Identifier: GPL-3.0-or-later */
/* sheet_scene.h -- the sections of a scene that belong to a sheet of spheres: what its spheres stand for, and
 * bonds that give the sheet the strength and stiffness asked for. */
#ifndef VORONOI_ICE_SHEET_SCENE_H
#define VORONOI_ICE_SHEET_SCENE_H
#include "ice/sheet_strength.h"
#include "recipe.h"

struct sheet_bonds {
    double strength, young;          /* of the bonds [Pa]; 0: nothing asked for */
    fl_sheet_strength ratio, turned; /* of the sheet over them: for stress along x and along y */
};

/* The inflow of an endless sheet. */
struct sheet_inflow {
    double pitch, bound, speed; /* [m], [m], [m/s]; 0: that of the water */
    int along_y, backwards;
};

/* Choose the bonds.  -1 with FL_USAGE. */
int sheet_bonds_choose(struct sheet_bonds *out, const struct recipe *o, enum fl_packing_kind kind,
                       fl_err *err);

/* Write the file of --scene; slab: thickness of the sheet [m]; inflow: NULL for none.  -1 with FL_SYSTEM. */
int sheet_scene_write(const struct recipe *o, const struct sheet_bonds *bonds, double slab,
                      const struct sheet_inflow *inflow, const fl_history_line *by, fl_err *err);

#endif
