/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include "base/array.h"
#include "mesh/merge_cylinders.h"

static const double SHARE = 1e-6;  /* of the diagonal: as in welding */
static const double GENTLE = 1e-3; /* bend and change of slope at a joint: then the whole run is looked at */
enum { CROWD = 64 };               /* ends in one place: more are not looked at, pair by pair */

/* One end of a cone: 2 cone for p0, 2 cone + 1 for p1. */
static fl_vec3 place(const fl_part *p, int32_t end)
{
    const fl_cone *c = &p->cone[end / 2];
    return end % 2 ? c->p1 : c->p0;
}

static double radius(const fl_part *p, int32_t end)
{
    const fl_cone *c = &p->cone[end / 2];
    return end % 2 ? c->r1 : c->r0;
}

typedef struct {
    fl_vec3 x;
    int32_t end;
} tip;

static int by_place(const void *pa, const void *pb)
{
    const tip *a = pa, *b = pb;
    if (a->x.x != b->x.x) return a->x.x < b->x.x ? -1 : 1;
    if (a->x.y != b->x.y) return a->x.y < b->x.y ? -1 : 1;
    if (a->x.z != b->x.z) return a->x.z < b->x.z ? -1 : 1;
    return a->end < b->end ? -1 : a->end > b->end;
}

/* Does the cone of end b go on from that of end a? */
static int goes_on(const fl_part *p, int32_t a, int32_t b, double tol)
{
    const fl_vec3 da = v3_sub(place(p, a ^ 1), place(p, a)), db = v3_sub(place(p, b ^ 1), place(p, b));
    const double la = v3_norm(da), lb = v3_norm(db);
    const double slope = (radius(p, a ^ 1) - radius(p, a)) / la + (radius(p, b ^ 1) - radius(p, b)) / lb;
    if (a / 2 == b / 2 || !(la > 0.0 && lb > 0.0)) return 0;
    return fabs(radius(p, a) - radius(p, b)) <= tol && fabs(slope) <= GENTLE &&
           v3_norm(v3_add(v3_scale(1.0 / la, da), v3_scale(1.0 / lb, db))) <= GENTLE;
}

/* Of n tips in one place link those that go on from each other alone. */
static void link_tips(const fl_part *p, const tip *t, int32_t n, double tol, int32_t *link)
{
    int32_t only[CROWD];
    if (n < 2 || n > CROWD) return;
    for (int32_t i = 0; i < n; i++) {
        only[i] = -1;
        for (int32_t j = 0; j < n; j++)
            if (goes_on(p, t[i].end, t[j].end, tol)) only[i] = only[i] == -1 ? j : -2;
    }
    for (int32_t i = 0; i < n; i++)
        if (only[i] >= 0 && only[only[i]] == i) link[t[i].end] = t[only[i]].end;
}

/* link[end] is the end that goes on from it, -1 for none. */
static int link_all(const fl_part *p, double tol, int32_t *link, fl_err *err)
{
    const int32_t n = 2 * p->nc;
    tip *t = fl_alloc(n, sizeof *t, err);
    if (!t) return -1;
    for (int32_t k = 0; k < n; k++) {
        t[k] = (tip){v3_add(place(p, k), v3(0, 0, 0)), k}; /* -0 is 0 */
        link[k] = -1;
    }
    qsort(t, (size_t)n, sizeof *t, by_place);
    for (int32_t i = 0, j; i < n; i = j) {
        for (j = i + 1; j < n && t[i].x.x == t[j].x.x && t[i].x.y == t[j].x.y && t[i].x.z == t[j].x.z; j++) {}
        link_tips(p, t + i, j - i, tol, link);
    }
    free(t);
    return 0;
}

/* A run of cones: end[k] is where cone k of it begins; the end across is where it goes on. */
typedef struct {
    int32_t *end;
    int32_t n;
} run;

/* The cone from the beginning of cone a of a run to the end of cone b. */
static fl_cone whole(const fl_part *p, const run *r, int32_t a, int32_t b)
{
    const int32_t from = r->end[a], to = r->end[b] ^ 1;
    return (fl_cone){place(p, from), place(p, to), radius(p, from), radius(p, to)};
}

/* How far the ends within stray from that cone; *worst becomes the cone behind the one that does most. */
static double strays(const fl_part *p, const run *r, int32_t a, int32_t b, int32_t *worst)
{
    const fl_cone c = whole(p, r, a, b);
    const fl_vec3 d = v3_sub(c.p1, c.p0);
    const double l2 = v3_norm2(d);
    double most = 0.0;
    *worst = a + 1;
    for (int32_t k = a + 1; k <= b; k++) {
        const fl_vec3 x = v3_sub(place(p, r->end[k]), c.p0);
        const double s = l2 > 0.0 ? v3_dot(x, d) / l2 : 0.0;
        const double aside = v3_norm(v3_madd(x, -s, d));
        const double wide = fabs(radius(p, r->end[k]) - (c.r0 + s * (c.r1 - c.r0)));
        if (fmax(aside, wide) > most) {
            most = fmax(aside, wide);
            *worst = k;
        }
    }
    return most;
}

/* Put the cones of a run to out[*n ..]; last[] is scratch of the length of the run.  Source: Douglas &
 * Peucker, Cartographica 10 (1973) 112. */
static void put_run(const fl_part *p, const run *r, double tol, int32_t *last, fl_cone *out, int32_t *n,
                    fl_merged_cylinders *did)
{
    int32_t a = 0, top = 0;
    last[top++] = r->n - 1;
    while (top > 0) {
        const int32_t b = last[top - 1];
        int32_t worst = b;
        const double off = b > a ? strays(p, r, a, b, &worst) : 0.0;
        if (off > tol) {
            last[top++] = worst - 1;
            continue;
        }
        out[(*n)++] = b > a ? whole(p, r, a, b) : p->cone[r->end[a] / 2];
        if (b > a) {
            did->merged += b - a + 1;
            did->remaining++;
            did->max_error = fmax(did->max_error, off);
        }
        a = b + 1;
        top--;
    }
}

static double diagonal(const fl_part *p)
{
    fl_aabb b = aabb_empty();
    for (int32_t k = 0; k < p->nc; k++) b = aabb_join(b, fl_cone_aabb(&p->cone[k]));
    return v3_norm(v3_sub(b.hi, b.lo));
}

int fl_part_merge_cylinders(fl_part *p, fl_merged_cylinders *did, fl_err *err)
{
    const int32_t n = p->nc;
    const double tol = n > 1 ? SHARE * diagonal(p) : 0.0;
    int32_t *link, *last = NULL, put = 0;
    uint8_t *met = NULL;
    fl_cone *out = NULL;
    run r = {0};
    int rc = -1;
    if (n < 2) return 0;
    link = fl_alloc(2 * (int64_t)n, sizeof *link, err);
    if (!link || !(r.end = fl_alloc(n, sizeof *r.end, err)) || !(last = fl_alloc(n, sizeof *last, err)) ||
        !(met = fl_alloc(n, 1, err)) || !(out = fl_alloc(n, sizeof *out, err)) || link_all(p, tol, link, err))
        goto done;
    for (int32_t k = 0; k < n; k++) {
        int32_t at = link[2 * k] < 0 ? 2 * k : link[2 * k + 1] < 0 ? 2 * k + 1 : -1;
        if (met[k] || at < 0) continue; /* a run begins at either end */
        for (r.n = 0; at >= 0; at = link[at ^ 1]) {
            met[at / 2] = 1;
            r.end[r.n++] = at;
        }
        put_run(p, &r, tol, last, out, &put, did);
    }
    for (int32_t k = 0; k < n; k++)
        if (!met[k]) out[put++] = p->cone[k]; /* a ring of gentle bends */
    free(p->cone);
    p->cone = out;
    p->nc = put;
    p->c_cap = n;
    out = NULL;
    rc = 0;
done:
    free(link);
    free(r.end);
    free(last);
    free(met);
    free(out);
    return rc;
}
