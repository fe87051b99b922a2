/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "scene/unused_keys.h"
#include <stdio.h>
#include "scene/scene_section.h"

/* 1 if the key, which may be NULL, was given in the only section of its kind. */
static int is_given(const fl_scene *s, int section, const char *key)
{
    const fl_scene_head *head = fl_section_at(s, section, 0);
    return key && head->key[fl_key_find(section, key) - fl_key_first(section)].line != 0;
}

int fl_scene_check_unused(const fl_scene *s, fl_err *err)
{
    for (int k = 0; k < fl_key_count; k++) {
        const fl_key *key = &fl_key_table[k];
        const int section = (int)key->section;
        const char *name = fl_section_table[section].name, *const *needs = key->needs;
        char at[2 * FL_SCENE_NAME];
        if (!needs[0] || fl_section_table[section].names || !is_given(s, section, key->key)) continue;
        if (is_given(s, section, needs[0]) || is_given(s, section, needs[1]) ||
            is_given(s, section, needs[2]))
            continue;
        snprintf(at, sizeof at, "%s.%s", name, key->key);
        return fl_scene_fail(s, at, err, "%s has no effect without %s.%s%s%s%s%s", at, name, needs[0],
                             needs[1] ? " or " : "", needs[1] ? needs[1] : "", needs[2] ? " or " : "",
                             needs[2] ? needs[2] : "");
    }
    return 0;
}
