/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include "base/decimal.h"
#include "base/array.h"
#include "base/number_text.h"
#include "mesh/bytes.h"

static const char BYTE_ORDER_MARK[] = "\xef\xbb\xbf";
static int32_t window = FL_BYTES_HEAD;
enum { MIN_CAPACITY = 1 << 17 }; /* bytes; data may be handed to fl_text, which reads as many at once */

void fl_bytes_set_window(int32_t bytes) { window = bytes > 0 ? bytes : FL_BYTES_HEAD; }

/* Length of the line end at p, 0 if there is none. */
static int line_end(const char *p) { return *p == '\n' ? 1 : *p != '\r' ? 0 : p[1] == '\n' ? 2 : 1; }

/* Index behind the last complete line end.  The byte behind it has been read, so \r\n is whole, and no
 * backslash before it joins the next line. */
static int32_t complete_until(const fl_bytes *b)
{
    if (b->ended) return b->n;
    for (int32_t k = b->n - 1; k-- > b->pos;) {
        const int width = line_end(b->data + k);
        if (width == 0 || (k > b->pos && (b->data[k - 1] == '\\' || b->data[k - 1] == '\r'))) continue;
        return k + width;
    }
    return b->pos;
}

/* Read until data holds n bytes or the file ends. */
static int fill_window(fl_bytes *b, int64_t n, fl_err *err)
{
    if (n > INT32_MAX - 1) n = INT32_MAX - 1;
    if (fl_grow(&b->data, &b->cap, n > MIN_CAPACITY ? n + 1 : MIN_CAPACITY, 1, err)) return -1;
    while (!b->ended && b->n < n) {
        const int64_t k = fl_in_read(b->in, b->data + b->n, n - b->n, err);
        if (k < 0) return -1;
        b->ended = k == 0;
        b->n += (int32_t)k;
    }
    b->data[b->n] = '\0';
    return 0;
}

/* Move the window: data then holds at least n bytes from pos on, or the rest of the file. */
static int advance_window(fl_bytes *b, int64_t n, fl_err *err)
{
    const int32_t left = b->n - b->pos;
    if (b->pos) memmove(b->data, b->data + b->pos, (size_t)left);
    b->offset += b->pos;
    b->pos = 0;
    b->n = left;
    if (fill_window(b, n > window ? n : window, err)) return -1;
    b->complete = complete_until(b);
    return 0;
}

/* Read until the line that begins at pos ends in data. */
static int complete_line(fl_bytes *b, fl_err *err)
{
    while (!b->ended && b->pos >= b->complete) {
        const int64_t left = b->n - b->pos;
        if (left >= INT32_MAX - 1) return fl_bytes_fail(b, err, "a line of more than 2 GiB");
        if (advance_window(b, 2 * left, err)) return -1;
    }
    return 0;
}

int fl_bytes_open(fl_bytes *b, const char *path, fl_err *err)
{
    *b = (fl_bytes){0};
    b->in = fl_in_open(path, err);
    if (!b->in) return -1;
    if (fill_window(b, window, err)) {
        fl_bytes_free(b);
        return -1;
    }
    if (b->n >= 3 && memcmp(b->data, BYTE_ORDER_MARK, 3) == 0) {
        b->n -= 3;
        memmove(b->data, b->data + 3, (size_t)b->n + 1);
    }
    b->complete = complete_until(b);
    return 0;
}

int fl_bytes_is_text(const fl_bytes *b) { return memchr(b->data, '\0', (size_t)b->n) == NULL; }

int fl_bytes_read_all(fl_bytes *b, fl_err *err)
{
    while (!b->ended) {
        if (b->n >= INT32_MAX - 1)
            return fl_fail(err, FL_INPUT, "%s: larger than 2 GiB, which is the most for a file of this kind",
                           fl_in_name(b->in));
        if (fill_window(b, 2 * (int64_t)b->n + window, err)) return -1;
    }
    b->complete = b->n;
    return 0;
}

int fl_bytes_read(fl_bytes *b, int32_t n, const unsigned char **p, fl_err *err)
{
    if (b->n - b->pos < n && !b->ended && advance_window(b, n, err)) return -1;
    if (b->n - b->pos < n) return 0;
    *p = (const unsigned char *)b->data + b->pos;
    b->pos += n;
    return 1;
}

int32_t fl_bytes_peek(fl_bytes *b, int32_t n, const char **p, fl_err *err)
{
    if (b->n - b->pos < n && !b->ended && advance_window(b, n, err)) return -1;
    *p = b->data + b->pos;
    return b->n - b->pos < n ? b->n - b->pos : n;
}

int fl_bytes_skip(fl_bytes *b, int64_t n, fl_err *err)
{
    for (;;) {
        const int32_t left = b->n - b->pos, k = n < left ? (int32_t)n : left;
        b->pos += k;
        n -= k;
        if (n == 0) return 1;
        if (b->ended) return 0;
        if (advance_window(b, 1, err)) return -1;
    }
}

/* Index of the first match of mark from pos on, in the sense of fl_bytes_seek(); without a match, the index
 * from which to search when more of the file has been read. */
static int32_t find_mark(const fl_bytes *b, const char *mark, int32_t len, int *found)
{
    const char *const end = b->data + b->n, *p = b->data + b->pos;
    *found = 0;
    while ((p = memchr(p, mark[0], (size_t)(end - p))) != NULL) {
        if (end - p <= len && !b->ended) return (int32_t)(p - b->data);
        /* a zero byte before it is a line end that was overwritten */
        *found = end - p >= len && memcmp(p, mark, (size_t)len) == 0 && strchr(" \t\r\n", p[len]) &&
                 (b->line == 0 || (p == b->data ? b->offset == 0 : strchr("\r\n", p[-1]) != NULL));
        if (*found) return (int32_t)(p - b->data);
        p++;
    }
    return b->n;
}

int fl_bytes_seek(fl_bytes *b, const char *mark, fl_err *err)
{
    const int32_t len = (int32_t)strlen(mark);
    b->words = b->next = 0;
    for (;;) {
        int found;
        const int32_t at = find_mark(b, mark, len, &found), keep = at > b->pos && !found;
        if (b->line)
            for (int32_t k = b->pos; k < at - keep; k++) b->line += b->data[k] == '\n';
        b->pos = at - keep; /* keep the byte before the mark: it shows whether a line begins there */
        if (found) return 1;
        if (b->ended) return 0;
        if (advance_window(b, (int64_t)len + 2, err)) return -1;
    }
}

int fl_bytes_line(fl_bytes *b, char **start, int32_t *len, fl_err *err)
{
    if (complete_line(b, err)) return -1;
    if (b->pos >= b->n) return 0;
    b->line++;
    *start = b->data + b->pos;
    char *const end = *start + strcspn(*start, "\r\n");
    if (*end == '\0' && end < b->data + b->n)
        return fl_bytes_fail(b, err, "a zero byte: this is not a text file");
    *len = (int32_t)(end - *start);
    b->pos += *len + (end < b->data + b->n ? line_end(end) : 0);
    *end = '\0';
    return 1;
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

/* Characters that may end a word. */
static const unsigned char ENDS_WORD[256] = {
    ['\0'] = 1, [' '] = 1, ['\t'] = 1, ['\f'] = 1, ['\v'] = 1, ['\r'] = 1, ['\n'] = 1, ['\\'] = 1};

/* End of the word that begins at p. */
static char *word_end(char *p)
{
    for (;; p++) {
        while (!ENDS_WORD[(unsigned char)*p]) p++;
        if (*p != '\\' || line_end(p + 1)) return p;
    }
}

/* Split the line at pos into words; pos moves to the next line. */
static int split_row(fl_bytes *b, fl_err *err)
{
    char *p, *end;
    b->words = b->next = 0;
    if (complete_line(b, err)) return -1;
    p = b->data + b->pos;
    end = b->data + b->n;
    b->line++;
    for (;;) {
        char *start;
        while (fl_bytes_blank(*p)) p++;
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
        start = p;
        p = word_end(p);
        if (*p == '\0' && p < end) return fl_bytes_fail(b, err, "a zero byte: this is not a text file");
        if (b->words == b->field_cap &&
            fl_grow(&b->field, &b->field_cap, (int64_t)b->words + 1, sizeof *b->field, err))
            return -1;
        b->field[b->words++] = start;
        if (fl_bytes_blank(*p)) *p++ = '\0';
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

/* Skip blanks and line ends. */
static int skip_space(fl_bytes *b, fl_err *err)
{
    for (;;) {
        const char *p = b->data + b->pos;
        for (; fl_bytes_blank(*p) || *p == '\r' || *p == '\n'; p++) b->line += *p == '\n';
        b->pos = (int32_t)(p - b->data);
        if (b->pos < b->n || b->ended) return 0;
        if (advance_window(b, 1, err)) return -1;
    }
}

/* A number as FORTRAN writes it: D for E, or no letter before the sign of the exponent. */
static int read_fortran(const char *p, int32_t len, double *x)
{
    char text[64];
    int32_t n = 0;
    int exponent = 0;
    if (len < 1 || len > (int32_t)sizeof text - 3) return 0;
    for (int32_t k = 0; k < len; k++) {
        const char c = (char)(p[k] == 'd' || p[k] == 'D' ? 'e' : p[k]);
        exponent |= c == 'e' || c == 'E';
        if ((c == '+' || c == '-') && k > 0 && !exponent) {
            text[n++] = 'e';
            exponent = 1;
        }
        text[n++] = c;
    }
    text[n] = '\0';
    return fl_decimal_read(text, x) == text + n;
}

int fl_bytes_real(fl_bytes *b, int any, double *x, fl_err *err)
{
    static const char ENDS[] = " \t\f\v\r\n";
    enum { TYPICAL = 64, LIMIT = 1 << 20 }; /* bytes of most numbers, and the limit for a word */
    const char *end;
    int32_t len;
    if (skip_space(b, err)) return -1;
    if (b->n - b->pos >= TYPICAL && (end = fl_decimal_read(b->data + b->pos, x)) != NULL &&
        (fl_bytes_blank(*end) || *end == '\n' || *end == '\r')) {
        b->pos = (int32_t)(end - b->data);
        return 1;
    }
    for (;;) {
        len = (int32_t)strcspn(b->data + b->pos, ENDS);
        if (b->pos + len < b->n || b->ended) break;
        if (len > LIMIT) return fl_bytes_fail(b, err, "a word of more than %d bytes", LIMIT);
        if (advance_window(b, 2 * (int64_t)len + TYPICAL, err)) return -1;
    }
    const char *p = b->data + b->pos;
    if (b->pos == b->n) return 0;
    if (p[len] == '\0' && b->pos + len < b->n)
        return fl_bytes_fail(b, err, "a zero byte: this is not a text file");
    end = fl_decimal_read(p, x);
    if (end != p + len && !(b->fortran && read_fortran(p, len, x))) {
        if (!any)
            return fl_bytes_fail(b, err, "\"%.*s\" was found, a number is expected", len < 40 ? len : 40, p);
        *x = 0.0;
    }
    b->pos += len;
    return 1;
}

int fl_bytes_row(fl_bytes *b, fl_err *err)
{
    while (b->pos < b->n || !b->ended) {
        if (split_row(b, err)) return -1;
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

static int parse_finite(const fl_bytes *b, const char *word, const char *what, double *x, fl_err *err)
{
    if (fl_number_f64(word, x))
        return fl_bytes_fail(b, err, "%s is \"%.40s\", a finite number is expected", what, word);
    return 0;
}

int fl_bytes_f64_at(const fl_bytes *b, int32_t k, const char *what, double *x, fl_err *err)
{
    if (k >= b->words) return fl_bytes_fail(b, err, "%s is missing after %d words", what, b->words);
    return parse_finite(b, b->field[k], what, x, err);
}

int fl_bytes_f64(fl_bytes *b, const char *what, double *x, fl_err *err)
{
    const char *word = "";
    const int more = fl_bytes_word(b, &word, err);
    if (more < 0) return -1;
    if (more == 0) return fl_bytes_fail(b, err, "the file ends where %s is expected", what);
    return parse_finite(b, word, what, x, err);
}
