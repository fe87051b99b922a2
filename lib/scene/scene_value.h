/* SPDX-License-Identifier: GPL-3.0-or-later */
/* scene_value.h -- conversion of one value of a scene from text and to text, and copies between structs. */
#ifndef FL_SCENE_SCENE_VALUE_H
#define FL_SCENE_SCENE_VALUE_H
#include "scene/scene_key.h"

enum { FL_VALUE_TEXT = FL_SCENE_PATH + 8 };

/* Parse the value of a key and store it in `section`, the struct of its section.
 *   text    numbers and units, a word, a name, a path; ends trimmed
 *   folder  prefix of a relative path, "" for none
 *   why     out, on failure: what was found and what is expected, "run.dt is ..."
 * Returns 0, or -1 with section unchanged. */
int fl_value_read(const fl_key *key, const char *text, const char *folder, void *section, char *why,
                  size_t why_size);

/* Write the value as text that fl_value_read() parses to the same value.  Returns buf. */
char *fl_value_text(const fl_key *key, const void *section, char buf[FL_VALUE_TEXT]);

/* Copy the value of one key between two sections of the same kind. */
void fl_value_copy(const fl_key *key, void *to, const void *from);

/* 1 if a number has the value of the special word of the key (auto, none). */
int fl_value_is_special(const fl_key *key, const void *section);

/* 1 if s is a valid name of a material or a group: letters, digits, _ + -, 1 to FL_SCENE_NAME - 1
 * characters. */
int fl_value_is_name(const char *s);

/* Write the range in words, "above 0 and at most 1", "" for none.  Returns buf. */
char *fl_value_range(const fl_key *key, char *buf, size_t size);

#endif
