/* SPDX-License-Identifier: GPL-3.0-or-later */
/* gl_shaders.h -- the shaders of a picture, GLSL 3.30.
 *
 * Light, in display values, no tone curve; s shadow, a ambient occlusion, n normal, `sun` the unit vector
 * towards it:
 *     c (1/2 (0.66 + 0.34 n.z) a (0.98, 1, 1.02) + 1/2 max(n.sun, 0) / sun.z s (1/2 + a/2) (1.02, 1, 0.98))
 * A level face in the sun has the factor 1, the colour of the bar. Below the surface of the water
 * mix(deep, c, 2^-(6.1, 1.95, 1.37) path), path along the view [m]; then the sky, 0.55 of its mirror image
 * by Fresnel's reflection at n = 1.33, F = 0.02 + 0.98 (1 - cos)^5 (C. Schlick, Computer Graphics Forum 13
 * (1994) 233), and haze. */
#ifndef FL_VIEW_GL_SHADERS_H
#define FL_VIEW_GL_SHADERS_H

extern const char fl_glsl_common[];      /* light, water, sky: of all that has a colour */
extern const char fl_glsl_mesh_vertex[]; /* triangles of bodies and parts, posed by a texture */
extern const char fl_glsl_mesh_pixel[];
extern const char fl_glsl_sphere_point[]; /* a sphere as a point, or as two triangles */
extern const char fl_glsl_sphere_quad[];
extern const char fl_glsl_sphere_pixel[];
extern const char fl_glsl_tube_vertex[]; /* capsules of contacts */
extern const char fl_glsl_tube_pixel[];
extern const char fl_glsl_full_vertex[]; /* a triangle over the whole picture */
extern const char fl_glsl_back_pixel[];  /* water and sky */
extern const char fl_glsl_occlusion_pixel[];
extern const char fl_glsl_blur_pixel[];
extern const char fl_glsl_nothing_pixel[]; /* depth alone */
extern const char fl_glsl_copy_pixel[];    /* a picture over another */

#endif
