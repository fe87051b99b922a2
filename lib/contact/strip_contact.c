/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "contact/strip_contact.h"
#include <stdlib.h>
#include "base/array.h"
#include "contact/pair_response.h"

/* Share of the width of a sector after which areas are found anew, and of delta that a step may close. */
#define KNOWN_SHARE 0.1
#define STEP_SHARE 0.2

enum { PLANES = 128 };

/* The floe as half-spaces n.x <= c in the frame of the piece; `steep` ones are its sides. */
typedef struct {
    int32_t n;
    fl_vec3 normal[PLANES];
    double c[PLANES];
    uint8_t steep[PLANES];
} floe_planes;

static void find_planes(floe_planes *q, const fl_bodies *b, const fl_pair *p, const fl_relative_pose *r)
{
    const fl_poly *core = &b->core[p->i];
    const fl_vec3 up = v3(r->R.m[2][0], r->R.m[2][1], r->R.m[2][2]);
    q->n = core->nf < PLANES ? core->nf : PLANES;
    for (int32_t f = 0; f < q->n; f++) {
        q->normal[f] = m3_mul(r->M, core->n[f]);
        q->c[f] = v3_dot(core->n[f], core->v[core->loop[core->first[f]]]) + b->radius[p->i] +
                  v3_dot(q->normal[f], r->o);
        q->steep[f] = fabs(v3_dot(q->normal[f], up)) < 0.7;
    }
}

/* Area of sector s in the floe and its middle; *room is lowered to the way after which that may change. */
static double sector_area(const floe_planes *q, const fl_wall_sector *s, double *middle, double *room)
{
    double from = s->from, to = s->to, depth = INFINITY, outside = 0.0;
    int clipped = 0;
    for (int32_t f = 0; f < q->n; f++) {
        const double rise = v3_dot(q->normal[f], s->up), gap = q->c[f] - v3_dot(q->normal[f], s->x);
        if (rise > 0.0 && to * rise > gap) to = gap / rise, clipped |= 1;
        else if (rise < 0.0 && from * rise > gap) from = gap / rise, clipped |= 2;
        else if (rise == 0.0 && gap < 0.0) to = -INFINITY;
        if (!q->steep[f]) continue;
        depth = fmin(depth, gap);
        outside = fmax(outside, -gap);
    }
    const double length = to - from;
    if (!(length > 0.0)) {
        *room = fmin(*room, outside);
        return 0.0;
    }
    *middle = 0.5 * (from + to);
    *room = clipped == 3 ? fmin(*room, fmax(depth, 0.0)) : 0.0;
    return length * fmax(0.0, s->width + s->taper * *middle);
}

fl_strip *fl_strip_make(int32_t n)
{
    fl_strip *q = calloc(1, sizeof *q + (size_t)n * sizeof *q->cell);
    if (q) q->n = n, q->strength.node = -1, q->known_until = -1.0;
    return q;
}

static fl_strip_id id_of(const fl_world *w, const fl_pair *p, int32_t sector)
{
    return (fl_strip_id){w->id[p->i], p->j - w->n, sector};
}

/* Areas of all sectors, if the two have moved far enough. */
static void update_areas(fl_world *w, const fl_pair *p, const fl_relative_pose *r, const fl_wall *wall)
{
    fl_strip *q = p->strip;
    const double now = w->b.odometer[p->i] + w->b.odometer[p->j];
    floe_planes planes;
    double room = INFINITY;
    if (now < q->known_until) return;
    find_planes(&planes, &w->b, p, r);
    for (int32_t k = 0; k < q->n; k++) {
        fl_strip_cell *c = &q->cell[k];
        const double before = c->area;
        c->area = sector_area(&planes, &wall->sector[k], &c->middle, &room);
        room = fmin(room, KNOWN_SHARE * wall->sector[k].width);
        if (before > 0.0 || c->area == 0.0) continue;
        const fl_strip_id id = id_of(w, p, k); /* it enters */
        c->ice.u = 0.0;
        c->ice.e = -fl_strip_gap(&w->strips.law, fl_rng_entity4(id.floe, id.region, id.sector, c->ice.count));
    }
    q->known_until = now + room;
}

/* Velocity of the ice against the wall at x, frame of the piece: base + spin x x. */
typedef struct {
    fl_vec3 base, spin;
} wall_motion;

static wall_motion motion_of(const fl_world *w, const fl_pair *p, const fl_relative_pose *r, double dt)
{
    const fl_bodies *b = &w->b;
    const fl_vec3 lag = fl_pair_rotation_lag(b, p, r->off, dt),
                  v = v3_add(v3_add(v3_sub(b->v[p->i], b->v[p->j]), lag), v3_cross(b->w[p->i], r->off));
    return (wall_motion){m3_tmul(r->R, v), m3_tmul(r->R, v3_sub(b->w[p->i], b->w[p->j]))};
}

/* Ice that slides along the wall passes from sector to sector. */
static void transport(fl_strip *q, const fl_wall *wall, const wall_motion *v, double dt)
{
    for (int32_t k = 0; k < q->n; k++) q->cell[k].e = q->cell[k].ice.e, q->cell[k].u = q->cell[k].ice.u;
    for (int32_t k = 0; k < q->n; k++) {
        const fl_wall_sector *s = &wall->sector[k];
        fl_strip_cell *c = &q->cell[k];
        const double slid = dt * v3_dot(s->along, v3_add(v->base, v3_cross(v->spin, s->x)));
        const int32_t from = slid > 0.0 ? s->left : s->right;
        if (c->area == 0.0 || slid == 0.0 || from < 0 || q->cell[from].area == 0.0) continue;
        const double part = fmin(1.0, fabs(slid) / s->width);
        c->ice.e -= part * (c->e - q->cell[from].e);
        c->ice.u -= part * (c->u - q->cell[from].u);
    }
}

/* Sum of the area vectors of the ice that is near the wall, and *A, the nominal area: its length, or that of all
 * of them seen against the motion, which is the same on a front, and more where ice is all around. */
static fl_vec3 near_area(const fl_world *w, const fl_strip *q, const fl_wall *wall, fl_vec3 v, double *A)
{
    const double least = -4.0 * w->strips.law.delta * w->strips.law.peak_ratio, speed = v3_norm(v);
    const fl_vec3 d = speed > 0.0 ? v3_scale(-1.0 / speed, v) : v3(0, 0, 0);
    fl_vec3 sum = v3(0, 0, 0);
    double seen = 0.0;
    for (int32_t k = 0; k < q->n; k++) {
        if (!(q->cell[k].area > 0.0) || !(q->cell[k].ice.e > least)) continue;
        const double facing = v3_dot(wall->sector[k].n, d);
        sum = v3_madd(sum, q->cell[k].area, wall->sector[k].n);
        if (facing > 0.0) seen += q->cell[k].area * facing;
    }
    *A = fmax(v3_norm(sum), seen);
    return sum;
}

/* k of the present step; sets the way of the ice, and the closing speed. */
static double stiffness_now(fl_world *w, const fl_pair *p, const fl_wall *wall, const wall_motion *v, double dt)
{
    const fl_strips *s = &w->strips;
    fl_strip *q = p->strip;
    double A;
    const fl_vec3 S = near_area(w, q, wall, v->base, &A);
    const double size = v3_norm(S);
    if (A > q->largest_area) q->largest_area = A;
    q->closing = size > 1e-9 * A ? -v3_dot(v->base, S) / size : 0.0;
    q->way += dt * q->closing;
    q->farthest = fmax(q->farthest, q->way);
    if (q->largest_area == 0.0) return 0.0;
    double k = s->law.peak_ratio * fl_crushing_pressure(&s->pressure, q->largest_area) / s->law.delta;
    if (s->scatter > 0.0)
        k *= fl_strip_strength_at(&q->strength, &s->law, s->scatter, s->scatter_length, q->farthest, w->id[p->i],
                                  p->j - w->n);
    return k;
}

static void note_speed(fl_world *w, double closes)
{
    if (closes <= STEP_SHARE * w->strips.law.delta) return;
#pragma omp critical(fl_strip_speed)
    if (closes > w->strips.too_fast) w->strips.too_fast = closes;
}

int fl_strip_contact_advance(fl_world *w, fl_pair *p, const fl_relative_pose *r, double dt, fl_strip_result *out)
{
    const fl_wall *wall = &w->strips.wall[p->j - w->n];
    const fl_strip_law *law = &w->strips.law;
    fl_vec3 moment = v3(0, 0, 0);
    double work = 0.0, store = 0.0, fastest = 0.0;
    *out = (fl_strip_result){0};
    if (!p->strip && !(p->strip = fl_strip_make(wall->n))) return -1;
    fl_strip *const q = p->strip;
    const wall_motion v = motion_of(w, p, r, dt);
    const fl_strip_step step = fl_strip_step_of(law, dt);
    for (int32_t k = 0; k < q->n; k++) { /* work of the forces at the start of the step */
        fl_strip_cell *c = &q->cell[k];
        if (!(c->area > 0.0)) continue;
        const fl_wall_sector *s = &wall->sector[k];
        const double f = q->k * c->area * fl_strip_deflection(&c->ice);
        if (f > 0.0) work -= 0.5 * f * dt * v3_dot(s->n, v3_add(v.base, v3_cross(v.spin, v3_madd(s->x, c->middle, s->up))));
    }
    update_areas(w, p, r, wall);
    if (dt > 0.0) transport(q, wall, &v, dt);
    q->k = stiffness_now(w, p, wall, &v, dt);
    q->breaks = 0;
    for (int32_t k = 0; k < q->n; k++) {
        fl_strip_cell *c = &q->cell[k];
        if (!(c->area > 0.0)) continue;
        const fl_wall_sector *s = &wall->sector[k];
        const fl_vec3 x = v3_madd(s->x, c->middle, s->up);
        const double dq = -dt * v3_dot(s->n, v3_add(v.base, v3_cross(v.spin, x)));
        q->breaks += fl_strip_advance(&step, &c->ice, dq, id_of(w, p, k));
        fastest = fmax(fastest, dq);
        out->touches = 1;
        const double z = fl_strip_deflection(&c->ice), stiff = q->k * c->area, f = stiff * z;
        store += stiff * fl_strip_store(law, &c->ice);
        if (!(f > 0.0)) continue;
        const fl_vec3 force = v3_scale(f, s->n);
        work += 0.5 * f * dq;
        out->force.f = v3_add(out->force.f, force);
        out->force.m = v3_add(out->force.m, v3_cross(x, force));
        out->normal += f;
        out->slope += stiff;
        moment = v3_madd(moment, f, x);
        out->max_depth = fmax(out->max_depth, z);
    }
    if (out->normal > 0.0) out->centre = v3_scale(1.0 / out->normal, moment);
    q->work = work - (store - q->store);
    q->store = store;
    note_speed(w, fastest);
    return 0;
}

void fl_strip_contact_springs(const fl_world *w, const fl_pair *p,
                              void (*add)(void *arg, double k, fl_vec3 n, fl_vec3 x), void *arg)
{
    const fl_wall *wall = &w->strips.wall[p->j - w->n];
    const fl_strip *q = p->strip;
    for (int32_t k = 0; k < q->n; k++) {
        const fl_strip_cell *c = &q->cell[k];
        const fl_wall_sector *s = &wall->sector[k];
        if (c->area > 0.0 && c->ice.e > -w->strips.law.delta)
            add(arg, q->k * c->area, s->n, v3_madd(s->x, c->middle, s->up));
    }
}
