/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "contact/strip_contact.h"
#include <stdlib.h>
#include <string.h>
#include "base/simd.h"
#include "contact/pair_response.h"
#include "contact/strip_dent.h"
#include "failure/strip_lanes.h"

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

/* The three arrays of a vector from element k on. */
static inline void set_vector(fl_strip *q, int column, int32_t k, fl_vec3 v)
{
    fl_strip_column(q, column)[k] = v.x;
    fl_strip_column(q, column + 1)[k] = v.y;
    fl_strip_column(q, column + 2)[k] = v.z;
}

static inline fl_vec3 vector_of(fl_strip *q, int column, int32_t k)
{
    return v3(fl_strip_column(q, column)[k], fl_strip_column(q, column + 1)[k],
              fl_strip_column(q, column + 2)[k]);
}

void fl_strip_place(fl_strip *q, const fl_wall *wall, int32_t k)
{
    const fl_wall_sector *s = &wall->sector[k];
    const fl_vec3 x = v3_madd(s->x, fl_strip_column(q, FL_STRIP_MIDDLE)[k], s->up);
    set_vector(q, FL_STRIP_CENTRE, k, x);
    set_vector(q, FL_STRIP_ARM, k, v3_cross(x, s->n));
}

fl_strip *fl_strip_make(const fl_wall *wall)
{
    const int32_t lanes = (wall->n + FL_SIMD_WIDTH - 1) / FL_SIMD_WIDTH * FL_SIMD_WIDTH;
    const size_t numbers = (size_t)FL_STRIP_COLUMNS * (size_t)lanes;
    fl_strip *q = calloc(1, sizeof *q + numbers * sizeof *q->data + (size_t)lanes * sizeof *q->count);
    if (!q) return NULL;
    q->n = wall->n, q->lanes = lanes, q->strength.node = -1, q->known_until = -1.0;
    q->count = (int32_t *)(void *)(q->data + numbers);
    for (int32_t k = 0; k < q->n; k++) {
        set_vector(q, FL_STRIP_NORMAL, k, wall->sector[k].n);
        fl_strip_place(q, wall, k);
    }
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
        double *const area = &fl_strip_column(q, FL_STRIP_AREA)[k], before = *area;
        *area = sector_area(&planes, &wall->sector[k], &fl_strip_column(q, FL_STRIP_MIDDLE)[k], &room);
        room = fmin(room, KNOWN_SHARE * wall->sector[k].width);
        fl_strip_place(q, wall, k);
        if (*area != before) q->near_known = 0;
        if (before > 0.0 && *area == 0.0 && w->scene->failure.wear)
            fl_strip_leave(q, wall, r, k, w->strips.law.peak_ratio * w->strips.law.delta);
        if (before > 0.0 || *area == 0.0) continue;
        const fl_strip_id id = id_of(w, p, k); /* it enters */
        fl_strip_column(q, FL_STRIP_U)[k] = 0.0;
        fl_strip_column(q, FL_STRIP_E)[k] =
            -fl_strip_gap(&w->strips.law, fl_rng_entity4(id.floe, id.region, id.sector, q->count[k])) -
            fl_strip_missing_ice(w, p, r, k);
        fl_strip_column(q, FL_STRIP_LEFT)[k] = 0.0;
    }
    q->known_until = now + room;
}

/* Velocity of the ice against the wall at x, frame of the piece: base + spin x x. */
typedef struct {
    fl_vec3 base, spin;
    int turns; /* spin is not 0 */
} wall_motion;

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
    double *const e = fl_strip_column(q, FL_STRIP_E), *const u = fl_strip_column(q, FL_STRIP_U),
                  *const old_e = fl_strip_column(q, FL_STRIP_OLD_E),
                  *const old_u = fl_strip_column(q, FL_STRIP_OLD_U),
                  *const area = fl_strip_column(q, FL_STRIP_AREA);
    memcpy(old_e, e, (size_t)q->n * sizeof *e);
    memcpy(old_u, u, (size_t)q->n * sizeof *u);
    for (int32_t k = 0; k < q->n; k++) {
        const fl_wall_sector *s = &wall->sector[k];
        const double slid = v3_dot(s->along, v3_add(q->slid, v3_cross(q->turned, s->x)));
        const int32_t from = slid > 0.0 ? s->left : s->right;
        if (area[k] == 0.0 || slid == 0.0 || from < 0 || area[from] == 0.0) continue;
        const double part = fmin(1.0, fabs(slid) / s->width);
        e[k] -= part * (old_e[k] - old_e[from]);
        u[k] -= part * (old_u[k] - old_u[from]);
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
    const double *e = fl_strip_column(q, FL_STRIP_E), *area = fl_strip_column(q, FL_STRIP_AREA);
    double seen = 0.0, before = q->largest_area;
    q->near_area = v3(0, 0, 0);
    for (int32_t k = 0; k < q->n; k++) {
        if (!(area[k] > 0.0) || !(e[k] > least)) continue;
        const double facing = v3_dot(wall->sector[k].n, d);
        q->near_area = v3_madd(q->near_area, area[k], wall->sector[k].n);
        if (facing > 0.0) seen += area[k] * facing;
    }
    q->largest_area = fmax(q->largest_area, fmax(v3_norm(q->near_area), seen));
    if (q->largest_area > before) q->pressure = 0.0;
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
    if (q->pressure == 0.0) q->pressure = fl_crushing_pressure(&s->pressure, q->largest_area);
    double k = s->law.peak_ratio * q->pressure / s->law.delta;
    if (s->scatter > 0.0)
        k *= fl_strip_strength_at(&q->strength, &s->law, s->scatter, s->scatter_length, q->farthest,
                                  w->id[p->i], p->j - w->n);
    return k;
}

/* Adds the springs of the sectors that touch the ice, or may soon. */
static void add_springs(fl_strip *q, double gap, fl_spring_sums *sum)
{
    const double *e = fl_strip_column(q, FL_STRIP_E), *area = fl_strip_column(q, FL_STRIP_AREA);
    for (int32_t j = 0; j < q->n; j++) {
        if (!(area[j] > 0.0) || e[j] < -gap) continue;
        const fl_vec3 n = vector_of(q, FL_STRIP_NORMAL, j), arm = vector_of(q, FL_STRIP_ARM, j);
        const double k = q->k * area[j], N[3] = {n.x, n.y, n.z}, M[3] = {arm.x, arm.y, arm.z};
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

/* What the elements of a step add up to, frame of the piece. */
typedef struct {
    fl_vec3 force, moment, weighted; /* sum of f, of x x f, and of |f| x */
    double normal, stiffness, depth, work, store, fastest;
    int32_t breaks, touching, crossing; /* crossing: some came near the wall or left it */
} strip_sums;

/* The same, lane by lane. */
typedef struct {
    fl_simd force[3], moment[3], weighted[3], normal, stiffness, depth, work, store, fastest;
    fl_simd_mask touching, crossing;
    int32_t breaks;
} lane_sums;

FL_SIMD_INLINE void load_vectors(fl_strip *q, int column, int32_t j, fl_simd v[3])
{
    FL_SIMD_UNROLL
    for (int c = 0; c < 3; c++) v[c] = FL_SIMD_LOAD(fl_strip_column(q, column + c) + j);
}

/* Breaks the elements of the lanes of `breaks`, whose wall is `rest` further on. */
static int32_t break_lanes(const fl_strip_law *law, fl_strip *q, int32_t j, const fl_simd_mask *breaks,
                           const fl_simd *rest, fl_strip_id id)
{
    int32_t before = 0, after = 0;
    for (int32_t k = j; k < j + FL_SIMD_WIDTH; k++) {
        if (!(*breaks)[k - j]) continue;
        fl_strip_element one = {0.0, 0.0, q->count[k]};
        id.sector = k;
        before += one.count;
        fl_strip_break(law, &one, (*rest)[k - j], id);
        fl_strip_column(q, FL_STRIP_E)[k] = one.e;
        fl_strip_column(q, FL_STRIP_U)[k] = one.u;
        after += q->count[k] = one.count;
    }
    return after - before;
}

/* Adds what four elements with the loads f and the stiffnesses k press. */
FL_SIMD_INLINE void add_loads(fl_strip *q, int32_t j, const fl_simd *f, const fl_simd *k, const fl_simd n[3],
                              const fl_simd arm[3], lane_sums *sum)
{
    fl_simd x[3];
    load_vectors(q, FL_STRIP_CENTRE, j, x);
    FL_SIMD_UNROLL
    for (int c = 0; c < 3; c++) {
        sum->force[c] += *f * n[c];
        sum->moment[c] += *f * arm[c];
        sum->weighted[c] += *f * x[c];
    }
    sum->normal += *f;
    sum->stiffness += FL_SIMD_MASKED(*f > 0.0, *k);
}

/* Advances the four elements from j on; those that stay in a gap are done with it at once. */
FL_SIMD_INLINE void advance_four(fl_strip *q, const fl_strip_step *step, const wall_motion *v, double dt,
                                 double least, int32_t j, fl_strip_id id, lane_sums *sum)
{
    double *const at_e = fl_strip_column(q, FL_STRIP_E) + j, *const at_u = fl_strip_column(q, FL_STRIP_U) + j,
                  *const at_load = fl_strip_column(q, FL_STRIP_LOAD) + j;
    const fl_simd area = FL_SIMD_LOAD(fl_strip_column(q, FL_STRIP_AREA) + j), load = FL_SIMD_LOAD(at_load),
                  stiff = q->k * area;
    const fl_simd_mask in = area > 0.0, loaded = load > 0.0, used = in | loaded;
    if (!fl_simd_any(&used)) return;
    fl_simd e = FL_SIMD_LOAD(at_e), u = FL_SIMD_LOAD(at_u), n[3], arm[3], z, rest;
    const fl_simd before = e;
    load_vectors(q, FL_STRIP_NORMAL, j, n);
    load_vectors(q, FL_STRIP_ARM, j, arm);
    fl_simd speed = n[0] * v->base.x + n[1] * v->base.y + n[2] * v->base.z;
    if (v->turns) speed += arm[0] * v->spin.x + arm[1] * v->spin.y + arm[2] * v->spin.z;
    const fl_simd dq = -dt * speed, ahead = e + dq, closes = FL_SIMD_MASKED(in, dq);
    const fl_simd_mask live = (in & ((u != 0.0) | (ahead > 0.0))) | loaded;
    sum->touching |= in;
    sum->fastest = FL_SIMD_MAX(closes, sum->fastest);
    if (!fl_simd_any(&live)) {
        e = FL_SIMD_SELECT(in, ahead, e);
        FL_SIMD_STORE(at_e) = e;
        sum->crossing |= in & ((before > least) ^ (e > least));
        return;
    }
    fl_simd_mask breaks;
    fl_strip_lanes_advance(step, &in, &dq, &e, &u, &breaks, &rest);
    FL_SIMD_STORE(at_e) = e;
    FL_SIMD_STORE(at_u) = u;
    if (fl_simd_any(&breaks)) {
        sum->breaks += break_lanes(step->law, q, j, &breaks, &rest, id);
        e = FL_SIMD_LOAD(at_e), u = FL_SIMD_LOAD(at_u);
    }
    sum->crossing |= in & ((before > least) ^ (e > least));
    fl_strip_lanes_deflection(&e, &u, &z);
    z = FL_SIMD_MASKED(in, z);
    const fl_simd f = stiff * z;
    sum->store += stiff * (0.5 * (z * z + step->law->kappa * u * u));
    sum->work += 0.5 * (load + f) * dq; /* of a sector that has left the ice: of the last of its load */
    sum->depth = FL_SIMD_MAX(z, sum->depth);
    FL_SIMD_STORE(at_load) = f;
    add_loads(q, j, &f, &stiff, n, arm, sum);
}

static fl_vec3 sum_of_lanes(const fl_simd v[3])
{
    return v3(fl_simd_sum(&v[0]), fl_simd_sum(&v[1]), fl_simd_sum(&v[2]));
}

static double most_of_lanes(const fl_simd *a) { return fmax(fmax((*a)[0], (*a)[1]), fmax((*a)[2], (*a)[3])); }

/* Advances all elements by the step. */
FL_SIMD4_VERSIONS static void advance_elements(fl_strip *q, const fl_strip_step *step, const wall_motion *v,
                                               double dt, double least, fl_strip_id id, strip_sums *out)
{
    lane_sums sum = {.breaks = 0};
    for (int32_t j = 0; j < q->n; j += FL_SIMD_WIDTH) advance_four(q, step, v, dt, least, j, id, &sum);
    *out = (strip_sums){.force = sum_of_lanes(sum.force),
                        .moment = sum_of_lanes(sum.moment),
                        .weighted = sum_of_lanes(sum.weighted),
                        .normal = fl_simd_sum(&sum.normal),
                        .stiffness = fl_simd_sum(&sum.stiffness),
                        .depth = most_of_lanes(&sum.depth),
                        .work = fl_simd_sum(&sum.work),
                        .store = fl_simd_sum(&sum.store),
                        .fastest = most_of_lanes(&sum.fastest),
                        .breaks = sum.breaks,
                        .touching = fl_simd_any(&sum.touching),
                        .crossing = fl_simd_any(&sum.crossing)};
}

int fl_strip_contact_advance(fl_world *w, fl_pair *p, const fl_relative_pose *r, double dt, int survey,
                             fl_strip_result *out)
{
    const fl_wall *wall = &w->strips.wall[p->j - w->n];
    *out = (fl_strip_result){0};
    if (!p->strip && !(p->strip = fl_strip_make(wall))) return -1;
    fl_strip *const q = p->strip;
    const wall_motion v = motion_of(w, p, r, dt);
    const fl_strip_step step = fl_strip_step_of(&w->strips.law, dt);
    update_areas(w, p, r, wall);
    transport(q, wall, &v, dt);
    q->k = stiffness_now(w, p, wall, &v, dt);
    strip_sums sum;
    advance_elements(q, &step, &v, dt, near_limit(w), id_of(w, p, 0), &sum);
    if (sum.crossing) q->near_known = 0;
    q->breaks = sum.breaks;
    q->work = sum.work - (sum.store - q->store);
    q->store = sum.store;
    out->force = (fl_wrench){sum.force, sum.moment};
    out->normal = sum.normal;
    out->slope = sum.stiffness;
    out->touches = sum.touching;
    q->apart = !sum.touching;
    out->max_depth = sum.depth;
    if (sum.normal > 0.0) out->centre = v3_scale(1.0 / sum.normal, sum.weighted);
    if (survey) add_springs(q, step.gap, &out->springs);
    note_speed(w, sum.fastest);
    return 0;
}
