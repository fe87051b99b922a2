/* SPDX-License-Identifier: GPL-3.0-or-later */
/* look.h -- how a picture looks: the settings of ice-view, kept in an INI file, look(5).
 *
 * A row of the table in look.c has key, kind, range and meaning of a setting; the reader, the writer and
 * ice-view --set follow from it.  `auto` is kept as NAN. */
#ifndef FL_VIEW_LOOK_H
#define FL_VIEW_LOOK_H
#include <stdio.h>
#include "base/err.h"
#include "view/colour_map.h"

enum fl_colour_by {
    FL_BY_ICE,
    FL_BY_ONE,
    FL_BY_SPEED,
    FL_BY_SPIN,
    FL_BY_DIAMETER,
    FL_BY_THICKNESS,
    FL_BY_HEIGHT,
    FL_BY_NUMBER,
    FL_BY_GROUP,
    FL_BY_FORCE,
    FL_BY_DAMAGE,
    FL_BY_COLUMN,
    FL_BYS
};
extern const char *const fl_colour_by_name[FL_BYS + 1];

enum { FL_LOOK_TEXT = 256 };

typedef struct {
    struct {
        int parallel;                             /* projection = perspective, parallel */
        double azimuth, elevation;                /* [deg] */
        double distance, at_x, at_y, at_z, field; /* [m]; [deg] */
        double spin;                              /* [deg/s] */
    } view;
    struct {
        int by, map;
        double from, to;
        char column[FL_LOOK_TEXT];
    } colour;
    struct {
        fl_rgb colour;
        double opacity;
    } ice, structure;
    struct {
        int shown;
        double level, opacity;
        fl_rgb colour;
    } water;
    struct {
        int kind; /* sky, plain */
        fl_rgb colour;
    } background;
    struct {
        double azimuth, elevation; /* of the sun [deg] */
        int32_t shadow, occlusion; /* side of the shadow map, taps; 0: none; -1: auto */
    } light;
    struct {
        int axis; /* none, x, y, z */
        double at;
        int side; /* above, below: what is taken away */
    } cut;
    struct {
        int32_t width, height, samples; /* samples: 1 to 3 along each side of a pixel */
        int smooth, legend, time, curve;
    } picture;
    struct {
        double thickness; /* of the tubes of contacts, radius at the largest force [m] */
        double most;      /* force of that radius [N] */
        int shown;
    } contacts;
} fl_look;

fl_look fl_look_defaults(void);

/* Reads "section.key=value" into the look; `where` names it in messages, and `code` is FL_USAGE or
 * FL_INPUT. */
int fl_look_set(fl_look *l, const char *key, const char *value, const char *where, int code, fl_err *err);

/* Reads a file of kind look: sections, "key = value", comments with #.  -1 with FL_INPUT or FL_SYSTEM. */
int fl_look_read(fl_look *l, const char *path, fl_err *err);

/* Writes all settings; reads back to the same look. */
void fl_look_write(FILE *f, const fl_look *l);

/* Writes key, default and meaning of each setting, for ice-view --keys. */
void fl_look_explain(FILE *f);

#endif
