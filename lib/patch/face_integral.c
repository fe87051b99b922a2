/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "patch/face_integral.h"
#include <math.h>
#include "base/array.h"
#include "base/simd.h"
#include "geom/quadrature_rules.h"
#include "narrow/overlap.h"

/* fraction of the size of the core: how far below the other's plane a corner still counts as on it */
#define ON_PLANE_TOL 1e-13
/* Fraction of the sum of the absolute parts: a smaller sum is the rounding of parts that cancel. */
#define CANCEL_TOL 1e-13
#define BOUND_SHARE 0.5 /* part of its lower bound above which the sum for s^4 is used */
#define SLIM_CORNER 4.0 /* cotangent of half the angle of a corner */

/* A corner of F over the plane of f: plane coordinates and overlap.  own: 1 where the side that starts here
 * is a side of F, 0 where it is a cut. */
typedef struct {
    double x, y, s, own;
} corner;

/* The sides of f, one array a number, counter-clockwise: start of side c, its direction, its length.  D: path
 * to the inner border of the rim from its first corner, for a width of 1; tan: the component of D along the
 * side.  One more entry at the end repeats the first. */
typedef struct {
    double *x, *y, *ux, *uy, *length, *Dx, *Dy, *tan;
    fl_simd *lo, *hi; /* part of the inner border inside F, along the side; lo >= hi: none */
    int32_t n, room;  /* room: n rounded up to full registers */
    double width;
} face_border;

/* Integrals by lanes, about the origin of the lane: of s^3 times 1, x, y, xx, xy, yy and of s^2, all with the
 * rim weight; sum of the absolute parts of the first; the largest s. */
typedef struct {
    fl_simd m, x, y, xx, xy, yy, q, parts, most;
} lane_sums;

/* A piece of border, by lanes, relative to the origin of the lane: from (x, y) by (dx, dy); overlap from s by
 * ds; rim weight from w by dw. */
typedef struct {
    fl_simd x, y, dx, dy, s, ds, w, dw;
} border_piece;

/* All integrals, about the first corner of F, so that far from the origin no digits are lost. */
typedef struct {
    double m, x, y, xx, xy, yy, q, u, parts, most; /* u: of s^4 */
} polygon_sums;

/* F over the plane of f. */
typedef struct {
    fl_patch_points *w;
    const fl_patch_core *own;
    fl_plane_axes at;    /* origin and axes in the plane of f */
    const fl_vec3 *v;    /* vertices of the other core */
    const int32_t *loop; /* corners of f; NULL: a plane */
    fl_vec3 nf, nF;
    double slope, half, R; /* c = -n_F.n_f; half: 1/2, or 1 for a plane */
    double sx, sy;         /* slopes of s over F */
    double m, dm;          /* half m(c) and its derivative */
    corner *p;             /* [n + 1] F, counter-clockwise; the last repeats the first */
    int32_t n;
    fl_simd *away;            /* [n + 1] distances of the corners of F from four sides of f */
    fl_simd *from, *to;       /* [n] parts of sides of F inside a rim */
    int32_t *which;           /* [n] and their sides */
    fl_simd *beyond, *before; /* [n] begin and end of the parts inside the inner borders, by lanes */
    double *in, *out;         /* [n] begin and end of the parts inside all inner borders */
    polygon_sums sum;
    /* rim force and its moment about the first corner on the plane of f, in the axes at.x, at.y, nf */
    fl_vec3 pull, turn;
} projected_face;

/* Adds triangles from the origin to pieces of border.  With the overlap A at the origin and B on the border,
 *     int s^3 w rho^k dA = cross int_0^1 dt int_0^1 rho^(k+1) (A (1 - rho) + B rho)^3 w drho,
 * closed in rho, by Gauss' rule in t: exact but for the second moments in rims.
 *     faded   1: the weight w is 0 at the origin and linear, so it is rho times that on the border; 0: w = 1
 */
static inline __attribute__((always_inline)) void
add_fan(lane_sums *q, const border_piece *p, const fl_simd *at, const fl_simd_mask *counted, int faded)
{
    const fl_simd_mask valid = *counted;
    const fl_simd A = *at, A2 = A * A, A3 = A2 * A,
                  cross = FL_SIMD_MASKED(valid, p->x * p->dy - p->y * p->dx);
    const fl_simd from = FL_SIMD_MASKED(valid, p->s), end = FL_SIMD_MASKED(valid, p->s + p->ds), zero = {0};
    fl_simd sum = zero;
    for (int k = 0; k < FL_LINE3_NODES; k++) {
        const double z = FL_LINE3_NODE[k];
        const fl_simd B = p->s + z * p->ds, x = p->x + z * p->dx, y = p->y + z * p->dy;
        const fl_simd share = FL_LINE3_WEIGHT[k] * cross;
        fl_simd c = share, i0, i1, i2, j;
        if (faded) {
            c *= p->w + z * p->dw;
            i0 = (((10.0 * B + 6.0 * A) * B + 3.0 * A2) * B + A3) * (1.0 / 60.0);
            i1 = (((20.0 * B + 10.0 * A) * B + 4.0 * A2) * B + A3) * (1.0 / 140.0);
            i2 = (((35.0 * B + 15.0 * A) * B + 5.0 * A2) * B + A3) * (1.0 / 280.0);
            j = ((6.0 * B + 3.0 * A) * B + A2) * (1.0 / 30.0);
        } else {
            i0 = (((4.0 * B + 3.0 * A) * B + 2.0 * A2) * B + A3) * (1.0 / 20.0);
            i1 = (((10.0 * B + 6.0 * A) * B + 3.0 * A2) * B + A3) * (1.0 / 60.0);
            i2 = (((20.0 * B + 10.0 * A) * B + 4.0 * A2) * B + A3) * (1.0 / 140.0);
            j = ((3.0 * B + 2.0 * A) * B + A2) * (1.0 / 12.0);
        }
        const fl_simd c1 = c * i1, c2 = c * i2, cx = c2 * x;
        sum += c * i0;
        q->x += c1 * x;
        q->y += c1 * y;
        q->xx += cx * x;
        q->xy += cx * y;
        q->yy += c2 * y * y;
        q->q += c * j;
    }
    q->m += sum;
    q->parts += FL_SIMD_MAX(sum, -sum);
    q->most = FL_SIMD_MAX(FL_SIMD_MAX(q->most, from), end);
}

/* Adds triangles to the border of a rim; b: position and weight, s: overlap at the origin. */
static inline __attribute__((always_inline)) void add_rim_border(lane_sums *q, const projected_face *f,
                                                                 const fl_simd *s, border_piece *b,
                                                                 const fl_simd_mask *counted)
{
    b->s = *s + f->sx * b->x + f->sy * b->y;
    b->ds = f->sx * b->dx + f->sy * b->dy;
    add_fan(q, b, s, counted, 1);
}

/* Adds the sums of four lanes, with origins o[0], o[1] and overlap o[2] there, to the sums of all. */
static inline __attribute__((always_inline)) void add_lane_sums(projected_face *f, const lane_sums *q,
                                                                const fl_simd *o)
{
    polygon_sums *t = &f->sum;
    const fl_simd x = o[0], y = o[1], s = o[2];
    const fl_simd u = s * q->m + f->sx * q->x + f->sy * q->y, mx = x * q->m, my = y * q->m;
    const fl_simd X = q->x + mx, Y = q->y + my, XX = q->xx + x * (q->x + X), XY = q->xy + x * q->y + y * X;
    const fl_simd YY = q->yy + y * (q->y + Y);
    t->m += fl_simd_sum(&q->m), t->q += fl_simd_sum(&q->q), t->u += fl_simd_sum(&u);
    t->x += fl_simd_sum(&X), t->y += fl_simd_sum(&Y);
    t->xx += fl_simd_sum(&XX), t->xy += fl_simd_sum(&XY), t->yy += fl_simd_sum(&YY);
    t->parts += fl_simd_sum(&q->parts);
    for (int l = 0; l < FL_SIMD_WIDTH; l++) t->most = q->most[l] > t->most ? q->most[l] : t->most;
}

/* Adds the gradient from the motion of F's own rim: moving F outward enlarges the area.
 *     k     side of F
 *     all   integral of s^4 over the side with the rim weight;  far: of s^4 times the fraction along the side
 */
static inline __attribute__((always_inline)) void add_rim_force(projected_face *f, int32_t k, double all,
                                                                double far)
{
    const corner a = f->p[k], b = f->p[k + 1], o = f->p[0];
    const double ex = b.x - a.x, ey = b.y - a.y, rx = all * (a.x - o.x) + far * ex,
                 ry = all * (a.y - o.y) + far * ey, rz = all * (f->R - a.s) - far * (b.s - a.s);
    f->pull = v3_add(f->pull, v3(all * ey, -all * ex, 0.0));
    f->turn = v3_add(f->turn, v3(rz * ex, rz * ey, -(rx * ex + ry * ey)));
}

/* int s^4 dt over a piece of a side with the rim weight, and the same times t, which runs from t0 by dt.  dt
 * is 0 in lanes that do not count. */
static inline __attribute__((always_inline)) void
integrate_side(const border_piece *p, const fl_simd *t0, const fl_simd *dt, fl_simd *all, fl_simd *far)
{
    fl_simd sum = {0}, more = {0};
    for (int k = 0; k < FL_LINE4_NODES; k++) {
        const double z = FL_LINE4_NODE[k];
        const fl_simd s = p->s + z * p->ds, s2 = s * s;
        const fl_simd c = FL_LINE4_WEIGHT[k] * *dt * (p->w + z * p->dw) * s2 * s2;
        sum += c;
        more += c * (*t0 + z * *dt);
    }
    *all = sum, *far = more;
}

/* LOAD loads one by one: a vector load would wait for the scalar stores before it. */

/* Adds the rims of sides [c, c + FL_SIMD_WIDTH) of f, and finds which parts of the sides of F remain inside.
 */
static inline __attribute__((always_inline)) void add_rims(projected_face *f, const face_border *g, int32_t c)
{
#define LOAD(a, at) ((fl_simd){g->a[at], g->a[(at) + 1], g->a[(at) + 2], g->a[(at) + 3]})
    const fl_simd zero = {0}, one = 1.0 + zero, never = INFINITY + zero;
    const fl_simd ax = LOAD(x, c), ay = LOAD(y, c), ux = LOAD(ux, c), uy = LOAD(uy, c),
                  length = LOAD(length, c);
    const fl_simd bx = LOAD(x, c + 1), by = LOAD(y, c + 1), Dx = LOAD(Dx, c), Dy = LOAD(Dy, c);
    const fl_simd Ex = LOAD(Dx, c + 1), Ey = LOAD(Dy, c + 1), ta = LOAD(tan, c), tb = LOAD(tan, c + 1);
    /* in a lane without a side every part is inside */
    const fl_simd W = FL_SIMD_SELECT(length > 0.0, g->width + zero, zero - 3.0);
    const fl_simd d0 = FL_SIMD_SELECT(length > 0.0, ax * uy - ay * ux, zero - 1.0), l0 = -(ax * ux + ay * uy);
    const fl_simd a0 = ay * Dx - ax * Dy, b0 = by * Ex - bx * Ey;
    const int32_t n = f->n;
    const corner *p = f->p;
    fl_simd_mask reached = zero != 0.0;
    fl_simd *const from = f->from, *const to = f->to, *const beyond = f->beyond, *const before = f->before;
    fl_simd *const away = f->away;
    int32_t *const which = f->which, parts = 0;
    for (int32_t k = 0; k < n; k++) {
        away[k] = p[k].y * ux - p[k].x * uy + d0;
        reached |= away[k] < W;
    }
    g->lo[c / FL_SIMD_WIDTH] = one, g->hi[c / FL_SIMD_WIDTH] = zero;
    if (!fl_simd_any(&reached)) return;
    /* of the last corner: distance from the side and along it, and side of the two lines that bound the rim
     * piece */
    away[n] = away[0];
    fl_simd l = p[0].x * ux + p[0].y * uy + l0;
    fl_simd a = (p[0].x * Dy - p[0].y * Dx) + a0, b = (p[0].y * Ex - p[0].x * Ey) - b0;
    fl_simd in_lo = never, in_hi = -never, a_lo = never, a_hi = -never, b_lo = never, b_hi = -never,
            foot = zero;
    fl_simd_mask some = zero != 0.0;
    for (int32_t k = 0; k < n; k++) {
        const corner q = p[k + 1];
        const fl_simd d = away[k], e = away[k + 1], m = q.x * ux + q.y * uy + l0;
        const fl_simd h = (q.x * Dy - q.y * Dx) + a0, i = (q.y * Ex - q.x * Ey) - b0;
        const fl_simd gap = d - W, gaq = e - W, de = e - d, dl = m - l;
        /* a point on a bounding line belongs to exactly one of the two rims that share it */
        const fl_simd_mask dp = d >= 0.0, dq = e >= 0.0, wp = gap >= 0.0, wq = gaq >= 0.0, ap = a >= 0.0,
                           aq = h >= 0.0, bp = b > 0.0, bq = i > 0.0, outside = ~(wp & wq);
        const fl_simd_mask crosses = wp ^ wq, crosses_a = ap ^ aq, crosses_b = bp ^ bq;
        if (!fl_simd_any(&outside)) { /* outside the rim: only the crossings of the bounding lines matter */
            a_hi = FL_SIMD_SELECT(crosses_a, never, a_hi), b_hi = FL_SIMD_SELECT(crosses_b, never, b_hi);
            l = m, a = h, b = i;
            continue;
        }
        const fl_simd td = d / (d - e), tw = gap / (gap - gaq), ta_ = a / (a - h), tb_ = b / (b - i);
        fl_simd t0 = FL_SIMD_MAX(FL_SIMD_MASKED(~dp, td), FL_SIMD_MASKED(wp, tw));
        fl_simd t1 = FL_SIMD_MIN(FL_SIMD_SELECT(dq, one, td), FL_SIMD_SELECT(wq, tw, one));
        t0 = FL_SIMD_MAX(t0, FL_SIMD_MAX(FL_SIMD_MASKED(~ap, ta_), FL_SIMD_MASKED(~bp, tb_)));
        t1 = FL_SIMD_MIN(t1, FL_SIMD_MIN(FL_SIMD_SELECT(aq, one, ta_), FL_SIMD_SELECT(bq, one, tb_)));
        const fl_simd_mask here = (t0 < t1) & outside & (bp | bq);
        if (fl_simd_any(&here)) {
            from[parts] = FL_SIMD_MASKED(here, t0), to[parts] = FL_SIMD_MASKED(here, t1), which[parts++] = k;
            some |= here;
            foot = FL_SIMD_SELECT(here, l + t0 * dl, foot);
        }
        const fl_simd i0 = FL_SIMD_MASKED(~wp, tw), i1 = FL_SIMD_SELECT(wq, one, tw);
        beyond[k] = FL_SIMD_MAX(i0, beyond[k]), before[k] = FL_SIMD_MIN(i1, before[k]);
        const fl_simd at = l + tw * dl, at_a = d + ta_ * de, at_b = d + tb_ * de;
        in_lo = FL_SIMD_MIN(in_lo, FL_SIMD_SELECT(crosses, at, never));
        in_hi = FL_SIMD_MAX(in_hi, FL_SIMD_SELECT(crosses, at, -never));
        a_lo = FL_SIMD_MIN(a_lo, FL_SIMD_SELECT(crosses_a, at_a, never));
        a_hi = FL_SIMD_MAX(a_hi, FL_SIMD_SELECT(crosses_a, at_a, -never));
        b_lo = FL_SIMD_MIN(b_lo, FL_SIMD_SELECT(crosses_b, at_b, never));
        b_hi = FL_SIMD_MAX(b_hi, FL_SIMD_SELECT(crosses_b, at_b, -never));
        l = m, a = h, b = i;
    }
    in_lo = FL_SIMD_MAX(in_lo, ta * W), in_hi = FL_SIMD_MIN(in_hi, length - tb * W);
    a_lo = FL_SIMD_MAX(a_lo, zero), a_hi = FL_SIMD_MIN(a_hi, W);
    b_lo = FL_SIMD_MAX(b_lo, zero), b_hi = FL_SIMD_MIN(b_hi, W);
    const fl_simd_mask inner = in_lo < in_hi, living = some | inner, first = a_lo < a_hi, last = b_lo < b_hi;
    in_lo = FL_SIMD_MASKED(inner, in_lo), in_hi = FL_SIMD_MASKED(inner, in_hi);
    a_lo = FL_SIMD_MASKED(first, a_lo), a_hi = FL_SIMD_MASKED(first, a_hi);
    b_lo = FL_SIMD_MASKED(last, b_lo), b_hi = FL_SIMD_MASKED(last, b_hi);
    g->lo[c / FL_SIMD_WIDTH] = in_lo, g->hi[c / FL_SIMD_WIDTH] = in_hi;
    if (!(g->width > 0.0) || !fl_simd_any(&living)) return;
    /* The origin of a lane lies on its side of f: in a corner where a border to the next rim ends, which then
     * contributes nothing, or at the foot of a part inside the rim.  Not in a slim corner: its border extends
     * far, where the overlap may be large and of any sign. */
    const fl_simd_mask at_first = first & (ta <= SLIM_CORNER),
                       at_last = last & ~at_first & (tb <= SLIM_CORNER), add_first = first & ~at_first,
                       add_last = last & ~at_last;
    foot = FL_SIMD_SELECT(some, foot, in_lo);
    foot = FL_SIMD_SELECT(at_last, length, FL_SIMD_MASKED(living, foot));
    foot = FL_SIMD_SELECT(at_first, zero, foot);
    const fl_simd ox = ax + foot * ux, oy = ay + foot * uy, per = 1.0 / W;
    const fl_simd s = p[0].s + f->sx * (ox - p[0].x) + f->sy * (oy - p[0].y);
    lane_sums sum = {zero, zero, zero, zero, zero, zero, zero, zero, zero};
    for (int32_t i = 0; i < parts; i++) {
        const int32_t k = which[i];
        const fl_simd t0 = from[i], dt = to[i] - t0;
        const fl_simd_mask here = dt > 0.0;
        const double ex = p[k + 1].x - p[k].x, ey = p[k + 1].y - p[k].y, es = p[k + 1].s - p[k].s;
        const fl_simd w0 = away[k], dw = ey * ux - ex * uy;
        const border_piece b1 = {
            p[k].x + t0 * ex - ox, p[k].y + t0 * ey - oy, dt * ex, dt * ey, p[k].s + t0 * es, dt * es,
            per * (w0 + t0 * dw),  per * (dt * dw)};
        add_fan(&sum, &b1, &s, &here, 1);
        if (!(p[k].own > 0.0)) continue;
        fl_simd all, far;
        integrate_side(&b1, &t0, &dt, &all, &far);
        add_rim_force(f, k, fl_simd_sum(&all), fl_simd_sum(&far));
    }
    if (fl_simd_any(&inner)) {
        const fl_simd x = (in_hi - foot) * ux - W * uy, y = (in_hi - foot) * uy + W * ux, dl = in_lo - in_hi;
        add_rim_border(&sum, f, &s, &(border_piece){x, y, dl * ux, dl * uy, zero, zero, one, zero}, &inner);
    }
    if (fl_simd_any(&add_first)) {
        const fl_simd x = ax + a_hi * Dx - ox, y = ay + a_hi * Dy - oy, dl = a_lo - a_hi;
        add_rim_border(&sum, f, &s, &(border_piece){x, y, dl * Dx, dl * Dy, zero, zero, per * a_hi, per * dl},
                       &add_first);
    }
    if (fl_simd_any(&add_last)) {
        const fl_simd x = bx + b_lo * Ex - ox, y = by + b_lo * Ey - oy, dl = b_hi - b_lo;
        add_rim_border(&sum, f, &s, &(border_piece){x, y, dl * Ex, dl * Ey, zero, zero, per * b_lo, per * dl},
                       &add_last);
    }
    add_lane_sums(f, &sum, (const fl_simd[3]){ox - p[0].x, oy - p[0].y, s});
}

/* Origin of the sums over the part inside all rims: a point of it.  0 where there is none. */
static inline int interior_origin(const projected_face *f, const face_border *g, double *x, double *y)
{
    const corner *p = f->p;
    for (int32_t k = 0; k < f->n; k++) {
        if (!(f->in[k] < f->out[k])) continue;
        *x = p[k].x + f->in[k] * (p[k + 1].x - p[k].x), *y = p[k].y + f->in[k] * (p[k + 1].y - p[k].y);
        return 1;
    }
    for (int32_t c = 0; c < g->n; c++) {
        const double l = g->lo[c / FL_SIMD_WIDTH][c % FL_SIMD_WIDTH];
        if (!(l < g->hi[c / FL_SIMD_WIDTH][c % FL_SIMD_WIDTH])) continue;
        *x = g->x[c] + l * g->ux[c] - g->width * g->uy[c], *y = g->y[c] + l * g->uy[c] + g->width * g->ux[c];
        return 1;
    }
    return 0;
}

/* Adds the part inside all rims. */
static inline __attribute__((always_inline)) void add_interior(projected_face *f, const face_border *g)
{
    const corner *p = f->p;
    const fl_simd zero = {0}, one = 1.0 + zero;
    double ox, oy;
    if (!interior_origin(f, g, &ox, &oy)) return;
    const double s = p[0].s + f->sx * (ox - p[0].x) + f->sy * (oy - p[0].y);
    const fl_simd A = s + zero, W = g->width + zero;
    lane_sums sum = {zero, zero, zero, zero, zero, zero, zero, zero, zero};
    for (int32_t k = 0; k < f->n; k += FL_SIMD_WIDTH) {
        const corner *r = p + k;
#define FOUR(m, i) ((fl_simd){r[i].m, r[i + 1].m, r[i + 2].m, r[i + 3].m})
        const double *i = f->in + k, *o = f->out + k;
        const fl_simd in = {i[0], i[1], i[2], i[3]}, out = {o[0], o[1], o[2], o[3]};
        const fl_simd_mask here = in < out;
        const fl_simd t0 = FL_SIMD_MASKED(here, in), dt = FL_SIMD_MASKED(here, out) - t0;
        const fl_simd x = FOUR(x, 0), y = FOUR(y, 0), z = FOUR(s, 0);
        const fl_simd ex = FOUR(x, 1) - x, ey = FOUR(y, 1) - y, ez = FOUR(s, 1) - z;
        const border_piece b1 = {x + t0 * ex - ox, y + t0 * ey - oy, dt * ex, dt * ey,
                                 z + t0 * ez,      dt * ez,          one,     zero};
        add_fan(&sum, &b1, &A, &here, 0);
        fl_simd all, far;
        integrate_side(&b1, &t0, &dt, &all, &far);
        for (int l = 0; l < FL_SIMD_WIDTH && k + l < f->n; l++)
            if (r[l].own > 0.0 && here[l]) add_rim_force(f, k + l, all[l], far[l]);
#undef FOUR
    }
    for (int32_t c = 0; c < g->n; c += FL_SIMD_WIDTH) {
        const fl_simd ux = LOAD(ux, c), uy = LOAD(uy, c), lo = g->lo[c / FL_SIMD_WIDTH],
                      dl = g->hi[c / FL_SIMD_WIDTH] - lo;
        const fl_simd_mask here = dl > 0.0;
        if (!fl_simd_any(&here)) continue;
        const fl_simd x = LOAD(x, c) + lo * ux - W * uy - ox, y = LOAD(y, c) + lo * uy + W * ux - oy;
        const fl_simd dx = dl * ux, dy = dl * uy;
        const border_piece b1 = {x, y, dx, dy, s + f->sx * x + f->sy * y, f->sx * dx + f->sy * dy, one, zero};
        add_fan(&sum, &b1, &A, &here, 0);
    }
    add_lane_sums(f, &sum, (const fl_simd[3]){ox - p[0].x + zero, oy - p[0].y + zero, A});
}

/* Loads four corners at[0], at[step], .. of a loop relative to o; the last of n is repeated. */
static inline __attribute__((always_inline)) void load_four(fl_simd r[3], const fl_vec3 *v, const int32_t *at,
                                                            int32_t step, int32_t n, const fl_vec3 *o)
{
    const fl_vec3 *p[FL_SIMD_WIDTH];
    FL_SIMD_UNROLL
    for (int32_t l = 0; l < FL_SIMD_WIDTH; l++) p[l] = &v[at[step * (l < n ? l : n - 1)]];
    r[0] = (fl_simd){p[0]->x, p[1]->x, p[2]->x, p[3]->x} - o->x;
    r[1] = (fl_simd){p[0]->y, p[1]->y, p[2]->y, p[3]->y} - o->y;
    r[2] = (fl_simd){p[0]->z, p[1]->z, p[2]->z, p[3]->z} - o->z;
}

#define ALONG(a, r) ((a).x * (r)[0] + (a).y * (r)[1] + (a).z * (r)[2])

/* Projects the corners of f onto its plane axes. */
static inline __attribute__((always_inline)) void project_other(const projected_face *f, face_border *g)
{
    const fl_plane_axes at = f->at;
    const int32_t n = g->n;
    for (int32_t c = 0; c < n; c += FL_SIMD_WIDTH) {
        fl_simd r[3];
        load_four(r, f->v, f->loop + c, 1, n - c, &at.o);
        FL_SIMD_STORE(g->x + c) = ALONG(at.x, r), FL_SIMD_STORE(g->y + c) = ALONG(at.y, r);
    }
    g->x[n] = g->x[0], g->y[n] = g->y[0];
    for (int32_t c = n + 1; c <= g->room; c++) g->x[c] = g->y[c] = 0.0;
}

/* Directions of the sides of f and their inner borders.  The rim is at most `width` wide and leaves every
 * side half its length. */
static inline __attribute__((always_inline)) void set_up_sides(face_border *g, double width)
{
    const int32_t n = g->n;
    for (int32_t c = 0; c < n; c += FL_SIMD_WIDTH) {
        const fl_simd ex = LOAD(x, c + 1) - LOAD(x, c), ey = LOAD(y, c + 1) - LOAD(y, c),
                      l2 = ex * ex + ey * ey;
        fl_simd l;
        for (int k = 0; k < FL_SIMD_WIDTH; k++) l[k] = sqrt(l2[k]);
        *(fl_simd *)(g->length + c) = l, *(fl_simd *)(g->ux + c) = ex / l, *(fl_simd *)(g->uy + c) = ey / l;
    }
    for (int32_t c = n; c < g->room; c++) g->length[c] = g->ux[c] = g->uy[c] = 0.0;
    g->Dx[g->room] = g->Dy[g->room] = g->tan[g->room] = 0.0;
    g->ux[-1] = g->ux[n - 1], g->uy[-1] = g->uy[n - 1];
    for (int32_t c = 0; c < n; c += FL_SIMD_WIDTH) {
        const fl_simd ux = LOAD(ux, c), uy = LOAD(uy, c), vx = LOAD(ux, c - 1), vy = LOAD(uy, c - 1);
        const fl_simd k = 1.0 / (1.0 + (ux * vx + uy * vy)), turn = k * (vx * uy - vy * ux);
        *(fl_simd *)(g->Dx + c) = -k * (vy + uy), *(fl_simd *)(g->Dy + c) = k * (vx + ux);
        *(fl_simd *)(g->tan + c) = FL_SIMD_MAX(turn, -turn);
    }
    g->Dx[n] = g->Dx[0], g->Dy[n] = g->Dy[0], g->tan[n] = g->tan[0];
    for (int32_t c = 0; c < n && width > 0.0; c++) {
        const double most = 0.5 * g->length[c] / (g->tan[c] + g->tan[c + 1]);
        width = width < most ? width : most;
    }
    g->width = width;
}

FL_SIMD_VERSIONS static void integrate_face(projected_face *f, face_border *g, double width)
{
    const fl_simd zero = {0}, one = 1.0 + zero;
    const int32_t n = f->n;
    fl_simd *const beyond = f->beyond, *const before = f->before;
    for (int32_t k = 0; k < n; k++) beyond[k] = zero, before[k] = one;
    if (g->n > 0) project_other(f, g), set_up_sides(g, width);
    for (int32_t c = 0; c < g->n; c += FL_SIMD_WIDTH) add_rims(f, g, c);
    /* combine the four lanes of sides; nothing behind the last */
    for (int32_t k = 0; k < n; k += FL_SIMD_WIDTH) {
        const fl_simd_mask some = FL_SIMD_MASK_BELOW(n - k);
        fl_simd a[FL_SIMD_WIDTH], b[FL_SIMD_WIDTH];
        FL_SIMD_UNROLL
        for (int l = 0; l < FL_SIMD_WIDTH; l++) a[l] = beyond[k + l], b[l] = before[k + l];
        fl_simd_transpose(a), fl_simd_transpose(b);
        a[0] = FL_SIMD_MAX(a[0], a[2]), a[1] = FL_SIMD_MAX(a[1], a[3]);
        b[0] = FL_SIMD_MIN(b[0], b[2]), b[1] = FL_SIMD_MIN(b[1], b[3]);
        const fl_simd in = FL_SIMD_MAX(a[0], a[1]), out = FL_SIMD_MIN(b[0], b[1]);
        FL_SIMD_STORE(f->in + k) = FL_SIMD_SELECT(some, in, one);
        FL_SIMD_STORE(f->out + k) = FL_SIMD_MASKED(some, out);
    }
    add_interior(f, g);
}
#undef LOAD

/* Clips polygon p[n] to sign (s - s0) >= 0.  Sides along the cut are not F's own. */
static int32_t clip_overlap(const corner *p, double s0, double sign, int32_t n, corner *out)
{
    int32_t m = 0;
    double g = sign * (p[0].s - s0);
    for (int32_t k = 0; k < n; k++) {
        const corner a = p[k], b = p[k + 1 < n ? k + 1 : 0];
        const double h = sign * (b.s - s0);
        const int in = g >= 0.0, then = h >= 0.0;
        if (in) out[m++] = a;
        if (in != then) {
            const double t = g / (g - h);
            out[m++] = (corner){a.x + t * (b.x - a.x), a.y + t * (b.y - a.y), s0, in ? 0.0 : a.own};
        }
        g = h;
    }
    return m;
}

/* Reserves memory for a face of n corners over one of `sides`, assigns it, and projects F. */
FL_SIMD_VERSIONS static int project_face(projected_face *f, int32_t F, int32_t sides, face_border *g,
                                         corner **spare)
{
    const fl_poly *p = f->own->p;
    const int32_t *loop = p->loop + p->first[F], n = p->first[F + 1] - p->first[F];
    const int64_t most = n + 2 * FL_SIMD_WIDTH,
                  room = (sides + FL_SIMD_WIDTH - 1) / FL_SIMD_WIDTH * FL_SIMD_WIDTH,
                  each = room + 2 * FL_SIMD_WIDTH;
    if (fl_reserve(&f->w->polygon, &f->w->polygon_cap, (28 + 3) * most / 3 + (8 * each + 2 * room) / 3 + 2,
                   sizeof *f->w->polygon))
        return -1;
    double *at = (double *)(void *)f->w->polygon;
    f->p = (corner *)(void *)at, at += 4 * most;
    *spare = (corner *)(void *)at, at += 4 * most;
    f->from = (fl_simd *)(void *)at, at += 4 * most;
    f->to = (fl_simd *)(void *)at, at += 4 * most;
    f->beyond = (fl_simd *)(void *)at, at += 4 * most;
    f->before = (fl_simd *)(void *)at, at += 4 * most;
    f->away = (fl_simd *)(void *)at, at += 4 * most;
    f->which = (int32_t *)(void *)at, at += most;
    f->in = at, at += most;
    f->out = at, at += most;
    g->n = sides, g->room = (int32_t)room;
    at++; /* ux and uy have an entry before the first */
    g->x = at, g->y = at + each, g->ux = at + 2 * each, g->uy = at + 3 * each;
    g->length = at + 4 * each, g->Dx = at + 5 * each, g->Dy = at + 6 * each, g->tan = at + 7 * each;
    at += 8 * each - 1;
    g->lo = (fl_simd *)(void *)at, at += room;
    g->hi = (fl_simd *)(void *)at;
    f->sx = -v3_dot(f->nF, f->at.x) / f->slope, f->sy = -v3_dot(f->nF, f->at.y) / f->slope;
    const fl_plane_axes across = f->at;
    const fl_vec3 nf = f->nf;
    for (int32_t k = 0; k < n; k += FL_SIMD_WIDTH) { /* seen from above F is reversed */
        fl_simd r[3];
        load_four(r, f->own->v, loop + n - 1 - k, -1, n - k, &across.o);
        fl_simd row[FL_SIMD_WIDTH] = {ALONG(across.x, r), ALONG(across.y, r), f->R - ALONG(nf, r),
                                      FL_SIMD_SPLAT(1.0)};
        fl_simd_transpose(row);
        FL_SIMD_UNROLL
        for (int l = 0; l < FL_SIMD_WIDTH; l++) FL_SIMD_STORE(&f->p[k + l]) = row[l];
    }
    f->n = n;
    return 0;
}

/* Clips F to 0 <= s <= floor; 0 where nothing remains. */
static int clip_to_overlap(projected_face *f, double floor, corner *spare)
{
    double most = -INFINITY, least = INFINITY;
    for (int32_t k = 0; k < f->n; k++) {
        most = f->p[k].s > most ? f->p[k].s : most;
        least = f->p[k].s < least ? f->p[k].s : least;
    }
    if (most <= 0.0 || least > floor) return 0;
    for (int way = 0; way < 2; way++) {
        if (way ? most <= floor : least >= 0.0) continue;
        f->n = way ? clip_overlap(f->p, floor, -1.0, f->n, spare) : clip_overlap(f->p, 0.0, 1.0, f->n, spare);
        corner *const swap = f->p;
        f->p = spare, spare = swap;
    }
    if (f->n < 3) return 0;
    for (int32_t k = 0; k < FL_SIMD_WIDTH; k++) f->p[f->n + k] = f->p[k == 0 ? 0 : f->n];
    return 1;
}

/* Stores the points: all forces act along n_F, so three points with the sum, mean and second moments have the
 * same force, torque and spread.  They carry the factor m; its derivative is a couple.  Then the rim force.
 */
FL_SIMD_VERSIONS static int make_points(projected_face *q)
{
    static const fl_simd COS = {1.0, -0.5, -0.5}, SIN = {0.0, 0.86602540378443865, -0.86602540378443865};
    const polygon_sums *t = &q->sum;
    const double m = q->m, side = q->own->side;
    if (!(t->m > CANCEL_TOL * t->parts && t->q > 0.0)) return 0;
    /* (int s^3)^2 <= int s^2 int s^4: rounding must not make a contact stiffer than this bound */
    const double least = t->m * (t->m / t->q), su = t->u > BOUND_SHARE * least ? t->u : least;
    const double each = 1.0 / t->m, x = t->x * each, y = t->y * each, s = su * each;
    const double xx = t->xx * each - x * x, xy = t->xy * each - x * y, yy = t->yy * each - y * y;
    const double a = xx > 0.0 ? sqrt(2.0 * xx) : 0.0, b = a > 0.0 ? 2.0 * xy / a : 0.0, c2 = 2.0 * yy - b * b,
                 c = c2 > 0.0 ? sqrt(c2) : 0.0;
    const double x0 = q->p[0].x, y0 = q->p[0].y;
    const fl_simd dx = a * COS, dy = b * COS + c * SIN, sk = s + q->sx * dx + q->sy * dy;
    const fl_simd X = x0 + x + dx, Y = y0 + y + dy, under = q->R - sk, up = q->own->r - 0.5 * sk;
    const fl_vec3 nf = q->nf, nF = q->nF;
    const fl_plane_axes at = q->at;
    const fl_simd px = at.o.x + under * nf.x + X * at.x.x + Y * at.y.x + up * nF.x,
                  py = at.o.y + under * nf.y + X * at.x.y + Y * at.y.y + up * nF.y,
                  pz = at.o.z + under * nf.z + X * at.x.z + Y * at.y.z + up * nF.z;
    const fl_vec3 n = v3_scale(-side / q->slope, nF), across = v3_scale(side, nf);
    FL_SIMD_UNROLL
    for (int k = 0; k < 3; k++) {
        fl_patch_point *const to = fl_patch_points_next(q->w);
        if (!to) return -1;
        *to = (fl_patch_point){.group_size = 3,
                               .overlap = t->most,
                               .u = m * su / 3.0,
                               .du = m * 4.0 * t->m / 3.0,
                               .ddu = m * 12.0 * t->q / 3.0,
                               .n = n,
                               .unit_normal = across,
                               .p = v3(px[k], py[k], pz[k])};
    }
    q->w->couple = v3_madd(q->w->couple, side * q->dm * su, v3_cross(q->nF, q->nf));
    const fl_vec3 turn = v3_madd(v3_madd(v3_scale(q->turn.x, q->at.x), q->turn.y, q->at.y), q->turn.z, q->nf);
    q->w->couple = v3_madd(q->w->couple, -side * q->m, turn);
    /* opposite rim forces cancel; their moment is kept */
    if (q->pull.x == 0.0 && q->pull.y == 0.0) return 0;
    const fl_vec3 pull = v3_madd(v3_scale(q->pull.x, q->at.x), q->pull.y, q->at.y);
    const double size = v3_norm(pull);
    const fl_vec3 first = v3_madd(v3_madd(q->at.o, x0, q->at.x), y0, q->at.y);
    return fl_patch_points_add(
        q->w, (fl_patch_point){.du = q->m * size, .n = v3_scale(-side / size, pull), .p = first});
}

/* Weight m = (1 - 4 sin^2)^2 of the angle between the faces.  Returns 0 beyond 30 degrees, where it is 0. */
static int set_angle_weight(projected_face *q)
{
    const double c = q->slope = -v3_dot(q->nf, q->nF), root = 4.0 * c * c - 3.0;
    q->m = q->half * root * root;
    q->dm = q->half * 16.0 * c * root;
    return c > 0.0 && root > 0.0;
}

int fl_face_integral_over_face(fl_patch_points *w, const fl_patch_core *own, int32_t F,
                               const fl_patch_core *other, int32_t f, double R, double prism_depth,
                               double width)
{
    const fl_poly *p = other->p;
    const int32_t *loop = p->loop + p->first[f], sides = p->first[f + 1] - p->first[f];
    projected_face q = {.w = w, .own = own, .nf = other->n[f], .nF = own->n[F], .half = 0.5, .R = R};
    face_border g;
    corner *spare;
    if (!set_angle_weight(&q)) return 0;
    /* axes turn with f, and so do the three points: how panels share an area depends on them */
    const fl_vec3 o = other->v[loop[0]], x = v3_unit(v3_sub(other->v[loop[1]], o));
    q.at = (fl_plane_axes){o, x, v3_cross(q.nf, x)};
    q.v = other->v, q.loop = loop;
    if (project_face(&q, F, sides, &g, &spare)) return -1;
    if (!clip_to_overlap(&q, R + prism_depth + ON_PLANE_TOL * p->size, spare)) return 0;
    integrate_face(&q, &g, width);
    return make_points(&q);
}

int fl_face_integral_over_plane(fl_patch_points *w, const fl_patch_core *own, int32_t F, double R)
{
    projected_face q = {.w = w, .own = own, .nf = v3(0, 0, 1), .nF = own->n[F], .half = 1.0, .R = R};
    face_border g;
    corner *spare;
    if (!set_angle_weight(&q)) return 0;
    q.at = (fl_plane_axes){v3(0, 0, 0), v3(1, 0, 0), v3(0, 1, 0)};
    if (project_face(&q, F, 0, &g, &spare)) return -1;
    if (!clip_to_overlap(&q, INFINITY, spare)) return 0;
    integrate_face(&q, &g, 0.0);
    return make_points(&q);
}
