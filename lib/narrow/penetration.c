/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "narrow/penetration.h"
#include <ccd/ccd.h>
#include <float.h>
#include <math.h>
#include "geom/dd.h"
#include "narrow/gjk_double.h"

/* Widths nearer to each other than this fraction of the extent are equal: a few roundings of a support. */
#define EQUAL_WIDTH (64.0 * DBL_EPSILON)
/* libccd's direction is poor when it is wider than the depth by more, in extents. */
#define POOR 1e-6
/* Vertices this near to a supporting plane of libccd's direction, in extents, belong to the facet that it
 * means: its portal ends within 1e-8 and its direction is good to about the root of that. */
#define FACET_BAND 1e-3
/* Vertices that touch the shifted plane, in extents: as in gjk.c. */
#define PLANE_BAND 1e-10

/* sin^2 of the angle of two edges below which their product is taken in pairs of doubles: in doubles it would
 * turn by 2^-53 over the sine. */
#define NEARLY_PARALLEL 1e-2
/* And below which they are parallel: the facet that they make of the difference of the bodies is then too
 * narrow to matter, and so is what any direction across one of them leaves out of the other, the sine
 * times its length.  Pairs of doubles turn the product by 2^-104 over the sine, 1e-14 at most. */
#define PARALLEL 1e-34
/* Arcs that miss each other by less are tried all the same, which costs a support each and no more.  Normals
 * are unit vectors that carry the rounding of their face over its least height: 1e-7 on one that is 1e-9
 * of its body wide. */
#define NEARLY_CROSSING 1e-6

enum { SUPPORTS_MAX = 4000, CCD_STEPS = 200, NEAR_MAX = 64, FACE_MAX = 1024 };
static const int64_t ALL_EDGE_PAIRS = 1 << 20;

typedef struct {
    const fl_solid *a, *b;
    fl_core ca, cb;
    fl_vec3 offset, apart; /* b's vertex 0 from a's; centre of a from the centre of b */
    double size;
    double width; /* the least so far, along n */
    fl_vec3 n;
    fl_penetration by, trying; /* of, ea and eb of n, and of what is being tried */
} hunt;

/* Mean of the vertices over vertex 0. */
static fl_vec3 centre_of(fl_core c)
{
    fl_vec3 s = {0, 0, 0};
    for (int32_t i = 0; i < c.n; i++) s = v3_add(s, v3_sub(c.v[i], c.v[0]));
    return v3_scale(1.0 / c.n, s);
}

/* How far a has to go along n until it leaves b: max over b of n.y - min over a of n.x. */
static double width_along(const hunt *h, fl_vec3 n)
{
    double la, lb;
    fl_core_support(h->ca, n, &la);
    fl_core_support(h->cb, v3_neg(n), &lb);
    return v3_dot(n, h->offset) - lb - la;
}

static void try_direction(hunt *h, fl_vec3 n)
{
    const double w = width_along(h, n), equal = EQUAL_WIDTH * h->size;
    if (w < h->width - equal ||
        (w < h->width + equal && v3_dot(n, h->apart) > v3_dot(h->n, h->apart) + equal)) {
        h->width = w;
        h->n = n;
        h->by = h->trying;
    }
}

static void try_faces(hunt *h)
{
    h->trying.turns_with = 1;
    for (int32_t f = 0; f < h->a->p->nf; f++) try_direction(h, v3_neg(h->a->n[f]));
    h->trying.turns_with = -1;
    for (int32_t f = 0; f < h->b->p->nf; f++) try_direction(h, h->b->n[f]);
}

static fl_vec3 along(const fl_solid *s, const fl_edge *e) { return v3_sub(s->v[e->b], s->v[e->a]); }

/* The unit vector across two edges; zero when they are parallel. */
static fl_vec3 across(const hunt *h, const fl_edge *e, const fl_edge *f)
{
    const fl_vec3 l = along(h->a, e), m = along(h->b, f), n = v3_cross(l, m);
    const double ll = v3_norm2(l), mm = v3_norm2(m);
    if (v3_norm2(n) > NEARLY_PARALLEL * ll * mm) return v3_unit(n);
    const fl_vec3 fine =
        ddv_round(ddv_cross(ddv_diff(h->a->v[e->b], h->a->v[e->a]), ddv_diff(h->b->v[f->b], h->b->v[f->a])));
    return v3_norm2(fine) > PARALLEL * ll * mm ? v3_unit(fine) : v3(0, 0, 0);
}

static void try_cross(hunt *h, const fl_edge *e, const fl_edge *f)
{
    const fl_vec3 n = across(h, e, f);
    if (!(v3_norm2(n) > 0.0)) return; /* no direction of their own; that of the next face serves */
    h->trying =
        (fl_penetration){.turns_with = 0, .ea = v3_unit(along(h->a, e)), .eb = v3_unit(along(h->b, f))};
    try_direction(h, n);
    try_direction(h, v3_neg(n));
}

/* Both clearly on one side. */
static int beside(double x, double y)
{
    return (x > NEARLY_CROSSING && y > NEARLY_CROSSING) || (x < -NEARLY_CROSSING && y < -NEARLY_CROSSING);
}

/* May the arcs p q (an edge of a) and -r -s (an edge of b turned round) cross on the sphere of normals?  Only
 * then can the pair of edges be a facet of the difference of the bodies.  Each sign may be rounding, so
 * that only those are left out that are clear. */
static int arcs_may_cross(fl_vec3 p, fl_vec3 q, fl_vec3 r, fl_vec3 s)
{
    const fl_vec3 c = v3_cross(q, p), d = v3_cross(s, r);
    const double rc = -v3_dot(r, c), sc = -v3_dot(s, c), pd = v3_dot(p, d), qd = v3_dot(q, d);
    return !beside(rc, sc) && !beside(pd, qd) && !beside(rc, -qd);
}

/* A body without volume has edges whose normals are opposite or missing: no arcs to speak of. */
static int has_arcs(const fl_solid *s) { return s->p->nf > 2; }

static void try_edges(hunt *h)
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

/* ---- libccd -------------------------------------------------------------------------------------------- */

typedef struct {
    fl_core c;
    fl_vec3 centre, o; /* both from vertex 0 */
    double scale;
    int *left; /* support calls that are still allowed */
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
static int ask_ccd(const hunt *h, fl_penetration_count *count, fl_vec3 *n)
{
    int left = SUPPORTS_MAX;
    const fl_vec3 ca = centre_of(h->ca), cb = centre_of(h->cb);
    /* The origin of both: midway between the centres. */
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
    ccd.mpr_tolerance = (ccd_real_t)1e-8;
    ccdVec3Set(&dir, 0, 0, 0);
    ccdVec3Set(&at, 0, 0, 0);
    const int rc = ccdMPRPenetration(&a, &b, &ccd, &depth, &dir, &at);
    if (count && left < 0) count->capped++;
    *n = v3(-(double)dir.v[0], -(double)dir.v[1], -(double)dir.v[2]); /* it moves b, we move a */
    const double len = v3_norm(*n);
    if (rc != 0 || !isfinite(len) || !(fabs(len - 1.0) < 1e-6)) return 0;
    *n = v3_unit(*n);
    return 1;
}

/* Vertices within a band over the lowest along n.  Of more than max every so many are kept: of a face of many
 * corners, so as not to lose one side of it. */
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

static int listed(int32_t n, const int32_t *at, int32_t i)
{
    for (int32_t k = 0; k < n; k++)
        if (at[k] == i) return 1;
    return 0;
}

/* The pairs of edges about the supports of n. */
static void try_edges_near(hunt *h, fl_vec3 n)
{
    int32_t va[NEAR_MAX], vb[NEAR_MAX];
    const double band = FACET_BAND * h->size;
    const int32_t na = vertices_near(h->ca, n, band, NEAR_MAX, va),
                  nb = vertices_near(h->cb, v3_neg(n), band, NEAR_MAX, vb);
    const fl_poly *p = h->a->p, *q = h->b->p;
    for (int32_t e = 0; e < p->ne; e++) {
        if (!listed(na, va, p->edge[e].a) || !listed(na, va, p->edge[e].b)) continue;
        for (int32_t f = 0; f < q->ne; f++)
            if (listed(nb, vb, q->edge[f].a) && listed(nb, vb, q->edge[f].b))
                try_cross(h, &p->edge[e], &q->edge[f]);
    }
}

/* Points and parallel segments have no face and no product of edges: then any direction across them, and
 * the vertical for two points. */
static void try_whatever(hunt *h)
{
    const fl_solid *s = h->a->p->ne ? h->a : h->b;
    if (s->p->ne == 0) {
        try_direction(h, v3(0, 0, 1));
        return;
    }
    const fl_vec3 n = v3_normal_to(v3_unit(along(s, &s->p->edge[0])));
    try_direction(h, n);
    try_direction(h, v3_neg(n));
}

/* Points of the two planes that come together when a has been moved out. */
static void find_points(const hunt *h, fl_penetration *out)
{
    int32_t va[FACE_MAX], vb[FACE_MAX];
    fl_vec3 pa[FACE_MAX], pb[FACE_MAX];
    const double band = PLANE_BAND * h->size;
    const int32_t na = vertices_near(h->ca, h->n, band, FACE_MAX, va),
                  nb = vertices_near(h->cb, v3_neg(h->n), band, FACE_MAX, vb);
    /* Moved out by a size more, so that they are apart beyond any rounding; and relative to a's vertex 0. */
    const fl_vec3 shift = v3_scale(out->depth + h->size, h->n);
    for (int32_t k = 0; k < na; k++) pa[k] = v3_add(v3_sub(h->ca.v[va[k]], h->ca.v[0]), shift);
    for (int32_t k = 0; k < nb; k++) pb[k] = v3_add(v3_sub(h->cb.v[vb[k]], h->cb.v[0]), h->offset);
    fl_gap g;
    fl_gjk((fl_core){pa, na, NULL}, (fl_core){pb, nb, NULL}, NULL, &g);
    /* Of directions equally wide to rounding the one that was taken may not be the least, and then the two
     * points do not quite face each other: the middle is kept. */
    const fl_vec3 mid = v3_lerp(v3_sub(g.pa, shift), g.pb, 0.5);
    out->pa = v3_add(h->ca.v[0], v3_madd(mid, -0.5 * out->depth, h->n));
    out->pb = v3_add(h->ca.v[0], v3_madd(mid, 0.5 * out->depth, h->n));
}

void fl_penetration_find(const fl_solid *a, const fl_solid *b, fl_penetration_count *count,
                         fl_penetration *out)
{
    hunt h = {.a = a, .b = b, .ca = fl_solid_core(a), .cb = fl_solid_core(b), .width = INFINITY};
    h.offset = v3_sub(b->v[0], a->v[0]);
    h.apart = v3_sub(v3_sub(centre_of(h.ca), centre_of(h.cb)), h.offset);
    h.size = fl_core_extent(h.ca) + fl_core_extent(h.cb);
    fl_vec3 n;
    const int proposed = ask_ccd(&h, count, &n);
    const double theirs = proposed ? width_along(&h, n) : INFINITY;

    try_faces(&h);
    if ((int64_t)a->p->ne * b->p->ne <= ALL_EDGE_PAIRS) try_edges(&h);
    else if (proposed) {
        try_edges_near(&h, n);
        h.trying.turns_with = -1;
        try_direction(&h, n);
    }
    h.trying.turns_with = -1;
    if (h.width == INFINITY) try_whatever(&h);
    if (count) {
        count->queries++;
        count->no_answer += !proposed;
        count->rejected += proposed && theirs > h.width + POOR * h.size;
    }
    /* Normals of faces come as the caller keeps them, turned many times. */
    h.n = v3_unit(h.n);
    h.width = width_along(&h, h.n);
    out->depth = h.width > 0.0 ? h.width : 0.0;
    out->n = h.n;
    out->turns_with = h.by.turns_with;
    out->ea = h.by.ea;
    out->eb = h.by.eb;
    find_points(&h, out);
}
