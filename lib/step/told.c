/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <string.h>
#include "base/wide.h"
#include "law/damping.h"
#include "step/pairing.h"
#include "step/told.h"

/* What is known of contacts beside what their surrogates tell.  World axes, but for what is said to be in the
 * frame of B. */
typedef struct {
    fl_tellers s;
    _Alignas(64) fl_lane qi[4], qj[4], R[9]; /* attitudes; axes of B, row by row                       */
    fl_lane off[3], u[3], wi[3], wj[3];      /* from A's centre to B's; v_A - v_B; spins               */
    fl_lane mass, touch, rest, damping, friction, tangential; /* of pair and law                       */
    fl_lane way[3], v[3], turn[3], chi; /* of the first place, and how it moves, frame of B             */
    fl_lane elastic, normal, direction[3], moment[3], spread, at[3], fd[3], md[3]; /* fl_bearing   */
    fl_lane scale;                                             /* what these are to be multiplied by      */
    fl_lane f[3], ti[3], tj[3], damp[3], di[3], dj[3];         /* as in fl_pair                           */
    fl_lane n[3], slip[3], aj[3], k, g, limit, arm, twist, dw; /* as friction sees them            */
} batch;

#define OF(member) (b->s.s + FL_SURROGATE_ROW(member))

static void put4(fl_lane *a, int k, fl_quat q)
{
    a[0].a[k] = q.w, a[1].a[k] = q.x, a[2].a[k] = q.y, a[3].a[k] = q.z;
}

static void lay(batch *b, const fl_world *w, fl_pair *const *p, int n)
{
    const fl_surrogate *s[FL_TOLD];
    for (int k = 0; k < FL_TOLD; k++) {
        const fl_pair *c = p[k < n ? k : 0];
        const fl_bodies *o = &w->b;
        const int32_t i = c->i, j = c->j;
        s[k] = c->surrogate;
        put4(b->qi, k, o->ball[i] ? q_one() : o->q[i]);
        put4(b->qj, k, o->ball[j] ? q_one() : o->q[j]);
        fl_lane3_put(b->off, k, fl_world_way(w, i, j, c->image));
        fl_lane3_put(b->u, k, v3_sub(o->v[i], o->v[j]));
        fl_lane3_put(b->wi, k, o->w[i]);
        fl_lane3_put(b->wj, k, o->w[j]);
        b->mass.a[k] = c->mass, b->touch.a[k] = c->touch;
        b->rest.a[k] = c->law->rest, b->damping.a[k] = c->law->chi;
        b->friction.a[k] = c->law->friction, b->tangential.a[k] = c->law->tangential;
    }
    fl_surrogate_lay(&b->s, s, FL_TOLD);
}

/* --- lane by lane ------------------------------------------------------------------------------- */

typedef struct {
    fl_vec3 x, y, z;
} rows;

/* q_matrix() */
FL_WIDE_PART rows axes(const fl_lane *q, int k)
{
    const double w = q[0].a[k], x = q[1].a[k], y = q[2].a[k], z = q[3].a[k];
    return (rows){v3(1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)),
                  v3(2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)),
                  v3(2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y))};
}

FL_WIDE_PART rows rows_of(const fl_lane *R, int k)
{
    return (rows){fl_lane3(R, k), fl_lane3(R + 3, k), fl_lane3(R + 6, k)};
}

FL_WIDE_PART fl_vec3 out(rows R, fl_vec3 a) { return v3(v3_dot(R.x, a), v3_dot(R.y, a), v3_dot(R.z, a)); }
FL_WIDE_PART fl_vec3 in(rows R, fl_vec3 a)
{
    return v3(R.x.x * a.x + R.y.x * a.y + R.z.x * a.z, R.x.y * a.x + R.y.y * a.y + R.z.y * a.z,
              R.x.z * a.x + R.y.z * a.y + R.z.z * a.z);
}

/* The velocity of A against B at aj from B's centre. */
FL_WIDE_PART fl_vec3 approach(const batch *b, int k, fl_vec3 aj)
{
    const fl_vec3 ai = v3_add(aj, fl_lane3(b->off, k));
    return v3_add(fl_lane3(b->u, k),
                  v3_sub(v3_cross(fl_lane3(b->wi, k), ai), v3_cross(fl_lane3(b->wj, k), aj)));
}

/* How A stands to B. */
FL_WIDE_VERSIONS static void relate(batch *restrict b)
{
#pragma omp simd
    for (int k = 0; k < FL_TOLD; k++) {
        const rows A = axes(b->qi, k), B = axes(b->qj, k);
        const fl_vec3 x = v3(A.x.x, A.y.x, A.z.x), y = v3(A.x.y, A.y.y, A.z.y), z = v3(A.x.z, A.y.z, A.z.z);
        const fl_vec3 Mx = in(B, x), My = in(B, y), Mz = in(B, z); /* columns of M */
        fl_lane3_put(b->R, k, B.x);
        fl_lane3_put(b->R + 3, k, B.y);
        fl_lane3_put(b->R + 6, k, B.z);
        fl_lane3_put(b->s.o, k, v3_neg(in(B, fl_lane3(b->off, k))));
        fl_lane3_put(b->s.M, k, v3(Mx.x, My.x, Mz.x));
        fl_lane3_put(b->s.M + 3, k, v3(Mx.y, My.y, Mz.y));
        fl_lane3_put(b->s.M + 6, k, v3(Mx.z, My.z, Mz.z));
    }
}

/* The mass that meets, where that hangs on the force. */
static void weigh(batch *b, const fl_world *w, fl_pair *const *p, int n)
{
    for (int k = 0; k < FL_TOLD; k++) {
        const fl_pair *c = p[k < n ? k : 0];
        if (fl_pair_is_plain(w, c)) continue;
        const rows R = rows_of(b->R, k);
        const fl_vec3 at = out(R, fl_lane3(b->s.at, k)), f = out(R, fl_lane3(b->s.f, k)),
                      m = out(R, fl_lane3(b->s.m, k));
        const fl_vec3 ti = v3_add(v3_cross(v3_add(at, fl_lane3(b->off, k)), f), m),
                      tj = v3_add(v3_cross(at, f), m);
        b->mass.a[k] = fl_pair_mass(w, c, f, ti, tj);
    }
}

/* How the first place has moved, and moves; the damping if it does not approach faster than ever. */
FL_WIDE_VERSIONS static void move(batch *restrict b)
{
#pragma omp simd
    for (int k = 0; k < FL_TOLD; k++) {
        const rows R = rows_of(b->R, k);
        const fl_vec3 first = fl_lane3(OF(first), k), arm = v3_sub(first, fl_lane3(OF(at), k));
        fl_lane3_put(b->way, k, v3_add(fl_lane3(b->s.q, k), v3_cross(fl_lane3(b->s.w, k), arm)));
        fl_lane3_put(b->v, k, in(R, approach(b, k, out(R, first))));
        fl_lane3_put(b->turn, k, in(R, v3_sub(fl_lane3(b->wi, k), fl_lane3(b->wj, k))));
        b->chi.a[k] =
            fl_damping_chi(b->damping.a[k], b->rest.a[k], b->touch.a[k], b->s.energy.a[k], b->mass.a[k]);
    }
}

/* The force of W and what damping adds to it; and what friction sees. */
FL_WIDE_VERSIONS static void bear(batch *restrict b)
{
#pragma omp simd
    for (int k = 0; k < FL_TOLD; k++) {
        const rows R = rows_of(b->R, k);
        const fl_vec3 first = fl_lane3(OF(first), k), point = fl_lane3(b->s.at, k), f = fl_lane3(b->s.f, k),
                      m = fl_lane3(b->s.m, k), off = fl_lane3(b->off, k);
        const double elastic = b->elastic.a[k], normal = b->normal.a[k], each = 1.0 / elastic;
        const double scale = b->s.share.a[k] * OF(pressure)->a[k] * each;
        fl_vec3 direction = fl_lane3(b->direction, k), moment = fl_lane3(b->moment, k);
        fl_vec3 fd = fl_lane3(b->fd, k), md = fl_lane3(b->md, k);
        /* damping must not leave what the force is off from the pressures by */
        const fl_vec3 beside = v3_madd(f, -b->s.share.a[k], fl_lane3(OF(beside), k));
        const fl_vec3 rest = v3_sub(v3_scale(1.0 / scale, beside), v3_sub(direction, fd));
        const fl_vec3 less = v3_madd(fd, normal * each - 1.0, rest);
        fd = v3(normal < elastic ? less.x : fd.x, normal < elastic ? less.y : fd.y,
                normal < elastic ? less.z : fd.z);
        /* the pressures move to where force and moment want them */
        const fl_vec3 told = v3_add(m, v3_cross(v3_sub(point, first), f));
        const fl_vec3 by =
            v3_add(v3_madd(fl_surrogate_centre(f, told), -each, fl_lane3(b->at, k)), fl_lane3(OF(off), k));
        const double spread = b->spread.a[k] + 2.0 * v3_dot(by, moment) + normal * v3_norm2(by);
        moment = v3_madd(moment, normal, by);
        md = v3_add(md, v3_cross(by, fd));
        /* in the world */
        const fl_vec3 at = out(R, point), aj = out(R, first), F = out(R, f), FM = out(R, m);
        const fl_vec3 D = v3_scale(scale, out(R, fd)), DM = v3_scale(scale, out(R, md));
        const fl_vec3 di = v3_add(v3_cross(v3_add(aj, off), D), DM), dj = v3_neg(v3_add(v3_cross(aj, D), DM));
        fl_lane3_put(b->damp, k, D);
        fl_lane3_put(b->di, k, di);
        fl_lane3_put(b->dj, k, dj);
        fl_lane3_put(b->f, k, v3_add(F, D));
        fl_lane3_put(b->ti, k, v3_add(v3_add(v3_cross(v3_add(at, off), F), FM), di));
        fl_lane3_put(b->tj, k, v3_sub(dj, v3_add(v3_cross(at, F), FM)));
        /* friction */
        const double whole = 1.0 / normal, size = v3_norm(direction);
        const fl_vec3 n = out(R, v3_scale(size > 0.0 ? 1.0 / size : 0.0, direction));
        const fl_vec3 mean = v3_scale(whole, moment), centred = v3_add(aj, out(R, mean));
        const double arm2 = whole * spread - v3_norm2(mean);
        const double wi = v3_dot(fl_lane3(b->wi, k), n), wj = v3_dot(fl_lane3(b->wj, k), n);
        b->scale.a[k] = scale;
        fl_lane3_put(b->n, k, n);
        fl_lane3_put(b->aj, k, centred);
        fl_lane3_put(b->slip, k, approach(b, k, centred));
        b->k.a[k] = b->tangential.a[k] * b->s.slope.a[k];
        b->g.a[k] = b->tangential.a[k] * b->chi.a[k] * (scale * elastic);
        b->limit.a[k] = b->friction.a[k] * (scale * size);
        b->arm.a[k] = arm2 > 0.0 ? sqrt(arm2) : 0.0;
        b->dw.a[k] = wi - wj;
        b->twist.a[k] = 0.5 * (wi + wj);
    }
}

/* --- contact by contact ------------------------------------------------------------------------- */

static void take(batch *b, int k, const fl_bearing *q, fl_vec3 at)
{
    b->elastic.a[k] = q->elastic, b->normal.a[k] = q->normal, b->spread.a[k] = q->spread;
    fl_lane3_put(b->direction, k, q->direction);
    fl_lane3_put(b->moment, k, q->moment);
    fl_lane3_put(b->at, k, at);
    fl_lane3_put(b->fd, k, q->damping.f);
    fl_lane3_put(b->md, k, q->damping.m);
}

/* How the places press; 0 where nothing does any longer.  It does not often approach faster than ever. */
static int recall(batch *b, int k, fl_pair *p)
{
    const fl_vec3 way = fl_lane3(b->way, k), turned = fl_lane3(b->s.w, k), v = fl_lane3(b->v, k),
                  turn = fl_lane3(b->turn, k);
    fl_bearing q;
    fl_vec3 at;
    fl_bearing_recall(&p->surrogate->pads, way, turned, v, turn, b->chi.a[k], &q, &at);
    if (!(q.elastic > 0.0)) return 0;
    if (q.met > p->touch * q.pressed) {
        p->touch = q.met / q.pressed;
        b->chi.a[k] = fl_damping_chi(p->law->chi, p->law->rest, p->touch, b->s.energy.a[k], b->mass.a[k]);
        fl_bearing_recall(&p->surrogate->pads, way, turned, v, turn, b->chi.a[k], &q, &at);
    }
    take(b, k, &q, at);
    return 1;
}

/* Friction at the centre of the pressure. */
static void rub(const batch *b, int k, fl_pair *p, double dt)
{
    if (!(b->friction.a[k] > 0.0 && b->tangential.a[k] > 0.0 && b->normal.a[k] > 0.0)) {
        p->slip = (fl_slip){0};
        return;
    }
    const fl_rubbing c = {fl_lane3(b->n, k), b->k.a[k], b->g.a[k], b->limit.a[k], b->arm.a[k]};
    const fl_vec3 aj = fl_lane3(b->aj, k), ai = v3_add(aj, fl_lane3(b->off, k));
    double moment;
    p->fs = fl_tangent_force(&p->slip, &c, fl_lane3(b->slip, k), b->dw.a[k], b->twist.a[k], dt, &moment);
    p->si = v3_madd(v3_cross(ai, p->fs), moment, c.n);
    p->sj = v3_neg(v3_madd(v3_cross(aj, p->fs), moment, c.n));
    p->f = v3_add(p->f, p->fs);
    p->ti = v3_add(p->ti, p->si);
    p->tj = v3_add(p->tj, p->sj);
    p->spring = fl_tangent_energy(&p->slip);
}

static void give(const batch *b, int k, fl_pair *p, double dt, int survey)
{
    const fl_surrogate *s = p->surrogate;
    const double slope = b->s.slope.a[k];
    p->f = fl_lane3(b->f, k), p->ti = fl_lane3(b->ti, k), p->tj = fl_lane3(b->tj, k);
    p->fd = fl_lane3(b->damp, k), p->di = fl_lane3(b->di, k), p->dj = fl_lane3(b->dj, k);
    p->fs = p->si = p->sj = v3(0, 0, 0);
    p->spring = 0.0;
    p->overlap = s->overlap * b->s.z.a[k];
    p->stiff_i = survey ? slope * s->stiff_i : 0.0;
    p->stiff_j = survey ? slope * s->stiff_j : 0.0;
    rub(b, k, p, dt);
    p->energy = b->s.energy.a[k] + p->spring;
}

void fl_told_touch(const fl_world *w, fl_pair *const *p, int n, double dt, int survey, uint8_t *done,
                   fl_told *t)
{
    batch b;
    int any = 0;
    lay(&b, w, p, n);
    relate(&b);
    fl_surrogate_tell(&b.s);
    weigh(&b, w, p, n);
    move(&b);
    for (int k = 0; k < FL_TOLD; k++) {
        fl_pair *const c = p[k < n ? k : 0];
        const int holds = k < n && fl_surrogate_within(c->surrogate, b.s.way.a[k], b.s.z.a[k], 1.0) &&
                          b.s.share.a[k] > 0.0 && recall(&b, k, c);
        if (k < n) done[k] = (uint8_t)holds;
        any |= holds;
        if (!holds) take(&b, k, &(fl_bearing){.elastic = 1.0, .normal = 1.0}, v3(0, 0, 0));
    }
    if (any) bear(&b);
    for (int k = 0; k < n; k++) {
        if (done[k]) done[k] = b.scale.a[k] > 0.0;
        if (done[k]) give(&b, k, p[k], dt, survey);
        else t[k] = fl_surrogate_told(&b.s, k);
    }
}
