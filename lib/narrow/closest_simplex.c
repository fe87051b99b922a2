/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "narrow/closest_simplex.h"
#include <float.h>
#include <math.h>
#include "geom/dd.h"

/* sin^2 of the angle below which a cross product in doubles loses two digits. */
#define NEARLY_PARALLEL 1e-4
/* (d / u)^2 below which the foot of a vertex on an edge loses a digit of the direction to rounding. */
#define NEARLY_TOUCHING 1e-2

typedef struct {
    const fl_subsimplex *a, *b;
    int fine, found;
    double enough, slack; /* slack that is rounding; slack of *out */
    fl_gap *out;
} candidate_search;

typedef struct {
    fl_ddv m; /* fine only: along n, of any length */
    double d;
    fl_vec3 n, pa, pb;
} candidate;

/* By division, not by a reciprocal: a direction along an axis comes out exact. */
static fl_vec3 divide_vector(fl_vec3 a, double d) { return v3(a.x / d, a.y / d, a.z / d); }

static fl_ddv negate_vector(fl_ddv a) { return (fl_ddv){dd_neg(a.x), dd_neg(a.y), dd_neg(a.z)}; }

static fl_ddv to_dd(fl_vec3 v) { return (fl_ddv){dd_of(v.x), dd_of(v.y), dd_of(v.z)}; }

/* Height of p over q along the candidate's normal. */
static double height_of(const candidate_search *s, const candidate *c, fl_vec3 p, fl_vec3 q)
{
    return s->fine ? ddv_dot(c->m, ddv_diff(p, q)).h : v3_dot(c->n, v3_sub(p, q));
}

static double slack_of(const candidate_search *s, const int32_t *ka, const int32_t *kb, const candidate *c)
{
    double sa = 0.0, sb = 0.0;
    for (int32_t k = 0; k < s->a->n; k++) {
        const double t = height_of(s, c, s->a->v[ka[0]], s->a->v[k]);
        sa = t > sa ? t : sa;
    }
    for (int32_t k = 0; k < s->b->n; k++) {
        const double t = height_of(s, c, s->b->v[k], s->b->v[kb[0]]);
        sb = t > sb ? t : sb;
    }
    return s->fine ? (sa + sb) / v3_norm(ddv_round(c->m)) : sa + sb;
}

static void take_candidate(candidate_search *s, int32_t na, const int32_t *ka, int32_t nb, const int32_t *kb,
                           const candidate *c)
{
    if (!(c->d > 0.0) || !isfinite(c->d)) return;
    const double slack = slack_of(s, ka, kb, c);
    if (s->found && !(slack < s->slack)) return;
    s->slack = slack;
    s->found = 1;
    fl_gap *g = s->out;
    g->d = c->d;
    g->n = c->n;
    g->pa = c->pa;
    g->pb = c->pb;
    g->na = na;
    g->nb = nb;
    for (int32_t k = 0; k < 3; k++) {
        g->ia[k] = k < na ? s->a->i[ka[k]] : 0;
        g->ib[k] = k < nb ? s->b->i[kb[k]] : 0;
    }
}

/* A candidate of a vertex and a sub-simplex of the other core; swapped: the vertex is b's. */
static void take_vertex_candidate(candidate_search *s, int32_t i, int32_t n, const int32_t *k, int swapped,
                                  candidate c, fl_vec3 p, fl_vec3 foot)
{
    c.pa = swapped ? foot : p;
    c.pb = swapped ? p : foot;
    if (swapped) {
        c.n = v3_neg(c.n);
        c.m = negate_vector(c.m);
    }
    if (swapped) take_candidate(s, n, k, 1, &i, &c);
    else take_candidate(s, 1, &i, n, k, &c);
}

static void try_points(candidate_search *s, int32_t i, int32_t j)
{
    const fl_vec3 p = s->a->v[i], q = s->b->v[j], w = v3_sub(p, q);
    const double d = v3_norm(w);
    if (!(d > 0.0)) return;
    candidate c = {.d = d, .n = divide_vector(w, d), .pa = p, .pb = q};
    if (s->fine) c.m = ddv_diff(p, q);
    take_candidate(s, 1, &i, 1, &j, &c);
}

static void try_vertex_edge(candidate_search *s, int32_t i, const int32_t *e, int swapped)
{
    const fl_subsimplex *pt = swapped ? s->b : s->a, *eg = swapped ? s->a : s->b;
    const fl_vec3 p = pt->v[i];
    fl_vec3 e0 = eg->v[e[0]], e1 = eg->v[e[1]];
    /* From the nearer end the offset is the smaller part of the difference that it is subtracted from. */
    if (v3_norm2(v3_sub(p, e1)) < v3_norm2(v3_sub(p, e0))) {
        e0 = e1;
        e1 = eg->v[e[0]];
    }
    const fl_vec3 u = v3_sub(p, e0), l = v3_sub(e1, e0);
    const double ll = v3_norm2(l);
    if (!(ll > 0.0)) return;
    double t = v3_dot(u, l) / ll;
    fl_vec3 w = v3_madd(u, -t, l);
    candidate c = {.d = 0.0};
    if (s->fine || v3_norm2(w) < NEARLY_TOUCHING * v3_norm2(u)) {
        const fl_ddv uu = ddv_diff(p, e0), le = ddv_diff(e1, e0);
        const fl_dd tt = dd_div(ddv_dot(uu, le), ddv_dot(le, le));
        const fl_ddv ww = ddv_madd(uu, dd_neg(tt), le);
        t = tt.h;
        w = ddv_round(ww);
        c.m = ww;
    }
    if (!(t > 0.0 && t < 1.0)) return;
    c.d = v3_norm(w);
    if (!(c.d > 0.0)) return;
    c.n = divide_vector(w, c.d);
    take_vertex_candidate(s, i, 2, e, swapped, c, p, v3_madd(e0, t, l));
}

/* Common normal m of e and g, of the length of e x g, oriented so that the height h of x - y along it, c->d,
 * is positive.  Returns 0 where there is none. */
static int common_normal(const candidate_search *s, fl_vec3 e1, fl_vec3 e0, fl_vec3 g1, fl_vec3 g0, fl_vec3 x,
                         fl_vec3 y, fl_ddv *m, candidate *c)
{
    const fl_vec3 e = v3_sub(e1, e0), g = v3_sub(g1, g0), p = v3_cross(e, g);
    double h;
    if (!s->fine && v3_norm2(p) > NEARLY_PARALLEL * v3_norm2(e) * v3_norm2(g)) {
        *m = to_dd(p);
        c->n = divide_vector(p, v3_norm(p));
        h = v3_dot(c->n, v3_sub(x, y));
    } else {
        *m = ddv_cross(ddv_diff(e1, e0), ddv_diff(g1, g0));
        const double len = v3_norm(ddv_round(*m));
        if (!(len > 0.0)) return 0;
        const fl_dd high = ddv_dot(*m, ddv_diff(x, y));
        c->n = divide_vector(ddv_round(*m), len);
        h = high.h / len;
    }
    c->d = fabs(h);
    if (h < 0.0) c->n = v3_neg(c->n);
    if (s->fine) c->m = h < 0.0 ? negate_vector(*m) : *m;
    return h != 0.0;
}

/* Sign of m.(e x g); exact to the last bit if fine. */
static double triple_product(const candidate_search *s, fl_ddv m, fl_vec3 e1, fl_vec3 e0, fl_vec3 g1,
                             fl_vec3 g0)
{
    if (s->fine) return ddv_dot(m, ddv_cross(ddv_diff(e1, e0), ddv_diff(g1, g0))).h;
    return v3_dot(ddv_round(m), v3_cross(v3_sub(e1, e0), v3_sub(g1, g0)));
}

static void try_vertex_triangle(candidate_search *s, int32_t i, int swapped)
{
    static const int32_t all[3] = {0, 1, 2};
    const fl_vec3 p = (swapped ? s->b : s->a)->v[i], *t = (swapped ? s->a : s->b)->v;
    fl_ddv m;
    candidate c = {.d = 0.0};
    if (!common_normal(s, t[1], t[0], t[2], t[0], p, t[0], &m, &c)) return;
    for (int32_t k = 0; k < 3; k++)
        if (!(triple_product(s, m, t[(k + 1) % 3], t[k], p, t[k]) > 0.0)) return;
    /* Project back onto the triangle: the rounding of d moves the foot off it. */
    const fl_vec3 foot = v3_madd(p, -c.d, c.n);
    take_vertex_candidate(s, i, 3, all, swapped, c, p, v3_madd(foot, -v3_dot(c.n, v3_sub(foot, t[0])), c.n));
}

static fl_vec3 foot_on_segment(fl_vec3 p, fl_vec3 e0, fl_vec3 e1)
{
    const fl_vec3 l = v3_sub(e1, e0);
    const double t = v3_dot(v3_sub(p, e0), l) / v3_norm2(l);
    return v3_madd(e0, t < 0.0 ? 0.0 : t > 1.0 ? 1.0 : t, l);
}

static void try_edges(candidate_search *s, const int32_t *ea, const int32_t *eb)
{
    const fl_vec3 a0 = s->a->v[ea[0]], a1 = s->a->v[ea[1]], b0 = s->b->v[eb[0]], b1 = s->b->v[eb[1]];
    fl_ddv m;
    candidate c = {.d = 0.0};
    if (!common_normal(s, a1, a0, b1, b0, a0, b0, &m, &c)) return;
    /* The lines are closest at a0 + x (a1 - a0) and b0 + y (b1 - b0):
     *     x m.m = m.(lb x (a0 - b0)),   y m.m = m.(la x (a0 - b0));   1 - x and 1 - y from the other ends. */
    const double mm = v3_norm2(ddv_round(m)), x = triple_product(s, m, b1, b0, a0, b0),
                 y = triple_product(s, m, a1, a0, a0, b0);
    if (!(x > 0.0 && y > 0.0)) return;
    if (!(triple_product(s, m, b1, b0, a1, b0) < 0.0 && triple_product(s, m, a1, a0, a0, b1) < 0.0)) return;
    /* On nearly parallel edges this point is uncertain.  So that the two points face each other, each is the
     * foot of the other. */
    const double t = x / mm;
    c.pa = v3_madd(a0, t < 1.0 ? t : 1.0, v3_sub(a1, a0));
    c.pb = foot_on_segment(c.pa, b0, b1);
    c.pa = foot_on_segment(c.pb, a0, a1);
    take_candidate(s, 2, ea, 2, eb, &c);
}

int fl_closest_simplex_points(const fl_subsimplex *a, const fl_subsimplex *b, double size, int fine,
                              fl_gap *out)
{
    static const int32_t side[3][2] = {{0, 1}, {0, 2}, {1, 2}};
    const int32_t na = a->n, nb = b->n, ea = na == 3 ? 3 : na - 1, eb = nb == 3 ? 3 : nb - 1;
    candidate_search s = {.a = a,
                          .b = b,
                          .fine = fine,
                          .enough = fine ? 0.0 : 0.5 * DBL_EPSILON * size,
                          .slack = INFINITY,
                          .out = out};
    /* Higher dimensions first: usually one of them ends the search. */
    for (int32_t i = 0; i < na && nb == 3 && s.slack > s.enough; i++) try_vertex_triangle(&s, i, 0);
    for (int32_t i = 0; i < nb && na == 3 && s.slack > s.enough; i++) try_vertex_triangle(&s, i, 1);
    for (int32_t e = 0; e < ea; e++)
        for (int32_t f = 0; f < eb && s.slack > s.enough; f++) try_edges(&s, side[e], side[f]);
    for (int32_t i = 0; i < na; i++)
        for (int32_t f = 0; f < eb && s.slack > s.enough; f++) try_vertex_edge(&s, i, side[f], 0);
    for (int32_t i = 0; i < nb; i++)
        for (int32_t e = 0; e < ea && s.slack > s.enough; e++) try_vertex_edge(&s, i, side[e], 1);
    for (int32_t i = 0; i < na; i++)
        for (int32_t j = 0; j < nb && s.slack > s.enough; j++) try_points(&s, i, j);
    return s.found;
}
