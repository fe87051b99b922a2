/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <assert.h>
#include "base/pi.h"
#include "bond/disc_batch.h"
#include "bond/disc_kernel.h"

/* A disc whose bound of lambda^2 is less stays whole: the bound is computed in some 40 operations. */
#define WHOLE_LIMIT (1.0 - 1e-9)

/* Rows of a class. */
enum { LENGTH, KN, RATIO, RADIUS, SHARE, DAMPING, WEAKENING };
static_assert(sizeof(fl_disc_class) == FL_DISC_CLASS_NUMBERS * sizeof(double), "consecutive doubles");

enum { OUTPUT = 9, ROWS = 12 };
static_assert(sizeof(fl_disc_wrench) == OUTPUT * sizeof(double), "consecutive doubles");

typedef struct {
    _Alignas(64) fl_lane xi[4], xj[4], vi[4], vj[4], wi[4], wj[4];
    fl_lane class[FL_DISC_CLASS_NUMBERS], shift[3], scatter, whole;
    fl_lane out[ROWS], done, size;
} disc_lanes;

FL_SIMD4_VERSIONS static void load_lanes(disc_lanes *restrict t, const double *const *class,
                                         const fl_bodies *restrict b, const int32_t *i, const int32_t *j)
{
    const double *of[6][FL_LANE_COUNT];
    for (int k = 0; k < FL_LANE_COUNT; k++) {
        of[0][k] = fl_lane_column(&b->x[i[k]]), of[1][k] = fl_lane_column(&b->x[j[k]]);
        of[2][k] = fl_lane_column(&b->v[i[k]]), of[3][k] = fl_lane_column(&b->v[j[k]]);
        of[4][k] = fl_lane_column(&b->w[i[k]]), of[5][k] = fl_lane_column(&b->w[j[k]]);
    }
    fl_lanes_load(t->xi, of[0], 4), fl_lanes_load(t->xj, of[1], 4);
    fl_lanes_load(t->vi, of[2], 4), fl_lanes_load(t->vj, of[3], 4);
    fl_lanes_load(t->wi, of[4], 4), fl_lanes_load(t->wj, of[5], 4);
    if (class[0]) fl_lanes_load(t->class, class, FL_DISC_CLASS_NUMBERS);
}

/* The arrays of fl_disc_arrays from the first disc of the batch on. */
typedef struct {
    double *S[3], *M[3], *force[3], *couple[3], *damped;
} memory_rows;

FL_SIMD_INLINE fl_vec3 row3(double *const *a, int k) { return v3(a[0][k], a[1][k], a[2][k]); }

FL_SIMD_INLINE void set_row3(double *const *a, int k, int on, fl_vec3 v)
{
    a[0][k] = on ? v.x : a[0][k], a[1][k] = on ? v.y : a[1][k], a[2][k] = on ? v.z : a[2][k];
}

/* Number `row` of the class of lane k; of all lanes if `one`. */
#define CLASS(member, row) (one ? all.member : c[row].a[k])

FL_SIMD_INLINE void evaluate_lanes(disc_lanes *restrict t, const memory_rows *restrict m,
                                   const fl_disc_law *restrict law, fl_disc_class all, double dt, int damped,
                                   int one)
{
    const fl_lane *c = t->class;
    const double beta = law->moment_factor,
                 per_area = one ? 1.0 / (PI * all.radius * all.radius * all.weakening) : 0.0,
                 all_lever = one ? beta / all.radius : 0.0, all_pull = per_area / law->tension,
                 all_cut = per_area / law->cohesion;
#pragma omp simd
    for (int k = 0; k < FL_LANE_COUNT; k++) {
        const double kn = CLASS(kn, KN), ratio = CLASS(shear_ratio, RATIO), R = CLASS(radius, RADIUS),
                     share = CLASS(share, SHARE), damping = CLASS(damping, DAMPING), s = t->scatter.a[k],
                     own = one ? 0.0 : 1.0 / (PI * R * R * c[WEAKENING].a[k]),
                     lever = one ? all_lever : beta / R, pull = one ? all_pull : own / law->tension,
                     cut = one ? all_cut : own / law->cohesion;
        const fl_vec3 d = v3_add(v3_sub(fl_lane3(t->xj, k), fl_lane3(t->xi, k)), fl_lane3(t->shift, k));
        const fl_disc_motion q = fl_disc_motion_of(
            d, fl_lane3(t->vi, k), fl_lane3(t->vj, k), fl_lane3(t->wi, k), fl_lane3(t->wj, k), row3(m->S, k),
            row3(m->M, k), CLASS(length, LENGTH), kn, ratio, R, share, dt);
        const double used = fl_disc_strength_bound(q, lever, pull, cut);
        const int on = t->whole.a[k] > 0.0 && used < WHOLE_LIMIT * s * s;
        fl_vec3 F = v3_madd(v3_scale(q.N, q.e), 1.0, q.S), M = q.M;
        if (damped) {
            const fl_vec3 drag = fl_disc_damping_force(q, kn, ratio, damping),
                          brake = fl_disc_damping_couple(q, kn, ratio, R, damping);
            const double more =
                0.5 * dt *
                fl_disc_power(q, v3_add(row3(m->force, k), drag), v3_add(row3(m->couple, k), brake));
            m->damped[k] += on ? more : 0.0;
            set_row3(m->force, k, on, drag);
            set_row3(m->couple, k, on, brake);
            F = v3_add(F, drag);
            M = v3_add(brake, M);
        }
        set_row3(m->S, k, on, q.S);
        set_row3(m->M, k, on, q.M);
        const fl_vec3 arm = v3_cross(q.e, F);
        fl_lane3_set(t->out, k, F);
        fl_lane3_set(t->out + 3, k, v3_madd(M, share * q.r, arm));
        fl_lane3_set(t->out + 6, k, v3_madd(v3_neg(M), (1.0 - share) * q.r, arm));
        t->done.a[k] = on ? 1.0 : 0.0;
        t->size.a[k] = on ? v3_norm(F) : 0.0;
    }
}

FL_SIMD_VERSIONS static void evaluate_elastic(disc_lanes *restrict t, const memory_rows *restrict m,
                                              const fl_disc_law *restrict law,
                                              const fl_disc_class *restrict all, double dt)
{
    if (all) evaluate_lanes(t, m, law, *all, dt, 0, 1);
    else evaluate_lanes(t, m, law, (fl_disc_class){0}, dt, 0, 0);
}

FL_SIMD_VERSIONS static void evaluate_damped(disc_lanes *restrict t, const memory_rows *restrict m,
                                             const fl_disc_law *restrict law,
                                             const fl_disc_class *restrict all, double dt)
{
    if (all) evaluate_lanes(t, m, law, *all, dt, 1, 1);
    else evaluate_lanes(t, m, law, (fl_disc_class){0}, dt, 1, 0);
}

/* Stores the forces of the discs that are done. */
FL_SIMD4_VERSIONS static void store_lanes(const disc_lanes *restrict t, fl_disc_wrench *restrict out)
{
    for (int k = 0; k < FL_LANE_COUNT; k += FL_SIMD_WIDTH) {
        double nowhere[ROWS], *to[FL_SIMD_WIDTH], *far[FL_SIMD_WIDTH];
        FL_SIMD_UNROLL
        for (int l = 0; l < FL_SIMD_WIDTH; l++) {
            to[l] = t->done.a[k + l] > 0.0 ? (double *)(void *)&out[k + l] : nowhere;
            far[l] = to[l] + FL_SIMD_WIDTH;
        }
        fl_lanes_store(to, t->out, k);
        fl_lanes_store(far, t->out + FL_SIMD_WIDTH, k);
        FL_SIMD_UNROLL
        for (int l = 0; l < FL_SIMD_WIDTH; l++) to[l][OUTPUT - 1] = t->out[OUTPUT - 1].a[k + l];
    }
}

double fl_disc_batch_force(const fl_disc_arrays *a, int32_t from, const fl_disc_law *law,
                           const fl_disc_class *classes, const fl_bodies *b, const fl_vec3 *shift, double dt,
                           uint8_t done[FL_LANE_COUNT])
{
    disc_lanes t;
    const double *class[FL_LANE_COUNT];
    memory_rows m = {.damped = a->damped ? a->damped + from : NULL};
    double sum = 0.0;
    for (int e = 0; e < 3; e++) {
        m.S[e] = a->S[e] + from, m.M[e] = a->M[e] + from;
        m.force[e] = a->damped ? a->damping_force[e] + from : NULL;
        m.couple[e] = a->damped ? a->damping_couple[e] + from : NULL;
    }
    int same = 1; /* class of all lanes */
    for (int k = 1; k < FL_LANE_COUNT; k++) same &= a->which[from + k] == a->which[from];
    const fl_disc_class *all = same ? &classes[a->which[from]] : NULL;
    for (int k = 0; k < FL_LANE_COUNT; k++) {
        class[k] = all ? NULL : fl_lane_column(&classes[a->which[from + k]]);
        fl_lane3_set(t.shift, k, shift ? shift[k] : v3(0, 0, 0));
        t.scatter.a[k] = a->scatter ? a->scatter[from + k] : 1.0;
        t.whole.a[k] = a->is_whole[from + k] ? 1.0 : 0.0;
    }
    load_lanes(&t, class, b, a->i + from, a->j + from);
    if (a->damped) evaluate_damped(&t, &m, law, all, dt);
    else evaluate_elastic(&t, &m, law, all, dt);
    store_lanes(&t, a->out + from);
    for (int k = 0; k < FL_LANE_COUNT; k++) done[k] = t.done.a[k] > 0.0, sum += t.size.a[k];
    return sum;
}
