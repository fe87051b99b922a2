/* SPDX-License-Identifier: GPL-3.0-or-later */
/* picture_rgba.h -- a picture of RGBA bytes, rows from the top, and what is drawn on it by the processor:
 * areas, lines, letters.  Letters are strokes of our own, of any size, so that no font file is needed. */
#ifndef FL_VIEW_PICTURE_RGBA_H
#define FL_VIEW_PICTURE_RGBA_H
#include <stdint.h>
#include "base/err.h"

typedef struct {
    unsigned char *px; /* [4 w h] */
    int w, h;
} fl_picture;

typedef struct {
    unsigned char c[3];
} fl_rgb;

/* Zeroed pixels.  -1 with FL_SYSTEM. */
int fl_picture_make(fl_picture *p, int w, int h, fl_err *err);
void fl_picture_free(fl_picture *p); /* accepts a zeroed struct, leaves one */

/* The area [x0, x1) x [y0, y1) in a colour of opacity a.  Alpha becomes a + (1 - a) alpha. */
void fl_picture_plate(fl_picture *p, int x0, int y0, int x1, int y1, fl_rgb c, float a);

/* A line of the given width [pixels]. */
void fl_picture_line(fl_picture *p, float x0, float y0, float x1, float y1, float width, fl_rgb c, float a);

/* Text with its baseline at y; h: height of its capitals [pixels].  Bytes without a glyph leave a gap. */
void fl_picture_text(fl_picture *p, float x, float y, float h, const char *text, fl_rgb c);
float fl_picture_text_width(const char *text, float h);

/* Swaps rows, as between OpenGL's order and a file's. */
void fl_picture_flip(fl_picture *p);

#endif
