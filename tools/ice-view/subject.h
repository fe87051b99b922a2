/* SPDX-License-Identifier: GPL-3.0-or-later */
/* subject.h -- the subject of pictures: frames or a single state, and the tables that go with it. */
#ifndef ICE_VIEW_SUBJECT_H
#define ICE_VIEW_SUBJECT_H
#include "options.h"
#include "base/string_table.h"
#include "scene/scene.h"
#include "view/camera.h"
#include "view/legend.h"
#include "view/playback.h"
#include "view/sea_surface.h"
#include "view/time_rows.h"
#include "view/view_frame.h"
#include "water/wave.h"

struct subject {
    fl_frame_file *file;
    fl_frame_data own; /* of a still */
    fl_playback play;
    fl_view_frame shown;
    int32_t *group;     /* [group_rows] of --ice, by row; -1: none */
    int32_t group_rows; /* rows of a run under way may become more */
    fl_string_table groups;
    fl_time_rows contacts, bonds, table, panels;
    fl_load_curve curve;
    char curve_title[80], column_title[160];
    fl_waves waves;
    fl_scene_boundary walls; /* of --scene */
    int has_walls;
    int has_waves;
    float *sea_height;
    fl_sea_surface sea; /* the waves at the time shown; height NULL: still water */
    fl_vec3 *fit;       /* points that a camera of its own choice has in view */
    int32_t fits, fit_cap;
    double from, to; /* ends of the colour bar */
    int bar;         /* a colour bar belongs to the picture */
    double most_force;
};

/* Opens the files of the options.  A warning goes to standard error.  -1 with FL_INPUT or FL_SYSTEM. */
int subject_open(struct subject *s, struct options *o, fl_err *err);

/* Chooses colours anew after the look has changed: ends of the bar.  -1 with FL_INPUT or FL_SYSTEM. */
int subject_range(struct subject *s, const fl_look *l, fl_err *err);

/* Poses, colours, tubes and waves at a time.  -1 with FL_INPUT or FL_SYSTEM. */
int subject_at(struct subject *s, const fl_look *l, double t, fl_err *err);

/* What `auto` of the camera has in view: the time shown, or all times.  -1 with FL_INPUT or FL_SYSTEM. */
int subject_fit_now(struct subject *s, fl_err *err);
int subject_fit_all(struct subject *s, double from, double to, fl_err *err);

/* The camera of a look: `auto` is resolved by the extent; spun by view.spin from `start`. */
fl_camera subject_camera(const struct subject *s, const fl_look *l, double aspect, double spin_seconds);

/* Height of the strip of the load curve at the lower edge of a picture; 0: none. */
int subject_strip(const struct subject *s, const fl_look *l, int w, int h);

/* Draws bar, time and curve of time t. */
void subject_legend(const struct subject *s, const fl_look *l, double t, fl_picture *p);

/* The time shown. */
double subject_time(const struct subject *s);

/* Sentences about a body for a click; text has 200 bytes. */
void subject_tell(const struct subject *s, int32_t row, char text[200]);

void subject_close(struct subject *s);

#endif
