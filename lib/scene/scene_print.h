/* SPDX-License-Identifier: GPL-3.0-or-later */
/* scene_print.h -- a scene as text, and the table of keys as help. */
#ifndef FL_SCENE_SCENE_PRINT_H
#define FL_SCENE_SCENE_PRINT_H
#include <stdio.h>
#include "scene/scene.h"

/* The complete scene, every key of every section that is present with its value in SI units; reading it from
 * standard input (or, paths apart, from anywhere) gives the same scene and the same text again.  Cannot fail
 * but by the stream, whose error flag tells. */
void fl_scene_write(FILE *f, const fl_scene *scene);

/* Meaning, unit, range, default, manual's word and source of one key ("water.density"), of every key of a
 * section ("water"), or, for "", of the sections.
 * 0, or -1 with FL_USAGE in err for a key that is not known; the nearest one is named. */
int fl_scene_explain(FILE *f, const char *key, fl_err *err);

#endif
