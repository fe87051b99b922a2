/* SPDX-License-Identifier: GPL-3.0-or-later */
/* scene.h -- one case: every key of a scene file with its value.
 *
 * Life of a scene:
 *     fl_scene_init()    every key at its default                          (scene.h)
 *     fl_scene_read()    values of the file replace defaults               (scene_read.h)
 *     fl_scene_set()     --set section.key=value, any number of times      (scene_read.h)
 *     fl_scene_check()   "auto" filled in, keys checked against each other (scene_check.h)
 *     fl_scene_write(), fl_scene_explain()                                 (scene_print.h)
 *     fl_scene_free()                                                      (scene.h)
 * Keys with types, units, defaults, ranges and sources are rows of one table, scene_key.h.  The
 * specification for the user is scene(5). */
#ifndef FL_SCENE_SCENE_H
#define FL_SCENE_SCENE_H
#include <stdint.h>
#include "base/err.h"
#include "scene/scene_types.h"

/* Set every key to its default, no section present.  Cannot fail.  scene may be uninitialised. */
void fl_scene_init(fl_scene *scene);

/* Accepts a zeroed scene and leaves a zeroed one. */
void fl_scene_free(fl_scene *scene);

/* Index of the material or the group of that name, -1 when there is none. */
int32_t fl_scene_find_material(const fl_scene *scene, const char *name);
int32_t fl_scene_find_group(const fl_scene *scene, const char *name);

/* Contact parameters of a body of material a (an index) with b: a material, the structure or the boundary.
 * A member takes the first of these values that was given:
 *     [contact A B], names in either order; the structure is named "structure" or by its material, the
 *                    boundary "boundary"
 *     [structure] friction, [boundary] stiffness        where b is the structure, the boundary
 *     [contact]      without names
 *     friction, restitution: the smaller value of the two materials (of material a at the boundary);
 *     other keys: the default.
 * Call fl_scene_check() before.  Cannot fail. */
enum { FL_SCENE_STRUCTURE = -1, FL_SCENE_BOUNDARY = -2 };
fl_scene_contact fl_scene_pair(const fl_scene *scene, int32_t a, int32_t b);

/* Record an error about a key, "FILE:LINE: sentence": the line where the key was given, else the heading
 * of its section, else the file alone; "--set: sentence" for a value from the command line.
 *   key  "section.key", "material ice.young", "contact ice steel.law"
 * The code is FL_INPUT (FL_USAGE for --set).  Returns -1. */
int fl_scene_fail(const fl_scene *scene, const char *key, fl_err *err, const char *fmt, ...)
    __attribute__((format(printf, 4, 5)));

#endif
