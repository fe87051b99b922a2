/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "sphere/floating_batch.h"
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

int32_t fl_floating_run_end(const fl_world *w, int32_t k, int32_t to, int second)
{
    const int32_t *now = w->contact_sums.slot, *before = w->previous_sums.slot;
    while (k < to && w->b.is_isotropic[k] && !w->b.fixed_dof[k] && before[k] == 0 &&
           !(second && now[k] != 0) && !fl_body_absent(w, k) && !fl_floe_is_driven(w, k))
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
} sphere_rows;

#define LOAD(member, from)                                                                                   \
    do {                                                                                                     \
        q->member[0][k] = (from).x, q->member[1][k] = (from).y, q->member[2][k] = (from).z;                  \
    } while (0)
#define STORE(to, member) (to) = v3(q->member[0][k], q->member[1][k], q->member[2][k])

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
    for (int32_t k = 0; k < n; k++) {
        const int32_t i = from + k;
        LOAD(v, b->v[i]);
        LOAD(L, b->L[i]);
        LOAD(w, b->w[i]);
        LOAD(f, b->f[i]);
        LOAD(t, b->t[i]);
        q->m[k] = b->m[i], q->invm[k] = b->invm[i], q->turn[k] = b->invI[i].x;
        q->heave[k] = b->heave_mass ? b->heave_mass[i] : 0.0;
        q->up[k] = q->m[k] + q->heave[k];
        q->area[k] = w->sea.wetted_area[i], q->loss[k] = w->sea.drag_loss[i];
        q->r[k] = w->sea.drag_radius[i];
    }
    for (int32_t k = n; k < (n + 7) / 8 * 8; k++) { /* the last register is full */
        for (int e = 0; e < 3; e++) q->v[e][k] = q->L[e][k] = q->w[e][k] = q->f[e][k] = q->t[e][k] = 0.0;
        q->m[k] = q->invm[k] = q->turn[k] = q->up[k] = q->r[k] = q->fill[k] = 1.0;
        q->heave[k] = q->area[k] = q->loss[k] = q->z[k] = q->volume[k] = q->surface[k] = q->work[k] = 0.0;
    }
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

void fl_floating_batch_begin(fl_world *w, int32_t from, int32_t to, double h)
{
    fl_bodies *b = &w->b;
    sphere_rows rows, *const q = &rows;
    const int32_t n = to - from;
    const int full = (n + 7) / 8 * 8, heavy = b->heave_mass != NULL;
    const fl_sphere_drag d = drag_law_of(w, h);
    fl_vec3 v0[N], w0[N];
    load_motion(w, from, n, q);
    for (int32_t k = 0; k < n && w->drag_change; k++) v0[k] = b->v[from + k], w0[k] = b->w[from + k];
    decay_rows(q, full, d, heavy);
    for (int32_t k = 0; k < n; k++) {
        w->sea.drag_loss[from + k] = q->loss[k];
        if (!w->drag_change) continue;
        const fl_vec3 v = v3(q->v[0][k], q->v[1][k], q->v[2][k]), s = v3(q->w[0][k], q->w[1][k], q->w[2][k]);
        w->drag_change[from + k] = (fl_velocity_change){v3_sub(v, v0[k]), v3_sub(s, w0[k])};
    }
    kick_rows(q, full, h, heavy);
    for (int32_t k = 0; k < n; k++) {
        STORE(b->v[from + k], v);
        STORE(b->L[from + k], L);
        STORE(b->w[from + k], w);
    }
    fl_kick_drift_isotropic(b, from, to, 0.0, 2.0 * h);
}

/* Change of velocity by a kick. */
static fl_vec3 change_by(const sphere_rows *q, int k, double h, int heavy)
{
    const fl_vec3 f = v3(q->f[0][k], q->f[1][k], q->f[2][k]);
    return heavy ? v3_scale(h, v3(q->invm[k] * f.x, q->invm[k] * f.y, f.z / q->up[k]))
                 : v3_scale(h * q->invm[k], f);
}

static fl_vec3 turn_by(const sphere_rows *q, int k, double h)
{
    return v3_scale(h * q->turn[k], v3(q->t[0][k], q->t[1][k], q->t[2][k]));
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
    for (int32_t k = 0; k < n; k++) {
        const int32_t i = from + k;
        out->first_dv[k] = change_by(q, k, h, heavy), out->first_dw[k] = turn_by(q, k, h);
        q->z[k] = b->x[i].z;
        q->volume[k] = s->hull[i].volume, q->surface[k] = s->hull[i].surface_area;
        q->fill[k] = s->hull[i].fill;
        q->work[k] = heavy ? b->heave_work[i] : 0.0;
    }
    float_rows(q, full, s->level, s->specific_weight, heavy ? s->heave_factor : 0.0, s->gravity);
    for (int32_t k = 0; k < n; k++) {
        const int32_t i = from + k;
        const fl_vec3 own = v3_add(v3_scale(b->m[i], w->gravity), v3(0, 0, q->buoyancy[k]));
        fl_vec3 f = own, t = v3(0, 0, 0);
        if (w->spheres.bodies) fl_sphere_add_forces(w, i, &f, &t);
        fl_disc_list_add_forces(w, i, &f, &t);
        LOAD(f, f);
        LOAD(t, t);
        b->f[i] = f, b->t[i] = t;
        out->contact_force[k] = v3_sub(v3_madd(f, -b->m[i], w->gravity), v3(0, 0, q->buoyancy[k]));
        s->wetted_area[i] = q->area[k], s->buoyancy[i] = q->buoyancy[k];
        if (heavy) b->heave_mass[i] = q->heave[k], b->heave_work[i] = q->work[k];
        out->second_dv[k] = change_by(q, k, h, heavy), out->second_dw[k] = turn_by(q, k, h);
    }
    kick_rows(q, full, h, heavy);
    decay_rows(q, full, d, heavy);
    for (int32_t k = 0; k < n; k++) {
        s->drag_loss[from + k] = q->loss[k];
        STORE(b->v[from + k], v);
        STORE(b->L[from + k], L);
        STORE(b->w[from + k], w);
    }
}
