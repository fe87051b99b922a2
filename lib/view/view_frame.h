/* SPDX-License-Identifier: GPL-3.0-or-later */
/* view_frame.h -- what is drawn at one time: poses and colours of bodies and parts, tubes; and its extent.
 *
 * Places are about `origin`, so that single precision is enough far from the origin of the scene. */
#ifndef FL_VIEW_VIEW_FRAME_H
#define FL_VIEW_VIEW_FRAME_H
#include "geom/aabb.h"
#include "out/frame_data.h"
#include "view/colour_map.h"

/* Kinds of colour: ice with its own look, a value of the bar, a colour as it is. */
enum fl_paint { FL_PAINT_ICE, FL_PAINT_VALUE, FL_PAINT_PLAIN };

/* As a row of the pose texture holds it. */
typedef struct {
    float x[3], speck; /* place; a number of the body, for its grain */
    float q[4];        /* rotation x y z w; 0 0 0 0: it is not there */
    float colour[3], kind;
} fl_view_pose;

typedef struct {
    float a[3], b[3], r, colour[3];
} fl_tube;

typedef struct {
    const fl_frame_data *data; /* borrowed */
    fl_vec3 origin;            /* [m] */
    fl_vec3 centre;            /* of a sphere that holds all, about origin */
    double radius;             /* of it [m] */
    double t;                  /* [s] */
    int32_t frame;             /* whose shapes are valid */
    int32_t rows, parts;
    fl_view_pose *pose; /* [rows + parts] */
    float *reach;       /* [rows + parts] radius of a sphere about the place */
    fl_tube *tube;
    int32_t tubes, tube_cap;
} fl_view_frame;

/* Room for the rows and parts of d, with their reach.  box: of all that is shown.  -1 with FL_SYSTEM. */
int fl_view_frame_make(fl_view_frame *v, const fl_frame_data *d, fl_aabb box, fl_err *err);

/* Box of the bodies and parts of a frame. */
fl_aabb fl_view_frame_box(const fl_frame_data *d, const fl_frame *f);

int fl_view_frame_add_tube(fl_view_frame *v, fl_vec3 a, fl_vec3 b, double r, fl_rgb c, fl_err *err);

/* The body that a ray meets first, by spheres first and then by its core moved out by the radius.
 * from: in the axes of the scene.  The row, or -1. */
int32_t fl_view_frame_pick(const fl_view_frame *v, fl_vec3 from, fl_vec3 along);

void fl_view_frame_free(fl_view_frame *v); /* accepts a zeroed struct, leaves one */

#endif
