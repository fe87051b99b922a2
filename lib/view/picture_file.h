/* SPDX-License-Identifier: GPL-3.0-or-later */
/* picture_file.h -- a picture as PNG (8 bits, RGB, filter Up, zlib) or BMP (24 bits): the same bytes for
 * the same picture.  Sources: PNG specification, ISO/IEC 15948; BITMAPINFOHEADER. */
#ifndef FL_VIEW_PICTURE_FILE_H
#define FL_VIEW_PICTURE_FILE_H
#include <stdio.h>
#include "view/picture_rgba.h"

/* level: of zlib, 1 to 9.  -1 with FL_SYSTEM without memory; write errors stay in f, for fl_out_close(). */
int fl_png_write(FILE *f, const fl_picture *p, int level, fl_err *err);
void fl_bmp_write(FILE *f, const fl_picture *p);

#endif
