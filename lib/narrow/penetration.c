/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "narrow/penetration.h"
#include <ccd/ccd.h>
#include <float.h>
#include <math.h>
#include "geom/dd.h"
#include "narrow/gjk_double.h"

/* Widths nearer to each other than this fraction of the extent are equal: a few roundings of a support. */
#define EQUAL_WIDTH (64.0 * DBL_EPSILON)
/* libccd's direction is rejected when it is wider than the depth by more than this fraction of the extent. */
#define REJECT_TOL 1e-6
/* Vertices this near, over the extent, to a supporting plane of libccd's direction belong to its facet: its
 * portal ends within 1e-8, and its direction is good to about the root of that. */
#define FACET_BAND 1e-3
/* Vertices that touch the shifted plane, over the extent: as in gjk.c. */
#define PLANE_BAND 1e-10

/* sin^2 of the angle of two edges below which their cross product is computed in double-doubles: in doubles
 * it would turn by 2^-53 over the sine. */
#define NEARLY_PARALLEL 1e-2
/* sin^2 below which two edges are parallel.  Their facet of the Minkowski difference is then too narrow to
 * matter.  So is what a direction across one of them leaves out of the other: the sine times its length.
 * Double-doubles turn the product by 2^-104 over the sine, 1e-14 at most. */
#define PARALLEL 1e-34
/* Arcs that miss each other by less are tried too, at the cost of a support each.  Normals are unit vectors
 * with the rounding of their face over its least height: 1e-7 on a face 1e-9 of its body wide. */
#define NEARLY_CROSSING 1e-6

/* Tolerance of libccd's portal, in cores scaled to unit size. */
#define CCD_TOL 1e-8
/* A direction of libccd whose length differs from 1 by more is an error of its: it rounds in 1e-15. */
#define UNIT_TOL 1e-6

enum { MAX_SUPPORTS = 4000, CCD_STEPS = 200, MAX_NEAR = 64, MAX_FACE = 1024 };
static const int64_t ALL_EDGE_PAIRS = 1 << 20;

typedef struct {
    const fl_solid *a, *b;
    fl_core ca, cb;
    fl_vec3 offset, apart; /* vertex 0 of b from that of a; centre of a from that of b */
    double size;
    double width; /* the least so far, along n */
    fl_vec3 n;
    fl_penetration by, trying; /* turns_with, ea and eb of n, and of the candidate */
} width_search;

/* Mean of the vertices, relative to vertex 0. */
static fl_vec3 centre_of(fl_core c)
{
    fl_vec3 s = {0, 0, 0};
    for (int32_t i = 0; i < c.n; i++) s = v3_add(s, v3_sub(c.v[i], c.v[0]));
    return v3_scale(1.0 / c.n, s);
}

/* How far a has to move along n to leave b: max over b of n.y - min over a of n.x. */
static double width_along(const width_search *h, fl_vec3 n)
{
    double la, lb;
    fl_core_support(h->ca, n, &la);
    fl_core_support(h->cb, v3_neg(n), &lb);
    return v3_dot(n, h->offset) - lb - la;
}

static void try_direction(width_search *h, fl_vec3 n)
{
    const double w = width_along(h, n), equal = EQUAL_WIDTH * h->size;
    if (w < h->width - equal ||
        (w < h->width + equal && v3_dot(n, h->apart) > v3_dot(h->n, h->apart) + equal)) {
        h->width = w;
        h->n = n;
        h->by = h->trying;
    }
}

static void try_faces(width_search *h)
{
    h->trying.turns_with = 1;
    for (int32_t f = 0; f < h->a->p->nf; f++) try_direction(h, v3_neg(h->a->n[f]));
    h->trying.turns_with = -1;
    for (int32_t f = 0; f < h->b->p->nf; f++) try_direction(h, h->b->n[f]);
}

static fl_vec3 edge_vector(const fl_solid *s, const fl_edge *e) { return v3_sub(s->v[e->b], s->v[e->a]); }

/* The unit vector across two edges; zero when they are parallel. */
static fl_vec3 direction_across(const width_search *h, const fl_edge *e, const fl_edge *f)
{
    const fl_vec3 l = edge_vector(h->a, e), m = edge_vector(h->b, f), n = v3_cross(l, m);
    const double ll = v3_norm2(l), mm = v3_norm2(m);
    if (v3_norm2(n) > NEARLY_PARALLEL * ll * mm) return v3_unit(n);
    const fl_vec3 fine =
        ddv_round(ddv_cross(ddv_diff(h->a->v[e->b], h->a->v[e->a]), ddv_diff(h->b->v[f->b], h->b->v[f->a])));
    return v3_norm2(fine) > PARALLEL * ll * mm ? v3_unit(fine) : v3(0, 0, 0);
}

static void try_cross(width_search *h, const fl_edge *e, const fl_edge *f)
{
    const fl_vec3 n = direction_across(h, e, f);
    /* no direction of their own; the normal of a neighbouring face covers it */
    if (!(v3_norm2(n) > 0.0)) return;
    h->trying = (fl_penetration){
        .turns_with = 0, .ea = v3_unit(edge_vector(h->a, e)), .eb = v3_unit(edge_vector(h->b, f))};
    try_direction(h, n);
    try_direction(h, v3_neg(n));
}

/* Both clearly on one side. */
static int on_one_side(double x, double y)
{
    return (x > NEARLY_CROSSING && y > NEARLY_CROSSING) || (x < -NEARLY_CROSSING && y < -NEARLY_CROSSING);
}

/* True if the arcs p q (an edge of a) and -r -s (an edge of b, mirrored) may cross on the Gauss sphere.  Only
 * then can the edge pair be a facet of the Minkowski difference.  Signs may be rounding, so only clear cases
 * are excluded. */
static int arcs_may_cross(fl_vec3 p, fl_vec3 q, fl_vec3 r, fl_vec3 s)
{
    const fl_vec3 c = v3_cross(q, p), d = v3_cross(s, r);
    const double rc = -v3_dot(r, c), sc = -v3_dot(s, c), pd = v3_dot(p, d), qd = v3_dot(q, d);
    return !on_one_side(rc, sc) && !on_one_side(pd, qd) && !on_one_side(rc, -qd);
}

/* A body without volume has edges whose normals are opposite or missing: they have no arcs. */
static int has_arcs(const fl_solid *s) { return s->p->nf > 2; }

static void try_edges(width_search *h)
{
    const fl_poly *p = h->a->p, *q = h->b->p;
    const int thin = has_arcs(h->a) && has_arcs(h->b);
    for (int32_t e = 0; e < p->ne; e++)
        for (int32_t f = 0; f < q->ne; f++) {
            const fl_edge *ea = &p->edge[e], *eb = &q->edge[f];
            if (thin &&
                !arcs_may_cross(h->a->n[ea->left], h->a->n[ea->right], h->b->n[eb->left], h->b->n[eb->right]))
                continue;
            try_cross(h, ea, eb);
        }
}

/* --- libccd --------------------------------------------------------------------------------------------- */

typedef struct {
    fl_core c;
    fl_vec3 centre, o; /* both relative to vertex 0 */
    double scale;
    int *left; /* support calls left */
} ccd_body;

static void ccd_support(const void *obj, const ccd_vec3_t *dir, ccd_vec3_t *out)
{
    const ccd_body *s = obj;
    double low;
    /* Its loops have no bound of their own; a support at the origin ends each of them. */
    if (--*s->left < 0) {
        ccdVec3Set(out, 0, 0, 0);
        return;
    }
    const int32_t i =
        fl_core_support(s->c, v3(-(double)dir->v[0], -(double)dir->v[1], -(double)dir->v[2]), &low);
    const fl_vec3 p = v3_scale(s->scale, v3_sub(v3_sub(s->c.v[i], s->c.v[0]), s->o));
    ccdVec3Set(out, p.x, p.y, p.z);
}

static void ccd_centre(const void *obj, ccd_vec3_t *out)
{
    const ccd_body *s = obj;
    const fl_vec3 p = v3_scale(s->scale, v3_sub(s->centre, s->o));
    ccdVec3Set(out, p.x, p.y, p.z);
}

/* The direction that libccd proposes; 0 when it has none. */
static int call_ccd(const width_search *h, fl_penetration_count *count, fl_vec3 *n)
{
    int left = MAX_SUPPORTS;
    const fl_vec3 ca = centre_of(h->ca), cb = centre_of(h->cb);
    /* common origin: midway between the centres */
    const fl_vec3 mid = v3_scale(0.5, v3_add(ca, v3_add(h->offset, cb)));
    const double scale = h->size > 0.0 ? 1.0 / h->size : 1.0;
    const ccd_body a = {h->ca, ca, mid, scale, &left}, b = {h->cb, cb, v3_sub(mid, h->offset), scale, &left};
    ccd_t ccd;
    ccd_real_t depth = 0;
    ccd_vec3_t dir, at;
    CCD_INIT(&ccd);
    ccd.support1 = ccd.support2 = ccd_support;
    ccd.center1 = ccd.center2 = ccd_centre;
    ccd.max_iterations = CCD_STEPS;
    ccd.mpr_tolerance = (ccd_real_t)CCD_TOL;
    ccdVec3Set(&dir, 0, 0, 0);
    ccdVec3Set(&at, 0, 0, 0);
    const int rc = ccdMPRPenetration(&a, &b, &ccd, &depth, &dir, &at);
    if (count && left < 0) count->capped++;
    *n = v3(-(double)dir.v[0], -(double)dir.v[1], -(double)dir.v[2]); /* libccd moves b, we move a */
    const double len = v3_norm(*n);
    if (rc != 0 || !isfinite(len) || !(fabs(len - 1.0) < UNIT_TOL)) return 0;
    *n = v3_unit(*n);
    return 1;
}

/* Vertices within a band over the lowest along n.  If there are more than max, evenly spread ones are kept,
 * so that a face of many corners loses no side. */
static int32_t vertices_near(fl_core c, fl_vec3 n, double band, int32_t max, int32_t *at)
{
    double low;
    int64_t found = 0, k = 0;
    fl_core_support(c, n, &low);
    for (int32_t i = 0; i < c.n; i++) found += v3_dot(n, v3_sub(c.v[i], c.v[0])) <= low + band;
    const int64_t kept = found < max ? found : max;
    int64_t seen = 0;
    for (int32_t i = 0; i < c.n && k < kept; i++)
        if (v3_dot(n, v3_sub(c.v[i], c.v[0])) <= low + band && seen++ * kept >= k * found) at[k++] = i;
    return (int32_t)k;
}

static int is_listed(int32_t n, const int32_t *at, int32_t i)
{
    for (int32_t k = 0; k < n; k++)
        if (at[k] == i) return 1;
    return 0;
}

/* Tries the edge pairs near the supports of n. */
static void try_edges_near(width_search *h, fl_vec3 n)
{
    int32_t va[MAX_NEAR], vb[MAX_NEAR];
    const double band = FACET_BAND * h->size;
    const int32_t na = vertices_near(h->ca, n, band, MAX_NEAR, va),
                  nb = vertices_near(h->cb, v3_neg(n), band, MAX_NEAR, vb);
    const fl_poly *p = h->a->p, *q = h->b->p;
    for (int32_t e = 0; e < p->ne; e++) {
        if (!is_listed(na, va, p->edge[e].a) || !is_listed(na, va, p->edge[e].b)) continue;
        for (int32_t f = 0; f < q->ne; f++)
            if (is_listed(nb, vb, q->edge[f].a) && is_listed(nb, vb, q->edge[f].b))
                try_cross(h, &p->edge[e], &q->edge[f]);
    }
}

/* Points and parallel segments have no face and no edge product: any direction across them is taken, and the
 * vertical for two points. */
static void try_fallback(width_search *h)
{
    const fl_solid *s = h->a->p->ne ? h->a : h->b;
    if (s->p->ne == 0) {
        try_direction(h, v3(0, 0, 1));
        return;
    }
    const fl_vec3 n = v3_normal_to(v3_unit(edge_vector(s, &s->p->edge[0])));
    try_direction(h, n);
    try_direction(h, v3_neg(n));
}

/* Points of the two planes that touch after a has been moved out. */
static void find_deepest_points(const width_search *h, fl_penetration *out)
{
    int32_t va[MAX_FACE], vb[MAX_FACE];
    fl_vec3 pa[MAX_FACE], pb[MAX_FACE];
    const double band = PLANE_BAND * h->size;
    const int32_t na = vertices_near(h->ca, h->n, band, MAX_FACE, va),
                  nb = vertices_near(h->cb, v3_neg(h->n), band, MAX_FACE, vb);
    /* Moved out by one size more: separated beyond any rounding.  Relative to vertex 0 of a. */
    const fl_vec3 shift = v3_scale(out->depth + h->size, h->n);
    for (int32_t k = 0; k < na; k++) pa[k] = v3_add(v3_sub(h->ca.v[va[k]], h->ca.v[0]), shift);
    for (int32_t k = 0; k < nb; k++) pb[k] = v3_add(v3_sub(h->cb.v[vb[k]], h->cb.v[0]), h->offset);
    fl_gap g;
    fl_gjk((fl_core){pa, na, NULL}, (fl_core){pb, nb, NULL}, NULL, &g);
    /* Of directions equal to rounding the chosen one may not be the least, and the two points do not quite
     * face each other: take the middle. */
    const fl_vec3 mid = v3_lerp(v3_sub(g.pa, shift), g.pb, 0.5);
    out->pa = v3_add(h->ca.v[0], v3_madd(mid, -0.5 * out->depth, h->n));
    out->pb = v3_add(h->ca.v[0], v3_madd(mid, 0.5 * out->depth, h->n));
}

void fl_penetration_find(const fl_solid *a, const fl_solid *b, fl_penetration_count *count,
                         fl_penetration *out)
{
    width_search h = {.a = a, .b = b, .ca = fl_solid_core(a), .cb = fl_solid_core(b), .width = INFINITY};
    h.offset = v3_sub(b->v[0], a->v[0]);
    h.apart = v3_sub(v3_sub(centre_of(h.ca), centre_of(h.cb)), h.offset);
    h.size = fl_core_extent(h.ca) + fl_core_extent(h.cb);
    fl_vec3 n;
    const int proposed = call_ccd(&h, count, &n);
    const double theirs = proposed ? width_along(&h, n) : INFINITY;

    try_faces(&h);
    if ((int64_t)a->p->ne * b->p->ne <= ALL_EDGE_PAIRS) try_edges(&h);
    else if (proposed) {
        try_edges_near(&h, n);
        h.trying.turns_with = -1;
        try_direction(&h, n);
    }
    h.trying.turns_with = -1;
    if (h.width == INFINITY) try_fallback(&h);
    if (count) {
        count->queries++;
        count->no_answer += !proposed;
        count->rejected += proposed && theirs > h.width + REJECT_TOL * h.size;
    }
    /* normals of faces come from the caller, rotated many times */
    h.n = v3_unit(h.n);
    h.width = width_along(&h, h.n);
    out->depth = h.width > 0.0 ? h.width : 0.0;
    out->n = h.n;
    out->turns_with = h.by.turns_with;
    out->ea = h.by.ea;
    out->eb = h.by.eb;
    find_deepest_points(&h, out);
}
