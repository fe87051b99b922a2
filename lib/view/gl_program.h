/* SPDX-License-Identifier: GPL-3.0-or-later */
/* gl_program.h -- programs, textures and framebuffers of OpenGL, with failures reported.  Names of
 * OpenGL's objects are unsigned; 0: none. */
#ifndef FL_VIEW_GL_PROGRAM_H
#define FL_VIEW_GL_PROGRAM_H
#include "base/err.h"
#include "view/camera.h"

/* Compiles and links; each text is a list of parts that ends with NULL.  0 with FL_SYSTEM. */
unsigned fl_gl_program(const char *const *vertex, const char *const *fragment, fl_err *err);

enum fl_gl_format { FL_GL_COLOUR, FL_GL_DEPTH, FL_GL_GREY, FL_GL_FLOAT4, FL_GL_FLOAT1 };

/* A texture of w x h without contents, linear or nearest, clamped to its edge. */
unsigned fl_gl_texture(enum fl_gl_format format, int w, int h, int linear);

/* A framebuffer of textures; 0: without.  0 with FL_SYSTEM. */
unsigned fl_gl_target(unsigned colour, unsigned depth, fl_err *err);

/* Uniforms of the program in use, by name. */
void fl_gl_set_matrix(unsigned program, const char *name, const fl_mat4 *m);
void fl_gl_set_float(unsigned program, const char *name, float x);
void fl_gl_set_int(unsigned program, const char *name, int x);
void fl_gl_set_vec2(unsigned program, const char *name, float x, float y);
void fl_gl_set_vec3(unsigned program, const char *name, const float x[3]);
void fl_gl_set_vec4(unsigned program, const char *name, const float x[4]);

/* Binds a texture to a unit and names the unit in a sampler. */
void fl_gl_bind(unsigned program, const char *sampler, int unit, unsigned texture);

#endif
