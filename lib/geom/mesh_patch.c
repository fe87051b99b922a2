/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <string.h>
#include "base/array.h"
#include "base/pi.h"
#include "geom/outer_skin.h"
#include "geom/mesh_patch.h"

/* Rounding leaves up to 4 x 2^-53 of the longest side squared in a cross product that should be zero. */
static const double NO_AREA = 1e-15, NO_VOLUME = 1e-10;

/* across[3 t + k]: the triangle across side k of t, -1 for none; coherent[3 t + k]: both run along the side
 * in opposite directions. */
typedef struct {
    int32_t *across, *queue;
    int8_t *coherent;
    int8_t *sign; /* 0 not reached, 1 unchanged, -1 to be turned */
    int32_t open, branched, incoherent;
    int balanced;
} adjacency;

static void adjacency_free(adjacency *w)
{
    free(w->across);
    free(w->queue);
    free(w->coherent);
    free(w->sign);
}

static void add_edge(adjacency *w, const fl_half_edge *s, int64_t n)
{
    int64_t up = 0;
    for (int64_t k = 0; k < n; k++) up += s[k].up ? 1 : -1;
    if (up != 0) w->balanced = 0;
    if (n == 1) w->open++;
    if (n > 2) w->branched++;
    if (n != 2) return;
    if (up != 0) w->incoherent++;
    for (int k = 0; k < 2; k++) {
        const int64_t here = 3 * (int64_t)s[k].t + s[k].k;
        w->across[here] = s[1 - k].t;
        w->coherent[here] = up == 0;
    }
}

/* Builds the adjacency of p, and edges, which the caller frees. */
static int adjacency_make(adjacency *w, const fl_part *p, fl_edges *edges, fl_err *err)
{
    *w = (adjacency){.balanced = 1};
    if (fl_edges_make(edges, p, err)) return -1;
    w->across = fl_alloc(3 * (int64_t)p->nt, sizeof *w->across, err);
    w->coherent = w->across ? fl_alloc(3 * (int64_t)p->nt, 1, err) : NULL;
    w->sign = w->coherent ? fl_alloc(p->nt, 1, err) : NULL;
    w->queue = w->sign ? fl_alloc(p->nt, sizeof *w->queue, err) : NULL;
    if (!w->queue) {
        fl_edges_free(edges);
        adjacency_free(w);
        return -1;
    }
    memset(w->across, -1, 3 * (size_t)p->nt * sizeof *w->across);
    for (int32_t v = 0; v < p->nv; v++)
        for (int64_t from = edges->first[v], to; from < edges->first[v + 1]; from = to) {
            to = fl_edge_end(edges, v, from);
            add_edge(w, edges->side + from, to - from);
        }
    return 0;
}

/* Properties of a patch after traversal. */
typedef struct {
    int32_t n;                 /* triangles, w->queue[0 .. n)      */
    int has_rim, is_one_sided; /* has a boundary; signs cannot be made consistent */
} patch_walk;

/* Traverses the patch of triangle t0.  Each triangle gets the sign that makes it coherent with t0. */
static patch_walk walk_patch(adjacency *w, int32_t t0)
{
    patch_walk g = {1, 0, 0};
    w->queue[0] = t0;
    w->sign[t0] = 1;
    for (int32_t at = 0; at < g.n; at++) {
        const int32_t t = w->queue[at];
        for (int k = 0; k < 3; k++) {
            const int32_t u = w->across[3 * (int64_t)t + k];
            const int8_t want = w->coherent[3 * (int64_t)t + k] ? w->sign[t] : (int8_t)-w->sign[t];
            if (u < 0) {
                g.has_rim = 1;
            } else if (w->sign[u] == 0) {
                w->sign[u] = want;
                w->queue[g.n++] = u;
            } else if (w->sign[u] != want) {
                g.is_one_sided = 1;
            }
        }
    }
    return g;
}

/* Sums over the signed triangles of a patch: volume, area kept, area turned.  The volume is taken about a
 * corner of the patch and divided by the sum of the absolute terms.  A value below NO_VOLUME may be rounding,
 * whose sign depends on the order of the triangles. */
static void sum_patch(const fl_part *p, const adjacency *w, int32_t n, double sum[3])
{
    double sizes = 0.0;
    const fl_vec3 o = p->v[p->t[w->queue[0]].v[0]];
    sum[0] = sum[1] = sum[2] = 0.0;
    for (int32_t k = 0; k < n; k++) {
        const int32_t t = w->queue[k], *v = p->t[t].v;
        const fl_vec3 a = v3_sub(p->v[v[0]], o), b = v3_sub(p->v[v[1]], o), c = v3_sub(p->v[v[2]], o);
        const double six = v3_dot(a, v3_cross(b, c));
        sum[0] += w->sign[t] * six;
        sizes += fabs(six);
        sum[w->sign[t] > 0 ? 1 : 2] += 0.5 * v3_norm(v3_cross(v3_sub(b, a), v3_sub(c, a)));
    }
    if (sizes > 0.0) sum[0] /= sizes;
}

/* --- measures ------------------------------------------------------------------------------------------- */

typedef struct {
    double volume, area;
    fl_vec3 vc, ac; /* first moments of volume and area about the common origin */
} measure_sums;

static void add_cone(measure_sums *s, const fl_cone *c, fl_vec3 o)
{
    const fl_vec3 p0 = v3_sub(c->p0, o), along = v3_sub(c->p1, c->p0), p1 = v3_sub(c->p1, o);
    const double h = v3_norm(along), r = c->r0, q = c->r1, squares = r * r + r * q + q * q;
    const double volume = PI * h / 3.0 * squares, side_area = PI * (r + q) * hypot(h, r - q);
    s->volume += volume;
    s->vc = v3_madd(s->vc, volume, v3_madd(p0, 0.25 * (r * r + 2 * r * q + 3 * q * q) / squares, along));
    s->area += side_area + PI * r * r + PI * q * q;
    s->ac = v3_madd(s->ac, side_area, v3_madd(p0, (r + 2 * q) / (3 * (r + q)), along));
    s->ac = v3_madd(v3_madd(s->ac, PI * r * r, p0), PI * q * q, p1);
}

static double smaller_of(double a, double b) { return a < b ? a : b; }

/* Adds part p to s, and its degenerate triangles and shortest edge to q. */
static void add_part(measure_sums *s, fl_mesh_quality *q, const fl_part *p, fl_vec3 o)
{
    double least = INFINITY; /* length of an edge, squared */
    for (int32_t t = 0; t < p->nt; t++) {
        const int32_t *v = p->t[t].v;
        const fl_vec3 a = v3_sub(p->v[v[0]], o), b = v3_sub(p->v[v[1]], o), c = v3_sub(p->v[v[2]], o);
        const fl_vec3 ab = v3_sub(b, a), ac = v3_sub(c, a), middle = v3_add(a, v3_add(b, c));
        const double twice = v3_norm(v3_cross(ab, ac)), six = v3_dot(a, v3_cross(b, c));
        const double l0 = v3_norm2(ab), l1 = v3_norm2(v3_sub(c, b)), l2 = v3_norm2(ac);
        q->degenerate +=
            fl_tri_repeats_vertex(&p->t[t]) || twice <= NO_AREA * -smaller_of(-l0, smaller_of(-l1, -l2));
        least = smaller_of(least, smaller_of(l0, smaller_of(l1, l2)));
        s->volume += six / 6.0;
        s->vc = v3_madd(s->vc, six / 24.0, middle);
        s->area += 0.5 * twice;
        s->ac = v3_madd(s->ac, twice / 6.0, middle);
    }
    q->shortest_edge = fmin(q->shortest_edge, sqrt(least));
    for (int32_t c = 0; c < p->nc; c++) add_cone(s, &p->cone[c], o);
}

/* Turns the triangles of a traversed patch.  outer: outward sides of the triangles, NULL without branched
 * edges. */
static void orient_patch(fl_part *p, const adjacency *w, const patch_walk *g, const double sum[3],
                         const uint8_t *outer, fl_orient_counts *o)
{
    const double volume = sum[0], kept = sum[1], turned = sum[2];
    const int outward = g->has_rim && !g->is_one_sided && outer ? outer[w->queue[0]] : FL_OUTER_BOTH;
    int flip = turned > kept, inward = 0;
    o->kept_side += g->has_rim && outward == FL_OUTER_BOTH;
    o->one_sided += g->is_one_sided;
    for (int32_t k = 0; k < g->n; k++) o->triangles += (w->sign[w->queue[k]] < 0) != flip;
    if (!g->has_rim && !g->is_one_sided) inward = (flip ? -volume : volume) < -0.5 * NO_VOLUME;
    else if (outward == FL_OUTER_FRONT || outward == FL_OUTER_BACK)
        inward = flip != (outward == FL_OUTER_BACK);
    o->patches += inward;
    flip ^= inward;
    for (int32_t k = 0; k < g->n; k++) {
        int32_t *v = p->t[w->queue[k]].v;
        if ((w->sign[w->queue[k]] < 0) != flip) {
            const int32_t keep = v[1];
            v[1] = v[2];
            v[2] = keep;
        }
    }
}

/* If o is given, finds the outward sides of a part with branched edges; *outer stays NULL for other parts. */
static int find_outer_sides(const adjacency *w, const fl_part *p, const fl_edges *edges,
                            const fl_orient_counts *o, uint8_t **outer, fl_err *err)
{
    *outer = NULL;
    if (!o || !w->branched) return 0;
    *outer = fl_alloc(p->nt, 1, err);
    return *outer && fl_part_outer_sides(p, edges, *outer, err) == 0 ? 0 : -1;
}

/* Traverses all patches and counts edges and patches.  If o is given, each patch is then oriented. */
static int walk_patches(fl_mesh_quality *q, const fl_part *p, fl_part *to_turn, fl_orient_counts *o,
                        fl_err *err)
{
    adjacency w;
    fl_edges edges;
    uint8_t *outer;
    if (adjacency_make(&w, p, &edges, err)) return -1;
    const int rc = find_outer_sides(&w, p, &edges, o, &outer, err);
    fl_edges_free(&edges);
    q->open += w.open;
    q->branched += w.branched;
    q->incoherent += w.incoherent;
    q->closed = q->closed && w.balanced;
    for (int32_t t0 = 0; t0 < p->nt && rc == 0; t0++) {
        double sum[3]; /* volume, area kept, area turned */
        patch_walk g;
        if (w.sign[t0] || fl_tri_repeats_vertex(&p->t[t0])) continue;
        g = walk_patch(&w, t0);
        sum_patch(p, &w, g.n, sum);
        q->patches++;
        q->inverted += !g.has_rim && !g.is_one_sided && sum[2] == 0.0 && sum[0] < -NO_VOLUME;
        if (o) orient_patch(to_turn, &w, &g, sum, outer, o);
    }
    free(outer);
    adjacency_free(&w);
    return rc;
}

/* Measures n parts.  If o is given, n is 1 and the part is oriented. */
static int measure_parts(const fl_part *p, int32_t n, fl_part *to_turn, fl_mesh_quality *q,
                         fl_orient_counts *o, fl_err *err)
{
    const fl_surface all = {.n = n, .part = (fl_part *)p};
    measure_sums s = {0};
    fl_vec3 middle = {0};
    *q = (fl_mesh_quality){.closed = 1, .shortest_edge = INFINITY, .box = fl_surface_aabb(&all)};
    if (q->box.lo.x <= q->box.hi.x) middle = v3_scale(0.5, v3_add(q->box.lo, q->box.hi));
    for (int32_t i = 0; i < n; i++) {
        q->vertices += p[i].nv;
        q->triangles += p[i].nt;
        q->cones += p[i].nc;
        add_part(&s, q, &p[i], middle);
        if (p[i].nt && walk_patches(q, &p[i], to_turn, o, err)) return -1;
    }
    q->volume = s.volume;
    q->area = s.area;
    q->centroid = middle;
    if (q->closed && s.volume != 0.0) q->centroid = v3_madd(middle, 1.0 / s.volume, s.vc);
    else if (s.area > 0.0) q->centroid = v3_madd(middle, 1.0 / s.area, s.ac);
    return 0;
}

int fl_part_measure(const fl_part *p, fl_mesh_quality *q, fl_err *err)
{
    return measure_parts(p, 1, NULL, q, NULL, err);
}

int fl_surface_measure(const fl_surface *s, fl_mesh_quality *q, fl_err *err)
{
    return measure_parts(s->part, s->n, NULL, q, NULL, err);
}

int fl_part_orient(fl_part *p, fl_mesh_quality *came, fl_orient_counts *o, fl_err *err)
{
    *o = (fl_orient_counts){0};
    return measure_parts(p, 1, p, came, o, err);
}
