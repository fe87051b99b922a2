/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <inttypes.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>
#include "base/array.h"
#include "base/number_text.h"
#include "base/text.h"

enum { CHUNK = 1 << 16 };

static int begin_text(fl_text *t, fl_in *in, fl_err *err)
{
    *t = (fl_text){0};
    t->in = in;
    t->chunk = t->in ? fl_alloc(CHUNK, 1, err) : NULL;
    if (t->chunk) return 0;
    fl_text_close(t);
    return -1;
}

int fl_text_open(fl_text *t, const char *path, fl_err *err)
{
    return begin_text(t, fl_in_open(path, err), err);
}

int fl_text_open_bytes(fl_text *t, const char *name, const void *data, int64_t n, fl_err *err)
{
    return begin_text(t, fl_in_open_bytes(name, data, n, err), err);
}

void fl_text_close(fl_text *t)
{
    fl_in_close(t->in);
    free(t->chunk);
    free(t->joined);
    free(t->field);
    free(t->history);
    free(t->run_lines);
    *t = (fl_text){0};
}

int fl_text_fail(const fl_text *t, fl_err *err, const char *fmt, ...)
{
    char what[400];
    va_list ap;
    va_start(ap, fmt);
    vsnprintf(what, sizeof what, fmt, ap);
    va_end(ap);
    if (t->line_number == 0)
        return fl_fail(err, FL_INPUT, "%s: %s", fl_in_name(t->in), what); /* the file is empty */
    return fl_fail(err, FL_INPUT, "%s:%" PRId64 ": %s", fl_in_name(t->in), t->line_number, what);
}

/* Is there a nul byte before end?  Each part of the chunk is searched once. */
static int has_nul(fl_text *t, int64_t end)
{
    if (end > t->nul_free) {
        const char *from = t->chunk + t->nul_free,
                   *zero = memchr(from, '\0', (size_t)(t->chunk_len - t->nul_free));
        t->nul_free = zero ? zero - t->chunk : t->chunk_len;
    }
    return end > t->nul_free;
}

/* Appends a part of a line that is not contained in one chunk. */
static int append_to_line(fl_text *t, int64_t k, fl_err *err)
{
    if (t->len + k > FL_TEXT_LINE_MAX) return fl_text_fail(t, err, "line is longer than 1 MiB");
    if (fl_grow(&t->joined, &t->joined_cap, t->len + k + 1, 1, err)) return -1;
    if (k) memcpy(t->joined + t->len, t->chunk + t->chunk_pos, (size_t)k);
    t->len += (int32_t)k;
    return 0;
}

int fl_text_line(fl_text *t, fl_err *err)
{
    int zero = 0, whole; /* set if the line lies in the chunk and can stay there */
    t->len = 0;
    t->line_number++;
    for (int first = 1;; first = 0) {
        const char *from = t->chunk + t->chunk_pos;
        const char *end = memchr(from, '\n', (size_t)(t->chunk_len - t->chunk_pos));
        const int64_t k = end ? end - from : t->chunk_len - t->chunk_pos;
        zero |= has_nul(t, t->chunk_pos + k);
        whole = first && end;
        if (whole) {
            t->line = t->chunk + t->chunk_pos;
            t->len = (int32_t)k;
        } else if (append_to_line(t, k, err)) {
            return -1;
        }
        t->chunk_pos += k + (end != NULL);
        if (end) break;
        t->chunk_pos = t->nul_free = 0;
        t->chunk_len = fl_in_read(t->in, t->chunk, CHUNK, err);
        if (t->chunk_len < 0) {
            t->chunk_len = 0;
            return -1;
        }
        if (t->chunk_len == 0) {
            if (t->len) break;
            t->line = t->joined;
            t->line[0] = '\0';
            t->line_number--;
            return 0;
        }
    }
    if (!whole) t->line = t->joined;
    if (t->line_number == 1 && t->len >= 3 && memcmp(t->line, "\xEF\xBB\xBF", 3) == 0)
        t->line += 3, t->len -= 3;
    if (t->len && t->line[t->len - 1] == '\r') t->len--;
    t->line[t->len] = '\0';
    if (zero) return fl_text_fail(t, err, "a zero byte: this is not a text file");
    return 1;
}

/* Append the current line to a text of lines. */
static int append_line(const fl_text *t, char **to, int32_t *len, int32_t *cap, fl_err *err)
{
    if (fl_grow(to, cap, *len + t->len + 2, 1, err)) return -1;
    memcpy(*to + *len, t->line, (size_t)t->len);
    *len += t->len;
    memcpy(*to + *len, "\n", 2);
    ++*len;
    return 0;
}

/* Keep a comment that is part of the history, or of the scene and the closing report of a run. */
static int keep_comment(fl_text *t, fl_err *err)
{
    const char *p = t->line;
    if (strncmp(p, "#by ", 4) == 0 || strncmp(p, "#stopped ", 9) == 0)
        return append_line(t, &t->history, &t->history_len, &t->history_cap, err);
    if (strncmp(p, "#set ", 5) == 0 || strncmp(p, "#report ", 8) == 0 || strncmp(p, "#part ", 6) == 0)
        return append_line(t, &t->run_lines, &t->run_lines_len, &t->run_lines_cap, err);
    return 0;
}

int fl_text_magic(fl_text *t, const char *kind, int newest, fl_err *err)
{
    char found[32] = "", digits[16] = "";
    int32_t version = 0;
    int used = 0;
    const int more = fl_text_line(t, err);
    if (more < 0) return -1;
    if (!more)
        return fl_fail(err, FL_INPUT, "%s: empty, a %s file is expected", fl_in_name(t->in),
                       kind ? kind : "table");
    if (sscanf(t->line, "#%31s %15s %n", found, digits, &used) != 2 || t->line[used] ||
        fl_number_i32(digits, 1, INT32_MAX, &version))
        return fl_text_fail(t, err, "\"%.40s\" does not open a %s file, \"#%s %d\" is expected", t->line,
                            kind ? kind : "table", kind ? kind : "KIND", newest);
    if (kind && strcmp(found, kind) != 0)
        return fl_text_fail(t, err, "this is a %s file, a %s file is expected", found, kind);
    if (version > newest)
        return fl_text_fail(t, err, "%s version %d is newer than this program, which reads up to %d", found,
                            version, newest);
    memcpy(t->kind, found, sizeof found);
    t->version = version;
    return 0;
}

/* Character classes: part of a field, blank, end of the row. */
enum { FIELD, BLANK, END };
static const unsigned char CLASS[256] = {
    ['\0'] = END, ['#'] = END, [' '] = BLANK, ['\t'] = BLANK, ['\f'] = BLANK, ['\v'] = BLANK};

static unsigned char class_of(char c) { return CLASS[(unsigned char)c]; }

int fl_text_split(fl_text *t, fl_err *err)
{
    char *p = t->line;
    t->n = t->next = 0;
    if (*p == '#' && keep_comment(t, err)) return -1;
    for (;;) {
        while (class_of(*p) == BLANK) p++;
        if (class_of(*p) == END) break;
        if (t->n == t->field_cap && fl_grow(&t->field, &t->field_cap, t->n + 1, sizeof *t->field, err))
            return -1;
        t->field[t->n++] = p;
        /* "#" begins a comment only after a blank. */
        while (class_of(*p) == FIELD || *p == '#') p++;
        if (*p) *p++ = '\0';
    }
    return t->n > 0;
}

int fl_text_row(fl_text *t, fl_err *err)
{
    int more;
    while ((more = fl_text_line(t, err)) > 0) {
        const int cut = fl_text_split(t, err);
        if (cut) return cut;
    }
    return more;
}

int fl_text_word(fl_text *t, const char *what, const char **word, fl_err *err)
{
    if (t->next >= t->n) return fl_text_fail(t, err, "%s is missing after %d fields", what, t->n);
    *word = t->field[t->next++];
    return 0;
}

int fl_text_row_of(fl_text *t, const char *word, fl_err *err)
{
    const char *found = "";
    const int more = fl_text_row(t, err);
    if (more < 0) return -1;
    if (more == 0) return fl_text_fail(t, err, "the file ends before \"%s\"", word);
    if (fl_text_word(t, word, &found, err)) return -1;
    return strcmp(found, word) == 0 ? 0
                                    : fl_text_fail(t, err, "\"%.40s\" found, expected \"%s\"", found, word);
}

int fl_text_f64(fl_text *t, const char *what, double *x, fl_err *err)
{
    const char *w = "";
    if (fl_text_word(t, what, &w, err)) return -1;
    if (fl_number_f64(w, x))
        return fl_text_fail(t, err, "%s is \"%.40s\", a finite number is expected", what, w);
    return 0;
}

int fl_text_i32(fl_text *t, const char *what, int32_t lo, int32_t hi, int32_t *x, fl_err *err)
{
    const char *w = "";
    if (fl_text_word(t, what, &w, err)) return -1;
    if (fl_number_i32(w, lo, hi, x))
        return fl_text_fail(t, err, "%s is \"%.40s\", a whole number from %d to %d is expected", what, w, lo,
                            hi);
    return 0;
}

int fl_text_no_more(fl_text *t, fl_err *err)
{
    if (t->next == t->n) return 0;
    return fl_text_fail(t, err, "\"%.40s\" was not expected after %d fields", t->field[t->next], t->next);
}

/* Levenshtein distance on at most 63 characters, case ignored. */
static int edit_distance(const char *a, const char *b)
{
    int row[64];
    const int na = (int)strnlen(a, 63), nb = (int)strnlen(b, 63);
    for (int j = 0; j <= nb; j++) row[j] = j;
    for (int i = 1; i <= na; i++) {
        int diagonal = row[0];
        row[0] = i;
        for (int j = 1; j <= nb; j++) {
            int best = diagonal + (strncasecmp(a + i - 1, b + j - 1, 1) != 0);
            if (row[j] + 1 < best) best = row[j] + 1;
            if (row[j - 1] + 1 < best) best = row[j - 1] + 1;
            diagonal = row[j];
            row[j] = best;
        }
    }
    return row[nb];
}

/* True if text contains word, case ignored. */
static int contains_word(const char *word, const char *text)
{
    const size_t n = strlen(word);
    for (; strlen(text) >= n; text++)
        if (strncasecmp(word, text, n) == 0) return 1;
    return 0;
}

const char *fl_text_nearest(const char *word, const char *const *list, int n)
{
    const char *best = NULL;
    int least = 1000, whole = 0;
    for (int k = 0; k < n; k++) whole = whole || contains_word(word, list[k]);
    for (int k = 0; k < n; k++) {
        if (whole && !contains_word(word, list[k])) continue;
        const int d = edit_distance(word, list[k]);
        if (d < least) {
            least = d;
            best = list[k];
        }
    }
    return best;
}
