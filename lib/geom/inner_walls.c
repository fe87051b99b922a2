/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include "base/array.h"
#include "base/union_find.h"
#include "geom/enclosed_volume.h"
#include "geom/outer_skin.h"
#include "geom/inner_walls.h"
#include "geom/weld.h"

static int32_t apex_of(const fl_part *p, const fl_half_edge *s) { return p->t[s->t].v[(s->k + 2) % 3]; }

/* twin[t]: the triangle that faces t from behind, on the same corners; -1 for none */
static void find_twins(const fl_part *p, const fl_edges *e, int32_t *twin)
{
    for (int32_t t = 0; t < p->nt; t++) twin[t] = -1;
    for (int32_t v = 0; v < p->nv; v++)
        for (int64_t from = e->first[v], to; from < e->first[v + 1]; from = to) {
            const fl_half_edge *s = e->side;
            to = fl_edge_end(e, v, from);
            for (int64_t i = from; i < to; i++)
                for (int64_t j = i + 1; j < to && twin[s[i].t] < 0; j++)
                    if (s[i].up != s[j].up && twin[s[j].t] < 0 && apex_of(p, &s[i]) == apex_of(p, &s[j]))
                        twin[s[i].t] = s[j].t, twin[s[j].t] = s[i].t;
        }
}

/* Properties of a connected set of paired triangles, stored at its lowest triangle: a rim edge has fewer than
 * four half-edges; an edge has a triangle without a twin; a rim edge is free. */
enum { RIM_BELOW_FOUR = 1, HAS_UNPAIRED = 2, HAS_FREE_RIM = 4 };

/* Finds the connected sets of paired triangles and their properties. */
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
            if (last >= 0 && to - from < 4) is[e->side[last].t] |= RIM_BELOW_FOUR;
            if (last >= 0 && to - from == twins && twins < 4) is[e->side[last].t] |= HAS_FREE_RIM;
            if (last >= 0 && to - from > twins) is[e->side[last].t] |= HAS_UNPAIRED;
        }
    for (int32_t t = 0; t < p->nt; t++) is[fl_union_find_root(set, t)] |= is[t];
}

/* Marks the paired triangles of sets with all properties `of` and none of `nothing_of`. */
static int mark_twins(const fl_part *p, const fl_edges *e, unsigned of, unsigned nothing_of, uint8_t *wall,
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

static int find_double_walls(const fl_part *p, const fl_edges *e, uint8_t *wall, fl_err *err)
{
    return mark_twins(p, e, 0, RIM_BELOW_FOUR, wall, err);
}

/* Marks, of triangles on the same corners with the same orientation, all but the first. */
static int find_copies(const fl_part *p, const fl_edges *e, uint8_t *wall, fl_err *err)
{
    (void)err;
    for (int32_t v = 0; v < p->nv; v++)
        for (int64_t from = e->first[v], to; from < e->first[v + 1]; from = to) {
            const fl_half_edge *s = e->side;
            to = fl_edge_end(e, v, from);
            for (int64_t i = from; i < to; i++)
                for (int64_t j = i + 1; j < to && !wall[s[i].t]; j++)
                    wall[s[j].t] |= s[i].up == s[j].up && apex_of(p, &s[i]) == apex_of(p, &s[j]);
        }
    return 0;
}

/* Marks sheets without a rim that lie inside the triangles without twins: a cavity that a body fills. */
static int mark_filled(const fl_part *p, const int32_t *twin, int32_t *set, const uint8_t *is, uint8_t *wall,
                       fl_err *err)
{
    fl_part rest = {.nv = p->nv, .v = p->v};
    int8_t *inside = fl_alloc(p->nt, 1, err); /* of a set, at its lowest triangle: 1 outside, 2 inside */
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

static int find_contact_walls(const fl_part *p, const fl_edges *e, uint8_t *wall, fl_err *err)
{
    int32_t *twin = fl_alloc(p->nt, sizeof *twin, err), *set = twin ? fl_union_find_make(p->nt, err) : NULL;
    uint8_t *is = set ? fl_alloc(p->nt, 1, err) : NULL;
    int rc = -1;
    if (is) {
        find_twins(p, e, twin);
        find_sheets(p, e, twin, set, is);
        for (int32_t t = 0; t < p->nt; t++)
            wall[t] = twin[t] >= 0 && is[fl_union_find_root(set, t)] == HAS_UNPAIRED;
        rc = mark_filled(p, twin, set, is, wall, err);
    }
    free(twin);
    free(set);
    free(is);
    return rc;
}

static int find_lone_sheets(const fl_part *p, const fl_edges *e, uint8_t *wall, fl_err *err)
{
    return mark_twins(p, e, RIM_BELOW_FOUR | HAS_FREE_RIM, HAS_UNPAIRED, wall, err);
}

static int find_fins(const fl_part *p, const fl_edges *e, uint8_t *wall, fl_err *err)
{
    return mark_twins(p, e, HAS_FREE_RIM | HAS_UNPAIRED, 0, wall, err);
}

static int find_single_walls(const fl_part *p, const fl_edges *e, uint8_t *wall, fl_err *err)
{
    if (fl_part_outer_sides(p, e, wall, err)) return -1;
    for (int32_t t = 0; t < p->nt; t++) wall[t] = wall[t] == FL_OUTER_NONE;
    return 0;
}

/* Removes the triangles that `find` marks. */
static int drop_marked(fl_part *p, int (*find)(const fl_part *, const fl_edges *, uint8_t *, fl_err *),
                       int32_t *removed, fl_err *err)
{
    fl_edges e = {0};
    uint8_t *wall = fl_alloc(p->nt, 1, err);
    const int rc = !wall || fl_edges_make(&e, p, err) || find(p, &e, wall, err) ? -1 : 0;
    int32_t kept = 0;
    for (int32_t t = 0; rc == 0 && t < p->nt; t++)
        if (!wall[t]) p->t[kept++] = p->t[t];
    if (rc == 0) *removed += p->nt - kept, p->nt = kept;
    fl_edges_free(&e);
    free(wall);
    return rc;
}

int fl_part_drop_inner_walls(fl_part *p, int32_t *removed, fl_err *err)
{
    fl_weld w;
    *removed = 0;
    if (drop_marked(p, find_double_walls, removed, err) || drop_marked(p, find_single_walls, removed, err))
        return -1;
    return *removed ? fl_part_weld(p, 0.0, &w, err) : 0;
}

int fl_part_drop_fins(fl_part *p, int32_t *removed, fl_err *err)
{
    fl_weld w;
    *removed = 0;
    if (drop_marked(p, find_fins, removed, err)) return -1;
    return *removed ? fl_part_weld(p, 0.0, &w, err) : 0;
}

int fl_part_drop_contact_walls(fl_part *p, int32_t *removed, int32_t *same, fl_err *err)
{
    fl_weld w;
    *removed = *same = 0;
    if (drop_marked(p, find_copies, same, err) || drop_marked(p, find_contact_walls, removed, err)) return -1;
    return *removed + *same ? fl_part_weld(p, 0.0, &w, err) : 0;
}

int fl_part_drop_sheets(fl_part *p, int32_t *removed, fl_err *err)
{
    fl_weld w;
    *removed = 0;
    if (drop_marked(p, find_lone_sheets, removed, err)) return -1;
    return *removed ? fl_part_weld(p, 0.0, &w, err) : 0;
}
