/* SPDX-License-Identifier: GPL-3.0-or-later */
/* small_world.h -- a small world ("lab") for a test: set keys, add bodies, run. */
#ifndef FL_TESTS_SMALL_WORLD_H
#define FL_TESTS_SMALL_WORLD_H
#include "sim/step.h"

typedef struct {
    fl_scene scene;
    fl_ice_field field;
    fl_surface surface;
    fl_world w;
    int made;
    int through; /* bodies are put through surfaces: contacts may begin deeper than bodies move */
} lab;

/* No gravity, no damping, no friction, one thread; keys as for --set ("material.ice.young=1 GPa").  A
 * failure ends the program with its message: a test that cannot set up its world has failed. */
void lab_start(lab *l);
/* contact.surrogate of labs of law patch: FLOE_SURROGATE of the environment; else 0: evaluation in every
 * step. */
double lab_surrogate_tolerance(void);
/* False under a FLOE_LAW without surrogates, where contact.surrogate is left out of the scene. */
int lab_has_surrogates(void);
void lab_set(lab *l, const char *assignment);
void lab_setf(lab *l, const char *fmt, ...) __attribute__((format(printf, 2, 3)));
void lab_box(lab *l, fl_vec3 centre, fl_vec3 outer_half, double radius, fl_quat q, fl_vec3 v, fl_vec3 spin);
void lab_sphere(lab *l, fl_vec3 centre, double radius, fl_vec3 v, fl_vec3 spin);
/* At rest; its core extends from centre - half to centre + half. */
void lab_capsule(lab *l, fl_vec3 centre, fl_vec3 half, double radius);
void lab_poly(lab *l, fl_poly *core, double radius, fl_vec3 v,
              fl_vec3 spin); /* takes ownership of the core */
/* A part of the structure: a box of triangles, n by n on its top face, or a cone. */
void lab_wall(lab *l, fl_vec3 lo, fl_vec3 hi, int n);
void lab_cone(lab *l, fl_cone c);
/* A part that is an upright prism over any simple polygon (counter-clockwise, z ignored). */
void lab_prism(lab *l, int n, const fl_vec3 *xy, double z0, double z1);
/* Builds the world and sets the step: dt > 0, or 0: automatic.  Then the state is that of t = 0. */
void lab_make(lab *l, double dt);
/* Runs steps; returns 0, or the code of the error that ended them.  A contact that begins deeper than its
 * bodies moved in the step ends the program, but in the first step, before which lab_pose() may be called. */
int lab_run(lab *l, int64_t steps);
double lab_energy(lab *l); /* all stores */
/* A world of its own: 196 square floes of 1.6 to 2.5 m that move between four walls without friction and
 * damping, ready to run. */
void lab_gas(lab *l, const char *law, double safety);
void lab_gas_on(lab *l, const char *law, double safety, int threads);
void lab_gas_surrogate(lab *l, double safety, double surrogate); /* with contact.surrogate, law patch */
/* Puts body i at a pose, at rest. */
void lab_pose(fl_world *w, int32_t i, fl_vec3 x, fl_quat q);
/* The pair (i, j), i < j, evaluated at the present poses as one that has never touched before; no history
 * is kept. */
fl_pair lab_evaluate_pair(fl_world *w, int32_t i, int32_t j);
/* Near pair number c; a pair that does not touch if there are fewer. */
fl_pair lab_pair(const lab *l, int32_t c);
void lab_free(lab *l);

#endif
