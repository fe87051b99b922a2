/* SPDX-License-Identifier: GPL-3.0-or-later */
/* camera.h -- where a picture is seen from, and its 4x4 matrices (columns first, as OpenGL takes them). */
#ifndef FL_VIEW_CAMERA_H
#define FL_VIEW_CAMERA_H
#include "geom/vec3.h"

typedef struct {
    float m[16];
} fl_mat4;

/* The camera stands at `at` + distance (cos e cos a, cos e sin a, sin e) and looks at `at`; up is z. */
typedef struct {
    fl_vec3 at;
    double azimuth, elevation; /* [rad] */
    double distance;           /* [m] */
    double field;              /* vertical angle of view [rad]; parallel: height 2 distance tan(field / 2) */
    int parallel;
} fl_camera;

typedef struct {
    fl_mat4 view, projection, both, inverse_turn; /* the last: directions of the eye in the world */
    float eye[3], ahead[3];                       /* place of the camera, direction of the view */
    double pixel; /* height of a pixel at distance 1, or everywhere (parallel) [m] */
    int parallel;
} fl_eye;

/* radius: that of a sphere about `centre` that holds all that is drawn, for the near and far planes [m]. */
fl_eye fl_camera_eye(const fl_camera *c, int w, int h, fl_vec3 centre, double radius);

/* Of the nearest point of a sphere of radius `reach` about x, for eye->pixel [m]; 1 in a parallel view. */
double fl_eye_distance(const fl_eye *eye, const float x[3], double reach);

fl_mat4 fl_mat4_mul(fl_mat4 a, fl_mat4 b);

/* The ray through a pixel centre: a point on it and its direction. */
void fl_camera_ray(const fl_camera *c, int w, int h, double px, double py, fl_vec3 *from, fl_vec3 *along);

#endif
