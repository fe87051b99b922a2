/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include "base/array.h"
#include "base/union_find.h"
#include "geom/enclosed_volume.h"
#include "geom/outer_skin.h"
#include "geom/inner_walls.h"
#include "geom/weld.h"

static int32_t apex(const fl_part *p, const fl_half_edge *s) { return p->t[s->t].v[(s->k + 2) % 3]; }

/* twin: of each triangle the one that faces it from behind, on the same corners; -1 for none */
static void find_twins(const fl_part *p, const fl_edges *e, int32_t *twin)
{
    for (int32_t t = 0; t < p->nt; t++) twin[t] = -1;
    for (int32_t v = 0; v < p->nv; v++)
        for (int64_t from = e->first[v], to; from < e->first[v + 1]; from = to) {
            const fl_half_edge *s = e->side;
            to = fl_edge_end(e, v, from);
            for (int64_t i = from; i < to; i++)
                for (int64_t j = i + 1; j < to && twin[s[i].t] < 0; j++)
                    if (s[i].up != s[j].up && twin[s[j].t] < 0 && apex(p, &s[i]) == apex(p, &s[j]))
                        twin[s[i].t] = s[j].t, twin[s[j].t] = s[i].t;
        }
}

/* Of what hangs together of them, under its lowest triangle: an edge of its rim has fewer than four sides; an
 * edge has some without a twin; an edge of its rim is free. */
enum { SHEET = 1, STANDS = 2, FREE = 4 };

/* What hangs together of them, in set, and what that is. */
static void find_sheets(const fl_part *p, const fl_edges *e, const int32_t *twin, int32_t *set, uint8_t *is)
{
    for (int32_t v = 0; v < p->nv; v++)
        for (int64_t from = e->first[v], to; from < e->first[v + 1]; from = to) {
            int64_t last = -1, twins = 0;
            to = fl_edge_end(e, v, from);
            for (int64_t k = from; k < to; k++) {
                const int32_t t = e->side[k].t;
                if (twin[t] < 0) continue;
                if (last >= 0) fl_union_find_join(set, e->side[last].t, t);
                last = k, twins++;
            }
            if (last >= 0 && to - from < 4) is[e->side[last].t] |= SHEET;
            if (last >= 0 && to - from == twins && twins < 4) is[e->side[last].t] |= FREE;
            if (last >= 0 && to - from > twins) is[e->side[last].t] |= STANDS;
        }
    for (int32_t t = 0; t < p->nt; t++) is[fl_union_find_root(set, t)] |= is[t];
}

/* Triangles with a twin, of what is all of one and nothing of the other. */
static int twins_of(const fl_part *p, const fl_edges *e, unsigned of, unsigned nothing_of, uint8_t *wall,
                    fl_err *err)
{
    int32_t *twin = fl_alloc(p->nt, sizeof *twin, err), *set = twin ? fl_union_find_make(p->nt, err) : NULL;
    uint8_t *is = set ? fl_alloc(p->nt, 1, err) : NULL;
    if (is) {
        find_twins(p, e, twin);
        find_sheets(p, e, twin, set, is);
        for (int32_t t = 0; t < p->nt; t++) {
            const unsigned kind = is[fl_union_find_root(set, t)];
            wall[t] = twin[t] >= 0 && (kind & of) == of && !(kind & nothing_of);
        }
    }
    free(twin), free(set);
    free(is);
    return is ? 0 : -1;
}

static int double_walls(const fl_part *p, const fl_edges *e, uint8_t *wall, fl_err *err)
{
    return twins_of(p, e, 0, SHEET, wall, err);
}

/* Of triangles on the same corners that look the same way, all but the first. */
static int copies(const fl_part *p, const fl_edges *e, uint8_t *wall, fl_err *err)
{
    (void)err;
    for (int32_t v = 0; v < p->nv; v++)
        for (int64_t from = e->first[v], to; from < e->first[v + 1]; from = to) {
            const fl_half_edge *s = e->side;
            to = fl_edge_end(e, v, from);
            for (int64_t i = from; i < to; i++)
                for (int64_t j = i + 1; j < to && !wall[s[i].t]; j++)
                    wall[s[j].t] |= s[i].up == s[j].up && apex(p, &s[i]) == apex(p, &s[j]);
        }
    return 0;
}

/* Sheets without a rim that lie inside what has no twins: the walls of a cavity that another body fills. */
static int mark_filled(const fl_part *p, const int32_t *twin, int32_t *set, const uint8_t *is, uint8_t *wall,
                       fl_err *err)
{
    fl_part rest = {.nv = p->nv, .v = p->v};
    int8_t *inside = fl_alloc(p->nt, 1, err); /* of a set, under its lowest triangle: 1 outside, 2 inside */
    rest.t = inside ? fl_alloc(p->nt, sizeof *rest.t, err) : NULL;
    for (int32_t t = 0; rest.t && t < p->nt; t++)
        if (twin[t] < 0) rest.t[rest.nt++] = p->t[t];
    for (int32_t t = 0; rest.t && t < p->nt; t++) {
        const int32_t root = fl_union_find_root(set, t);
        if (twin[t] < 0 || is[root]) continue;
        if (!inside[root]) inside[root] = fabs(fl_part_winding(&rest, p->v[p->t[t].v[0]])) > 0.5 ? 2 : 1;
        wall[t] = inside[root] == 2;
    }
    const int rc = rest.t ? 0 : -1;
    free(inside);
    free(rest.t);
    return rc;
}

static int contact_walls(const fl_part *p, const fl_edges *e, uint8_t *wall, fl_err *err)
{
    int32_t *twin = fl_alloc(p->nt, sizeof *twin, err), *set = twin ? fl_union_find_make(p->nt, err) : NULL;
    uint8_t *is = set ? fl_alloc(p->nt, 1, err) : NULL;
    int rc = -1;
    if (is) {
        find_twins(p, e, twin);
        find_sheets(p, e, twin, set, is);
        for (int32_t t = 0; t < p->nt; t++)
            wall[t] = twin[t] >= 0 && is[fl_union_find_root(set, t)] == STANDS;
        rc = mark_filled(p, twin, set, is, wall, err);
    }
    free(twin);
    free(set);
    free(is);
    return rc;
}

static int sheets(const fl_part *p, const fl_edges *e, uint8_t *wall, fl_err *err)
{
    return twins_of(p, e, SHEET | FREE, STANDS, wall, err);
}

static int fins(const fl_part *p, const fl_edges *e, uint8_t *wall, fl_err *err)
{
    return twins_of(p, e, FREE | STANDS, 0, wall, err);
}

static int single_walls(const fl_part *p, const fl_edges *e, uint8_t *wall, fl_err *err)
{
    if (fl_part_outer_sides(p, e, wall, err)) return -1;
    for (int32_t t = 0; t < p->nt; t++) wall[t] = wall[t] == FL_OUTER_NONE;
    return 0;
}

/* One kind of them. */
static int drop(fl_part *p, int (*find)(const fl_part *, const fl_edges *, uint8_t *, fl_err *),
                int32_t *gone, fl_err *err)
{
    fl_edges e = {0};
    uint8_t *wall = fl_alloc(p->nt, 1, err);
    const int rc = !wall || fl_edges_make(&e, p, err) || find(p, &e, wall, err) ? -1 : 0;
    int32_t kept = 0;
    for (int32_t t = 0; rc == 0 && t < p->nt; t++)
        if (!wall[t]) p->t[kept++] = p->t[t];
    if (rc == 0) *gone += p->nt - kept, p->nt = kept;
    fl_edges_free(&e);
    free(wall);
    return rc;
}

int fl_part_drop_inner_walls(fl_part *p, int32_t *gone, fl_err *err)
{
    fl_weld w;
    *gone = 0;
    if (drop(p, double_walls, gone, err) || drop(p, single_walls, gone, err)) return -1;
    return *gone ? fl_part_weld(p, 0.0, &w, err) : 0;
}

int fl_part_drop_fins(fl_part *p, int32_t *gone, fl_err *err)
{
    fl_weld w;
    *gone = 0;
    if (drop(p, fins, gone, err)) return -1;
    return *gone ? fl_part_weld(p, 0.0, &w, err) : 0;
}

int fl_part_drop_contact_walls(fl_part *p, int32_t *gone, int32_t *same, fl_err *err)
{
    fl_weld w;
    *gone = *same = 0;
    if (drop(p, copies, same, err) || drop(p, contact_walls, gone, err)) return -1;
    return *gone + *same ? fl_part_weld(p, 0.0, &w, err) : 0;
}

int fl_part_drop_sheets(fl_part *p, int32_t *gone, fl_err *err)
{
    fl_weld w;
    *gone = 0;
    if (drop(p, sheets, gone, err)) return -1;
    return *gone ? fl_part_weld(p, 0.0, &w, err) : 0;
}
