/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <float.h>
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "geom/clip.h"
#include "geom/mass.h"

/* Distance from the plane, relative to the size, below which a vertex lies on it: a plane through given
 * vertices misses them by a few roundings.  A vertex slightly farther away may leave a face too narrow for
 * fl_poly_make().  Then larger tolerances are tried, up to half the allowed deviation of a face from its
 * plane. */
enum { ON_TRIES = 3 };
static const double ON_TOL[ON_TRIES] = {1e-12, 5e-11, 5e-10};
/* Corners closer than this (relative to the size) are merged: twice the limit of fl_poly_make(). */
static const double WELD_TOL = 2e-10;
/* Rounding of a coordinate of magnitude m, a few m eps: twice the value of fl_poly_make(). */
static const double COARSE_TOL = 16 * DBL_EPSILON;
/* Planes whose normals differ by less than the root of this [rad] count as one plane in the search for their
 * common corner: normals of narrow faces are accurate to 1e-5 only (fl_poly_make()). */
static const double RANK_TOL = 1e-9;
/* Three planes whose normals have a larger determinant meet in a corner found by Cramer's rule.  Its relative
 * error is DBL_EPSILON / DET_TOL; a second iteration removes it. */
static const double DET_TOL = 1e-7;
/* A corner may miss its planes by this, relative to size + r. */
static const double MEET_TOL = 1e-12;
/* Largest displacement of a corner, relative to size + r. */
static const double FAR_MAX = 1e4;

/* A polyhedron being cut: loops, and for each face the number of its plane. */
struct shape {
    int32_t nv, nf;
    fl_vec3 *v;
    int32_t *first, *loop, *tag;
    void *mem;
};

struct plane {
    fl_vec3 n;
    double c;
};

static int shape_alloc(struct shape *s, int64_t nv, int64_t nf, int64_t nl, fl_err *err)
{
    const int64_t bytes = nv * (int64_t)sizeof(fl_vec3) + (2 * nf + 1 + nl) * (int64_t)sizeof(int32_t);
    if (nv > INT32_MAX || nl > INT32_MAX)
        return fl_fail(err, FL_SYSTEM, "a cut of %lld sides is too large", (long long)nl);
    char *at = fl_alloc(bytes, 1, err);
    if (!at) return -1;
    *s = (struct shape){.mem = at, .v = (fl_vec3 *)(void *)at};
    s->first = (int32_t *)(void *)(s->v + nv);
    s->tag = s->first + nf + 1;
    s->loop = s->tag + nf;
    return 0;
}

static void shape_free(struct shape *s)
{
    free(s->mem);
    *s = (struct shape){0};
}

static double box_extent(int32_t n, const fl_vec3 *v, double *far)
{
    fl_aabb b = aabb_empty();
    for (int32_t k = 0; k < n; k++) b = aabb_add(b, v[k]);
    *far = fmax(fmax(fmax(fabs(b.lo.x), fabs(b.hi.x)), fmax(fabs(b.lo.y), fabs(b.hi.y))),
                fmax(fabs(b.lo.z), fabs(b.hi.z)));
    return fmax(b.hi.x - b.lo.x, fmax(b.hi.y - b.lo.y, b.hi.z - b.lo.z));
}

/* New vertices by the edge that they split: open addressing over (inner end, outer end). */
struct split_table {
    int32_t *inner, *outer, *id; /* [mask + 1]; id = 0 is free */
    uint64_t mask;
};

static int32_t *find_split(const struct split_table *h, int32_t i, int32_t j)
{
    uint64_t at = ((uint64_t)(uint32_t)i * UINT64_C(0x9E3779B97F4A7C15) ^ (uint64_t)(uint32_t)j) *
                  UINT64_C(0xD6E8FEB86659FD93);
    for (at = (at >> 32) & h->mask; h->id[at] && (h->inner[at] != i || h->outer[at] != j);)
        at = (at + 1) & h->mask;
    h->inner[at] = i;
    h->outer[at] = j;
    return h->id + at;
}

/* Scratch of one cut, by vertex: signed distance, next corner of the cap, new index. */
struct cut_scratch {
    double *s;
    int32_t *next, *place;
    struct split_table split;
    void *mem;
};

static int cut_scratch_alloc(struct cut_scratch *w, int32_t nv, int32_t nl, fl_err *err)
{
    uint64_t slots = 16;
    while (slots < 2 * (uint64_t)nl) slots *= 2;
    const int64_t most = (int64_t)nv + nl;
    char *at = fl_alloc(
        nv * (int64_t)sizeof(double) + (2 * most + 3 * (int64_t)slots) * (int64_t)sizeof(int32_t), 1, err);
    if (!at) return -1;
    w->mem = at;
    w->s = (double *)(void *)at;
    w->next = (int32_t *)(void *)(w->s + nv);
    w->place = w->next + most;
    w->split = (struct split_table){w->place + most, w->place + most + slots, w->place + most + 2 * slots,
                                    slots - 1};
    for (int64_t k = 0; k < most; k++) w->next[k] = -1;
    return 0;
}

/* Collects the cap, starting at its lowest corner.  The links must form one ring.  Returns its length or
 * -1. */
static int32_t close_cap(struct shape *to, int32_t at, const int32_t *next, int32_t most, int32_t links)
{
    int32_t start = 0, n = 0;
    while (start < most && next[start] < 0) start++;
    if (links == 0) return 0;
    int32_t k = start;
    do {
        to->loop[at + n++] = k;
        k = next[k];
    } while (k >= 0 && k != start && n < links);
    return k == start && n == links && n >= 3 ? n : -1;
}

/* Renumbers the vertices used by loops: old vertices in their order, then new ones in theirs. */
static void renumber_vertices(struct shape *s, int32_t *place, int32_t most)
{
    const int32_t nl = s->first[s->nf];
    int32_t n = 0;
    for (int32_t k = 0; k < most; k++) place[k] = 0;
    for (int32_t k = 0; k < nl; k++) place[s->loop[k]] = 1;
    for (int32_t k = 0; k < most; k++)
        if (place[k]) {
            s->v[n] = s->v[k];
            place[k] = n++;
        }
    for (int32_t k = 0; k < nl; k++) s->loop[k] = place[s->loop[k]];
    s->nv = n;
}

enum { CUT_NOTHING, CUT_SOME, CUT_ALL };

/* Cuts by the plane with number tag.  Vertices within tol of the plane lie on it.  Returns CUT_... or -1. */
static int cut_shape(struct shape *a, struct plane pl, int32_t tag, double tol, fl_err *err)
{
    const int32_t nl = a->first[a->nf];
    struct cut_scratch w = {0};
    struct shape to = {0};
    int32_t inner = 0, outer = 0, at = 0, links = 0, most = a->nv;
    int rc = -1;

    if (cut_scratch_alloc(&w, a->nv, nl, err)) return -1;
    for (int32_t k = 0; k < a->nv; k++) {
        w.s[k] = v3_dot(pl.n, a->v[k]) - pl.c;
        if (fabs(w.s[k]) <= tol) w.s[k] = 0.0;
        inner += w.s[k] < 0.0;
        outer += w.s[k] > 0.0;
    }
    rc = outer == 0 ? CUT_NOTHING : inner == 0 ? CUT_ALL : -1;
    if (rc >= 0 || shape_alloc(&to, (int64_t)a->nv + nl, (int64_t)a->nf + 1, 3 * (int64_t)nl, err)) goto done;
    memcpy(to.v, a->v, (size_t)a->nv * sizeof *to.v);
    for (int32_t f = 0; f < a->nf; f++) {
        const int32_t begin = at, *loop = a->loop + a->first[f], m = a->first[f + 1] - a->first[f];
        int inside = 0;
        for (int32_t k = 0; k < m; k++) inside |= w.s[loop[k]] < 0.0;
        if (!inside) continue;
        for (int32_t k = 0; k < m; k++) {
            const int32_t i = loop[k], j = loop[k + 1 < m ? k + 1 : 0];
            const double si = w.s[i], sj = w.s[j];
            if (si <= 0.0) to.loop[at++] = i;
            if (!(si * sj < 0.0)) continue;
            const int32_t p = si < 0.0 ? i : j, q = si < 0.0 ? j : i;
            int32_t *id = find_split(&w.split, p, q);
            if (!*id) {
                to.v[most] = v3_lerp(a->v[p], a->v[q], w.s[p] / (w.s[p] - w.s[q]));
                *id = most++;
            }
            to.loop[at++] = *id;
        }
        for (int32_t k = begin; k < at; k++) {
            const int32_t u = to.loop[k], x = to.loop[k + 1 < at ? k + 1 : begin];
            const int on = (u >= a->nv || w.s[u] >= 0.0) && (x >= a->nv || w.s[x] >= 0.0);
            if (!on) continue;
            /* This side runs from u to x on the plane, the cap from x to u.  Two faces that share the side
             * need no cap. */
            if (w.next[u] == x) {
                w.next[u] = -1;
                links--;
            } else {
                links += w.next[x] < 0;
                w.next[x] = u;
            }
        }
        to.tag[to.nf++] = a->tag[f];
        to.first[to.nf] = at;
    }
    const int32_t cap = close_cap(&to, at, w.next, most, links);
    if (cap < 0) {
        fl_fail(err, FL_NUMERIC, "the cut by a plane does not close: the body is too thin for it");
        goto done;
    }
    if (cap > 0) {
        to.tag[to.nf++] = tag;
        to.first[to.nf] = at + cap;
    }
    renumber_vertices(&to, w.place, most);
    shape_free(a);
    *a = to;
    to = (struct shape){0};
    rc = CUT_SOME;
done:
    free(w.mem);
    shape_free(&to);
    return rc;
}

static int32_t root_of(int32_t *up, int32_t v)
{
    while (up[v] != v) v = up[v] = up[up[v]];
    return v;
}

/* Merges corners closer than tol, drops faces without interior and builds the polyhedron.  Returns CUT_SOME,
 * CUT_ALL when a solid has lost its volume, or -1. */
static int build_result(struct shape *s, double tol, fl_poly *out, fl_err *err)
{
    const int solid = s->nf > 2;
    int32_t *up = fl_alloc(s->nv, sizeof *up, err), at = 0, nf = 0;
    fl_err why = {0};
    if (!up) return -1;
    for (int32_t v = 0; v < s->nv; v++) up[v] = v;
    for (int32_t f = 0; f < s->nf; f++)
        for (int32_t k = s->first[f]; k < s->first[f + 1]; k++) {
            const int32_t i = s->loop[k], j = s->loop[k + 1 < s->first[f + 1] ? k + 1 : s->first[f]];
            if (v3_norm(v3_sub(s->v[i], s->v[j])) > tol) continue;
            const int32_t a = root_of(up, i), b = root_of(up, j);
            if (a < b) up[b] = a;
            else up[a] = b;
        }
    for (int32_t f = 0; f < s->nf; f++) {
        const int32_t begin = at, from = s->first[f], to = s->first[f + 1];
        s->first[nf] = begin;
        for (int32_t k = from; k < to; k++) {
            const int32_t v = root_of(up, s->loop[k]);
            if (at == begin || s->loop[at - 1] != v) s->loop[at++] = v;
        }
        while (at > begin + 1 && s->loop[at - 1] == s->loop[begin]) at--;
        if (at - begin < 3) at = begin;
        else s->tag[nf++] = s->tag[f];
    }
    s->first[nf] = at;
    s->nf = nf;
    renumber_vertices(s, up, s->nv);
    free(up);
    if (solid && nf < 4) return CUT_ALL;
    if (fl_poly_make(out, s->nv, s->v, s->nf, s->first, s->loop, &why) == 0) return CUT_SOME;
    if (why.code == FL_SYSTEM) return fl_fail(err, FL_SYSTEM, "%s", why.text);
    return fl_fail(err, FL_NUMERIC, "the rest of the cut is too thin: %s", why.text);
}

static int copy_to_shape(struct shape *s, const fl_poly *p, fl_err *err)
{
    const int32_t nl = p->first[p->nf];
    if (shape_alloc(s, p->nv, p->nf, nl, err)) return -1;
    s->nv = p->nv;
    s->nf = p->nf;
    memcpy(s->v, p->v, (size_t)p->nv * sizeof *p->v);
    memcpy(s->first, p->first, ((size_t)p->nf + 1) * sizeof *p->first);
    memcpy(s->loop, p->loop, (size_t)nl * sizeof *p->loop);
    return 0;
}

/* A point or a segment has no loops to cut. */
static int cut_point_or_segment(fl_poly *p, struct plane pl, double tol, fl_err *err)
{
    double s[2] = {0};
    fl_vec3 v[2];
    fl_poly out;
    for (int32_t k = 0; k < p->nv; k++) {
        s[k] = v3_dot(pl.n, p->v[k]) - pl.c;
        if (fabs(s[k]) <= tol) s[k] = 0.0;
        v[k] = p->v[k];
    }
    if (s[0] <= 0.0 && s[1] <= 0.0) return 0;
    if (s[0] >= 0.0 && s[1] >= 0.0) {
        fl_poly_free(p);
        return 0;
    }
    const int inner = s[0] < 0.0 ? 0 : 1, outer = 1 - inner;
    v[outer] = v3_lerp(v[inner], v[outer], s[inner] / (s[inner] - s[outer]));
    if (fl_poly_make(&out, 2, v, 0, NULL, NULL, err)) return -1;
    fl_poly_free(p);
    *p = out;
    return 0;
}

int fl_poly_cut(fl_poly *p, fl_vec3 n, double c, fl_err *err)
{
    double far;
    int rc = -1;
    const double size = box_extent(p->nv, p->v, &far), coarse = COARSE_TOL * far;

    if (p->nv <= 2) return cut_point_or_segment(p, (struct plane){n, c}, ON_TOL[0] * size + coarse, err);
    for (int k = 0; k < ON_TRIES && rc == -1; k++) {
        struct shape s = {0};
        fl_poly out = {0};
        fl_err why = {0};
        if (copy_to_shape(&s, p, &why) == 0) {
            rc = cut_shape(&s, (struct plane){n, c}, 0, ON_TOL[k] * size + coarse, &why);
            if (rc == CUT_SOME) rc = build_result(&s, WELD_TOL * size + coarse, &out, &why);
        }
        shape_free(&s);
        if (rc == CUT_SOME || rc == CUT_ALL) {
            fl_poly_free(p);
            *p = out;
        } else if (rc == -1 && (why.code == FL_SYSTEM || k + 1 == ON_TRIES)) {
            return fl_fail(err, why.code, "%s", why.text);
        }
    }
    return 0;
}

/* The smallest step d with n_k.d = miss_k for the n planes at a corner, by least squares.  Directions in
 * which the planes do not differ are left alone. */
static fl_vec3 solve_corner(int32_t n, const struct plane *pl, const double *miss)
{
    fl_vec3 rhs = {0}, d = {0};
    fl_mat3 a = {{{0}}}, axes;
    double value[3];
    if (n == 3) { /* the usual case; Cramer's rule is ten times faster */
        const fl_vec3 yz = v3_cross(pl[1].n, pl[2].n), zx = v3_cross(pl[2].n, pl[0].n),
                      xy = v3_cross(pl[0].n, pl[1].n);
        const double det = v3_dot(pl[0].n, yz);
        d = v3_madd(v3_madd(v3_scale(miss[0], yz), miss[1], zx), miss[2], xy);
        if (fabs(det) > DET_TOL) return v3_scale(1.0 / det, d);
        d = (fl_vec3){0};
    }
    for (int32_t k = 0; k < n; k++) {
        const double u[3] = {pl[k].n.x, pl[k].n.y, pl[k].n.z};
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++) a.m[i][j] += u[i] * u[j];
        rhs = v3_madd(rhs, miss[k], pl[k].n);
    }
    fl_mass_principal(&a, value, &axes);
    for (int k = 0; k < 3; k++) {
        const fl_vec3 e = m3_col(axes, k);
        if (value[k] > RANK_TOL * value[0]) d = v3_madd(d, v3_dot(e, rhs) / value[k], e);
    }
    return d;
}

/* Planes at one corner. */
struct corner_planes {
    struct plane *pl;
    double *miss;
    int32_t cap_pl, cap_miss;
};

static int reserve_corner(struct corner_planes *c, int32_t n, fl_err *err)
{
    return fl_grow(&c->pl, &c->cap_pl, n, sizeof *c->pl, err) ||
                   fl_grow(&c->miss, &c->cap_miss, n, sizeof *c->miss, err)
               ? -1
               : 0;
}

/* The faces at each vertex: face[first[v] .. first[v + 1]). */
static int faces_at_vertices(int32_t nv, int32_t nf, const int32_t *first, const int32_t *loop, int32_t **out,
                             int32_t **face, fl_err *err)
{
    const int32_t nl = first[nf];
    int32_t *at = fl_alloc((int64_t)nv + 2 + nl, sizeof *at, err);
    if (!at) return -1;
    *out = at;
    *face = at + nv + 2;
    for (int32_t k = 0; k < nl; k++) at[loop[k] + 2]++;
    for (int32_t v = 0; v < nv; v++) at[v + 2] += at[v + 1];
    for (int32_t f = 0; f < nf; f++)
        for (int32_t k = first[f]; k < first[f + 1]; k++) (*face)[at[loop[k] + 1]++] = f;
    return 0;
}

static int fail_too_far(double r, double most, fl_err *err)
{
    return fl_fail(err, FL_INPUT, "a corner is so sharp that moving the faces by %g m moves it beyond %g m",
                   r, most);
}

/* Moves every corner with its faces.  Returns 1 on success, 0 when the faces at a corner separate or an edge
 * would reverse, -1 with err. */
static int move_corners(fl_poly *out, const fl_poly *in, double r, double weld, fl_err *err)
{
    int32_t *first = NULL, *face;
    fl_vec3 *v = NULL;
    struct corner_planes c = {0};
    fl_err why = {0};
    const double most = FAR_MAX * (in->size + fabs(r));
    int rc = -1;

    if (in->nf == 2) return 0;
    v = fl_alloc(in->nv, sizeof *v, err);
    if (!v || faces_at_vertices(in->nv, in->nf, in->first, in->loop, &first, &face, err)) goto done;
    for (int32_t i = 0; i < in->nv; i++) {
        const int32_t n = first[i + 1] - first[i];
        fl_vec3 d = {0};
        if (reserve_corner(&c, n, err)) goto done;
        for (int32_t k = 0; k < n; k++) c.pl[k] = (struct plane){in->n[face[first[i] + k]], 0.0};
        for (int turn = 0; turn < 3;
             turn++) { /* the second and third iteration remove the rounding of the one before */
            for (int32_t k = 0; k < n; k++) c.miss[k] = r - v3_dot(c.pl[k].n, d);
            d = v3_add(d, solve_corner(n, c.pl, c.miss));
        }
        for (int32_t k = 0; k < n; k++)
            if (fabs(r - v3_dot(c.pl[k].n, d)) > MEET_TOL * (in->size + fabs(r))) {
                rc = 0;
                goto done;
            }
        if (v3_norm(d) > most) {
            fail_too_far(r, most, err);
            goto done;
        }
        v[i] = v3_add(in->v[i], d);
    }
    for (int32_t e = 0; e < in->ne; e++) {
        const fl_vec3 old = v3_sub(in->v[in->edge[e].b], in->v[in->edge[e].a]),
                      new = v3_sub(v[in->edge[e].b], v[in->edge[e].a]);
        if (!(v3_dot(old, new) > weld * v3_norm(old))) {
            rc = 0;
            goto done;
        }
    }
    rc = fl_poly_make(out, in->nv, v, in->nf, in->first, in->loop, &why) == 0;
    if (why.code == FL_SYSTEM) rc = fl_fail(err, FL_SYSTEM, "%s", why.text);
done:
    free(v);
    free(first);
    free(c.pl);
    free(c.miss);
    return rc;
}

/* Moves each vertex to the intersection of its planes: cuts of a large box leave it off by roundings of the
 * box. */
static int refine_vertices(struct shape *s, const struct plane *pl, fl_err *err)
{
    int32_t *first = NULL, *face;
    struct corner_planes c = {0};
    int rc = -1;
    if (faces_at_vertices(s->nv, s->nf, s->first, s->loop, &first, &face, err)) return -1;
    for (int32_t i = 0; i < s->nv; i++) {
        const int32_t n = first[i + 1] - first[i];
        if (reserve_corner(&c, n, err)) goto done;
        for (int32_t k = 0; k < n; k++) c.pl[k] = pl[s->tag[face[first[i] + k]]];
        for (int turn = 0; turn < 2; turn++) {
            for (int32_t k = 0; k < n; k++) c.miss[k] = c.pl[k].c - v3_dot(c.pl[k].n, s->v[i]);
            s->v[i] = v3_add(s->v[i], solve_corner(n, c.pl, c.miss));
        }
    }
    rc = 0;
done:
    free(first);
    free(c.pl);
    free(c.miss);
    return rc;
}

/* Collects the planes about the working origin o.  A flat polygon also gets the planes of its edges. */
static int32_t gather_planes(const fl_poly *in, fl_vec3 o, double r, struct plane *pl)
{
    int32_t n = 0;
    for (int32_t f = 0; f < in->nf; f++) {
        double c = -INFINITY;
        for (int32_t k = in->first[f]; k < in->first[f + 1]; k++)
            c = fmax(c, v3_dot(in->n[f], v3_sub(in->v[in->loop[k]], o)));
        pl[n++] = (struct plane){in->n[f], c + r};
    }
    for (int32_t k = 0; in->nf == 2 && k < in->first[1]; k++) {
        const fl_vec3 a = v3_sub(in->v[in->loop[k]], o),
                      b = v3_sub(in->v[in->loop[k + 1 < in->first[1] ? k + 1 : 0]], o);
        const fl_vec3 m = v3_unit(v3_cross(v3_sub(b, a), in->n[0]));
        pl[n++] = (struct plane){m, v3_dot(m, a) + r};
    }
    return n;
}

/* Makes a box of the given half side about the working origin.  Its planes have the numbers from tag on. */
static int start_box(struct shape *s, double half, int32_t tag, fl_err *err)
{
    fl_poly box;
    if (fl_poly_box(&box, v3(half, half, half), err)) return -1;
    const int rc = copy_to_shape(s, &box, err);
    for (int32_t f = 0; rc == 0 && f < 6; f++) s->tag[f] = tag + f;
    fl_poly_free(&box);
    return rc;
}

/* Cuts a box about o by all half-spaces.  The box grows until none of its faces is left.  on is the tolerance
 * of a vertex on a plane, relative to the size.  Returns CUT_... or -1. */
static int intersect_half_spaces(fl_poly *out, const fl_poly *in, fl_vec3 o, double r, double on, fl_err *err)
{
    struct plane *pl = fl_alloc((int64_t)in->nf + in->first[1], sizeof *pl, err);
    struct shape s = {0};
    const double reach = in->size + fabs(r);
    double far;
    int rc = -1, shows = 1;
    if (!pl) return -1;
    const int32_t n = gather_planes(in, o, r, pl);
    for (double half = 2.0 * reach; shows; half *= 8.0) {
        if (half > FAR_MAX * reach) {
            fail_too_far(r, FAR_MAX * reach, err);
            goto done;
        }
        shape_free(&s);
        if (start_box(&s, half, n, err)) goto done;
        for (int32_t k = 0; k < n; k++) {
            rc = cut_shape(&s, pl[k], k, on * box_extent(s.nv, s.v, &far), err);
            if (rc < 0 || rc == CUT_ALL) goto done;
        }
        rc = -1;
        shows = 0;
        for (int32_t f = 0; f < s.nf; f++) shows |= s.tag[f] >= n;
    }
    if (refine_vertices(&s, pl, err)) goto done;
    const double size = box_extent(s.nv, s.v, &far);
    for (int32_t v = 0; v < s.nv; v++) s.v[v] = v3_add(s.v[v], o);
    box_extent(s.nv, s.v, &far);
    rc = build_result(&s, WELD_TOL * size + COARSE_TOL * far, out, err);
done:
    shape_free(&s);
    free(pl);
    return rc;
}

int fl_poly_offset(fl_poly *out, const fl_poly *in, double r, fl_err *err)
{
    double far;
    fl_vec3 o = {0};
    if (!isfinite(r)) return fl_fail(err, FL_INPUT, "faces cannot be moved by %g m", r);
    if (in->nv <= 2)
        return fl_fail(err, FL_INPUT, "a %s has no faces to move", in->nv == 1 ? "point" : "segment");
    if (in->nf == 2 && r < 0.0)
        return fl_fail(err, FL_INPUT, "moving the faces of a flat core inward by %g m leaves nothing", -r);
    const double size = box_extent(in->nv, in->v, &far);
    const int moved = r == 0.0
                          ? (fl_poly_copy(out, in, err) ? -1 : 1)
                          : move_corners(out, in, r, WELD_TOL * (size + fabs(r)) + COARSE_TOL * far, err);
    if (moved) return moved < 0 ? -1 : 0;
    for (int32_t v = 0; v < in->nv; v++) o = v3_add(o, v3_sub(in->v[v], in->v[0]));
    o = v3_madd(in->v[0], 1.0 / in->nv, o);
    for (int k = 0;; k++) {
        fl_err why = {0};
        const int rc = intersect_half_spaces(out, in, o, r, ON_TOL[k], &why);
        if (rc == CUT_SOME) return 0;
        if (rc == CUT_ALL)
            return fl_fail(err, FL_INPUT, "moving the faces inward by %g m leaves nothing", -r);
        if (why.code != FL_NUMERIC || k + 1 == ON_TRIES) return fl_fail(err, why.code, "%s", why.text);
    }
}
