/* SPDX-License-Identifier: GPL-3.0-or-later */
/* gl_bodies.h -- bodies and parts in OpenGL: meshes by level of detail, made when first needed, all in one
 * vertex buffer with the body's row as an attribute; poses in a texture; spheres drawn as points or
 * squares that a ray per pixel turns into spheres; tubes.
 *
 * Level of detail by the dilation radius in pixels: below 1/4 faces alone, below 2 arcs uncut, below 6 cut
 * in 2, else in 6.  Points are limited to 255 pixels and vanish with their centre; spheres near these
 * limits are squares. */
#ifndef FL_VIEW_GL_BODIES_H
#define FL_VIEW_GL_BODIES_H
#include "view/camera.h"
#include "view/view_frame.h"

typedef struct fl_gl_bodies fl_gl_bodies;

/* NULL with FL_SYSTEM. */
fl_gl_bodies *fl_gl_bodies_open(fl_err *err);

/* Poses, spheres and tubes of a frame to the device, meshes for this camera.  -1 with FL_SYSTEM. */
int fl_gl_bodies_load(fl_gl_bodies *b, const fl_view_frame *v, const fl_eye *eye, fl_err *err);

enum fl_gl_what { FL_GL_ICE, FL_GL_STRUCTURE };

/* Draw with the program in use, which takes its matrices from the caller.  Meshes: `coarse` 1 takes at
 * most uncut arcs.  Spheres of the ice: as points, with a program for points, or as squares. */
void fl_gl_bodies_meshes(fl_gl_bodies *b, unsigned program, enum fl_gl_what what, int coarse);
void fl_gl_bodies_points(fl_gl_bodies *b);
void fl_gl_bodies_squares(fl_gl_bodies *b);
void fl_gl_bodies_tubes(fl_gl_bodies *b);
int32_t fl_gl_bodies_point_count(const fl_gl_bodies *b);
int32_t fl_gl_bodies_square_count(const fl_gl_bodies *b);

void fl_gl_bodies_close(fl_gl_bodies *b); /* NULL is accepted */

#endif
