/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include "base/array.h"
#include "mesh/merge_cylinders.h"

static const double TOLERANCE = 1e-6; /* tolerance as a share of the diagonal, as in welding */
static const double MAX_BEND =
    1e-3;               /* bend and change of slope at a joint; the tolerance is then applied to the run */
enum { MAX_ENDS = 64 }; /* ends at one point; larger groups are not compared pair by pair */

/* Position of an end of a cone: end 2 c is p0 of cone c, end 2 c + 1 is p1. */
static fl_vec3 end_point(const fl_part *p, int32_t end)
{
    const fl_cone *c = &p->cone[end / 2];
    return end % 2 ? c->p1 : c->p0;
}

static double end_radius(const fl_part *p, int32_t end)
{
    const fl_cone *c = &p->cone[end / 2];
    return end % 2 ? c->r1 : c->r0;
}

typedef struct {
    fl_vec3 x;
    int32_t end;
} cone_end;

static int compare_ends(const void *pa, const void *pb)
{
    const cone_end *a = pa, *b = pb;
    if (a->x.x != b->x.x) return a->x.x < b->x.x ? -1 : 1;
    if (a->x.y != b->x.y) return a->x.y < b->x.y ? -1 : 1;
    if (a->x.z != b->x.z) return a->x.z < b->x.z ? -1 : 1;
    return a->end < b->end ? -1 : a->end > b->end;
}

/* True if the cone of end b continues that of end a. */
static int continues(const fl_part *p, int32_t a, int32_t b, double tol)
{
    const fl_vec3 da = v3_sub(end_point(p, a ^ 1), end_point(p, a)),
                  db = v3_sub(end_point(p, b ^ 1), end_point(p, b));
    const double la = v3_norm(da), lb = v3_norm(db);
    const double slope =
        (end_radius(p, a ^ 1) - end_radius(p, a)) / la + (end_radius(p, b ^ 1) - end_radius(p, b)) / lb;
    if (a / 2 == b / 2 || !(la > 0.0 && lb > 0.0)) return 0;
    return fabs(end_radius(p, a) - end_radius(p, b)) <= tol && fabs(slope) <= MAX_BEND &&
           v3_norm(v3_add(v3_scale(1.0 / la, da), v3_scale(1.0 / lb, db))) <= MAX_BEND;
}

/* Among n ends at one point, link those that continue each other and no third one. */
static void link_ends(const fl_part *p, const cone_end *t, int32_t n, double tol, int32_t *link)
{
    int32_t only[MAX_ENDS];
    if (n < 2 || n > MAX_ENDS) return;
    for (int32_t i = 0; i < n; i++) {
        only[i] = -1;
        for (int32_t j = 0; j < n; j++)
            if (continues(p, t[i].end, t[j].end, tol)) only[i] = only[i] == -1 ? j : -2;
    }
    for (int32_t i = 0; i < n; i++)
        if (only[i] >= 0 && only[only[i]] == i) link[t[i].end] = t[only[i]].end;
}

/* Set link[end] to the end that continues it, -1 for none. */
static int link_cones(const fl_part *p, double tol, int32_t *link, fl_err *err)
{
    const int32_t n = 2 * p->nc;
    cone_end *t = fl_alloc(n, sizeof *t, err);
    if (!t) return -1;
    for (int32_t k = 0; k < n; k++) {
        t[k] = (cone_end){v3_add(end_point(p, k), v3(0, 0, 0)), k}; /* -0 becomes 0 */
        link[k] = -1;
    }
    qsort(t, (size_t)n, sizeof *t, compare_ends);
    for (int32_t i = 0, j; i < n; i = j) {
        for (j = i + 1; j < n && t[i].x.x == t[j].x.x && t[i].x.y == t[j].x.y && t[i].x.z == t[j].x.z; j++) {}
        link_ends(p, t + i, j - i, tol, link);
    }
    free(t);
    return 0;
}

/* A run of cones: end[k] is the end at which cone k begins; the run continues at its other end. */
typedef struct {
    int32_t *end;
    int32_t n;
} run;

/* The cone from the beginning of cone a of a run to the end of cone b. */
static fl_cone merged_cone(const fl_part *p, const run *r, int32_t a, int32_t b)
{
    const int32_t from = r->end[a], to = r->end[b] ^ 1;
    return (fl_cone){end_point(p, from), end_point(p, to), end_radius(p, from), end_radius(p, to)};
}

/* Largest deviation of the inner ends from that cone; *worst is the index of the cone behind the worst one.
 */
static double max_deviation(const fl_part *p, const run *r, int32_t a, int32_t b, int32_t *worst)
{
    const fl_cone c = merged_cone(p, r, a, b);
    const fl_vec3 d = v3_sub(c.p1, c.p0);
    const double l2 = v3_norm2(d);
    double most = 0.0;
    *worst = a + 1;
    for (int32_t k = a + 1; k <= b; k++) {
        const fl_vec3 x = v3_sub(end_point(p, r->end[k]), c.p0);
        const double s = l2 > 0.0 ? v3_dot(x, d) / l2 : 0.0;
        const double aside = v3_norm(v3_madd(x, -s, d));
        const double wide = fabs(end_radius(p, r->end[k]) - (c.r0 + s * (c.r1 - c.r0)));
        if (fmax(aside, wide) > most) {
            most = fmax(aside, wide);
            *worst = k;
        }
    }
    return most;
}

/* Write the merged cones of a run to out[*n ..]; last[] is scratch of the length of the run.  Source: Douglas
 * & Peucker, Cartographica 10 (1973) 112. */
static void write_run(const fl_part *p, const run *r, double tol, int32_t *last, fl_cone *out, int32_t *n,
                      fl_merged_cylinders *did)
{
    int32_t a = 0, top = 0;
    last[top++] = r->n - 1;
    while (top > 0) {
        const int32_t b = last[top - 1];
        int32_t worst = b;
        const double off = b > a ? max_deviation(p, r, a, b, &worst) : 0.0;
        if (off > tol) {
            last[top++] = worst - 1;
            continue;
        }
        out[(*n)++] = b > a ? merged_cone(p, r, a, b) : p->cone[r->end[a] / 2];
        if (b > a) {
            did->merged += b - a + 1;
            did->remaining++;
            did->max_error = fmax(did->max_error, off);
        }
        a = b + 1;
        top--;
    }
}

static double box_diagonal(const fl_part *p)
{
    fl_aabb b = aabb_empty();
    for (int32_t k = 0; k < p->nc; k++) b = aabb_join(b, fl_cone_aabb(&p->cone[k]));
    return v3_norm(v3_sub(b.hi, b.lo));
}

int fl_part_merge_cylinders(fl_part *p, fl_merged_cylinders *did, fl_err *err)
{
    const int32_t n = p->nc;
    const double tol = n > 1 ? TOLERANCE * box_diagonal(p) : 0.0;
    int32_t *link, *last = NULL, written = 0;
    uint8_t *visited = NULL;
    fl_cone *out = NULL;
    run r = {0};
    int rc = -1;
    if (n < 2) return 0;
    link = fl_alloc(2 * (int64_t)n, sizeof *link, err);
    if (!link || !(r.end = fl_alloc(n, sizeof *r.end, err)) || !(last = fl_alloc(n, sizeof *last, err)) ||
        !(visited = fl_alloc(n, 1, err)) || !(out = fl_alloc(n, sizeof *out, err)) ||
        link_cones(p, tol, link, err))
        goto done;
    for (int32_t k = 0; k < n; k++) {
        int32_t at = link[2 * k] < 0 ? 2 * k : link[2 * k + 1] < 0 ? 2 * k + 1 : -1;
        if (visited[k] || at < 0) continue; /* runs begin at either end */
        for (r.n = 0; at >= 0; at = link[at ^ 1]) {
            visited[at / 2] = 1;
            r.end[r.n++] = at;
        }
        write_run(p, &r, tol, last, out, &written, did);
    }
    for (int32_t k = 0; k < n; k++)
        if (!visited[k]) out[written++] = p->cone[k]; /* a closed ring of gentle bends */
    free(p->cone);
    p->cone = out;
    p->nc = written;
    p->c_cap = n;
    out = NULL;
    rc = 0;
done:
    free(link);
    free(r.end);
    free(last);
    free(visited);
    free(out);
    return rc;
}
