/* SPDX-License-Identifier: GPL-3.0-or-later */
/* scene_section.h -- access to the sections of a scene by index and by name, and addresses of keys. */
#ifndef FL_SCENE_SCENE_SECTION_H
#define FL_SCENE_SCENE_SECTION_H
#include "base/err.h"
#include "scene/scene_key.h"

/* Section i of its kind, NULL if there are fewer; i = 0 for a kind with one section.  The struct starts with
 * its fl_scene_head. */
void *fl_section_at(const fl_scene *scene, int section, int32_t i);
int32_t fl_section_count(const fl_scene *scene, int section);

/* Index of the section with these names (empty for a kind without names; a pair in either order), or -1. */
int32_t fl_section_named(const fl_scene *scene, int section, const char *a, const char *b);

/* Append a named section with every key at its default.  Returns its index, or -1 with FL_SYSTEM. */
int32_t fl_section_add(fl_scene *scene, int section, const char *a, const char *b, fl_err *err);

/* Set every key of a section to its default, without names and marks.  name "steel" selects default_steel. */
void fl_section_defaults(int section, const char *name, void *fresh);

/* Address of a key: "section.key", "material ice.young", "contact.ice.steel.law"; or of a section alone, with
 * key -1. */
typedef struct {
    int section, key; /* indices in the tables */
    char a[FL_SCENE_NAME], b[FL_SCENE_NAME];
} fl_address;

/* Parse an address.  Returns 0, or -1 with a sentence in why: what was found and what is expected. */
int fl_address_read(const char *text, fl_address *out, char *why, size_t why_size);

/* Parse the heading of a section, "contact ice steel", without its brackets; out->key is -1. */
int fl_address_heading(const char *text, fl_address *out, char *why, size_t why_size);

/* Index of a key of the section; -1 with a sentence that suggests the nearest name in why. */
int fl_address_key(int section, const char *key, char *why, size_t why_size);

#endif
