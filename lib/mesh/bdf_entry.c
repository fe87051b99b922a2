/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <ctype.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include "base/array.h"
#include "mesh/bdf_entry.h"

enum { SMALL = 8, LARGE = 16, COLUMNS = 72, ROW = 8 };

void fl_bdf_entry_free(fl_bdf_entry *r)
{
    fl_deck_free(&r->deck);
    free(r->text);
    *r = (fl_bdf_entry){0};
}

int fl_bdf_fail(const fl_bdf_entry *r, fl_err *err, const char *fmt, ...)
{
    char what[400];
    va_list ap;
    va_start(ap, fmt);
    vsnprintf(what, sizeof what, fmt, ap);
    va_end(ap);
    return fl_elements_fail(r->deck.e, r->file, r->line, err, "%s", what);
}

/* --- lines ---------------------------------------------------------------------------------------------- */

static int is_include(const char *line)
{
    const char *p = line;
    while (*p == ' ' || *p == '\t') p++;
    return (*p | 32) == 'i' && strncasecmp(p, "INCLUDE", 7) == 0 && p[7] &&
           (fl_bytes_blank(p[7]) || strchr("'\"=", p[7]));
}

/* Advance to the next line that is not blank and cut off its comment.  Returns 1, 0 at the end, or -1. */
static int next_line(fl_bdf_entry *r, fl_err *err)
{
    for (;;) {
        const int more = fl_deck_line(&r->deck, err);
        char *line = r->deck.line, *end;
        if (more <= 0) return more;
        end = strchr(line, '$');
        if (end == line && r->comment && r->comment(r->context, line + 1, err)) return -1;
        if (is_include(line)) return 1; /* a $ may be part of the file name */
        if (end) *end = '\0';
        while (*line && fl_bytes_blank(*line)) line++;
        if (*line) return 1;
    }
}

/* True if the line continues the entry before it. */
static int is_continuation(const char *line)
{
    return (*line == '+' || *line == '*' || *line == ',' || fl_bytes_blank(*line)) && !is_include(line);
}

/* INCLUDE 'file', with quotes of either kind or none; a quoted name may continue on the next lines. */
static int follow_include(fl_bdf_entry *r, fl_err *err)
{
    char *line = r->deck.line + strspn(r->deck.line, " \t") + 7;
    int32_t n = 0;
    char mark, *end;
    line += strspn(line, " \t=");
    mark = *line == '\'' || *line == '"' ? *line++ : '\0';
    for (;;) {
        const size_t len = strlen(line);
        if (fl_grow(&r->text, &r->text_cap, (int64_t)n + (int64_t)len + 1, 1, err)) return -1;
        memcpy(r->text + n, line, len + 1);
        n += (int32_t)len;
        end = mark ? strchr(r->text, mark) : r->text + n;
        if (end) break;
        if (fl_deck_line(&r->deck, err) <= 0)
            return fl_bdf_fail(r, err, "the name of the file to include has no closing quote");
        line = r->deck.line + strspn(r->deck.line, " \t");
    }
    *end = '\0';
    if (fl_deck_include(&r->deck, fl_deck_trim(r->text), err) == 0) return 0;
    if (r->bulk || err->code != FL_INPUT) return -1;
    /* before BEGIN BULK it holds commands; whether that comes is not known yet */
    if (r->missing++ == 0) r->first_missing = *err;
    *err = (fl_err){0};
    return 0;
}

/* --- fields --------------------------------------------------------------------------------------------- */

/* Append s[0 .. n) as a field. */
static int add_field(fl_bdf_entry *r, const char *s, size_t n, fl_err *err)
{
    if (r->fields == FL_BDF_FIELDS) return 0;
    while (n > 0 && fl_bytes_blank(*s)) {
        s++;
        n--;
    }
    while (n > 0 && fl_bytes_blank(s[n - 1])) n--;
    if (fl_grow(&r->text, &r->text_cap, (int64_t)r->text_len + (int64_t)n + 1, 1, err)) return -1;
    memcpy(r->text + r->text_len, s, n);
    r->text[r->text_len + (int32_t)n] = '\0';
    r->at[r->fields++] = r->text_len;
    r->text_len += (int32_t)n + 1;
    return 0;
}

static int fill_fields(fl_bdf_entry *r, int fields, fl_err *err)
{
    while (r->fields < fields && r->fields < FL_BDF_FIELDS)
        if (add_field(r, "", 0, err)) return -1;
    return 0;
}

/* Free format: the name, eight fields (four behind a star) and the continuation mark, separated by commas. */
static int split_free(fl_bdf_entry *r, const char *line, fl_err *err)
{
    const char *p = line + strcspn(line, ",");
    const int star = memchr(line, '*', (size_t)(p - line)) != NULL, most = star ? ROW / 2 : ROW;
    if (!star && fill_fields(r, (r->fields + ROW - 1) / ROW * ROW, err)) return -1;
    const int had = r->fields;
    for (int k = 0; *p; k++) {
        const char *const comma = strchr(++p, ',');
        const size_t n = comma ? (size_t)(comma - p) : strlen(p);
        if (k < most && add_field(r, p, n, err)) return -1;
        if (k > most && strspn(p, " \t") < n)
            return fl_elements_fail(
                r->deck.e, r->deck.e->file, r->deck.e->line, err,
                "%d fields behind the name, %d and the mark of the next line are the most", k + 1, most);
        p += n;
    }
    return fill_fields(r, had + most, err);
}

/* Fixed columns; a tab reaches the next multiple of eight. */
static int split_columns(fl_bdf_entry *r, const char *line, fl_err *err)
{
    char text[COLUMNS + 8];
    int n = 0, width = SMALL;
    for (const char *p = line; *p && n < COLUMNS; p++) {
        do text[n++] = *p == '\t' ? ' ' : *p;
        while (*p == '\t' && n % SMALL);
    }
    while (n < COLUMNS) text[n++] = ' ';
    if (memchr(text, '*', SMALL)) width = LARGE;
    if (width == SMALL && fill_fields(r, (r->fields + ROW - 1) / ROW * ROW, err)) return -1;
    for (int k = SMALL; k < COLUMNS; k += width)
        if (add_field(r, text + k, (size_t)width, err)) return -1;
    return 0;
}

static int split_line(fl_bdf_entry *r, fl_err *err)
{
    return strchr(r->deck.line, ',') ? split_free(r, r->deck.line, err) : split_columns(r, r->deck.line, err);
}

/* True if a reader uses the fields of this entry.  Other entries, mostly loads, are not split. */
static int is_used(const char *name, int frame)
{
    if (frame && (strcmp(name, "MAT1") == 0 || strncmp(name, "SPC", 3) == 0 || strcmp(name, "FORCE") == 0 ||
                  strcmp(name, "MOMENT") == 0))
        return 1;
    return *name == 'C' || *name == 'G' || strncmp(name, "PB", 2) == 0 || strncmp(name, "PTUBE", 5) == 0 ||
           strncmp(name, "PROD", 4) == 0 || strncmp(name, "PSOLID", 6) == 0;
}

/* Without BEGIN BULK the deck is all bulk data, and so was what could not be included. */
static int end_of_deck(const fl_bdf_entry *r, fl_err *err)
{
    if (r->bulk || !r->missing) return 0;
    *err = r->first_missing;
    return -1;
}

int fl_bdf_next(fl_bdf_entry *r, fl_err *err)
{
    int more;
    while ((more = next_line(r, err)) > 0) {
        const char *line = r->deck.line, *start = line + strspn(line, " \t");
        size_t n = 0;
        r->file = r->deck.e->file;
        r->line = r->deck.e->line;
        if (is_include(line)) {
            if (follow_include(r, err)) return -1;
            continue;
        }
        if ((*start | 32) == 'e' && strncasecmp(start, "ENDDATA", 7) == 0) return end_of_deck(r, err);
        if (is_continuation(line)) continue; /* continues an entry that was skipped */
        while (line[n] && !fl_bytes_blank(line[n]) && line[n] != ',' && line[n] != '*' &&
               n < FL_BDF_NAME - 1) {
            r->name[n] = (char)toupper((unsigned char)line[n]);
            n++;
        }
        r->name[n] = '\0';
        r->fields = r->text_len = 0;
        if (strcmp(r->name, "BEGIN") == 0) r->bulk = 1;
        if (!is_used(r->name, r->frame)) return 1;
        if (split_line(r, err)) return -1;
        while ((more = next_line(r, err)) > 0 && is_continuation(r->deck.line))
            if (split_line(r, err)) return -1;
        if (more < 0) return -1;
        if (more) fl_deck_unread(&r->deck);
        return 1;
    }
    return more < 0 ? -1 : end_of_deck(r, err);
}

const char *fl_bdf_field(const fl_bdf_entry *r, int k) { return k < r->fields ? r->text + r->at[k] : ""; }

int fl_bdf_real(const fl_bdf_entry *r, int k, double *x, fl_err *err)
{
    const char *s = fl_bdf_field(r, k);
    *x = 0.0;
    if (*s == '\0' || fl_deck_real(s, x) == 0) return 0;
    return fl_bdf_fail(r, err, "field %d of %s is \"%.40s\", a number is expected", k + 2, r->name, s);
}

int fl_bdf_point(const fl_bdf_entry *r, int k, fl_vec3 *x, fl_err *err)
{
    if (fl_bdf_real(r, k, &x->x, err) || fl_bdf_real(r, k + 1, &x->y, err)) return -1;
    return fl_bdf_real(r, k + 2, &x->z, err);
}

int fl_bdf_integer(const fl_bdf_entry *r, int k, int64_t blank, int64_t *n, fl_err *err)
{
    const char *s = fl_bdf_field(r, k);
    *n = blank;
    if (*s == '\0' || fl_deck_integer(s, n) == 0) return 0;
    return fl_bdf_fail(r, err, "field %d of %s is \"%.40s\", a whole number is expected", k + 2, r->name, s);
}

int fl_bdf_id(const fl_bdf_entry *r, int k, int64_t *n, fl_err *err)
{
    if (fl_bdf_integer(r, k, 0, n, err)) return -1;
    if (*n >= 1) return 0;
    return fl_bdf_fail(r, err, "field %d of %s is \"%.40s\", a number of 1 or more is expected", k + 2,
                       r->name, fl_bdf_field(r, k));
}
