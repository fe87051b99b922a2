/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include "bond/bond.h"

/* Cosines between which the pressing part of a crack wears off as it turns: 60 and 90 degrees. */
#define TURNED 0.5

static const double LOBATTO[3] = {1.0 / 6.0, 4.0 / 6.0, 1.0 / 6.0};

double fl_bond_point_at(int k, double *along_a, double *along_b)
{
    *along_a = k % 3 - 1;
    *along_b = k / 3 - 1;
    return LOBATTO[k % 3] * LOBATTO[k / 3];
}

double fl_bond_limit(double modulus, double energy, double strength)
{
    return 2.0 * modulus * energy / (strength * strength);
}

double fl_bond_energy(const fl_bond *c)
{
    const double peak = 0.5 * c->tension * c->tension / c->kn;
    return fmax(fmax(c->energy[0], peak), c->stretch * peak);
}

void fl_bond_place(fl_bond *c, const fl_bodies *b, fl_vec3 way, fl_vec3 x, fl_vec3 n, fl_vec3 a, fl_vec3 h)
{
    const fl_mat3 Ri = fl_body_axes(b, c->i), Rj = fl_body_axes(b, c->j);
    c->pi = m3_tmul(Ri, v3_sub(x, b->x[c->i]));
    c->pj = m3_tmul(Rj, v3_sub(v3_sub(x, way), b->x[c->j]));
    c->ni = m3_tmul(Ri, n), c->nj = m3_tmul(Rj, n);
    c->ai = m3_tmul(Ri, a), c->aj = m3_tmul(Rj, a);
    c->bi = m3_tmul(Ri, h), c->bj = m3_tmul(Rj, h);
}

/* How the two sides of the face stand to one another.  Vectors with two elements are of i and j, world axes;
 * s, su and sv are the separation of the centre and its change along half of either side, along m, ta, tb. */
typedef struct {
    fl_vec3 r[2], u[2], v[2], n[2];
    fl_vec3 centre, m, ta, tb; /* of the separation in world axes; the frame */
    double s[3], su[3], sv[3];
    double length, cosine; /* |n_i + n_j|, n_i.n_j */
} standing;

static void along(const standing *q, fl_vec3 x, double out[3])
{
    out[0] = v3_dot(q->m, x);
    out[1] = v3_dot(q->ta, x);
    out[2] = v3_dot(q->tb, x);
}

static fl_vec3 world(const standing *q, const double x[3])
{
    return v3_madd(v3_madd(v3_scale(x[0], q->m), x[1], q->ta), x[2], q->tb);
}

/* 0 where the sides have turned away from each other, and there is no frame. */
static int stand(const fl_bond *c, const fl_bodies *b, fl_vec3 way, standing *q)
{
    const fl_mat3 R[2] = {fl_body_axes(b, c->i), fl_body_axes(b, c->j)};
    const fl_vec3 p[2] = {c->pi, c->pj}, u[2] = {c->ai, c->aj}, v[2] = {c->bi, c->bj}, n[2] = {c->ni, c->nj};
    for (int k = 0; k < 2; k++) {
        q->r[k] = m3_mul(R[k], p[k]);
        q->u[k] = m3_mul(R[k], u[k]);
        q->v[k] = m3_mul(R[k], v[k]);
        q->n[k] = m3_mul(R[k], n[k]);
    }
    q->cosine = v3_dot(q->n[0], q->n[1]);
    if (!(q->cosine > 0.0)) return 0;
    const fl_vec3 sum = v3_add(q->n[0], q->n[1]), side = v3_add(q->u[0], q->u[1]);
    q->length = v3_norm(sum);
    q->m = v3_scale(1.0 / q->length, sum);
    const fl_vec3 flat = v3_madd(side, -v3_dot(side, q->m), q->m);
    /* sides that are turned by half a turn about m cancel */
    q->ta = v3_norm2(flat) > 1e-12 * v3_norm2(q->u[0]) ? v3_unit(flat) : v3_normal_to(q->m);
    q->tb = v3_cross(q->m, q->ta);
    q->centre = v3_add(v3_add(v3_sub(b->x[c->j], b->x[c->i]), way), v3_sub(q->r[1], q->r[0]));
    along(q, q->centre, q->s);
    along(q, v3_sub(q->u[1], q->u[0]), q->su);
    along(q, v3_sub(q->v[1], q->v[0]), q->sv);
    return 1;
}

static void separation(const standing *q, double xi, double eta, double s[3])
{
    for (int e = 0; e < 3; e++) s[e] = q->s[e] + xi * q->su[e] + eta * q->sv[e];
}

static double positive(double x) { return x > 0.0 ? x : 0.0; }

/* --- how a point breaks ------------------------------------------------------------------------ */

/* Begin the damage of a point whose stress has reached the strength: lambda at that, by the way on which all
 * of it grows alike, and the end. */
static void begin(const fl_bond *c, fl_bond_point *p, double lambda2, double shear2, double over)
{
    const double share = shear2 / lambda2;
    double mixed = 1.0;
    for (int32_t k = 0; k < c->mixing; k++) mixed *= share;
    const double G = c->energy[0] + (c->energy[1] - c->energy[0]) * mixed;
    p->first = sqrt(lambda2 / over);
    p->last = fmax(2.0 * G / p->first, c->stretch * p->first);
    if (p->last <= p->first) p->last = p->first;
}

/* Damage by the separation s. */
static double damage(const fl_bond *c, fl_bond_point *p, const double s[3])
{
    const double open = positive(s[0]), pressed = positive(-s[0]), shear2 = s[1] * s[1] + s[2] * s[2];
    const double lambda2 = c->kn * open * open + c->ks * shear2;
    if (p->d == 1.0 || !(lambda2 > 0.0)) return p->d;
    if (p->first == 0.0) {
        const double sigma = c->kn * open / c->tension, tau2 = c->ks * c->ks * shear2,
                     limit = c->cohesion + c->friction * c->kn * pressed;
        const double over = sigma * sigma + tau2 / (limit * limit);
        if (!(over >= 1.0)) return 0.0;
        begin(c, p, lambda2, c->ks * shear2, over);
    }
    if (p->last == p->first) return 1.0;
    const double lambda = sqrt(lambda2);
    if (lambda <= p->first) return p->d;
    const double d = p->last * (lambda - p->first) / (lambda * (p->last - p->first));
    return d >= 1.0 ? 1.0 : d > p->d ? d : p->d;
}

/* Slip so that friction bears what is there: e[2], what its springs are drawn by. */
static void rub(const fl_bond *c, fl_bond_point *p, const double s[3], double kn, double e[2])
{
    const double limit = c->friction * kn * positive(-s[0]);
    double e0 = s[1] - p->slip[0], e1 = s[2] - p->slip[1];
    const double size = c->ks * sqrt(e0 * e0 + e1 * e1);
    if (size > limit) {
        const double back = limit / size;
        e0 *= back, e1 *= back;
        p->slip[0] = s[1] - e0, p->slip[1] = s[2] - e1;
    }
    e[0] = e0, e[1] = e1;
}

/* How much of the two sides still faces the other. */
static double facing(const fl_bond *c, const standing *q)
{
    const double a = positive(1.0 - fabs(q->s[1]) / (2.0 * v3_norm(c->ai))),
                 b = positive(1.0 - fabs(q->s[2]) / (2.0 * v3_norm(c->bi)));
    return a * b * (q->cosine < TURNED ? q->cosine / TURNED : 1.0);
}

/* How much of the pressing part is gone. */
static double wear(const fl_bond *c, const standing *q)
{
    double now = 0.0;
    if (c->state == FL_BOND_BROKEN) now = c->held > 0.0 ? 1.0 - facing(c, q) / c->held : 1.0;
    else if (q->cosine < TURNED) now = 1.0 - q->cosine / TURNED;
    return now > c->worn ? now : c->worn;
}

/* --- all of it --------------------------------------------------------------------------------- */

/* Sums over the points of a traction, of it times either coordinate. */
typedef struct {
    double f[3], fu[3], fv[3];
} traction;

static void add(traction *t, double xi, double eta, double x, double y, double z)
{
    t->f[0] += x, t->f[1] += y, t->f[2] += z;
    t->fu[0] += xi * x, t->fu[1] += xi * y, t->fu[2] += xi * z;
    t->fv[0] += eta * x, t->fv[1] += eta * y, t->fv[2] += eta * z;
}

/* Tractions that act on i at the points of i and on j at those of j. */
static void apart(const standing *q, const traction *t, fl_vec3 *f, fl_vec3 *ti, fl_vec3 *tj)
{
    const fl_vec3 F = world(q, t->f), U = world(q, t->fu), V = world(q, t->fv);
    *f = F;
    *ti = v3_add(v3_cross(q->r[0], F), v3_add(v3_cross(q->u[0], U), v3_cross(q->v[0], V)));
    *tj = v3_neg(v3_add(v3_cross(q->r[1], F), v3_add(v3_cross(q->u[1], U), v3_cross(q->v[1], V))));
}

/* Tractions that act in the middle between the two; half: sum over points of s x traction, over 2. */
static void between(const standing *q, const traction *t, const double half[3], fl_vec3 *f, fl_vec3 *ti,
                    fl_vec3 *tj)
{
    const fl_vec3 h = world(q, half);
    apart(q, t, f, ti, tj);
    *ti = v3_add(*ti, h);
    *tj = v3_add(*tj, h);
}

static void add_moment(double half[3], const double s[3], double x, double y, double z)
{
    half[0] += 0.5 * (s[1] * z - s[2] * y);
    half[1] += 0.5 * (s[2] * x - s[0] * z);
    half[2] += 0.5 * (s[0] * y - s[1] * x);
}

/* Velocity of j against i in the middle of the points: at the centre, and its change along half sides. */
static void rates(const fl_bond *c, const fl_bodies *b, const standing *q, double r[3], double ru[3],
                  double rv[3])
{
    const fl_vec3 wi = b->w[c->i], wj = b->w[c->j], half = v3_scale(0.5, q->centre),
                  su = v3_scale(0.5, v3_sub(q->u[1], q->u[0])), sv = v3_scale(0.5, v3_sub(q->v[1], q->v[0]));
    along(q,
          v3_sub(fl_body_velocity(b, c->j, v3_sub(q->r[1], half)),
                 fl_body_velocity(b, c->i, v3_add(q->r[0], half))),
          r);
    along(q, v3_sub(v3_cross(wj, v3_sub(q->u[1], su)), v3_cross(wi, v3_add(q->u[0], su))), ru);
    along(q, v3_sub(v3_cross(wj, v3_sub(q->v[1], sv)), v3_cross(wi, v3_add(q->v[0], sv))), rv);
}

static void dash(fl_bond *c, const fl_bodies *b, const standing *q)
{
    traction t = {0};
    double r[3], ru[3], rv[3], half[3] = {0};
    rates(c, b, q, r, ru, rv);
    for (int k = 0; k < FL_BOND_POINTS; k++) {
        double xi, eta, x[3], s[3];
        const fl_bond_point *p = &c->point[k];
        const double scale = fl_bond_point_at(k, &xi, &eta) * c->area * c->damping * (1.0 - p->d);
        for (int e = 0; e < 3; e++) x[e] = scale * (e ? c->ks : c->kn) * (r[e] + xi * ru[e] + eta * rv[e]);
        add(&t, xi, eta, x[0], x[1], x[2]);
        separation(q, xi, eta, s);
        add_moment(half, s, x[0], x[1], x[2]);
    }
    between(q, &t, half, &c->fd, &c->di, &c->dj);
}

static void calm(fl_bond *c)
{
    c->f = c->ti = c->tj = c->fd = c->di = c->dj = c->fs = c->si = c->sj = v3(0, 0, 0);
    c->store = c->spring = 0.0;
}

void fl_bond_end(fl_bond *c)
{
    c->spent += c->store;
    calm(c);
    c->state = FL_BOND_ENDED;
}

/* What is kept of a look. */
static void keep(fl_bond *c, const standing *q)
{
    for (int e = 0; e < 3; e++) c->s[e] = q->s[e], c->su[e] = q->su[e], c->sv[e] = q->sv[e];
}

void fl_bond_look(fl_bond *c, const fl_bodies *b, fl_vec3 way)
{
    standing q;
    if (c->state != FL_BOND_ENDED && stand(c, b, way, &q)) keep(c, &q);
}

/* What the points come to. */
typedef struct {
    traction elastic, friction;
    double turn[2], half[3]; /* for the turn of m; the moment of friction */
    int hurt, failed, open;  /* points */
} result;

/* Whether no point of a whole face can have reached its strength: the largest opening and shear that any may
 * have, and no help of pressure. */
static int holds(const fl_bond *c, const standing *q)
{
    const double open = positive(q->s[0] + fabs(q->su[0]) + fabs(q->sv[0])),
                 x = fabs(q->s[1]) + fabs(q->su[1]) + fabs(q->sv[1]),
                 y = fabs(q->s[2]) + fabs(q->su[2]) + fabs(q->sv[2]);
    const double sigma = c->kn * open, tau2 = c->ks * c->ks * (x * x + y * y), T = c->tension * c->tension,
                 C = c->cohesion * c->cohesion;
    return sigma * sigma / T + tau2 / C < 1.0 - 1e-9;
}

/* The sums over the points of a whole face: the weights have sum 1, and 1/3 with the square of a
 * coordinate. */
static void whole(fl_bond *c, const standing *q, result *out)
{
    double square[3];
    for (int e = 0; e < 3; e++) {
        const double k = c->area * (e ? c->ks : c->kn);
        out->elastic.f[e] = k * q->s[e];
        out->elastic.fu[e] = k / 3.0 * q->su[e];
        out->elastic.fv[e] = k / 3.0 * q->sv[e];
        square[e] = q->s[e] * q->s[e] + (q->su[e] * q->su[e] + q->sv[e] * q->sv[e]) / 3.0;
    }
    for (int e = 0; e < 2; e++)
        out->turn[e] = c->area * (c->kn - c->ks) *
                       (q->s[0] * q->s[e + 1] + (q->su[0] * q->su[e + 1] + q->sv[0] * q->sv[e + 1]) / 3.0);
    c->store = 0.5 * c->area * (c->kn * square[0] + c->ks * (square[1] + square[2]));
}

/* Point k: what a look does to it, and what it gives.  more: what has worn off since the last. */
static void look_at(fl_bond *c, const standing *q, int k, double more, result *out)
{
    fl_bond_point *p = &c->point[k];
    double xi, eta, s[3], before[3];
    const double wa = fl_bond_point_at(k, &xi, &eta) * c->area, pressing = c->kn * (1.0 - c->worn);
    separation(q, xi, eta, s);
    for (int e = 0; e < 3; e++) before[e] = c->s[e] + xi * c->su[e] + eta * c->sv[e];
    const double d = damage(c, p, s), grown = d - p->d, shear2 = s[1] * before[1] + s[2] * before[2];
    if (grown > 0.0)
        c->spent += 0.5 * wa * grown * (c->kn * positive(s[0]) * positive(before[0]) + c->ks * shear2);
    if (more > 0.0) c->spent += 0.5 * wa * more * c->kn * positive(-s[0]) * positive(-before[0]);
    p->d = d;
    const double kn = s[0] > 0.0 ? (1.0 - d) * c->kn : pressing, ks = (1.0 - d) * c->ks;
    add(&out->elastic, xi, eta, wa * kn * s[0], wa * ks * s[1], wa * ks * s[2]);
    c->store += 0.5 * wa * (kn * s[0] * s[0] + ks * (s[1] * s[1] + s[2] * s[2]));
    out->turn[0] += wa * (kn - ks) * s[0] * s[1];
    out->turn[1] += wa * (kn - ks) * s[0] * s[2];
    out->hurt += d > 0.0;
    out->failed += d == 1.0;
    out->open += s[0] >= 0.0;
    if (d == 0.0) return;
    double e[2];
    rub(c, p, s, pressing, e);
    const double k_rub = wa * d * c->ks, held = 0.5 * wa * c->ks * (e[0] * e[0] + e[1] * e[1]);
    add(&out->friction, xi, eta, 0.0, k_rub * e[0], k_rub * e[1]);
    add_moment(out->half, s, 0.0, k_rub * e[0], k_rub * e[1]);
    c->spring += d * held;
    c->handed += grown * held;
    c->spent -= grown * held;
}

int fl_bond_force(fl_bond *c, const fl_bodies *b, fl_vec3 way)
{
    standing q;
    result r = {0};
    if (c->state == FL_BOND_ENDED) return 0;
    if (!stand(c, b, way, &q)) {
        fl_bond_end(c);
        return 1;
    }
    const double worn = wear(c, &q), more = worn - c->worn;
    c->worn = worn;
    calm(c);
    if (c->state == FL_BOND_WHOLE && worn == 0.0 && holds(c, &q)) whole(c, &q, &r);
    else
        for (int k = 0; k < FL_BOND_POINTS; k++) look_at(c, &q, k, more, &r);
    keep(c, &q);
    if (c->state != FL_BOND_BROKEN && r.failed == FL_BOND_POINTS) c->held = facing(c, &q);
    if (c->state != FL_BOND_BROKEN)
        c->state = r.failed == FL_BOND_POINTS ? FL_BOND_BROKEN : r.hurt ? FL_BOND_HURT : FL_BOND_WHOLE;
    if (c->state == FL_BOND_BROKEN && (r.open == FL_BOND_POINTS || c->worn >= 1.0)) {
        fl_bond_end(c);
        return 1;
    }
    const double tilt[3] = {0.0, r.turn[0] / q.length, r.turn[1] / q.length};
    const fl_vec3 across = world(&q, tilt);
    apart(&q, &r.elastic, &c->f, &c->ti, &c->tj);
    c->ti = v3_sub(c->ti, v3_cross(q.n[0], across));
    c->tj = v3_sub(c->tj, v3_cross(q.n[1], across));
    if (r.hurt) between(&q, &r.friction, r.half, &c->fs, &c->si, &c->sj);
    if (c->damping > 0.0) dash(c, b, &q);
    if (!r.hurt && !(c->damping > 0.0)) return 0;
    c->f = v3_add(c->f, v3_add(c->fs, c->fd));
    c->ti = v3_add(c->ti, v3_add(c->si, c->di));
    c->tj = v3_add(c->tj, v3_add(c->sj, c->dj));
    return 0;
}

fl_bond_load fl_bond_loaded(const fl_bond *c, const fl_bodies *b, fl_vec3 way)
{
    const fl_mat3 Ri = fl_body_axes(b, c->i), Rj = fl_body_axes(b, c->j);
    const fl_vec3 ri = m3_mul(Ri, c->pi), rj = m3_mul(Rj, c->pj),
                  n = v3_add(m3_mul(Ri, c->ni), m3_mul(Rj, c->nj));
    const fl_vec3 off = v3_sub(v3_add(v3_add(b->x[c->j], way), rj), v3_add(b->x[c->i], ri)),
                  arm = v3_madd(ri, 0.5, off);
    fl_bond_load out = {.x = v3_add(b->x[c->i], arm)};
    if (c->state == FL_BOND_ENDED || !(v3_norm2(n) > 0.0)) return out;
    const fl_vec3 m = v3_unit(n);
    out.tension = v3_dot(c->f, m);
    out.shear = v3_norm(v3_madd(c->f, -out.tension, m));
    out.moment = v3_norm(v3_sub(c->ti, v3_cross(arm, c->f)));
    return out;
}

double fl_bond_worst(const fl_bond *c)
{
    double most = 0.0;
    for (int k = 0; k < FL_BOND_POINTS; k++) most = fmax(most, c->point[k].d);
    return most;
}

double fl_bond_mean(const fl_bond *c)
{
    double sum = 0.0, xi, eta;
    for (int k = 0; k < FL_BOND_POINTS; k++) sum += fl_bond_point_at(k, &xi, &eta) * c->point[k].d;
    return sum;
}
