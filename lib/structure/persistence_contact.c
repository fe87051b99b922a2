/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <string.h>
#include "base/array.h"
#include "structure/persistence_contact.h"

/* Distance up to which two tiles meet, relative to the size. Tiles are flat, and straight runs of their sides
 * straight, to half of that (coplanar_regions.c). */
#define SEAM_TOL 2e-6
/* Slope up to which one of two tiles that meet may rise from the plane of the other and be one wall with it:
 * it changes the distance by half its square, 5e-13. */
#define RISE_TOL 1e-6
/* Rounding of distances, relative to the size; half the square of RISE_TOL is below it. */
#define ROUNDING_TOL 1e-12

/* Length of a seam, in SEAM_TOL, below which it is one point: each of its two ends may be off by 1 on either
 * tile. */
#define POINT_SEAM 4.0
/* Excess, in SEAM_TOL, by which ends of different intervals have to be farther apart than the longest
 * interval to be the seam. Twice POINT_SEAM: the ends compared may be off by that, and those of the interval
 * too. */
#define LONGER 8.0
/* Cosine of the normals below which two tiles are the two sides of a sheet (154 degrees): their seam is no
 * convex edge. */
#define BACK_TO_BACK -0.9
/* Gap between spans, as a fraction of a side, that is rounding: far above 1e-15, far below any tile. */
#define COVER_TOL 1e-9

enum { DROPPED = -1 }; /* marks a seam to be dropped */

/* --- seams of tiles ------------------------------------------------------------------------------ */

static int32_t sides_of(const fl_poly *p, int32_t f) { return p->first[f + 1] - p->first[f]; }
static const int32_t *loop_of(const fl_poly *p, int32_t f) { return p->loop + p->first[f]; }

/* Side c of tile f, from its corner to the next. */
static fl_vec3 side_vector(const fl_poly *p, int32_t f, int32_t c)
{
    return v3_sub(p->v[p->loop[c + 1 < p->first[f + 1] ? c + 1 : p->first[f]]], p->v[p->loop[c]]);
}

/* Clips the interval t[0] to t[1] of a line to where the height is at most 0; h0 and h1 are the heights at 0
 * and 1. Returns 0 if nothing is left. */
static int clip_interval(double t[2], double h0, double h1)
{
    if (h0 > 0.0 && h1 > 0.0) return 0;
    if (h0 > 0.0) t[0] = fmax(t[0], h0 / (h0 - h1));
    if (h1 > 0.0) t[1] = fmin(t[1], h0 / (h0 - h1));
    return t[0] <= t[1];
}

/* The interval of a b that lies within tol of tile f; 0 if there is none. */
static int interval_on_tile(const fl_poly *p, int32_t f, fl_vec3 a, fl_vec3 b, double tol, double t[2])
{
    const int32_t *v = loop_of(p, f), m = sides_of(p, f);
    const fl_vec3 n = p->n[f];
    const double ha = v3_dot(n, a) - p->c[f], hb = v3_dot(n, b) - p->c[f];
    t[0] = 0.0, t[1] = 1.0;
    if (!clip_interval(t, ha - tol, hb - tol) || !clip_interval(t, -ha - tol, -hb - tol)) return 0;
    for (int32_t c = 0, last = m - 1; c < m; last = c++) {
        const fl_vec3 from = p->v[v[last]], out = v3_unit(v3_cross(v3_sub(p->v[v[c]], from), n));
        if (!clip_interval(t, v3_dot(out, v3_sub(a, from)) - tol, v3_dot(out, v3_sub(b, from)) - tol))
            return 0;
    }
    return 1;
}

/* A part of a side, numbered as in loop, that another tile covers. */
typedef struct {
    int32_t side;
    double from, to; /* fractions of the side */
} side_span;

/* State while seams are made. */
typedef struct {
    const fl_poly *p;
    const fl_bvh *tree;
    const fl_aabb *box;
    side_span *over;
    fl_vec3 *end; /* ends of all intervals of two tiles on each other */
    int32_t n_over, n_end, over_cap, end_cap;
    fl_persistence_work k;
} seam_builder;

/* Collects the intervals of sides of tile f on tile g: spans and ends. Sets *seam to the longest if it is
 * longer than *most. Returns -1 when memory runs out. */
static int collect_intervals(seam_builder *q, int32_t f, int32_t g, double tol, double *most,
                             fl_tile_seam *seam)
{
    const fl_poly *p = q->p;
    for (int32_t c = p->first[f]; c < p->first[f + 1]; c++) {
        const fl_vec3 a = p->v[p->loop[c]], way = side_vector(p, f, c);
        double t[2];
        if (!interval_on_tile(p, g, a, v3_add(a, way), tol, t)) continue;
        if (fl_reserve(&q->over, &q->over_cap, (int64_t)q->n_over + 1, sizeof *q->over) ||
            fl_reserve(&q->end, &q->end_cap, (int64_t)q->n_end + 2, sizeof *q->end))
            return -1;
        const fl_vec3 from = v3_madd(a, t[0], way), to = v3_madd(a, t[1], way);
        const double length = (t[1] - t[0]) * v3_norm(way);
        q->over[q->n_over++] = (side_span){c, t[0], t[1]};
        q->end[q->n_end++] = from, q->end[q->n_end++] = to;
        if (length > *most) *most = length, seam->a = from, seam->b = to;
    }
    return 0;
}

static fl_vec3 mean_corner(const fl_poly *p, int32_t f)
{
    const int32_t *v = loop_of(p, f), m = sides_of(p, f);
    fl_vec3 sum = v3(0, 0, 0);
    for (int32_t c = 0; c < m; c++) sum = v3_add(sum, p->v[v[c]]);
    return v3_scale(1.0 / m, sum);
}

/* True if tile g rises from the plane of f, where they meet at x. */
static int rises_above(const fl_poly *p, int32_t f, int32_t g, fl_vec3 x)
{
    const fl_vec3 way = v3_sub(mean_corner(p, g), x);
    return v3_dot(p->n[f], way) > RISE_TOL * v3_norm(way);
}

/* True if both tiles contain that point to rounding. */
static int is_shared_point(const fl_poly *p, int32_t f, int32_t g, fl_vec3 x)
{
    return fl_closest_on_face_border(p, f, x).d <= ROUNDING_TOL * p->size &&
           fl_closest_on_face_border(p, g, x).d <= ROUNDING_TOL * p->size;
}

/* The seam of tiles f < g: 1, or 0 if they do not meet; -1 when memory runs out. Two convex tiles share a
 * convex set: a side or a part of it, or, if they cross or overlap, what ends at sides. */
static int find_seam(seam_builder *q, int32_t f, int32_t g, double tol, fl_tile_seam *seam)
{
    const fl_poly *p = q->p;
    double length = -1.0;
    q->n_end = 0;
    if (collect_intervals(q, f, g, tol, &length, seam) || collect_intervals(q, g, f, tol, &length, seam))
        return -1;
    if (length < 0.0) return 0;
    for (int32_t i = 0; i < q->n_end; i++)
        for (int32_t j = 0; j < i; j++) {
            const double across = v3_norm(v3_sub(q->end[i], q->end[j]));
            if (across > length + LONGER * tol) length = across, seam->a = q->end[j], seam->b = q->end[i];
        }
    if (length < POINT_SEAM * tol) { /* corners only, if exact */
        if (is_shared_point(p, f, g, seam->a)) seam->b = seam->a;
        else if (is_shared_point(p, f, g, seam->b)) seam->a = seam->b;
    }
    seam->j = g;
    seam->concave = rises_above(p, f, g, seam->a) || rises_above(p, g, f, seam->a) ||
                    v3_dot(p->n[f], p->n[g]) < BACK_TO_BACK || !is_shared_point(p, f, g, seam->a) ||
                    !is_shared_point(p, f, g, seam->b);
    return 1;
}

static int compare_int(const void *a, const void *b)
{
    const int32_t x = *(const int32_t *)a, y = *(const int32_t *)b;
    return (x > y) - (x < y);
}

/* Boxes that meet q, ascending; -1 when memory runs out. */
static int32_t query_boxes(fl_persistence_work *k, const fl_bvh *tree, const fl_aabb *box, fl_aabb q)
{
    int32_t n = fl_bvh_query(tree, box, q, k->list, k->list_cap);
    if (n > k->list_cap) {
        if (fl_reserve(&k->list, &k->list_cap, n, sizeof *k->list)) return -1;
        n = fl_bvh_query(tree, box, q, k->list, k->list_cap);
    }
    if (n > 1) qsort(k->list, (size_t)n, sizeof *k->list, compare_int);
    return n;
}

/* Appends the seams of tile f with later tiles. */
static int seams_of(fl_tile_seams *s, seam_builder *q, int32_t f)
{
    const int32_t n = query_boxes(&q->k, q->tree, q->box, aabb_grow(q->box[f], s->tol));
    if (n < 0) return -1;
    for (int32_t c = 0; c < n; c++) {
        const int32_t g = q->k.list[c];
        fl_tile_seam seam;
        const int met = g > f ? find_seam(q, f, g, s->tol, &seam) : 0;
        if (met < 0) return -1;
        if (!met) continue;
        if (fl_reserve(&s->seam, &s->cap, (int64_t)s->n + 1, sizeof *s->seam)) return -1;
        s->seam[s->n++] = seam;
    }
    return 0;
}

/* --- contact of a sphere -------------------------------------------------------------------------- */

/* Index of a tile in the scratch, -1 for none; tiles there are ascending. */
static int32_t index_of_tile(const fl_persistence_work *k, int32_t tile)
{
    int32_t low = 0, high = k->tiles;
    while (low < high) {
        const int32_t mid = low + (high - low) / 2;
        if (k->tile[mid].tile < tile) low = mid + 1;
        else high = mid;
    }
    return low < k->tiles && k->tile[low].tile == tile ? low : -1;
}

static int32_t root_of(fl_persistence_work *k, int32_t i)
{
    while (k->tile[i].parent != i) i = k->tile[i].parent = k->tile[k->tile[i].parent].parent;
    return i;
}

/* Nearest point of a tile if x is in front of it, else of its rim. */
static fl_closest_point closest_of_tile(const fl_poly *p, int32_t f, fl_vec3 x)
{
    return v3_dot(p->n[f], x) >= p->c[f] ? fl_closest_on_face(p, f, x) : fl_closest_on_face_border(p, f, x);
}

/* Collects the tiles of an ascending list that are nearer than `radius`. If q is given, it is the nearest
 * point of tile `of`, and of tiles that face away only the rim counts. Returns -1 when memory runs out. */
static int collect_tiles(fl_persistence_work *k, const fl_poly *p, const fl_near_tiles *some, fl_vec3 x,
                         double radius, const fl_closest_point *q, int32_t of)
{
    k->tiles = 0;
    if (fl_reserve(&k->tile, &k->tile_cap, some->n, sizeof *k->tile)) return -1;
    for (int32_t c = 0; c < some->n; c++) {
        const int32_t f = some->tile[c];
        if (fabs(v3_dot(p->n[f], x) - p->c[f]) >= radius) continue;
        const fl_closest_point at = !q        ? fl_closest_on_face(p, f, x)
                                    : f == of ? *q
                                              : closest_of_tile(p, f, x);
        if (at.d < radius) k->tile[k->tiles] = (fl_persistence_tile){f, k->tiles, at}, k->tiles++;
    }
    return 0;
}

/* A saddle is never nearer than the tiles that it joins; the margin keeps rounding from separating
 * components. */
static fl_closest_point saddle_of(const fl_tile_seams *s, const fl_persistence_work *k,
                                  const fl_persistence_link *l, fl_vec3 x)
{
    fl_closest_point q = fl_closest_on_segment(s->seam[l->seam].a, s->seam[l->seam].b, x);
    if (k->tile[l->i].nearest.d > q.d) q = k->tile[l->i].nearest;
    if (k->tile[l->j].nearest.d > q.d) q = k->tile[l->j].nearest;
    q.d -= s->rounding;
    return q;
}

/* Collects the links of tiles in the scratch within that radius. Returns -1 when memory runs out. */
static int collect_links(const fl_tile_seams *s, fl_persistence_work *k, fl_vec3 x, double radius)
{
    k->links = 0;
    for (int32_t i = 0; i < k->tiles; i++) {
        const int32_t f = k->tile[i].tile;
        for (int32_t at = s->begin[f]; at < s->begin[f + 1]; at++) {
            fl_persistence_link l = {.i = i, .j = index_of_tile(k, s->seam[at].j), .seam = at};
            if (l.j < 0) continue;
            l.d = saddle_of(s, k, &l, x).d;
            if (!(l.d < radius)) continue;
            if (fl_reserve(&k->link, &k->link_cap, (int64_t)k->links + 1, sizeof *k->link)) return -1;
            k->link[k->links++] = l;
        }
    }
    return 0;
}

/* True if a side of tile f nearer than that is a rim. */
static int has_rim_within(const fl_tile_seams *s, const fl_poly *p, int32_t f, fl_vec3 x, double radius)
{
    for (int32_t c = p->first[f]; c < p->first[f + 1]; c++) {
        const fl_vec3 a = p->v[p->loop[c]];
        if (s->rim[c] && fl_closest_on_segment(a, v3_add(a, side_vector(p, f, c)), x).d < radius) return 1;
    }
    return 0;
}

/* Within a ball where the surface has no rim, is not concave and is connected, it is that of a convex body
 * (Tietze and Nakajima). */
int fl_persistence_is_single(const fl_tile_seams *s, fl_persistence_work *k, const fl_poly *p,
                             const fl_near_tiles *near, fl_vec3 x, double r)
{
    if (collect_tiles(k, p, near, x, r, NULL, -1) || collect_links(s, k, x, r)) return -1;
    int32_t components = k->tiles;
    if (components < 2) return 1;
    for (int32_t i = 0; i < k->tiles; i++)
        if (has_rim_within(s, p, k->tile[i].tile, x, r)) return 0;
    for (int32_t c = 0; c < k->links; c++) {
        const int32_t i = root_of(k, k->link[c].i), j = root_of(k, k->link[c].j);
        if (s->seam[k->link[c].seam].concave) return 0;
        if (i != j) k->tile[i].parent = j, components--;
    }
    return components == 1;
}

static int compare_links(const void *a, const void *b)
{
    const fl_persistence_link *x = a, *y = b;
    if (x->d != y->d) return x->d < y->d ? -1 : 1;
    return x->seam < y->seam ? -1 : x->seam > y->seam;
}

/* Overlapping tiles have one point twice. True if the minimum of component i is that of a nearer
 * component. */
static int is_repeated(const fl_tile_seams *s, fl_persistence_work *k, int32_t i)
{
    const fl_persistence_tile *const it = &k->tile[i];
    for (int32_t j = 0; j < k->tiles; j++) {
        const fl_persistence_tile *const other = &k->tile[j];
        const int nearer = other->nearest.d < it->nearest.d || (other->nearest.d == it->nearest.d && j < i);
        if (nearer && v3_norm(v3_sub(other->nearest.p, it->nearest.p)) <= s->tol && root_of(k, j) != i)
            return 1;
    }
    return 0;
}

static int add_point(fl_patch_points *w, fl_vec3 x, const fl_closest_point *q, double radius, double times)
{
    if (fl_patch_points_add_plain(w, x, q->n, radius - q->d, radius)) return -1;
    w->point[w->n - 1].du = times;
    return 0;
}

int fl_persistence_points(const fl_tile_seams *s, fl_persistence_work *k, fl_patch_points *w,
                          const fl_poly *p, const fl_near_tiles *near, fl_vec3 x, double radius,
                          const fl_closest_point *q, int32_t of)
{
    if (!(q->d < radius)) return 0;
    if (add_point(w, x, q, radius, 1.0)) return -1;
    if (q->d < 0.0) return 0; /* from behind all other walls belong to the other side */
    if (collect_tiles(k, p, near, x, radius, q, of)) return -1;
    if (k->tiles < 2) return 0;
    if (collect_links(s, k, x, radius)) return -1;
    if (k->links > 1) qsort(k->link, (size_t)k->links, sizeof *k->link, compare_links);
    const int32_t first = index_of_tile(k, of);
    for (int32_t c = 0; c < k->links; c++) { /* roots are the minima of their components */
        const fl_persistence_link *const l = &k->link[c];
        int32_t old = root_of(k, l->i), young = root_of(k, l->j);
        if (old == young) continue;
        if (young == first || (old != first && k->tile[young].nearest.d < k->tile[old].nearest.d)) {
            const int32_t t = old;
            old = young, young = t;
        }
        const int own =
            l->d > k->tile[young].nearest.d && !is_repeated(s, k, young); /* a minimum of its own */
        k->tile[young].parent = old;
        if (!own) continue;
        const fl_closest_point seam = saddle_of(s, k, l, x);
        if (add_point(w, x, &k->tile[young].nearest, radius, 1.0) || add_point(w, x, &seam, radius, -1.0))
            return -1;
    }
    for (int32_t i = 0; i < k->tiles; i++)
        if (k->tile[i].parent == i && i != first && !is_repeated(s, k, i) &&
            add_point(w, x, &k->tile[i].nearest, radius, 1.0))
            return -1;
    return 0;
}

/* --- making the seams ----------------------------------------------------------------------------- */

/* The tiles at every vertex. */
typedef struct {
    int32_t *begin, *tile; /* [nv + 1], [sides] */
} vertex_tiles;

static int find_corners(vertex_tiles *c, const fl_poly *p, fl_err *err)
{
    const int32_t sides = p->first[p->nf];
    c->begin = fl_alloc((int64_t)p->nv + 2, sizeof *c->begin, err);
    c->tile = fl_alloc(sides, sizeof *c->tile, err);
    if (!c->begin || !c->tile) return -1;
    memset(c->begin, 0, ((size_t)p->nv + 2) * sizeof *c->begin);
    for (int32_t k = 0; k < sides; k++) c->begin[p->loop[k] + 2]++;
    for (int32_t v = 0; v <= p->nv; v++) c->begin[v + 1] += c->begin[v];
    for (int32_t f = 0; f < p->nf; f++)
        for (int32_t k = p->first[f]; k < p->first[f + 1]; k++) c->tile[c->begin[p->loop[k] + 1]++] = f;
    return 0;
}

/* Tiles round a vertex x that a chain of longer seams joins need no seam at the vertex itself. With drop = 0
 * joins tiles in the scratch by the long seams; with drop = 1 drops the short seams between tiles that are
 * joined. */
static void join_round_corner(fl_tile_seams *s, fl_persistence_work *k, fl_vec3 x, const int32_t *number,
                              int drop)
{
    for (int32_t i = 0; i < k->tiles; i++) {
        for (int32_t at = s->begin[k->tile[i].tile]; at < s->begin[k->tile[i].tile + 1]; at++) {
            fl_tile_seam *const l = &s->seam[at];
            const int32_t j = number[l->j];
            const int is_short = v3_norm(v3_sub(l->b, l->a)) < POINT_SEAM * s->tol;
            if (j < 0 || is_short != drop || fl_closest_on_segment(l->a, l->b, x).d > POINT_SEAM * s->tol)
                continue;
            if (!drop) k->tile[root_of(k, i)].parent = root_of(k, j);
            else if (root_of(k, i) == root_of(k, j)) l->concave = DROPPED;
        }
    }
}

/* Drops the seams that are corners, where possible. Returns -1 with FL_SYSTEM. */
static int drop_corner_seams(fl_tile_seams *s, fl_persistence_work *k, const fl_poly *p, fl_err *err)
{
    vertex_tiles c = {0};
    int32_t kept = 0, *number = fl_alloc(p->nf, sizeof *number, err);
    int rc = -1;
    if (!number || find_corners(&c, p, err)) goto done;
    for (int32_t f = 0; f < p->nf; f++) number[f] = -1;
    for (int32_t v = 0; v < p->nv; v++) {
        const int32_t n = c.begin[v + 1] - c.begin[v];
        if (fl_grow(&k->tile, &k->tile_cap, n, sizeof *k->tile, err)) goto done;
        k->tiles = n;
        for (int32_t i = 0; i < n; i++) {
            k->tile[i] = (fl_persistence_tile){.tile = c.tile[c.begin[v] + i], .parent = i};
            number[k->tile[i].tile] = i;
        }
        for (int drop = 0; drop < 2; drop++) join_round_corner(s, k, p->v[v], number, drop);
        for (int32_t i = 0; i < n; i++) number[k->tile[i].tile] = -1;
    }
    for (int32_t f = 0, at = 0; f < p->nf; f++) {
        const int32_t end = s->begin[f + 1];
        s->begin[f] = kept;
        for (; at < end; at++)
            if (s->seam[at].concave != DROPPED) s->seam[kept++] = s->seam[at];
    }
    s->n = s->begin[p->nf] = kept;
    fl_tile_seam *const trimmed = realloc(s->seam, (size_t)(kept + 1) * sizeof *s->seam);
    if (trimmed) s->seam = trimmed, s->cap = kept + 1;
    rc = 0;
done:
    free(number), free(c.begin), free(c.tile);
    return rc;
}

static int compare_spans(const void *a, const void *b)
{
    const side_span *x = a, *y = b;
    if (x->side != y->side) return x->side < y->side ? -1 : 1;
    return (x->from > y->from) - (x->from < y->from);
}

/* Marks sides that spans do not cover from end to end. */
static void find_rims(fl_tile_seams *s, seam_builder *q)
{
    int32_t at = 0;
    if (q->n_over > 1) qsort(q->over, (size_t)q->n_over, sizeof *q->over, compare_spans);
    for (int32_t c = 0; c < q->p->first[q->p->nf]; c++) {
        double covered = 0.0;
        for (; at < q->n_over && q->over[at].side == c; at++)
            if (q->over[at].from <= covered + COVER_TOL) covered = fmax(covered, q->over[at].to);
        s->rim[c] = covered < 1.0 - COVER_TOL;
    }
}

int fl_tile_seams_make(fl_tile_seams *out, const fl_poly *p, const fl_bvh *tree, const fl_aabb *box,
                       fl_err *err)
{
    fl_tile_seams s = {.tol = SEAM_TOL * p->size, .rounding = ROUNDING_TOL * p->size};
    seam_builder q = {.p = p, .tree = tree, .box = box};
    int rc = -1;
    s.begin = fl_alloc((int64_t)p->nf + 1, sizeof *s.begin, err);
    s.rim = fl_alloc(p->first[p->nf], sizeof *s.rim, err);
    if (!s.begin || !s.rim) goto done;
    for (int32_t f = 0; f < p->nf; f++) {
        s.begin[f] = s.n;
        if (seams_of(&s, &q, f)) {
            fl_fail(err, FL_SYSTEM, "out of memory: where %d tiles meet", (int)p->nf);
            goto done;
        }
    }
    s.begin[p->nf] = s.n;
    if (drop_corner_seams(&s, &q.k, p, err)) goto done;
    find_rims(&s, &q);
    rc = 0;
done:
    free(q.over), free(q.end);
    fl_persistence_work_free(&q.k);
    if (rc) fl_tile_seams_free(&s);
    else *out = s;
    return rc;
}

void fl_tile_seams_free(fl_tile_seams *s)
{
    free(s->begin), free(s->seam), free(s->rim);
    *s = (fl_tile_seams){0};
}

void fl_persistence_work_free(fl_persistence_work *k)
{
    free(k->tile), free(k->link), free(k->list);
    *k = (fl_persistence_work){0};
}
