/* SPDX-License-Identifier: GPL-3.0-or-later */
/* scene_print.h -- print a scene as text, and explain the keys. */
#ifndef FL_SCENE_SCENE_PRINT_H
#define FL_SCENE_SCENE_PRINT_H
#include <stdio.h>
#include "scene/scene.h"

/* Print the scene: every key of every present section with its value in SI units, under its current name.
 * Reading the text from standard input gives the same scene and the same text.  The only failure is that
 * of the stream, see ferror(). */
void fl_scene_write(FILE *f, const fl_scene *scene);

/* Print the sections that are present with the keys that are given, without a first line. */
void fl_scene_write_given(FILE *f, const fl_scene *scene);

/* Print the lines "#set section.key = value" at the head of a table: the keys that are given and differ from
 * their defaults, without those that change no number of it (run.threads and [output], but for loads_every
 * and the key `interval` of the table, "" for none).  fl_scene_read_sets() makes the same scene of them.
 * 0, or -1 with FL_SYSTEM in err. */
int fl_scene_write_sets(FILE *f, const fl_scene *scene, const char *interval, fl_err *err);

/* Print meaning, unit, range, default, old name, word of the manual and source of one key
 * ("water.density", also by its old name), of every key of a section ("water"), or, for "", of the sections.
 * A word alone that is no section, "softening" or "mus": of every key of that name, old name or word of the
 * manual, else a line for each whose names contain it.  Returns 0, or -1 with FL_USAGE and the nearest name
 * for an unknown key. */
int fl_scene_explain(FILE *f, const char *key, fl_err *err);

#endif
