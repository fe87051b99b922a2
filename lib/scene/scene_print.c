/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "base/text.h"
#include "scene/scene_section.h"
#include "scene/field_words.h"
#include "scene/scene_print.h"
#include "scene/scene_value.h"

/* Of [contact A B] only given keys are written: a default would override [contact]. */
static void write_section(FILE *f, int section, const char *names, const void *at, int given_only)
{
    const fl_scene_head *head = at;
    const int first = fl_key_first(section);
    char text[FL_VALUE_TEXT];
    fprintf(f, "\n[%s%s]\n", fl_section_table[section].name, names);
    for (int k = first; k < fl_key_first(section + 1); k++)
        if (!(given_only && head->key[k - first].line == 0))
            fprintf(f, "%s = %s\n", fl_key_table[k].key, fl_value_text(&fl_key_table[k], at, text));
}

/* The names in the heading of section i of its kind, each after the mark: " ice steel". */
static void name_section(const fl_scene *scene, int s, int32_t i, char mark,
                         char names[2 * FL_SCENE_NAME + 2])
{
    const size_t size = 2 * FL_SCENE_NAME + 2;
    names[0] = '\0';
    if (s == FL_SEC_MATERIAL) snprintf(names, size, "%c%s", mark, scene->material[i].name);
    if (s == FL_SEC_GROUP) snprintf(names, size, "%c%s", mark, scene->group[i].name);
    if (s == FL_SEC_PART) snprintf(names, size, "%c%s", mark, scene->part[i].name);
    if (s == FL_SEC_MODE) snprintf(names, size, "%c%s", mark, scene->mode[i].name);
    if (s == FL_SEC_JOINT) snprintf(names, size, "%c%s", mark, scene->joint[i].name);
    if (s == FL_SEC_STAGE) snprintf(names, size, "%c%s", mark, scene->stage[i].name);
    if (s == FL_SEC_CONTACT && scene->contact[i].a[0])
        snprintf(names, size, "%c%s%c%s", mark, scene->contact[i].a, mark, scene->contact[i].b);
}

void fl_scene_write(FILE *f, const fl_scene *scene)
{
    char names[2 * FL_SCENE_NAME + 2];
    fl_scene_contact all;
    fprintf(f, "#scene 1\n");
    for (int s = 0; s < FL_SECTIONS; s++) {
        /* [contact] without names applies to the pairs below, so it is always written, and first */
        if (s == FL_SEC_CONTACT) {
            const int32_t i = fl_section_named(scene, s, "", "");
            fl_section_defaults(s, "", &all);
            write_section(f, s, "", i < 0 ? &all : &scene->contact[i], 0);
        }
        for (int32_t i = 0; i < fl_section_count(scene, s); i++) {
            const fl_scene_head *head = fl_section_at(scene, s, i);
            const int pair = s == FL_SEC_CONTACT;
            if (pair && scene->contact[i].a[0] == '\0') continue;
            name_section(scene, s, i, ' ', names);
            if (fl_section_table[s].names || head->present || s == FL_SEC_RUN || s == FL_SEC_OUTPUT)
                write_section(f, s, names, head, pair);
        }
    }
}

void fl_scene_write_given(FILE *f, const fl_scene *scene)
{
    char names[2 * FL_SCENE_NAME + 2];
    for (int s = 0; s < FL_SECTIONS; s++)
        for (int32_t i = 0; i < fl_section_count(scene, s); i++) {
            const fl_scene_head *head = fl_section_at(scene, s, i);
            name_section(scene, s, i, ' ', names);
            if (head->present) write_section(f, s, names, head, 1);
        }
}

/* 1 if a key that is given needs this one to be given too (unused_keys.h). */
static int is_needed(const fl_scene_head *head, const fl_key *needed)
{
    const int first = fl_key_first((int)needed->section);
    for (int k = first; k < fl_key_first((int)needed->section + 1); k++)
        for (int c = 0; c < 3; c++)
            if (fl_key_table[k].needs[c] && head->key[k - first].line &&
                strcmp(fl_key_table[k].needs[c], needed->key) == 0)
                return 1;
    return 0;
}

/* 1 if a record of the run needs the key: it is given, and differs from its default.  Threads, paths and
 * checkpoints change no number; of the intervals those of the loads and of the table itself count. */
static int is_of_run(const fl_key *key, const fl_scene_head *head, const void *defaults, const char *interval)
{
    char text[FL_VALUE_TEXT], usual[FL_VALUE_TEXT];
    const fl_scene_mark *mark = &head->key[key - fl_key_table - fl_key_first((int)key->section)];
    if (mark->line == 0) return 0;
    if (mark->is_auto && strcmp(key->default_text, key->special) == 0) return 0;
    if (key->section == FL_SEC_RUN && strcmp(key->key, "threads") == 0) return 0;
    if (key->section == FL_SEC_OUTPUT && strcmp(key->key, "loads_every") != 0 &&
        strcmp(key->key, interval) != 0)
        return 0;
    if (key->section == FL_SEC_CONTACT || is_needed(head, key)) return 1; /* it overrides [contact] */
    return strcmp(fl_value_text(key, head, text), fl_value_text(key, defaults, usual)) != 0;
}

/* Write the keys of a section; a section without any is made present by the default of its first key. */
static void write_section_sets(FILE *f, int s, const char *names, const fl_scene_head *head, void *defaults,
                               const char *interval)
{
    char text[FL_VALUE_TEXT];
    const char *section = fl_section_table[s].name;
    const int first = fl_key_first(s);
    int written = s == FL_SEC_RUN || s == FL_SEC_OUTPUT;
    fl_section_defaults(s, names[0] ? names + 1 : "", defaults);
    for (int k = first; k < fl_key_first(s + 1); k++) {
        const fl_key *key = &fl_key_table[k];
        if (!is_of_run(key, head, defaults, interval)) continue;
        fprintf(f, "#set %s%s.%s = %s\n", section, names, key->key, fl_value_text(key, head, text));
        written = 1;
    }
    if (!written) {
        const fl_key *key = &fl_key_table[first];
        fprintf(f, "#set %s%s.%s = %s\n", section, names, key->key, fl_value_text(key, defaults, text));
    }
}

int fl_scene_write_sets(FILE *f, const fl_scene *scene, const char *interval, fl_err *err)
{
    char names[2 * FL_SCENE_NAME + 2];
    size_t largest = 0;
    for (int s = 0; s < FL_SECTIONS; s++)
        if (fl_section_table[s].size > largest) largest = fl_section_table[s].size;
    void *const defaults = fl_alloc((int64_t)largest, 1, err);
    if (!defaults) return -1;
    for (int s = 0; s < FL_SECTIONS; s++)
        for (int32_t i = 0; i < fl_section_count(scene, s); i++) {
            const fl_scene_head *head = fl_section_at(scene, s, i);
            name_section(scene, s, i, '.', names);
            if (head->present) write_section_sets(f, s, names, head, defaults, interval);
        }
    free(defaults);
    return 0;
}

/* Print the words of "a|b|c". */
static void explain_choices(FILE *f, const char *choices)
{
    while (*choices) {
        const size_t len = strcspn(choices, "|");
        fprintf(f, " %.*s", (int)len, choices);
        choices += len + (choices[len] == '|');
        if (*choices) fputc(',', f);
    }
}

static void explain_type(FILE *f, const fl_key *k)
{
    char units[100], range[100];
    switch (k->type) {
    case FL_VALUE_F64: fprintf(f, "a number"); break;
    case FL_VALUE_VEC3: fprintf(f, k->single ? "one number or three" : "three numbers"); break;
    case FL_VALUE_I32: fprintf(f, "a whole number"); break;
    case FL_VALUE_WORD: fprintf(f, "one of"); break;
    case FL_VALUE_WORDS: fprintf(f, "one, or one for each of x, y, z, of"); break;
    case FL_VALUE_FIXED: fprintf(f, "some of x y z rx ry rz"); break;
    case FL_VALUE_NAME: fprintf(f, "a name"); break;
    case FL_VALUE_PATH: fprintf(f, "a file"); break;
    }
    if (k->type == FL_VALUE_F64 && k->choices) fprintf(f, ":");
    if (k->choices) explain_choices(f, k->choices);
    if (k->unit != FL_UNIT_ONE)
        fprintf(f, " in %s (units: %s)", fl_unit_si(k->unit), fl_unit_list(k->unit, units, sizeof units));
    if (k->range) fprintf(f, ", %s", fl_value_range(k, range, sizeof range));
    if (k->special) fprintf(f, ", or %s", k->special);
}

static void explain_key(FILE *f, const fl_key *k)
{
    const char *section = fl_section_table[k->section].name;
    fprintf(f, "%s.%s: %s\n", section, k->key, k->meaning);
    fprintf(f, "  value    ");
    explain_type(f, k);
    fprintf(f, "\n");
    fprintf(f, "  default  %s%s%s%s\n", k->default_text, k->default_steel ? " (steel: " : "",
            k->default_steel ? k->default_steel : "", k->default_steel ? ")" : "");
    if (k->old_name) fprintf(f, "  was      %s.%s, which is still read\n", section, k->old_name);
    for (int w = 0; w < fl_manual_count; w++)
        if (fl_manual_table[w].section == k->section && strcmp(fl_manual_table[w].key, k->key) == 0)
            fprintf(f, "  manual   %s\n", fl_manual_table[w].word);
    if (k->source) fprintf(f, "  source   %s\n", k->source);
}

/* A single word may be a section or a key of any section: suggest the nearest name of all. */
static int fail_unknown_word(const char *word, fl_err *err)
{
    const char *near[2 * FL_SECTIONS], *list[FL_SCENE_KEYS];
    for (int s = 0; s < FL_SECTIONS; s++) {
        const int first = fl_key_first(s), n = fl_key_first(s + 1) - first;
        for (int k = 0; k < n; k++) list[k] = fl_key_table[first + k].key;
        near[s] = fl_section_table[s].name;
        near[FL_SECTIONS + s] = n ? fl_text_nearest(word, list, n) : near[s];
    }
    const char *best = fl_text_nearest(word, near, 2 * FL_SECTIONS);
    for (int s = 0; s < FL_SECTIONS; s++)
        if (near[s] == best)
            return fl_fail(err, FL_USAGE, "unknown section [%.40s], nearest is [%s]", word, best);
    int of = 0;
    while (near[FL_SECTIONS + of] != best) of++;
    return fl_fail(err, FL_USAGE, "unknown section [%.40s], nearest is the key %s.%s", word,
                   fl_section_table[of].name, best);
}

/* 1 if the name is that of the key now or before, or a word of the manual for it; whole: not only a part of
 * it. */
static int has_name(const fl_key *key, const char *name, int whole)
{
    const char *const own[] = {key->key, key->old_name};
    for (int k = 0; k < 2; k++)
        if (own[k] && (whole ? strcmp(own[k], name) == 0 : strstr(own[k], name) != NULL)) return 1;
    for (int w = 0; w < fl_manual_count; w++) {
        const fl_manual_word *m = &fl_manual_table[w];
        if (m->section != key->section || strcmp(m->key, key->key) != 0) continue;
        if (whole ? strcmp(m->word, name) == 0 : strstr(m->word, name) != NULL) return 1;
    }
    return 0;
}

/* Explain each key that a word alone may mean: those of that name; then list those whose names contain it.  A
 * word of the field is answered before.  Returns how many answers there are. */
static int explain_word(FILE *f, const char *word)
{
    const fl_field_word *const field = fl_field_word_find(word);
    int found = field != NULL;
    if (field) fprintf(f, "%s: %s\n", field->word, field->says);
    for (int k = 0; k < fl_key_count; k++) {
        if (!has_name(&fl_key_table[k], word, 1)) continue;
        explain_key(f, &fl_key_table[k]);
        found++;
    }
    if (strlen(word) < 3) return found;
    for (int k = 0; k < fl_key_count; k++) {
        const fl_key *key = &fl_key_table[k];
        if (!has_name(key, word, 0) || has_name(key, word, 1)) continue;
        fprintf(f, "%s.%s: %s\n", fl_section_table[key->section].name, key->key, key->meaning);
        found++;
    }
    return found;
}

int fl_scene_explain(FILE *f, const char *key, fl_err *err)
{
    char text[200], why[400];
    const char *dot = strrchr(key, '.');
    fl_address at;
    int section;
    if (key[0] == '\0') {
        for (int s = 0; s < FL_SECTIONS; s++)
            fprintf(f, "%-16s  %s\n", fl_section_table[s].form, fl_section_table[s].meaning);
        return 0;
    }
    /* "material.young" as well as "material ice.young": a bare section has no names to check */
    snprintf(text, sizeof text, "%.*s", (int)(dot ? dot - key : (long)strlen(key)), key);
    section = fl_section_find(text);
    if (section >= 0) {
        at = (fl_address){.section = section, .key = -1};
        if (dot && (at.key = fl_address_key(section, dot + 1, why, sizeof why)) < 0)
            return fl_fail(err, FL_USAGE, "%s", why);
    } else if (!strchr(key, '.') && explain_word(f, key)) {
        return 0;
    } else if (!strpbrk(key, ". ")) {
        return fail_unknown_word(key, err);
    } else if (fl_address_read(key, &at, why, sizeof why)) {
        return fl_fail(err, FL_USAGE, "%s", why);
    }
    if (at.key >= 0) {
        explain_key(f, &fl_key_table[at.key]);
        return 0;
    }
    fprintf(f, "%s: %s\n", fl_section_table[at.section].form, fl_section_table[at.section].meaning);
    for (int k = fl_key_first(at.section); k < fl_key_first(at.section + 1); k++)
        explain_key(f, &fl_key_table[k]);
    return 0;
}
