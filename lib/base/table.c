/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "base/number_text.h"
#include "base/table.h"

/* Reads "#start T" [s] above the column names: the start of the first interval, if it is not 0. */
static int read_start(fl_table *t, fl_err *err)
{
    const char *word = t->text.line + strlen("#start");
    word += strspn(word, " \t");
    if (fl_number_f64(word, &t->start))
        return fl_text_fail(&t->text, err, "start is \"%.40s\", a finite number is expected", word);
    t->has_start = 1;
    return 0;
}

static int compare_names(const void *a, const void *b)
{
    return strcmp(*(char *const *)a, *(char *const *)b);
}

static int check_names(fl_table *t, fl_err *err)
{
    char **sorted = fl_alloc(t->n, sizeof *sorted, err);
    int rc = sorted ? 0 : -1;
    if (rc) return rc;
    memcpy(sorted, t->name, (size_t)t->n * sizeof *sorted);
    qsort(sorted, (size_t)t->n, sizeof *sorted, compare_names);
    for (int32_t k = 0; k < t->n && rc == 0; k++) {
        if (sorted[k][0] == '\0') rc = fl_text_fail(&t->text, err, "a column has a unit and no name");
        else if (k && strcmp(sorted[k], sorted[k - 1]) == 0)
            rc = fl_text_fail(&t->text, err, "column %.40s appears twice", sorted[k]);
    }
    free(sorted);
    return rc;
}

/* Copies the column names, which the next row would overwrite, and splits "fx[N]" into "fx" and "N". */
static int store_names(fl_table *t, fl_err *err)
{
    int64_t bytes = 0;
    char *to;
    if (t->text.n > FL_TABLE_COLUMNS_MAX)
        return fl_text_fail(&t->text, err, "%d columns, at most %d are expected", t->text.n,
                            FL_TABLE_COLUMNS_MAX);
    t->n = t->text.n;
    for (int32_t k = 0; k < t->n; k++) bytes += (int64_t)strlen(t->text.field[k]) + 1;
    t->header = to = fl_alloc(bytes, 1, err);
    t->name = to ? fl_alloc(t->n, sizeof *t->name, err) : NULL;
    t->unit = t->name ? fl_alloc(t->n, sizeof *t->unit, err) : NULL;
    if (!t->unit) return -1;
    for (int32_t k = 0; k < t->n; k++) {
        const size_t len = strlen(t->text.field[k]);
        memcpy(to, t->text.field[k], len + 1);
        t->name[k] = to;
        t->unit[k] = to + len;
        char *open = strchr(to, '[');
        if (open && to[len - 1] == ']') {
            *open = to[len - 1] = '\0';
            t->unit[k] = open + 1;
        }
        to += len + 1;
    }
    return check_names(t, err);
}

int fl_table_open(fl_table *t, const char *path, const char *kind, int newest, fl_err *err)
{
    int more = 0, cut = 0;
    *t = (fl_table){0};
    if (fl_text_open(&t->text, path, err) || fl_text_magic(&t->text, kind, newest, err)) goto fail;
    while (!cut && (more = fl_text_line(&t->text, err)) > 0) {
        if (strncmp(t->text.line, "#start", 6) == 0 && strspn(t->text.line + 6, " \t") > 0) {
            if (read_start(t, err)) goto fail;
        }
        cut = fl_text_split(&t->text, err);
        if (cut < 0) goto fail;
    }
    if (more < 0) goto fail;
    if (!cut) {
        fl_text_fail(&t->text, err, "the %s table ends here, a row of column names is expected",
                     t->text.kind);
        goto fail;
    }
    if (store_names(t, err)) goto fail;
    return 0;
fail:
    fl_table_close(t);
    return -1;
}

int32_t fl_table_column(const fl_table *t, const char *name)
{
    const char *open = strchr(name, '[');
    for (int32_t k = 0; k < t->n; k++)
        if (strcmp(t->name[k], name) == 0) return k;
    for (int32_t k = 0; open && k < t->n; k++) {
        const size_t len = strlen(t->name[k]), unit = strlen(t->unit[k]);
        if (strncmp(name, t->name[k], len) != 0 || name + len != open) continue;
        if (strncmp(open + 1, t->unit[k], unit) == 0 && strcmp(open + 1 + unit, "]") == 0) return k;
    }
    return -1;
}

int fl_table_require(const fl_table *t, const char *name, int32_t *col, fl_err *err)
{
    *col = fl_table_column(t, name);
    if (*col >= 0) return 0;
    return fl_text_fail(&t->text, err, "no column %.60s in this %s table, the nearest is %.60s", name,
                        t->text.kind, fl_text_nearest(name, (const char *const *)t->name, t->n));
}

int fl_table_row(fl_table *t, fl_err *err)
{
    const int more = fl_text_row(&t->text, err);
    if (more > 0 && t->text.n != t->n)
        return fl_text_fail(&t->text, err, "%d fields, expected %d, one for each column", t->text.n, t->n);
    return more;
}

const char *fl_table_word(const fl_table *t, int32_t col) { return t->text.field[col]; }

int fl_table_f64(const fl_table *t, int32_t col, double *x, fl_err *err)
{
    const char *word = t->text.field[col];
    if (fl_number_f64(word, x) == 0) return 0;
    return fl_text_fail(&t->text, err, "%.60s is \"%.40s\", a finite number is expected", t->name[col], word);
}

int fl_table_f64_bounded(const fl_table *t, int32_t col, double most, double *x, fl_err *err)
{
    if (fl_table_f64(t, col, x, err)) return -1;
    if (fabs(*x) <= most) return 0;
    return fl_text_fail(&t->text, err, "%s is %g, at most %g is expected", t->name[col], *x, most);
}

void fl_table_close(fl_table *t)
{
    fl_text_close(&t->text);
    free(t->header);
    free(t->name);
    free(t->unit);
    *t = (fl_table){0};
}
