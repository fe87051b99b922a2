/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <string.h>
#include "base/array.h"
#include "base/parallel.h"
#include "base/rng.h"
#include "ice/domain.h"
#include "shim/cgal_simple.h"

/* --- rings ---------------------------------------------------------------------------------------------- */

int fl_domain_add(fl_domain *d, int32_t n, const fl_vec2 *v, fl_err *err)
{
    const int32_t at = d->corners;
    const double area = n < 3 ? 0.0 : fl_polygon_area(n, v);
    const int simple = n < 3 ? 1 : fl_cgal_is_simple(n, v, err);
    int backward;
    if (simple < 0) return -1;
    if (n < 3) return fl_fail(err, FL_INPUT, "a ring of %d corners found, three are expected", n);
    if (!simple)
        return fl_fail(err, FL_INPUT,
                       "a ring of %d corners crosses or touches itself, one that does not is expected", n);
    if (!(fabs(area) > 0.0)) return fl_fail(err, FL_INPUT, "a ring without area found");
    if (fl_grow(&d->first, &d->first_cap, (int64_t)d->rings + 2, sizeof *d->first, err) ||
        fl_grow(&d->v, &d->v_cap, (int64_t)at + n, sizeof *d->v, err))
        return -1;
    backward = (area < 0.0) == (d->rings == 0);
    for (int32_t k = 0; k < n; k++) d->v[at + k] = v[backward ? n - 1 - k : k];
    if (d->rings == 0) {
        d->lo = d->hi = v[0];
        for (int32_t k = 1; k < n; k++) {
            d->lo = (fl_vec2){fmin(d->lo.x, v[k].x), fmin(d->lo.y, v[k].y)};
            d->hi = (fl_vec2){fmax(d->hi.x, v[k].x), fmax(d->hi.y, v[k].y)};
        }
    }
    d->first[d->rings] = at;
    d->first[++d->rings] = d->corners = at + n;
    return 0;
}

/* The corner after corner k of ring r. */
static fl_vec2 next_corner(const fl_domain *d, int32_t r, int32_t k)
{
    return d->v[k + 1 < d->first[r + 1] ? k + 1 : d->first[r]];
}

int fl_domain_build(fl_domain *d, fl_err *err)
{
    d->box = fl_alloc(d->corners, sizeof *d->box, err);
    if (!d->box) return -1;
    for (int32_t r = 0; r < d->rings; r++)
        for (int32_t k = d->first[r]; k < d->first[r + 1]; k++) {
            const fl_vec2 p = d->v[k], q = next_corner(d, r, k);
            d->box[k] = aabb_add(aabb_add(aabb_empty(), v3(p.x, p.y, 0.0)), v3(q.x, q.y, 0.0));
        }
    return fl_bvh_build(&d->tree, d->box, d->corners, err);
}

int fl_domain_is_convex(const fl_domain *d)
{
    if (d->rings != 1) return 0;
    for (int32_t k = 0; k < d->corners; k++) {
        const fl_vec2 p = d->v[k], q = next_corner(d, 0, k), r = d->v[(k + 2) % d->corners];
        if (!((q.x - p.x) * (r.y - q.y) - (q.y - p.y) * (r.x - q.x) > 0.0)) return 0;
    }
    return 1;
}

/* --- points --------------------------------------------------------------------------------------------- */

struct near {
    int32_t *k, n, cap;
};

static int by_number(const void *a, const void *b)
{
    const int32_t p = *(const int32_t *)a, q = *(const int32_t *)b;
    return (p > q) - (p < q);
}

static int find_sides(const fl_domain *d, fl_aabb q, struct near *near, fl_err *err)
{
    while ((near->n = fl_bvh_query(&d->tree, d->box, q, near->k, near->cap)) > near->cap)
        if (fl_grow(&near->k, &near->cap, near->n, sizeof *near->k, err)) return -1;
    return 0;
}

/* The side from corner k.  The ring is found by bisection. */
static void side_of(const fl_domain *d, int32_t k, fl_vec2 *p, fl_vec2 *q)
{
    int32_t lo = 0, hi = d->rings;
    while (hi - lo > 1) {
        const int32_t mid = lo + (hi - lo) / 2;
        if (d->first[mid] <= k) lo = mid;
        else hi = mid;
    }
    *p = d->v[k];
    *q = next_corner(d, lo, k);
}

/* Winding number by a ray towards +x: sides that cross it upward count +1, downward -1; a corner belongs
 * to the side above. */
static int find_winding(const fl_domain *d, fl_vec2 at, struct near *near, int *is, fl_err *err)
{
    const fl_aabb ray = {{at.x, at.y, 0.0}, {INFINITY, at.y, 0.0}};
    int turns = 0;
    if (find_sides(d, ray, near, err)) return -1;
    for (int32_t i = 0; i < near->n; i++) {
        fl_vec2 p, q;
        double left;
        side_of(d, near->k[i], &p, &q);
        if ((p.y <= at.y) == (q.y <= at.y)) continue;
        left = (q.x - p.x) * (at.y - p.y) - (q.y - p.y) * (at.x - p.x);
        if (q.y > p.y && left > 0.0) turns++;
        if (q.y < p.y && left < 0.0) turns--;
    }
    *is = turns == 1;
    return 0;
}

int fl_domain_contains(const fl_domain *d, fl_vec2 p, fl_err *err)
{
    struct near near = {0};
    int is = 0;
    const int rc = find_winding(d, p, &near, &is, err);
    free(near.k);
    return rc ? -1 : is;
}

int fl_domain_sites(int32_t n, uint64_t seed, const fl_domain *d, fl_vec2 *site, fl_err *err)
{
    struct near near = {0};
    int rc = -1;
    for (int32_t i = 0; i < n; i++) {
        fl_rng g = fl_rng_of(seed, i, FL_RNG_SITE);
        int is = 0;
        /* a domain of the least share is missed so often with probability exp(-20) */
        for (int32_t k = 0; k < (int32_t)(20.0 / FL_DOMAIN_MIN_SHARE) && !is; k++) {
            site[i].x = fl_rng_in(&g, d->lo.x, d->hi.x);
            site[i].y = fl_rng_in(&g, d->lo.y, d->hi.y);
            if (find_winding(d, site[i], &near, &is, err)) goto done;
        }
        if (is) continue;
        fl_fail(err, FL_INPUT, "less than %g of the box of the outline is left for ice, more is expected",
                FL_DOMAIN_MIN_SHARE);
        goto done;
    }
    rc = 0;
done:
    free(near.k);
    return rc;
}

/* --- cutting -------------------------------------------------------------------------------------------- */

/* Pool of polygons: those still to be cut, and the finished pieces. */
struct pool {
    int32_t n, at, cap, first_cap, v_cap, side_cap;
    int32_t *first; /* [n + 1] */
    fl_vec2 *v;
    fl_polygon_side *side;
};

static int pool_add(struct pool *p, int32_t n, const fl_vec2 *v, const fl_polygon_side *side, fl_err *err)
{
    if (fl_grow(&p->first, &p->first_cap, (int64_t)p->n + 2, sizeof *p->first, err) ||
        fl_grow(&p->v, &p->v_cap, (int64_t)p->at + n, sizeof *p->v, err) ||
        fl_grow(&p->side, &p->side_cap, (int64_t)p->at + n, sizeof *p->side, err))
        return -1;
    memmove(p->v + p->at, v, (size_t)n * sizeof *v);
    memmove(p->side + p->at, side, (size_t)n * sizeof *side);
    p->first[p->n++] = p->at;
    p->first[p->n] = p->at += n;
    return 0;
}

static void pool_free(struct pool *p)
{
    free(p->first);
    free(p->v);
    free(p->side);
}

struct cutting {
    const fl_domain *d;
    double least, touch;
    struct pool todo, done;
    int32_t *site, site_cap;     /* of the finished pieces */
    double *area, *dropped_area; /* of the finished and of the dropped pieces [m2] */
    int32_t area_cap, dropped_cap, dropped;
    struct near near, ray;
    fl_vec2 *v; /* scratch */
    fl_polygon_side *side;
    int32_t v_cap, side_cap;
};

static fl_polygon_side line_of(fl_vec2 p, fl_vec2 q, int32_t tag)
{
    const double dx = q.x - p.x, dy = q.y - p.y, s = 1.0 / hypot(dx, dy);
    return (fl_polygon_side){s * dy, -s * dx, s * (dy * p.x - dx * p.y), tag};
}

/* Length of the part of p q that is inside the polygon by more than `touch`. */
static double length_in(int32_t n, const fl_polygon_side *side, fl_vec2 p, fl_vec2 q, double touch)
{
    double from = 0.0, to = 1.0;
    for (int32_t k = 0; k < n && from < to; k++) {
        const double a = fl_polygon_side_distance(side[k], p) + touch,
                     b = fl_polygon_side_distance(side[k], q) + touch;
        if (a > 0.0 && b > 0.0) return 0.0;
        if (a > 0.0) from = fmax(from, a / (a - b));
        if (b > 0.0) to = fmin(to, a / (a - b));
    }
    return to > from ? (to - from) * hypot(q.x - p.x, q.y - p.y) : 0.0;
}

/* The side of the domain with the greatest length inside a piece, -1 if there is none. */
static int32_t longest_side(const struct cutting *c, int32_t n, const fl_polygon_side *side)
{
    int32_t at = -1;
    double best = c->touch;
    for (int32_t k = 0; k < c->near.n; k++) {
        fl_vec2 p, q;
        double l;
        side_of(c->d, c->near.k[k], &p, &q);
        l = length_in(n, side, p, q, c->touch);
        if (l > best) {
            best = l;
            at = c->near.k[k];
        }
    }
    return at;
}

/* Store a piece that no side crosses, if it is inside the domain and no sliver. */
static int store_piece(struct cutting *c, int32_t i, int32_t n, fl_vec2 *v, fl_polygon_side *side, int cut,
                       fl_err *err)
{
    const double area = fl_polygon_area(n, v);
    double depth = INFINITY;
    int is = 0;
    if (!(area > 0.0)) return 0;
    if (find_winding(c->d, fl_polygon_centroid(n, v), &c->ray, &is, err)) return -1;
    if (!is) return 0;
    if (cut) {
        memcpy(c->v, v, (size_t)n * sizeof *v);
        memcpy(c->side, side, (size_t)n * sizeof *side);
        fl_polygon_inset(n, c->v, c->side, INFINITY, &depth);
    }
    if (depth < c->least) {
        if (fl_grow(&c->dropped_area, &c->dropped_cap, (int64_t)c->dropped + 1, sizeof *c->dropped_area, err))
            return -1;
        c->dropped_area[c->dropped++] = area;
        return 0;
    }
    if (fl_grow(&c->site, &c->site_cap, (int64_t)c->done.n + 1, sizeof *c->site, err) ||
        fl_grow(&c->area, &c->area_cap, (int64_t)c->done.n + 1, sizeof *c->area, err))
        return -1;
    c->site[c->done.n] = i;
    c->area[c->done.n] = area;
    return pool_add(&c->done, n, v, side, err);
}

static int cut_cell(struct cutting *c, const fl_power_cells *cells, int32_t i, fl_err *err)
{
    const int32_t first = cells->first[i], m = cells->first[i + 1] - first;
    struct pool *todo = &c->todo;
    fl_aabb box = aabb_empty();
    if (m < 3) return 0;
    for (int32_t k = 0; k < m; k++) box = aabb_add(box, v3(cells->v[first + k].x, cells->v[first + k].y, 0));
    if (find_sides(c->d, box, &c->near, err)) return -1;
    if (c->near.n) qsort(c->near.k, (size_t)c->near.n, sizeof *c->near.k, by_number);
    todo->n = todo->at = 0;
    if (pool_add(todo, m, cells->v + first, cells->side + first, err)) return -1;
    for (int32_t t = 0; t < todo->n; t++) {
        const int32_t at = todo->first[t], n = todo->first[t + 1] - at;
        const int32_t along = longest_side(c, n, todo->side + at);
        /* room for the piece and one more corner, twice: the pool may move when a piece is added */
        if (fl_grow(&c->v, &c->v_cap, 2 * ((int64_t)n + 1), sizeof *c->v, err) ||
            fl_grow(&c->side, &c->side_cap, 2 * ((int64_t)n + 1), sizeof *c->side, err))
            return -1;
        if (along < 0) {
            if (store_piece(c, i, n, todo->v + at, todo->side + at, t > 0, err)) return -1;
            continue;
        }
        for (int half = 0; half < 2; half++) {
            fl_vec2 p, q, *v = c->v + half * (n + 1);
            fl_polygon_side *side = c->side + half * (n + 1), h;
            int32_t left;
            side_of(c->d, along, &p, &q);
            h = line_of(p, q, -5 - along);
            if (half) h = (fl_polygon_side){-h.nx, -h.ny, -h.c, h.tag};
            memcpy(v, todo->v + todo->first[t], (size_t)n * sizeof *v);
            memcpy(side, todo->side + todo->first[t], (size_t)n * sizeof *side);
            left = fl_polygon_cut(n, v, side, h);
            if (left >= 3 && pool_add(todo, left, v, side, err)) return -1;
        }
    }
    return 0;
}

/* --- the pieces ----------------------------------------------------------------------------------------- */

/* Collect the pieces: largest pieces first, by cell, then the others. */
static int collect_pieces(const struct cutting *c, int32_t cells, fl_pieces *out, fl_err *err)
{
    const int32_t n = c->done.n;
    int32_t *largest = fl_alloc(cells, sizeof *largest, err), to = 0, at = 0;
    fl_pieces p = {.cells.n = n, .dropped = c->dropped};
    int rc = -1;
    if (!(p.cells.first = fl_alloc((int64_t)n + 1, sizeof *p.cells.first, err)) ||
        !(p.cells.side = fl_alloc(c->done.at, sizeof *p.cells.side, err)) ||
        !(p.cells.v = fl_alloc(c->done.at, sizeof *p.cells.v, err)) ||
        !(p.parent = fl_alloc(n, sizeof *p.parent, err)) || !largest)
        goto done;
    for (int32_t i = 0; i < cells; i++) largest[i] = -1;
    for (int32_t k = 0; k < n; k++)
        if (largest[c->site[k]] < 0 || c->area[k] > c->area[largest[c->site[k]]]) largest[c->site[k]] = k;
    for (int pass = 0; pass < 2; pass++) {
        for (int32_t k = 0; k < n; k++) {
            const int32_t from = c->done.first[k], m = c->done.first[k + 1] - from;
            if ((largest[c->site[k]] == k) != (pass == 0)) continue;
            memcpy(p.cells.v + at, c->done.v + from, (size_t)m * sizeof *p.cells.v);
            memcpy(p.cells.side + at, c->done.side + from, (size_t)m * sizeof *p.cells.side);
            p.parent[to] = c->site[k];
            p.cells.first[++to] = at += m;
        }
        if (pass == 0) p.largest = to;
    }
    p.dropped_area = fl_parallel_sum(c->dropped_area, c->dropped);
    p.area = fl_parallel_sum(c->area, n) + p.dropped_area;
    *out = p;
    p = (fl_pieces){0};
    rc = 0;
done:
    free(largest);
    fl_pieces_free(&p);
    return rc;
}

int fl_domain_cut(fl_pieces *out, const fl_power_cells *cells, const fl_domain *d, double least, fl_err *err)
{
    struct cutting c = {.d = d, .least = least};
    int rc = -1;
    c.touch = FL_DOMAIN_TOUCH_TOL * hypot(d->hi.x - d->lo.x, d->hi.y - d->lo.y);
    for (int32_t i = 0; i < cells->n; i++)
        if (cut_cell(&c, cells, i, err)) goto done;
    rc = collect_pieces(&c, cells->n, out, err);
done:
    pool_free(&c.todo);
    pool_free(&c.done);
    free(c.site);
    free(c.area);
    free(c.dropped_area);
    free(c.near.k);
    free(c.ray.k);
    free(c.v);
    free(c.side);
    return rc;
}

void fl_pieces_free(fl_pieces *p)
{
    fl_power_cells_free(&p->cells);
    free(p->parent);
    *p = (fl_pieces){0};
}

void fl_domain_free(fl_domain *d)
{
    free(d->first);
    free(d->v);
    free(d->box);
    fl_bvh_free(&d->tree);
    *d = (fl_domain){0};
}
