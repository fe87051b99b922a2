/* SPDX-License-Identifier: GPL-3.0-or-later */
/* page.h -- one HTML file that plays frames in a browser: meshes, packed frames and the load curve in one
 * zlib stream, in base64, with a script (page_text.h).
 *
 * Places are rounded to 1 mm and rotations to 1 mrad, in the planes of out/frame_codec.h; meshes are
 * rounded shapes with arcs cut once.  Shapes are those of the first frame.  A body that is not there lies
 * 10 km below. */
#ifndef FL_VIEW_PAGE_H
#define FL_VIEW_PAGE_H
#include <stdio.h>
#include "view/legend.h"
#include "view/playback.h"

typedef struct {
    double from, to; /* frames of these times [s] */
    int32_t every;
    double level;          /* of the water [m] */
    double top_speed;      /* at the end of the colour bar [m/s] */
    const fl_curve *curve; /* NULL: none */
    const char *title;
} fl_page;

/* -1 with FL_INPUT (frames that cannot be read, more than 20 000 bodies) or FL_SYSTEM; write errors stay
 * in f, for fl_out_close(). */
int fl_page_write(FILE *f, fl_playback *p, const fl_page *page, fl_err *err);

#endif
