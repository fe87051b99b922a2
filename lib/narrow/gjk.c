/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "narrow/gjk.h"
#include <stddef.h>
#include "narrow/descent.h"
#include "narrow/fine.h"
#include "narrow/parts.h"

/* Who belongs to a supporting plane, in extents of the pair.  A hundred times the 1e-12 that doubles may
 * leave in n at FL_FINE_BELOW, so that the true nearest feature is always among them. */
#define PLANE_BAND 1e-10

/* A direction found in doubles is taken when no vertex lies beyond its planes by more than this, in
 * extents: the rounding of two heights, and of a direction that has lost a digit (parts.c). */
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

/* Distances in pairs of doubles, found in two ways, agree far better, in extents. */
#define FARTHER 1e-14

/* Vertices of a supporting plane that are copied out; cores with more (the end of a fine cylinder) take
 * part whole. */
enum { PLANE_MAX = 64, ROUNDS = 4 };

typedef struct {
    fl_core a, b;
    double ea, eb, size; /* extents and their sum */
} pair;

/* The vertices of c within band of its lowest along n, ascending; PLANE_MAX + 1 for more than PLANE_MAX.
 * *low is the height of the lowest over vertex 0. */
static int32_t plane_of(fl_core c, fl_vec3 n, double band, int32_t *at, double *low)
{
    double height[PLANE_MAX];
    int32_t k = 0;
    if (c.n <= PLANE_MAX) { /* each height once */
        *low = height[0] = 0.0;
        for (int32_t i = 1; i < c.n; i++) height[i] = v3_dot(n, v3_sub(c.v[i], c.v[0]));
        for (int32_t i = 1; i < c.n; i++) *low = height[i] < *low ? height[i] : *low;
        for (int32_t i = 0; i < c.n; i++)
            if (height[i] <= *low + band) at[k++] = i;
        return k;
    }
    fl_core_lowest(c, n, low);
    for (int32_t i = 0; i < c.n; i++)
        if (v3_dot(n, v3_sub(c.v[i], c.v[0])) <= *low + band) {
            if (k == PLANE_MAX) return PLANE_MAX + 1;
            at[k++] = i;
        }
    return k;
}

/* The vertices at[0 .. k) of c, sorted, each once; map gives their numbers in the whole core. */
static fl_part part_of(fl_core c, int32_t k, const int32_t *at, const int32_t *map)
{
    fl_part f = {.n = 0};
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

/* The vertices on the two supporting planes across n, and the cores that they make. */
typedef struct {
    int32_t ka, kb, at[PLANE_MAX], bt[PLANE_MAX];
    double low_a, low_b; /* heights of the planes over vertices 0 along n and -n */
} planes;

static void find_planes(const pair *p, fl_vec3 n, planes *f)
{
    const double band = PLANE_BAND * p->size;
    f->ka = plane_of(p->a, n, band, f->at, &f->low_a);
    f->kb = plane_of(p->b, v3_neg(n), band, f->bt, &f->low_b);
}

static int same_planes(const planes *f, const planes *g)
{
    if (f->ka != g->ka || f->kb != g->kb) return 0;
    for (int32_t k = 0; k < f->ka && f->ka <= PLANE_MAX; k++)
        if (f->at[k] != g->at[k]) return 0;
    for (int32_t k = 0; k < f->kb && f->kb <= PLANE_MAX; k++)
        if (f->bt[k] != g->bt[k]) return 0;
    return 1;
}

/* Nearest points from the vertices on the planes alone.  1, or 0 when more bits are needed. */
static int answer_on(const pair *p, const planes *f, int fine, fl_gap *out)
{
    static const int32_t first[3] = {0, 1, 2};
    fl_vec3 va[PLANE_MAX], vb[PLANE_MAX];
    const int whole = f->ka > PLANE_MAX || f->kb > PLANE_MAX;
    fl_core a = p->a, b = p->b;
    if (!whole) {
        for (int32_t k = 0; k < f->ka; k++) va[k] = a.v[f->at[k]];
        for (int32_t k = 0; k < f->kb; k++) vb[k] = b.v[f->bt[k]];
        a = (fl_core){va, f->ka};
        b = (fl_core){vb, f->kb};
    }
    fl_simplex s = {.n = 0};
    const int direct = a.n <= 3 && b.n <= 3 && a.n + b.n <= 4;
    if (!direct) {
        fl_vec3 v;
        fl_simplex_start(&s, a, b, NULL);
        if (fine ? fl_fine_descend(a, b, p->size, &s, out)
                 : !fl_descend(a, b, p->size, &s, &v, &out->iterations))
            return 0;
    }
    const fl_part fa = part_of(a, direct ? a.n : s.n, direct ? first : s.a, whole ? NULL : f->at),
                  fb = part_of(b, direct ? b.n : s.n, direct ? first : s.b, whole ? NULL : f->bt);
    return fl_parts_nearest(&fa, &fb, p->size, fine, out);
}

/* A vertex on a plane, in two axes across n, from the nearest point of its core. */
typedef struct {
    double x, y;
} spot;

/* Two axes across n. */
typedef struct {
    fl_vec3 x, y;
} axes;

/* Those of the vertices at[0 .. k) that lie on the plane of height low along n itself. */
static int32_t spots_of(fl_core c, fl_vec3 n, const axes *t, double low, double band, int32_t k,
                        const int32_t *at, fl_vec3 from, spot *out)
{
    int32_t count = 0;
    for (int32_t i = 0; i < k; i++) {
        if (v3_dot(n, v3_sub(c.v[at[i]], c.v[0])) > low + band) continue;
        const fl_vec3 r = v3_sub(c.v[at[i]], from);
        out[count++] = (spot){v3_dot(t->x, r), v3_dot(t->y, r)};
    }
    return count;
}

/* How far the spots reach along (x, y). */
static double reach(int32_t n, const spot *s, double x, double y)
{
    double most = -INFINITY;
    for (int32_t i = 0; i < n; i++) {
        const double t = x * s[i].x + y * s[i].y;
        most = t > most ? t : most;
    }
    return most;
}

/* The least height of a triangle of three of the spots; 0 when two coincide. */
static double least_height(int32_t n, const spot *s)
{
    double least = INFINITY;
    for (int32_t i = 0; i < n; i++)
        for (int32_t j = 0; j < i; j++) {
            const double x = s[i].x - s[j].x, y = s[i].y - s[j].y, len = sqrt(x * x + y * y);
            for (int32_t k = 0; k < n; k++) {
                if (k == i || k == j) continue;
                const double area = fabs(x * (s[k].y - s[j].y) - y * (s[k].x - s[j].x));
                if (!(area > least * len)) least = len > 0.0 ? area / len : 0.0;
            }
        }
    return least;
}

/* How far P - Q, where Q is given as -Q, reaches about the origin across the sides of P and Q: the least
 * over them, and the lesser of the wider ways of each. */
static void least_reach(const int32_t *k, spot (*s)[PLANE_MAX], double *least, double *width)
{
    *least = *width = INFINITY;
    for (int side = 0; side < 2; side++)
        for (int32_t i = 0; i < k[side]; i++)
            for (int32_t j = 0; j < i; j++) {
                const double ex = s[side][i].x - s[side][j].x, ey = s[side][i].y - s[side][j].y,
                             len = sqrt(ex * ex + ey * ey);
                if (!(len > 0.0)) continue;
                const double x = ey / len, y = -ex / len;
                const double one = reach(k[0], s[0], x, y) + reach(k[1], s[1], x, y),
                             two = reach(k[0], s[0], -x, -y) + reach(k[1], s[1], -x, -y);
                *least = fmin(*least, fmin(one, two));
                *width = fmin(*width, fmax(one, two));
            }
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
static int stands_firm(const pair *p, const planes *g, const fl_gap *out, double beyond)
{
    spot s[2][PLANE_MAX];
    int32_t k[2];
    if (g->ka + g->kb <= 3) return 1;
    if (g->ka > PLANE_MAX || g->kb > PLANE_MAX) return 0;
    const double on = ON_PLANE * p->size;
    axes t = {.x = v3_normal_to(out->n)};
    t.y = v3_cross(out->n, t.x);
    /* A vertex has no rounding of world coordinates, which that of a foot is above any other far off. */
    const int vertex = out->na == 1 || out->nb == 1;
    const fl_vec3 o = out->na == 1 ? out->pa : out->pb;
    k[0] = spots_of(p->a, out->n, &t, g->low_a, on, g->ka, g->at, vertex ? o : out->pa, s[0]);
    k[1] = spots_of(p->b, v3_neg(out->n), &t, g->low_b, on, g->kb, g->bt, o, s[1]);
    if (k[0] + k[1] <= 3 && k[0] <= 2 && k[1] <= 2) return 1;
    const double coarse = vertex ? 0.0 : WORLD * v3_norm(o), uneven = (beyond + UNEVEN * p->size) / FIRM;
    if ((k[0] == 1 || k[1] == 1) && least_height(k[k[0] == 1], s[k[0] == 1]) > uneven) return 1;
    for (int32_t i = 0; i < k[1]; i++) s[1][i] = (spot){-s[1][i].x, -s[1][i].y};
    double least, width;
    least_reach(k, s, &least, &width);
    return width < THIN * out->d || least > coarse + (k[0] + k[1] == 4 ? INSIDE * p->size : uneven);
}

/* Stage 3 for the direction n.  The answer stands when along its own direction the same vertices lie on the
 * planes as it was made from, so that it is a function of them; a first n in doubles may be off by 1e-8,
 * since distances alone cannot tell, and then the better one that it leads to is used.  Returns 1, or 0
 * when more bits are needed. */
static int settle(const pair *p, fl_vec3 n, int fine, fl_gap *out)
{
    planes f, g;
    find_planes(p, n, &f);
    for (int round = 0; round < ROUNDS; round++) {
        if (!answer_on(p, &f, fine, out)) return 0;
        if (fine) return 1; /* this n was right to the last place to begin with */
        find_planes(p, out->n, &g);
        if (same_planes(&f, &g)) break;
        if (round == ROUNDS - 1) return 0;
        f = g;
    }
    /* The proof: along the final direction no vertex at all lies beyond the two planes. */
    const double beyond = v3_dot(out->n, v3_sub(p->a.v[out->ia[0]], p->a.v[0])) - g.low_a -
                          v3_dot(out->n, v3_sub(p->b.v[out->ib[0]], p->b.v[0])) - g.low_b;
    return beyond <= PROOF * p->size && stands_firm(p, &g, out, beyond > 0.0 ? beyond : 0.0);
}

void fl_gjk(fl_core a, fl_core b, fl_gjk_cache *cache, fl_gap *out)
{
    pair p = {a, b, fl_core_extent(a), fl_core_extent(b), 0.0};
    fl_simplex s;
    fl_vec3 v;
    p.size = p.ea + p.eb;
    *out = (fl_gap){0};
    fl_simplex_start(&s, a, b, cache);
    if (!fl_descend(a, b, p.size, &s, &v, &out->iterations) || !settle(&p, v3_unit(v), 0, out)) {
        *out = (fl_gap){.iterations = out->iterations};
        if (!fl_fine_descend(a, b, p.size, &s, out)) {
            /* Doubles first here too, wherever they might do: which road was taken must not show in the
             * bits. Should the parts of the nearest features all degenerate, the walk's own answer is
             * kept, as it is should they come out farther apart; should the vertices on the planes meet,
             * the cores do. */
            const fl_gap own = *out;
            if (!(own.d > FL_FINE_BELOW * p.size && settle(&p, own.n, 0, out)) &&
                (!settle(&p, own.n, 1, out) || out->d > own.d + FARTHER * p.size) && !out->overlap)
                *out = own;
        }
    }
    if (cache) {
        cache->n = s.n;
        for (int32_t k = 0; k < s.n; k++) {
            cache->a[k] = s.a[k];
            cache->b[k] = s.b[k];
        }
    }
}
