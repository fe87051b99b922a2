/* SPDX-License-Identifier: GPL-3.0-or-later */
/* gl_view.h -- the passes of a picture: shadow map, ambient occlusion at half size, water and sky, bodies,
 * tubes. */
#ifndef FL_VIEW_GL_VIEW_H
#define FL_VIEW_GL_VIEW_H
#include "view/camera.h"
#include "view/look.h"
#include "view/picture_rgba.h"
#include "view/sea_surface.h"
#include "view/view_frame.h"

typedef struct fl_gl_view fl_gl_view;

typedef struct {
    int w, h;      /* of the picture [pixels] */
    int samples;   /* along each side of a pixel */
    int shadow;    /* side of the shadow map; 0: none */
    int occlusion; /* taps; 0: none */
    int keep_back; /* water and sky are kept while the camera stands; without shadows on open water */
    int keep_maps; /* shadow and occlusion are kept until a body has moved by half a texel of their maps */
} fl_gl_quality;

/* In the context that is current.  NULL with FL_SYSTEM. */
fl_gl_view *fl_gl_view_open(fl_err *err);

/* Quality of a picture (moving 0), of a film (1), of a window while the mouse moves (2). */
fl_gl_quality fl_gl_view_quality(const fl_look *l, int w, int h, int moving);

/* Draws into a framebuffer of its own.  sea: NULL for still water.  -1 with FL_SYSTEM. */
int fl_gl_view_draw(fl_gl_view *g, const fl_view_frame *v, const fl_look *l, const fl_camera *c,
                    fl_gl_quality q, const fl_sea_surface *sea, fl_err *err);

/* The picture drawn last, rows from the top; p has its size.  -1 with FL_SYSTEM. */
int fl_gl_view_read(fl_gl_view *g, fl_picture *p, fl_err *err);

/* Starts to read the picture drawn last into one of two buffers, 0 or 1; takes what was started. */
void fl_gl_view_start_read(fl_gl_view *g, int which);
void fl_gl_view_end_read(fl_gl_view *g, int which, fl_picture *p);

/* Shows the picture drawn last in the window's framebuffer of w x h, `bottom` pixels above its lower edge,
 * under an overlay of w x h whose rows go from the top and whose colours are multiplied by their alpha;
 * NULL: none. */
void fl_gl_view_show(fl_gl_view *g, int w, int h, int bottom, const fl_picture *overlay);

void fl_gl_view_close(fl_gl_view *g); /* NULL is accepted */

#endif
