/* SPDX-License-Identifier: GPL-3.0-or-later */
/* scene_section.h -- the sections of one scene, by number and by name. */
#ifndef FL_SCENE_SCENE_SECTION_H
#define FL_SCENE_SCENE_SECTION_H
#include "scene/scene_key.h"

/* Section i of its kind, NULL when there are fewer; i = 0 where there is only one.  The struct starts with
 * its fl_scene_head. */
void *fl_section_at(const fl_scene *scene, int section, int32_t i);
int32_t fl_section_count(const fl_scene *scene, int section);

/* Number of the section with these names (a, b empty where it has none; a pair in either order), or -1. */
int32_t fl_section_named(const fl_scene *scene, int section, const char *a, const char *b);

/* Append a section of a kind that has names, every key at its default.  Its number, or -1 with FL_SYSTEM. */
int32_t fl_section_add(fl_scene *scene, int section, const char *a, const char *b, fl_err *err);

/* Every key of a section at its default, no names, no marks; name chooses the defaults of `steel`. */
void fl_section_defaults(int section, const char *name, void *fresh);

/* Where a key lives, from "section.key", "material ice.young", "contact.ice.steel.law", or a section alone,
 * when key is -1. */
typedef struct {
    int section, key; /* numbers in the tables */
    char a[FL_SCENE_NAME], b[FL_SCENE_NAME];
} fl_address;

/* Take an address apart.  0, or -1 with a sentence in why: what was found and what is expected. */
int fl_address_read(const char *text, fl_address *out, char *why, size_t why_size);

/* The heading of a section, "contact ice steel", without its brackets; key is -1 in out. */
int fl_address_heading(const char *text, fl_address *out, char *why, size_t why_size);

/* Number of a key of the section, -1 with a sentence that names the nearest one in why. */
int fl_address_key(int section, const char *key, char *why, size_t why_size);

#endif
