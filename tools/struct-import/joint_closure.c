/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdlib.h>
#include "base/array.h"
#include "joint_closure.h"

static int is_open(const struct cleanup *m) { return m->quality.triangles > 0 && m->quality.open > 0; }

/* Collect the triangles of all open parts, in the order of the parts. */
static int gather_open(fl_part *all, const fl_surface *s, const struct cleanup *m, fl_err *err)
{
    for (int32_t i = 0; i < s->n; i++) {
        const fl_part *p = &s->part[i];
        const int32_t first = all->nv;
        if (!is_open(&m[i])) continue;
        for (int32_t v = 0; v < p->nv; v++)
            if (fl_surface_vertex(all, p->v[v], err)) return -1;
        for (int32_t t = 0; t < p->nt; t++) {
            const int32_t *v = p->t[t].v;
            if (fl_surface_triangle(all, first + v[0], first + v[1], first + v[2], err)) return -1;
        }
    }
    return 0;
}

/* Reverse the triangles of the parts that the joint orientation reversed: their second vertex is then the
 * third. */
static int reverse_triangles(fl_surface *s, struct cleanup *m, const fl_part *all, const int32_t *second,
                             fl_err *err)
{
    int32_t at = 0;
    for (int32_t i = 0; i < s->n; i++) {
        fl_part *p = &s->part[i];
        int32_t turned = 0;
        if (!is_open(&m[i])) continue;
        for (int32_t t = 0; t < p->nt; t++, at++) {
            int32_t *v = p->t[t].v;
            const int32_t keep = v[1];
            if (all->t[at].v[1] == second[at]) continue;
            v[1] = v[2];
            v[2] = keep;
            turned++;
        }
        m[i].closes_jointly = 1;
        m[i].orient.triangles += turned;
        if (turned && fl_part_measure(p, &m[i].quality, err)) return -1;
    }
    return 0;
}

int close_jointly(fl_surface *s, struct cleanup *m, fl_err *err)
{
    fl_part all = {0};
    fl_weld w;
    fl_orient_counts o;
    fl_mesh_quality q;
    int32_t *second = NULL, parts = 0, triangles;
    int rc = -1;
    for (int32_t i = 0; i < s->n; i++) parts += is_open(&m[i]);
    if (parts < 2) return 0;
    if (gather_open(&all, s, m, err) || !(second = fl_alloc(all.nt, sizeof *second, err))) goto done;
    triangles = all.nt;
    if (fl_part_weld(&all, -1.0, &w, err)) goto done;
    rc = 0;
    if (all.nt < triangles)
        goto done; /* some triangles are smaller than the tolerance and cannot be matched */
    for (int32_t t = 0; t < all.nt; t++) second[t] = all.t[t].v[1];
    rc = fl_part_orient(&all, &q, &o, err) || fl_part_measure(&all, &q, err) ? -1 : 0;
    if (rc == 0 && q.closed && q.open == 0 && q.branched == 0)
        rc = reverse_triangles(s, m, &all, second, err);
done:
    fl_part_free(&all);
    free(second);
    return rc;
}
