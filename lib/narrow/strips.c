/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stddef.h>
#include "narrow/strips.h"

/* Points closer to each other than this fraction of the size have no direction between them. */
#define SAME 1e-13

/* Rules for int_0^1 of s^(9/2) dt over a piece where s is curved, exact for polynomials of degree 19 times
 * ... */
typedef struct {
    double node[FL_STRIP_CURVED], weight[FL_STRIP_CURVED];
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

/* Gauss and Legendre's, for pieces where s is linear. */
static const double NODE[FL_STRIP_NODES] = {0.03376524289842398609, 0.16939530676686774317,
                                            0.38069040695840154568, 0.61930959304159845432,
                                            0.83060469323313225683, 0.96623475710157601391},
                    WEIGHT[FL_STRIP_NODES] = {0.08566224618958517252, 0.18038078652406930378,
                                              0.23395696728634552369, 0.23395696728634552369,
                                              0.18038078652406930378, 0.08566224618958517252};

/* The part of a line, in [0, 1]. */
typedef struct {
    double lo, hi;
} span;

/* Keep of t what has a linear function >= 0, or < 0, from its values at the two ends. */
static int keep(span *t, double a0, double a1, int inside)
{
    const int in0 = (a0 >= 0.0) == inside, in1 = (a1 >= 0.0) == inside;
    if (in0 && in1) return 1;
    if (!in0 && !in1) return 0;
    const double at = a0 / (a0 - a1);
    if (in1) t->lo = at > t->lo ? at : t->lo;
    else t->hi = at < t->hi ? at : t->hi;
    return t->lo < t->hi;
}

/* Prisms, wedges and cones share planes.  All ask with the same number, so that nothing falls between two and
 * nothing counts twice; and r on the plane itself, g.r = 0, is taken as a hair aside, for all of them to the
 * same side. */
static double beyond(fl_vec3 g, fl_vec3 r)
{
    const double h = v3_dot(g, r);
    return h != 0.0 ? h : 1e-300 * v3_dot(g, v3(0.5772156649, 0.4342944819, 0.6931471806));
}

/* Points to the left of the edge a b of a face with normal n: the same numbers, turned round, for the face on
 * the other side. */
static fl_vec3 leftward(const fl_side *q, fl_vec3 n, int32_t a, int32_t b, fl_vec3 *from)
{
    *from = q->v[a < b ? a : b];
    return v3_cross(n, v3_sub(q->v[a < b ? b : a], *from));
}

/* How far x is to the left of it, times a length. */
static double left_of(const fl_side *q, fl_vec3 n, int32_t a, int32_t b, fl_vec3 x)
{
    fl_vec3 from;
    const fl_vec3 g = leftward(q, n, a, b, &from);
    const double h = beyond(g, v3_sub(x, from));
    return a < b ? h : -h;
}

/* Keep of the line from x0 to x1 what is left of the edge, or what is not. */
static int keep_left(span *t, const fl_side *q, fl_vec3 n, int32_t a, int32_t b, fl_vec3 x0, fl_vec3 x1,
                     int left)
{
    fl_vec3 from;
    const fl_vec3 g = leftward(q, n, a, b, &from);
    const double h0 = beyond(g, v3_sub(x0, from)), h1 = beyond(g, v3_sub(x1, from));
    return a < b ? keep(t, h0, h1, left) : keep(t, -h0, -h1, left);
}

/* How far x is beyond a towards b, times a length. */
static double along(fl_vec3 a, fl_vec3 b, fl_vec3 x) { return beyond(v3_sub(b, a), v3_sub(x, a)); }

static double root_of(double s) { return s > 0.0 ? sqrt(s) : 0.0; }

/* Over a plane: d is linear and its direction one, so that two places have force and torque of all nodes, and
 * the second moment of the pressure.  Node k of a piece over which s goes from p^2 to q^2 has the root r = p
 * + (q - p) z at t = lo + (hi - lo) z (r + p)/(q + p): in z the integrand s^(9/2) dt is a polynomial of
 * degree 10. */
static int piece_over_face(const fl_line *l, span t, double h0, double h1, fl_vec3 n)
{
    if (!keep(&t, l->R - h0, l->R - h1, 1)) return 0;
    const double p = root_of(l->R - h0 - t.lo * (h1 - h0)), q = root_of(l->R - h0 - t.hi * (h1 - h0));
    if (!(p + q > 0.0)) return 0;
    const double dt = t.hi - t.lo, k0 = l->factor * 2.0 * dt / (p + q);
    double u = 0.0, du = 0.0, ddu = 0.0, first = 0.0, second = 0.0;
    for (int k = 0; k < FL_STRIP_NODES; k++) {
        const double z = NODE[k], r = p + (q - p) * z, at = z * (r + p) / (p + q), s = r * r;
        const double c = k0 * WEIGHT[k] * s * s * s, pull = 4.5 * c * s;
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
        if (fl_places_add(l->w, (fl_place){.overlap = s,
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
    fl_vec3 q, u;                /* d = |q + t u| */
    double small;                /* distances below it have no direction */
    double from, over;           /* t of the first end; 1/(to - from), or 0 for a point */
    double sum, du, ddu, s, far; /* of u, of its derivatives, of du s, of du (t - from)/(to - from) */
    fl_vec3 f, ffar;
} bundle;

static void take(bundle *b, double t, double share)
{
    const fl_vec3 r = v3_madd(b->q, t, b->u);
    const double d = v3_norm(r), s = b->l->R - d;
    if (s <= 0.0 || d <= b->small) return;
    const double k = b->l->factor * share * sqrt(s) * s * s, du = 4.5 * k * s, way = (t - b->from) * b->over;
    const fl_vec3 f = v3_scale(du / d, r);
    b->sum += k * s * s;
    b->du += du;
    b->ddu += 15.75 * k;
    b->s += du * s;
    b->f = v3_add(b->f, f);
    b->far += way * du;
    b->ffar = v3_madd(b->ffar, way, f);
}

/* A piece t; zero_lo, zero_hi: s is 0 at that end. */
static void gauss(bundle *b, span t, int zero_lo, int zero_hi)
{
    const rule *g = zero_lo && zero_hi ? &BETWEEN_ZEROS : zero_lo || zero_hi ? &FROM_ZERO : &WHOLE;
    const double from = zero_hi && !zero_lo ? t.hi : t.lo,
                 dt = zero_hi && !zero_lo ? t.lo - t.hi : t.hi - t.lo;
    for (int k = 0; k < FL_STRIP_CURVED; k++) take(b, from + dt * g->node[k], fabs(dt) * g->weight[k]);
}

/* The same where an end that is not 0 may be nearly so: the quarter next to it is a piece of its own. */
static void gauss_over_point(bundle *b, span t, int zero_lo, int zero_hi)
{
    const double R = b->l->R, quarter = 0.25 * (t.hi - t.lo), s0 = R - v3_norm(v3_madd(b->q, t.lo, b->u)),
                 s1 = R - v3_norm(v3_madd(b->q, t.hi, b->u)),
                 sm = R - v3_norm(v3_madd(b->q, 0.5 * (t.lo + t.hi), b->u));
    const double most = s0 > s1 ? (s0 > sm ? s0 : sm) : s1 > sm ? s1 : sm;
    const int near_lo = !zero_lo && s0 < 0.3 * most, near_hi = !zero_hi && s1 < 0.3 * most;
    const span mid = {near_lo ? t.lo + quarter : t.lo, near_hi ? t.hi - quarter : t.hi};
    if (near_lo) gauss(b, (span){t.lo, mid.lo}, 0, 0);
    if (near_hi) gauss(b, (span){mid.hi, t.hi}, 0, 0);
    gauss(b, mid, zero_lo, zero_hi);
}

/* d^2 = uu ((t - m)^2 + a^2); half: s > 0 at |t - m| < half.  Where the overlap is large d is singular at
 * m +- i a, and pieces that grow threefold from m keep away. */
static void graded(bundle *b, span t, int zero_lo, int zero_hi, double m, double a, double uu)
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
            const span s = way ? (span){m + lo, m + hi} : (span){m - hi, m - lo};
            const int end = zero && hi == last;
            gauss_over_point(b, s, !way && end, way && end);
        }
    }
}

/* One place: the part `share` of the bundle with force f and scalar sum du, where it meets the point c. */
static int tie(const bundle *b, double share, double du, fl_vec3 f, fl_vec3 c)
{
    const double size = v3_norm(f), s = b->s / b->du;
    if (!(size > 0.0) || !(du > 0.0)) return 0;
    const fl_vec3 n = v3_scale(1.0 / size, f);
    return fl_places_add(b->l->w, (fl_place){.overlap = s,
                                             .u = share * b->sum,
                                             .du = du,
                                             .ddu = share * b->ddu,
                                             .n = v3_scale(b->l->own->side / du, f),
                                             .across = v3_scale(b->l->own->side, n),
                                             .p = v3_madd(c, b->l->R - 0.5 * s - b->l->own->r, n)});
}

static int piece_over_point(const fl_line *l, span t, fl_vec3 c, const fl_vec3 *e, double small)
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
    if (!(b.du > 0.0)) return 0;
    if (slope == 0.0) return tie(&b, 1.0, b.du, b.f, e ? v3_madd(c, tau, *e) : c);
    const double far = b.far / b.du;
    return tie(&b, 1.0 - far, b.du - b.far, v3_sub(b.f, b.ffar), v3_madd(c, tau + t.lo * slope, *e)) ||
                   tie(&b, far, b.far, b.ffar, v3_madd(c, tau + t.hi * slope, *e))
               ? -1
               : 0;
}

fl_line fl_strips_line(fl_places *w, const fl_side *own, int32_t e, double other, double R)
{
    const fl_poly *p = own->p;
    const fl_vec3 x0 = own->v[p->edge[e].a], u = v3_sub(own->v[p->edge[e].b], x0);
    const double sharp = p->bend[e] * FL_PLACE_SHARP_EDGE, length = v3_norm(u);
    const double rho = fl_place_rho(own->r, other);
    return (fl_line){.w = w,
                     .own = own,
                     .edge = e,
                     .x0 = x0,
                     .u = u,
                     .length = length,
                     .R = R,
                     .factor = (sharp < 1.0 ? sharp : 1.0) * FL_PLACE_ROUND * (256.0 / 315.0) *
                               sqrt(2.0 * rho) * length};
}

static fl_vec3 end_of(const fl_line *l) { return l->own->v[l->own->p->edge[l->edge].b]; }

int fl_strips_edge_face(const fl_line *l, const fl_side *other, int32_t f, double behind)
{
    const fl_poly *q = other->p;
    const int32_t *loop = q->loop + q->first[f], n = q->first[f + 1] - q->first[f];
    const fl_vec3 nf = other->n[f], o = other->v[loop[0]], x0 = l->x0, x1 = end_of(l);
    const double h0 = v3_dot(nf, v3_sub(x0, o)), h1 = v3_dot(nf, v3_sub(x1, o)), small = SAME * q->size;
    span t = {0.0, 1.0};
    if (!(l->factor > 0.0)) return 0;
    if ((h0 >= l->R && h1 >= l->R) || !keep(&t, h0 + behind + small, h1 + behind + small, 1)) return 0;
    for (int32_t c = 0, a = loop[n - 1]; c < n; a = loop[c++])
        if (!keep_left(&t, other, nf, a, loop[c], x0, x1, 1)) return 0;
    return piece_over_face(l, t, h0, h1, nf);
}

int fl_strips_edge_edge(const fl_line *l, const fl_side *other, int32_t k)
{
    const fl_poly *q = other->p;
    const fl_edge g = q->edge[k];
    const fl_vec3 a = other->v[g.a], b = other->v[g.b], x0 = l->x0, x1 = end_of(l);
    span t = {0.0, 1.0};
    if (!(l->factor > 0.0) || !(q->bend[k] > 0.0)) return 0;
    if (!keep(&t, along(a, b, x0), along(a, b, x1), 1)) return 0;
    if (!keep(&t, along(b, a, x0), along(b, a, x1), 1)) return 0;
    if (g.left >= 0 && !keep_left(&t, other, other->n[g.left], g.a, g.b, x0, x1, 0)) return 0;
    if (g.right >= 0 && !keep_left(&t, other, other->n[g.right], g.b, g.a, x0, x1, 0)) return 0;
    const fl_vec3 axis = v3_unit(v3_sub(b, a));
    return piece_over_point(l, t, a, &axis, SAME * q->size);
}

int fl_strips_edge_vertex(const fl_line *l, const fl_side *other, int32_t v)
{
    const fl_poly *q = other->p;
    const fl_vec3 c = other->v[v], x0 = l->x0, x1 = end_of(l);
    span t = {0.0, 1.0};
    if (!(l->factor > 0.0) || !(q->defect[v] > 0.0)) return 0;
    for (int32_t m = q->begin[v]; m < q->begin[v + 1]; m++) {
        const fl_vec3 b = other->v[q->beside[m]];
        if (!keep(&t, along(c, b, x0), along(c, b, x1), 0)) return 0;
    }
    return piece_over_point(l, t, c, NULL, SAME * q->size);
}

/* Vertex v at r from the nearest point of an edge or a vertex. */
static int vertex_over(fl_places *w, const fl_side *own, int32_t v, const fl_side *other, fl_vec3 r, double R)
{
    const double d = v3_norm(r);
    if (d >= R || d <= SAME * other->p->size) return 0;
    return fl_places_vertex(w, own, other->r, v, v3_scale(1.0 / d, r), R - d);
}

int fl_strips_vertex_face(fl_places *w, const fl_side *own, int32_t v, const fl_side *other, int32_t f,
                          double R)
{
    const fl_poly *q = other->p;
    const int32_t *loop = q->loop + q->first[f], n = q->first[f + 1] - q->first[f];
    const fl_vec3 x = own->v[v];
    const double h = v3_dot(other->n[f], v3_sub(x, other->v[loop[0]]));
    if (h >= R || h < -SAME * q->size) return 0;
    for (int32_t c = 0, a = loop[n - 1]; c < n; a = loop[c++])
        if (left_of(other, other->n[f], a, loop[c], x) < 0.0) return 0;
    return fl_places_vertex(w, own, other->r, v, other->n[f], R - h);
}

int fl_strips_vertex_edge(fl_places *w, const fl_side *own, int32_t v, const fl_side *other, int32_t k,
                          double R)
{
    const fl_edge g = other->p->edge[k];
    const fl_vec3 a = other->v[g.a], b = other->v[g.b], x = own->v[v];
    if (!(other->p->bend[k] > 0.0) || along(a, b, x) < 0.0 || along(b, a, x) < 0.0) return 0;
    if (g.left >= 0 && left_of(other, other->n[g.left], g.a, g.b, x) >= 0.0) return 0;
    if (g.right >= 0 && left_of(other, other->n[g.right], g.b, g.a, x) >= 0.0) return 0;
    const fl_vec3 e = v3_unit(v3_sub(b, a)), r = v3_sub(x, a);
    return vertex_over(w, own, v, other, v3_madd(r, -v3_dot(r, e), e), R);
}

int fl_strips_vertex_vertex(fl_places *w, const fl_side *own, int32_t v, const fl_side *other, int32_t c,
                            double R)
{
    const fl_poly *q = other->p;
    const fl_vec3 x = own->v[v];
    if (!(q->defect[c] > 0.0)) return 0;
    for (int32_t m = q->begin[c]; m < q->begin[c + 1]; m++)
        if (along(other->v[c], other->v[q->beside[m]], x) >= 0.0) return 0;
    return vertex_over(w, own, v, other, v3_sub(x, other->v[c]), R);
}

int fl_strips_plane(fl_places *w, const fl_side *own, int32_t e, double R)
{
    const fl_line l = fl_strips_line(w, own, e, 0.0, R);
    if (!(l.factor > 0.0)) return 0;
    return piece_over_face(&l, (span){0.0, 1.0}, l.x0.z, l.x0.z + l.u.z, v3(0, 0, 1));
}
