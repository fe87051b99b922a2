/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <assert.h>
#include <stdio.h>
#include <string.h>
#include "base/array.h"
#include "base/text.h"
#include "scene/field_words.h"
#include "scene/scene_section.h"
#include "scene/scene_value.h"

/* A kind of section that has names: offsets of length and capacity in fl_scene, and of the first name in a
 * section. */
typedef struct {
    size_t n, cap, name;
} named_kind;

#define NAMED(kind, first_name)                                                                              \
    {                                                                                                        \
        offsetof(fl_scene, n_##kind), offsetof(fl_scene, cap_##kind), offsetof(fl_scene_##kind, first_name)  \
    }
static const named_kind NAMED_KINDS[FL_SECTIONS] = {
    [FL_SEC_MATERIAL] = NAMED(material, name), [FL_SEC_CONTACT] = NAMED(contact, a),
    [FL_SEC_GROUP] = NAMED(group, name),       [FL_SEC_PART] = NAMED(part, name),
    [FL_SEC_JOINT] = NAMED(joint, name),       [FL_SEC_STAGE] = NAMED(stage, name),
    [FL_SEC_MODE] = NAMED(mode, name)};

int32_t fl_section_count(const fl_scene *scene, int section)
{
    int32_t n = 1;
    if (fl_section_table[section].names) memcpy(&n, (const char *)scene + NAMED_KINDS[section].n, sizeof n);
    return n;
}

void *fl_section_at(const fl_scene *scene, int section, int32_t i)
{
    const fl_section *t = &fl_section_table[section];
    void *array;
    if (!t->names) return i == 0 ? (char *)(uintptr_t)scene + t->offset : NULL; /* the caller's own object */
    memcpy(&array, (const char *)scene + t->offset, sizeof array);
    return i >= 0 && i < fl_section_count(scene, section) ? (char *)array + (size_t)i * t->size : NULL;
}

int32_t fl_section_named(const fl_scene *scene, int section, const char *a, const char *b)
{
    const int32_t n = fl_section_count(scene, section);
    if (!fl_section_table[section].names) return 0;
    for (int32_t i = 0; i < n; i++) {
        const char *first = (const char *)fl_section_at(scene, section, i) + NAMED_KINDS[section].name;
        const char *second = section == FL_SEC_CONTACT ? scene->contact[i].b : b;
        if (strcmp(first, a) == 0 && strcmp(second, b) == 0) return i;
        if (section == FL_SEC_CONTACT && strcmp(first, b) == 0 && strcmp(second, a) == 0) return i;
    }
    return -1;
}

int32_t fl_section_add(fl_scene *scene, int section, const char *a, const char *b, fl_err *err)
{
    const fl_section *t = &fl_section_table[section];
    const named_kind *kind = &NAMED_KINDS[section];
    int32_t *n = (int32_t *)(void *)((char *)scene + kind->n);
    int32_t *cap = (int32_t *)(void *)((char *)scene + kind->cap);
    char *fresh;
    if (fl_grow((char *)scene + t->offset, cap, *n + 1, t->size, err)) return -1;
    ++*n;
    fresh = fl_section_at(scene, section, *n - 1);
    fl_section_defaults(section, a, fresh);
    strncpy(fresh + kind->name, a, FL_SCENE_NAME - 1);
    if (section == FL_SEC_CONTACT) strncpy(scene->contact[*n - 1].b, b, FL_SCENE_NAME - 1);
    return *n - 1;
}

void fl_section_defaults(int section, const char *name, void *fresh)
{
    memset(fresh, 0, fl_section_table[section].size);
    for (int k = fl_key_first(section); k < fl_key_first(section + 1); k++) {
        const fl_key *key = &fl_key_table[k];
        const int steel = key->default_steel && strcmp(name, "steel") == 0;
        char why[200];
        int rc;
        rc = fl_value_read(key, steel ? key->default_steel : key->default_text, "", fresh, why, sizeof why);
        assert(rc == 0); /* test_scene reads every default */
        (void)rc;
    }
}

int fl_address_key(int section, const char *key, char *why, size_t why_size)
{
    const char *list[FL_SCENE_KEYS];
    const int first = fl_key_first(section), n = fl_key_first(section + 1) - first;
    const int k = fl_key_find(section, key);
    for (int i = 0; i < n; i++) list[i] = fl_key_table[first + i].key;
    if (k < 0) {
        const char *nearest = fl_text_nearest(key, list, n), *one = NULL;
        for (int i = 0; i < n; i++) /* static_friction for friction */
            if (fl_key_table[first + i].one_number && strstr(key, list[i]))
                nearest = list[i], one = fl_key_table[first + i].one_number;
        const fl_field_word *const field = one ? NULL : fl_field_word_find(key);
        snprintf(why, why_size, "unknown key \"%.40s\" in [%s], nearest is \"%s\"%s%s", key,
                 fl_section_table[section].name, nearest, one || field ? "; " : "",
                 one     ? one
                 : field ? field->says
                         : "");
    }
    return k;
}

int fl_address_heading(const char *text, fl_address *out, char *why, size_t why_size)
{
    char copy[200], *word[4] = {0}, *save = NULL;
    const char *list[FL_SECTIONS];
    const fl_section *t;
    fl_address at = {.key = -1};
    int n = 0;
    if (strlen(text) >= sizeof copy) {
        snprintf(why, why_size, "[%.40s...] is too long for the heading of a section", text);
        return -1;
    }
    memcpy(copy, text, strlen(text) + 1);
    for (char *w = strtok_r(copy, " \t", &save); w && n < 4; w = strtok_r(NULL, " \t", &save)) word[n++] = w;
    at.section = n ? fl_section_find(word[0]) : -1;
    if (at.section < 0) {
        for (int k = 0; k < FL_SECTIONS; k++) list[k] = fl_section_table[k].name;
        snprintf(why, why_size, "unknown section [%.40s], nearest is [%s]", text,
                 fl_text_nearest(n ? word[0] : "", list, FL_SECTIONS));
        return -1;
    }
    t = &fl_section_table[at.section];
    if (n - 1 != t->names && !(t->names == 2 && n == 1)) {
        snprintf(why, why_size, "[%.80s] has %d name%s, %s is expected", text, n - 1, n == 2 ? "" : "s",
                 t->form);
        return -1;
    }
    for (int k = 1; k < n; k++)
        if (!fl_value_is_name(word[k])) {
            snprintf(why, why_size,
                     "\"%.60s\" cannot be a name: letters, digits, _ + -, at most %d characters", word[k],
                     FL_SCENE_NAME - 1);
            return -1;
        }
    if (n > 1) memcpy(at.a, word[1], strlen(word[1]) + 1);
    if (n > 2) memcpy(at.b, word[2], strlen(word[2]) + 1);
    if (at.section == FL_SEC_MATERIAL && (!strcmp(at.a, "structure") || !strcmp(at.a, "boundary"))) {
        snprintf(why, why_size,
                 "a material cannot be called \"%s\": that word names a place in [contact A B]", at.a);
        return -1;
    }
    *out = at;
    return 0;
}

int fl_address_read(const char *text, fl_address *out, char *why, size_t why_size)
{
    char heading[200];
    const char *dot = strrchr(text, '.');
    const size_t len = dot ? (size_t)(dot - text) : strlen(text);
    fl_address at;
    if (len >= sizeof heading) {
        snprintf(why, why_size, "\"%.40s...\" is too long for a key", text);
        return -1;
    }
    for (size_t k = 0; k < len; k++) heading[k] = text[k] == '.' ? ' ' : text[k];
    heading[len] = '\0';
    if (fl_address_heading(heading, &at, why, why_size)) return -1;
    if (dot && (at.key = fl_address_key(at.section, dot + 1, why, why_size)) < 0) return -1;
    *out = at;
    return 0;
}
