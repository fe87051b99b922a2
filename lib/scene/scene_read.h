/* SPDX-License-Identifier: GPL-3.0-or-later */
/* scene_read.h -- a scene file, and the command line's changes to it.  Grammar and keys: scene(5). */
#ifndef FL_SCENE_SCENE_READ_H
#define FL_SCENE_SCENE_READ_H
#include "base/text.h"
#include "scene/scene.h"

/* Read a scene over its defaults (fl_scene_init() is called here); "-" is standard input.  Paths of files in
 * it are taken from the folder of the file they stand in, for standard input from the working folder.
 * scene is untouched on failure.
 * 0, or -1 with FL_INPUT (grammar, unknown or repeated or unsupported key, unit, range; file and line are
 * told) or FL_SYSTEM in err. */
int fl_scene_read(fl_scene *scene, const char *path, fl_err *err);

/* The same from a text that was opened already, which it closes; paths are taken from the working folder. */
int fl_scene_read_text(fl_scene *scene, fl_text *text, fl_err *err);

/* Change one key: "section.key=value", for named sections "material.ice.young=2 GPa" or
 * "contact.ice.steel.friction=0.1"; blanks may stand for the dots of the section.  What the file said is
 * overruled, a section that was absent becomes present; paths are taken from the working folder.
 * 0, or -1 with FL_USAGE or FL_SYSTEM in err; then scene keeps its values. */
int fl_scene_set(fl_scene *scene, const char *assignment, fl_err *err);

#endif
