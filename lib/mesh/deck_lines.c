/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "base/number_text.h"
#include "mesh/deck_lines.h"

void fl_deck_start(fl_deck *d, fl_elements *e, fl_bytes *base)
{
    *d = (fl_deck){.e = e, .base = base};
    d->file[0] = e->file;
    base->pos = base->line = 0;
}

void fl_deck_free(fl_deck *d)
{
    while (d->depth > 0) fl_bytes_free(&d->included[--d->depth]);
    *d = (fl_deck){0};
}

int fl_deck_fail(const fl_deck *d, fl_err *err, const char *fmt, ...)
{
    char what[400];
    va_list ap;
    va_start(ap, fmt);
    vsnprintf(what, sizeof what, fmt, ap);
    va_end(ap);
    return fl_elements_fail(d->e, d->e->file, d->e->line, err, "%s", what);
}

int fl_deck_line(fl_deck *d, fl_err *err)
{
    fl_bytes *b = d->depth ? &d->included[d->depth - 1] : d->base;
    int32_t len;
    int more;
    if (d->unread) {
        d->unread = 0;
        d->e->file = d->unread_file;
        d->e->line = d->unread_line;
        return 1;
    }
    for (;;) {
        const int32_t file = d->file[d->depth];
        more = fl_bytes_line(b, &d->line, &len, err);
        d->e->file = file;
        d->e->line = b->line;
        if (more < 0) return -1;
        if (more > 0) break;
        if (d->depth == 0) return 0;
        fl_bytes_free(b);
        d->depth--;
        b = d->depth ? &d->included[d->depth - 1] : d->base;
    }
    while (len > 0 && fl_bytes_blank(d->line[len - 1])) len--;
    d->line[len] = '\0';
    d->len = len;
    return 1;
}

void fl_deck_unread(fl_deck *d)
{
    d->unread = 1;
    d->unread_file = d->e->file;
    d->unread_line = d->e->line;
}

int fl_deck_include(fl_deck *d, const char *path, fl_err *err)
{
    const char *deck = d->e->files.name[d->file[0]], *slash = strrchr(deck, '/');
    const size_t folder = slash && path[0] != '/' ? (size_t)(slash - deck) + 1 : 0;
    const int32_t here = d->e->file;
    char *whole = NULL;
    int32_t file;
    int rc = -1;
    if (path[0] == '\0') return fl_deck_fail(d, err, "a file to include is expected");
    if (d->depth == FL_DECK_DEPTH)
        return fl_deck_fail(d, err, "\"%.60s\" is included more than %d files deep", path, FL_DECK_DEPTH);
    if (d->includes++ == FL_DECK_FILES)
        return fl_deck_fail(d, err, "more than %d files are included", FL_DECK_FILES);
    if (strcmp(path, "-") == 0) return fl_deck_fail(d, err, "standard input cannot be included");
    whole = fl_alloc((int64_t)(folder + strlen(path) + 1), 1, err);
    if (!whole) return -1;
    memcpy(whole, deck, folder);
    memcpy(whole + folder, path, strlen(path) + 1);
    for (int k = 0; k <= d->depth; k++)
        if (strcmp(whole, d->e->files.name[d->file[k]]) == 0) {
            fl_deck_fail(d, err, "\"%.60s\" is included in itself", path);
            goto done;
        }
    /* names of files live as long as the elements */
    if (fl_elements_set_file(d->e, whole, err)) goto done;
    file = d->e->file;
    d->e->file = here;
    if (fl_bytes_open(&d->included[d->depth], d->e->files.name[file], err)) {
        if (err->code == FL_INPUT) {
            /* report the line that includes the file, which is where the user has to look */
            const fl_err why = *err;
            *err = (fl_err){0};
            fl_deck_fail(d, err, "the file included here cannot be read: %.300s", why.text);
        }
        goto done;
    }
    d->e->file = d->file[++d->depth] = file;
    rc = 0;
done:
    free(whole);
    return rc;
}

int fl_deck_real(const char *s, double *x)
{
    char text[64];
    size_t n = strlen(s), out = 0;
    int exponent = 0;
    if (fl_number_f64(s, x) == 0) return 0;
    if (n == 0 || n > sizeof text - 2) return -1;
    for (size_t k = 0; k < n; k++) {
        char c = s[k];
        if (c == 'd' || c == 'D') c = 'e';
        exponent |= c == 'e' || c == 'E';
        if ((c == '+' || c == '-') && k > 0 && !exponent) {
            text[out++] = 'e';
            exponent = 1;
        }
        text[out++] = c;
    }
    text[out] = '\0';
    return fl_number_f64(text, x);
}

int fl_deck_integer(const char *s, int64_t *x)
{
    const char *p = s + (*s == '-' || *s == '+'), *first = p;
    int64_t n = 0;
    for (; *p >= '0' && *p <= '9' && p - first < 18; p++) n = 10 * n + (*p - '0');
    if (p == first || *p != '\0') return -1; /* more than 18 digits */
    *x = *s == '-' ? -n : n;
    return 0;
}

char *fl_deck_trim(char *s)
{
    size_t n;
    while (fl_bytes_blank(*s)) s++;
    n = strlen(s);
    while (n > 0 && fl_bytes_blank(s[n - 1])) n--;
    s[n] = '\0';
    return s;
}
