/* SPDX-License-Identifier: GPL-3.0-or-later */
/* film.h -- pictures to a film file through a pipe to ffmpeg; and one picture as jpg.
 *
 * Frames go as yuv420p, BT.709, limited range.  mp4, mkv, mov: x264, yuv420p, quality 21.  avi: mjpeg,
 * which every player knows.  gif is refused: ffmpeg's palette needs the whole film. */
#ifndef FL_VIEW_FILM_H
#define FL_VIEW_FILM_H
#include <stdio.h>
#include "view/picture_rgba.h"

typedef struct {
    FILE *pipe;
    long pid;
    const char *path; /* borrowed */
    char *part;       /* written here first */
    unsigned char *yuv;
    int w, h;
} fl_film;

/* True if ffmpeg is on the PATH. */
int fl_film_has_ffmpeg(void);

/* Starts a film of w x h pixels, both even.  -1 with FL_USAGE (an ending that is not known, odd sizes) or
 * FL_SYSTEM (no ffmpeg: the package). */
int fl_film_open(fl_film *f, const char *path, int w, int h, double fps, fl_err *err);

/* Writes the next frame.  -1 with FL_SYSTEM. */
int fl_film_add(fl_film *f, const fl_picture *p, fl_err *err);

/* Ends the film; it gets its name if ffmpeg ended well.  -1 with FL_SYSTEM. */
int fl_film_close(fl_film *f, fl_err *err);

/* Ends the film and removes what there is of it.  Accepts a zeroed struct. */
void fl_film_abort(fl_film *f);

/* Writes a picture as jpg.  -1 with FL_SYSTEM. */
int fl_film_jpg(const char *path, const fl_picture *p, fl_err *err);

#endif
