/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include "base/array.h"
#include "mesh/inp_line.h"

int fl_inp_fail(const fl_inp_line *r, fl_err *err, const char *what, const char *more)
{
    return fl_deck_fail(&r->deck, err, "%s%.100s", what, more);
}

void fl_inp_line_free(fl_inp_line *r)
{
    fl_deck_free(&r->deck);
    free(r->text);
    *r = (fl_inp_line){0};
}

static const char *skip_blanks(const char *s)
{
    while (fl_bytes_blank(*s)) s++;
    return s;
}

static int is_keyword(const char *line) { return *skip_blanks(line) == '*'; }
static int is_comment(const char *line)
{
    const char *p = skip_blanks(line);
    return p[0] == '\0' || (p[0] == '*' && p[1] == '*');
}

/* Join a keyword line and its continuation lines in text. */
static int join_lines(fl_inp_line *r, fl_err *err)
{
    int32_t n = 0;
    for (;;) {
        const size_t len = strlen(r->deck.line);
        int more;
        if (fl_grow(&r->text, &r->text_cap, (int64_t)n + (int64_t)len + 1, 1, err)) return -1;
        memcpy(r->text + n, r->deck.line, len + 1);
        n += (int32_t)len;
        if (len == 0 || r->text[n - 1] != ',') return 0;
        do {
            more = fl_deck_line(&r->deck, err);
            if (more < 0) return -1;
        } while (more && is_comment(r->deck.line));
        if (!more) return 0;
        if (is_keyword(r->deck.line)) {
            fl_deck_unread(&r->deck);
            return 0;
        }
    }
}

/* Convert s to upper case without blanks, in place. */
static char *to_upper_no_blanks(char *s)
{
    char *to = s;
    for (const char *p = s; *p; p++)
        if (!isspace((unsigned char)*p)) *to++ = (char)toupper((unsigned char)*p);
    *to = '\0';
    return s;
}

static char *strip_quotes(char *s)
{
    const size_t n = strlen(s);
    if (n < 2 || s[0] != '"' || s[n - 1] != '"') return s;
    s[n - 1] = '\0';
    return s + 1;
}

/* End of an item: the next comma (or other mark) outside quotes, or the end of p. */
static char *item_end(char *p, char mark)
{
    int quoted = 0;
    for (; *p && (quoted || *p != mark); p++) quoted ^= *p == '"';
    return p;
}

/* Split text into word, keys and values. */
static void split_parameters(fl_inp_line *r)
{
    char *p = r->text + strspn(r->text, " \t*"), *end = item_end(p, ',');
    int last = *end == '\0';
    *end = '\0';
    to_upper_no_blanks(p);
    r->params = 0;
    snprintf(r->word, sizeof r->word, "%.*s", FL_INP_WORD - 1, p); /* no known keyword is as long */
    while (!last) {
        char *mid;
        p = end + 1;
        end = item_end(p, ',');
        last = *end == '\0';
        *end = '\0';
        p = fl_deck_trim(p);
        if (*p == '\0' || r->params == FL_INP_PARAMS) continue; /* no known keyword has as many */
        mid = item_end(p, '=');
        r->value[r->params] = *mid ? strip_quotes(fl_deck_trim(mid + 1)) : mid;
        *mid = '\0';
        r->key[r->params++] = to_upper_no_blanks(p);
    }
}

int fl_inp_split_keyword(fl_inp_line *r, fl_err *err)
{
    if (join_lines(r, err)) return -1;
    split_parameters(r);
    return 0;
}

const char *fl_inp_param(const fl_inp_line *r, const char *key)
{
    for (int k = 0; k < r->params; k++)
        if (strcmp(r->key[k], key) == 0) return r->value[k];
    return NULL;
}

int fl_inp_param_is(const fl_inp_line *r, const char *key, const char *value)
{
    const char *s = fl_inp_param(r, key);
    if (!s) return 0;
    for (; *s && *value; s++) {
        if (isspace((unsigned char)*s)) continue;
        if (toupper((unsigned char)*s) != *value) return 0;
        value++;
    }
    return *skip_blanks(s) == '\0' && *value == '\0';
}

const char *fl_inp_required(const fl_inp_line *r, const char *key, fl_err *err)
{
    const char *s = fl_inp_param(r, key);
    if (s && *s) return s;
    fl_deck_fail(&r->deck, err, "*%s needs %s=", r->word, key);
    return NULL;
}

int fl_inp_next(fl_inp_line *r, fl_err *err)
{
    for (;;) {
        const char *path;
        const int more = fl_deck_line(&r->deck, err);
        if (more <= 0) return more;
        if (is_comment(r->deck.line)) continue;
        if (!is_keyword(r->deck.line)) return 2;
        if (strncasecmp(skip_blanks(r->deck.line) + 1, "INCLUDE", 7) != 0) return 1;
        if (fl_inp_split_keyword(r, err)) return -1;
        path = fl_inp_required(r, "INPUT", err);
        if (!path || fl_deck_include(&r->deck, path, err)) return -1;
    }
}

int fl_inp_next_data(fl_inp_line *r, fl_err *err)
{
    const int kind = fl_inp_next(r, err);
    char *p = r->deck.line;
    if (kind < 0) return -1;
    if (kind != 2) {
        if (kind == 1) fl_deck_unread(&r->deck);
        return 0;
    }
    r->fields = 0;
    for (;;) { /* as item_end(), and without surrounding blanks */
        while (fl_bytes_blank(*p)) p++;
        char *const start = p, *end = p, *stop = p; /* stop: behind the last that is not blank */
        int quoted = 0;
        for (; *end && (quoted || *end != ','); end++) {
            quoted ^= *end == '"';
            if (!fl_bytes_blank(*end)) stop = end + 1;
        }
        const int last = *end == '\0';
        *stop = '\0';
        r->more = last && stop == start && r->fields > 0;
        if (r->more) return 1;
        if (r->fields == FL_INP_FIELDS) return fl_inp_fail(r, err, "too many numbers on one line", "");
        r->field[r->fields++] = *start == '"' ? strip_quotes(start) : start;
        if (last) return 1;
        p = end + 1;
    }
}

int fl_inp_real(const fl_inp_line *r, int k, double *x, fl_err *err)
{
    *x = 0.0;
    if (k >= r->fields || r->field[k][0] == '\0' || fl_deck_real(r->field[k], x) == 0) return 0;
    return fl_deck_fail(&r->deck, err, "field %d is \"%.40s\", a number is expected", k + 1, r->field[k]);
}

int fl_inp_point(const fl_inp_line *r, int k, fl_vec3 *x, fl_err *err)
{
    return fl_inp_real(r, k, &x->x, err) || fl_inp_real(r, k + 1, &x->y, err) ||
                   fl_inp_real(r, k + 2, &x->z, err)
               ? -1
               : 0;
}

int fl_inp_integer(const fl_inp_line *r, int k, int64_t missing, int64_t *n, fl_err *err)
{
    *n = missing;
    if (k >= r->fields || r->field[k][0] == '\0' || fl_deck_integer(r->field[k], n) == 0) return 0;
    return fl_deck_fail(&r->deck, err, "field %d is \"%.40s\", a whole number is expected", k + 1,
                        r->field[k]);
}

int fl_inp_id(const fl_inp_line *r, int k, int64_t *id, fl_err *err)
{
    if (fl_inp_integer(r, k, 0, id, err)) return -1;
    if (*id < 1)
        return fl_deck_fail(&r->deck, err, "field %d is \"%.40s\", a number of 1 or more is expected", k + 1,
                            k < r->fields ? r->field[k] : "");
    return 0;
}
