/* SPDX-License-Identifier: GPL-3.0-or-later */
/* scenes.h -- a scene that has something of everything: all shapes of bodies, held and driven ones, every
 * kind of structure, walls, water, wind, friction and restitution. */
#ifndef FL_TESTS_SCENES_H
#define FL_TESTS_SCENES_H
#include "support/small_world.h"

/* side^3 bodies in a heap that meet one another from the start; law NULL: patch, each other law where the
 * bodies are polyhedra.  Keys may still be set; then lab_make(). */
void scene_of_everything(lab *l, int32_t side, const char *law);

/* The same in a cell that repeats itself along x and y, with nothing at its sides. */
void scene_of_wraps(lab *l, int32_t side, const char *law);

/* The same with a sea of waves, a sheared current, drag on each facet of water and wind, and added mass. */
void scene_of_seas(lab *l, int32_t side, const char *law);

/* scene_of_everything() in a sheared current, and scene_of_seas(), where few steps are looks at the water. */
void scene_of_looks(lab *l, int32_t side, const char *law);
void scene_of_glances(lab *l, int32_t side, const char *law);

/* scene_of_everything() where contacts that have moved little are told and not looked at. */
void scene_of_surrogates(lab *l, int32_t side, const char *law);

/* Spheres of two sizes in such a cell, one body in nine a box; laws as above. */
void scene_of_balls(lab *l, int32_t side, const char *law);

/* side + 1 by side by side - 1 boxes and spheres that are frozen together, and at once torn apart; space
 * repeats itself along x. */
void scene_of_bonds(lab *l, int32_t side, const char *law);

/* The same where nothing bounds the heap along x: floes leave there at once, and copies of it come in. */
void scene_of_traffic(lab *l, int32_t side, const char *law);
/* And few steps are looks at the water. */
void scene_of_visits(lab *l, int32_t side, const char *law);

#endif
