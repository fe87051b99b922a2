/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "contact/strip_contact.h"
#include <stdlib.h>
#include "base/array.h"
#include "contact/pair_response.h"

/* Share of the width of a sector after which areas are found anew, and of delta that a step may close. */
#define KNOWN_SHARE 0.1
#define STEP_SHARE 0.2

/* Share of that width after which ice is passed on. */
#define PASS_SHARE 0.01

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
        if (c->area != before) q->near_known = 0;
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
    int turns; /* spin is not 0 */
} wall_motion;

/* Way by which the wall closes on the ice at x along n in dt. */
static inline double closing_way(const wall_motion *v, fl_vec3 n, fl_vec3 x, double dt)
{
    return -dt * v3_dot(n, v->turns ? v3_add(v->base, v3_cross(v->spin, x)) : v->base);
}

static wall_motion motion_of(const fl_world *w, const fl_pair *p, const fl_relative_pose *r, double dt)
{
    const fl_bodies *b = &w->b;
    const fl_vec3 lag = fl_pair_rotation_lag(b, p, r->off, dt),
                  v = v3_add(v3_add(v3_sub(b->v[p->i], b->v[p->j]), lag), v3_cross(b->w[p->i], r->off));
    const fl_vec3 spin = m3_tmul(r->R, v3_sub(b->w[p->i], b->w[p->j]));
    return (wall_motion){m3_tmul(r->R, v), spin, v3_nonzero(spin)};
}

/* Ice that has slid along the wall passes from sector to sector, in steps of a share of their width. */
static void transport(fl_strip *q, const fl_wall *wall, const wall_motion *v, double dt)
{
    double far = 0.0;
    q->slid = v3_madd(q->slid, dt, v->base);
    q->turned = v3_madd(q->turned, dt, v->spin);
    far = v3_norm(q->slid) + v3_norm(q->turned) * v3_norm(wall->sector[0].x);
    if (far < PASS_SHARE * wall->sector[0].width) return;
    for (int32_t k = 0; k < q->n; k++) q->cell[k].e = q->cell[k].ice.e, q->cell[k].u = q->cell[k].ice.u;
    for (int32_t k = 0; k < q->n; k++) {
        const fl_wall_sector *s = &wall->sector[k];
        fl_strip_cell *c = &q->cell[k];
        const double slid = v3_dot(s->along, v3_add(q->slid, v3_cross(q->turned, s->x)));
        const int32_t from = slid > 0.0 ? s->left : s->right;
        if (c->area == 0.0 || slid == 0.0 || from < 0 || q->cell[from].area == 0.0) continue;
        const double part = fmin(1.0, fabs(slid) / s->width);
        c->ice.e -= part * (c->e - q->cell[from].e);
        c->ice.u -= part * (c->u - q->cell[from].u);
    }
    q->slid = q->turned = v3(0, 0, 0);
    q->near_known = 0;
}

/* Depth of ice in a gap beyond which it is not near the wall. */
static double near_limit(const fl_world *w) { return -4.0 * w->strips.law.delta * w->strips.law.peak_ratio; }

/* Sums the area vectors of the ice near the wall. The nominal area is their length, or that of all of them
 * seen against the motion, which is the same on a front, and more where ice is all around. */
static void sum_near_area(const fl_world *w, fl_strip *q, const fl_wall *wall, fl_vec3 v)
{
    const double least = near_limit(w), speed = v3_norm(v);
    const fl_vec3 d = speed > 0.0 ? v3_scale(-1.0 / speed, v) : v3(0, 0, 0);
    double seen = 0.0;
    q->near_area = v3(0, 0, 0);
    for (int32_t k = 0; k < q->n; k++) {
        if (!(q->cell[k].area > 0.0) || !(q->cell[k].ice.e > least)) continue;
        const double facing = v3_dot(wall->sector[k].n, d);
        q->near_area = v3_madd(q->near_area, q->cell[k].area, wall->sector[k].n);
        if (facing > 0.0) seen += q->cell[k].area * facing;
    }
    q->largest_area = fmax(q->largest_area, fmax(v3_norm(q->near_area), seen));
    q->near_known = speed > 0.0;
}

/* k of the present step; sets the way of the ice, and the closing speed. */
static double stiffness_now(fl_world *w, const fl_pair *p, const fl_wall *wall, const wall_motion *v,
                            double dt)
{
    const fl_strips *s = &w->strips;
    fl_strip *q = p->strip;
    if (!q->near_known) sum_near_area(w, q, wall, v->base);
    const double size = v3_norm(q->near_area);
    q->closing = size > 1e-9 * q->largest_area ? -v3_dot(v->base, q->near_area) / size : 0.0;
    q->way += dt * q->closing;
    q->farthest = fmax(q->farthest, q->way);
    if (q->largest_area == 0.0) return 0.0;
    double k = s->law.peak_ratio * fl_crushing_pressure(&s->pressure, q->largest_area) / s->law.delta;
    if (s->scatter > 0.0)
        k *= fl_strip_strength_at(&q->strength, &s->law, s->scatter, s->scatter_length, q->farthest,
                                  w->id[p->i], p->j - w->n);
    return k;
}

/* Adds the springs of the sectors that touch the ice, or may soon. */
static void add_springs(const fl_strip *q, const fl_wall *wall, double gap, fl_spring_sums *sum)
{
    for (int32_t j = 0; j < q->n; j++) {
        const fl_strip_cell *c = &q->cell[j];
        const fl_wall_sector *s = &wall->sector[j];
        if (!(c->area > 0.0) || c->ice.e < -gap) continue;
        const fl_vec3 arm = v3_cross(v3_madd(s->x, c->middle, s->up), s->n);
        const double k = q->k * c->area, N[3] = {s->n.x, s->n.y, s->n.z}, M[3] = {arm.x, arm.y, arm.z};
        for (int r = 0; r < 3; r++)
            for (int i = 0; i < 3; i++) {
                sum->linear[r][i] += k * N[r] * N[i];
                sum->coupling[r][i] += k * M[r] * N[i];
                sum->angular[r][i] += k * M[r] * M[i];
            }
    }
}

static void note_speed(fl_world *w, double closes)
{
    if (closes <= STEP_SHARE * w->strips.law.delta) return;
#pragma omp critical(fl_strip_speed)
    if (closes > w->strips.too_fast) w->strips.too_fast = closes;
}

/* What the cells of a step add up to, frame of the piece. */
typedef struct {
    fl_vec3 force, moment, weighted; /* sum of f, of x x f, and of |f| x */
    double normal, stiffness, depth, work, store, fastest;
    int32_t breaks, touching, crossing; /* crossing: some came near the wall or left it */
} cell_sums;

/* Advances all cells by the step; those that stay in a gap are done with it at once. */
static cell_sums advance_cells(const fl_world *w, const fl_pair *p, const fl_strip_step *step,
                               const wall_motion *v, double dt)
{
    const fl_wall *wall = &w->strips.wall[p->j - w->n];
    const double least = near_limit(w), k = p->strip->k;
    fl_strip *const q = p->strip;
    cell_sums sum = {.normal = 0.0};
    for (int32_t j = 0; j < q->n; j++) {
        fl_strip_cell *const c = &q->cell[j];
        const fl_wall_sector *const s = &wall->sector[j];
        const double e = c->ice.e;
        if (!(c->area > 0.0) && c->load == 0.0) continue;
        fl_vec3 x = s->x;
        if (v->turns || c->load > 0.0) x = v3_madd(s->x, c->middle, s->up);
        const double dq = closing_way(v, s->n, x, dt);
        if (!(c->area > 0.0)) { /* the sector has left the ice: the last of its load does work */
            sum.work += 0.5 * c->load * dq;
            c->load = 0.0;
            continue;
        }
        sum.touching = 1;
        if (dq > sum.fastest) sum.fastest = dq;
        if (c->load == 0.0 && c->ice.u == 0.0 && e + dq <= 0.0) {
            c->ice.e = e + dq;
            sum.crossing |= (e > least) != (e + dq > least);
            continue;
        }
        const double stiff = k * c->area;
        sum.breaks += fl_strip_advance(step, &c->ice, dq, id_of(w, p, j));
        const double z = fl_strip_deflection(&c->ice), f = stiff * z;
        sum.store += stiff * fl_strip_store(step->law, &c->ice);
        sum.work += 0.5 * (c->load + f) * dq;
        c->load = f;
        if (!(z > 0.0)) continue;
        if (z > sum.depth) sum.depth = z;
        const fl_vec3 force = v3_scale(f, s->n), at = v3_madd(s->x, c->middle, s->up);
        sum.force = v3_add(sum.force, force);
        sum.moment = v3_add(sum.moment, v3_cross(at, force));
        sum.weighted = v3_madd(sum.weighted, f, at);
        sum.normal += f;
        sum.stiffness += stiff;
    }
    return sum;
}

int fl_strip_contact_advance(fl_world *w, fl_pair *p, const fl_relative_pose *r, double dt, int survey,
                             fl_strip_result *out)
{
    const fl_wall *wall = &w->strips.wall[p->j - w->n];
    *out = (fl_strip_result){0};
    if (!p->strip && !(p->strip = fl_strip_make(wall->n))) return -1;
    fl_strip *const q = p->strip;
    const wall_motion v = motion_of(w, p, r, dt);
    const fl_strip_step step = fl_strip_step_of(&w->strips.law, dt);
    update_areas(w, p, r, wall);
    transport(q, wall, &v, dt);
    q->k = stiffness_now(w, p, wall, &v, dt);
    const cell_sums sum = advance_cells(w, p, &step, &v, dt);
    if (sum.crossing) q->near_known = 0;
    q->breaks = sum.breaks;
    q->work = sum.work - (sum.store - q->store);
    q->store = sum.store;
    out->force = (fl_wrench){sum.force, sum.moment};
    out->normal = sum.normal;
    out->slope = sum.stiffness;
    out->touches = sum.touching;
    out->max_depth = sum.depth;
    if (sum.normal > 0.0) out->centre = v3_scale(1.0 / sum.normal, sum.weighted);
    if (survey) add_springs(q, wall, step.gap, &out->springs);
    note_speed(w, sum.fastest);
    return 0;
}
