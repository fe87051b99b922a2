/* SPDX-License-Identifier: GPL-3.0-or-later */
/* scenes.h -- scenes with all features: all shapes of bodies, held and driven ones, every kind of
 * structure, walls, water, wind, friction and restitution. */
#ifndef FL_TESTS_SCENES_H
#define FL_TESTS_SCENES_H
#include "support/small_world.h"

/* side^3 bodies in a heap that touch from the start.  law NULL: patch; other laws apply to polyhedra.  Keys
 * may still be set before lab_make(). */
void scene_of_everything(lab *l, int32_t side, const char *law);

/* The same in a cell that is periodic along x and y. */
void scene_of_periodic_cell(lab *l, int32_t side, const char *law);

/* The same with a sea of waves, a sheared current, drag on each facet in water and wind, and added mass. */
void scene_of_seas(lab *l, int32_t side, const char *law);

/* scene_of_everything() in a sheared current, and scene_of_seas(), with water evaluated in few steps
 * (water.every). */
void scene_of_water_interval(lab *l, int32_t side, const char *law);
void scene_of_sea_interval(lab *l, int32_t side, const char *law);

/* scene_of_everything() with contacts by surrogates. */
void scene_of_surrogates(lab *l, int32_t side, const char *law);

/* Spheres of two sizes in such a cell, one body in nine a box; laws as above. */
void scene_of_spheres(lab *l, int32_t side, const char *law);

/* side + 1 by side by side - 1 boxes and spheres bonded and breaking apart at once; periodic along x. */
void scene_of_bonds(lab *l, int32_t side, const char *law);

/* side x side x side boxes with joints of three laws that slip and open at once: coulomb along x, yielding
 * along y, intact along z; the lowest layer is fixed. */
void scene_of_joints(lab *l, int32_t side, const char *law);

/* The same in stages: one block is taken out when the run has settled, and a second one behind a stage that
 * begins at 0.02 s. Blocks of group soft may be given zones. */
void scene_of_stages(lab *l, int32_t side, const char *law);

/* A floating sheet of 2 side by 3 side by 2 bonded spheres that breaks on a cone at once; its last row is
 * driven. */
void scene_of_sheet(lab *l, int32_t side, const char *law);

/* The same sheet without end, at 8 m/s: rows come in, bonded to it, and others leave. */
void scene_of_endless_sheet(lab *l, int32_t side, const char *law);

/* scene_of_bonds() without boundaries along x: floes leave there at once, and copies of the field flow in. */
void scene_of_inflow(lab *l, int32_t side, const char *law);
/* The same with water evaluated in few steps. */
void scene_of_inflow_interval(lab *l, int32_t side, const char *law);

/* The inflow pushes with a line load. */
void scene_of_pushed_ice(lab *l, int32_t side, const char *law);

/* Cubes and spheres on a floor of two parts with a leg of two more, all of which are one piece. */
void scene_of_joined_parts(lab *l, int32_t side, const char *law);

/* Plates that run from all sides into cones, crush, bend and split at once. */
void scene_of_failing_floes(lab *l, int32_t side, const char *law);

#endif
