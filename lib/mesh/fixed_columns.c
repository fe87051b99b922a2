/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/decimal.h"
#include "mesh/fixed_columns.h"
#include "mesh/deck_lines.h"

int fl_columns_parse(fl_columns *f, const char *format)
{
    const char *p = format + strspn(format, " \t");
    int at = 0, mixed = 0;
    *f = (fl_columns){0};
    if (*p++ != '(') return -1;
    while (*p && *p != ')') {
        char *end;
        long count = 1, width;
        char kind;
        p += strspn(p, " \t,");
        if (*p >= '0' && *p <= '9') {
            count = strtol(p, &end, 10);
            p = end;
        }
        kind = (char)(*p | 32);
        if (!*p || !strchr("iefdgax", kind)) return -1;
        p++;
        if (kind == 'x') {
            if (count < 1 || count > FL_COLUMN_WIDTH) return -1;
            at += (int)count;
            continue;
        }
        if (*p < '1' || *p > '9') return -1;
        width = strtol(p, &end, 10);
        p = end + strspn(end, ".0123456789eE");
        if (count < 1 || count > FL_COLUMNS - f->n || width >= FL_COLUMN_WIDTH) return -1;
        mixed |= kind != 'i';
        for (long k = 0; k < count; k++, at += (int)width) {
            f->integers += !mixed;
            f->start[f->n] = at;
            f->width[f->n++] = (int)width;
        }
        p += strspn(p, " \t,");
    }
    return f->n && *p == ')' ? 0 : -1;
}

/* Find the begin and end of column k in a row; returns 0 if the row is too short. */
static int find_column(const fl_columns *f, int k, int32_t len, int32_t *from, int32_t *to)
{
    if (k >= f->n || f->start[k] >= len) return 0;
    *from = f->start[k];
    *to = *from + f->width[k] < len ? *from + f->width[k] : len;
    return 1;
}

const char *fl_columns_text(const fl_columns *f, int k, const char *row, int32_t len,
                            char text[FL_COLUMN_WIDTH])
{
    int32_t from, to;
    if (!find_column(f, k, len, &from, &to)) return "";
    memcpy(text, row + from, (size_t)(to - from));
    text[to - from] = '\0';
    return fl_deck_trim(text);
}

int fl_columns_integer(const fl_columns *f, int k, const char *row, int32_t len, int64_t *x)
{
    enum { DIGITS = 18 };
    int32_t from, to;
    const char *p, *end, *first;
    int minus;
    int64_t n = 0;
    *x = 0;
    if (!find_column(f, k, len, &from, &to)) return 0;
    p = row + from;
    end = row + to;
    while (p < end && fl_bytes_blank(*p)) p++;
    if (p == end) return 0;
    minus = *p == '-';
    p += minus || *p == '+';
    for (first = p; p < end && (unsigned char)(*p - '0') < 10 && p - first < DIGITS; p++)
        n = 10 * n + (*p - '0');
    if (p == first) return -1;
    while (p < end && fl_bytes_blank(*p)) p++;
    *x = minus ? -n : n;
    return p == end ? 0 : -1;
}

int fl_columns_real(const fl_columns *f, int k, char *row, int32_t len, double *x)
{
    char text[FL_COLUMN_WIDTH];
    int32_t from, to;
    double y;
    *x = 0.0;
    if (!find_column(f, k, len, &from, &to)) return 0;
    while (from < to && fl_bytes_blank(row[from])) from++;
    if (from == to) return 0;
    const char next = row[to];
    row[to] = '\0'; /* the next column may follow without a blank */
    const char *end = fl_decimal_read(row + from, &y);
    row[to] = next;
    if (end == row + to && isfinite(y)) {
        *x = y + 0.0; /* -0 becomes 0 */
        return 0;
    }
    return fl_deck_real(fl_columns_text(f, k, row, len, text), x);
}
