/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "patch/cone.h"
#include <math.h>
#include "patch/cone_face.h"
#include "patch/cone_sum.h"
#include "geom/quadrature_rules.h"
#include "patch/cone_side.h"
#include "patch/edge_integral.h"
#include "patch/patch_law.h"

/* Most pieces of an edge: two for each threefold growth up to 1e9, and a few. */
enum { MAX_PIECES = 64 };

/* An edge that extends farther than this from its point nearest to the axis, over the distance of that point,
 * is split into pieces that grow away from it: the distance has a branch point that far from the real axis.
 */
#define FAR_EDGE 0.25

/* Shortest piece over the length of the edge, where it meets the axis; it bounds the number of pieces. */
#define SHORTEST_PIECE 1e-9

double fl_cone_support(const fl_truncated_cone *c, fl_vec3 n)
{
    const double across = sqrt(n.x * n.x + n.y * n.y);
    return fmax(across * c->r0, n.z * c->h + across * c->r1);
}

/* Adds a piece of an edge beside the slant side; q->o is the middle of the edge. */
static void add_side_piece(fl_cone_sums *q, const fl_cone_profile *c, fl_vec3 u, const fl_cone_side_edge *p)
{
    fl_cone_side_edge_sums r;
    fl_cone_side_sum_edge(p, &r);
    const double length = v3_dot(q->x, u);
    q->u += r.u, q->du += r.du, q->ddu += r.ddu, q->ds += r.ds;
    q->most = r.most > q->most ? r.most : q->most;
    q->sx += length * r.dt, q->sxx += length * length * r.dtt;
    /* sums of d n and of d n t; o: radial vector of the middle, a: radial part of u */
    const fl_vec3 o = v3(q->o.x, q->o.y, 0), a = v3(u.x, u.y, 0), nz = v3(0, 0, c->nz);
    const fl_vec3 f = v3_madd(v3_scale(c->nr, v3_madd(v3_scale(r.dq, o), r.dqt, a)), r.du, nz);
    const fl_vec3 ft = v3_madd(v3_scale(c->nr, v3_madd(v3_scale(r.dqt, o), r.dqtt, a)), r.dt, nz);
    q->f = v3_add(q->f, f);
    q->m = v3_add(q->m, v3_cross(u, ft));
}

static void add_general_piece(fl_cone_sums *q, const fl_cone_profile *c, fl_vec3 a, fl_vec3 u, double factor,
                              double from, double width, const int zero[2])
{
    for (int k = 0; k < FL_LINE10_NODES; k++) {
        double t;
        const double dt = fl_cone_cluster_node(FL_LINE10_NODE[k], zero, &t);
        const fl_vec3 at = v3_madd(a, from + t * width, u);
        const double rho = sqrt(at.x * at.x + at.y * at.y);
        const fl_cone_profile_field d = fl_cone_profile_distance(c, rho, at.z);
        const double s = c->R - d.d;
        if (!(s > 0.0)) continue;
        const fl_vec3 er = fl_cone_radial_direction(at, rho), n = v3(d.mr * er.x, d.mr * er.y, d.mz);
        const double g = factor * FL_LINE10_WEIGHT[k] * dt * width * sqrt(s) * s * s;
        fl_cone_sum_add(q, at, n, s, g * s * s, 4.5 * g * s, 15.75 * g);
    }
}

typedef struct {
    const fl_cone_profile *c;
    fl_vec3 a, u;
} edge_line;

static int zone_on_edge(const void *what, double t)
{
    const edge_line *r = what;
    const fl_vec3 at = v3_madd(r->a, t, r->u);
    return fl_cone_profile_distance(r->c, sqrt(at.x * at.x + at.y * at.y), at.z).zone;
}

/* True if the slant side is nearest from t = lo to hi, inside the cone too. */
static int side_is_nearest(const fl_cone_profile *c, const fl_cone_profile_line *l, double lo, double hi)
{
    const double z0 = l->z0 + lo * l->dz, z1 = l->z0 + hi * l->dz, far = c->R * fabs(c->nz);
    const double low = fmin(z0, z1), high = fmax(z0, z1),
                 rho = sqrt(fmax(fl_cone_line_min_radius2(l, lo, hi), 0.0));
    const double out = c->nr * (rho - c->r0) + fmin(c->nz * z0, c->nz * z1);
    return low >= far && high <= c->h - far && out > -low && out > high - c->h;
}

static double overlap_on_side(const fl_cone_side_edge *p, double t)
{
    return p->s0 + t * p->s1 - p->nr * sqrt(fmax(p->a + t * (2.0 * p->b + t * p->g), 0.0));
}

/* Splits an edge from lo to hi along the side so that Gauss' rule converges on each piece: at the point
 * nearest to the axis and at distances from it that grow threefold, where the edge extends far.  Else in the
 * middle, where s = 0 at both ends. */
static int32_t split_on_side(const fl_cone_profile_line *l, double lo, double hi, int both,
                             double at[MAX_PIECES])
{
    int32_t n = 0;
    at[n++] = lo, at[n++] = hi;
    if (l->g > 0.0) {
        const double nearest = -l->b / l->g, apart = sqrt(fmax(l->a + nearest * l->b, 0.0) / l->g);
        const double longest = fmax(hi - nearest, nearest - lo);
        if (longest > FAR_EDGE * apart && nearest > lo && nearest < hi) at[n++] = nearest;
        for (double d = fmax(apart, SHORTEST_PIECE * longest); d < longest && longest > FAR_EDGE * apart;
             d *= 3.0) {
            if (nearest + d < hi - 0.2 * d && nearest + d > lo + 0.2 * d) at[n++] = nearest + d;
            if (nearest - d > lo + 0.2 * d && nearest - d < hi - 0.2 * d) at[n++] = nearest - d;
        }
    }
    if (n == 2 && both) at[n++] = 0.5 * (lo + hi);
    fl_cone_sort_ascending(at, n);
    return n;
}

static int add_edge(fl_patch_points *w, const fl_patch_core *A, int32_t e, const fl_cone_profile *c)
{
    static const double CLUSTER[2][2][3] = {{{1, 0, 0}, {2, -1, 0}},
                                            {{0, 1, 0}, {0, 3, -2}}}; /* as fl_cone_cluster_node() */
    const fl_edge g = A->p->edge[e];
    const fl_vec3 a = A->v[g.a], u = v3_sub(A->v[g.b], a);
    const fl_cone_profile_line l = fl_cone_profile_line_of(a, u);
    double lo = 0.0, hi = 1.0, at[MAX_PIECES];
    int zero[2];
    if (!fl_cone_profile_clip(c, &l, &lo, &hi, zero)) return 0;
    const double factor = fl_edge_integral_factor(A, e, 0.0);
    if (!(factor > 0.0)) return 0;
    const double middle = 0.5 * (lo + hi);
    fl_cone_sums q = {.o = v3_madd(a, middle, u), .x = v3_unit(u)};
    if (side_is_nearest(c, &l, lo, hi)) {
        fl_cone_side_edge p = {.a = l.a,
                               .b = l.b,
                               .g = l.g,
                               .s0 = c->R + c->nr * c->r0 - c->nz * l.z0,
                               .s1 = -c->nz * l.dz,
                               .nr = c->nr};
        p.middle = middle, p.factor = factor;
        const double s[3] = {overlap_on_side(&p, lo), overlap_on_side(&p, middle), overlap_on_side(&p, hi)};
        fl_cone_mark_zero_ends(s, zero);
        const int32_t n = split_on_side(&l, lo, hi, zero[0] && zero[1], at);
        for (int32_t k = 0; k + 1 < n; k++) {
            const double *cluster = CLUSTER[zero[0] && k == 0][zero[1] && k + 2 == n];
            p.from = at[k], p.width = at[k + 1] - at[k];
            p.c[0] = cluster[0], p.c[1] = cluster[1], p.c[2] = cluster[2];
            add_side_piece(&q, c, u, &p);
        }
        return fl_cone_sum_to_points(w, &q, 2, A->r);
    }
    int32_t n = fl_cone_profile_breaks(c, &l, lo, hi, at);
    at[n++] = lo, at[n++] = hi;
    if (zero[0] && zero[1]) at[n++] = middle;
    fl_cone_sort_ascending(at, n);
    const edge_line r = {c, a, u};
    for (int32_t k = 0; k + 1 < n; k++) {
        fl_cone_intervals parts;
        fl_cone_split_interval(&parts, zone_on_edge, &r, at[k], at[k + 1]);
        for (int s = 0; s < parts.n; s++) {
            const int ends[2] = {zero[0] && k == 0 && s == 0, zero[1] && k + 2 == n && s + 1 == parts.n};
            add_general_piece(&q, c, a, u, factor, parts.s[s].from, parts.s[s].to - parts.s[s].from, ends);
        }
    }
    return fl_cone_sum_to_points(w, &q, 2, A->r);
}

int fl_cone_evaluate(fl_patch_points *w, const fl_poly *a, const fl_truncated_cone *solid, double ra)
{
    const fl_patch_core A = {a, w->va, w->na, ra, 1.0};
    const fl_cone_profile c = fl_cone_profile_of(solid, ra);
    for (int32_t v = 0; v < a->nv; v++) {
        const double rho = sqrt(w->va[v].x * w->va[v].x + w->va[v].y * w->va[v].y);
        const fl_cone_profile_field d = fl_cone_profile_distance(&c, rho, w->va[v].z);
        const fl_vec3 er = fl_cone_radial_direction(w->va[v], rho);
        if (d.d < ra &&
            fl_patch_points_add_vertex(w, &A, 0.0, v, v3(d.mr * er.x, d.mr * er.y, d.mz), ra - d.d))
            return -1;
    }
    for (int32_t e = 0; e < a->ne; e++)
        if (add_edge(w, &A, e, &c)) return -1;
    for (int32_t F = 0; F < a->nf; F++)
        if (fl_cone_face_evaluate(w, &A, F, &c)) return -1;
    return 0;
}
