/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "narrow/gjk.h"
#include <stddef.h>
#include "narrow/gjk_double.h"
#include "narrow/gjk_dd.h"
#include "narrow/closest_simplex.h"

/* Who belongs to a supporting plane, in extents of the pair.  A hundred times the 1e-12 that doubles may
 * leave in n at FL_GJK_DD_BELOW, so that the true nearest feature is always among them. */
#define PLANE_BAND 1e-10

/* A direction found in doubles is taken when no vertex lies beyond its planes by more than this, in
 * extents: the rounding of two heights, and of a direction that has lost a digit (closest_simplex.c). */
#define PROOF 4e-15

/* Vertices within this of the planes, in extents, count as lying on them where it is asked how firmly the
 * planes stand: what a direction turned by FIRM shifts them by, with a margin. */
#define ON_PLANE 4e-12

/* The error of n in doubles that is not worth another look [rad]. */
#define FIRM 5e-13

/* Vertices that lie nearer to one line than this, in distances of the cores, turn n by no more. */
#define THIN 1e-13

/* Rounding of a height and of the coordinates of a turned face, in extents. */
#define UNEVEN 4.5e-16

/* Rounding of where the nearest points lie, in extents, with a margin. */
#define INSIDE 1e-14
/* The same far from the origin, in distances from there. */
#define WORLD 1e-15

/* Distances in pairs of doubles, found in two ways, agree far better, in extents and distances. */
#define FARTHER 1e-14

/* Cores with more vertices on a plane (the end of a fine cylinder) take part whole. */
enum { PLANE_MAX = FL_CORE_SMALL, ROUNDS = 4 };

typedef struct {
    fl_core a, b;
    double size; /* sum of the extents */
} pair;

/* The vertices at[0 .. k) of c, sorted, each once; map gives their numbers in the whole core. */
static fl_subsimplex part_of(fl_core c, int32_t k, const int32_t *at, const int32_t *map)
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

/* The vertices of a core on its supporting plane; k is PLANE_MAX + 1 for more than are listed. */
typedef struct {
    int32_t k, at[PLANE_MAX];
    double above[PLANE_MAX]; /* over the lowest                                */
    double clear;            /* no vertex is as near to the border of the band */
} plane;

/* Both planes across n. */
typedef struct {
    plane a, b;
} planes;

/* from: vertices where to begin to look */
static void find_planes(const pair *p, fl_vec3 n, const fl_support_heights *h, const fl_simplex *from,
                        planes *f)
{
    const double band = PLANE_BAND * p->size;
    f->a.k = fl_core_support_band(p->a, n, h, from->a[0], band, f->a.at, f->a.above, &f->a.clear);
    f->b.k = fl_core_support_band(p->b, v3_neg(n), h ? h + 1 : NULL, from->b[0], band, f->b.at, f->b.above,
                                  &f->b.clear);
}

static int whole(const planes *f) { return f->a.k > PLANE_MAX || f->b.k > PLANE_MAX; }

static int same_plane(const plane *f, const plane *g)
{
    if (f->k != g->k) return 0;
    for (int32_t k = 0; k < f->k && f->k <= PLANE_MAX; k++)
        if (f->at[k] != g->at[k]) return 0;
    return 1;
}

/* Would n turned by so much have the same vertices on its planes?  Two vertices are at most two extents, or
 * the root of 3 of a box, apart. */
static int keeps(const pair *p, const planes *f, double turn)
{
    const double shift = 4.0 * turn * p->size;
    return !whole(f) && f->a.clear > shift && f->b.clear > shift;
}

/* The heights of the vertices on a plane along another n. */
static void measure(fl_core c, fl_vec3 n, plane *f)
{
    double low = INFINITY;
    for (int32_t i = 0; i < f->k; i++) {
        f->above[i] = v3_dot(n, v3_sub(c.v[f->at[i]], c.v[f->at[0]]));
        low = f->above[i] < low ? f->above[i] : low;
    }
    for (int32_t i = 0; i < f->k; i++) f->above[i] -= low;
}

/* How far vertex i is above the plane of its core. */
static double over_plane(fl_core c, fl_vec3 n, const plane *f, int32_t i)
{
    double low;
    for (int32_t k = 0; k < f->k && f->k <= PLANE_MAX; k++)
        if (f->at[k] == i) return f->above[k];
    fl_core_hill_climb(c, n, i, &low);
    return v3_dot(n, v3_sub(c.v[i], c.v[0])) - low;
}

/* Nearest points from the vertices on the planes alone.  1, or 0 when more bits are needed. */
static int answer_on(const pair *p, const planes *f, int fine, fl_gap *out)
{
    static const int32_t first[3] = {0, 1, 2};
    fl_vec3 va[PLANE_MAX], vb[PLANE_MAX];
    const int all = whole(f);
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
    const fl_subsimplex fa = part_of(a, direct ? a.n : s.n, direct ? first : s.a, all ? NULL : f->a.at),
                  fb = part_of(b, direct ? b.n : s.n, direct ? first : s.b, all ? NULL : f->b.at);
    return fl_closest_simplex_points(&fa, &fb, p->size, fine, out);
}

/* A vertex on a plane, in two axes across n, from the nearest point of its core. */
typedef struct {
    double x, y;
} spot;

/* Two axes across n. */
typedef struct {
    fl_vec3 x, y;
} axes;

static int32_t count_on(const plane *f, double band)
{
    int32_t count = 0;
    for (int32_t i = 0; i < f->k; i++) count += f->above[i] <= band;
    return count;
}

/* Those of the vertices of f that lie on the plane itself; sign -1 turns them round. */
static void spots_of(fl_core c, const axes *t, double band, const plane *f, fl_vec3 from, double sign,
                     spot *out)
{
    int32_t count = 0;
    for (int32_t i = 0; i < f->k; i++) {
        if (f->above[i] > band) continue;
        const fl_vec3 r = v3_sub(c.v[f->at[i]], from);
        out[count++] = (spot){sign * v3_dot(t->x, r), sign * v3_dot(t->y, r)};
    }
}

/* Is every triangle of three of the spots higher than h? */
static int are_high(int32_t n, const spot *s, double h)
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

/* How far spots reach along (x, y), most, and against it. */
static void reach(int32_t n, const spot *s, double x, double y, double *along, double *against)
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

/* Of P and -Q: does P - Q reach farther than r from the origin across every side of P and Q, or, thin, less
 * than w across one, both ways? */
static int reaches(const int32_t *k, spot (*s)[PLANE_MAX], double r, double w)
{
    int far = 1;
    for (int side = 0; side < 2; side++)
        for (int32_t i = 0; i < k[side]; i++)
            for (int32_t j = 0; j < i; j++) {
                const double ex = s[side][i].x - s[side][j].x, ey = s[side][i].y - s[side][j].y,
                             ee = ex * ex + ey * ey;
                if (!(ee > 0.0)) continue;
                double one = 0.0, two = 0.0;
                reach(k[side], s[side], ey, -ex, &one, &two);
                reach(k[!side], s[!side], ey, -ex, &one, &two);
                const double less = one < two ? one : two, more = one < two ? two : one;
                if (more * more < w * w * ee) return 1;
                far &= less > 0.0 && less * less > r * r * ee;
            }
    return far;
}

/* Does rounding leave n as it is?  Seen along n the vertices on the planes make two polygons P and Q with the
 * origin, where the nearest points are, in their difference P - Q.  A plane tilted by t finds vertices
 * beyond it by t rho, where rho is the radius of the largest disc about the origin in P - Q; heights known
 * to within u allow a tilt of u / rho.  rho is the least reach of P - Q across any of the sides of P and Q.
 * A vertex over a polygon also stands near the rim, where n passes over into that of the rim without a jump,
 * if three corners of the polygon tilt by no more than u over the height of their triangle. A vertex and a
 * triangle, or two edges, make a plane that their formula has exactly, so there the question is only
 * whether the nearest points lie inside. Vertex and vertex, vertex and edge have nothing to tilt about but
 * what their formulae see; edges and faces that lie on one line to within a part of d neither. */
static int stands_firm(const pair *p, const planes *f, const fl_gap *out, double beyond)
{
    if (f->a.k + f->b.k <= 3) return 1;
    if (whole(f)) return 0;
    const double on = ON_PLANE * p->size;
    const int32_t k[2] = {count_on(&f->a, on), count_on(&f->b, on)};
    if (k[0] + k[1] <= 3) return 1;
    spot s[2][PLANE_MAX];
    axes t = {.x = v3_normal_to(out->n)};
    t.y = v3_cross(out->n, t.x);
    /* A vertex has no rounding of world coordinates, which that of a foot is above any other far off. */
    const int vertex = out->na == 1 || out->nb == 1;
    const fl_vec3 o = out->na == 1 ? out->pa : out->pb;
    spots_of(p->a, &t, on, &f->a, vertex ? o : out->pa, 1.0, s[0]);
    spots_of(p->b, &t, on, &f->b, o, -1.0, s[1]);
    const double coarse = vertex ? 0.0 : WORLD * v3_norm(o), uneven = (beyond + UNEVEN * p->size) / FIRM;
    if ((k[0] == 1 || k[1] == 1) && are_high(k[k[0] == 1], s[k[0] == 1], uneven)) return 1;
    return reaches(k, s, coarse + (k[0] + k[1] == 4 ? INSIDE * p->size : uneven), THIN * out->d);
}

/* Stage 3 for the direction n, along which h[2] has the heights if it is not NULL.  The answer stands when
 * along its own direction the same vertices lie on the planes as it was made from, so that it is a function
 * of them; a first n in doubles may be off by 1e-8, since distances alone cannot tell, and then the better
 * one that it leads to is used.  Returns 1, or 0 when more bits are needed. */
static int settle(const pair *p, fl_vec3 n, const fl_support_heights *h, const fl_simplex *from, int fine,
                  fl_gap *out)
{
    planes f[2];
    int now = 0;
    find_planes(p, n, h, from, &f[now]);
    for (int round = 0;; round++) {
        if (round == ROUNDS || !answer_on(p, &f[now], fine, out)) return 0;
        if (fine) return 1; /* this n was right to the last place to begin with */
        if (keeps(p, &f[now], v3_norm(v3_sub(out->n, n)))) {
            measure(p->a, out->n, &f[now].a);
            measure(p->b, v3_neg(out->n), &f[now].b);
            break;
        }
        now = !now;
        n = out->n;
        find_planes(p, n, NULL, from, &f[now]);
        if (same_plane(&f[0].a, &f[1].a) && same_plane(&f[0].b, &f[1].b)) break;
    }
    /* The proof: along the final direction no vertex at all lies beyond the two planes. */
    const double beyond = over_plane(p->a, out->n, &f[now].a, out->ia[0]) +
                          over_plane(p->b, v3_neg(out->n), &f[now].b, out->ib[0]);
    return beyond <= PROOF * p->size && stands_firm(p, &f[now], out, beyond);
}

/* What the walk in pairs of doubles found, with the vertices of its simplex as features. */
static void own_answer(const pair *p, const fl_simplex *s, const fl_gap *own, fl_gap *out)
{
    const fl_subsimplex a = part_of(p->a, s->n, s->a, NULL), b = part_of(p->b, s->n, s->b, NULL);
    *out = *own;
    out->na = a.n;
    out->nb = b.n;
    for (int32_t k = 0; k < a.n; k++) out->ia[k] = a.i[k];
    for (int32_t k = 0; k < b.n; k++) out->ib[k] = b.i[k];
}

static void keep(fl_gjk_cache *cache, const fl_simplex *s)
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
    const pair p = {a, b, fl_core_extent(a) + fl_core_extent(b)};
    fl_simplex s;
    fl_support_heights h[2];
    fl_vec3 n;
    *out = (fl_gap){0};
    fl_simplex_start(&s, a, b, cache);
    if (!fl_gjk_double(a, b, p.size, &s, &n, h, &out->iterations) || !settle(&p, n, h, &s, 0, out)) {
        *out = (fl_gap){.iterations = out->iterations};
        if (!fl_gjk_dd(a, b, p.size, &s, out)) {
            /* Doubles first here too, wherever they might do: which road was taken must not show in the
             * bits. Should the parts of the nearest features all degenerate, the walk's own answer is
             * kept, as it is should they come out farther apart; should the vertices on the planes meet,
             * the cores do. */
            const fl_gap own = *out;
            if (!(own.d > FL_GJK_DD_BELOW * p.size && settle(&p, own.n, NULL, &s, 0, out)) &&
                (!settle(&p, own.n, NULL, &s, 1, out) || out->d > own.d + FARTHER * (p.size + own.d)) &&
                !out->overlap)
                own_answer(&p, &s, &own, out);
        }
    }
    keep(cache, &s);
}

int fl_gjk_direction(fl_core a, fl_core b, fl_gjk_cache *cache, fl_vec3 *n)
{
    fl_simplex s;
    fl_support_heights h[2];
    int32_t steps = 0;
    fl_simplex_start(&s, a, b, cache);
    const int found = fl_gjk_double(a, b, fl_core_extent(a) + fl_core_extent(b), &s, n, h, &steps);
    keep(cache, &s);
    return found;
}
