/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include "patch/quick_faces.h"
#include "base/array.h"
#include "geom/quadrature_rules.h"

/* Of the sizes of the cores: how far below the plane of the other face a point still counts as on it. */
#define ON_PLANE_TOL 1e-12

/* Sides of the polygon P that are not of the other face. */
enum { OWN_SIDE = -1, CUT = -2, PAD = FL_SIMD_WIDTH };

/* P in the plane of the other face: plane coordinates and overlap of its corners, and the side of the
 * other face that begins there.  [n + 2 PAD]; once closed, the first is repeated behind the last. */
enum { X, Y, OVERLAP, SIDE, COLUMNS };
typedef struct {
    double *a[COLUMNS];
} outline;

/* A face of the own core over the plane of one of the other. */
typedef struct {
    const fl_quick_direction *d;
    const fl_quick_face *f; /* of the other core */
    const fl_quick_side *side;
    fl_vec3 n;         /* normal of the own face, in the frame of other */
    double C, m, dm;   /* C = -n.n_f, m and dm/dC */
    double s0, sx, sy; /* s = s0 + sx x + sy y */
    outline p, spare;
    double *g; /* scratch */
    int32_t corners, room;
} face_pair;

/* The end of the part with g >= 0 between corner k and the next. */
FL_SIMD_INLINE void cut_side(const face_pair *q, int32_t k, int32_t next, double to[COLUMNS])
{
    const double part = q->g[k] / (q->g[k] - q->g[next]);
    FL_SIMD_UNROLL
    for (int c = 0; c < COLUMNS; c++) to[c] = q->p.a[c][k] + part * (q->p.a[c][next] - q->p.a[c][k]);
}

/* Moves n corners; those behind them may be overwritten. */
FL_SIMD_INLINE void move_corners(face_pair *q, int32_t from, int32_t to, int32_t n)
{
    const int32_t last = (n - 1) / FL_SIMD_WIDTH * FL_SIMD_WIDTH;
    if (from == to) return;
    for (int c = 0; c < COLUMNS; c++) {
        double *const a = q->p.a[c];
        if (from > to)
            for (int32_t k = 0; k < n; k += FL_SIMD_WIDTH)
                FL_SIMD_STORE(a + to + k) = FL_SIMD_LOAD(a + from + k);
        else
            for (int32_t k = last; k >= 0; k -= FL_SIMD_WIDTH)
                FL_SIMD_STORE(a + to + k) = FL_SIMD_LOAD(a + from + k);
    }
}

FL_SIMD_INLINE void set_corner(face_pair *q, int32_t k, const double from[COLUMNS])
{
    FL_SIMD_UNROLL
    for (int c = 0; c < COLUMNS; c++) q->p.a[c][k] = from[c];
}

/* Keeps the part of the polygon with g >= 0, given at its corners; those with g < 0 follow one another.
 *   outside, corners   the first that is outside and their number, over the last corner to the first */
FL_SIMD_INLINE void clip_convex(face_pair *q, uint64_t outside, int32_t side)
{
    const int32_t n = q->corners, out = __builtin_popcountll(outside);
    double leaves[COLUMNS], enters[COLUMNS];
    if (outside & 1) { /* those inside move to the front, behind the corner where the polygon enters */
        const int32_t first = __builtin_ctzll(~outside), end = first + n - out;
        cut_side(q, first - 1, first, enters), enters[SIDE] = q->p.a[SIDE][first - 1];
        cut_side(q, end - 1, end < n ? end : 0, leaves), leaves[SIDE] = (double)side;
        move_corners(q, first, 1, n - out);
        set_corner(q, 0, enters), set_corner(q, n - out + 1, leaves);
    } else {
        const int32_t first = __builtin_ctzll(outside), end = first + out;
        cut_side(q, first - 1, first, leaves), leaves[SIDE] = (double)side;
        cut_side(q, end - 1, end < n ? end : 0, enters), enters[SIDE] = q->p.a[SIDE][end - 1];
        if (end < n) move_corners(q, end, first + 2, n - end);
        set_corner(q, first, leaves), set_corner(q, first + 1, enters);
    }
    q->corners = n - out + 2;
}

/* The same wherever corners are outside.  A convex polygon gains one corner at most.  One that rounding has
 * bent may gain more: what has no room is left out. */
static void clip_any(face_pair *q, int32_t side)
{
    const outline to = q->spare;
    const double *g = q->g;
    int32_t m = 0;
    for (int32_t k = 0; k < q->corners; k++) {
        const int32_t next = k + 1 < q->corners ? k + 1 : 0;
        const int in = g[k] >= 0.0, then = g[next] >= 0.0;
        double cut[COLUMNS];
        if (in && m < q->room) {
            for (int c = 0; c < COLUMNS; c++) to.a[c][m] = q->p.a[c][k];
            m++;
        }
        if (in == then || m == q->room) continue;
        cut_side(q, k, next, cut), cut[SIDE] = in ? (double)side : q->p.a[SIDE][k];
        for (int c = 0; c < COLUMNS; c++) to.a[c][m] = cut[c];
        m++;
    }
    q->spare = q->p, q->p = to, q->corners = m;
}

/* Clips to c - qx x - qy y >= 0.  Returns 0 when nothing is left. */
FL_SIMD_INLINE int clip_side(face_pair *q, double c, double qx, double qy, int32_t side)
{
    enum { BITS = 64 };
    const int32_t n = q->corners;
    const fl_simd zero = {0};
    const fl_simd_mask bit = {1, 2, 4, 8};
    fl_simd_mask any = zero != 0.0;
    for (int32_t k = 0; k < n; k += FL_SIMD_WIDTH) {
        const fl_simd g = c - qx * FL_SIMD_LOAD(q->p.a[X] + k) - qy * FL_SIMD_LOAD(q->p.a[Y] + k);
        FL_SIMD_STORE(q->g + k) = g;
        any |= (g < 0.0) & FL_SIMD_MASK_BELOW(n - k);
    }
    if (!fl_simd_any(&any)) return 1;
    uint64_t outside = 0; /* a bit of each corner, if there are so few */
    for (int32_t k = 0; k < n && n < BITS; k += FL_SIMD_WIDTH) {
        const fl_simd_mask m = (FL_SIMD_LOAD(q->g + k) < 0.0) & FL_SIMD_MASK_BELOW(n - k) & bit;
        outside |= (uint64_t)(m[0] | m[1] | m[2] | m[3]) << k;
    }
    /* and of each that is unlike the next */
    const uint64_t next = outside >> 1 | (outside & 1) << (n < BITS ? n - 1 : 0);
    if (n < BITS && outside == (UINT64_C(1) << n) - 1) return 0;
    if (n < BITS && n < q->room && __builtin_popcountll(outside ^ next) == 2) clip_convex(q, outside, side);
    else clip_any(q, side);
    return q->corners >= 3;
}

/* Repeats the first corner behind the last, for registers that begin at any corner. */
FL_SIMD_INLINE void close_polygon(face_pair *q)
{
    FL_SIMD_UNROLL
    for (int c = 0; c < COLUMNS; c++) {
        double *const end = q->p.a[c] + q->corners;
        const fl_simd first = FL_SIMD_SPLAT(q->p.a[c][0]);
        FL_SIMD_STORE(end) = first, FL_SIMD_STORE(end + FL_SIMD_WIDTH) = first;
    }
}

/* Point of the own face over (x, y). */
static fl_vec3 point_at(const face_pair *q, double x, double y, double s)
{
    const fl_quick_face *f = q->f;
    return v3_madd(v3_madd(v3_scale(f->height + q->d->reach - s, f->n), x, f->t1), y, f->t2);
}

static fl_wrench force_at(fl_vec3 f, fl_vec3 x) { return (fl_wrench){f, v3_cross(x, f)}; }

/* A corner of the closed polygon. */
typedef struct {
    double x, y, s;
    int32_t side;
} corner;

static corner corner_of(const face_pair *q, int32_t k)
{
    return (corner){q->p.a[X][k], q->p.a[Y][k], q->p.a[OVERLAP][k], (int32_t)q->p.a[SIDE][k]};
}

/* How near the own face comes, D = int z^4/int z^3 over the polygon with z = s + R > 0, and its gradient:
 * with z growing by -n_f.u and the border moving,
 *     dD int z^3 = -int (4 z^3 - 3 D z^2) n_f.u dP - sum over sides int (z^4 - D z^3) q.u dl.
 * D is at least 2R/3 where the faces touch. */
static double find_nearness(const face_pair *q, fl_wrench *rise)
{
    const double R = q->d->R;
    double area3 = 0.0, area4 = 0.0;
    double D = 0.0;
    *rise = (fl_wrench){.f = {0}};
    for (int pass = 0; pass < 2; pass++) {
        for (int32_t k = 1; k + 1 < q->corners; k++) {
            const corner a = corner_of(q, 0), b = corner_of(q, k), c = corner_of(q, k + 1);
            const double T = 0.5 * ((b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y));
            for (int i = 0; i < FL_TRIANGLE_NODES; i++) {
                const double *at = FL_TRIANGLE_NODE[i], w = T * FL_TRIANGLE_WEIGHT[i];
                const double x = at[0] * a.x + at[1] * b.x + at[2] * c.x,
                             y = at[0] * a.y + at[1] * b.y + at[2] * c.y,
                             s = at[0] * a.s + at[1] * b.s + at[2] * c.s, z = s + R, z2 = z * z;
                if (pass == 0) area3 += w * z2 * z, area4 += w * z2 * z2;
                else
                    *rise = fl_wrench_madd(*rise, -w * (4.0 * z - 3.0 * D) * z2,
                                           force_at(q->f->n, point_at(q, x, y, s)));
            }
        }
        if (pass > 0) break;
        if (!(area3 > 0.0)) return 0.0;
        D = area4 / area3;
    }
    for (int32_t k = 0; k < q->corners; k++) {
        const corner a = corner_of(q, k), b = corner_of(q, k + 1);
        const double l = sqrt((b.x - a.x) * (b.x - a.x) + (b.y - a.y) * (b.y - a.y));
        if (a.side < 0) continue;
        for (int i = 0; i < FL_LINE4_NODES; i++) {
            const double t = FL_LINE4_NODE[i], x = a.x + t * (b.x - a.x), y = a.y + t * (b.y - a.y),
                         s = a.s + t * (b.s - a.s), z = s + R;
            *rise = fl_wrench_madd(*rise, -l * FL_LINE4_WEIGHT[i] * (z - D) * z * z * z,
                                   force_at(q->side[a.side].q, point_at(q, x, y, s)));
        }
    }
    *rise = fl_wrench_madd((fl_wrench){.f = {0}}, 1.0 / area3, *rise);
    return D;
}

/* Area of the polygon on the own face. */
FL_SIMD_INLINE double find_area(const face_pair *q)
{
    const double *x = q->p.a[X], *y = q->p.a[Y];
    double area = 0.0;
    for (int32_t k = 1; k + 1 < q->corners; k++)
        area += (x[k] - x[0]) * (y[k + 1] - y[0]) - (x[k + 1] - x[0]) * (y[k] - y[0]);
    return 0.5 * area / q->C;
}

/* Its gradient: -int q.u dl over the sides of f, over C. */
static fl_wrench area_gradient(const face_pair *q)
{
    fl_wrench rise = {.f = {0}};
    for (int32_t k = 0; k < q->corners; k++) {
        const corner a = corner_of(q, k), b = corner_of(q, k + 1);
        if (a.side < 0) continue;
        const double l = sqrt((b.x - a.x) * (b.x - a.x) + (b.y - a.y) * (b.y - a.y));
        const fl_vec3 middle = point_at(q, 0.5 * (a.x + b.x), 0.5 * (a.y + b.y), 0.5 * (a.s + b.s));
        rise = fl_wrench_madd(rise, -l / q->C, force_at(q->side[a.side].q, middle));
    }
    return rise;
}

/* Share of the edges of the own face that the pair bears.  The polygon is not yet cut at s = 0; where it does
 * not touch it is cut at z = 0 here.  least: the least s. */
static int find_support(face_pair *q, double a0, int touching, double least, int32_t own,
                        fl_quick_support *to)
{
    const double far = FL_QUICK_NEARNESS * q->d->R;
    fl_wrench of_area = {.f = {0}}, of_nearness = of_area;
    /* 1 - h of the sine S of the angle, and its derivative by C, S dS = -C dC */
    const double S2 = 1.0 - q->C * q->C, S = S2 > 0.0 ? sqrt(S2) : 0.0;
    double dS;
    const double by_angle = 1.0 - fl_quick_step((S - FL_QUICK_FLAT) / (FL_QUICK_TILTED - FL_QUICK_FLAT), &dS);
    if (!(by_angle > 0.0)) return 0;
    double da, dn = 0.0, by_nearness = 1.0;
    const double by_area = fl_quick_step(find_area(q) / a0, &da);
    if (!(by_area > 0.0)) return 0;
    if (da > 0.0) close_polygon(q), of_area = area_gradient(q);
    if (!touching) {
        if (least < -q->d->R && !clip_side(q, q->s0 + q->d->R, -q->sx, -q->sy, CUT)) return 0;
        close_polygon(q);
        by_nearness = fl_quick_step(find_nearness(q, &of_nearness) / far, &dn);
    }
    const double by_others = by_area * by_nearness;
    *to = (fl_quick_support){.share = by_angle * by_others, .face = own};
    to->reach = by_angle * by_area * dn / far;
    if (da > 0.0) to->rise = fl_wrench_madd(to->rise, by_angle * da / a0 * by_nearness, of_area);
    if (dn > 0.0) to->rise = fl_wrench_madd(to->rise, to->reach, of_nearness);
    if (dS > 0.0) {
        const double by_C = dS / (FL_QUICK_TILTED - FL_QUICK_FLAT) * q->C / S;
        to->rise.m = v3_madd(to->rise.m, -by_C * by_others, v3_cross(q->n, q->f->n));
    }
    return to->share > 0.0;
}

/* Integrals over P of s^n times 1, x, y and, for s^3, their products about the first corner; and of
 * s^4 over the sides of f, with their normals: force and moment in the axes t1, t2, n_f. */
typedef struct {
    double i2, i3, i4, x, y, xx, xy, yy;
    double f1, f2, m1, m2, m3;
} area_sums;

/* A fan of triangles T, four side by side, by complete homogeneous symmetric polynomials h_n of the three s:
 *     int s^n = 2T n!/(n+2)! h_n,  int s^n x = 2T n!/(n+3)! sum x_i h_n(s, s_i),
 *     int s^n x y = 2T n!/(n+4)! sum x_i y_j (1 + [i = j]) h_n(s, s_i, s_j). */
FL_SIMD_INLINE void integrate_fan(const face_pair *q, area_sums *to)
{
    const struct {
        const double *x, *y, *s, *side;
    } p = {q->p.a[X], q->p.a[Y], q->p.a[OVERLAP], q->p.a[SIDE]};
    const double a = p.s[0], x0 = p.x[0], y0 = p.y[0];
    const fl_simd zero = {0};
    fl_simd i2 = zero, i3 = zero, i4 = zero, sx = zero, sy = zero, xx = zero, xy = zero, yy = zero;
    for (int32_t k = 1; k + 1 < q->corners; k += FL_SIMD_WIDTH) {
        const fl_simd_mask some = FL_SIMD_MASK_BELOW(q->corners - 1 - k);
        const fl_simd b = FL_SIMD_LOAD(p.s + k), c = FL_SIMD_LOAD(p.s + k + 1);
        const fl_simd x1 = FL_SIMD_LOAD(p.x + k) - x0, y1 = FL_SIMD_LOAD(p.y + k) - y0,
                      x2 = FL_SIMD_LOAD(p.x + k + 1) - x0, y2 = FL_SIMD_LOAD(p.y + k + 1) - y0;
        const fl_simd T = FL_SIMD_MASKED(some, 0.5 * (x1 * y2 - x2 * y1));
        const fl_simd ab1 = a + b, ab2 = a * a + b * ab1, ab3 = a * a * a + b * ab2,
                      ab4 = a * a * a * a + b * ab3;
        const fl_simd h1 = ab1 + c, h2 = ab2 + c * h1, h3 = ab3 + c * h2, h4 = ab4 + c * h3;
        /* with b once more, with c once more, and pairs of them */
        const fl_simd b1 = h1 + b, b2 = h2 + b * b1, b3 = h3 + b * b2;
        const fl_simd c1 = h1 + c, c2 = h2 + c * c1, c3 = h3 + c * c2;
        const fl_simd bb3 = b3 + b * (b2 + b * (b1 + b)), cc3 = c3 + c * (c2 + c * (c1 + c)),
                      bc3 = b3 + c * (b2 + c * (b1 + c));
        i2 += T * h2, i3 += T * h3, i4 += T * h4;
        sx += T * (x1 * b3 + x2 * c3), sy += T * (y1 * b3 + y2 * c3);
        const fl_simd one = T * bb3, two = T * cc3, mix = T * bc3;
        xx += one * x1 * x1 + two * x2 * x2 + mix * x1 * x2;
        yy += one * y1 * y1 + two * y2 * y2 + mix * y1 * y2;
        xy += one * x1 * y1 + two * x2 * y2 + 0.5 * mix * (x1 * y2 + x2 * y1);
    }
    to->i2 = fl_simd_sum(&i2) / 6.0, to->i3 = fl_simd_sum(&i3) / 10.0, to->i4 = fl_simd_sum(&i4) / 15.0;
    to->x = fl_simd_sum(&sx) / 60.0, to->y = fl_simd_sum(&sy) / 60.0;
    to->xx = fl_simd_sum(&xx) / 210.0, to->xy = fl_simd_sum(&xy) / 210.0, to->yy = fl_simd_sum(&yy) / 210.0;
}

/* Sides of f on the border: -int s^4 q.u dl is the force q int s^4 dl. */
FL_SIMD_INLINE void integrate_sides(const face_pair *q, area_sums *to)
{
    const struct {
        const double *x, *y, *s, *side;
    } p = {q->p.a[X], q->p.a[Y], q->p.a[OVERLAP], q->p.a[SIDE]};
    const fl_simd zero = {0};
    const double top = q->f->height + q->d->reach;
    fl_simd f1 = zero, f2 = zero, m1 = zero, m2 = zero, m3 = zero;
    for (int32_t k = 0; k < q->corners; k += FL_SIMD_WIDTH) {
        fl_simd qx = zero, qy = zero, l;
        int any = 0;
        for (int i = 0; i < FL_SIMD_WIDTH && k + i < q->corners; i++)
            if (p.side[k + i] >= 0.0) {
                const fl_quick_side *side = &q->side[(int32_t)p.side[k + i]];
                qx[i] = side->qx, qy[i] = side->qy, any = 1;
            }
        if (!any) continue;
        const fl_simd xa = FL_SIMD_LOAD(p.x + k), xb = FL_SIMD_LOAD(p.x + k + 1), ya = FL_SIMD_LOAD(p.y + k),
                      yb = FL_SIMD_LOAD(p.y + k + 1), s = FL_SIMD_LOAD(p.s + k),
                      t = FL_SIMD_LOAD(p.s + k + 1);
        const fl_simd l2 = (xb - xa) * (xb - xa) + (yb - ya) * (yb - ya);
        for (int i = 0; i < FL_SIMD_WIDTH; i++) l[i] = sqrt(l2[i]);
        const fl_simd s2 = s * s, e1 = s + t, e2 = s2 + t * e1, e3 = s2 * s + t * e2, e4 = s2 * s2 + t * e3;
        const fl_simd r1 = e1 + s, r2 = e2 + s * r1, r3 = e3 + s * r2, r4 = e4 + s * r3; /* with s twice */
        const fl_simd u1 = e1 + t, u2 = e2 + t * u1, u3 = e3 + t * u2, u4 = e4 + t * u3;
        const fl_simd wa = l * r4, wb = l * u4, w = wa + wb, z = wa * (top - s) + wb * (top - t);
        f1 += w * qx, f2 += w * qy, m1 -= z * qy, m2 += z * qx;
        m3 += (wa * xa + wb * xb) * qy - (wa * ya + wb * yb) * qx;
    }
    const double each = 1.0 / 30.0;
    to->f1 = each * fl_simd_sum(&f1), to->f2 = each * fl_simd_sum(&f2), to->m1 = each * fl_simd_sum(&m1);
    to->m2 = each * fl_simd_sum(&m2), to->m3 = each * fl_simd_sum(&m3);
}

FL_SIMD_INLINE fl_vec3 from_axes(const fl_quick_face *f, double a, double b, double c)
{
    return v3_madd(v3_madd(v3_scale(a, f->t1), b, f->t2), c, f->n);
}

/* Adds the term of the pair from its integrals. */
FL_SIMD_INLINE void add_area(const face_pair *q, fl_quick_total *to)
{
    const fl_quick_face *f = q->f;
    area_sums i;
    integrate_fan(q, &i);
    const double factor = 0.5 * q->m / q->C, e = 4.0 * factor * i.i3;
    if (!(e > 0.0)) return;
    integrate_sides(q, &i);
    const double each = 1.0 / i.i3, rx = i.x * each, ry = i.y * each, cx = q->p.a[X][0] + rx,
                 cy = q->p.a[Y][0] + ry, s = q->s0 + q->sx * cx + q->sy * cy;
    const double turned = 0.5 * (q->dm / q->C) * i.i4;
    const fl_vec3 force = from_axes(f, factor * i.f1, factor * i.f2, factor * 4.0 * i.i3),
                  moment =
                      v3_madd(from_axes(f, factor * i.m1 + e * cy, factor * i.m2 - e * cx, factor * i.m3),
                              turned, v3_cross(q->n, f->n)),
                  direction = v3_scale(e, f->n);
    /* the middle of the overlap, and second moments in the plane of f about it */
    const fl_vec3 p = from_axes(f, cx, cy, f->height + q->d->reach - 0.5 * s - q->d->r);
    const double w = e * each, xx = w * (i.xx - i.x * rx), xy = w * (i.xy - i.x * ry),
                 yy = w * (i.yy - i.y * ry);
    const fl_vec3 g = v3_madd(v3_scale(xx, f->t1), xy, f->t2), h = v3_madd(v3_scale(xy, f->t1), yy, f->t2),
                  ep = v3_scale(e, p);
    double *const a = to->a;
    a[FL_QUICK_U] += factor * i.i4, a[FL_QUICK_REACH] += e, a[FL_QUICK_DDU] += 12.0 * factor * i.i2;
    a[FL_QUICK_E] += e;
    a[FL_QUICK_F] += force.x, a[FL_QUICK_F + 1] += force.y, a[FL_QUICK_F + 2] += force.z;
    a[FL_QUICK_M] += moment.x, a[FL_QUICK_M + 1] += moment.y, a[FL_QUICK_M + 2] += moment.z;
    a[FL_QUICK_DIRECTION] += direction.x, a[FL_QUICK_DIRECTION + 1] += direction.y,
        a[FL_QUICK_DIRECTION + 2] += direction.z;
    a[FL_QUICK_EX] += ep.x, a[FL_QUICK_EY] += ep.y, a[FL_QUICK_EZ] += ep.z;
    a[FL_QUICK_XX] += ep.x * p.x + g.x * f->t1.x + h.x * f->t2.x;
    a[FL_QUICK_XY] += ep.x * p.y + g.x * f->t1.y + h.x * f->t2.y;
    a[FL_QUICK_XZ] += ep.x * p.z + g.x * f->t1.z + h.x * f->t2.z;
    a[FL_QUICK_YY] += ep.y * p.y + g.y * f->t1.y + h.y * f->t2.y;
    a[FL_QUICK_YZ] += ep.y * p.z + g.y * f->t1.z + h.y * f->t2.z;
    a[FL_QUICK_ZZ] += ep.z * p.z + g.z * f->t1.z + h.z * f->t2.z;
}

/* Projects own face j; returns 0 where no corner is nearer than R + R.  *low, *high: of s. */
FL_SIMD_INLINE int project_face(face_pair *q, const fl_quick_face *j)
{
    const fl_quick_direction *d = q->d;
    const fl_quick_face *f = q->f;
    const double per = 1.0 / q->C;
    const double *const *v = (const double *const *)d->own->corner;
    const fl_vec3 a = m3_tmul(d->M, f->t1), b = m3_tmul(d->M, f->t2), c = m3_tmul(d->M, f->n);
    const double oa = v3_dot(f->t1, d->o), ob = v3_dot(f->t2, d->o),
                 oc = d->reach + f->height - v3_dot(f->n, d->o);
    fl_simd most = FL_SIMD_SPLAT(-INFINITY);
    for (int32_t k = 0; k < j->sides; k += FL_SIMD_WIDTH) { /* reversed: it goes round as f does */
        const fl_simd x = FL_SIMD_LOAD(v[0] + j->first + k), y = FL_SIMD_LOAD(v[1] + j->first + k),
                      z = FL_SIMD_LOAD(v[2] + j->first + k);
        const fl_simd s = oc - (c.x * x + c.y * y + c.z * z);
        const fl_simd_mask some = FL_SIMD_MASK_BELOW(j->sides - k) & (s > most);
        FL_SIMD_STORE(q->p.a[X] + k) = a.x * x + a.y * y + a.z * z + oa;
        FL_SIMD_STORE(q->p.a[Y] + k) = b.x * x + b.y * y + b.z * z + ob;
        FL_SIMD_STORE(q->p.a[OVERLAP] + k) = s;
        FL_SIMD_STORE(q->p.a[SIDE] + k) = FL_SIMD_SPLAT((double)OWN_SIDE);
        most = FL_SIMD_SELECT(some, s, most);
    }
    q->corners = j->sides;
    q->sx = -per * v3_dot(q->n, f->t1), q->sy = -per * v3_dot(q->n, f->t2);
    q->s0 = q->p.a[OVERLAP][0] - q->sx * q->p.a[X][0] - q->sy * q->p.a[Y][0];
    const fl_simd_mask near = most > -d->R;
    return fl_simd_any(&near);
}

/* Adds a pair of faces; returns 1 if it bears edges of its own face. */
FL_SIMD_INLINE int add_pair(face_pair *q, int32_t own, int32_t other, fl_quick_total *to,
                            fl_quick_support *support, double *overlap)
{
    const fl_quick_direction *d = q->d;
    const fl_quick_face *j = &d->own->face[own];
    q->f = &d->other->face[other], q->side = d->other->side + q->f->first;
    q->n = m3_mul(d->M, j->n);
    const double C = q->C = -v3_dot(q->n, q->f->n), root = 4.0 * C * C - 3.0;
    if (!(C > 0.0 && root > 0.0) || !project_face(q, j)) return 0;
    q->m = root * root, q->dm = 16.0 * C * root;
    for (int32_t c = 0; c < q->f->sides; c++)
        if (!clip_side(q, q->side[c].inset_c, q->side[c].qx, q->side[c].qy, c)) return 0;
    const double most = d->reach + ON_PLANE_TOL * (d->own->bound + d->other->bound);
    double low = INFINITY, high = -INFINITY;
    for (int32_t k = 0; k < q->corners; k++) {
        const double s = q->p.a[OVERLAP][k];
        low = s < low ? s : low, high = s > high ? s : high;
    }
    if (high > most && !clip_side(q, most - q->s0, q->sx, q->sy, CUT)) return 0;
    const double least = j->area < q->f->area ? j->area : q->f->area, most_wide = d->R * sqrt(least),
                 a0 = most_wide < 0.5 * least ? most_wide : 0.5 * least;
    const int bears = find_support(q, a0, high > 0.0, low, own, support);
    if (!(high > 0.0)) return bears;
    if (low < 0.0) {
        if (!clip_side(q, q->s0, -q->sx, -q->sy, CUT)) return bears;
        double *const s = q->p.a[OVERLAP];
        for (int32_t k = 0; k < q->corners; k++) s[k] = s[k] > 0.0 ? s[k] : 0.0;
    }
    close_polygon(q);
    add_area(q, to);
    high = high < most ? high : most;
    *overlap = high > *overlap ? high : *overlap;
    return bears;
}

FL_SIMD_VERSIONS static int32_t add_pairs(face_pair *q, const int32_t *at, int32_t n, fl_quick_total *to,
                                          fl_quick_support *support, double *overlap)
{
    int32_t bear = 0;
    for (int32_t k = 0; k < n; k += 2) bear += add_pair(q, at[k], at[k + 1], to, &support[bear], overlap);
    return bear;
}

int fl_quick_add_faces(fl_quick_scratch *w, const fl_quick_direction *d, fl_quick_total *to,
                       const fl_quick_support **support, int32_t *n, double *overlap)
{
    int32_t pairs, most = 0;
    const int32_t *at = fl_quick_section_of(d->l, d->section + FL_QUICK_PAIR, &pairs);
    *n = 0;
    *support = w->support;
    if (pairs == 0) return 0;
    for (int32_t k = 0; k < pairs; k += 2) {
        const int32_t corners = d->own->face[at[k]].sides + d->other->face[at[k + 1]].sides + 3 + 2 * PAD;
        most = corners > most ? corners : most;
    }
    most = (most + FL_SIMD_WIDTH - 1) / FL_SIMD_WIDTH * FL_SIMD_WIDTH;
    if (fl_reserve(&w->polygon, &w->polygon_cap, (2 * COLUMNS + 1) * most, sizeof(double)) ||
        fl_reserve(&w->support, &w->support_cap, pairs / 2, sizeof(fl_quick_support)))
        return -1;
    double *const x = w->polygon;
    face_pair q = {.d = d, .g = x + 2 * COLUMNS * most, .room = most - 2 * PAD};
    for (int c = 0; c < COLUMNS; c++) q.p.a[c] = x + c * most, q.spare.a[c] = x + (COLUMNS + c) * most;
    *support = w->support;
    *n = add_pairs(&q, at, pairs, to, w->support, overlap);
    return 0;
}
