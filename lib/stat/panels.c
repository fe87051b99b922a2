/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "stat/panels.h"
#include "stat/record.h"

enum { T, PANEL, X, Y, Z, AREA, FX, FY, FZ, COLUMNS };
static const char *const NAME[COLUMNS] = {"t", "panel", "x", "y", "z", "area", "fx", "fy", "fz"};

int fl_panels_open(fl_panels *p, const char *path, fl_err *err)
{
    *p = (fl_panels){0};
    if (fl_table_open(&p->table, path, "panels", 1, err)) return -1;
    for (int k = 0; k < COLUMNS; k++)
        if (fl_table_require(&p->table, NAME[k], &p->col[k], err)) return -1;
    p->t = p->table.start;
    return 0;
}

static int add_panel(fl_panels *p, const char *name, const double *x, fl_err *err)
{
    if (fl_grow(&p->panel, &p->cap, (int64_t)p->n + 1, sizeof *p->panel, err)) return -1;
    fl_panel *q = &p->panel[p->n];
    *q = (fl_panel){.name = fl_alloc_text(name, err), .middle = v3(x[X], x[Y], x[Z]), .area = x[AREA]};
    if (!q->name) return -1;
    p->n++;
    return 0;
}

/* Read the row of panel k of this time. */
static int read_panel(fl_panels *p, int32_t k, fl_err *err)
{
    const char *name = fl_table_word(&p->table, p->col[PANEL]);
    double x[COLUMNS];
    for (int c = X; c < COLUMNS; c++)
        if (fl_table_f64_bounded(&p->table, p->col[c], FL_RECORD_LARGEST_VALUE, &x[c], err)) return -1;
    if (!(x[AREA] > 0.0))
        return fl_text_fail(&p->table.text, err, "panel %.40s has the area %g m2, expected above 0", name,
                            x[AREA]);
    if (p->times == 0 && add_panel(p, name, x, err)) return -1;
    if (k == p->n || strcmp(name, p->panel[k].name) != 0)
        return fl_text_fail(&p->table.text, err, "panel %.40s comes here, expected %.40s", name,
                            k < p->n ? p->panel[k].name : "a later time");
    p->panel[k].force = v3(x[FX], x[FY], x[FZ]);
    return 0;
}

int fl_panels_next(fl_panels *p, fl_err *err)
{
    int32_t k = 0;
    double t = p->next;
    for (;; p->pending = 0) {
        if (!p->pending) {
            const int more = fl_table_row(&p->table, err);
            if (more < 0) return -1;
            if (more == 0) break;
            if (fl_table_f64_bounded(&p->table, p->col[T], FL_RECORD_LARGEST_VALUE, &t, err)) return -1;
        }
        if (k && t != p->t) {
            p->pending = 1;
            p->next = t;
            break;
        }
        if (k == 0) {
            if (!(t > p->t))
                return fl_text_fail(&p->table.text, err, "time %.10g s does not follow %.10g s", t, p->t);
            p->edge[0] = p->t;
            p->edge[1] = p->t = t;
        }
        if (read_panel(p, k++, err)) return -1;
    }
    if (k == 0 && p->times == 0)
        return fl_fail(err, FL_INPUT, "%s: this panels table has no rows", fl_in_name(p->table.text.in));
    if (k == 0) return 0;
    if (k < p->n)
        return fl_text_fail(&p->table.text, err, "panel %.40s has no row at %.10g s", p->panel[k].name, p->t);
    p->times++;
    return 1;
}

void fl_panels_close(fl_panels *p)
{
    for (int32_t k = 0; k < p->n; k++) free(p->panel[k].name);
    free(p->panel);
    fl_table_close(&p->table);
    *p = (fl_panels){0};
}
