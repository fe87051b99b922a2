/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <float.h>
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "base/pi.h"
#include "geom/poly.h"

/* Planes may miss their vertices, and vertices lie outside planes, by this fraction of the size: the rounding
 * of input written with ten digits. */
static const double FLAT_TOL = 1e-9;
/* Shorter edges and narrower faces have no reliable direction: with vertices accurate to DBL_EPSILON size the
 * normal of a face of this width is accurate to 1e-5 rad. */
static const double WIDTH_TOL = 1e-10;
/* Rounding of coordinates far from the origin: a coordinate of magnitude m carries m eps / 2, a plane through
 * three points a few times that. */
static const double COARSE_TOL = 8 * DBL_EPSILON;
/* Up to this many vertex-plane pairs all are tested; beyond, the local test of edges is used. */
enum { ALL_PAIRS = 1 << 16 };

/* Working data of fl_poly_make(). */
struct build {
    fl_poly p;
    double flat, width;     /* tolerances [m] */
    int32_t *work;          /* one block: */
    int32_t *face;          /* [nh] the face of each half-edge */
    int32_t *order, *other; /* [nh] half-edges while sorting */
    int32_t *count;         /* [nv + 1] */
};

/* Allocates the arrays of p in one block, widest alignment first.  nl is the total loop length. */
static int allocate_arrays(fl_poly *p, int32_t nl, fl_err *err)
{
    const size_t nv = (size_t)p->nv, nf = (size_t)p->nf, ne = (size_t)p->ne;
    const size_t bytes = (nv + nf) * sizeof(fl_vec3) + (nf + ne + nv) * sizeof(double) +
                         ne * sizeof(fl_edge) + (nf + 1 + (size_t)nl + nv + 1 + 2 * ne) * sizeof(int32_t);
    char *at = fl_alloc((int64_t)bytes, 1, err);
    if (!at) return -1;
    p->v = (fl_vec3 *)(void *)at;
    p->n = p->v + nv;
    p->c = (double *)(void *)(p->n + nf);
    p->bend = p->c + nf;
    p->defect = p->bend + ne;
    p->edge = (fl_edge *)(void *)(p->defect + nv);
    p->first = (int32_t *)(void *)(p->edge + ne);
    p->loop = p->first + nf + 1;
    p->neighbour_first = p->loop + nl;
    p->neighbour = p->neighbour_first + nv + 1;
    return 0;
}

/* Returns the loop length, or -1.  Checks: offsets rise, three vertices per face, indices in range. */
static int32_t check_loops(int32_t nv, int32_t nf, const int32_t *first, const int32_t *loop, fl_err *err)
{
    if (first[0] != 0)
        return fl_fail(err, FL_INPUT, "face 0 starts at %d of the index list, not at 0", first[0]);
    for (int32_t f = 0; f < nf; f++) {
        if ((int64_t)first[f + 1] - first[f] < 3)
            return fl_fail(err, FL_INPUT, "face %d has %lld vertices, at least 3 are expected", f,
                           (long long)first[f + 1] - first[f]);
        for (int32_t k = first[f]; k < first[f + 1]; k++)
            if (loop[k] < 0 || loop[k] >= nv)
                return fl_fail(err, FL_INPUT, "face %d names vertex %d, but there are %d (0 to %d)", f,
                               loop[k], nv, nv - 1);
    }
    if (first[nf] % 2)
        return fl_fail(err, FL_INPUT, "the faces have %d sides in all, an odd number: the core is not closed",
                       first[nf]);
    return first[nf];
}

static int32_t next_vertex(const fl_poly *p, int32_t f, int32_t k)
{
    return p->loop[k + 1 < p->first[f + 1] ? k + 1 : p->first[f]];
}

fl_vec3 fl_poly_face_area_vector(const fl_poly *p, int32_t f)
{
    const fl_vec3 o = p->v[p->loop[p->first[f]]];
    fl_vec3 s = {0};
    fl_vec3 a = v3_sub(p->v[p->loop[p->first[f] + 1]], o);
    for (int32_t k = p->first[f] + 2; k < p->first[f + 1]; k++) {
        const fl_vec3 b = v3_sub(p->v[p->loop[k]], o);
        s = v3_add(s, v3_cross(a, b));
        a = b;
    }
    return v3_scale(0.5, s);
}

double fl_poly_largest_face_area(const fl_poly *p)
{
    double area = 0.0;
    for (int32_t f = 0; f < p->nf; f++) area = fmax(area, v3_norm(fl_poly_face_area_vector(p, f)));
    return area;
}

static double plane_offset(const fl_poly *p, int32_t f)
{
    double c = -INFINITY;
    for (int32_t k = p->first[f]; k < p->first[f + 1]; k++) c = fmax(c, v3_dot(p->n[f], p->v[p->loop[k]]));
    return c;
}

/* A polygon whose corners all turn left and which turns once in total is convex and simple.  Four corners of
 * less than pi each cannot turn twice, so the angles are summed from five corners on. */
static int check_face(struct build *b, int32_t f, fl_err *err)
{
    fl_poly *p = &b->p;
    const int32_t m = p->first[f + 1] - p->first[f], *at = p->loop + p->first[f];
    const fl_vec3 area = fl_poly_face_area_vector(p, f);
    double longest = 0.0, turn = 0.0, low = INFINITY;
    for (int32_t k = 0; k < m; k++) {
        const int32_t i = at[k], j = at[k + 1 < m ? k + 1 : 0];
        const double len = v3_norm(v3_sub(p->v[j], p->v[i]));
        if (i == j) return fl_fail(err, FL_INPUT, "face %d names vertex %d twice", f, i);
        if (len <= b->width)
            return fl_fail(err, FL_INPUT, "vertices %d and %d coincide: they are %g m apart", i, j, len);
        longest = fmax(longest, len);
    }
    if (2.0 * v3_norm(area) <= b->width * longest)
        return fl_fail(err, FL_INPUT, "face %d has no area: its vertices lie on a line", f);
    p->n[f] = v3_unit(area);
    p->c[f] = plane_offset(p, f);
    for (int32_t k = 0; k < m; k++) low = fmin(low, v3_dot(p->n[f], p->v[at[k]]));
    if (p->c[f] - low > b->flat)
        return fl_fail(err, FL_INPUT, "face %d is not flat: its vertices span %g m across its plane", f,
                       p->c[f] - low);
    for (int32_t k = 0; k < m; k++) {
        const fl_vec3 x = p->v[at[k]], in = v3_sub(x, p->v[at[k ? k - 1 : m - 1]]),
                      out = v3_sub(p->v[at[k + 1 < m ? k + 1 : 0]], x);
        const double s = v3_dot(v3_cross(in, out), p->n[f]), c = v3_dot(in, out);
        /* s over the longer side is the distance of the shorter side's far end from the longer's line */
        if (s < -b->flat * sqrt(fmax(v3_norm2(in), v3_norm2(out))))
            return fl_fail(err, FL_INPUT, "face %d is not convex at vertex %d", f, at[k]);
        if (m > 4) turn += atan2(s, c);
    }
    if (m > 4 && turn > 9.0) /* between one turn, 6.28, and two, 12.57 */
        return fl_fail(err, FL_INPUT, "face %d winds round more than once", f);
    return 0;
}

/* Reports what is wrong with face f when some vertex lies outside it. */
static int fail_outside(const struct build *b, int32_t f, fl_err *err)
{
    const fl_poly *p = &b->p;
    double low = INFINITY, high = -INFINITY;
    int32_t worst = 0;
    for (int32_t v = 0; v < p->nv; v++) {
        const double d = v3_dot(p->n[f], p->v[v]) - p->c[f];
        low = fmin(low, d);
        if (d > high) {
            high = d;
            worst = v;
        }
    }
    if (low >= -b->flat) return fl_fail(err, FL_INPUT, "face %d is turned inside out", f);
    return fl_fail(err, FL_INPUT, "vertex %d lies %g m outside face %d: the core is not convex", worst, high,
                   f);
}

/* The mean vertex lies inside a convex body, and well inside unless the body is flat. */
static int check_inside(const struct build *b, fl_vec3 mean, fl_err *err)
{
    const fl_poly *p = &b->p;
    const int all = (int64_t)p->nv * p->nf <= ALL_PAIRS;
    double deep = INFINITY;
    for (int32_t f = 0; f < p->nf; f++) {
        double d = v3_dot(p->n[f], mean) - p->c[f];
        deep = fmin(deep, -d);
        for (int32_t v = 0; all && v < p->nv; v++) d = fmax(d, v3_dot(p->n[f], p->v[v]) - p->c[f]);
        if (d > b->flat) return fail_outside(b, f, err);
    }
    if (p->nf > 2 && deep <= b->width)
        return fl_fail(err, FL_INPUT, "the core is flat and has %d faces: a flat core has two, one each way",
                       p->nf);
    return 0;
}

static int compare_points(const void *a, const void *b)
{
    const fl_vec3 *s = a, *t = b;
    if (s->x < t->x || s->x > t->x) return s->x < t->x ? -1 : 1;
    if (s->y < t->y || s->y > t->y) return s->y < t->y ? -1 : 1;
    return (s->z > t->z) - (s->z < t->z);
}

/* Reports a gap at edge (i, j).  A common cause is a vertex given twice, so that is searched. */
static int fail_open(struct build *b, int32_t i, int32_t j, int32_t f, const char *how, fl_err *err)
{
    fl_vec3 *v = fl_alloc(b->p.nv, sizeof *v, err);
    int twice = 0;
    if (!v) return -1;
    memcpy(v, b->p.v, (size_t)b->p.nv * sizeof *v);
    qsort(v, (size_t)b->p.nv, sizeof *v, compare_points);
    for (int32_t k = 0; k + 1 < b->p.nv && !twice; k++) twice = compare_points(v + k, v + k + 1) == 0;
    free(v);
    return fl_fail(err, FL_INPUT, "the edge of vertices %d and %d, on face %d, %s%s", i, j, f, how,
                   twice ? " (some vertices coincide)" : "");
}

/* Pairs the half-edges by two stable counting sorts, by the larger end and then by the smaller.  This brings
 * the halves of an edge together and puts the edges in (a, b) order, in linear time. */
static int pair_edges(struct build *b, fl_err *err)
{
    fl_poly *p = &b->p;
    const int32_t nh = p->first[p->nf];
    for (int32_t f = 0; f < p->nf; f++)
        for (int32_t k = p->first[f]; k < p->first[f + 1]; k++) b->face[k] = f;
    for (int pass = 0; pass < 2; pass++) {
        memset(b->count, 0, ((size_t)p->nv + 1) * sizeof *b->count);
        for (int turn = 0; turn < 2; turn++) {
            for (int32_t s = 0; s < nh; s++) {
                const int32_t k = pass ? b->other[s] : s, i = p->loop[k], j = next_vertex(p, b->face[k], k);
                const int32_t key = (pass == 0) == (i > j) ? i : j;
                if (turn == 0) b->count[key + 1]++;
                else (pass ? b->order : b->other)[b->count[key]++] = k;
            }
            for (int32_t v = 0; turn == 0 && v < p->nv; v++) b->count[v + 1] += b->count[v];
        }
    }
    for (int32_t s = 0; s < nh; s += 2) {
        int32_t h = b->order[s], t = b->order[s + 1];
        const int32_t i = p->loop[h], j = next_vertex(p, b->face[h], h), k = p->loop[t],
                      l = next_vertex(p, b->face[t], t);
        if (i == k && j == l)
            return fail_open(b, i, j, b->face[h], "has the same direction in another face", err);
        if (i != l || j != k)
            return fail_open(b, i, j, b->face[h], "has no second face: the core is not closed", err);
        if (s + 2 < nh) {
            const int32_t m = b->order[s + 2], q = p->loop[m], r = next_vertex(p, b->face[m], m);
            if ((q == i && r == j) || (q == j && r == i))
                return fail_open(b, i, j, b->face[m], "belongs to more than two faces", err);
        }
        if (i > j) {
            const int32_t swap = h;
            h = t;
            t = swap;
        }
        p->edge[s / 2] = (fl_edge){i < j ? i : j, i < j ? j : i, b->face[h], b->face[t]};
    }
    return 0;
}

static int32_t root_of(int32_t *up, int32_t f)
{
    while (up[f] != f) f = up[f] = up[up[f]];
    return f;
}

/* One surface, with the Euler characteristic of a sphere. */
static int check_topology(struct build *b, fl_err *err)
{
    const fl_poly *p = &b->p;
    int32_t pieces = p->nf;
    int32_t *up = b->face; /* nf < nh, and the faces of half-edges are no longer needed */
    for (int32_t f = 0; f < p->nf; f++) up[f] = f;
    for (int32_t e = 0; e < p->ne; e++) {
        const int32_t l = root_of(up, p->edge[e].left), r = root_of(up, p->edge[e].right);
        pieces -= l != r;
        if (l < r) up[r] = l;
        else up[l] = r;
    }
    if (pieces > 1)
        return fl_fail(err, FL_INPUT, "the faces form %d separate surfaces, one is expected", pieces);
    if (p->nv - p->ne + p->nf != 2)
        return fl_fail(err, FL_INPUT,
                       "%d vertices, %d edges and %d faces do not form a sphere: V - E + F = %d, not 2",
                       p->nv, p->ne, p->nf, p->nv - p->ne + p->nf);
    return 0;
}

static int check_used(struct build *b, fl_err *err)
{
    const fl_poly *p = &b->p;
    memset(b->count, 0, ((size_t)p->nv + 1) * sizeof *b->count);
    for (int32_t k = 0; k < p->first[p->nf]; k++) b->count[p->loop[k]] = 1;
    for (int32_t v = 0; v < p->nv; v++)
        if (!b->count[v]) return fl_fail(err, FL_INPUT, "vertex %d belongs to no face", v);
    return 0;
}

/* No edge is concave: tests the vertices of each face against the plane across the edge. */
static int check_edges_convex(const struct build *b, fl_err *err)
{
    const fl_poly *p = &b->p;
    if ((int64_t)p->nv * p->nf <= ALL_PAIRS) return 0; /* all pairs were tested */
    for (int32_t e = 0; e < p->ne; e++) {
        const fl_edge s = p->edge[e];
        const fl_vec3 along = v3_unit(v3_sub(p->v[s.b], p->v[s.a]));
        /* Convex: the left normal turns into the right one about `along`.  The sine of the bend times the
         * extent of the smaller face bounds how far that face lies outside the other's plane. */
        const double bend = v3_dot(v3_cross(p->n[s.left], p->n[s.right]), along);
        if (bend >= 0.0 && v3_dot(p->n[s.left], p->n[s.right]) > -1.0) continue;
        for (int side = 0; side < 2; side++) {
            const int32_t f = side ? s.right : s.left, g = side ? s.left : s.right;
            for (int32_t k = p->first[g]; k < p->first[g + 1]; k++) {
                const double d = v3_dot(p->n[f], p->v[p->loop[k]]) - p->c[f];
                if (d > b->flat)
                    return fl_fail(err, FL_INPUT,
                                   "vertex %d lies %g m outside face %d: the core is not convex", p->loop[k],
                                   d, f);
            }
        }
    }
    return 0;
}

/* A ray from inside through the middle of face 0 leaves the body there and nowhere else.  A surface that is
 * convex at every edge and passes this test covers its body once (Mehlhorn et al. 1999). */
static int check_covers_once(const struct build *b, fl_vec3 mean, fl_err *err)
{
    const fl_poly *p = &b->p;
    fl_vec3 aim = {0};
    if (p->nf == 2) return 0;
    for (int32_t k = p->first[0]; k < p->first[1]; k++) aim = v3_add(aim, v3_sub(p->v[p->loop[k]], mean));
    aim = v3_unit(aim);
    for (int32_t f = 1; f < p->nf; f++) {
        const double rate = v3_dot(p->n[f], aim);
        int inside = rate > 0.0;
        if (!inside) continue;
        const fl_vec3 x = v3_madd(mean, (p->c[f] - v3_dot(p->n[f], mean)) / rate, aim);
        for (int32_t k = p->first[f]; k < p->first[f + 1] && inside; k++) {
            const fl_vec3 a = p->v[p->loop[k]], s = v3_sub(p->v[next_vertex(p, f, k)], a);
            /* on the boundary within the tolerance is outside: two faces may share the plane of face 0 */
            inside = v3_dot(v3_cross(s, v3_sub(x, a)), p->n[f]) > b->flat * v3_norm(s);
        }
        if (inside) return fl_fail(err, FL_INPUT, "faces 0 and %d lie over each other", f);
    }
    return 0;
}

static fl_vec3 mean_vertex(const fl_poly *p)
{
    fl_vec3 s = {0};
    for (int32_t v = 0; v < p->nv; v++) s = v3_add(s, v3_sub(p->v[v], p->v[0]));
    return v3_madd(p->v[0], 1.0 / p->nv, s);
}

static double size_of(const fl_poly *p)
{
    const fl_aabb box = fl_poly_aabb(p);
    return fmax(box.hi.x - box.lo.x, fmax(box.hi.y - box.lo.y, box.hi.z - box.lo.z));
}

/* Runs all checks of a core with faces. */
static int check_faces(struct build *b, fl_err *err)
{
    fl_poly *p = &b->p;
    const fl_vec3 mean = mean_vertex(p);
    for (int32_t f = 0; f < p->nf; f++)
        if (check_face(b, f, err)) return -1;
    return check_used(b, err) || check_inside(b, mean, err) || pair_edges(b, err) || check_topology(b, err) ||
                   check_edges_convex(b, err) || check_covers_once(b, mean, err)
               ? -1
               : 0;
}

int fl_poly_make(fl_poly *p, int32_t nv, const fl_vec3 *v, int32_t nf, const int32_t *first,
                 const int32_t *loop, fl_err *err)
{
    struct build b = {.p = {.nv = nv, .nf = nf, .ne = nv == 2 ? 1 : 0}};
    int32_t nl = 0;
    int rc = -1;
    double far = 0.0;

    if (nv < 1) return fl_fail(err, FL_INPUT, "a core needs a vertex");
    if (nf < 0) return fl_fail(err, FL_INPUT, "%d faces are not possible", nf);
    if (nv <= 2 && nf != 0)
        return fl_fail(err, FL_INPUT, "a core of %d %s has no faces, %d given", nv,
                       nv == 1 ? "vertex" : "vertices", nf);
    if (nv > 2 && nf < 2)
        return fl_fail(err, FL_INPUT, "a core of %d vertices needs at least 2 faces, %d given", nv, nf);
    for (int32_t k = 0; k < nv; k++) {
        if (!isfinite(v[k].x) || !isfinite(v[k].y) || !isfinite(v[k].z))
            return fl_fail(err, FL_INPUT, "vertex %d is not finite", k);
        far = fmax(far, fmax(fabs(v[k].x), fmax(fabs(v[k].y), fabs(v[k].z))));
    }
    if (far > 1e100)
        return fl_fail(err, FL_INPUT, "a vertex lies %g m away", far); /* its square would overflow */
    if (nf > 0) {
        nl = check_loops(nv, nf, first, loop, err);
        if (nl < 0) return -1;
        b.p.ne = nl / 2;
    }
    if (allocate_arrays(&b.p, nl, err)) return -1;
    memcpy(b.p.v, v, (size_t)nv * sizeof *v);
    if (nf > 0) {
        memcpy(b.p.first, first, ((size_t)nf + 1) * sizeof *first);
        memcpy(b.p.loop, loop, (size_t)nl * sizeof *loop);
        b.work = fl_alloc(3 * (int64_t)nl + nv + 1, sizeof *b.work, err);
        if (!b.work) goto done;
        b.face = b.work;
        b.order = b.face + nl;
        b.other = b.order + nl;
        b.count = b.other + nl;
    }
    b.p.size = size_of(&b.p);
    b.flat = FLAT_TOL * b.p.size + COARSE_TOL * far;
    b.width = WIDTH_TOL * b.p.size + COARSE_TOL * far;
    if (nv == 2) {
        b.p.edge[0] = (fl_edge){0, 1, -1, -1};
        if (v3_norm(v3_sub(v[1], v[0])) <= b.width) {
            fl_fail(err, FL_INPUT, "vertices 0 and 1 coincide: a sphere has one vertex");
            goto done;
        }
    }
    if (nf > 0 && check_faces(&b, err)) goto done;
    fl_poly_angles(&b.p);
    *p = b.p;
    b.p = (fl_poly){0};
    rc = 0;
done:
    free(b.work);
    fl_poly_free(&b.p);
    return rc;
}

int fl_poly_box(fl_poly *p, fl_vec3 h, fl_err *err)
{
    const fl_vec3 xy[4] = {{-h.x, -h.y, 0}, {h.x, -h.y, 0}, {h.x, h.y, 0}, {-h.x, h.y, 0}};
    if (!(h.x > 0.0 && h.y > 0.0 && h.z > 0.0))
        return fl_fail(err, FL_INPUT, "a box of half sides %g, %g, %g m is not possible", h.x, h.y, h.z);
    return fl_poly_prism(p, 4, xy, -h.z, h.z, err);
}

int fl_poly_prism(fl_poly *p, int32_t n, const fl_vec3 *xy, double z0, double z1, fl_err *err)
{
    fl_vec3 *v = NULL;
    int32_t *first = NULL, *loop;
    int rc = -1;
    if (n < 3 || n > INT32_MAX / 12)
        return fl_fail(err, FL_INPUT, "a prism over %d corners is not possible", n);
    if (!(z0 < z1)) return fl_fail(err, FL_INPUT, "a prism from z = %g to %g m is not possible", z0, z1);
    v = fl_alloc(2 * (int64_t)n, sizeof *v, err);
    first = fl_alloc(7 * (int64_t)n + 3, sizeof *first, err);
    if (!v || !first) goto done;
    loop = first + n + 3;
    first[1] = n;
    first[2] = 2 * n;
    for (int32_t k = 0; k < n; k++) {
        const int32_t m = k + 1 < n ? k + 1 : 0;
        v[k] = v3(xy[k].x, xy[k].y, z0);
        v[n + k] = v3(xy[k].x, xy[k].y, z1);
        loop[k] = n - 1 - k;
        loop[n + k] = n + k;
        first[3 + k] = first[2 + k] + 4;
        memcpy(loop + first[2 + k], (int32_t[4]){k, m, n + m, n + k}, 4 * sizeof *loop);
    }
    rc = fl_poly_make(p, 2 * n, v, n + 2, first, loop, err);
done:
    free(v);
    free(first);
    return rc;
}

int fl_poly_copy(fl_poly *to, const fl_poly *from, fl_err *err)
{
    fl_poly p = {.nv = from->nv, .nf = from->nf, .ne = from->ne, .size = from->size};
    const int32_t nl = from->first[from->nf];
    if (allocate_arrays(&p, nl, err)) return -1;
    memcpy(p.v, from->v, (size_t)p.nv * sizeof *p.v);
    memcpy(p.n, from->n, (size_t)p.nf * sizeof *p.n);
    memcpy(p.edge, from->edge, (size_t)p.ne * sizeof *p.edge);
    memcpy(p.first, from->first, ((size_t)p.nf + 1) * sizeof *p.first);
    memcpy(p.loop, from->loop, (size_t)nl * sizeof *p.loop);
    for (int32_t f = 0; f < p.nf; f++) p.c[f] = from->c ? from->c[f] : plane_offset(&p, f);
    if (!from->bend) { /* from has no angles, or a few */
        fl_poly_angles(&p);
        for (int32_t e = 0; e < p.ne; e++)
            if (fl_poly_edge_angle(from, e) < FL_POLY_BLUNT_EDGE) p.bend[e] = fl_poly_edge_angle(from, e);
        for (int32_t v = 0; v < p.nv; v++)
            if (fl_poly_corner_angle(from, v) < FL_POLY_BLUNT_CORNER)
                p.defect[v] = fl_poly_corner_angle(from, v);
        *to = p;
        return 0;
    }
    memcpy(p.bend, from->bend, (size_t)p.ne * sizeof *p.bend);
    memcpy(p.defect, from->defect, (size_t)p.nv * sizeof *p.defect);
    memcpy(p.neighbour_first, from->neighbour_first, ((size_t)p.nv + 1) * sizeof *p.neighbour_first);
    memcpy(p.neighbour, from->neighbour, (size_t)from->neighbour_first[p.nv] * sizeof *p.neighbour);
    *to = p;
    return 0;
}

int fl_poly_strip(fl_poly *p, fl_err *err)
{
    fl_poly q = {.nv = p->nv, .nf = p->nf, .size = p->size};
    const size_t corners = (size_t)p->nv * sizeof *p->v, faces = ((size_t)p->nf + 1) * sizeof *p->first,
                 loops = (size_t)p->first[p->nf] * sizeof *p->loop;
    char *at = fl_alloc((int64_t)(corners + faces + loops), 1, err);
    if (!at) return -1;
    q.v = memcpy(at, p->v, corners);
    q.first = memcpy(at + corners, p->first, faces);
    q.loop = memcpy(at + corners + faces, p->loop, loops);
    fl_poly_free(p);
    *p = q;
    return 0;
}

void fl_poly_to_frame(fl_poly *p, fl_vec3 o, fl_mat3 axes)
{
    for (int32_t v = 0; v < p->nv; v++) p->v[v] = m3_tmul(axes, v3_sub(p->v[v], o));
    for (int32_t f = 0; f < p->nf; f++) {
        p->n[f] = m3_tmul(axes, p->n[f]);
        /* from the moved vertices: c - n.o would cancel far from the origin */
        if (p->c) p->c[f] = plane_offset(p, f);
    }
    p->size = size_of(p);
}

double fl_poly_compute_bend(const fl_poly *p, int32_t e)
{
    const fl_edge s = p->edge[e];
    if (s.left < 0 || s.right < 0) return s.left == s.right ? 2.0 * PI : PI;
    const fl_vec3 l = p->n[s.left], r = p->n[s.right];
    const double sine = v3_dot(v3_cross(l, r), v3_unit(v3_sub(p->v[s.b], p->v[s.a]))), cosine = v3_dot(l, r);
    /* rounding may bend a flat edge inward, and -0 would turn pi into -pi */
    return fabs(sine) < 1e-12 ? (cosine > 0.0 ? 0.0 : PI) : atan2(sine, cosine);
}

void fl_poly_angles(fl_poly *p)
{
    for (int32_t v = 0; v <= p->nv; v++) p->neighbour_first[v] = 0;
    for (int32_t v = 0; v < p->nv; v++) p->defect[v] = p->nv == 1 ? 4.0 * PI : 2.0 * PI;
    for (int32_t e = 0; e < p->ne; e++) {
        p->bend[e] = fl_poly_compute_bend(p, e);
        p->neighbour_first[p->edge[e].a + 1]++;
        p->neighbour_first[p->edge[e].b + 1]++;
    }
    for (int32_t v = 0; v < p->nv; v++) p->neighbour_first[v + 1] += p->neighbour_first[v];
    for (int32_t e = 0; e < p->ne; e++) { /* edges are sorted: first the lower neighbours, then the higher */
        p->neighbour[p->neighbour_first[p->edge[e].b]++] = p->edge[e].a;
    }
    for (int32_t e = 0; e < p->ne; e++) p->neighbour[p->neighbour_first[p->edge[e].a]++] = p->edge[e].b;
    for (int32_t v = p->nv; v > 0; v--) p->neighbour_first[v] = p->neighbour_first[v - 1];
    p->neighbour_first[0] = 0;
    for (int32_t f = 0; f < p->nf; f++) {
        const int32_t *loop = p->loop + p->first[f], n = p->first[f + 1] - p->first[f];
        for (int32_t k = 0; k < n; k++) {
            const fl_vec3 x = p->v[loop[k]], to = v3_sub(p->v[loop[(k + 1) % n]], x),
                          from = v3_sub(p->v[loop[(k + n - 1) % n]], x);
            p->defect[loop[k]] -= atan2(v3_norm(v3_cross(to, from)), v3_dot(to, from));
        }
    }
}

double fl_poly_bytes(const fl_poly *p)
{
    const size_t nv = (size_t)p->nv, nf = (size_t)p->nf, ne = (size_t)p->ne;
    if (!p->v) return 0.0;
    size_t sum = (p->v ? nv * sizeof *p->v : 0) + (p->n ? nf * sizeof *p->n : 0) +
                 (p->c ? nf * sizeof *p->c : 0) +
                 (p->bend ? nv * sizeof *p->defect + ne * sizeof *p->bend : 0) +
                 (size_t)p->kept_angles * (sizeof(double) + sizeof(int32_t));
    if (p->first && !p->shared) sum += (nf + 1 + (size_t)p->first[nf]) * sizeof(int32_t);
    if (p->edge && !p->shared) sum += ne * sizeof *p->edge + (nv + 1 + 2 * ne) * sizeof(int32_t);
    return (double)sum;
}

fl_aabb fl_poly_aabb(const fl_poly *p)
{
    fl_aabb box = aabb_empty();
    for (int32_t v = 0; v < p->nv; v++) box = aabb_add(box, p->v[v]);
    return box;
}

void fl_poly_free(fl_poly *p)
{
    free(p->v);
    *p = (fl_poly){0};
}
