/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stddef.h>
#include "base/wide.h"
#include "narrow/rules.h"
#include "narrow/strips.h"

/* FL_STRIP_CURVED, rounded up to full registers. */
enum { ROOM = (FL_STRIP_CURVED + FL_LANES - 1) / FL_LANES * FL_LANES };

/* Rules for int_0^1 of s^(9/2) dt over a piece where s is curved, of 8 and of FL_STRIP_CURVED points, exact
 * for polynomials of degree 15 and 19 times ... */
typedef struct {
    double node[ROOM], weight[ROOM]; /* the rest is 0 */
    int32_t n;                       /* rounded up */
} rule;

/* ... 1: Gauss and Legendre; */
static const rule WHOLE[2] = {
    {{0.01985507175123185641, 0.10166676129318663602, 0.23723379504183550459, 0.40828267875217510996,
      0.59171732124782494555, 0.76276620495816449541, 0.89833323870681336398, 0.98014492824876819910},
     {0.05061426814518812933, 0.11119051722668724103, 0.15685332293894363453, 0.18134189168918099511,
      0.18134189168918099511, 0.15685332293894363453, 0.11119051722668724103, 0.05061426814518812933},
     8},
    {{0.01304673574141413996, 0.06746831665550774463, 0.16029521585048779688, 0.28330230293537640460,
      0.42556283050918439456, 0.57443716949081560544, 0.71669769706462359540, 0.83970478414951220312,
      0.93253168334449225537, 0.98695326425858586004},
     {0.03333567215434406880, 0.07472567457529029657, 0.10954318125799102200, 0.13463335965499817755,
      0.14776211235737643509, 0.14776211235737643509, 0.13463335965499817755, 0.10954318125799102200,
      0.07472567457529029657, 0.03333567215434406880},
     ROOM}};
/* ... the root of t, s being 0 at t = 0: the squares of the positive zeros of P_17 and P_21, and their
 * weights there times twice the zeros; */
static const rule FROM_ZERO[2] = {
    {{0.03185660304424275946, 0.12336375165891971806, 0.26285158681802017755, 0.43253135366542577733,
      0.61076413828680964357, 0.77482096775400033373, 0.90378394769031888956, 0.98123977229438386072},
     {0.06302729990024044660, 0.11801675413579025553, 0.15795560796472993270, 0.17775058420605799325,
      0.17487758678299006321, 0.14970429446183250444, 0.10544803404933117408, 0.04784143318409675438},
     8},
    {{0.02118825338675769150, 0.08295627893258909625, 0.18006623498214442643, 0.30428334010557153850,
      0.44507418406595325323, 0.59049997746650119822, 0.72822903201295969525, 0.84658278470401096083,
      0.93552775724297153710, 0.98754337661273572464},
     {0.04207448043255661265, 0.08058110330356446811, 0.11225456371451605788, 0.13440900779609855377,
      0.14516580013255898386, 0.14361285869512088124, 0.12988209802217303721, 0.10513869358463409598,
      0.07148539450621113178, 0.03183431069697096669},
     ROOM}};
/* ... the root of t (1 - t), s being 0 at both ends: of k = 1 to n (1 + cos(k pi/(n + 1)))/2 and
 * pi/(2 n + 2) sin(k pi/(n + 1)). */
static const rule BETWEEN_ZEROS[2] = {
    {{0.03015368960704584156, 0.11697777844051098240, 0.25, 0.41317591116653482558, 0.58682408883346517442,
      0.75, 0.88302222155948901760, 0.96984631039295415844},
     {0.05969377609175827157, 0.11218760180054306030, 0.15114994701951814382, 0.17188137789230134578,
      0.17188137789230134578, 0.15114994701951814382, 0.11218760180054306030, 0.05969377609175827157},
     8},
    {{0.02025351319275131567, 0.07937323358440945276, 0.17256963302735750521, 0.29229249349905683797,
      0.42884258086335746984, 0.57115741913664253016, 0.70770750650094327305, 0.82743036697264260582,
      0.92062676641559060275, 0.97974648680724873984},
     {0.04023131503864110087, 0.07720332819769483435, 0.10792078685204321842, 0.12989514518527181530,
      0.14134617137176341828, 0.14134617137176339052, 0.12989514518527181530, 0.10792078685204321842,
      0.07720332819769480659, 0.04023131503864110087},
     ROOM}};

/* Up to this half width over a of graded(), 8 points are within 1e-8 (7e-9 of the force at worst). */
#define FLAT 0.35

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

/* Over a point c, or a line through it along the unit vector e: d^2 = least2 + uu x^2, x = t - m.  The parts
 * of the span that have a rule of their own. */
typedef struct {
    double from, by;
    const rule *g;
} part;

/* graded() makes pieces each way up to the 1000th of R/sqrt(uu), three times as long each, of up to three
 * parts: 48. */
enum { PARTS = 48 };

typedef struct {
    double R, least2, uu;
    double small; /* distances below it have no direction */
    int longer, n;
    part part[PARTS];
} bundle;

/* With P = s^(7/2) dt: of s P, P, P/s; of x P; of P/d times 1, x, x^2. */
typedef struct {
    double u, du, ddu, far, f, fx, fxx;
} sums;

FL_WIDE_VERSIONS static void sum_up(const bundle *b, sums *out)
{
    const fl_wide zero = {0};
    const double R = b->R, least2 = b->least2, uu = b->uu, small = b->small;
    fl_wide u = zero, du = zero, ddu = zero, far = zero, f = zero, fx = zero, fxx = zero;
    for (int k = 0; k < b->n; k++) {
        const part *q = &b->part[k];
        const rule *g = q->g;
        const double from = q->from, by = q->by, share = fabs(by);
        for (int32_t c = 0; c < g->n; c += FL_LANES) {
            const fl_wide x = from + by * *(const fl_wide *)(g->node + c), d2 = least2 + uu * (x * x);
            fl_wide d, root;
            for (int l = 0; l < FL_LANES; l++) d[l] = sqrt(d2[l]);
            const fl_wide_mask in = (d < R) & (d > small);
            const fl_wide s = FL_WIDE_WHERE(in, R - d);
            for (int l = 0; l < FL_LANES; l++) root[l] = sqrt(s[l]);
            const fl_wide bend = share * *(const fl_wide *)(g->weight + c) * (root * s * s), pull = bend * s;
            const fl_wide force = FL_WIDE_WHERE(in, pull / d), px = force * x;
            u += pull * s;
            du += pull;
            ddu += bend;
            far += pull * x;
            f += force;
            fx += px;
            fxx += px * x;
        }
    }
    *out = (sums){fl_wide_sum(&u), fl_wide_sum(&du), fl_wide_sum(&ddu), fl_wide_sum(&far),
                  fl_wide_sum(&f), fl_wide_sum(&fx), fl_wide_sum(&fxx)};
}

/* A piece t; zero_lo, zero_hi: s is 0 at that end. */
static void gauss(bundle *b, fl_span t, int zero_lo, int zero_hi)
{
    const rule *g = zero_lo && zero_hi ? BETWEEN_ZEROS : zero_lo || zero_hi ? FROM_ZERO : WHOLE;
    const int back = zero_hi && !zero_lo;
    b->part[b->n++] = (part){back ? t.hi : t.lo, back ? t.lo - t.hi : t.hi - t.lo, g + b->longer};
}

/* The same where an end that is not 0 may be nearly so: the quarter next to it is a piece of its own. */
static void gauss_over_point(bundle *b, fl_span t, int zero_lo, int zero_hi)
{
    if (zero_lo && zero_hi) {
        gauss(b, t, 1, 1);
        return;
    }
    const double quarter = 0.25 * (t.hi - t.lo), middle = 0.5 * (t.lo + t.hi);
    const double s0 = b->R - sqrt(b->least2 + b->uu * (t.lo * t.lo));
    const double s1 = b->R - sqrt(b->least2 + b->uu * (t.hi * t.hi));
    const double sm = b->R - sqrt(b->least2 + b->uu * (middle * middle));
    const double most = s0 > s1 ? (s0 > sm ? s0 : sm) : s1 > sm ? s1 : sm;
    const int near_lo = !zero_lo && s0 < 0.3 * most, near_hi = !zero_hi && s1 < 0.3 * most;
    const fl_span mid = {near_lo ? t.lo + quarter : t.lo, near_hi ? t.hi - quarter : t.hi};
    if (near_lo) gauss(b, (fl_span){t.lo, mid.lo}, 0, 0);
    if (near_hi) gauss(b, (fl_span){mid.hi, t.hi}, 0, 0);
    gauss(b, mid, zero_lo, zero_hi);
}

/* d^2 = uu (x^2 + a^2).  Where the overlap is large d is singular at +- i a, and pieces that grow threefold
 * from 0 keep away. */
static void graded(bundle *b, fl_span t, int zero_lo, int zero_hi, double a)
{
    const double bend = 1e-3 * b->R / sqrt(b->uu);
    for (int way = 0; way < 2; way++) {
        double from = 0.0, to = a > bend ? a : bend;
        const double first = way ? t.lo : -t.hi, last = way ? t.hi : -t.lo;
        const int zero = way ? zero_hi : zero_lo;
        for (; from < last; from = to, to *= 3.0) {
            if (last < 1.3 * to) to = last; /* no crumbs */
            const double lo = from > first ? from : first, hi = to < last ? to : last;
            if (!(lo < hi)) continue;
            const int end = zero && hi == last;
            gauss_over_point(b, way ? (fl_span){lo, hi} : (fl_span){-hi, -lo}, !way && end, way && end);
        }
    }
}

/* One place: the part `share` of the bundle with force f and scalar sum du, where it meets the point c; q:
 * all of it; s: mean overlap. */
static int tie(const fl_line *l, const sums *q, double share, double du, double s, fl_vec3 f, fl_vec3 c)
{
    const double size = v3_norm(f);
    if (!(size > 0.0) || !(du > 0.0)) return 0;
    const fl_vec3 n = v3_scale(1.0 / size, f);
    return fl_places_add(l->w, (fl_place){.overlap = s,
                                          .u = share * (l->factor * q->u),
                                          .du = 4.5 * l->factor * du,
                                          .ddu = share * (15.75 * l->factor * q->ddu),
                                          .n = v3_scale(l->own->side / du, f),
                                          .across = v3_scale(l->own->side, n),
                                          .p = v3_madd(c, l->R - 0.5 * s - l->own->r, n)});
}

/* The forces all meet the point or the line, at tau + t slope, so that one place has their resultant, or two
 * at the ends of the span. */
static inline __attribute__((always_inline)) int at_foot(const fl_line *l, const fl_strip_foot *at, fl_vec3 c,
                                                         const fl_vec3 *e, double small)
{
    const fl_vec3 q = at->q, u = at->u;
    fl_span t = at->t;
    bundle b;
    b.uu = at->uu, b.least2 = at->least2, b.R = l->R, b.small = small, b.n = 0, b.longer = 1;
    if (b.uu > 0.0) {
        const double half = sqrt((l->R * l->R - b.least2) / b.uu), a = sqrt(b.least2 / b.uu);
        const int zero_lo = -half > t.lo, zero_hi = half < t.hi;
        if (zero_lo) t.lo = -half;
        if (zero_hi) t.hi = half;
        if (!(t.lo < t.hi)) return 0;
        b.longer = !(half <= FLAT * a);
        if (half <= 0.5 * a) gauss_over_point(&b, t, zero_lo, zero_hi);
        else graded(&b, t, zero_lo, zero_hi, a);
    } else {
        gauss(&b, t, 0, 0);
    }
    sums sum;
    sum_up(&b, &sum);
    if (!(sum.du > 0.0)) return 0;
    const double mean = sum.u / sum.du;
    const fl_vec3 f = v3_madd(v3_scale(sum.f, q), sum.fx, u);
    if (at->slope == 0.0) return tie(l, &sum, 1.0, sum.du, mean, f, e ? v3_madd(c, at->tau, *e) : c);
    const double over = 1.0 / (t.hi - t.lo), far = over * (sum.far - t.lo * sum.du), part_far = far / sum.du;
    const fl_vec3 ffar =
        v3_madd(v3_scale(over * (sum.fx - t.lo * sum.f), q), over * (sum.fxx - t.lo * sum.fx), u);
    return tie(l, &sum, 1.0 - part_far, sum.du - far, mean, v3_sub(f, ffar),
               v3_madd(c, at->tau + (at->m + t.lo) * at->slope, *e)) ||
                   tie(l, &sum, part_far, far, mean, ffar,
                       v3_madd(c, at->tau + (at->m + t.hi) * at->slope, *e))
               ? -1
               : 0;
}

int fl_strips_over_point(const fl_line *l, fl_span t, fl_vec3 c, const fl_vec3 *e, double small)
{
    fl_strip_foot at = {.t = t, .q = v3_sub(l->x0, c), .u = l->u};
    if (e) {
        at.tau = v3_dot(at.q, *e), at.slope = v3_dot(at.u, *e);
        at.q = v3_madd(at.q, -at.tau, *e);
        at.u = v3_madd(at.u, -at.slope, *e);
    }
    at.uu = v3_norm2(at.u);
    at.m = at.uu > 0.0 ? -v3_dot(at.q, at.u) / at.uu : 0.0;
    at.q = v3_madd(at.q, at.m, at.u); /* what is nearest */
    at.least2 = v3_norm2(at.q);
    if (!(l->R * l->R - at.least2 > 0.0)) return 0;
    at.t.lo -= at.m, at.t.hi -= at.m;
    return at_foot(l, &at, c, e, small);
}

int fl_strips_at_foot(const fl_line *l, const fl_strip_foot *at, fl_vec3 c, const fl_vec3 *e, double small)
{
    return at_foot(l, at, c, e, small);
}

double fl_strips_factor(const fl_side *own, int32_t e, double other)
{
    const fl_edge g = own->p->edge[e];
    const double sharp = fl_poly_edge(own->p, e) * FL_PLACE_SHARP_EDGE, rho = fl_place_rho(own->r, other);
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
