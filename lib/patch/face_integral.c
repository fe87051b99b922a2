/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "patch/face_integral.h"
#include <math.h>
#include "base/array.h"
#include "base/simd.h"
#include "geom/quadrature_rules.h"
#include "narrow/overlap.h"

#define SAME 1e-13 /* of the size: how far below the other's plane still counts as on it */
/* Of the sum of its parts: less is what rounding leaves of parts that cancel. */
#define NOTHING 1e-13
#define ALIKE 0.5 /* what holds for integrals is taken to hold for their sums above this */
#define SLIM 4.0  /* cotangent of half the angle of a corner */

/* A corner of F over the plane of f: plane coordinates and overlap; the side that starts here is part of F's
 * own rim (1) or not (0). */
typedef struct {
    double x, y, s, own;
} corner;

/* Numbers of the sides of f, one array each, counter-clockwise: where side c starts, its direction, its
 * length; D, the way to the inner rim from its first corner for each unit of width, and the part of it along
 * the side.  One more at the end is the first again. */
typedef struct {
    double *x, *y, *ux, *uy, *length, *Dx, *Dy, *tan;
    fl_simd *lo, *hi; /* part of the inner rim that lies in F, along the side; lo >= hi: none */
    int32_t n, room;  /* room: rounded up to full registers */
    double width;
} outline;

/* Sums over an area, by lanes and about the lane's origin: of s^3 times 1, x, y, xx, xy, yy, of s^2, all with
 * the fade; of the sizes of the parts of the first; the largest s. */
typedef struct {
    fl_simd m, x, y, xx, xy, yy, q, parts, most;
} sums;

/* A piece of border, by lanes: from (x, y) by (dx, dy), seen from the lane's origin; overlap from s by ds,
 * fade from w by dw. */
typedef struct {
    fl_simd x, y, dx, dy, s, ds, w, dw;
} piece;

/* All of it, about the first corner, so that what is far away keeps its digits. */
typedef struct {
    double m, x, y, xx, xy, yy, q, u, parts, most; /* u: of s^4 */
} total;

/* Where the plane of f is, and F over it. */
typedef struct {
    fl_patch_points *w;
    const fl_patch_core *own;
    fl_plane_axes at;    /* origin and axes in the plane of f */
    const fl_vec3 *v;    /* its corners, by */
    const int32_t *loop; /* their numbers; NULL: a plane has none */
    fl_vec3 nf, nF;
    double slope, half, R; /* c = -n_F.n_f; 1/2, or 1 for a plane */
    double sx, sy;         /* slopes of s over F */
    double m, dm;          /* half of m(c), and its derivative */
    corner *p;             /* [n + 1] F, counter-clockwise, the first again at the end */
    int32_t n;
    fl_simd *away;            /* [n + 1] of the corners of F from four sides of f */
    fl_simd *from, *to;       /* [n] parts of sides of F that are in a rim, */
    int32_t *which;           /* [n] and of which; */
    fl_simd *beyond, *before; /* [n] what is inside the rims, by lanes, begins and ends */
    double *in, *out;         /* [n] and that inside all rims */
    total sum;
    fl_vec3 pull, turn; /* of the rims, in the axes at.x, at.y, nf: force, and moment about the first corner
                         * on the plane of f */
} footprint;

/* The triangles from the origin to pieces of border, of what is linear in the triangle with the values A and
 * B at the origin and at the border: int s^3 w rho^k dA = cross int_0^1 dt int_0^1 rho^(k+1) (A (1 - rho) + B
 * rho)^3 w drho, in rho closed, in t by Gauss' rule: exact but for the second moments of rims.  faded: the
 * origin lies where w is 0, so that w is rho times that at the border; else w = 1. */
static inline __attribute__((always_inline)) void fan(sums *q, const piece *p, const fl_simd *at,
                                                      const fl_simd_mask *counted, int faded)
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

/* The same to a border of a rim, of which the place and the fade are given; s: the overlap at the origin. */
static inline __attribute__((always_inline)) void border(sums *q, const footprint *f, const fl_simd *s,
                                                         piece *b, const fl_simd_mask *counted)
{
    b->s = *s + f->sx * b->x + f->sy * b->y;
    b->ds = f->sx * b->dx + f->sy * b->dy;
    fan(q, b, s, counted, 1);
}

/* The sums of four lanes with origins (x, y), where the overlap is s, into those of all. */
static inline __attribute__((always_inline)) void gather(footprint *f, const sums *q, const fl_simd *o)
{
    total *t = &f->sum;
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

/* Moving F outward over its own rim makes the area larger: the gradient of that.  Side k of F, and over it
 * the integrals of s^4 and of s^4 times the share of the way along it, both with the fade. */
static inline __attribute__((always_inline)) void rim(footprint *f, int32_t k, double all, double far)
{
    const corner a = f->p[k], b = f->p[k + 1], o = f->p[0];
    const double ex = b.x - a.x, ey = b.y - a.y, rx = all * (a.x - o.x) + far * ex,
                 ry = all * (a.y - o.y) + far * ey, rz = all * (f->R - a.s) - far * (b.s - a.s);
    f->pull = v3_add(f->pull, v3(all * ey, -all * ex, 0.0));
    f->turn = v3_add(f->turn, v3(rz * ex, rz * ey, -(rx * ex + ry * ey)));
}

/* int s^4 dt over a piece of a side, with the fade, and of that times t, which runs from t0 by dt; dt: what
 * is counted. */
static inline __attribute__((always_inline)) void along(const piece *p, const fl_simd *t0, const fl_simd *dt,
                                                        fl_simd *all, fl_simd *far)
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

/* LOAD: one by one, since a wide load would wait for the narrow stores before it. */

/* The rims of sides [c, c + FL_SIMD_WIDTH) of f, and how much of the sides of F they leave. */
static inline __attribute__((always_inline)) void rims(footprint *f, const outline *g, int32_t c)
{
#define LOAD(a, at) ((fl_simd){g->a[at], g->a[(at) + 1], g->a[(at) + 2], g->a[(at) + 3]})
    const fl_simd zero = {0}, one = 1.0 + zero, never = INFINITY + zero;
    const fl_simd ax = LOAD(x, c), ay = LOAD(y, c), ux = LOAD(ux, c), uy = LOAD(uy, c),
                  length = LOAD(length, c);
    const fl_simd bx = LOAD(x, c + 1), by = LOAD(y, c + 1), Dx = LOAD(Dx, c), Dy = LOAD(Dy, c);
    const fl_simd Ex = LOAD(Dx, c + 1), Ey = LOAD(Dy, c + 1), ta = LOAD(tan, c), tb = LOAD(tan, c + 1);
    /* a lane without a side is left by all */
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
    /* distance from the side and along it, on which side of the two lines to the inner rim: of the last
     * corner */
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
        /* what counts as on the one side of a line for one counts as on the other for its neighbour */
        const fl_simd_mask dp = d >= 0.0, dq = e >= 0.0, wp = gap >= 0.0, wq = gaq >= 0.0, ap = a >= 0.0,
                           aq = h >= 0.0, bp = b > 0.0, bq = i > 0.0, outside = ~(wp & wq);
        const fl_simd_mask crosses = wp ^ wq, crosses_a = ap ^ aq, crosses_b = bp ^ bq;
        if (!fl_simd_any(&outside)) { /* in no rim: it only tells that the lines go on beyond */
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
    /* the origins: on the side, in the corner where a border to the next rim ends, which then counts for
     * nothing, or at the foot of something that is in the rim; not in a corner so slim that its border runs
     * far off, where the overlap may be large and of any sign */
    const fl_simd_mask at_first = first & (ta <= SLIM), at_last = last & ~at_first & (tb <= SLIM),
                       add_first = first & ~at_first, add_last = last & ~at_last;
    foot = FL_SIMD_SELECT(some, foot, in_lo);
    foot = FL_SIMD_SELECT(at_last, length, FL_SIMD_MASKED(living, foot));
    foot = FL_SIMD_SELECT(at_first, zero, foot);
    const fl_simd ox = ax + foot * ux, oy = ay + foot * uy, per = 1.0 / W;
    const fl_simd s = p[0].s + f->sx * (ox - p[0].x) + f->sy * (oy - p[0].y);
    sums sum = {zero, zero, zero, zero, zero, zero, zero, zero, zero};
    for (int32_t i = 0; i < parts; i++) {
        const int32_t k = which[i];
        const fl_simd t0 = from[i], dt = to[i] - t0;
        const fl_simd_mask here = dt > 0.0;
        const double ex = p[k + 1].x - p[k].x, ey = p[k + 1].y - p[k].y, es = p[k + 1].s - p[k].s;
        const fl_simd w0 = away[k], dw = ey * ux - ex * uy;
        const piece b1 = {
            p[k].x + t0 * ex - ox, p[k].y + t0 * ey - oy, dt * ex, dt * ey, p[k].s + t0 * es, dt * es,
            per * (w0 + t0 * dw),  per * (dt * dw)};
        fan(&sum, &b1, &s, &here, 1);
        if (!(p[k].own > 0.0)) continue;
        fl_simd all, far;
        along(&b1, &t0, &dt, &all, &far);
        rim(f, k, fl_simd_sum(&all), fl_simd_sum(&far));
    }
    if (fl_simd_any(&inner)) {
        const fl_simd x = (in_hi - foot) * ux - W * uy, y = (in_hi - foot) * uy + W * ux, dl = in_lo - in_hi;
        border(&sum, f, &s, &(piece){x, y, dl * ux, dl * uy, zero, zero, one, zero}, &inner);
    }
    if (fl_simd_any(&add_first)) {
        const fl_simd x = ax + a_hi * Dx - ox, y = ay + a_hi * Dy - oy, dl = a_lo - a_hi;
        border(&sum, f, &s, &(piece){x, y, dl * Dx, dl * Dy, zero, zero, per * a_hi, per * dl}, &add_first);
    }
    if (fl_simd_any(&add_last)) {
        const fl_simd x = bx + b_lo * Ex - ox, y = by + b_lo * Ey - oy, dl = b_hi - b_lo;
        border(&sum, f, &s, &(piece){x, y, dl * Ex, dl * Ey, zero, zero, per * b_lo, per * dl}, &add_last);
    }
    gather(f, &sum, (const fl_simd[3]){ox - p[0].x, oy - p[0].y, s});
}

/* Where the sums over what lies inside all rims begin: a point of it.  0 where there is nothing. */
static inline int inside_from(const footprint *f, const outline *g, double *x, double *y)
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

/* What lies inside all rims. */
static inline __attribute__((always_inline)) void inside(footprint *f, const outline *g)
{
    const corner *p = f->p;
    const fl_simd zero = {0}, one = 1.0 + zero;
    double ox, oy;
    if (!inside_from(f, g, &ox, &oy)) return;
    const double s = p[0].s + f->sx * (ox - p[0].x) + f->sy * (oy - p[0].y);
    const fl_simd A = s + zero, W = g->width + zero;
    sums sum = {zero, zero, zero, zero, zero, zero, zero, zero, zero};
    for (int32_t k = 0; k < f->n; k += FL_SIMD_WIDTH) {
        const corner *r = p + k;
#define FOUR(m, i) ((fl_simd){r[i].m, r[i + 1].m, r[i + 2].m, r[i + 3].m})
        const double *i = f->in + k, *o = f->out + k;
        const fl_simd in = {i[0], i[1], i[2], i[3]}, out = {o[0], o[1], o[2], o[3]};
        const fl_simd_mask here = in < out;
        const fl_simd t0 = FL_SIMD_MASKED(here, in), dt = FL_SIMD_MASKED(here, out) - t0;
        const fl_simd x = FOUR(x, 0), y = FOUR(y, 0), z = FOUR(s, 0);
        const fl_simd ex = FOUR(x, 1) - x, ey = FOUR(y, 1) - y, ez = FOUR(s, 1) - z;
        const piece b1 = {x + t0 * ex - ox, y + t0 * ey - oy, dt * ex, dt * ey,
                          z + t0 * ez,      dt * ez,          one,     zero};
        fan(&sum, &b1, &A, &here, 0);
        fl_simd all, far;
        along(&b1, &t0, &dt, &all, &far);
        for (int l = 0; l < FL_SIMD_WIDTH && k + l < f->n; l++)
            if (r[l].own > 0.0 && here[l]) rim(f, k + l, all[l], far[l]);
#undef FOUR
    }
    for (int32_t c = 0; c < g->n; c += FL_SIMD_WIDTH) {
        const fl_simd ux = LOAD(ux, c), uy = LOAD(uy, c), lo = g->lo[c / FL_SIMD_WIDTH],
                      dl = g->hi[c / FL_SIMD_WIDTH] - lo;
        const fl_simd_mask here = dl > 0.0;
        if (!fl_simd_any(&here)) continue;
        const fl_simd x = LOAD(x, c) + lo * ux - W * uy - ox, y = LOAD(y, c) + lo * uy + W * ux - oy;
        const fl_simd dx = dl * ux, dy = dl * uy;
        const piece b1 = {x, y, dx, dy, s + f->sx * x + f->sy * y, f->sx * dx + f->sy * dy, one, zero};
        fan(&sum, &b1, &A, &here, 0);
    }
    gather(f, &sum, (const fl_simd[3]){ox - p[0].x + zero, oy - p[0].y + zero, A});
}

/* Four points, from o: of corners at[0], at[step] and so on of a loop; the last of n again behind it. */
static inline __attribute__((always_inline)) void four_of(fl_simd r[3], const fl_vec3 *v, const int32_t *at,
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

/* Corners of f in its plane. */
static inline __attribute__((always_inline)) void lay_outline(const footprint *f, outline *g)
{
    const fl_plane_axes at = f->at;
    const int32_t n = g->n;
    for (int32_t c = 0; c < n; c += FL_SIMD_WIDTH) {
        fl_simd r[3];
        four_of(r, f->v, f->loop + c, 1, n - c, &at.o);
        FL_SIMD_STORE(g->x + c) = ALONG(at.x, r), FL_SIMD_STORE(g->y + c) = ALONG(at.y, r);
    }
    g->x[n] = g->x[0], g->y[n] = g->y[0];
    for (int32_t c = n + 1; c <= g->room; c++) g->x[c] = g->y[c] = 0.0;
}

/* Directions, inner rim and so on of the sides of f.  The rim is at most `width` wide and leaves every side
 * half its length. */
static inline __attribute__((always_inline)) void lay_sides(outline *g, double width)
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

FL_SIMD_VERSIONS static void cover(footprint *f, outline *g, double width)
{
    const fl_simd zero = {0}, one = 1.0 + zero;
    const int32_t n = f->n;
    fl_simd *const beyond = f->beyond, *const before = f->before;
    for (int32_t k = 0; k < n; k++) beyond[k] = zero, before[k] = one;
    if (g->n > 0) lay_outline(f, g), lay_sides(g, width);
    for (int32_t c = 0; c < g->n; c += FL_SIMD_WIDTH) rims(f, g, c);
    for (int32_t k = 0; k < n; k += FL_SIMD_WIDTH) { /* those of four sides, behind the last none */
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
    inside(f, g);
}
#undef LOAD

/* Keep of poly[n] what has g >= 0 at its corners; sides along the cut are not F's own. */
static int32_t cut(const corner *p, double s0, double sign, int32_t n, corner *out)
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

/* Room for a face with n corners over one with `sides`, and where all of it lies. */
FL_SIMD_VERSIONS static int lay(footprint *f, int32_t F, int32_t sides, outline *g, corner **spare)
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
    at++; /* ux and uy have a number before the first */
    g->x = at, g->y = at + each, g->ux = at + 2 * each, g->uy = at + 3 * each;
    g->length = at + 4 * each, g->Dx = at + 5 * each, g->Dy = at + 6 * each, g->tan = at + 7 * each;
    at += 8 * each - 1;
    g->lo = (fl_simd *)(void *)at, at += room;
    g->hi = (fl_simd *)(void *)at;
    f->sx = -v3_dot(f->nF, f->at.x) / f->slope, f->sy = -v3_dot(f->nF, f->at.y) / f->slope;
    const fl_plane_axes across = f->at;
    const fl_vec3 nf = f->nf;
    for (int32_t k = 0; k < n; k += FL_SIMD_WIDTH) { /* from above, F is seen from behind */
        fl_simd r[3];
        four_of(r, f->own->v, loop + n - 1 - k, -1, n - k, &across.o);
        fl_simd row[FL_SIMD_WIDTH] = {ALONG(across.x, r), ALONG(across.y, r), f->R - ALONG(nf, r),
                                      FL_SIMD_SPLAT(1.0)};
        fl_simd_transpose(row);
        FL_SIMD_UNROLL
        for (int l = 0; l < FL_SIMD_WIDTH; l++) FL_SIMD_STORE(&f->p[k + l]) = row[l];
    }
    f->n = n;
    return 0;
}

/* Leave of F what has 0 <= s <= floor: 0 where that is nothing. */
static int trim(footprint *f, double floor, corner *spare)
{
    double most = -INFINITY, least = INFINITY;
    for (int32_t k = 0; k < f->n; k++) {
        most = f->p[k].s > most ? f->p[k].s : most;
        least = f->p[k].s < least ? f->p[k].s : least;
    }
    if (most <= 0.0 || least > floor) return 0;
    for (int way = 0; way < 2; way++) {
        if (way ? most <= floor : least >= 0.0) continue;
        f->n = way ? cut(f->p, floor, -1.0, f->n, spare) : cut(f->p, 0.0, 1.0, f->n, spare);
        corner *const swap = f->p;
        f->p = spare, spare = swap;
    }
    if (f->n < 3) return 0;
    for (int32_t k = 0; k < FL_SIMD_WIDTH; k++) f->p[f->n + k] = f->p[k == 0 ? 0 : f->n];
    return 1;
}

/* The places of it: all push along n_F, so that three with their sum, mean and second moments have the same
 * force, torque and spread.  They get the factor m, whose change has a couple.  Then the pull of the rims. */
FL_SIMD_VERSIONS static int put(footprint *q)
{
    static const fl_simd COS = {1.0, -0.5, -0.5}, SIN = {0.0, 0.86602540378443865, -0.86602540378443865};
    const total *t = &q->sum;
    const double m = q->m, side = q->own->side;
    if (!(t->m > NOTHING * t->parts && t->q > 0.0)) return 0;
    /* (int s^3)^2 <= int s^2 int s^4: where rounding is all there is, it must not make a contact stiffer than
     * any */
    const double least = t->m * (t->m / t->q), su = t->u > ALIKE * least ? t->u : least;
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
    if (q->pull.x == 0.0 && q->pull.y == 0.0) return 0; /* those of opposite sides, which still turn */
    const fl_vec3 pull = v3_madd(v3_scale(q->pull.x, q->at.x), q->pull.y, q->at.y);
    const double size = v3_norm(pull);
    const fl_vec3 first = v3_madd(v3_madd(q->at.o, x0, q->at.x), y0, q->at.y);
    return fl_patch_points_add(
        q->w, (fl_patch_point){.du = q->m * size, .n = v3_scale(-side / size, pull), .p = first});
}

/* m = (1 - 4 sin^2)^2 of the angle between the faces, and 0 beyond 30 degrees.  0 where there is nothing. */
static int turned(footprint *q)
{
    const double c = q->slope = -v3_dot(q->nf, q->nF), root = 4.0 * c * c - 3.0;
    q->m = q->half * root * root;
    q->dm = q->half * 16.0 * c * root;
    return c > 0.0 && root > 0.0;
}

int fl_face_integral_over_face(fl_patch_points *w, const fl_patch_core *own, int32_t F,
                               const fl_patch_core *other, int32_t f, double R, double behind, double width)
{
    const fl_poly *p = other->p;
    const int32_t *loop = p->loop + p->first[f], sides = p->first[f + 1] - p->first[f];
    footprint q = {.w = w, .own = own, .nf = other->n[f], .nF = own->n[F], .half = 0.5, .R = R};
    outline g;
    corner *spare;
    if (!turned(&q)) return 0;
    /* axes that turn with f, and with them the three places: how panels share an area hangs on these */
    const fl_vec3 o = other->v[loop[0]], x = v3_unit(v3_sub(other->v[loop[1]], o));
    q.at = (fl_plane_axes){o, x, v3_cross(q.nf, x)};
    q.v = other->v, q.loop = loop;
    if (lay(&q, F, sides, &g, &spare)) return -1;
    if (!trim(&q, R + behind + SAME * p->size, spare)) return 0;
    cover(&q, &g, width);
    return put(&q);
}

int fl_face_integral_over_plane(fl_patch_points *w, const fl_patch_core *own, int32_t F, double R)
{
    footprint q = {.w = w, .own = own, .nf = v3(0, 0, 1), .nF = own->n[F], .half = 1.0, .R = R};
    outline g;
    corner *spare;
    if (!turned(&q)) return 0;
    q.at = (fl_plane_axes){v3(0, 0, 0), v3(1, 0, 0), v3(0, 1, 0)};
    if (lay(&q, F, 0, &g, &spare)) return -1;
    if (!trim(&q, INFINITY, spare)) return 0;
    cover(&q, &g, 0.0);
    return put(&q);
}
