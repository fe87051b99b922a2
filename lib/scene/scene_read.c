/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <ini.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "base/number_text.h"
#include "base/text.h"
#include "scene/scene_read.h"
#include "scene/scene_section.h"
#include "scene/scene_value.h"

enum { SCENE_VERSION = 1, BEAUFORT_MAX = 17, WHY = 400 };

/* One file on its way in, or one --set (then text is not open and file is FL_SCENE_ARGUMENT). */
typedef struct {
    fl_scene *scene;
    fl_err *err;
    fl_text text;
    int32_t file;
    char folder[FL_SCENE_PATH]; /* of the file, with its slash; "" for the working folder */
    fl_address section;         /* the section that keys now belong to */
    int in_section;
    char *value; /* the value of the line, where it is too long for the parser's buffer; borrowed from text */
} source;

static int read_file(fl_scene *scene, const char *path, fl_err *err);

static int complain(const source *in, const char *fmt, ...) __attribute__((format(printf, 2, 3)));
static int complain(const source *in, const char *fmt, ...)
{
    char what[WHY + 100];
    va_list ap;
    va_start(ap, fmt);
    vsnprintf(what, sizeof what, fmt, ap);
    va_end(ap);
    if (in->file == FL_SCENE_ARGUMENT) return fl_fail(in->err, FL_USAGE, "--set: %s", what);
    return fl_text_fail(&in->text, in->err, "%s", what);
}

static fl_scene_mark mark_of(const source *in, uint32_t parts)
{
    return (fl_scene_mark){.file = in->file,
                           .line = in->file == FL_SCENE_ARGUMENT ? 1 : (int)in->text.line_number,
                           .components = parts};
}

/* The section of an address, made if it is not there; NULL without memory. */
static fl_scene_head *open_section(const source *in, const fl_address *at)
{
    fl_scene_head *head;
    int32_t i = fl_section_named(in->scene, at->section, at->a, at->b);
    if (i < 0) i = fl_section_add(in->scene, at->section, at->a, at->b, in->err);
    if (i < 0) return NULL;
    head = fl_section_at(in->scene, at->section, i);
    head->present = 1;
    if (head->heading.line == 0) head->heading = mark_of(in, ~0u);
    return head;
}

/* May this line give the key?  1 yes; 0 no, the scene itself gave it and overrules what it includes; -1 given
 * twice. */
static int may_give(const source *in, const fl_address *at, uint32_t parts)
{
    const int32_t i = fl_section_named(in->scene, at->section, at->a, at->b);
    const fl_scene_head *head = fl_section_at(in->scene, at->section, i);
    const fl_scene_mark *old;
    const char *key = fl_key_table[at->key].key;
    char section[4 * FL_SCENE_NAME];
    if (!head || in->file == FL_SCENE_ARGUMENT) return 1;
    old = &head->key[at->key - fl_key_first(at->section)];
    if (old->line == 0 || !(old->components & parts)) return 1;
    snprintf(section, sizeof section, "%s%s%s%s%s", fl_section_table[at->section].name, at->a[0] ? " " : "",
             at->a, at->b[0] ? " " : "", at->b);
    if (old->file == in->file)
        return complain(in, "%s.%s was given on line %d already", section, key, old->line);
    if (in->file == 0) return 1;
    if (old->file == 0) return 0;
    return complain(in, "%s.%s was given on line %d of %s already", section, key, old->line,
                    in->scene->file[old->file]);
}

/* The value of a word of the manual as the text of its key.  text stays where it means the same. */
static int map_word(enum fl_word_map map, const char **text, char buf[FL_NUMBER_LEN], char *why)
{
    static const char *const bound[] = {"rigid", "elastic", "periodic", "free"};
    double force;
    int32_t type;
    if (map == FL_MAP_BOUND) {
        if (fl_number_i32(*text, 1, 4, &type)) {
            snprintf(why, WHY,
                     "bound_type is \"%.60s\", 1 (rigid), 2 (elastic), 3 (periodic) or 4 (free) is expected",
                     *text);
            return -1;
        }
        *text = bound[type - 1];
    }
    if (map == FL_MAP_BEAUFORT) {
        if (fl_number_f64(*text, &force) || force < 0.0 || force > BEAUFORT_MAX) {
            snprintf(why, WHY, "windvel is \"%.60s\", a Beaufort number from 0 to %d is expected", *text,
                     BEAUFORT_MAX);
            return -1;
        }
        *text = fl_number_text(0.836 * force * sqrt(force), buf);
    }
    return 0;
}

/* Give a key its value.  Nothing of the scene changes on failure. */
static int give(const source *in, const fl_address *at, enum fl_word_map map, const char *text)
{
    union {
        fl_scene_run run;
        fl_scene_output output;
        fl_scene_material material;
        fl_scene_contact contact;
        fl_scene_ice ice;
        fl_scene_structure structure;
        fl_scene_boundary boundary;
        fl_scene_water water;
        fl_scene_wind wind;
        fl_scene_bond bond;
        fl_scene_group group;
    } scratch;
    const int slot = at->key - fl_key_first(at->section);
    fl_key key = fl_key_table[at->key];
    fl_scene_head *head;
    uint32_t parts = ~0u;
    char why[WHY], buf[FL_NUMBER_LEN];
    int may;
    memset(&scratch, 0, sizeof scratch);
    if (map == FL_MAP_X || map == FL_MAP_Y || map == FL_MAP_Z) { /* one component, read as a plain number */
        const int c = (int)map - FL_MAP_X;
        key.type = FL_VALUE_F64;
        key.at += (size_t)c * sizeof(double);
        parts = 1u << c;
    }
    if (map_word(map, &text, buf, why)) return complain(in, "%s", why);
    if (fl_value_read(&key, text, in->folder, &scratch, why, sizeof why)) return complain(in, "%s", why);
    may = may_give(in, at, parts);
    if (may <= 0) return may;
    head = open_section(in, at);
    if (!head) return -1;
    fl_value_copy(&key, head, &scratch);
    if (head->key[slot].line && head->key[slot].file == in->file) parts |= head->key[slot].components;
    head->key[slot] = mark_of(in, parts);
    head->key[slot].is_auto = fl_value_is_special(&key, &scratch);
    return 0;
}

/* --- lines ---------------------------------------------------------------------------------------------- */

static char *trim(char *s)
{
    size_t len;
    s += strspn(s, " \t\f\v");
    len = strlen(s);
    while (len && strchr(" \t\f\v", s[len - 1])) len--;
    s[len] = '\0';
    return s;
}

/* End the line where a comment starts: # or ; at the start of the line or behind a blank. */
static void cut_comment(char *s)
{
    for (char *p = s; *p; p++)
        if ((*p == '#' || *p == ';') && (p == s || p[-1] == ' ' || p[-1] == '\t')) {
            *p = '\0';
            return;
        }
}

/* The bare word that a line starts with; NULL for none. */
static const char *bare_word(const char *line)
{
    const char *best = NULL;
    size_t longest = 0;
    for (int k = -1; k < fl_manual_count; k++) {
        const char *word = k < 0 ? "include" : fl_manual_table[k].word;
        const size_t len = strlen(word);
        if (len > longest && strncmp(line, word, len) == 0 && strchr(" \t=", line[len])) {
            best = word; /* strchr also finds the end of the line */
            longest = len;
        }
    }
    return best;
}

static int unknown_word(const source *in, const char *line)
{
    const char *list[40];
    int n = 0;
    size_t len = strcspn(line, "=");
    while (len && strchr(" \t", line[len - 1])) len--;
    if (line[len] == '\0') len = strcspn(line, " \t");
    list[n++] = "include";
    for (int k = 0; k < fl_manual_count; k++) list[n++] = fl_manual_table[k].word;
    char word[64];
    snprintf(word, sizeof word, "%.*s", (int)(len < 60 ? len : 60), line);
    return complain(in, "\"%s\" before the first section is not a word of the manual, nearest is \"%s\"",
                    word, fl_text_nearest(word, list, n));
}

/* Open the section of a heading; heading points behind its bracket. */
static int heading(source *in, char *line)
{
    char why[WHY], *end = strchr(line, ']');
    if (!end) return complain(in, "\"%.40s\" lacks the ] of a section", line - 1);
    if (end[1]) return complain(in, "\"%.40s\" behind a section was not expected", end + 1);
    *end = '\0';
    if (fl_address_heading(trim(line), &in->section, why, sizeof why)) return complain(in, "%s", why);
    in->in_section = 1;
    return open_section(in, &in->section) ? 0 : -1;
}

/* Cut a line into key and value, at "=", or behind a bare word where there may be none. */
static int cut_line(const source *in, char *line, char **key, char **value)
{
    char *equals = strchr(line, '=');
    if (!in->in_section) {
        const char *word = bare_word(line);
        if (!word) return unknown_word(in, line);
        *key = line;
        *value = trim(line + strlen(word));
        if (**value == '=') *value = trim(*value + 1);
        line[strlen(word)] = '\0';
        return 0;
    }
    if (!equals) return complain(in, "\"%.40s\" is no section and no key = value", line);
    if (equals == line) return complain(in, "no key stands before =");
    *equals = '\0';
    *key = trim(line);
    *value = trim(equals + 1);
    return 0;
}

/* The parser's line source: each call is the next line that says something, as "key = value" or "[section]".
 * The packaged parser cuts lines to 200 bytes without a word, so a longer value waits in in->value. */
static char *next_line(char *buf, int size, void *stream)
{
    source *in = stream;
    char *line, *key = NULL, *value = NULL;
    int version;
    for (;;) {
        if (in->err->code || fl_text_line(&in->text, in->err) <= 0) return NULL;
        line = in->text.line;
        if (in->text.line_number == 1 && sscanf(line, "#scene %d", &version) == 1 &&
            version > SCENE_VERSION) {
            complain(in, "scene version %d is newer than this program, which reads up to %d", version,
                     SCENE_VERSION);
            return NULL;
        }
        line = trim(line);
        cut_comment(line);
        line = trim(line);
        if (*line == '[') {
            if (heading(in, line + 1)) return NULL;
        } else if (*line) {
            break;
        }
    }
    if (cut_line(in, line, &key, &value)) return NULL;
    if (strlen(key) + 8 > (size_t)size) {
        complain(in, "\"%.40s...\" is too long for a key", key);
        return NULL;
    }
    in->value = value;
    if (snprintf(buf, (size_t)size, "%s = %s\n", key, value) >= size)
        snprintf(buf, (size_t)size, "%s = .\n", key);
    else in->value = NULL;
    return buf;
}

static int include(source *in, const char *value)
{
    char path[FL_SCENE_PATH];
    const char *folder = value[0] == '/' ? "" : in->folder;
    if (in->file != 0)
        return complain(in, "include stands in a file that is itself included, one level is expected");
    if (value[0] == '\0' || strcmp(value, "-") == 0) return complain(in, "include wants the name of a file");
    const int n = snprintf(path, sizeof path, "%s%s", folder, value);
    if (n >= FL_SCENE_PATH)
        return complain(in, "include is a path of %d characters, at most %d are expected", n,
                        FL_SCENE_PATH - 1);
    return read_file(in->scene, path, in->err);
}

static int take(void *user, const char *section, const char *name, const char *value)
{
    source *in = user;
    fl_address at = in->section;
    char why[WHY];
    (void)section; /* next_line() keeps it, with its names */
    if (in->err->code) return 0;
    if (in->value) value = in->value;
    if (in->in_section) {
        at.key = fl_address_key(at.section, name, why, sizeof why);
        if (at.key < 0) complain(in, "%s", why);
        else give(in, &at, FL_MAP_SAME, value);
    } else if (strcmp(name, "include") == 0) {
        include(in, value);
    } else {
        for (int k = 0; k < fl_manual_count; k++) {
            const fl_manual_word *w = &fl_manual_table[k];
            if (strcmp(w->word, name) != 0) continue;
            at = (fl_address){.section = (int)w->section, .key = fl_key_find((int)w->section, w->key)};
            if (w->name) memcpy(at.a, w->name, strlen(w->name) + 1);
            give(in, &at, w->map, value);
        }
    }
    return in->err->code == 0;
}

/* Note the name of a file; its number, or -1. */
static int32_t keep_name(fl_scene *scene, const char *name, fl_err *err)
{
    char *copy = NULL;
    if (fl_grow(&scene->file, &scene->cap_file, scene->n_file + 1, sizeof *scene->file, err)) return -1;
    copy = fl_alloc_text(name, err);
    if (!copy) return -1;
    scene->file[scene->n_file] = copy;
    return scene->n_file++;
}

/* Everything in a text that is open already, which it closes.  in is fresh but for its folder. */
static int read_source(source *in, fl_scene *scene, fl_text *text, fl_err *err)
{
    int bad, rc = -1;
    in->scene = scene;
    in->err = err;
    in->text = *text;
    *text = (fl_text){0};
    in->file = keep_name(scene, fl_in_name(in->text.in), err);
    if (in->file < 0) goto done;
    bad = ini_parse_stream(next_line, in, take, in);
    if (err->code) goto done;
    if (bad < 0) fl_fail(err, FL_SYSTEM, "out of memory: %s", scene->file[in->file]);
    else if (bad > 0)
        complain(in, "the line is no section and no key = value"); /* next_line() lets none pass */
    else rc = 0;
done:
    fl_text_close(&in->text);
    return rc;
}

static int read_file(fl_scene *scene, const char *path, fl_err *err)
{
    source *in = fl_alloc(1, sizeof *in, err);
    const char *slash = strcmp(path, "-") == 0 ? NULL : strrchr(path, '/');
    fl_text text = {0};
    int rc = -1;
    if (!in) return -1;
    if (slash && (size_t)(slash - path) + 1 >= sizeof in->folder) {
        fl_fail(err, FL_INPUT, "%.60s...: the path is longer than %d characters", path, FL_SCENE_PATH - 2);
        goto done;
    }
    if (slash) memcpy(in->folder, path, (size_t)(slash - path) + 1);
    if (fl_text_open(&text, path, err) == 0) rc = read_source(in, scene, &text, err);
done:
    free(in);
    return rc;
}

int fl_scene_read(fl_scene *scene, const char *path, fl_err *err)
{
    fl_scene fresh;
    fl_scene_init(&fresh);
    if (read_file(&fresh, path, err)) {
        fl_scene_free(&fresh);
        return -1;
    }
    *scene = fresh;
    return 0;
}

int fl_scene_read_text(fl_scene *scene, fl_text *text, fl_err *err)
{
    source *in = fl_alloc(1, sizeof *in, err);
    fl_scene fresh;
    int rc = -1;
    fl_scene_init(&fresh);
    if (in) rc = read_source(in, &fresh, text, err);
    free(in);
    if (rc) fl_scene_free(&fresh);
    else *scene = fresh;
    return rc;
}

int fl_scene_set(fl_scene *scene, const char *assignment, fl_err *err)
{
    source in = {.scene = scene, .err = err, .file = FL_SCENE_ARGUMENT};
    fl_address at;
    char why[WHY], name[200], value[FL_VALUE_TEXT];
    const char *equals = strchr(assignment, '=');
    if (!equals || equals == assignment)
        return complain(&in, "\"%.60s\" is not section.key=value", assignment);
    if ((size_t)(equals - assignment) >= sizeof name || strlen(equals + 1) >= sizeof value)
        return complain(&in, "\"%.60s...\" is too long", assignment);
    memcpy(name, assignment, (size_t)(equals - assignment));
    name[equals - assignment] = '\0';
    memcpy(value, equals + 1, strlen(equals + 1) + 1);
    if (fl_address_read(trim(name), &at, why, sizeof why)) return complain(&in, "%s", why);
    if (at.key < 0) return complain(&in, "\"%.60s\" is a section, section.key=value is expected", name);
    return give(&in, &at, FL_MAP_SAME, trim(value));
}
