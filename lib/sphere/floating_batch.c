/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "sphere/floating_batch.h"
#include <string.h>
#include "base/simd.h"
#include "body/integrate.h"
#include "contact/disc_list.h"
#include "sphere/contact_list.h"
#include "water/sphere_water_kernel.h"
#include "world/access.h"

int fl_floating_batch_applies(const fl_world *w)
{
    const fl_environment *s = &w->sea;
    return w->discs.n && s->water && s->only_spheres && !s->waves && !s->wind && !s->flow_velocity &&
           !s->drag_surface && !s->impulses && !w->b.added_mass && !w->sleep.state &&
           !w->contact_sums.one_each && !w->previous_sums.one_each;
}

/* True if the bytes of the eight bodies from k on are all those of `value`. */
static int eight_are(const uint8_t *a, int32_t k, uint64_t value)
{
    uint64_t eight;
    memcpy(&eight, &a[k], sizeof eight);
    return eight == value;
}

static int eight_slots_are(const int32_t *a, int32_t k, int32_t value)
{
    int32_t other = 0;
    for (int32_t i = k; i < k + 8; i++) other |= a[i] ^ value;
    return other == 0;
}

/* True if sphere i touches spheres, now or before: works of its contacts need the changes by both kicks. */
static int needs_changes(const fl_world *w, int32_t i)
{
    return w->spheres.bodies && (w->spheres.contact_count[i] | w->spheres.previous_contact_count[i]);
}

int32_t fl_floating_run_end(const fl_world *w, int32_t k, int32_t to, int second)
{
    const int32_t *now = w->contact_sums.slot, *before = w->previous_sums.slot;
    const uint8_t *absent = w->inflow.absent, *fixed = w->b.fixed_dof;
    const uint64_t all = 0x0101010101010101;
    while (k + 8 <= to && eight_are(w->b.is_isotropic, k, all) && (!second || eight_are(fixed, k, 0)) &&
           eight_slots_are(before, k, 0) && !(second && !eight_slots_are(now, k, 0)) &&
           (!absent || eight_are(absent, k, 0)))
        k += 8;
    while (k < to && w->b.is_isotropic[k] && before[k] == 0 && !(second && now[k] != 0) &&
           !(second && fixed[k] && needs_changes(w, k)) && !fl_body_absent(w, k))
        k++;
    return k;
}

enum { N = FL_BODY_BLOCK };

/* Numbers of the spheres of a block, an array for each. */
typedef struct {
    _Alignas(64) double v[3][N], L[3][N], w[3][N], f[3][N], t[3][N];
    double m[N], invm[N], turn[N], up[N]; /* turn: 1/I; up: mass along the vertical */
    double area[N], loss[N];
    double z[N], r[N], volume[N], surface[N], fill[N], buoyancy[N], heave[N], work[N];
    double hold[6][N], turns_held[N], I[N], held_work[N]; /* of blocks with fixed degrees of freedom: 1 for a
                                                           * fixed one, 1 if a rotation is; work of them,
                                                           * 0 for a free sphere */
} sphere_rows;

/* Vectors of n bodies as three rows, and back. */
FL_SIMD4_VERSIONS static void load_rows(double (*restrict row)[N], const fl_vec3 *restrict a, int32_t n)
{
    int32_t k = 0;
    for (; k + FL_SIMD_WIDTH <= n; k += FL_SIMD_WIDTH) {
        fl_simd v[3];
        fl_simd_from_triples(v, &a[k]);
        FL_SIMD_STORE(&row[0][k]) = v[0], FL_SIMD_STORE(&row[1][k]) = v[1], FL_SIMD_STORE(&row[2][k]) = v[2];
    }
    for (; k < n; k++) row[0][k] = a[k].x, row[1][k] = a[k].y, row[2][k] = a[k].z;
}

FL_SIMD4_VERSIONS static void store_rows(fl_vec3 *restrict a, double (*restrict row)[N], int32_t n)
{
    int32_t k = 0;
    for (; k + FL_SIMD_WIDTH <= n; k += FL_SIMD_WIDTH) {
        const fl_simd v[3] = {FL_SIMD_LOAD(&row[0][k]), FL_SIMD_LOAD(&row[1][k]), FL_SIMD_LOAD(&row[2][k])};
        fl_simd_to_triples(&a[k], v);
    }
    for (; k < n; k++) a[k] = v3(row[0][k], row[1][k], row[2][k]);
}

static void copy_row(double *restrict to, const double *restrict from, int32_t n)
{
    memcpy(to, from, (size_t)n * sizeof *to);
}

static fl_sphere_drag drag_law_of(const fl_world *w, double h)
{
    const fl_fluid *s = &w->sea.seawater;
    const fl_vec3 c = w->sea.current.velocity;
    return (fl_sphere_drag){0.5 * s->force_coefficient * s->density, 0.5 * s->moment_coefficient * s->density,
                            h, c, s->moment_coefficient > 0.0 ? 1.0 : 0.0};
}

static void load_motion(const fl_world *w, int32_t from, int32_t n, sphere_rows *q)
{
    const fl_bodies *b = &w->b;
    load_rows(q->v, b->v + from, n);
    load_rows(q->L, b->L + from, n);
    load_rows(q->w, b->w + from, n);
    copy_row(q->m, b->m + from, n);
    copy_row(q->invm, b->invm + from, n);
    copy_row(q->area, w->sea.wetted_area + from, n);
    copy_row(q->loss, w->sea.drag_loss + from, n);
    copy_row(q->r, w->sea.drag_radius + from, n);
    for (int32_t k = 0; k < n; k++) q->turn[k] = b->invI[from + k].x;
    for (int32_t k = 0; k < n; k++) q->heave[k] = b->heave_mass ? b->heave_mass[from + k] : 0.0;
    for (int32_t k = 0; k < n; k++) q->up[k] = q->m[k] + q->heave[k];
    for (int32_t k = n; k < (n + 7) / 8 * 8; k++) { /* the last register is full */
        for (int e = 0; e < 3; e++) q->v[e][k] = q->L[e][k] = q->w[e][k] = q->f[e][k] = q->t[e][k] = 0.0;
        q->m[k] = q->invm[k] = q->turn[k] = q->up[k] = q->r[k] = q->fill[k] = 1.0;
        q->heave[k] = q->area[k] = q->loss[k] = q->z[k] = q->volume[k] = q->surface[k] = q->work[k] = 0.0;
    }
}

/* Loads the fixed degrees of freedom; returns 0 if there are none, and loads nothing. */
static int load_fixed(const fl_bodies *b, int32_t from, int32_t n, sphere_rows *q)
{
    const uint8_t *fixed = b->fixed_dof + from;
    unsigned any = 0;
    for (int32_t k = 0; k < n; k++) any |= fixed[k];
    if (!any) return 0;
    for (int e = 0; e < 6; e++)
        for (int32_t k = 0; k < N; k++) q->hold[e][k] = k < n && fixed[k] >> e & 1 ? 1.0 : 0.0;
    for (int32_t k = 0; k < N; k++) {
        q->turns_held[k] = q->hold[3][k] + q->hold[4][k] + q->hold[5][k];
        q->I[k] = k < n ? b->I[from + k].x : 1.0;
        q->held_work[k] = k < n && fixed[k] ? b->work_of_constraints[from + k] : 0.0;
    }
    return 1;
}

static void store_held_work(fl_bodies *b, int32_t from, int32_t n, const sphere_rows *q)
{
    for (int32_t k = 0; k < n; k++)
        if (b->fixed_dof[from + k]) b->work_of_constraints[from + k] = q->held_work[k];
}

static void store_motion(fl_bodies *b, int32_t from, int32_t n, sphere_rows *q)
{
    store_rows(b->v + from, q->v, n);
    store_rows(b->L + from, q->L, n);
    store_rows(b->w + from, q->w, n);
}

#define ROW(member) v3(q->member[0][k], q->member[1][k], q->member[2][k])
#define SET_ROW(member, a) (q->member[0][k] = (a).x, q->member[1][k] = (a).y, q->member[2][k] = (a).z)

FL_SIMD_INLINE fl_sphere_motion motion_of_lane(const sphere_rows *q, int k)
{
    return (fl_sphere_motion){ROW(v), ROW(L), ROW(w)};
}

FL_SIMD_INLINE void set_motion_of_lane(sphere_rows *restrict q, int k, fl_sphere_motion a)
{
    SET_ROW(v, a.v);
    SET_ROW(L, a.L);
    SET_ROW(w, a.w);
}

FL_SIMD_INLINE void decay_lane(sphere_rows *restrict q, int k, fl_sphere_drag d, int heavy)
{
    double lost;
    const fl_sphere_motion a =
        fl_sphere_decay(motion_of_lane(q, k), q->m[k], q->up[k], q->area[k], q->r[k], d, heavy, &lost);
    q->loss[k] = q->loss[k] - lost;
    set_motion_of_lane(q, k, a);
}

FL_SIMD_INLINE void kick_lane(sphere_rows *restrict q, int k, double h, int heavy)
{
    set_motion_of_lane(
        q, k,
        fl_sphere_kick(motion_of_lane(q, k), ROW(f), ROW(t), h, q->invm[k], q->turn[k], q->up[k], heavy));
}

/* The product of the unit matrix with a: its sums turn -0 into 0. */
FL_SIMD_INLINE fl_vec3 level_axes_times(fl_vec3 a)
{
    return m3_mul((fl_mat3){{{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}}}, a);
}

FL_SIMD_INLINE double held_power(const sphere_rows *q, int k, int from, fl_vec3 impulse, fl_vec3 u)
{
    return (q->hold[from][k] > 0.0 ? impulse.x * u.x : 0.0) +
           (q->hold[from + 1][k] > 0.0 ? impulse.y * u.y : 0.0) +
           (q->hold[from + 2][k] > 0.0 ? impulse.z * u.z : 0.0);
}

#define HELD(e, held, own) (q->hold[e][k] > 0.0 ? (held) : (own))

/* fl_body_apply_fixed_dof() of a sphere where `on`; `was`: its motion before the kick or the drag. */
FL_SIMD_INLINE void hold_lane(sphere_rows *restrict q, int k, fl_sphere_motion was, int on)
{
    const fl_sphere_motion a = motion_of_lane(q, k);
    const fl_vec3 v = v3(HELD(0, was.v.x, a.v.x), HELD(1, was.v.y, a.v.y), HELD(2, was.v.z, a.v.z)),
                  own = v3_scale(q->turn[k], a.L),
                  w = v3(HELD(3, was.w.x, own.x), HELD(4, was.w.y, own.y), HELD(5, was.w.z, own.z)),
                  s = level_axes_times(w),
                  L = level_axes_times(v3(q->I[k] * s.x, q->I[k] * s.y, q->I[k] * s.z));
    const int turns = on & (q->turns_held[k] > 0.0);
    const fl_sphere_motion c = {v3(on ? v.x : a.v.x, on ? v.y : a.v.y, on ? v.z : a.v.z),
                                v3(turns ? L.x : a.L.x, turns ? L.y : a.L.y, turns ? L.z : a.L.z),
                                v3(turns ? w.x : a.w.x, turns ? w.y : a.w.y, turns ? w.z : a.w.z)};
    const fl_vec3 change = v3_sub(c.v, a.v);
    const double rising = q->heave[k] * change.z * was.v.z,
                 work =
                     q->m[k] * v3_dot(change, was.v) + rising + held_power(q, k, 3, v3_sub(c.L, a.L), was.w);
    q->held_work[k] += on ? work : 0.0;
    set_motion_of_lane(q, k, c);
}

/* A sphere in a block with fixed degrees of freedom. */
FL_SIMD_INLINE int lane_is_held(const sphere_rows *q, int k)
{
    return (q->hold[0][k] + q->hold[1][k] + q->hold[2][k] + q->turns_held[k]) > 0.0;
}

FL_SIMD_INLINE double lane_energy(const sphere_rows *q, int k, int heavy)
{
    return fl_sphere_kinetic(q->m[k], q->up[k], ROW(v), v3_dot(ROW(w), ROW(L)), heavy) - q->held_work[k];
}

FL_SIMD_INLINE void decay_held_lane(sphere_rows *restrict q, int k, fl_sphere_drag d, int heavy)
{
    double lost;
    const int wet = q->area[k] > 0.0;
    const fl_sphere_motion was = motion_of_lane(q, k);
    const double before = lane_energy(q, k, heavy);
    set_motion_of_lane(q, k, fl_sphere_decay(was, q->m[k], q->up[k], q->area[k], q->r[k], d, heavy, &lost));
    hold_lane(q, k, was, wet & lane_is_held(q, k));
    lost = lane_energy(q, k, heavy) - before;
    q->loss[k] = q->loss[k] - (wet ? lost : 0.0);
}

FL_SIMD_VERSIONS static void decay_held_rows(sphere_rows *restrict q, int n, fl_sphere_drag d, int heavy)
{
#pragma omp simd
    for (int k = 0; k < n; k++) decay_held_lane(q, k, d, heavy);
}

FL_SIMD_VERSIONS static void kick_held_rows(sphere_rows *restrict q, int n, double h, int heavy)
{
#pragma omp simd
    for (int k = 0; k < n; k++) {
        const fl_sphere_motion was = motion_of_lane(q, k);
        kick_lane(q, k, h, heavy);
        hold_lane(q, k, was, lane_is_held(q, k));
    }
}

FL_SIMD_VERSIONS static void decay_rows(sphere_rows *restrict q, int n, fl_sphere_drag d, int heavy)
{
    if (heavy) {
#pragma omp simd
        for (int k = 0; k < n; k++) decay_lane(q, k, d, 1);
    } else {
#pragma omp simd
        for (int k = 0; k < n; k++) decay_lane(q, k, d, 0);
    }
}

FL_SIMD_VERSIONS static void kick_rows(sphere_rows *restrict q, int n, double h, int heavy)
{
    if (heavy) {
#pragma omp simd
        for (int k = 0; k < n; k++) kick_lane(q, k, h, 1);
    } else {
#pragma omp simd
        for (int k = 0; k < n; k++) kick_lane(q, k, h, 0);
    }
}

/* Cap of each sphere below the water, as fl_environment_force(); its added mass, and the work of its change.
 */
FL_SIMD_VERSIONS static void float_rows(sphere_rows *restrict q, int n, double level, double weight,
                                        double heave_factor, double gravity)
{
#pragma omp simd
    for (int k = 0; k < n; k++) {
        const fl_sphere_float wet =
            fl_sphere_floats(q->z[k], q->r[k], q->fill[k], q->volume[k], q->surface[k], level, weight);
        const double B = wet.buoyancy;
        q->area[k] = wet.area;
        q->buoyancy[k] = B;
        const double now = heave_factor * (B / gravity), change = now - q->heave[k];
        q->work[k] += 0.5 * change * q->v[2][k] * q->v[2][k];
        q->heave[k] = now;
        q->up[k] = q->m[k] + now;
    }
}

/* Drift; a sphere with a fixed rotation turns alone. */
static void drift(fl_bodies *b, int32_t from, int32_t to, double dt, int held)
{
    const int turns = FL_DOF_RX | FL_DOF_RY | FL_DOF_RZ;
    for (int32_t k = from, end; k < to; k = end) {
        end = held ? k : to;
        while (end < to && !(b->fixed_dof[end] & turns)) end++;
        if (end > k) fl_drift_isotropic(b, k, end, dt);
        else fl_drift(b, end++, dt);
    }
}

void fl_floating_batch_begin(fl_world *w, int32_t from, int32_t to, double h)
{
    fl_bodies *b = &w->b;
    sphere_rows rows, *const q = &rows;
    const int32_t n = to - from;
    const int full = (n + 7) / 8 * 8, heavy = b->heave_mass != NULL;
    const fl_sphere_drag d = drag_law_of(w, h);
    load_motion(w, from, n, q);
    const int held = load_fixed(b, from, n, q);
    load_rows(q->f, b->f + from, n);
    load_rows(q->t, b->t + from, n);
    if (held) decay_held_rows(q, full, d, heavy);
    else decay_rows(q, full, d, heavy);
    copy_row(w->sea.drag_loss + from, q->loss, n);
    for (int32_t k = 0; k < n && w->drag_change; k++)
        w->drag_change[from + k] =
            (fl_velocity_change){v3_sub(ROW(v), b->v[from + k]), v3_sub(ROW(w), b->w[from + k])};
    if (held) kick_held_rows(q, full, h, heavy), store_held_work(b, from, n, q);
    else kick_rows(q, full, h, heavy);
    store_motion(b, from, n, q);
    drift(b, from, to, 2.0 * h, held);
}

/* Change of velocity by a kick of the force f. */
static fl_vec3 change_by(const sphere_rows *q, int32_t k, fl_vec3 f, double h, int heavy)
{
    return heavy ? v3_scale(h, v3(q->invm[k] * f.x, q->invm[k] * f.y, f.z / q->up[k]))
                 : v3_scale(h * q->invm[k], f);
}

/* Volume and surface of the spheres, and what they stand for; equal radii have equal ones. */
static void load_hulls(const fl_environment *s, int32_t from, int32_t n, sphere_rows *q)
{
    for (int32_t k = 0; k < n; k++) {
        if (k && q->r[k] == q->r[k - 1]) {
            q->volume[k] = q->volume[k - 1], q->surface[k] = q->surface[k - 1], q->fill[k] = q->fill[k - 1];
            continue;
        }
        const fl_hull *hull = &s->hull[from + k];
        q->volume[k] = hull->volume, q->surface[k] = hull->surface_area, q->fill[k] = hull->fill;
    }
}

/* Weight, buoyancy, springs of driven floes, contacts and bonds, into f and t. */
static void sum_forces(const fl_world *w, int32_t from, int32_t n, const sphere_rows *q, fl_vec3 *f,
                       fl_vec3 *t)
{
    const fl_vec3 none = v3(0, 0, 0);
    for (int32_t k = 0; k < n; k++) {
        f[k] = v3_add(v3_scale(q->m[k], w->gravity), v3(0, 0, q->buoyancy[k])), t[k] = none;
        if (w->driven_floes.n) f[k].z -= fl_driven_floe_force(w, from + k);
        if (needs_changes(w, from + k)) fl_sphere_add_forces(w, from + k, &f[k], &t[k]);
    }
    fl_disc_list_add_forces_of(w, from, from + n, f, t);
}

void fl_floating_batch_end(fl_world *w, int32_t from, int32_t to, double h, fl_floating_result *out)
{
    fl_bodies *b = &w->b;
    fl_environment *s = &w->sea;
    sphere_rows rows, *const q = &rows;
    const int32_t n = to - from;
    const int full = (n + 7) / 8 * 8, heavy = b->heave_mass != NULL;
    const fl_sphere_drag d = drag_law_of(w, h);
    load_motion(w, from, n, q);
    const int held = load_fixed(b, from, n, q);
    for (int32_t k = 0; k < n; k++) {
        const int32_t i = from + k;
        q->z[k] = b->x[i].z;
        q->work[k] = heavy ? b->heave_work[i] : 0.0;
        if (!needs_changes(w, i)) continue;
        out->first_dv[k] = change_by(q, k, b->f[i], h, heavy);
        out->first_dw[k] = v3_scale(h * q->turn[k], b->t[i]);
    }
    load_hulls(s, from, n, q);
    float_rows(q, full, s->level, s->specific_weight, heavy ? s->heave_factor : 0.0, s->gravity);
    sum_forces(w, from, n, q, b->f + from, b->t + from);
    load_rows(q->f, b->f + from, n);
    load_rows(q->t, b->t + from, n);
    for (int32_t k = 0; k < n; k++) {
        const int32_t i = from + k;
        fl_vec3 f = ROW(f);
        if (w->driven_floes.n) f.z += fl_driven_floe_force(w, i);
        out->contact_force[k] = v3_sub(v3_madd(f, -q->m[k], w->gravity), v3(0, 0, q->buoyancy[k]));
        if (!needs_changes(w, i)) continue;
        out->second_dv[k] = change_by(q, k, b->f[i], h, heavy);
        out->second_dw[k] = v3_scale(h * q->turn[k], b->t[i]);
    }
    copy_row(s->wetted_area + from, q->area, n);
    copy_row(s->buoyancy + from, q->buoyancy, n);
    if (heavy) copy_row(b->heave_mass + from, q->heave, n), copy_row(b->heave_work + from, q->work, n);
    if (held) {
        kick_held_rows(q, full, h, heavy);
        decay_held_rows(q, full, d, heavy);
        store_held_work(b, from, n, q);
    } else {
        kick_rows(q, full, h, heavy);
        decay_rows(q, full, d, heavy);
    }
    copy_row(s->drag_loss + from, q->loss, n);
    store_motion(b, from, n, q);
}
