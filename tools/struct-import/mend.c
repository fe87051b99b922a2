/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdlib.h>
#include <string.h>
#include "base/mem.h"
#include "mend.h"

static int to_soup(const fl_part *p, fl_soup *s, fl_err *err)
{
    *s = (fl_soup){.nv = p->nv, .nt = p->nt};
    s->x = fl_alloc(3 * (int64_t)p->nv, sizeof *s->x, err);
    s->t = s->x ? fl_alloc(3 * (int64_t)p->nt, sizeof *s->t, err) : NULL;
    if (!s->t) {
        fl_soup_free(s);
        return -1;
    }
    for (int32_t v = 0; v < p->nv; v++) memcpy(s->x + 3 * (int64_t)v, &p->v[v].x, 3 * sizeof *s->x);
    for (int32_t t = 0; t < p->nt; t++) memcpy(s->t + 3 * (int64_t)t, p->t[t].v, 3 * sizeof *s->t);
    return 0;
}

static int from_soup(fl_part *p, const fl_soup *s, fl_err *err)
{
    p->nv = p->nt = 0;
    for (int32_t v = 0; v < s->nv; v++) {
        const double *x = s->x + 3 * (int64_t)v;
        if (fl_surface_vertex(p, v3(x[0], x[1], x[2]), err)) return -1;
    }
    for (int32_t t = 0; t < s->nt; t++) {
        const int32_t *v = s->t + 3 * (int64_t)t;
        if (fl_surface_triangle(p, v[0], v[1], v[2], err)) return -1;
    }
    return 0;
}

static int repair(fl_part *p, int32_t fill_holes, fl_repair *did, fl_err *err)
{
    fl_soup s = {0};
    fl_weld w;
    int rc = -1;
    if (to_soup(p, &s, err) == 0 && fl_cgal_repair(&s, fill_holes, did, err) == 0 &&
        from_soup(p, &s, err) == 0)
        rc = fl_part_weld(p, 0.0, &w,
                          err); /* joins what was cut along branched edges, and puts the order back */
    fl_soup_free(&s);
    return rc;
}

int mend(fl_part *p, double weld, int32_t fill_holes, int raw, struct mended *m, fl_err *err)
{
    fl_orient again;
    *m = (struct mended){0};
    if (p->nt) {
        if (fl_part_weld(p, weld, &m->weld, err)) return -1;
        if (p->nt == 0 && p->nc == 0)
            return fl_fail(err, FL_INPUT, "part \"%.60s\": each of its triangles is a point or a line",
                           p->name);
        if (!raw) {
            if (fl_part_orient(p, &m->orient, err) || repair(p, fill_holes, &m->repair, err)) return -1;
            /* Where the whole bounds a volume, a cavity looks inward and is right so. */
            if (!m->repair.bounding && fl_part_orient(p, &again, err)) return -1;
        }
        if (p->nt == 0 && p->nc == 0)
            return fl_fail(err, FL_INPUT, "part \"%.60s\": nothing is left after repair", p->name);
    }
    return fl_part_measure(p, &m->left, err);
}
