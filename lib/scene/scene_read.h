/* SPDX-License-Identifier: GPL-3.0-or-later */
/* scene_read.h -- reading of a scene file, and changes by the command line.  Grammar and keys: scene(5). */
#ifndef FL_SCENE_SCENE_READ_H
#define FL_SCENE_SCENE_READ_H
#include "base/text.h"
#include "scene/scene.h"

/* Read a scene into its defaults (calls fl_scene_init()); "-" is standard input.  A path in a file is
 * relative to the folder of that file; on standard input it is relative to the working folder. Returns 0,
 * or -1 with FL_INPUT (grammar, unknown or repeated key, unit, range; with file and line) or FL_SYSTEM;
 * scene is unchanged then. */
int fl_scene_read(fl_scene *scene, const char *path, fl_err *err);

/* The same from an open text, which is closed; paths are relative to the working folder. */
int fl_scene_read_text(fl_scene *scene, fl_text *text, fl_err *err);

/* Change one key: "section.key=value", for named sections "material.ice.young=2 GPa" or
 * "contact.ice.steel.friction=0.1"; blanks may replace the dots of the section.  The value overrides that
 * of the file, and an absent section becomes present.  Paths are relative to the working folder. Returns
 * 0, or -1 with FL_USAGE or FL_SYSTEM; the scene keeps its values then. */
int fl_scene_set(fl_scene *scene, const char *assignment, fl_err *err);

/* The scene of the run that wrote a table, by its lines "#set section.key = value" (fl_scene_write_sets); a
 * later line replaces an earlier one.  *history: the history of the table, to be freed, or NULL.  Calls
 * fl_scene_init(); 0, or -1 with FL_INPUT (no such line; an unknown key, with file and line) or FL_SYSTEM and
 * the scene unchanged. */
int fl_scene_read_sets(fl_scene *scene, const char *path, char **history, fl_err *err);

#endif
