/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "narrow/contact.h"
#include <float.h>
#include <math.h>
#include <stddef.h>
#include "narrow/gjk_double.h"
#include "narrow/overlap.h"

/* A common area or length below this fraction of the squared size, or of the size, is rounding: that of a few
 * products of coordinates. */
#define ROUNDING (256.0 * DBL_EPSILON)
/* Vertices on the supporting plane of an overlapping core, over the size: as in gjk.c. */
#define PLANE_BAND 1e-10

const char *fl_mode_name(fl_mode mode)
{
    static const char *const name[] = {"--", "VV", "VE", "VF", "EE", "EP", "EF", "FF"};
    return name[mode];
}

/* One body seen from the other; dir: direction towards the other. */
typedef struct {
    const fl_solid *s;
    fl_vec3 dir;
    int32_t n, at[3]; /* vertices of the closest feature */
} body_view;

typedef struct {
    body_view a, b;
    fl_vec3 n, pa, pb;
    fl_plane_axes t;
    double size;
    fl_mode before;
} pair_view;

typedef struct {
    fl_mode mode;
    double size;
    fl_vec3 pa, pb; /* on either core, over the middle of the common part */
} contact_features;

static double parallel_limit(const pair_view *w, fl_mode mode)
{
    return w->before == mode ? FL_PARALLEL_LEAVE : FL_PARALLEL_ENTER;
}

static int is_near_vertex(const body_view *s, int32_t v)
{
    for (int32_t k = 0; k < s->n; k++)
        if (s->at[k] == v) return 1;
    return 0;
}

static fl_loop loop_of(const fl_solid *s, int32_t f)
{
    const int32_t k = s->p->first[f];
    return (fl_loop){s->v, s->p->loop + k, s->p->first[f + 1] - k};
}

/* The face that contains the closest feature and is least inclined to the other body, within the angle; or
 * -1. */
static int32_t find_face(const body_view *s, double angle)
{
    int32_t best = -1;
    double least = angle;
    for (int32_t f = 0; f < s->s->p->nf; f++) {
        if (v3_dot(s->s->n[f], s->dir) <= 0.0) continue;
        const double tilt = v3_norm(v3_cross(s->s->n[f], s->dir)); /* its sine */
        if (!(tilt <= least) || (best >= 0 && tilt == least)) continue;
        const fl_loop l = loop_of(s->s, f);
        int32_t have = 0;
        for (int32_t k = 0; k < l.n; k++) have += is_near_vertex(s, l.loop[k]);
        if (have < s->n) continue;
        best = f;
        least = tilt;
    }
    return best;
}

static fl_vec3 edge_vector(const fl_solid *s, int32_t e)
{
    return v3_sub(s->v[s->p->edge[e].b], s->v[s->p->edge[e].a]);
}

/* True if edge e starts at the closest feature and is at right angles to the direction, within the angle. */
static int edge_is_parallel(const body_view *s, int32_t e, double angle)
{
    if (!is_near_vertex(s, s->s->p->edge[e].a) && !is_near_vertex(s, s->s->p->edge[e].b)) return 0;
    const fl_vec3 l = edge_vector(s->s, e);
    return fabs(v3_dot(l, s->dir)) <= angle * v3_norm(l);
}

/* The point over (x, y) on the plane of face f. */
static fl_vec3 point_on_face(const pair_view *w, const fl_solid *s, int32_t f, double x, double y)
{
    const fl_vec3 q = v3_madd(v3_madd(w->t.o, x, w->t.x), y, w->t.y), m = s->n[f];
    const double z = v3_dot(m, v3_sub(s->v[s->p->loop[s->p->first[f]]], q)) / v3_dot(m, w->n);
    return v3_madd(q, z, w->n);
}

/* The point over (x, y) on edge e. */
static fl_vec3 point_on_edge(const pair_view *w, const fl_solid *s, int32_t e, double x, double y)
{
    const fl_vec3 p = s->v[s->p->edge[e].a], l = edge_vector(s, e), d = v3_sub(p, w->t.o);
    const double lx = v3_dot(l, w->t.x), ly = v3_dot(l, w->t.y);
    const double s0 = ((x - v3_dot(d, w->t.x)) * lx + (y - v3_dot(d, w->t.y)) * ly) / (lx * lx + ly * ly);
    return v3_madd(p, s0, l);
}

static int find_face_face(const pair_view *w, contact_features *out)
{
    const double angle = parallel_limit(w, FL_FF);
    const int32_t f = find_face(&w->a, angle), g = find_face(&w->b, angle);
    if (f < 0 || g < 0) return 0;
    const fl_projected_overlap c = fl_overlap_area(&w->t, loop_of(w->a.s, f), loop_of(w->b.s, g));
    if (!(c.size > ROUNDING * w->size * w->size)) return 0;
    *out = (contact_features){FL_FF, c.size, point_on_face(w, w->a.s, f, c.x, c.y),
                              point_on_face(w, w->b.s, g, c.x, c.y)};
    return 1;
}

/* The longest edge of s in a face of o. */
static void find_edge_face(const pair_view *w, const body_view *s, const body_view *o, int turned,
                           contact_features *out)
{
    const double angle = parallel_limit(w, FL_EF);
    const int32_t f = find_face(o, angle);
    if (f < 0) return;
    for (int32_t e = 0; e < s->s->p->ne; e++) {
        if (!edge_is_parallel(s, e, angle)) continue;
        const fl_edge *g = &s->s->p->edge[e];
        const fl_projected_overlap c =
            fl_overlap_length(&w->t, s->s->v[g->a], s->s->v[g->b], loop_of(o->s, f), ROUNDING * w->size);
        if (!(c.size > ROUNDING * w->size) || c.size <= out->size) continue;
        const fl_vec3 p = point_on_edge(w, s->s, e, c.x, c.y), q = point_on_face(w, o->s, f, c.x, c.y);
        *out = (contact_features){FL_EF, c.size, turned ? q : p, turned ? p : q};
    }
}

/* The longest common stretch of an edge of a and a parallel edge of b. */
static void find_edge_edge(const pair_view *w, contact_features *out)
{
    const double angle = parallel_limit(w, FL_EP);
    const fl_solid *a = w->a.s, *b = w->b.s;
    for (int32_t e = 0; e < a->p->ne; e++) {
        if (!edge_is_parallel(&w->a, e, angle)) continue;
        for (int32_t f = 0; f < b->p->ne; f++) {
            if (!edge_is_parallel(&w->b, f, angle)) continue;
            const fl_vec3 l = edge_vector(a, e), ua = v3_unit(l), m = edge_vector(b, f), ub = v3_unit(m);
            if (v3_norm(v3_cross(ua, ub)) > angle) continue;
            /* stretches along the mean direction across n */
            fl_vec3 u = v3_dot(ua, ub) < 0.0 ? v3_sub(ua, ub) : v3_add(ua, ub);
            u = v3_unit(v3_madd(u, -v3_dot(u, w->n), w->n));
            const fl_vec3 p = a->v[a->p->edge[e].a], q = b->v[b->p->edge[f].a];
            const double a0 = v3_dot(u, v3_sub(p, w->t.o)), a1 = a0 + v3_dot(u, l),
                         b0 = v3_dot(u, v3_sub(q, w->t.o)), b1 = b0 + v3_dot(u, m);
            const double lo = fmax(fmin(a0, a1), fmin(b0, b1)), hi = fmin(fmax(a0, a1), fmax(b0, b1));
            if (!(hi - lo > ROUNDING * w->size) || hi - lo <= out->size) continue;
            const double mid = 0.5 * (lo + hi);
            *out = (contact_features){FL_EP, hi - lo, v3_madd(p, (mid - a0) / (a1 - a0), l),
                                      v3_madd(q, (mid - b0) / (b1 - b0), m)};
        }
    }
}

/* Mode of two features of na and nb vertices; 3: a face. */
static fl_mode mode_of_features(int32_t na, int32_t nb)
{
    if (na >= 3 || nb >= 3) return FL_VF;
    if (na == 2 && nb == 2) return FL_EE;
    return na == 2 || nb == 2 ? FL_VE : FL_VV;
}

/* The vertices on the supporting plane of a core along its direction, three at most. */
static void find_near_vertices(body_view *s, double size)
{
    const fl_core c = fl_solid_core(s->s);
    double low;
    s->n = 0;
    fl_core_support(c, v3_neg(s->dir), &low);
    for (int32_t i = 0; i < c.n && s->n < 3; i++)
        if (-v3_dot(s->dir, v3_sub(c.v[i], c.v[0])) <= low + PLANE_BAND * size) s->at[s->n++] = i;
}

void fl_contact_find(const fl_solid *a, const fl_solid *b, fl_mode before, fl_gjk_cache *cache,
                     fl_penetration_count *count, fl_contact *out)
{
    fl_gap g;
    fl_gjk(fl_solid_core(a), fl_solid_core(b), cache, &g);
    pair_view w = {.a = {.s = a}, .b = {.s = b}, .n = g.n, .pa = g.pa, .pb = g.pb, .before = before};
    w.size = a->p->size + b->p->size;
    *out = (fl_contact){.overlap = g.overlap, .d = g.d};
    if (g.overlap) {
        fl_penetration deep;
        fl_penetration_find(a, b, count, &deep);
        out->d = -deep.depth;
        w.n = deep.n;
        w.pa = deep.pa;
        w.pb = deep.pb;
    }
    w.a.dir = v3_neg(w.n);
    w.b.dir = w.n;
    if (g.overlap) {
        find_near_vertices(&w.a, w.size);
        find_near_vertices(&w.b, w.size);
    } else {
        w.a.n = g.na;
        w.b.n = g.nb;
        for (int k = 0; k < 3; k++) {
            w.a.at[k] = g.ia[k];
            w.b.at[k] = g.ib[k];
        }
    }
    w.t = fl_plane_axes_of(v3_lerp(w.pb, w.pa, 0.5), w.n);

    contact_features f = {mode_of_features(w.a.n, w.b.n), 0.0, w.pa, w.pb};
    if (!find_face_face(&w, &f)) {
        find_edge_face(&w, &w.a, &w.b, 0, &f);
        const double ours = f.size;
        find_edge_face(&w, &w.b, &w.a, 1, &f);
        out->lower_is_b = f.size > ours;
        if (f.size == 0.0) find_edge_edge(&w, &f);
    }
    out->mode = f.mode;
    out->gap = out->d - a->r - b->r;
    out->n = w.n;
    out->p = v3_scale(0.5, v3_add(v3_madd(f.pa, -a->r, w.n), v3_madd(f.pb, b->r, w.n)));
    out->length = f.mode == FL_EP || f.mode == FL_EF ? f.size : 0.0;
    out->area = f.mode == FL_FF ? f.size : 0.0;
    if (f.mode == FL_VE || f.mode == FL_VF) out->lower_is_b = w.b.n < w.a.n;
    if (f.mode == FL_EE) {
        const fl_vec3 l = v3_sub(a->v[w.a.at[1]], a->v[w.a.at[0]]),
                      m = v3_sub(b->v[w.b.at[1]], b->v[w.b.at[0]]);
        const double la = v3_norm(l), lb = v3_norm(m);
        out->sine = v3_norm(v3_cross(l, m)) / (la * lb);
        out->edge = la < lb ? la : lb;
    }
}
