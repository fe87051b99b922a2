/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <ini.h>
#include <math.h>
#include <stdarg.h>
#include <stddef.h>
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

/* A file being read, or one --set (text is not open then, and file is FL_SCENE_ARGUMENT). */
typedef struct {
    fl_scene *scene;
    fl_err *err;
    fl_text text;
    int32_t file;
    char folder[FL_SCENE_PATH]; /* of the file, with its slash; "" for the working folder */
    fl_address section;         /* the current section */
    int in_section;
    char *value; /* value of the line if it is too long for the parser's buffer; borrowed from text */
} source;

static int read_file(fl_scene *scene, const char *path, fl_err *err);

static int fail_line(const source *in, const char *fmt, ...) __attribute__((format(printf, 2, 3)));
static int fail_line(const source *in, const char *fmt, ...)
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

/* The section of an address, appended if absent; NULL if memory is exhausted. */
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

/* Check whether this line may set the key.  Returns 1; 0 if the scene itself has set it, which overrides
 * included files; -1 if the key is given twice. */
static int check_key_is_new(const source *in, const fl_address *at, uint32_t parts)
{
    const int32_t i = fl_section_named(in->scene, at->section, at->a, at->b);
    const fl_scene_head *head = fl_section_at(in->scene, at->section, i);
    const fl_scene_mark *old;
    const fl_key *row = &fl_key_table[at->key];
    char section[4 * FL_SCENE_NAME], key[100];
    if (!head || in->file == FL_SCENE_ARGUMENT) return 1;
    old = &head->key[at->key - fl_key_first(at->section)];
    if (old->line == 0 || !(old->components & parts)) return 1;
    snprintf(section, sizeof section, "%s%s%s%s%s", fl_section_table[at->section].name, at->a[0] ? " " : "",
             at->a, at->b[0] ? " " : "", at->b);
    snprintf(key, sizeof key, "%s%s%s%s", row->key, row->old_name ? " (old name " : "",
             row->old_name ? row->old_name : "", row->old_name ? ")" : "");
    if (old->file == in->file)
        return fail_line(in, "%s.%s was given on line %d already", section, key, old->line);
    if (in->file == 0) return 1;
    if (old->file == 0) return 0;
    return fail_line(in, "%s.%s was given on line %d of %s already", section, key, old->line,
                     in->scene->file[old->file]);
}

/* Convert the value of a word of the manual to the text of its key; unchanged if both mean the same. */
static int convert_manual_value(enum fl_word_map map, const char **text, char buf[FL_NUMBER_LEN], char *why)
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

/* Room for one section of any kind. */
enum { SECTION_MAX = 65536 };
_Static_assert(sizeof(fl_scene_run) <= SECTION_MAX, "[run]");
_Static_assert(sizeof(fl_scene_output) <= SECTION_MAX, "[output]");
_Static_assert(sizeof(fl_scene_material) <= SECTION_MAX, "[material]");
_Static_assert(sizeof(fl_scene_contact) <= SECTION_MAX, "[contact]");
_Static_assert(sizeof(fl_scene_ice) <= SECTION_MAX, "[ice]");
_Static_assert(sizeof(fl_scene_structure) <= SECTION_MAX, "[structure]");
_Static_assert(sizeof(fl_scene_boundary) <= SECTION_MAX, "[boundary]");
_Static_assert(sizeof(fl_scene_water) <= SECTION_MAX, "[water]");
_Static_assert(sizeof(fl_scene_wind) <= SECTION_MAX, "[wind]");
_Static_assert(sizeof(fl_scene_bond) <= SECTION_MAX, "[bond]");
_Static_assert(sizeof(fl_scene_group) <= SECTION_MAX, "[group]");
_Static_assert(sizeof(fl_scene_part) <= SECTION_MAX, "[part]");
_Static_assert(sizeof(fl_scene_failure) <= SECTION_MAX, "[failure]");
_Static_assert(sizeof(fl_scene_mode) <= SECTION_MAX, "[mode]");
_Static_assert(sizeof(fl_scene_joint) <= SECTION_MAX, "[joint]");
_Static_assert(sizeof(fl_scene_stage) <= SECTION_MAX, "[stage]");

/* Set a key to the value of the text.  The scene is unchanged on failure. */
static int set_key(const source *in, const fl_address *at, enum fl_word_map map, const char *text)
{
    _Alignas(max_align_t) char scratch[SECTION_MAX];
    const int slot = at->key - fl_key_first(at->section);
    fl_key key = fl_key_table[at->key];
    fl_scene_head *head;
    uint32_t parts = ~0u;
    char why[WHY], buf[FL_NUMBER_LEN];
    int is_new;
    memset(scratch, 0, sizeof scratch);
    if (map == FL_MAP_X || map == FL_MAP_Y || map == FL_MAP_Z) { /* one component, read as a plain number */
        const int c = (int)map - FL_MAP_X;
        key.type = FL_VALUE_F64;
        key.offset += (size_t)c * sizeof(double);
        parts = 1u << c;
    }
    if (convert_manual_value(map, &text, buf, why)) return fail_line(in, "%s", why);
    if (fl_value_read(&key, text, in->folder, scratch, why, sizeof why)) return fail_line(in, "%s", why);
    is_new = check_key_is_new(in, at, parts);
    if (is_new <= 0) return is_new;
    head = open_section(in, at);
    if (!head) return -1;
    fl_value_copy(&key, head, scratch);
    if (head->key[slot].line && head->key[slot].file == in->file) parts |= head->key[slot].components;
    head->key[slot] = mark_of(in, parts);
    head->key[slot].is_auto = fl_value_is_special(&key, scratch);
    return 0;
}

/* Frames go to the file of the program of the manual, beside the scene.  The key is not marked as given, so
 * that [output] frames replaces it. */
static void ask_for_frames(const source *in)
{
    const fl_key *key = &fl_key_table[fl_key_find(FL_SEC_OUTPUT, "frames")];
    char why[WHY];
    if (in->scene->output.head.key[key - fl_key_table - fl_key_first(FL_SEC_OUTPUT)].line == 0)
        fl_value_read(key, "ANIMATION_3D.DAT", in->folder, &in->scene->output, why, sizeof why);
}

/* --- lines ---------------------------------------------------------------------------------------------- */

static char *trim_blanks(char *s)
{
    size_t len;
    s += strspn(s, " \t\f\v");
    len = strlen(s);
    while (len && strchr(" \t\f\v", s[len - 1])) len--;
    s[len] = '\0';
    return s;
}

/* Cut the line at a comment: # or ; at the start of the line or after a blank. */
static void strip_comment(char *s)
{
    for (char *p = s; *p; p++)
        if ((*p == '#' || *p == ';') && (p == s || p[-1] == ' ' || p[-1] == '\t')) {
            *p = '\0';
            return;
        }
}

/* The bare word at the start of a line, or NULL. */
static const char *bare_word(const char *line)
{
    const char *best = NULL;
    size_t longest = 0;
    for (int k = -1; k < fl_manual_count; k++) {
        const char *word = k < 0 ? "include" : fl_manual_table[k].word;
        const size_t len = strlen(word);
        if (len > longest && strncmp(line, word, len) == 0 && strchr(" \t=", line[len])) {
            best = word; /* strchr also finds the terminating zero */
            longest = len;
        }
    }
    return best;
}

static int fail_unknown_word(const source *in, const char *line)
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
    return fail_line(in, "\"%s\" before the first section is not a word of the manual, nearest is \"%s\"",
                     word, fl_text_nearest(word, list, n));
}

/* Open the section of a heading; line points after its bracket. */
static int read_heading(source *in, char *line)
{
    char why[WHY], *end = strchr(line, ']');
    if (!end) return fail_line(in, "\"%.40s\" lacks the ] of a section", line - 1);
    if (end[1]) return fail_line(in, "\"%.40s\" after a section is not expected", end + 1);
    *end = '\0';
    if (fl_address_heading(trim_blanks(line), &in->section, why, sizeof why)) return fail_line(in, "%s", why);
    in->in_section = 1;
    return open_section(in, &in->section) ? 0 : -1;
}

/* Split a line into key and value at "=", which may be absent after a bare word. */
static int split_line(const source *in, char *line, char **key, char **value)
{
    char *equals = strchr(line, '=');
    if (!in->in_section) {
        const char *word = bare_word(line);
        if (!word) return fail_unknown_word(in, line);
        *key = line;
        *value = trim_blanks(line + strlen(word));
        if (**value == '=') *value = trim_blanks(*value + 1);
        line[strlen(word)] = '\0';
        return 0;
    }
    if (!equals) return fail_line(in, "\"%.40s\" is no section and no key = value", line);
    if (equals == line) return fail_line(in, "no key stands before =");
    *equals = '\0';
    *key = trim_blanks(line);
    *value = trim_blanks(equals + 1);
    return 0;
}

/* Line source of the parser: each call returns the next "key = value" line; headings are handled here.
 * The packaged parser silently truncates lines to 200 bytes, so a longer value is kept in in->value. */
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
            fail_line(in, "scene version %d is newer than this program, which reads up to %d", version,
                      SCENE_VERSION);
            return NULL;
        }
        line = trim_blanks(line);
        strip_comment(line);
        line = trim_blanks(line);
        if (*line == '[') {
            if (read_heading(in, line + 1)) return NULL;
        } else if (*line) {
            break;
        }
    }
    if (split_line(in, line, &key, &value)) return NULL;
    if (strlen(key) + 8 > (size_t)size) {
        fail_line(in, "\"%.40s...\" is too long for a key", key);
        return NULL;
    }
    in->value = value;
    if (snprintf(buf, (size_t)size, "%s = %s\n", key, value) >= size)
        snprintf(buf, (size_t)size, "%s = .\n", key);
    else in->value = NULL;
    return buf;
}

static int read_include(source *in, const char *value)
{
    char path[FL_SCENE_PATH];
    const char *folder = value[0] == '/' ? "" : in->folder;
    if (in->file != 0) return fail_line(in, "include in an included file, one level is expected");
    if (value[0] == '\0' || strcmp(value, "-") == 0) return fail_line(in, "include needs the name of a file");
    const int n = snprintf(path, sizeof path, "%s%s", folder, value);
    if (n >= FL_SCENE_PATH)
        return fail_line(in, "include is a path of %d characters, at most %d are expected", n,
                         FL_SCENE_PATH - 1);
    return read_file(in->scene, path, in->err);
}

static int handle_key(void *user, const char *section, const char *name, const char *value)
{
    source *in = user;
    fl_address at = in->section;
    char why[WHY];
    (void)section; /* next_line() keeps the section with its names */
    if (in->err->code) return 0;
    if (in->value) value = in->value;
    if (in->in_section) {
        at.key = fl_address_key(at.section, name, why, sizeof why);
        if (at.key < 0) fail_line(in, "%s", why);
        else set_key(in, &at, FL_MAP_SAME, value);
    } else if (strcmp(name, "include") == 0) {
        read_include(in, value);
    } else {
        for (int k = 0; k < fl_manual_count; k++) {
            const fl_manual_word *w = &fl_manual_table[k];
            if (strcmp(w->word, name) != 0) continue;
            at = (fl_address){.section = (int)w->section, .key = fl_key_find((int)w->section, w->key)};
            if (w->name) memcpy(at.a, w->name, strlen(w->name) + 1);
            if (set_key(in, &at, w->map, value) == 0 && w->map == FL_MAP_FRAMES) ask_for_frames(in);
        }
    }
    return in->err->code == 0;
}

/* Store the name of a file.  Returns its index, or -1. */
static int32_t add_file_name(fl_scene *scene, const char *name, fl_err *err)
{
    char *copy = NULL;
    if (fl_grow(&scene->file, &scene->cap_file, scene->n_file + 1, sizeof *scene->file, err)) return -1;
    copy = fl_alloc_text(name, err);
    if (!copy) return -1;
    scene->file[scene->n_file] = copy;
    return scene->n_file++;
}

/* Read an open text and close it.  in is zeroed except for its folder. */
static int read_source(source *in, fl_scene *scene, fl_text *text, fl_err *err)
{
    int bad, rc = -1;
    in->scene = scene;
    in->err = err;
    in->text = *text;
    *text = (fl_text){0};
    in->file = add_file_name(scene, fl_in_name(in->text.in), err);
    if (in->file < 0) goto done;
    bad = ini_parse_stream(next_line, in, handle_key, in);
    if (err->code) goto done;
    if (bad < 0) fl_fail(err, FL_SYSTEM, "out of memory: %s", scene->file[in->file]);
    else if (bad > 0)
        fail_line(in, "the line is no section and no key = value"); /* next_line() passes no such line */
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

/* Forget that the key was given: a later line of a table replaces an earlier one. */
static void forget_key(const source *in, const fl_address *at)
{
    const int32_t i = fl_section_named(in->scene, at->section, at->a, at->b);
    fl_scene_head *head = fl_section_at(in->scene, at->section, i);
    if (head) head->key[at->key - fl_key_first(at->section)].line = 0;
}

static int assign(const source *in, const char *assignment)
{
    fl_address at;
    char why[WHY], name[200], value[FL_VALUE_TEXT];
    const char *equals = strchr(assignment, '=');
    if (!equals || equals == assignment)
        return fail_line(in, "\"%.60s\" is not section.key=value", assignment);
    if ((size_t)(equals - assignment) >= sizeof name || strlen(equals + 1) >= sizeof value)
        return fail_line(in, "\"%.60s...\" is too long", assignment);
    memcpy(name, assignment, (size_t)(equals - assignment));
    name[equals - assignment] = '\0';
    memcpy(value, equals + 1, strlen(equals + 1) + 1);
    if (fl_address_read(trim_blanks(name), &at, why, sizeof why)) return fail_line(in, "%s", why);
    if (at.key < 0) return fail_line(in, "\"%.60s\" is a section, section.key=value is expected", name);
    if (in->file != FL_SCENE_ARGUMENT) forget_key(in, &at);
    return set_key(in, &at, FL_MAP_SAME, trim_blanks(value));
}

int fl_scene_set(fl_scene *scene, const char *assignment, fl_err *err)
{
    const source in = {.scene = scene, .err = err, .file = FL_SCENE_ARGUMENT};
    return assign(&in, assignment);
}

/* Read the lines of an open table. */
static int read_sets(source *in, fl_err *err)
{
    int more, sets = 0;
    while ((more = fl_text_line(&in->text, err)) > 0) {
        if (in->text.line[0] != '#') continue;
        if (strncmp(in->text.line, "#set ", 5) == 0) {
            if (assign(in, in->text.line + 5)) return -1;
            sets++;
        } else if (fl_text_split(&in->text, err) < 0) { /* keeps the history */
            return -1;
        }
    }
    if (more < 0) return -1;
    if (sets == 0)
        return fl_fail(err, FL_INPUT,
                       "%s: no line \"#set section.key = value\": a table of dem-solve is expected",
                       fl_in_name(in->text.in));
    return 0;
}

int fl_scene_read_sets(fl_scene *scene, const char *path, char **history, fl_err *err)
{
    source *in = fl_alloc(1, sizeof *in, err);
    fl_scene fresh;
    int rc = -1;
    *history = NULL;
    fl_scene_init(&fresh);
    if (!in) return -1;
    in->scene = &fresh;
    in->err = err;
    if (fl_text_open(&in->text, path, err) || fl_text_magic(&in->text, NULL, 1, err)) goto done;
    in->file = add_file_name(&fresh, fl_in_name(in->text.in), err);
    if (in->file < 0 || read_sets(in, err)) goto done;
    if (in->text.history && !(*history = fl_alloc_text(in->text.history, err))) goto done;
    rc = 0;
done:
    fl_text_close(&in->text);
    free(in);
    if (rc) fl_scene_free(&fresh);
    else *scene = fresh;
    return rc;
}
