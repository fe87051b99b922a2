/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "geom/facet.h"

/* A quadrilateral is flat if its corners deviate less than this from a plane, relative to its diagonal.
 * float32 coordinates deviate by 1e-7 of their size, panels modelled as warped by 1e-3 and more. */
static const double FLAT_TOL = 1e-6;

/* Sides that turn by less than this [rad] are straight.  Rounding turns the sides of a panel of 1 m by up to
 * 1e-10 at 1e6 m from the origin. */
static const double STRAIGHT_TOL = 1e-9;

static const double TWO_PI = 6.283185307179586477;

/* Corner k of n on the unit circle.  The angle is reduced to an eighth of a turn before the C library is
 * called, so that opposite corners are opposite to the last bit. */
static void circle_corner(int32_t k, int32_t n, double *c, double *s)
{
    const int64_t eighth = 8 * (int64_t)k / n;   /* 0 .. 7 */
    const int64_t twice_area = (eighth + 1) / 2; /* quarter turns to subtract, 0 .. 4 */
    const double a = TWO_PI * (double)(4 * (int64_t)k - twice_area * n) / (4.0 * n), x = cos(a), y = sin(a);
    *c = twice_area % 4 == 0 ? x : twice_area % 4 == 1 ? -y : twice_area % 4 == 2 ? -x : y;
    *s = twice_area % 4 == 0 ? y : twice_area % 4 == 1 ? x : twice_area % 4 == 2 ? -y : -x;
}

/* Closes an end with the disc of n corners from `first` on; a point needs none.  A polygon is used, not a
 * fan:
 * ten thousand triangles at one corner make every neighbour search quadratic. */
static int close_end(fl_part *p, int32_t first, int32_t n, int reverse, fl_err *err)
{
    int32_t *loop;
    int rc;
    if (n == 1) return 0;
    loop = fl_alloc(n, sizeof *loop, err);
    if (!loop) return -1;
    for (int32_t k = 0; k < n; k++) loop[k] = first + (reverse ? n - 1 - k : k);
    rc = fl_facet_polygon(p, n, loop, err);
    free(loop);
    return rc;
}

int fl_facet_cone(fl_part *p, const fl_cone *c, int32_t n, fl_err *err)
{
    const fl_vec3 axis = v3_unit(v3_sub(c->p1, c->p0)), e0 = v3_normal_to(axis), e1 = v3_cross(axis, e0);
    int32_t first[2], count[2];
    for (int end = 0; end < 2; end++) {
        const double r = end ? c->r1 : c->r0;
        const fl_vec3 o = end ? c->p1 : c->p0;
        first[end] = p->nv;
        count[end] = r > 0.0 ? n : 1; /* an apex has one corner */
        for (int32_t k = 0; k < count[end]; k++) {
            double x, y;
            circle_corner(k, n, &x, &y);
            if (fl_surface_vertex(p, v3_madd(v3_madd(o, r * x, e0), r * y, e1), err)) return -1;
        }
    }
    for (int32_t k = 0; k < n; k++) {
        const int32_t next = k + 1 < n ? k + 1 : 0;
        const int32_t a = first[0] + k % count[0], b = first[0] + next % count[0];
        const int32_t d = first[1] + k % count[1], e = first[1] + next % count[1];
        if (a != b && fl_surface_triangle(p, a, b, e, err)) return -1;
        if (d != e && fl_surface_triangle(p, a, e, d, err)) return -1;
    }
    return close_end(p, first[0], count[0], 1, err) || close_end(p, first[1], count[1], 0, err) ? -1 : 0;
}

int fl_facet_box(fl_part *p, fl_vec3 lo, fl_vec3 hi, fl_err *err)
{
    /* bits 0, 1, 2 of corner k select the high x, y, z */
    static const int32_t face[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                       {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    const int32_t o = p->nv;
    for (int k = 0; k < 8; k++) {
        const fl_vec3 x = v3(k & 1 ? hi.x : lo.x, k & 2 ? hi.y : lo.y, k & 4 ? hi.z : lo.z);
        if (fl_surface_vertex(p, x, err)) return -1;
    }
    for (int f = 0; f < 6; f++) {
        const int32_t *q = face[f];
        if (fl_surface_triangle(p, o + q[0], o + q[1], o + q[2], err) ||
            fl_surface_triangle(p, o + q[0], o + q[2], o + q[3], err))
            return -1;
    }
    return 0;
}

/* --- polygons ------------------------------------------------------------------------------------------- */

/* Largest cosine of the triangle's angles, that of its smallest angle. */
static double largest_cosine(fl_vec3 a, fl_vec3 b, fl_vec3 c)
{
    const fl_vec3 ab = v3_unit(v3_sub(b, a)), bc = v3_unit(v3_sub(c, b)), ca = v3_unit(v3_sub(a, c));
    return fmax(-v3_dot(ca, ab), fmax(-v3_dot(ab, bc), -v3_dot(bc, ca)));
}

/* The diagonal that splits a convex quadrilateral: 0 from corner 0 to 2, 1 from corner 1 to 3. */
static int choose_diagonal(const fl_vec3 *x, const int32_t q[4])
{
    const fl_vec3 a = x[q[0]], b = x[q[1]], c = x[q[2]], d = x[q[3]];
    const double ac = v3_norm(v3_sub(c, a)), bd = v3_norm(v3_sub(d, b));
    const fl_vec3 n = v3_unit(v3_cross(v3_sub(c, a), v3_sub(d, b)));
    double one = ac, other = bd;
    /* n is normal to both diagonals; their distance along n is twice the deviation of the corners */
    if (fabs(v3_dot(n, v3_sub(b, a))) > 2.0 * FLAT_TOL * fmax(ac, bd)) {
        one = fmax(largest_cosine(a, b, c), largest_cosine(a, c, d));
        other = fmax(largest_cosine(b, c, d), largest_cosine(b, d, a));
    }
    if (one != other) return other < one;
    return (q[1] < q[3] ? q[1] : q[3]) < (q[0] < q[2] ? q[0] : q[2]);
}

/* Twice the area of a, b, c seen along n; positive when counter-clockwise. */
static double twice_area(fl_vec3 n, fl_vec3 a, fl_vec3 b, fl_vec3 c)
{
    return v3_dot(n, v3_cross(v3_sub(b, a), v3_sub(c, a)));
}

typedef struct {
    const fl_vec3 *x;
    fl_vec3 n;                   /* unit area vector */
    int32_t *loop, *prev, *next; /* remaining corners, as a ring */
    char *concave;
    int32_t n_left, n_concave; /* remaining corners, and the concave ones among them */
} ring;

/* Bound below which a turn is zero, for sides ab and bc or any two like them. */
static double turn_tolerance(fl_vec3 a, fl_vec3 b, fl_vec3 c)
{
    return STRAIGHT_TOL * v3_norm(v3_sub(b, a)) * v3_norm(v3_sub(c, b));
}

/* True if corner k does not turn left. */
static int is_concave(const ring *r, int32_t k)
{
    const fl_vec3 a = r->x[r->loop[r->prev[k]]], b = r->x[r->loop[k]], c = r->x[r->loop[r->next[k]]];
    return !(twice_area(r->n, a, b, c) > turn_tolerance(a, b, c));
}

static int same_point(fl_vec3 a, fl_vec3 b) { return a.x == b.x && a.y == b.y && a.z == b.z; }

/* An ear is a convex corner whose triangle contains no other corner, not even on its boundary.  Only concave
 * corners need the test.  A corner equal to one of the triangle belongs to a cut that leads to a hole. */
static int is_ear(const ring *r, int32_t k)
{
    const int32_t i = r->prev[k], j = r->next[k];
    const fl_vec3 a = r->x[r->loop[i]], b = r->x[r->loop[k]], c = r->x[r->loop[j]];
    const double tol = -turn_tolerance(a, b, c);
    if (r->concave[k]) return 0;
    if (r->n_concave == 0) return 1;
    for (int32_t m = r->next[j]; m != i; m = r->next[m]) {
        const fl_vec3 y = r->x[r->loop[m]];
        if (!r->concave[m] || same_point(y, a) || same_point(y, b) || same_point(y, c)) continue;
        if (twice_area(r->n, a, b, y) >= tol && twice_area(r->n, b, c, y) >= tol &&
            twice_area(r->n, c, a, y) >= tol)
            return 0;
    }
    return 1;
}

static void set_concave(ring *r, int32_t k, int concave)
{
    r->n_concave += concave - r->concave[k];
    r->concave[k] = (char)concave;
}

static int clip_ears(fl_part *p, ring *r, fl_err *err)
{
    int32_t k = 0, idle = 0; /* corners since the last ear */
    int crossed = 0;
    while (r->n_left > 3) {
        const int32_t i = r->prev[k], j = r->next[k];
        if (!crossed && !is_ear(r, k)) {
            /* A full round without an ear: the polygon intersects itself and is cut corner by corner. */
            crossed = ++idle == r->n_left;
            k = j;
            continue;
        }
        if (fl_surface_triangle(p, r->loop[i], r->loop[k], r->loop[j], err)) return -1;
        r->next[i] = j;
        r->prev[j] = i;
        r->n_left--;
        set_concave(r, k, 0);
        set_concave(r, i, is_concave(r, i));
        set_concave(r, j, is_concave(r, j));
        idle = 0;
        k = r->next[j]; /* not j: moving on keeps triangles from becoming slivers at one corner */
    }
    return fl_surface_triangle(p, r->loop[r->prev[k]], r->loop[k], r->loop[r->next[k]], err);
}

static int split_quadrilateral(fl_part *p, const int32_t q[4], fl_err *err)
{
    const int d = choose_diagonal(p->v, q);
    return fl_surface_triangle(p, q[d], q[d + 1], q[d + 2], err) ||
                   fl_surface_triangle(p, q[d], q[d + 2], q[(d + 3) % 4], err)
               ? -1
               : 0;
}

int fl_facet_polygon(fl_part *p, int32_t n, const int32_t *loop, fl_err *err)
{
    enum { STACK_CORNERS = 16 };
    ring r = {.x = p->v};
    int32_t few[4 * STACK_CORNERS], *mem = few;
    int rc = -1;
    if (n == 3) { /* common case */
        if (loop[0] == loop[1] || loop[1] == loop[2] || loop[2] == loop[0]) return 0;
        return fl_surface_triangle(p, loop[0], loop[1], loop[2], err);
    }
    if (n > STACK_CORNERS) mem = fl_alloc(4 * (int64_t)n, sizeof *mem, err);
    else memset(few, 0, sizeof few);
    if (!mem) return -1;
    r.loop = mem;
    r.prev = mem + n;
    r.next = mem + 2 * (int64_t)n;
    r.concave = (char *)(mem + 3 * (int64_t)n);
    for (int32_t k = 0; k < n; k++)
        if (loop[k] != loop[k ? k - 1 : n - 1]) r.loop[r.n_left++] = loop[k];
    if (r.n_left < 3) {
        rc = 0;
        goto done;
    }
    for (int32_t k = 0; k < r.n_left; k++) {
        r.prev[k] = k ? k - 1 : r.n_left - 1;
        r.next[k] = k + 1 < r.n_left ? k + 1 : 0;
        /* about corner 0, to keep precision far from the origin */
        r.n = v3_add(r.n, v3_cross(v3_sub(r.x[r.loop[k]], r.x[r.loop[0]]),
                                   v3_sub(r.x[r.loop[r.next[k]]], r.x[r.loop[0]])));
    }
    r.n = v3_unit(r.n);
    for (int32_t k = 0; k < r.n_left; k++) set_concave(&r, k, is_concave(&r, k));
    rc = r.n_left == 4 && r.n_concave == 0 ? split_quadrilateral(p, r.loop, err) : clip_ears(p, &r, err);
done:
    if (mem != few) free(mem);
    return rc;
}
