/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "base/table.h"
#include "view/time_rows.h"

/* Room for one more of `size` bytes, doubling; counts of 64 bits. */
static int grow_long(void *array, int64_t *cap, int64_t want, size_t size, fl_err *err)
{
    void *old, *fresh;
    if (want <= *cap) return 0;
    const int64_t n = 2 * *cap > want ? 2 * *cap : want + 1024;
    memcpy(&old, array, sizeof old);
    fresh = fl_alloc(n, size, err);
    if (!fresh) return -1;
    if (*cap) memcpy(fresh, old, (size_t)*cap * size);
    free(old);
    memcpy(array, &fresh, sizeof fresh);
    *cap = n;
    return 0;
}

static int begin_time(fl_time_rows *r, double t, fl_err *err)
{
    if (fl_grow(&r->t, &r->time_cap, (int64_t)r->times + 1, sizeof *r->t, err) ||
        fl_grow(&r->first, &r->first_cap, (int64_t)r->times + 2, sizeof *r->first, err))
        return -1;
    r->t[r->times] = t;
    r->first[r->times++] = r->rows;
    return 0;
}

static int read_field(const fl_table *t, int32_t col, const char *const *words, double *x, fl_err *err)
{
    if (!words) return fl_table_f64(t, col, x, err);
    const char *w = fl_table_word(t, col);
    for (int k = 0; words[k]; k++)
        if (strcmp(w, words[k]) == 0) {
            *x = k;
            return 0;
        }
    return fl_text_fail(&t->text, err, "\"%.40s\" is not a word of column %s", w, t->name[col]);
}

int fl_time_rows_read(fl_time_rows *r, const char *path, const char *kind, const char *const *name,
                      int columns, int word_column, const char *const *words, fl_err *err)
{
    fl_table t = {0};
    int32_t col[FL_TIME_ROWS_COLUMNS];
    int rc = -1, more;
    r->columns = columns;
    if (fl_table_open(&t, path, kind, kind ? 1 : 1000, err)) goto done;
    const int32_t time = fl_table_column(&t, "t");
    for (int k = 0; k < columns; k++) {
        if (fl_table_require(&t, name[k], &col[k], err)) goto done;
        snprintf(r->unit[k], sizeof r->unit[k], "%s", t.unit[col[k]]);
    }
    while ((more = fl_table_row(&t, err)) > 0) {
        double now = NAN;
        int64_t cap = r->cap * columns;
        if (time >= 0 && fl_table_f64(&t, time, &now, err)) goto done;
        if (r->times && time >= 0 && now < r->t[r->times - 1]) {
            fl_text_fail(&t.text, err, "time %g s does not follow %g s", now, r->t[r->times - 1]);
            goto done;
        }
        if ((r->times == 0 || (time >= 0 && now > r->t[r->times - 1])) && begin_time(r, now, err)) goto done;
        if (grow_long(&r->x, &cap, (r->rows + 1) * columns, sizeof *r->x, err)) goto done;
        r->cap = cap / columns;
        for (int k = 0; k < columns; k++)
            if (read_field(&t, col[k], k == word_column ? words : NULL, &r->x[r->rows * columns + k], err))
                goto done;
        r->rows++;
    }
    if (more < 0) goto done;
    if (r->times) r->first[r->times] = r->rows;
    rc = 0;
done:
    fl_table_close(&t);
    return rc;
}

void fl_time_rows_at(const fl_time_rows *r, double t, int64_t *a, int64_t *b)
{
    int32_t lo = 0, hi = r->times;
    *a = *b = 0;
    if (!r->times) return;
    while (lo + 1 < hi) {
        const int32_t mid = (lo + hi) / 2;
        if (r->t[mid] <= t * (1.0 + 1e-12)) lo = mid;
        else hi = mid;
    }
    *a = r->first[lo];
    *b = r->first[lo + 1];
}

int fl_load_curve_read(fl_load_curve *c, const char *path, const char *component, const char *part,
                       fl_err *err)
{
    fl_table t = {0};
    int32_t time, of, fx, fy, fc = -1;
    int rc = -1, more, found = 0;
    const int horizontal = strcmp(component, "fh") == 0;
    double sx = 0.0, sy = 0.0;
    if (fl_table_open(&t, path, "loads", 1, err) || fl_table_require(&t, "t", &time, err) ||
        fl_table_require(&t, "part", &of, err) || fl_table_require(&t, "fx", &fx, err) ||
        fl_table_require(&t, "fy", &fy, err) || (!horizontal && fl_table_require(&t, component, &fc, err)))
        goto done;
    while ((more = fl_table_row(&t, err)) > 0) {
        double now, x, y = 0.0;
        int64_t cap = c->cap;
        if (part && strcmp(fl_table_word(&t, of), part) != 0) continue;
        found = 1;
        if (fl_table_f64(&t, time, &now, err) || fl_table_f64(&t, horizontal ? fx : fc, &x, err) ||
            (horizontal && fl_table_f64(&t, fy, &y, err)))
            goto done;
        if (c->n == 0 || now != c->t[c->n - 1]) {
            int64_t same = cap;
            if (grow_long(&c->t, &same, c->n + 1, sizeof *c->t, err) ||
                grow_long(&c->y, &cap, c->n + 1, sizeof *c->y, err))
                goto done;
            c->cap = cap;
            c->t[c->n++] = now;
            sx = sy = 0.0;
        }
        sx += x;
        sy += y;
        c->y[c->n - 1] = horizontal ? sqrt(sx * sx + sy * sy) : sx;
    }
    if (more < 0) goto done;
    if (part && !found) {
        fl_fail(err, FL_INPUT, "%s: there is no part %s", path, part);
        goto done;
    }
    rc = 0;
done:
    fl_table_close(&t);
    return rc;
}

void fl_time_rows_free(fl_time_rows *r)
{
    free(r->x);
    free(r->first);
    free(r->t);
    *r = (fl_time_rows){0};
}

void fl_load_curve_free(fl_load_curve *c)
{
    free(c->t);
    free(c->y);
    *c = (fl_load_curve){0};
}
