/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "narrow/gjk.h"
#include <stddef.h>
#include "narrow/gjk_double.h"
#include "narrow/gjk_dd.h"
#include "narrow/closest_simplex.h"

/* Vertices within this fraction of the extent of the pair belong to a supporting plane.  A hundred times the
 * 1e-12 that doubles may leave in n at FL_GJK_DD_BELOW, so the closest feature is always among them. */
#define PLANE_BAND 1e-10

/* A direction found in doubles is accepted when no vertex lies beyond its planes by more than this fraction
 * of the extent: the rounding of two heights, and of a direction that has lost a digit (closest_simplex.c).
 */
#define PROOF_TOL 4e-15

/* Vertices within this fraction of the extent count as lying on the planes in the test of firmness: what a
 * direction turned by FIRM_ANGLE shifts them by, with a margin. */
#define ON_PLANE_BAND 4e-12

/* Error of n in doubles that needs no second evaluation [rad]. */
#define FIRM_ANGLE 5e-13

/* Vertices nearer to one line than this, over the distance of the cores, turn n by no more. */
#define THIN_OUTLINE 1e-13

/* Rounding of a height and of the coordinates of a rotated face, over the extent. */
#define FLATNESS_ROUNDING 4.5e-16

/* Rounding of the closest points, over the extent, with a margin. */
#define POINT_ROUNDING 1e-14
/* The same far from the origin, over the distance from it. */
#define WORLD_ROUNDING 1e-15

/* Distances in double-doubles, found in two ways, agree far better than this, over the extent and the
 * distance. */
#define DISTANCE_TOL 1e-14

/* A core with more vertices on a plane (the end of a fine cylinder) takes part with all its vertices. */
enum { PLANE_MAX = FL_CORE_SMALL, ROUNDS = 4 };

typedef struct {
    fl_core a, b;
    double size; /* sum of the extents */
} core_pair;

/* The vertices at[0 .. k) of c, sorted, without repetition; map: their numbers in the whole core. */
static fl_subsimplex subsimplex_of(fl_core c, int32_t k, const int32_t *at, const int32_t *map)
{
    fl_subsimplex f = {.n = 0};
    for (int32_t p = 0; p < k; p++) {
        int32_t q = f.n;
        while (q > 0 && f.i[q - 1] > at[p]) q--;
        if (q > 0 && f.i[q - 1] == at[p]) continue;
        for (int32_t r = f.n; r > q; r--) f.i[r] = f.i[r - 1];
        f.i[q] = at[p];
        f.n++;
    }
    for (int32_t p = 0; p < f.n; p++) {
        f.v[p] = c.v[f.i[p]];
        if (map) f.i[p] = map[f.i[p]];
    }
    return f;
}

/* The vertices of a core on its supporting plane; k is PLANE_MAX + 1 when there are more. */
typedef struct {
    int32_t k, at[PLANE_MAX];
    double above[PLANE_MAX]; /* over the lowest vertex */
    double clear;            /* no vertex is nearer than this to the border of the band */
} plane;

/* The supporting planes of both cores across n. */
typedef struct {
    plane a, b;
} planes;

/* from: vertices where the search starts */
static void find_planes(const core_pair *p, fl_vec3 n, const fl_support_heights *h, const fl_simplex *from,
                        planes *f)
{
    const double band = PLANE_BAND * p->size;
    f->a.k = fl_core_support_band(p->a, n, h, from->a[0], band, f->a.at, f->a.above, &f->a.clear);
    f->b.k = fl_core_support_band(p->b, v3_neg(n), h ? h + 1 : NULL, from->b[0], band, f->b.at, f->b.above,
                                  &f->b.clear);
}

static int uses_whole_core(const planes *f) { return f->a.k > PLANE_MAX || f->b.k > PLANE_MAX; }

static int is_same_plane(const plane *f, const plane *g)
{
    if (f->k != g->k) return 0;
    for (int32_t k = 0; k < f->k && f->k <= PLANE_MAX; k++)
        if (f->at[k] != g->at[k]) return 0;
    return 1;
}

/* True if the planes would have the same vertices with n turned by this angle.  Two vertices are at most two
 * extents apart (the root of 3 for a box). */
static int plane_is_stable(const core_pair *p, const planes *f, double turn)
{
    const double shift = 4.0 * turn * p->size;
    return !uses_whole_core(f) && f->a.clear > shift && f->b.clear > shift;
}

/* Heights of the vertices on a plane along another n. */
static void update_heights(fl_core c, fl_vec3 n, plane *f)
{
    double low = INFINITY;
    for (int32_t i = 0; i < f->k; i++) {
        f->above[i] = v3_dot(n, v3_sub(c.v[f->at[i]], c.v[f->at[0]]));
        low = f->above[i] < low ? f->above[i] : low;
    }
    for (int32_t i = 0; i < f->k; i++) f->above[i] -= low;
}

/* Height of vertex i over the plane of its core. */
static double height_over_plane(fl_core c, fl_vec3 n, const plane *f, int32_t i)
{
    double low;
    for (int32_t k = 0; k < f->k && f->k <= PLANE_MAX; k++)
        if (f->at[k] == i) return f->above[k];
    fl_core_hill_climb(c, n, i, &low);
    return v3_dot(n, v3_sub(c.v[i], c.v[0])) - low;
}

/* Closest points from the vertices on the planes alone.  Returns 0 when more bits are needed. */
static int closest_on_planes(const core_pair *p, const planes *f, int fine, fl_gap *out)
{
    static const int32_t first[3] = {0, 1, 2};
    fl_vec3 va[PLANE_MAX], vb[PLANE_MAX];
    const int all = uses_whole_core(f);
    fl_core a = p->a, b = p->b;
    if (!all) {
        for (int32_t k = 0; k < f->a.k; k++) va[k] = a.v[f->a.at[k]];
        for (int32_t k = 0; k < f->b.k; k++) vb[k] = b.v[f->b.at[k]];
        a = (fl_core){va, f->a.k, NULL};
        b = (fl_core){vb, f->b.k, NULL};
    }
    fl_simplex s = {.n = 0};
    const int direct = a.n <= 3 && b.n <= 3 && a.n + b.n <= 4;
    if (!direct) {
        fl_vec3 n;
        fl_support_heights h[2];
        fl_simplex_start(&s, a, b, NULL);
        if (fine ? fl_gjk_dd(a, b, p->size, &s, out)
                 : !fl_gjk_double(a, b, p->size, &s, &n, h, &out->iterations))
            return 0;
    }
    const fl_subsimplex fa = subsimplex_of(a, direct ? a.n : s.n, direct ? first : s.a, all ? NULL : f->a.at),
                        fb = subsimplex_of(b, direct ? b.n : s.n, direct ? first : s.b, all ? NULL : f->b.at);
    return fl_closest_simplex_points(&fa, &fb, p->size, fine, out);
}

/* A vertex on a plane in two axes across n, relative to the closest point of its core. */
typedef struct {
    double x, y;
} plane_point;

/* Two axes across n. */
typedef struct {
    fl_vec3 x, y;
} plane_axes;

static int32_t count_on_plane(const plane *f, double band)
{
    int32_t count = 0;
    for (int32_t i = 0; i < f->k; i++) count += f->above[i] <= band;
    return count;
}

/* Projects the vertices of f that lie on the plane; sign -1 mirrors them. */
static void project_vertices(fl_core c, const plane_axes *t, double band, const plane *f, fl_vec3 from,
                             double sign, plane_point *out)
{
    int32_t count = 0;
    for (int32_t i = 0; i < f->k; i++) {
        if (f->above[i] > band) continue;
        const fl_vec3 r = v3_sub(c.v[f->at[i]], from);
        out[count++] = (plane_point){sign * v3_dot(t->x, r), sign * v3_dot(t->y, r)};
    }
}

/* True if every triangle of three of the points is higher than h. */
static int triangles_are_high(int32_t n, const plane_point *s, double h)
{
    for (int32_t i = 0; i < n; i++)
        for (int32_t j = 0; j < i; j++) {
            const double x = s[i].x - s[j].x, y = s[i].y - s[j].y, least = h * h * (x * x + y * y);
            for (int32_t k = 0; k < n; k++) {
                const double area = x * (s[k].y - s[j].y) - y * (s[k].x - s[j].x);
                if (k != i && k != j && !(area * area > least)) return 0;
            }
        }
    return 1;
}

/* Extends the range of points along (x, y), forwards and backwards. */
static void extend_range(int32_t n, const plane_point *s, double x, double y, double *along, double *against)
{
    double high = x * s[0].x + y * s[0].y, low = high;
    for (int32_t i = 1; i < n; i++) {
        const double t = x * s[i].x + y * s[i].y;
        high = t > high ? t : high;
        low = t < low ? t : low;
    }
    *along += high;
    *against -= low;
}

/* For polygons P and -Q: true if P - Q extends farther than r from the origin across every side of P and Q,
 * or if it is thinner than w across one side, both ways. */
static int difference_contains_disc(const int32_t *k, plane_point (*s)[PLANE_MAX], double r, double w)
{
    int far = 1;
    for (int side = 0; side < 2; side++)
        for (int32_t i = 0; i < k[side]; i++)
            for (int32_t j = 0; j < i; j++) {
                const double ex = s[side][i].x - s[side][j].x, ey = s[side][i].y - s[side][j].y,
                             ee = ex * ex + ey * ey;
                if (!(ee > 0.0)) continue;
                double one = 0.0, two = 0.0;
                extend_range(k[side], s[side], ey, -ex, &one, &two);
                extend_range(k[!side], s[!side], ey, -ex, &one, &two);
                const double less = one < two ? one : two, more = one < two ? two : one;
                if (more * more < w * w * ee) return 1;
                far &= less > 0.0 && less * less > r * r * ee;
            }
    return far;
}

/* True if rounding leaves n as it is. Seen along n the vertices on the planes form two polygons P and Q; the
 * closest points are the origin, which lies in their difference P - Q.  A plane tilted by t has vertices
 * beyond it by t rho, rho the radius of the largest disc about the origin in P - Q; heights known to within u
 * allow a tilt of u/rho.  rho is the least extent of P - Q across any side of P and Q.
 * - A vertex over a polygon is also firm near the rim, where n changes to that of the rim without a jump, if
 *   three corners of the polygon tilt by no more than u over the height of their triangle.
 * - A vertex and a triangle, or two edges, span a plane that their formula has exactly; there the closest
 *   points only have to lie inside.
 * - Vertex and vertex, vertex and edge have nothing to tilt about beyond their formulae; neither have edges
 *   and faces on one line to within a fraction of d. */
static int normal_is_firm(const core_pair *p, const planes *f, const fl_gap *out, double beyond)
{
    if (f->a.k + f->b.k <= 3) return 1;
    if (uses_whole_core(f)) return 0;
    const double on = ON_PLANE_BAND * p->size;
    const int32_t k[2] = {count_on_plane(&f->a, on), count_on_plane(&f->b, on)};
    if (k[0] + k[1] <= 3) return 1;
    plane_point s[2][PLANE_MAX];
    plane_axes t = {.x = v3_normal_to(out->n)};
    t.y = v3_cross(out->n, t.x);
    /* A vertex has no rounding of world coordinates; a foot has, and far from the origin it dominates. */
    const int vertex = out->na == 1 || out->nb == 1;
    const fl_vec3 o = out->na == 1 ? out->pa : out->pb;
    project_vertices(p->a, &t, on, &f->a, vertex ? o : out->pa, 1.0, s[0]);
    project_vertices(p->b, &t, on, &f->b, o, -1.0, s[1]);
    const double coarse = vertex ? 0.0 : WORLD_ROUNDING * v3_norm(o),
                 uneven = (beyond + FLATNESS_ROUNDING * p->size) / FIRM_ANGLE;
    if ((k[0] == 1 || k[1] == 1) && triangles_are_high(k[k[0] == 1], s[k[0] == 1], uneven)) return 1;
    return difference_contains_disc(k, s, coarse + (k[0] + k[1] == 4 ? POINT_ROUNDING * p->size : uneven),
                                    THIN_OUTLINE * out->d);
}

/* Stage 3 for the direction n; h[2]: heights along it, or NULL.  The result is accepted when the planes
 * across its own direction have the same vertices as it was made from, so it is a function of them.  The
 * first n in doubles may be off by 1e-8, since the distance alone does not determine it better; then the
 * improved n is used.  Returns 0 when more bits are needed. */
static int finish_from_planes(const core_pair *p, fl_vec3 n, const fl_support_heights *h,
                              const fl_simplex *from, int fine, fl_gap *out)
{
    planes f[2];
    int now = 0;
    find_planes(p, n, h, from, &f[now]);
    for (int round = 0;; round++) {
        if (round == ROUNDS || !closest_on_planes(p, &f[now], fine, out)) return 0;
        if (fine) return 1; /* this n was exact to the last bit from the start */
        if (plane_is_stable(p, &f[now], v3_norm(v3_sub(out->n, n)))) {
            update_heights(p->a, out->n, &f[now].a);
            update_heights(p->b, v3_neg(out->n), &f[now].b);
            break;
        }
        now = !now;
        n = out->n;
        find_planes(p, n, NULL, from, &f[now]);
        if (is_same_plane(&f[0].a, &f[1].a) && is_same_plane(&f[0].b, &f[1].b)) break;
    }
    /* Proof: along the final direction no vertex lies beyond the two planes. */
    const double beyond = height_over_plane(p->a, out->n, &f[now].a, out->ia[0]) +
                          height_over_plane(p->b, v3_neg(out->n), &f[now].b, out->ib[0]);
    return beyond <= PROOF_TOL * p->size && normal_is_firm(p, &f[now], out, beyond);
}

/* The result of stage 2, with the vertices of its simplex as features. */
static void keep_dd_result(const core_pair *p, const fl_simplex *s, const fl_gap *own, fl_gap *out)
{
    const fl_subsimplex a = subsimplex_of(p->a, s->n, s->a, NULL), b = subsimplex_of(p->b, s->n, s->b, NULL);
    *out = *own;
    out->na = a.n;
    out->nb = b.n;
    for (int32_t k = 0; k < a.n; k++) out->ia[k] = a.i[k];
    for (int32_t k = 0; k < b.n; k++) out->ib[k] = b.i[k];
}

static void store_simplex(fl_gjk_cache *cache, const fl_simplex *s)
{
    if (!cache) return;
    cache->n = s->n;
    for (int32_t k = 0; k < s->n; k++) {
        cache->a[k] = s->a[k];
        cache->b[k] = s->b[k];
    }
}

void fl_gjk(fl_core a, fl_core b, fl_gjk_cache *cache, fl_gap *out)
{
    const core_pair p = {a, b, fl_core_extent(a) + fl_core_extent(b)};
    fl_simplex s;
    fl_support_heights h[2];
    fl_vec3 n;
    *out = (fl_gap){0};
    fl_simplex_start(&s, a, b, cache);
    if (!fl_gjk_double(a, b, p.size, &s, &n, h, &out->iterations) ||
        !finish_from_planes(&p, n, h, &s, 0, out)) {
        *out = (fl_gap){.iterations = out->iterations};
        if (!fl_gjk_dd(a, b, p.size, &s, out)) {
            /* Doubles first here too, wherever they may do: the bits must not show which path was taken.
             * Stage 2's own result is kept if the sub-simplices of the closest features all degenerate, or if
             * their distance is larger; if the vertices on the planes overlap, the cores do. */
            const fl_gap own = *out;
            if (!(own.d > FL_GJK_DD_BELOW * p.size && finish_from_planes(&p, own.n, NULL, &s, 0, out)) &&
                (!finish_from_planes(&p, own.n, NULL, &s, 1, out) ||
                 out->d > own.d + DISTANCE_TOL * (p.size + own.d)) &&
                !out->overlap)
                keep_dd_result(&p, &s, &own, out);
        }
    }
    store_simplex(cache, &s);
}

int fl_gjk_direction(fl_core a, fl_core b, fl_gjk_cache *cache, fl_vec3 *n)
{
    fl_simplex s;
    fl_support_heights h[2];
    int32_t steps = 0;
    fl_simplex_start(&s, a, b, cache);
    const int found = fl_gjk_double(a, b, fl_core_extent(a) + fl_core_extent(b), &s, n, h, &steps);
    store_simplex(cache, &s);
    return found;
}
