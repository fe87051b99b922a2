/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "patch/edge_integral.h"
#include "patch/patch_law.h"
#include <assert.h>
#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "geom/simd3.h"
#include "geom/quadrature_line.h"

/* FL_EDGE_CURVED_NODES, rounded up to full registers. */
enum { NODES_PADDED = (FL_EDGE_CURVED_NODES + FL_SIMD_WIDTH - 1) / FL_SIMD_WIDTH * FL_SIMD_WIDTH };

/* Rules for int_0^1 s^(9/2) dt over a piece on which s is curved, two for each number of ends with s = 0:
 * with 8 and with FL_EDGE_CURVED_NODES nodes.  They are exact for polynomials of degree 15 and 19 times a
 * weight. */
typedef struct {
    double node[NODES_PADDED], weight[NODES_PADDED]; /* padded with 0 */
    int32_t n;                                       /* nodes, rounded up to full registers */
} gauss_rule;

static const gauss_rule RULE[] = {
    /* Weight 1: Gauss-Legendre. */
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
     NODES_PADDED},
    /* Weight sqrt(t), s = 0 at t = 0: nodes are the squares of the positive zeros of P_17 and P_21, weights
     * those of the zeros times twice the zero. */
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
     NODES_PADDED},
    /* Weight sqrt(t (1 - t)), s = 0 at both ends: nodes (1 + cos(k pi/(n + 1)))/2 and weights pi/(2 n + 2)
     * sin(k pi/(n + 1)), k = 1 to n. */
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
     NODES_PADDED}};

/* Up to this half width over a (see append_graded()) 8 nodes are within 1e-8 in energy and 7e-9 in force. */
#define EIGHT_NODES_MAX 0.35

/* An end with less than this part of the largest overlap counts as nearly s = 0 and gets a piece of its own.
 */
#define NEARLY_ZERO 0.3

/* Fraction of R within which the direction of the force turns where two lines almost cross: graded pieces
 * begin there. */
#define TURN_LENGTH 1e-9

#define MASK(a) (*(const fl_simd_mask *)(const void *)(a))
#define MASK_INTO(a) (*(fl_simd_mask *)(void *)(a))

FL_SIMD_INLINE void take_square_roots(fl_simd *a)
{
    FL_SIMD_UNROLL
    for (int l = 0; l < FL_SIMD_WIDTH; l++) (*a)[l] = sqrt((*a)[l]);
}

/* Two points a lane; `some` is the mask of points that exist. */
typedef struct {
    double s[2][FL_SIMD_WIDTH], u[2][FL_SIMD_WIDTH], du[2][FL_SIMD_WIDTH], ddu[2][FL_SIMD_WIDTH];
    double n[2][3][FL_SIMD_WIDTH], across[2][3][FL_SIMD_WIDTH], p[2][3][FL_SIMD_WIDTH];
    int64_t some[2][FL_SIMD_WIDTH];
} point_pairs;

/* Stores the existing points of four lanes one after the other and returns their number.  out has space for
 * all eight. */
FL_SIMD_INLINE int32_t store_points(const point_pairs *q, int32_t group_size, fl_patch_point *out)
{
    fl_simd a[2][FL_SIMD_WIDTH], b[2][FL_SIMD_WIDTH], c[2][FL_SIMD_WIDTH];
    char *at = (char *)out;
    FL_SIMD_UNROLL
    for (int k = 0; k < 2; k++) {
        a[k][0] = FL_SIMD_LOAD(q->s[k]);
        a[k][1] = FL_SIMD_LOAD(q->u[k]), a[k][2] = FL_SIMD_LOAD(q->du[k]), a[k][3] = FL_SIMD_LOAD(q->ddu[k]);
        b[k][0] = FL_SIMD_LOAD(q->n[k][0]), b[k][1] = FL_SIMD_LOAD(q->n[k][1]),
        b[k][2] = FL_SIMD_LOAD(q->n[k][2]);
        b[k][3] = FL_SIMD_LOAD(q->across[k][0]), c[k][0] = FL_SIMD_LOAD(q->across[k][1]);
        c[k][1] = FL_SIMD_LOAD(q->across[k][2]), c[k][2] = FL_SIMD_LOAD(q->p[k][0]),
        c[k][3] = FL_SIMD_LOAD(q->p[k][1]);
        fl_simd_transpose(a[k]), fl_simd_transpose(b[k]), fl_simd_transpose(c[k]);
    }
    FL_SIMD_UNROLL
    for (int l = 0; l < FL_SIMD_WIDTH; l++) {
        FL_SIMD_UNROLL
        for (int k = 0; k < 2; k++) {
            fl_patch_point *const p = (fl_patch_point *)(void *)at;
            FL_SIMD_STORE(&p->overlap) = a[k][l], FL_SIMD_STORE(&p->n) = b[k][l];
            FL_SIMD_STORE(&p->unit_normal.y) = c[k][l];
            p->p.z = q->p[k][2][l], p->approach_speed = 0.0, p->group_size = group_size;
            at += sizeof *p & (size_t)q->some[k][l]; /* the mask has all bits or none */
        }
    }
    return (int32_t)((fl_patch_point *)(void *)at - out);
}
static_assert(offsetof(fl_patch_point, ddu) == 3 * sizeof(double) &&
                  offsetof(fl_patch_point, unit_normal) == 7 * sizeof(double) &&
                  offsetof(fl_patch_point, p) == 10 * sizeof(double) &&
                  offsetof(fl_patch_point, n) == 4 * sizeof(double),
              "three registers of four lie in a row");

/* --- edges over faces ----------------------------------------------------------------------------------- */

/* The distance is linear along the edge and its direction constant, so two points have the force and the
 * torque of all nodes and the second moment of the pressure. */
FL_SIMD_VERSIONS static int32_t integrate_over_faces(const fl_edge_face_lanes *f, double R,
                                                     fl_patch_point *point)
{
    point_pairs points, *const out = &points;
    const fl_simd zero = {0};
    const fl_edge_lanes *e = &f->of;
    const fl_simd s0 = R - FL_SIMD_LOAD(f->h0), s1 = R - FL_SIMD_LOAD(f->h1), ds = s1 - s0,
                  zeroed = s0 / (s0 - s1);
    const fl_simd_mask in0 = s0 >= 0.0, in1 = s1 >= 0.0;
    fl_simd lo = FL_SIMD_LOAD(e->lo), hi = FL_SIMD_LOAD(e->hi);
    lo = FL_SIMD_SELECT(~in0 & in1 & (zeroed > lo), zeroed, lo);
    hi = FL_SIMD_SELECT(in0 & ~in1 & (zeroed < hi), zeroed, hi);
    fl_simd p = s0 + lo * ds, q = s0 + hi * ds;
    p = FL_SIMD_MAX(p, zero), q = FL_SIMD_MAX(q, zero);
    const fl_simd deepest = FL_SIMD_MAX(p, q);
    take_square_roots(&p), take_square_roots(&q);
    fl_line_integrals sum;
    fl_line_integrate(&p, &q, &sum);
    const fl_simd both = p + q, over = 1.0 / both, dt = hi - lo, share = FL_SIMD_LOAD(e->factor) * dt * over,
                  each = over / sum.du;
    const fl_simd mean = each * sum.first, square = each * over * sum.second - mean * mean;
    fl_simd spread = FL_SIMD_MAX(square, zero);
    take_square_roots(&spread);
    const fl_simd_mask some = (in0 | in1) & (lo < hi) & (both > 0.0) & (sum.u > 0.0);
    const fl_simd3 x = FL_SIMD3_LOAD(e->x), u = FL_SIMD3_LOAD(e->u), n = FL_SIMD3_LOAD(f->n),
                   to = FL_SIMD3_SCALE(FL_SIMD_LOAD(e->side), n);
    FL_SIMD_UNROLL
    for (int k = 0; k < 2; k++) {
        const fl_simd at = lo + dt * (k ? mean + spread : mean - spread), s = s0 + at * ds,
                      up = 0.5 * s - FL_SIMD_LOAD(e->r);
        const fl_simd3 foot = FL_SIMD3_MADD(x, at, u), y = FL_SIMD3_MADD(foot, up, n);
        FL_SIMD_STORE(out->s[k]) = deepest;
        FL_SIMD_STORE(out->u[k]) = share * sum.u;
        FL_SIMD_STORE(out->du[k]) = 4.5 * share * sum.du;
        FL_SIMD_STORE(out->ddu[k]) = 15.75 * share * sum.ddu;
        FL_SIMD3_STORE(out->n[k], to), FL_SIMD3_STORE(out->across[k], to), FL_SIMD3_STORE(out->p[k], y);
        MASK_INTO(out->some[k]) = some;
    }
    return store_points(out, 2, point);
}

/* --- edges over lines and points ------------------------------------------------------------------------ */

/* An edge relative to the line or point below it.  The parameter is x = t - m, where m is the point of the
 * edge part nearest to the line: d^2 = least2 + x (linear + uu x).  linear is 0 but for rounding where m is
 * inside the part.  (Measured from the nearest point of the infinite line x would lose all digits when edges
 * are parallel but for rounding.)
 *     tau + t slope   foot of the edge on the other line
 *     q, u            vector from that foot to the edge at m, and its rate
 *     lo, hi          part to integrate, in x
 *     zeros, zero_lo  number of ends with s = 0; whether lo is one
 *     half            distance in x to where s = 0;  a: to where d is singular */
typedef struct {
    double lo[FL_SIMD_WIDTH], hi[FL_SIMD_WIDTH], m[FL_SIMD_WIDTH], tau[FL_SIMD_WIDTH], slope[FL_SIMD_WIDTH];
    double uu[FL_SIMD_WIDTH], linear[FL_SIMD_WIDTH], least2[FL_SIMD_WIDTH], a[FL_SIMD_WIDTH],
        half[FL_SIMD_WIDTH];
    double q[3][FL_SIMD_WIDTH], u[3][FL_SIMD_WIDTH];
    double from[FL_SIMD_WIDTH], by[FL_SIMD_WIDTH];
    int64_t some[FL_SIMD_WIDTH], zeros[FL_SIMD_WIDTH], zero_lo[FL_SIMD_WIDTH], gauss_rule[FL_SIMD_WIDTH],
        more[FL_SIMD_WIDTH];
} edge_feet;

/* A piece of an edge that has several: nodes at from + t by; edge = lane in its group of four + 4 times the
 * group. */
typedef struct {
    double from, by;
    const gauss_rule *g;
    int32_t edge;
} edge_piece;

/* With P = s^(7/2) dt: integrals of s P, P, P/s; of P times x, x^2; of P/d times 1, x, x^2. */
typedef struct {
    double u[FL_SIMD_WIDTH], du[FL_SIMD_WIDTH], ddu[FL_SIMD_WIDTH], first[FL_SIMD_WIDTH],
        second[FL_SIMD_WIDTH];
    double f[FL_SIMD_WIDTH], fx[FL_SIMD_WIDTH], fxx[FL_SIMD_WIDTH];
} edge_sums;

FL_SIMD_INLINE void distance_at(const fl_simd *least2, const fl_simd *linear, const fl_simd *uu,
                                const fl_simd *x, fl_simd *d)
{
    *d = *least2 + *x * (*linear + *uu * *x);
    take_square_roots(d);
}

/* Prepares four edges.  Where an end with s > 0 has nearly s = 0, the quarter of the part next to it becomes
 * a piece of its own.  `more` marks these lanes and those for which one rule is too coarse. */
FL_SIMD_VERSIONS static void prepare_over_points(const fl_edge_point_lanes *p, double R, edge_feet *out)
{
    const fl_simd zero = {0};
    const fl_edge_lanes *of = &p->of;
    const fl_simd3 x = FL_SIMD3_LOAD(of->x), c = FL_SIMD3_LOAD(p->c), e = FL_SIMD3_LOAD(p->e),
                   u0 = FL_SIMD3_LOAD(of->u), q0 = FL_SIMD3_SUB(x, c);
    const fl_simd tau = FL_SIMD3_DOT(q0, e), slope = FL_SIMD3_DOT(u0, e), back = -tau, down = -slope;
    const fl_simd3 q1 = FL_SIMD3_MADD(q0, back, e), u = FL_SIMD3_MADD(u0, down, e);
    const fl_simd uu = FL_SIMD3_DOT(u, u), foot = -FL_SIMD3_DOT(q1, u) / uu, begin = FL_SIMD_LOAD(of->lo),
                  end = FL_SIMD_LOAD(of->hi);
    fl_simd m = FL_SIMD_SELECT(foot > begin, foot, begin);
    m = FL_SIMD_SELECT(m < end, m, end);
    const fl_simd3 q = FL_SIMD3_MADD(q1, m, u);
    const fl_simd least2 = FL_SIMD3_DOT(q, q), away = FL_SIMD3_DOT(q, u), linear = 2.0 * away;
    fl_simd reserve_points = R * R - least2;
    const fl_simd_mask there = (begin < end) & (reserve_points > 0.0);
    reserve_points = FL_SIMD_MASKED(there, reserve_points);
    fl_simd turn = away * away + uu * reserve_points, a = least2 / uu;
    take_square_roots(&turn), take_square_roots(&a);
    const fl_simd back_by = turn - away, on_by = turn + away;
    const fl_simd back_to = reserve_points / FL_SIMD_MAX(back_by, zero),
                  on_to = reserve_points / FL_SIMD_MAX(on_by, zero);
    const fl_simd half = FL_SIMD_MIN(back_to, on_to);
    fl_simd lo = begin - m, hi = end - m;
    const fl_simd_mask zero_lo = -back_to > lo, zero_hi = on_to < hi;
    lo = FL_SIMD_SELECT(zero_lo, -back_to, lo), hi = FL_SIMD_SELECT(zero_hi, on_to, hi);
    const fl_simd mid = 0.5 * (lo + hi), quarter = 0.25 * (hi - lo);
    const fl_simd_mask some = there & (lo < hi), append_graded = ~(half <= 0.5 * a),
                       backwards = zero_hi & ~zero_lo, longer = ~(half <= EIGHT_NODES_MAX * a),
                       which = -2 * (zero_lo + zero_hi) - longer;
    fl_simd s_lo, s_hi, s_mid;
    distance_at(&least2, &linear, &uu, &lo, &s_lo), distance_at(&least2, &linear, &uu, &hi, &s_hi);
    distance_at(&least2, &linear, &uu, &mid, &s_mid);
    s_lo = R - s_lo, s_hi = R - s_hi, s_mid = R - s_mid;
    const fl_simd ends = FL_SIMD_MAX(s_lo, s_hi), most = FL_SIMD_MAX(ends, s_mid);
    const fl_simd_mask near_lo = ~zero_lo & (s_lo < NEARLY_ZERO * most),
                       near_hi = ~zero_hi & (s_hi < NEARLY_ZERO * most);
    const fl_simd from = FL_SIMD_SELECT(near_lo, lo + quarter, lo),
                  to = FL_SIMD_SELECT(near_hi, hi - quarter, hi);
    const fl_simd by = FL_SIMD_SELECT(backwards, from - to, to - from);
    FL_SIMD_STORE(out->from) = FL_SIMD_SELECT(backwards, to, from), FL_SIMD_STORE(out->by) = by;
    FL_SIMD_STORE(out->lo) = lo, FL_SIMD_STORE(out->hi) = hi, FL_SIMD_STORE(out->m) = m;
    FL_SIMD_STORE(out->tau) = tau, FL_SIMD_STORE(out->slope) = slope;
    FL_SIMD_STORE(out->uu) = uu, FL_SIMD_STORE(out->linear) = linear, FL_SIMD_STORE(out->least2) = least2;
    FL_SIMD_STORE(out->a) = a, FL_SIMD_STORE(out->half) = half;
    FL_SIMD3_STORE(out->q, q), FL_SIMD3_STORE(out->u, u);
    MASK_INTO(out->some) = some, MASK_INTO(out->zeros) = -(zero_lo + zero_hi),
    MASK_INTO(out->zero_lo) = zero_lo;
    MASK_INTO(out->gauss_rule) = some & which,
    MASK_INTO(out->more) = some & (near_lo | near_hi | append_graded);
}

/* The queue, and scratch for edges over points. */
struct fl_edge_integral {
    fl_edge_queue queue; /* must be first: see fl_edge_queue_over_face() */
    edge_feet *feet;
    edge_sums *sum;
    edge_piece *piece;
    int32_t pieces, feet_cap, sum_cap, piece_cap;
};

/* Lane l of a group of four, while it is cut into pieces. */
typedef struct {
    struct fl_edge_integral *w;
    const edge_feet *f;
    double R;
    int32_t l, edge;
} edge_cutter;

static int append_piece(const edge_cutter *b, double from, double by, int64_t which)
{
    struct fl_edge_integral *const w = b->w;
    if (fl_reserve(&w->piece, &w->piece_cap, (int64_t)w->pieces + 1, sizeof *w->piece)) return -1;
    w->piece[w->pieces++] = (edge_piece){from, by, &RULE[which], b->edge};
    return 0;
}

/* zero_lo, zero_hi: s = 0 at that end. */
static int append_rule_piece(const edge_cutter *b, fl_edge_span t, int zero_lo, int zero_hi)
{
    const int back = zero_hi && !zero_lo, longer = (int)b->f->gauss_rule[b->l] & 1;
    return append_piece(b, back ? t.hi : t.lo, back ? t.lo - t.hi : t.hi - t.lo,
                        2 * (zero_lo + zero_hi) + longer);
}

static double overlap_of(const edge_cutter *b, double x)
{
    return b->R - sqrt(b->f->least2[b->l] + x * (b->f->linear[b->l] + b->f->uu[b->l] * x));
}

/* Appends the quarters next to ends with nearly s = 0, and what remains between them. */
static int append_with_ends(const edge_cutter *b, fl_edge_span t, int zero_lo, int zero_hi)
{
    const double quarter = 0.25 * (t.hi - t.lo), s0 = overlap_of(b, t.lo), s1 = overlap_of(b, t.hi),
                 sm = overlap_of(b, 0.5 * (t.lo + t.hi));
    const double most = s0 > s1 ? (s0 > sm ? s0 : sm) : s1 > sm ? s1 : sm;
    const int near_lo = !zero_lo && s0 < NEARLY_ZERO * most, near_hi = !zero_hi && s1 < NEARLY_ZERO * most;
    const fl_edge_span mid = {near_lo ? t.lo + quarter : t.lo, near_hi ? t.hi - quarter : t.hi};
    return (near_lo && append_rule_piece(b, (fl_edge_span){t.lo, mid.lo}, 0, 0)) ||
           (near_hi && append_rule_piece(b, (fl_edge_span){mid.hi, t.hi}, 0, 0)) ||
           append_rule_piece(b, mid, zero_lo, zero_hi);
}

/* For large overlaps.  d is singular at x = +- i a, so pieces that grow threefold from x = 0 keep their
 * distance from the singularity.  Where the lines almost cross, the smallest piece is the length over which
 * the direction of the force turns, TURN_LENGTH R. */
static int append_graded(const edge_cutter *b, fl_edge_span t, int zero_lo, int zero_hi)
{
    const double a = b->f->a[b->l], bend = TURN_LENGTH * b->R / sqrt(b->f->uu[b->l]);
    for (int direction = 0; direction < 2; direction++) {
        double from = 0.0, to = a > bend ? a : bend;
        const double first = direction ? t.lo : -t.hi, last = direction ? t.hi : -t.lo;
        const int zero = direction ? zero_hi : zero_lo;
        for (; from < last; from = to, to *= 3.0) {
            if (last < 1.3 * to) to = last; /* no tiny last piece */
            const double lo = from > first ? from : first, hi = to < last ? to : last;
            if (!(lo < hi)) continue;
            const int end = zero && hi == last;
            if (append_with_ends(b, direction ? (fl_edge_span){lo, hi} : (fl_edge_span){-hi, -lo},
                                 !direction && end, direction && end))
                return -1;
        }
    }
    return 0;
}

static int cut_edge(struct fl_edge_integral *w, const edge_feet *f, int32_t l, int32_t edge, double R)
{
    const edge_cutter b = {w, f, R, l, edge};
    const fl_edge_span t = {f->lo[l], f->hi[l]};
    const int zero_lo = f->zero_lo[l] != 0, zero_hi = f->zeros[l] - zero_lo != 0;
    return f->half[l] <= 0.5 * f->a[l] ? append_with_ends(&b, t, zero_lo, zero_hi)
                                       : append_graded(&b, t, zero_lo, zero_hi);
}

/* Four pieces by lanes, each of some edge, with its own rule. */
typedef struct {
    fl_simd least2, linear, uu, small, from, by;
    const gauss_rule *g[FL_SIMD_WIDTH];
} piece_lanes;

FL_SIMD_INLINE void integrate_pieces(const piece_lanes *p, double R, const fl_simd_mask *counted,
                                     edge_sums *out)
{
    const fl_simd zero = {0}, share = FL_SIMD_MAX(p->by, -p->by);
    fl_simd u = zero, du = zero, ddu = zero, first = zero, second = zero, f = zero, fx = zero, fxx = zero;
    const int alike = p->g[0] == p->g[1] && p->g[0] == p->g[2] && p->g[0] == p->g[3];
    int32_t n = p->g[0]->n;
    for (int l = 1; l < FL_SIMD_WIDTH && !alike; l++) n = p->g[l]->n > n ? p->g[l]->n : n;
    for (int32_t c = 0; c < n; c += FL_SIMD_WIDTH) {
        fl_simd node[FL_SIMD_WIDTH], weight[FL_SIMD_WIDTH];
        FL_SIMD_UNROLL
        for (int l = 0; l < FL_SIMD_WIDTH; l++)
            if (alike)
                node[l] = FL_SIMD_SPLAT(p->g[0]->node[c + l]),
                weight[l] = FL_SIMD_SPLAT(p->g[0]->weight[c + l]);
            else node[l] = FL_SIMD_LOAD(p->g[l]->node + c), weight[l] = FL_SIMD_LOAD(p->g[l]->weight + c);
        if (!alike) fl_simd_transpose(node), fl_simd_transpose(weight);
        FL_SIMD_UNROLL
        for (int k = 0; k < FL_SIMD_WIDTH; k++) {
            const fl_simd x = p->from + p->by * node[k];
            fl_simd d;
            distance_at(&p->least2, &p->linear, &p->uu, &x, &d);
            const fl_simd_mask in = (d < R) & (d > p->small);
            const fl_simd s = FL_SIMD_MASKED(in, R - d);
            fl_simd s_root = s;
            take_square_roots(&s_root);
            const fl_simd bend = share * weight[k] * (s_root * s * s), pull = bend * s;
            const fl_simd force = FL_SIMD_MASKED(in, pull / d), px = force * x, far = pull * x;
            u += pull * s;
            du += pull;
            ddu += bend;
            first += far;
            second += far * x;
            f += force;
            fx += px;
            fxx += px * x;
        }
    }
    const fl_simd_mask m = *counted;
    FL_SIMD_STORE(out->u) = FL_SIMD_MASKED(m, u), FL_SIMD_STORE(out->du) = FL_SIMD_MASKED(m, du);
    FL_SIMD_STORE(out->ddu) = FL_SIMD_MASKED(m, ddu), FL_SIMD_STORE(out->first) = FL_SIMD_MASKED(m, first);
    FL_SIMD_STORE(out->second) = FL_SIMD_MASKED(m, second), FL_SIMD_STORE(out->f) = FL_SIMD_MASKED(m, f);
    FL_SIMD_STORE(out->fx) = FL_SIMD_MASKED(m, fx), FL_SIMD_STORE(out->fxx) = FL_SIMD_MASKED(m, fxx);
}

/* Integrates the edges of a group that have a single piece; 0 for the others. */
FL_SIMD_VERSIONS static void integrate_single_pieces(const fl_edge_point_lanes *p, const edge_feet *a,
                                                     double R, edge_sums *out)
{
    const fl_simd_mask counted = MASK(a->some) & ~MASK(a->more);
    const piece_lanes q = {
        FL_SIMD_LOAD(a->least2),
        FL_SIMD_LOAD(a->linear),
        FL_SIMD_LOAD(a->uu),
        FL_SIMD_LOAD(p->small),
        FL_SIMD_LOAD(a->from),
        FL_SIMD_LOAD(a->by),
        {&RULE[a->gauss_rule[0]], &RULE[a->gauss_rule[1]], &RULE[a->gauss_rule[2]], &RULE[a->gauss_rule[3]]}};
    integrate_pieces(&q, R, &counted, out);
}

/* Integrates four pieces of any edges. */
FL_SIMD_VERSIONS static void integrate_four(const struct fl_edge_integral *w, const fl_edge_point_lanes *p,
                                            const edge_piece *q[FL_SIMD_WIDTH], double R, edge_sums *out)
{
    const fl_simd zero = {0};
    const fl_simd_mask all = zero == zero;
    piece_lanes four;
    FL_SIMD_UNROLL
    for (int l = 0; l < FL_SIMD_WIDTH; l++) {
        const int32_t k = q[l]->edge / FL_SIMD_WIDTH, lane = q[l]->edge % FL_SIMD_WIDTH;
        four.least2[l] = w->feet[k].least2[lane], four.linear[l] = w->feet[k].linear[lane];
        four.uu[l] = w->feet[k].uu[lane], four.small[l] = p[k].small[lane];
        four.from[l] = q[l]->from, four.by[l] = q[l]->by, four.g[l] = q[l]->g;
    }
    integrate_pieces(&four, R, &all, out);
}

/* Integrates all pieces of edges that have several and adds each to the sums of its edge. */
static void integrate_cut_edges(struct fl_edge_integral *w, const fl_edge_point_lanes *p, double R)
{
    for (int32_t k = 0; k < w->pieces; k += FL_SIMD_WIDTH) {
        const edge_piece *q[FL_SIMD_WIDTH];
        edge_sums four;
        for (int32_t l = 0; l < FL_SIMD_WIDTH; l++) q[l] = &w->piece[k + l < w->pieces ? k + l : k];
        integrate_four(w, p, q, R, &four);
        for (int32_t i = 0; i < FL_SIMD_WIDTH && k + i < w->pieces; i++) {
            edge_sums *const s = &w->sum[q[i]->edge / FL_SIMD_WIDTH];
            const int32_t l = q[i]->edge % FL_SIMD_WIDTH;
            s->u[l] += four.u[i], s->du[l] += four.du[i], s->ddu[l] += four.ddu[i],
                s->first[l] += four.first[i], s->second[l] += four.second[i];
            s->f[l] += four.f[i], s->fx[l] += four.fx[i], s->fxx[l] += four.fxx[i];
        }
    }
}

/* The forces of all nodes pass through the point or the line, at tau + t slope.  So two points with equal
 * shares have their resultant and the second moment of the pressure.  One point would do where all forces
 * meet in a point.  But damping depends on directions: two different ones are not damped as their mean is,
 * and rounding must not decide whether lines cross at right angles. */
FL_SIMD_VERSIONS static int32_t make_points(const fl_edge_point_lanes *p, const edge_feet *a,
                                            const edge_sums *sum, double R, fl_patch_point *point)
{
    point_pairs points, *const out = &points;
    const fl_simd zero = {0}, one = 1.0 + zero;
    const fl_edge_lanes *of = &p->of;
    const fl_simd factor = FL_SIMD_LOAD(of->factor), du = FL_SIMD_LOAD(sum->du),
                  slope = FL_SIMD_LOAD(a->slope), m = FL_SIMD_LOAD(a->m), r = FL_SIMD_LOAD(of->r),
                  side = FL_SIMD_LOAD(of->side);
    const fl_simd each = 1.0 / du, s = each * FL_SIMD_LOAD(sum->u), mean = each * FL_SIMD_LOAD(sum->first),
                  square = each * FL_SIMD_LOAD(sum->second) - mean * mean;
    fl_simd spread = FL_SIMD_MAX(square, zero), least = FL_SIMD_LOAD(a->least2);
    take_square_roots(&spread), take_square_roots(&least);
    const fl_simd deepest = R - least;
    const fl_simd_mask two = spread > 0.0;
    spread = FL_SIMD_MASKED(two, spread);
    const fl_simd f = FL_SIMD_LOAD(sum->f), fx = FL_SIMD_LOAD(sum->fx), fxx = FL_SIMD_LOAD(sum->fxx),
                  over = 0.5 / spread;
    const fl_simd f_turn = FL_SIMD_MASKED(two, over * (fx - mean * f)),
                  fx_turn = FL_SIMD_MASKED(two, over * (fxx - mean * fx));
    const fl_simd3 q = FL_SIMD3_LOAD(a->q), u = FL_SIMD3_LOAD(a->u), c = FL_SIMD3_LOAD(p->c),
                   e = FL_SIMD3_LOAD(p->e);
    const fl_simd_mask some = MASK(a->some) & (du > 0.0);
    FL_SIMD_UNROLL
    for (int k = 0; k < 2; k++) {
        const double sign = k ? 1.0 : -1.0;
        const fl_simd share = FL_SIMD_SELECT(two, 0.5 * one, (k ? zero : one)), pull = share * du,
                      along_q = share * f + sign * f_turn, along_u = share * fx + sign * fx_turn,
                      at = FL_SIMD_LOAD(a->tau) + (m + (mean + sign * spread)) * slope;
        const fl_simd3 part_q = FL_SIMD3_SCALE(along_q, q), force = FL_SIMD3_MADD(part_q, along_u, u);
        fl_simd size = FL_SIMD3_DOT(force, force);
        take_square_roots(&size);
        const fl_simd shorter = 1.0 / size, per = side / pull, up = R - 0.5 * s - r;
        const fl_simd3 n = FL_SIMD3_SCALE(shorter, force), long_n = FL_SIMD3_SCALE(per, force),
                       across = FL_SIMD3_SCALE(side, n);
        const fl_simd3 foot = FL_SIMD3_MADD(c, at, e), y = FL_SIMD3_MADD(foot, up, n);
        FL_SIMD_STORE(out->s[k]) = deepest;
        FL_SIMD_STORE(out->u[k]) = share * (factor * FL_SIMD_LOAD(sum->u));
        FL_SIMD_STORE(out->du[k]) = 4.5 * factor * pull;
        FL_SIMD_STORE(out->ddu[k]) = share * (15.75 * factor * FL_SIMD_LOAD(sum->ddu));
        FL_SIMD3_STORE(out->n[k], long_n), FL_SIMD3_STORE(out->across[k], across),
            FL_SIMD3_STORE(out->p[k], y);
        MASK_INTO(out->some[k]) = some & (size > 0.0) & (pull > 0.0);
    }
    return store_points(out, 0, point);
}

/* --- all edges ------------------------------------------------------------------------------------------ */

static struct fl_edge_integral *queue_of(fl_patch_points *w)
{
    if (!w->edges) w->edges = calloc(1, sizeof *w->edges);
    return w->edges;
}

/* Reserves memory for the points of `fours` groups. */
static int reserve_points(fl_patch_points *w, int32_t fours)
{
    return fl_reserve(&w->point, &w->point_cap, w->n + 2 * FL_SIMD_WIDTH * (int64_t)fours, sizeof *w->point);
}

int fl_edge_integral_over_faces(fl_patch_points *w, const fl_edge_face_lanes *q, int32_t fours, double R)
{
    if (reserve_points(w, fours)) return -1;
    for (int32_t k = 0; k < fours; k++) w->n += integrate_over_faces(&q[k], R, &w->point[w->n]);
    return 0;
}

int fl_edge_integral_over_points(fl_patch_points *w, const fl_edge_point_lanes *q, int32_t fours, double R)
{
    struct fl_edge_integral *s = queue_of(w);
    if (!s || fl_reserve(&s->feet, &s->feet_cap, fours, sizeof *s->feet) ||
        fl_reserve(&s->sum, &s->sum_cap, fours, sizeof *s->sum))
        return -1;
    s->pieces = 0;
    for (int32_t k = 0; k < fours; k++) {
        edge_feet *const f = &s->feet[k];
        prepare_over_points(&q[k], R, f);
        for (int32_t l = 0; l < FL_SIMD_WIDTH; l++)
            if (f->more[l] && cut_edge(s, f, l, k * FL_SIMD_WIDTH + l, R)) return -1;
        integrate_single_pieces(&q[k], f, R, &s->sum[k]);
    }
    integrate_cut_edges(s, q, R);
    if (reserve_points(w, fours)) return -1;
    for (int32_t k = 0; k < fours; k++)
        w->n += make_points(&q[k], &s->feet[k], &s->sum[k], R, &w->point[w->n]);
    return 0;
}

int fl_edge_integral_begin(fl_patch_points *w)
{
    struct fl_edge_integral *s = queue_of(w);
    if (!s) return -1;
    s->queue.faces = s->queue.points = 0;
    return 0;
}

/* Reserves one more group of four, all lanes empty. */
static int grow_queue(void *array, int32_t *cap, int32_t fours, size_t size)
{
    const int32_t had = *cap;
    char *all;
    if (fl_reserve(array, cap, (int64_t)fours + 1, size)) return -1;
    memcpy(&all, array, sizeof all); /* array is the address of a T*, for any T */
    if (*cap > had) memset(all + (size_t)had * size, 0, (size_t)(*cap - had) * size);
    fl_edge_lanes *const e = (fl_edge_lanes *)(void *)(all + (size_t)fours * size);
    for (int l = 0; l < FL_SIMD_WIDTH; l++) e->lo[l] = e->hi[l] = 0.0;
    return 0;
}

int fl_edge_queue_grow_faces(fl_edge_queue *s)
{
    return grow_queue(&s->face, &s->face_cap, s->faces / FL_SIMD_WIDTH, sizeof *s->face);
}

int fl_edge_queue_grow_points(fl_edge_queue *s)
{
    return grow_queue(&s->point, &s->point_cap, s->points / FL_SIMD_WIDTH, sizeof *s->point);
}

int fl_edge_integral_finish(fl_patch_points *w, double R)
{
    const fl_edge_queue *s = &w->edges->queue;
    const int32_t faces = (s->faces + FL_SIMD_WIDTH - 1) / FL_SIMD_WIDTH,
                  points = (s->points + FL_SIMD_WIDTH - 1) / FL_SIMD_WIDTH;
    return fl_edge_integral_over_faces(w, s->face, faces, R) ||
                   fl_edge_integral_over_points(w, s->point, points, R)
               ? -1
               : 0;
}

void fl_edge_integral_free(struct fl_edge_integral *s)
{
    if (s) free(s->queue.face), free(s->queue.point), free(s->feet), free(s->sum), free(s->piece);
    free(s);
}

double fl_edge_integral_factor(const fl_patch_core *own, int32_t e, double other)
{
    const fl_edge g = own->p->edge[e];
    const double weight = fl_poly_edge_angle(own->p, e) * FL_PATCH_EDGE_WEIGHT,
                 rho = fl_patch_feature_radius(own->r, other);
    return (weight < 1.0 ? weight : 1.0) * FL_PATCH_ROUND_FACTOR * (256.0 / 315.0) * sqrt(2.0 * rho) *
           v3_norm(v3_sub(own->p->v[g.b],
                          own->p->v[g.a])); /* from the core's own frame: the same bits in any pose */
}

int fl_edge_queue_over_plane(fl_patch_points *w, const fl_patch_core *own, int32_t e)
{
    const fl_edge g = own->p->edge[e];
    const fl_vec3 x0 = own->v[g.a], u = v3_sub(own->v[g.b], x0), up = v3(0, 0, 1);
    const fl_edge_line l = {w, own, x0, u, fl_edge_integral_factor(own, e, 0.0)};
    if (!(l.factor > 0.0)) return 0;
    return fl_edge_queue_over_face(&l, (fl_edge_span){0.0, 1.0}, x0.z, x0.z + u.z, up);
}
