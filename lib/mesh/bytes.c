/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include "base/mem.h"
#include "base/num.h"
#include "mesh/bytes.h"

enum { CHUNK = 1 << 16 };

static const char BYTE_ORDER_MARK[] = "\xef\xbb\xbf";

int fl_bytes_load(fl_bytes *b, const char *path, fl_err *err)
{
    int64_t k;
    *b = (fl_bytes){0};
    b->in = fl_in_open(path, err);
    if (!b->in) return -1;
    do {
        if (b->n > INT32_MAX - CHUNK - 1) {
            fl_fail(err, FL_INPUT, "%s: larger than 2 GiB", fl_in_name(b->in));
            goto fail;
        }
        if (fl_grow(&b->data, &b->cap, (int64_t)b->n + CHUNK + 1, 1, err)) goto fail;
        k = fl_in_read(b->in, b->data + b->n, CHUNK, err);
        if (k < 0) goto fail;
        b->n += (int32_t)k;
    } while (k > 0);
    if (b->n >= 3 && memcmp(b->data, BYTE_ORDER_MARK, 3) == 0) {
        b->n -= 3;
        memmove(b->data, b->data + 3, (size_t)b->n);
    }
    b->data[b->n] = '\0';
    return 0;
fail:
    fl_bytes_free(b);
    return -1;
}

void fl_bytes_free(fl_bytes *b)
{
    fl_in_close(b->in);
    free(b->data);
    free(b->field);
    *b = (fl_bytes){0};
}

int fl_bytes_fail(const fl_bytes *b, fl_err *err, const char *fmt, ...)
{
    char what[400];
    va_list ap;
    va_start(ap, fmt);
    vsnprintf(what, sizeof what, fmt, ap);
    va_end(ap);
    if (b->line) return fl_fail(err, FL_INPUT, "%s:%d: %s", fl_in_name(b->in), b->line, what);
    return fl_fail(err, FL_INPUT, "%s: %s", fl_in_name(b->in), what);
}

void fl_bytes_note(fl_bytes *b, const char *fmt, ...)
{
    char what[400];
    const size_t have = strlen(b->note);
    va_list ap;
    va_start(ap, fmt);
    vsnprintf(what, sizeof what, fmt, ap);
    va_end(ap);
    if (have + strlen(what) + 2 <= sizeof b->note) sprintf(b->note + have, "%s\n", what);
}

static int is_blank(char c) { return c == ' ' || c == '\t' || c == '\f' || c == '\v'; }

/* Length of the line end at p, 0 when there is none. */
static int line_end(const char *p) { return *p == '\n' ? 1 : *p != '\r' ? 0 : p[1] == '\n' ? 2 : 1; }

/* Cut the line at pos into words; pos moves to the next line. */
static int cut_line(fl_bytes *b, fl_err *err)
{
    char *p = b->data + b->pos, *const end = b->data + b->n;
    b->words = b->next = 0;
    b->line++;
    for (;;) {
        char *start;
        while (is_blank(*p)) p++;
        if (*p == '\\' && line_end(p + 1)) {
            p += 1 + line_end(p + 1);
            b->line++;
            continue;
        }
        if (p == end) break;
        if (*p == b->comment && b->comment) {
            while (p < end && !line_end(p)) p++;
            continue;
        }
        if (line_end(p)) {
            const int k = line_end(p);
            *p = '\0'; /* the last word may end here */
            p += k;
            break;
        }
        for (start = p; *p && !is_blank(*p) && !line_end(p) && !(*p == '\\' && line_end(p + 1)); p++) {}
        if (*p == '\0' && p < end) return fl_bytes_fail(b, err, "a zero byte: this is not a text file");
        if (fl_grow(&b->field, &b->field_cap, (int64_t)b->words + 1, sizeof *b->field, err)) return -1;
        b->field[b->words++] = start;
        if (is_blank(*p)) *p++ = '\0';
        else if (*p == '\\') {
            const int k = line_end(p + 1);
            *p = '\0';
            p += 1 + k;
            b->line++;
        }
    }
    b->pos = (int32_t)(p - b->data);
    return 0;
}

int fl_bytes_row(fl_bytes *b, fl_err *err)
{
    while (b->pos < b->n) {
        if (cut_line(b, err)) return -1;
        if (b->words) return 1;
    }
    b->words = b->next = 0;
    return 0;
}

int fl_bytes_word(fl_bytes *b, const char **word, fl_err *err)
{
    if (b->next >= b->words) {
        const int more = fl_bytes_row(b, err);
        if (more <= 0) return more;
    }
    *word = b->field[b->next++];
    return 1;
}

static int number(const fl_bytes *b, const char *word, const char *what, double *x, fl_err *err)
{
    if (fl_num_f64(word, x))
        return fl_bytes_fail(b, err, "%s is \"%.40s\", a finite number was wanted", what, word);
    return 0;
}

int fl_bytes_f64_at(const fl_bytes *b, int32_t k, const char *what, double *x, fl_err *err)
{
    if (k >= b->words) return fl_bytes_fail(b, err, "%s is missing after %d words", what, b->words);
    return number(b, b->field[k], what, x, err);
}

int fl_bytes_f64(fl_bytes *b, const char *what, double *x, fl_err *err)
{
    const char *word = "";
    const int more = fl_bytes_word(b, &word, err);
    if (more < 0) return -1;
    if (more == 0) return fl_bytes_fail(b, err, "the file ends where %s was wanted", what);
    return number(b, word, what, x, err);
}
