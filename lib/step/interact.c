/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/mem.h"
#include "law/damping.h"
#include "law/manual.h"
#include "law/material.h"
#include "law/normal.h"
#include "step/bearing.h"
#include "step/frozen.h"
#include "step/interact.h"
#include "step/lead.h"
#include "contact/pair_law.h"
#include "contact/pair_response.h"
#include "contact/pair_store.h"
#include "step/press.h"
#include "step/rolls.h"
#include "step/stance.h"
#include "step/stiff.h"
#include "step/told.h"

/* Overlaps below that much of the coordinates they come from are rounding, and have no stiffness. */
#define ROUNDING 3e-14

#define INLINE static inline __attribute__((always_inline)) /* vectors by value go through memory */

/* Whether looks at contacts that are told ask in this step how stiff they are: one step in four, in no rhythm
 * that looks might have. */
static int asks(const fl_world *w) { return (uint32_t)w->step * UINT32_C(2654435761) >> 30 == 0; }

INLINE void add_wrench(fl_vec3 *f, fl_vec3 *ti, fl_vec3 *tj, fl_vec3 force, fl_vec3 ai, fl_vec3 aj)
{
    *f = v3_add(*f, force);
    *ti = v3_add(*ti, v3_cross(ai, force));
    *tj = v3_sub(*tj, v3_cross(aj, force));
}

/* A force and its moment about a point, in the frame of B and times scale; the point is ai from A's centre
 * and aj from B's, in world axes. */
INLINE void add_sum(fl_vec3 *f, fl_vec3 *ti, fl_vec3 *tj, const fl_wrench *w, double scale, const fl_mat3 *R,
                    fl_vec3 ai, fl_vec3 aj)
{
    const fl_vec3 moment = v3_scale(scale, m3_mul(*R, w->m));
    add_wrench(f, ti, tj, v3_scale(scale, m3_mul(*R, w->f)), ai, aj);
    *ti = v3_add(*ti, moment);
    *tj = v3_sub(*tj, moment);
}

INLINE fl_vec3 approach(const fl_bodies *b, const fl_pair *p, fl_vec3 ai, fl_vec3 aj)
{
    return v3_sub(fl_body_velocity(b, p->i, ai), fl_body_velocity(b, p->j, aj));
}

/* How A moves: in the mean of the step that is approach() and fl_pair_lag(); at its end by a lead more. */
typedef struct {
    fl_lead_step of;
    fl_vec3 lag; /* [m/s] */
    fl_lead by;
    fl_before was;
} ahead;

static ahead ahead_of(const fl_world *w, const fl_pair *p, const fl_stance *r, double dt)
{
    const fl_vec3 lag = fl_pair_lag(&w->b, p, r->off, dt);
    return (ahead){fl_lead_span(w, dt), lag, fl_lead_of(w, p, lag), fl_before_of(p)};
}

/* By how much faster A approaches at the end than at c, as foreseen; the rest as in fl_lead_closing(). */
static double nearer(const ahead *a, double c, double elastic, double C, double yields)
{
    return fl_lead_closing(c, elastic, C, yields, a->by.pressed, a->of, a->was) - c;
}

INLINE fl_vec3 went(const fl_bodies *b, const fl_pair *p, const ahead *a, fl_vec3 ai, fl_vec3 aj)
{
    return v3_add(approach(b, p, ai, aj), a->lag);
}

INLINE fl_vec3 next(const fl_bodies *b, const fl_pair *p, const ahead *a, fl_vec3 ai, fl_vec3 aj)
{
    return v3_add(went(b, p, a, ai, aj), fl_lead_at(&a->by, ai, aj));
}

/* The pressure of a contact, summed up: what friction needs. */
typedef struct {
    double normal;     /* sum of F with damping                                     [N] */
    double elastic;    /* and without                                               [N] */
    fl_vec3 direction; /* sum of F n                                                [N] */
    fl_vec3 at;        /* a place, relative to B's centre                           [m] */
    fl_vec3 moment;    /* sum of F (p - at)                                       [N m] */
    double spread;     /* sum of F |p - at|^2; B's centre may be a thousand kilometres away [N m^2] */
    double slope;      /* dF/ds                                                   [N/m] */
    int walls;         /* sums of walls, each of which rubs by itself */
} pressure;

/* arm: of the place, from q->at. */
static void press(pressure *q, double elastic, double normal, fl_vec3 n, fl_vec3 arm)
{
    q->elastic += elastic;
    q->normal += normal;
    q->direction = v3_madd(q->direction, normal, n);
    q->moment = v3_madd(q->moment, normal, arm);
    q->spread += normal * v3_norm2(arm);
}

/* How both part there, as in fl_rubbing. */
typedef struct {
    fl_sym3 ease;
    double turns;
} parting;

/* Friction at the centre of the pressure. */
static void rub(fl_world *w, fl_pair *p, const pressure *q, double chi, const parting *part,
                const fl_stance *r, const ahead *a)
{
    const fl_bodies *b = &w->b;
    const fl_touching *law = p->law;
    if (!(law->friction > 0.0 && law->tangential > 0.0 && q->normal > 0.0)) {
        p->slip = (fl_slip){0};
        return;
    }
    const fl_vec3 mean = v3_scale(1.0 / q->normal, q->moment), aj = v3_add(q->at, mean),
                  ai = v3_add(aj, r->off);
    const double arm2 = q->spread / q->normal - v3_norm2(mean);
    const fl_rubbing c = {.n = v3_unit(q->direction),
                          .k = law->tangential * q->slope,
                          .g = law->tangential * chi * q->elastic,
                          .limit = law->friction * (q->walls ? q->normal : v3_norm(q->direction)),
                          .arm = arm2 > 0.0 ? sqrt(arm2) : 0.0,
                          .ease = part->ease,
                          .turns = part->turns,
                          .many = a->by.pressed};
    const double wi = v3_dot(b->w[p->i], c.n), wj = v3_dot(b->w[p->j], c.n),
                 turned = v3_dot(a->by.wi, c.n) - v3_dot(a->by.wj, c.n);
    const fl_vec3 v = went(b, p, a, ai, aj);
    const fl_sliding by = {v,
                           v3_add(v, fl_lead_at(&a->by, ai, aj)),
                           wi - wj,
                           wi - wj + turned,
                           0.5 * (wi + wj),
                           a->was.damped,
                           fl_lead_turned(a->was, c.n, ai, aj),
                           a->of.half,
                           a->of.begins};
    const fl_rubbed t = fl_tangent_rub(p->slip, c, by, a->of.dt);
    const fl_vec3 m = v3_scale(t.moment, c.n);
    p->slip = t.slip;
    add_wrench(&p->fs, &p->si, &p->sj, t.force, ai, aj);
    p->si = v3_add(p->si, m);
    p->sj = v3_sub(p->sj, m);
    p->f = v3_add(p->f, p->fs);
    p->ti = v3_add(p->ti, p->si);
    p->tj = v3_add(p->tj, p->sj);
    p->spring = fl_tangent_energy(p->slip);
}

/* 1/I of thing k for a turn to which it yields the most [1/kg m2]. */
static double most_turned(const fl_world *w, int32_t k)
{
    const int held = FL_HOLD_RX | FL_HOLD_RY | FL_HOLD_RZ;
    if (k >= w->n || (w->b.hold[k] & held) == held) return 0.0;
    return fmax(w->b.invI[k].x, fmax(w->b.invI[k].y, w->b.invI[k].z));
}

/* What keeps a sphere from rolling, if anything does: a moment on either.  -1 when memory runs out. */
static int roll(fl_world *w, fl_pair *p, const pressure *q, double chi, const ahead *a)
{
    const fl_bodies *b = &w->b;
    fl_err lost = {0};
    if (!w->rolls || !fl_rolls_pair(w, p)) return 0;
    const double arm = fl_material_radius(fl_rolls_radius(w, p->i), fl_rolls_radius(w, p->j)),
                 mu = p->law->rolling, part = fl_rolling_part(mu);
    if (!p->roll && !(p->roll = fl_alloc(1, sizeof *p->roll, &lost))) return -1;
    const fl_vec3 wi = b->w[p->i], wj = b->w[p->j], turns = v3_scale(arm, v3_sub(wi, wj));
    const fl_tangent_spring c = {.k = part * q->slope,
                                 .g = part * chi * q->elastic,
                                 .limit = mu * fmax(q->normal, 0.0),
                                 .yields = arm * arm * (most_turned(w, p->i) + most_turned(w, p->j)),
                                 .many = a->by.pressed};
    const fl_turning by = {turns, v3_madd(turns, arm, v3_sub(a->by.wi, a->by.wj)),
                           v3_scale(0.5, v3_add(wi, wj))};
    p->roll->arm = arm;
    *p->roll = fl_rolling(*p->roll, c, by, a->of.dt, a->of.half, a->of.begins);
    const fl_vec3 m = fl_rolls_moment(p->roll);
    p->si = v3_add(p->si, m), p->sj = v3_sub(p->sj, m);
    p->ti = v3_add(p->ti, m), p->tj = v3_sub(p->tj, m);
    p->spring += fl_rolling_energy(*p->roll);
    return 0;
}

/* What the springs of friction add, where they stick, and the bounds of it all. */
static void stiffen(const fl_world *w, fl_pair *p, const pressure *q, const fl_stance *r, fl_stiff *si,
                    fl_stiff *sj)
{
    const fl_bodies *b = &w->b;
    if (p->slip.k > 0.0) {
        const fl_vec3 n = v3_unit(q->direction), aj = v3_madd(q->at, 1.0 / q->normal, q->moment);
        const fl_vec3 ai = v3_add(aj, r->off), none = v3(0, 0, 0);
        fl_stiff_across(si, b, p->i, p->slip.k, n, ai);
        fl_stiff_across(sj, b, p->j, p->slip.k, n, aj);
        fl_stiff_add(si, b, p->i, p->slip.k_turn, none, n);
        fl_stiff_add(sj, b, p->j, p->slip.k_turn, none, n);
    }
    for (int axis = 0; axis < 3 && p->roll; axis++) {
        const fl_vec3 e = v3(axis == 0, axis == 1, axis == 2), none = v3(0, 0, 0);
        fl_stiff_add(si, b, p->i, fl_rolls_stiff(p->roll), none, e);
        fl_stiff_add(sj, b, p->j, fl_rolls_stiff(p->roll), none, e);
    }
    p->stiff_i = fl_stiff_bound(si);
    p->stiff_j = fl_stiff_bound(sj);
}

/* The same of a contact whose places push along n at the point of the pressure alone. */
static void stiffen_one(const fl_world *w, fl_pair *p, const pressure *q, fl_vec3 n, const fl_stance *r)
{
    fl_stiff si = {0}, sj = {0};
    fl_stiff_add(&si, &w->b, p->i, q->slope, n, v3_cross(v3_add(q->at, r->off), n));
    fl_stiff_add(&sj, &w->b, p->j, q->slope, n, v3_cross(q->at, n));
    stiffen(w, p, q, r, &si, &sj);
}

/* Damping is the same factor for all places of a pair,
 *     chi = D / max(v_touch, c sqrt(2 W / M)),
 * where v_touch is the largest approach speed of this touch, now the given one, and sqrt(2 W/M) the speed
 * that the stored energy W amounts to, with c of fl_damping_rest(): in an impact it stays below v_touch, so
 * restitution is that of D; in a contact that was never an impact the damping ratio stays below D/(2 c). */
static double damping_factor(fl_pair *p, double now, double mass)
{
    p->touch = p->n && p->touch > now ? p->touch : now;
    return fl_damping_chi(p->law->chi, p->law->rest, p->touch, p->energy, mass);
}

/* A place of a round thing in world axes. */
typedef struct {
    fl_vec3 n, ai, aj; /* ai, aj: from the centres of A and B    */
    double part;       /* phi'(s), with the sign of the place    */
} spot;

static spot spot_of(const fl_pair *p, const fl_place *q, const fl_stance *r)
{
    spot t = {.n = m3_mul(r->R, q->n), .aj = m3_mul(r->R, q->p)};
    t.ai = v3_add(t.aj, r->off);
    t.part = q->du * fl_normal_power(q->overlap, p->exponent);
    return t;
}

/* The same of places that push along their normals; passes take nothing off. */
static void stiffen_points(const fl_world *w, fl_pair *p, const fl_places *s, const pressure *all,
                           const fl_stance *r)
{
    fl_stiff si = {0}, sj = {0};
    for (int32_t c = 0; c < s->n; c++) {
        const fl_place *q = &s->place[c];
        const spot t = spot_of(p, q, r);
        const double slope = p->k * fl_normal_slope(q->overlap, p->exponent);
        if (q->du < 0.0) continue;
        fl_stiff_add(&si, &w->b, p->i, slope, t.n, v3_cross(t.ai, t.n));
        fl_stiff_add(&sj, &w->b, p->j, slope, t.n, v3_cross(t.aj, t.n));
    }
    stiffen(w, p, all, r, &si, &sj);
}

/* The speed of approach along n [m/s]. */
static double closing_of(const fl_bodies *b, const fl_pair *p, const ahead *a, const spot *t)
{
    return -v3_dot(t->n, next(b, p, a, t->ai, t->aj));
}

/* The places of a round thing or of `core`: W = k sum of phi(s), most often of one.  Of several places, or
 * one that may be another than a step ago, it is not known what each did then: they are damped by the speed
 * half a step ago.  -1 when memory runs out. */
static int force_points(fl_world *w, fl_pair *p, const fl_places *s, const fl_stance *r, const ahead *by,
                        int survey)
{
    const fl_bodies *b = &w->b;
    const int one = s->n == 1 && p->law->kind == FL_LAW_PATCH;
    const ahead late = {.of = by->of, .lag = by->lag, .by = {.pressed = 1.0}}, *const a = one ? by : &late;
    const double k = p->k;
    const spot first = spot_of(p, &s->place[0], r);
    fl_vec3 way = first.n, turn_i = v3_cross(first.ai, first.n), turn_j = v3_cross(first.aj, first.n);
    double sum = first.part, less = 1.0;
    p->overlap = s->place[0].overlap;
    p->energy = k * fl_normal_phi(p->overlap, p->exponent);
    if (s->n > 1) { /* of the force of all, which is less than that of each by itself */
        way = v3_scale(sum, way), turn_i = v3_scale(sum, turn_i), turn_j = v3_scale(sum, turn_j);
        for (int32_t c = 1; c < s->n; c++) {
            const fl_place *q = &s->place[c];
            const spot t = spot_of(p, q, r);
            sum += t.part;
            way = v3_madd(way, t.part, t.n);
            turn_i = v3_madd(turn_i, t.part, v3_cross(t.ai, t.n));
            turn_j = v3_madd(turn_j, t.part, v3_cross(t.aj, t.n));
            p->energy += q->du * k * fl_normal_phi(q->overlap, p->exponent);
            p->overlap = fmax(p->overlap, q->overlap);
        }
        less = v3_norm2(way) / (sum * sum);
    }
    fl_pair_yielding ease;
    if (one || !fl_pair_is_plain(w, p)) ease = fl_pair_yielding_of(w, p);
    const double mass = less > 0.0 ? fl_pair_mass(w, p, &ease, way, turn_i, turn_j) / less : INFINITY;
    const double begins = closing_of(b, p, a, &first);
    double closing = begins;
    for (int32_t c = 1; c < s->n; c++) {
        const spot t = spot_of(p, &s->place[c], r);
        if (s->place[c].du > 0.0) closing = fmax(closing, closing_of(b, p, a, &t));
    }
    const double chi = damping_factor(p, closing > 0.0 ? closing : 0.0, mass), push = k * first.part,
                 more = one ? nearer(a, begins, push, chi * push,
                                     fl_pair_yields(&ease, way, turn_i, turn_j, 1.0))
                            : 0.0;
    pressure all = {.at = first.aj, .walls = s->n > 1};
    for (int32_t c = 0; c < s->n; c++) {
        const fl_place *q = &s->place[c];
        const spot t = c ? spot_of(p, q, r) : first;
        const double elastic = k * t.part, slope = k * q->du * fl_normal_slope(q->overlap, p->exponent),
                     comes = c ? closing_of(b, p, a, &t) : begins,
                     normal = q->du * fl_normal_damped(fabs(elastic), chi, comes + more);
        add_wrench(&p->f, &p->ti, &p->tj, v3_scale(normal, t.n), t.ai, t.aj);
        add_wrench(&p->fd, &p->di, &p->dj, v3_scale(normal - elastic, t.n), t.ai, t.aj);
        press(&all, elastic, normal, t.n, v3_sub(t.aj, first.aj));
        all.slope += slope;
    }
    parting part = {.turns = 0.0};
    if (one && chi > 0.0 && p->law->friction > 0.0) part.ease = fl_pair_ease(&ease, first.ai, first.aj);
    rub(w, p, &all, chi, &part, r, a);
    if (roll(w, p, &all, chi, a)) return -1;
    if (survey) stiffen_points(w, p, s, &all, r);
    p->energy += p->spring;
    if (fl_press_wants(w, p)) fl_press_note(w, p, s, p->k, chi);
    return p->n = 1;
}

/* How stiff the springs of its places make a contact; the root in W bends down, W'' = scale (U'' - U'^2/2U).
 * ai, aj: the first place from the centres. */
static void survey_patch(const fl_world *w, const fl_pair *p, const fl_springs *q, fl_mat3 R, fl_vec3 ai,
                         fl_vec3 aj, double scale, double U, fl_stiff *si, fl_stiff *sj)
{
    const fl_bodies *b = &w->b;
    const double half = 0.5 / (scale * U);
    *si = *sj = (fl_stiff){0};
    fl_stiff_springs(si, b, p->i, scale, q, R, ai);
    fl_stiff_springs(sj, b, p->j, scale, q, R, aj);
    fl_stiff_add(si, b, p->i, -half, p->f, p->ti);
    fl_stiff_add(sj, b, p->j, -half, p->f, p->tj);
}

/* The damping of p with what shakes the bodies held back, its force being the elastic one so far; presses:
 * sum of its pressures. */
static void steady(fl_pair *p, double presses, double chi, const fl_stance *r, const ahead *a)
{
    const fl_wrench to =
        fl_lead_steadied(fl_lead_amid(p->f, p->ti, p->tj), fl_lead_amid(p->fd, p->di, p->dj), presses,
                         2.0 * a->of.half * chi * presses / p->mass, a->by.pressed, a->was, a->of.begins);
    const fl_vec3 half = v3_scale(0.5, v3_cross(r->off, to.f));
    p->fd = to.f, p->di = v3_add(half, to.m), p->dj = v3_sub(half, to.m);
}

/* What damping and friction add to the elastic force of `patch`.  q: of places, times scale; it is about aj
 * from B's centre; slope: dF/ds. */
static pressure bear(fl_world *w, fl_pair *p, const fl_bearing *q, double scale, double slope, double chi,
                     const parting *part, const fl_stance *r, fl_vec3 aj, const ahead *a)
{
    const fl_mat3 *R = &r->R;
    add_sum(&p->fd, &p->di, &p->dj, &q->damping, scale, R, v3_add(aj, r->off), aj);
    steady(p, scale * q->elastic, chi, r, a);
    p->f = v3_add(p->f, p->fd);
    p->ti = v3_add(p->ti, p->di);
    p->tj = v3_add(p->tj, p->dj);
    const pressure all = {.normal = scale * q->normal,
                          .elastic = scale * q->elastic,
                          .direction = v3_scale(scale, m3_mul(*R, q->direction)),
                          .at = aj,
                          .moment = v3_scale(scale, m3_mul(*R, q->moment)),
                          .spread = scale * q->spread,
                          .slope = slope};
    rub(w, p, &all, chi, part, r, a);
    return all;
}

/* After a look.  t: what was told for this pose, or NULL. */
static int renew(fl_world *w, fl_pair *p, int32_t thread, const fl_told *t, const fl_seen *seen)
{
    fl_surrogate_count *count = &w->told[thread];
    const int near = t && fl_surrogate_nearly(p->surrogate, t);
    fl_err lost = {0};
    if (!p->surrogate && !(p->surrogate = fl_alloc(1, sizeof *p->surrogate, &lost))) return -1;
    if (p->deep || p->keep != 1.0) {
        p->surrogate->live = 0;
        return 0;
    }
    const double off = fl_surrogate_look(p->surrogate, t, seen, p->law->surrogate);
    if (!near) return 0;
    count->looked++;
    count->off += off > p->law->surrogate;
    count->worst = off > count->worst ? off : count->worst;
    return 0;
}

/* --- what is found by a look ------------------------------------------------------------------- */

/* What turning adds: x, y, z torques of unit forces, in a frame where the inverse moments are invI. */
static fl_sym3 turning(fl_sym3 K, fl_vec3 invI, fl_vec3 x, fl_vec3 y, fl_vec3 z)
{
    return s3_add(K, s3_products(x, y, z, v3_mul(invI, x), v3_mul(invI, y), v3_mul(invI, z)));
}

/* How both part, who are free: yields, ease and turns, from how A stands to B alone; q is about `at`.  A
 * push is taken for half of the sum of the pressures at least. */
static void find_ease(const fl_bodies *b, const fl_pair *p, const fl_bearing *q, fl_vec3 at, fl_seen *seen)
{
    const fl_mat3 *M = seen->M;
    const fl_vec3 f = q->gradient.f, m = q->gradient.m, n = v3_unit(f), none = v3(0, 0, 0),
                  aj = v3_madd(at, 1.0 / q->elastic, q->middle), ai = v3_sub(aj, seen->o), ei = b->invI[p->i],
                  ej = p->j < b->n ? b->invI[p->j] : none;
    const fl_vec3 mi = m3_tmul(*M, v3_add(v3_cross(v3_sub(at, seen->o), f), m)),
                  mj = v3_add(v3_cross(at, f), m), ni = m3_tmul(*M, n);
    const double each = 1.0 / p->mass, f2 = fmax(v3_norm2(f), 0.25 * q->elastic * q->elastic),
                 turns = v3_dot(v3_mul(ei, mi), mi) + v3_dot(v3_mul(ej, mj), mj);
    seen->yields = each + turns / f2;
    seen->turns = v3_dot(v3_mul(ei, ni), ni) + v3_dot(v3_mul(ej, n), n);
    const fl_vec3 x = {1, 0, 0}, y = {0, 1, 0}, z = {0, 0, 1};
    const fl_sym3 alone = s3_even(each),
                  turned = turning(alone, ei, m3_tmul(*M, v3_cross(ai, x)), m3_tmul(*M, v3_cross(ai, y)),
                                   m3_tmul(*M, v3_cross(ai, z)));
    seen->ease = turning(turned, ej, v3_cross(aj, x), v3_cross(aj, y), v3_cross(aj, z));
}

/* W = k sqrt(U) of the places summed up in q, which gets their couple. */
static void seen_of(const fl_world *w, const fl_pair *p, const fl_places *s, const fl_stance *r,
                    fl_bearing *q, fl_seen *seen)
{
    const double energy = p->k * sqrt(q->u), scale = 0.5 * energy / q->u;
    q->gradient.m = v3_add(q->gradient.m, s->couple);
    *seen = (fl_seen){.M = &r->M,
                      .o = r->o,
                      .places = s,
                      .q = q,
                      .scale = scale,
                      .energy = energy,
                      .slope = scale * (q->ddu - 0.5 * q->elastic * q->elastic / q->u)};
    find_ease(&w->b, p, q, s->place[0].p, seen);
}

/* How far A may go until another wall of a surface that is not convex may bear, after a look.  -1 when memory
 * runs out. */
static int find_room(fl_world *w, const fl_pair *p, int32_t thread, fl_seen *seen)
{
    const fl_piece *piece = fl_world_piece(w, p->j);
    const double ra = w->b.radius[p->i];
    seen->bound = w->b.bound[p->i];
    seen->radii = ra + w->b.radius[p->j];
    seen->room = INFINITY;
    seen->level = piece && piece->kind == FL_PIECE_PLANE;
    if (piece && piece->kind == FL_PIECE_SHELL)
        seen->room = fl_shell_room(&w->near_shell[thread], seen->places->va, &w->b.core[p->i], piece, ra,
                                   seen->q->overlap, fl_surrogate_less(p->law->surrogate));
    return seen->room < 0.0 ? -1 : 0;
}

/* The places of `patch`: W = k sqrt(U), each with its share of dW/dU; t as in renew().  1 when they touch, 0
 * when nothing does, -1 when memory runs out. */
static int force_patch(fl_world *w, fl_pair *p, int32_t thread, const fl_told *t, const fl_stance *r,
                       const ahead *a, int survey)
{
    const fl_bodies *b = &w->b;
    const fl_mat3 R = r->R;
    fl_places *s = &w->scratch[thread];
    const int carried = p->law->surrogate > 0.0 && !fl_press_wants(w, p);
    if (s->n == 0) return 0;
    const fl_vec3 at = s->place[0].p, aj = m3_mul(R, at), ai = v3_add(aj, r->off);
    fl_bearing q;
    if (fl_bearing_sum(s, &q)) return -1;
    if (!(q.u > 0.0 && q.overlap > ROUNDING * (v3_norm(r->o) + b->bound[p->i]))) return 0;
    fl_seen seen;
    seen_of(w, p, s, r, &q, &seen);
    p->overlap = q.overlap;
    p->energy = seen.energy;
    add_sum(&p->f, &p->ti, &p->tj, &q.gradient, seen.scale, &R, ai, aj);
    const fl_vec3 elastic = p->f;
    parting part;
    double yields = seen.yields, mass = p->mass;
    if (!fl_pair_is_free(w, p)) {
        const fl_pair_yielding ease = fl_pair_yielding_of(w, p);
        const fl_vec3 middle = m3_mul(R, v3_scale(1.0 / q.elastic, q.middle));
        mass = fl_pair_mass(w, p, &ease, elastic, p->ti, p->tj);
        part.ease = fl_pair_ease(&ease, v3_add(ai, middle), v3_add(aj, middle));
        part.turns = fl_pair_turns(&ease, v3_unit(elastic));
        yields = fl_pair_yields(&ease, elastic, p->ti, p->tj, seen.scale * q.elastic);
    } else {
        part.ease = s3_turned(seen.ease, m3_col(R, 0), m3_col(R, 1), m3_col(R, 2));
        part.turns = seen.turns;
    }
    const fl_vec3 spin = v3_add(v3_sub(b->w[p->i], b->w[p->j]), v3_sub(a->by.wi, a->by.wj));
    const fl_vec3 v = m3_tmul(R, next(b, p, a, ai, aj)), turn = m3_tmul(R, spin);
    if (fl_bearing_move(s, v, turn, &q)) return -1;
    const double chi = damping_factor(p, q.pressed > 0.0 ? q.met / q.pressed : 0.0, mass);
    const double size = v3_norm(elastic), more = fl_lead_share(size, seen.scale * q.elastic) *
                                                 nearer(a, q.rate / q.elastic, size, chi * size, yields);
    fl_bearing_damp(s, chi, more, &q);
    fl_stiff si, sj;
    fl_springs springs;
    if (survey || carried) fl_bearing_springs(s, &springs);
    survey |= carried && (!t || asks(w));
    if (survey) survey_patch(w, p, &springs, R, ai, aj, seen.scale, q.u, &si, &sj);
    if (t && fl_surrogate_nearly(p->surrogate, t) && fabs(seen.slope - t->slope) < 0.5 * t->slope)
        fl_tangent_remeasured(&p->slip, seen.slope / t->slope, seen.slope < p->surrogate->slope);
    const pressure all = bear(w, p, &q, seen.scale, seen.slope, chi, &part, r, aj, a);
    if (survey) stiffen(w, p, &all, r, &si, &sj);
    if (carried) {
        const double speed = v3_dot(v3_unit(elastic), approach(b, p, ai, aj));
        seen.springs = &springs;
        seen.v = v, seen.turn = turn, seen.chi = chi, seen.more = more;
        /* the force that the energy of the motion would give, W growing as the square of it */
        seen.toward = sqrt(1.0 + 0.5 * mass * speed * speed / p->energy);
        seen.stiff_i = p->stiff_i, seen.stiff_j = p->stiff_j;
        if (find_room(w, p, thread, &seen) || renew(w, p, thread, t, &seen)) return -1;
    }
    p->energy += p->spring;
    if (fl_press_wants(w, p)) {
        for (int32_t k = 0; k < s->n; k++) s->place[k].closing = fl_bearing_closing(s, k) + more;
        fl_press_note(w, p, s, seen.scale, chi);
    }
    return p->n = 1;
}

/* An elastic wall: force, moment and energy of Winkler's foundation under the part of A behind the wall, and
 * a dashpot at the centre of the pressure, which never pulls the body back into the wall.  The closing speed
 * of a point does not change along the normal, so the centre may stand behind the wall. */
static int force_bed(fl_world *w, fl_pair *p, const fl_stance *r, const ahead *a, int survey,
                     double *distance)
{
    const fl_bodies *b = &w->b;
    const int32_t i = p->i;
    const fl_mat3 R = fl_body_axes(b, i);
    const fl_vec3 n = m3_col(r->R, 2), up = m3_tmul(R, n);
    const double level = v3_dot(n, r->off); /* of the wall over the centre of A */
    const fl_hull *hull = &w->bed.hull[i];
    double low = INFINITY;
    for (int32_t v = 0; v < hull->p->nv; v++) low = fmin(low, v3_dot(up, hull->p->v[v]));
    *distance = low - level - hull->radius;
    if (*distance >= 0.0) return 0;
    fl_wet wet;
    fl_vec3 force, moment;
    fl_buoyancy(hull, up, level, &wet);
    if (wet.volume <= 0.0) return 0;
    p->energy = fl_buoyancy_force(&wet, up, level, w->bed.stiffness, &force, &moment);
    const fl_vec3 ai = m3_mul(R, wet.centre), aj = v3_sub(ai, r->off);
    const double damping = w->bed.damping * wet.waterplane, elastic = w->bed.stiffness * wet.volume;
    const fl_pair_yielding ease = fl_pair_yielding_of(w, p);
    const double foreseen = -v3_dot(n, next(b, p, a, ai, aj)),
                 yields = fl_pair_yields(&ease, n, v3_cross(ai, n), v3_cross(aj, n), 1.0),
                 closing = foreseen + nearer(a, foreseen, elastic, damping, yields);
    double normal = elastic + damping * closing;
    if (normal < 0.0) normal = 0.0;
    pressure all = {.slope = w->bed.stiffness * wet.waterplane, .at = aj};
    add_wrench(&p->f, &p->ti, &p->tj, v3_scale(normal, n), ai, aj);
    add_wrench(&p->fd, &p->di, &p->dj, v3_scale(normal - elastic, n), ai, aj);
    press(&all, elastic, normal, n, v3(0, 0, 0));
    rub(w, p, &all, 0.0, &(parting){0}, r, a);
    if (roll(w, p, &all, 0.0, a)) return -1;
    if (survey) { /* the waterplane behind the wall turns with the body: as stiff as at its farthest point */
        fl_stiff si = {0}, sj = {0};
        fl_stiff_add(&si, b, i, all.slope, n, v3_cross(ai, n));
        stiffen(w, p, &all, r, &si, &sj);
    }
    p->energy += p->spring;
    return p->n = 1;
}

/* The manual's law: one contact, by the kind of the closest features. */
static int force_manual(fl_world *w, fl_pair *p, int32_t thread, const fl_stance *r, const ahead *a,
                        int survey, double *distance)
{
    const fl_bodies *b = &w->b;
    const fl_touching *law = p->law;
    const double ra = p->keep * b->radius[p->i], rb = p->keep * b->radius[p->j];
    fl_contact c;
    if (fl_stance_contact(w, p, thread, r, &c)) return -1;
    *distance = c.d;
    if (c.gap >= 0.0) {
        p->mode = FL_MODE_NONE;
        p->n = 0;
        return 0;
    }
    const double overlap = -c.gap;
    const fl_manual_contact mc = {.touch = (fl_touch)(c.mode - FL_VV),
                                  .length = c.length,
                                  .area = c.area,
                                  .sine = c.sine,
                                  .r_low = c.low_b ? rb : ra,
                                  .r_high = c.low_b ? ra : rb,
                                  .edge = c.edge};
    double exponent, k = fl_manual_stiffness(&mc, law->modulus, overlap, law->kind == FL_LAW_MANUAL_SI,
                                             law->literal18, &exponent);
    k = law->stiffness > 0.0 ? law->stiffness : law->softening * k;
    const fl_vec3 nw = m3_mul(r->R, c.n), aj = m3_mul(r->R, c.p), ai = v3_add(aj, r->off);
    const fl_vec3 u = went(b, p, a, ai, aj); /* without a lead: as the manual has it */
    const double closing = -v3_dot(nw, u);
    fl_pair_yielding ease;
    if (!fl_pair_is_plain(w, p)) ease = fl_pair_yielding_of(w, p);
    const double mass = law->literal2 && b->invm[p->j] > 0.0
                            ? b->m[p->i] + b->m[p->j]
                            : fl_pair_mass(w, p, &ease, nw, v3_cross(ai, nw), v3_cross(aj, nw));
    const double elastic = k * fl_normal_power(overlap, exponent);
    double normal = elastic + fl_manual_damping(k, exponent, overlap, mass, law->zeta, law->alpha, closing);
    if (normal < 0.0) normal = 0.0;
    const double slope = k * fl_normal_slope(overlap, exponent);
    pressure all = {.slope = slope, .at = aj};
    p->overlap = overlap;
    p->energy = k * fl_normal_phi(overlap, exponent);
    p->mode = c.mode;
    add_wrench(&p->f, &p->ti, &p->tj, v3_scale(normal, nw), ai, aj);
    add_wrench(&p->fd, &p->di, &p->dj, v3_scale(normal - elastic, nw), ai, aj);
    press(&all, elastic, normal, nw, v3(0, 0, 0));
    rub(w, p, &all, 0.0, &(parting){0}, r, a);
    if (survey) stiffen_one(w, p, &all, nw, r);
    p->energy += p->spring;
    if (fl_press_wants(w, p)) fl_press_note_one(w, p, c.p, c.n, c.area);
    p->n = 1;
    return 0;
}

void fl_interact(fl_world *w, fl_pair *p, int32_t thread, double dt, int survey)
{
    const int known = fl_told_of(w, p);
    uint8_t done = 0;
    fl_told t;
    if (known) fl_told_touch(w, &p, 1, dt, survey, &done, &t);
    if (done) w->told[thread].told++;
    else fl_interact_look(w, p, thread, known ? &t : NULL, dt, survey);
}

void fl_interact_look(fl_world *w, fl_pair *p, int32_t thread, const fl_told *t, double dt, int survey)
{
    const fl_bodies *b = &w->b;
    const double R = b->radius[p->i] + b->radius[p->j];
    const int first = p->bond && p->keep == 0.0 && p->n == 0; /* look since its bond ended */
    const fl_stance r = fl_stance_of(w, p);
    const ahead a = ahead_of(w, p, &r, dt);
    fl_places *s = &w->scratch[thread];
    double distance = 0.0;
    p->f = p->ti = p->tj = p->fd = p->di = p->dj = p->fs = p->si = p->sj = v3(0, 0, 0);
    p->energy = p->spring = p->overlap = p->stiff_i = p->stiff_j = 0.0;
    const fl_piece *piece = fl_world_piece(w, p->j);
    const int manual = (p->law->kind == FL_LAW_MANUAL || p->law->kind == FL_LAW_MANUAL_SI) &&
                       (!piece || piece->kind == FL_PIECE_SOLID || piece->kind == FL_PIECE_CONE);
    if (piece && piece->elastic) {
        const int touch = force_bed(w, p, &r, &a, survey, &distance);
        if (touch < 0) goto failed;
        if (touch) return;
        distance += R; /* what sleeps is told by the distance of the cores */
    } else if (manual) {
        if (force_manual(w, p, thread, &r, &a, survey, &distance)) goto failed;
        if (p->n) goto touches;
    } else {
        if (fl_stance_places(w, p, thread, &r, &distance)) goto failed;
        const int touch = p->exponent == 0.0 ? force_patch(w, p, thread, t, &r, &a, survey)
                          : s->n             ? force_points(w, p, s, &r, &a, survey)
                                             : 0;
        if (touch < 0) goto failed;
        if (touch) goto touches;
    }
    p->slip = (fl_slip){0};
    if (p->roll) *p->roll = (fl_roll){.k = 0.0};
    p->n = 0;
    p->touch = 0.0;
    if (p->surrogate) p->surrogate->live = 0;
    if (p->bond && p->keep < 1.0) fl_frozen_return(w, p, R, distance);
    fl_stance_parted(w, p, distance, R);
    return;
touches:
    if (first) fl_frozen_meet(w, p);
    return;
failed:
#pragma omp atomic write
    w->failed = 1;
}

int fl_interact_again(fl_world *w, fl_pair *p, const fl_mat3 *M, fl_vec3 o)
{
    const fl_stance r = {.M = *M, .o = o};
    fl_places *s = &w->scratch[0];
    double distance = 0.0;
    fl_bearing q;
    if (fl_stance_places(w, p, 0, &r, &distance)) return -1;
    if (s->n == 0) return 0;
    if (fl_bearing_sum(s, &q)) return -1;
    if (!(q.u > 0.0)) return 0;
    fl_seen seen;
    seen_of(w, p, s, &r, &q, &seen);
    fl_springs springs;
    fl_bearing_springs(s, &springs);
    seen.springs = &springs;
    if (find_room(w, p, 0, &seen)) return -1;
    fl_surrogate_fill(p->surrogate, &seen);
    return 0;
}
