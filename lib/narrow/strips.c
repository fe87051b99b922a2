/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stddef.h>
#include "base/wide.h"
#include "narrow/rules.h"
#include "narrow/strips.h"

/* FL_STRIP_CURVED, rounded up to full registers. */
enum { FL_STRIP_ROOM = (FL_STRIP_CURVED + FL_LANES - 1) / FL_LANES * FL_LANES };

/* Rules for int_0^1 of s^(9/2) dt over a piece where s is curved, exact for polynomials of degree 19 times
 * ... */
typedef struct {
    double node[FL_STRIP_ROOM], weight[FL_STRIP_ROOM]; /* the rest is 0 */
} rule;

/* ... 1: Gauss and Legendre; */
static const rule WHOLE = {
    {0.01304673574141413996, 0.06746831665550774463, 0.16029521585048779688, 0.28330230293537640460,
     0.42556283050918439456, 0.57443716949081560544, 0.71669769706462359540, 0.83970478414951220312,
     0.93253168334449225537, 0.98695326425858586004},
    {0.03333567215434406880, 0.07472567457529029657, 0.10954318125799102200, 0.13463335965499817755,
     0.14776211235737643509, 0.14776211235737643509, 0.13463335965499817755, 0.10954318125799102200,
     0.07472567457529029657, 0.03333567215434406880}};
/* ... the root of t, s being 0 at t = 0: the squares of the positive zeros of P_21, and their weights there
 * times twice the zeros; */
static const rule FROM_ZERO = {
    {0.02118825338675769150, 0.08295627893258909625, 0.18006623498214442643, 0.30428334010557153850,
     0.44507418406595325323, 0.59049997746650119822, 0.72822903201295969525, 0.84658278470401096083,
     0.93552775724297153710, 0.98754337661273572464},
    {0.04207448043255661265, 0.08058110330356446811, 0.11225456371451605788, 0.13440900779609855377,
     0.14516580013255898386, 0.14361285869512088124, 0.12988209802217303721, 0.10513869358463409598,
     0.07148539450621113178, 0.03183431069697096669}};
/* ... the root of t (1 - t), s being 0 at both ends: (1 + cos(k pi/11))/2 and (pi/22) sin(k pi/11). */
static const rule BETWEEN_ZEROS = {
    {0.02025351319275131567, 0.07937323358440945276, 0.17256963302735750521, 0.29229249349905683797,
     0.42884258086335746984, 0.57115741913664253016, 0.70770750650094327305, 0.82743036697264260582,
     0.92062676641559060275, 0.97974648680724873984},
    {0.04023131503864110087, 0.07720332819769483435, 0.10792078685204321842, 0.12989514518527181530,
     0.14134617137176341828, 0.14134617137176339052, 0.12989514518527181530, 0.10792078685204321842,
     0.07720332819769480659, 0.04023131503864110087}};

static double root_of(double s) { return s > 0.0 ? sqrt(s) : 0.0; }

/* Over a plane: d is linear and its direction one, so that two places have force and torque of all nodes, and
 * the second moment of the pressure.  Node k of a piece over which s goes from p^2 to q^2 has the root r = p
 * + (q - p) z at t = lo + (hi - lo) z (r + p)/(q + p): in z the integrand s^(9/2) dt is a polynomial of
 * degree 10. */
int fl_strips_over_face(const fl_line *l, fl_span t, double h0, double h1, fl_vec3 n)
{
    if (!fl_span_keep(&t, l->R - h0, l->R - h1)) return 0;
    const double p = root_of(l->R - h0 - t.lo * (h1 - h0)), q = root_of(l->R - h0 - t.hi * (h1 - h0));
    if (!(p + q > 0.0)) return 0;
    const double dt = t.hi - t.lo, k0 = l->factor * 2.0 * dt / (p + q);
    double u = 0.0, du = 0.0, ddu = 0.0, first = 0.0, second = 0.0;
    for (int k = 0; k < FL_LINE_NODES; k++) {
        const double z = FL_LINE_NODE[k], r = p + (q - p) * z, at = z * (r + p) / (p + q), s = r * r;
        const double c = k0 * FL_LINE_WEIGHT[k] * s * s * s, pull = 4.5 * c * s;
        u += c * s * s;
        du += pull;
        ddu += 15.75 * c;
        first += pull * at;
        second += pull * at * at;
    }
    if (!(u > 0.0)) return 0;
    const double mean = first / du, spread = root_of(second / du - mean * mean);
    for (int way = -1; way <= 1; way += 2) {
        const double at = t.lo + dt * (mean + way * spread), s = l->R - h0 - at * (h1 - h0);
        const fl_vec3 to = v3_scale(l->own->side, n);
        if (fl_places_add(l->w, (fl_place){.stands = 2,
                                           .overlap = s,
                                           .u = 0.5 * u,
                                           .du = 0.5 * du,
                                           .ddu = 0.5 * ddu,
                                           .n = to,
                                           .across = to,
                                           .p = v3_madd(v3_madd(l->x0, at, l->u), 0.5 * s - l->own->r, n)}))
            return -1;
    }
    return 0;
}

/* Over a point c, or a line through it along the unit vector e.  The forces all meet that point or that line
 * at tau = tau0 + t slope, so that one place has their resultant, or two at the ends from and to of the
 * piece. */
typedef struct {
    const fl_line *l;
    fl_vec3 q, u;      /* d = |q + t u| */
    double small;      /* distances below it have no direction */
    double from, over; /* t of the first end; 1/(to - from), or 0 for a point */
    /* sums of u, of its derivatives, of du s, of du (t - from)/(to - from); of the force, and that times the
     * latter */
    fl_wide sum, du, ddu, s, far, f[3], ffar[3];
} bundle;

/* Nodes at a + k b of what lies at q + t u, with the shares w: into the sums. */
FL_WIDE_VERSIONS static void take(bundle *b, const rule *g, double from, double dt)
{
    const fl_vec3 q = b->q, u = b->u;
    const double share = b->l->factor * fabs(dt), R = b->l->R, small = b->small;
    for (int k = 0; k < FL_STRIP_ROOM; k += FL_LANES) {
        const fl_wide t = from + dt * *(const fl_wide *)(g->node + k),
                      weight = *(const fl_wide *)(g->weight + k);
        const fl_wide x = q.x + t * u.x, y = q.y + t * u.y, z = q.z + t * u.z, d2 = x * x + y * y + z * z;
        fl_wide d, root;
        for (int l = 0; l < FL_LANES; l++) d[l] = sqrt(d2[l]);
        const fl_wide_mask in = (d < R) & (d > small);
        const fl_wide s = FL_WIDE_WHERE(in, R - d);
        for (int l = 0; l < FL_LANES; l++) root[l] = sqrt(s[l]);
        const fl_wide pull = share * weight * root * s * s, du = 4.5 * pull * s,
                      way = (t - b->from) * b->over;
        const fl_wide f = FL_WIDE_WHERE(in, du / d), far = way * f;
        b->sum += pull * s * s;
        b->du += du;
        b->ddu += 15.75 * pull;
        b->s += du * s;
        b->far += way * du;
        b->f[0] += f * x, b->f[1] += f * y, b->f[2] += f * z;
        b->ffar[0] += far * x, b->ffar[1] += far * y, b->ffar[2] += far * z;
    }
}

/* A piece t; zero_lo, zero_hi: s is 0 at that end. */
static void gauss(bundle *b, fl_span t, int zero_lo, int zero_hi)
{
    const rule *g = zero_lo && zero_hi ? &BETWEEN_ZEROS : zero_lo || zero_hi ? &FROM_ZERO : &WHOLE;
    if (zero_hi && !zero_lo) take(b, g, t.hi, t.lo - t.hi);
    else take(b, g, t.lo, t.hi - t.lo);
}

/* The same where an end that is not 0 may be nearly so: the quarter next to it is a piece of its own. */
static void gauss_over_point(bundle *b, fl_span t, int zero_lo, int zero_hi)
{
    const double R = b->l->R, quarter = 0.25 * (t.hi - t.lo), s0 = R - v3_norm(v3_madd(b->q, t.lo, b->u)),
                 s1 = R - v3_norm(v3_madd(b->q, t.hi, b->u)),
                 sm = R - v3_norm(v3_madd(b->q, 0.5 * (t.lo + t.hi), b->u));
    const double most = s0 > s1 ? (s0 > sm ? s0 : sm) : s1 > sm ? s1 : sm;
    const int near_lo = !zero_lo && s0 < 0.3 * most, near_hi = !zero_hi && s1 < 0.3 * most;
    const fl_span mid = {near_lo ? t.lo + quarter : t.lo, near_hi ? t.hi - quarter : t.hi};
    if (near_lo) gauss(b, (fl_span){t.lo, mid.lo}, 0, 0);
    if (near_hi) gauss(b, (fl_span){mid.hi, t.hi}, 0, 0);
    gauss(b, mid, zero_lo, zero_hi);
}

/* d^2 = uu ((t - m)^2 + a^2); half: s > 0 at |t - m| < half.  Where the overlap is large d is singular at
 * m +- i a, and pieces that grow threefold from m keep away. */
static void graded(bundle *b, fl_span t, int zero_lo, int zero_hi, double m, double a, double uu)
{
    const double bend = 1e-3 * b->l->R / sqrt(uu);
    for (int way = 0; way < 2; way++) {
        double from = 0.0, to = a > bend ? a : bend;
        const double first = way ? t.lo - m : m - t.hi, last = way ? t.hi - m : m - t.lo;
        const int zero = way ? zero_hi : zero_lo;
        for (; from < last; from = to, to *= 3.0) {
            if (last < 1.3 * to) to = last; /* no crumbs */
            const double lo = from > first ? from : first, hi = to < last ? to : last;
            if (!(lo < hi)) continue;
            const fl_span s = way ? (fl_span){m + lo, m + hi} : (fl_span){m - hi, m - lo};
            const int end = zero && hi == last;
            gauss_over_point(b, s, !way && end, way && end);
        }
    }
}

/* One place: the part `share` of the bundle with force f and scalar sum du, where it meets the point c; s:
 * mean overlap. */
static int tie(const bundle *b, double share, double du, double s, fl_vec3 f, fl_vec3 c)
{
    const double size = v3_norm(f);
    if (!(size > 0.0) || !(du > 0.0)) return 0;
    const fl_vec3 n = v3_scale(1.0 / size, f);
    return fl_places_add(b->l->w, (fl_place){.overlap = s,
                                             .u = share * fl_wide_sum(&b->sum),
                                             .du = du,
                                             .ddu = share * fl_wide_sum(&b->ddu),
                                             .n = v3_scale(b->l->own->side / du, f),
                                             .across = v3_scale(b->l->own->side, n),
                                             .p = v3_madd(c, b->l->R - 0.5 * s - b->l->own->r, n)});
}

static fl_vec3 sum3(const fl_wide a[3])
{
    return v3(fl_wide_sum(&a[0]), fl_wide_sum(&a[1]), fl_wide_sum(&a[2]));
}

int fl_strips_over_point(const fl_line *l, fl_span t, fl_vec3 c, const fl_vec3 *e, double small)
{
    bundle b = {.l = l, .q = v3_sub(l->x0, c), .u = l->u, .small = small};
    double tau = 0.0, slope = 0.0;
    if (e) {
        tau = v3_dot(b.q, *e), slope = v3_dot(b.u, *e);
        b.q = v3_madd(b.q, -tau, *e);
        b.u = v3_madd(b.u, -slope, *e);
    }
    const double uu = v3_norm2(b.u);
    double m = 0.0, a = 0.0, half = 0.0;
    int zero_lo = 0, zero_hi = 0;
    if (uu > 0.0) {
        m = -v3_dot(b.q, b.u) / uu;
        const double least2 = v3_norm2(v3_madd(b.q, m, b.u)), free2 = l->R * l->R - least2;
        if (!(free2 > 0.0)) return 0;
        half = sqrt(free2 / uu), a = sqrt(least2 / uu);
        zero_lo = m - half > t.lo, zero_hi = m + half < t.hi;
        if (zero_lo) t.lo = m - half;
        if (zero_hi) t.hi = m + half;
        if (!(t.lo < t.hi)) return 0;
    } else if (v3_norm2(b.q) >= l->R * l->R) {
        return 0;
    }
    b.from = t.lo;
    b.over = slope != 0.0 ? 1.0 / (t.hi - t.lo) : 0.0;
    if (half <= 0.5 * a || !(uu > 0.0)) gauss_over_point(&b, t, zero_lo, zero_hi);
    else graded(&b, t, zero_lo, zero_hi, m, a, uu);
    const double du = fl_wide_sum(&b.du);
    if (!(du > 0.0)) return 0;
    const double mean = fl_wide_sum(&b.s) / du;
    const fl_vec3 f = sum3(b.f);
    if (slope == 0.0) return tie(&b, 1.0, du, mean, f, e ? v3_madd(c, tau, *e) : c);
    const double far = fl_wide_sum(&b.far), part = far / du;
    const fl_vec3 ffar = sum3(b.ffar);
    return tie(&b, 1.0 - part, du - far, mean, v3_sub(f, ffar), v3_madd(c, tau + t.lo * slope, *e)) ||
                   tie(&b, part, far, mean, ffar, v3_madd(c, tau + t.hi * slope, *e))
               ? -1
               : 0;
}

double fl_strips_factor(const fl_side *own, int32_t e, double other)
{
    const fl_edge g = own->p->edge[e];
    const double sharp = own->p->bend[e] * FL_PLACE_SHARP_EDGE, rho = fl_place_rho(own->r, other);
    return (sharp < 1.0 ? sharp : 1.0) * FL_PLACE_ROUND * (256.0 / 315.0) * sqrt(2.0 * rho) *
           v3_norm(v3_sub(own->p->v[g.b], own->p->v[g.a])); /* the same bits in any pose */
}

int fl_strips_plane(fl_places *w, const fl_side *own, int32_t e, double R)
{
    const fl_edge g = own->p->edge[e];
    const fl_vec3 x0 = own->v[g.a], u = v3_sub(own->v[g.b], x0);
    const fl_line l = {w, own, x0, u, fl_strips_factor(own, e, 0.0), R};
    if (!(l.factor > 0.0)) return 0;
    return fl_strips_over_face(&l, (fl_span){0.0, 1.0}, x0.z, x0.z + u.z, v3(0, 0, 1));
}
