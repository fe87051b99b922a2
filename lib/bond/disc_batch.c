/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <assert.h>
#include <string.h>
#include "base/pi.h"
#include "bond/disc_batch.h"
#include "bond/disc_kernel.h"

/* A disc whose bound of lambda^2 is less stays whole: the bound is computed in some 40 operations. */
#define WHOLE_LIMIT (1.0 - 1e-9)

/* Rows of a class. */
enum { LENGTH, KN, RATIO, RADIUS, SHARE, DAMPING, WEAKENING };
static_assert(sizeof(fl_disc_class) == FL_DISC_CLASS_NUMBERS * sizeof(double), "consecutive doubles");

enum { OUTPUT = 9 };
static_assert(sizeof(fl_disc_wrench) == OUTPUT * sizeof(double), "consecutive doubles");

/* Numbers of the discs of a batch, a row for each: position and velocity of j from i, spins, what the class
 * has, forces, the memory after the step, 1 for those that are done, and |F|. */
typedef struct {
    double a[FL_DISC_BATCH];
} disc_row;
typedef struct {
    _Alignas(64) disc_row d[3], v[3], wi[3], wj[3];
    disc_row class[FL_DISC_CLASS_NUMBERS], scatter, whole;
    disc_row out[OUTPUT], S[3], M[3], force[3], couple[3], damped;
    disc_row done, size;
} disc_rows;

/* Stores four rows of three. */
FL_SIMD_INLINE void store_three(disc_row *row, int k, fl_simd r[FL_SIMD_WIDTH])
{
    fl_simd_transpose(r);
    FL_SIMD_UNROLL
    for (int c = 0; c < 3; c++) FL_SIMD_STORE(&row[c].a[k]) = r[c];
}

/* Rows of a_j - a_i and of a_j for four discs; vectors of bodies are followed by memory that may be read. */
FL_SIMD_INLINE void load_differences(disc_row *row, int k, const fl_vec3 *a, const int32_t *i,
                                     const int32_t *j)
{
    fl_simd r[FL_SIMD_WIDTH];
    FL_SIMD_UNROLL
    for (int l = 0; l < FL_SIMD_WIDTH; l++) r[l] = FL_SIMD_LOAD(&a[j[k + l]]) - FL_SIMD_LOAD(&a[i[k + l]]);
    store_three(row, k, r);
}

FL_SIMD_INLINE void load_vectors(disc_row *row, int k, const fl_vec3 *a, const int32_t *i)
{
    fl_simd r[FL_SIMD_WIDTH];
    FL_SIMD_UNROLL
    for (int l = 0; l < FL_SIMD_WIDTH; l++) r[l] = FL_SIMD_LOAD(&a[i[k + l]]);
    store_three(row, k, r);
}

FL_SIMD4_VERSIONS static void load_bodies(disc_rows *restrict t, const fl_bodies *restrict b,
                                          const int32_t *i, const int32_t *j, int n)
{
    for (int k = 0; k < n; k += FL_SIMD_WIDTH) {
        load_differences(t->d, k, b->x, i, j);
        load_differences(t->v, k, b->v, i, j);
        load_vectors(t->wi, k, b->w, i);
        load_vectors(t->wj, k, b->w, j);
    }
}

/* The arrays of fl_disc_arrays from the first disc of the batch on. */
typedef struct {
    double *S[3], *M[3], *force[3], *couple[3], *damped;
} memory_rows;

FL_SIMD_INLINE fl_vec3 row3(const disc_row *a, int64_t k) { return v3(a[0].a[k], a[1].a[k], a[2].a[k]); }
FL_SIMD_INLINE fl_vec3 memory3(const double *x, const double *y, const double *z, int64_t k)
{
    return v3(x[k], y[k], z[k]);
}
FL_SIMD_INLINE void set_row3(disc_row *a, int64_t k, fl_vec3 v)
{
    a[0].a[k] = v.x, a[1].a[k] = v.y, a[2].a[k] = v.z;
}

/* Number `row` of the class of disc k; of all discs if `one`. */
#define CLASS(member, row) (one ? all.member : t->class[row].a[k])

/* Evaluates n discs, a multiple of FL_LANE_COUNT; returns how many are not done. */
FL_SIMD_INLINE int evaluate_rows(disc_rows *restrict t, const memory_rows *restrict m,
                                 const fl_disc_law *restrict law, fl_disc_class all, double dt, int n,
                                 int damped, int one)
{
    const double beta = law->moment_factor,
                 per_area = one ? 1.0 / (PI * all.radius * all.radius * all.weakening) : 0.0,
                 all_lever = one ? beta / all.radius : 0.0, all_pull = per_area / law->tension,
                 all_cut = per_area / law->cohesion;
    const double *const S0 = m->S[0], *const S1 = m->S[1], *const S2 = m->S[2], *const M0 = m->M[0],
                        *const M1 = m->M[1], *const M2 = m->M[2], *const f0 = m->force[0],
                        *const f1 = m->force[1], *const f2 = m->force[2], *const c0 = m->couple[0],
                        *const c1 = m->couple[1], *const c2 = m->couple[2], *const used_up = m->damped;
    double left = 0.0;
#pragma omp simd reduction(+ : left)
    for (int64_t k = 0; k < (n & -FL_LANE_COUNT); k++) {
        const double kn = CLASS(kn, KN), ratio = CLASS(shear_ratio, RATIO), R = CLASS(radius, RADIUS),
                     share = CLASS(share, SHARE), damping = CLASS(damping, DAMPING), s = t->scatter.a[k],
                     own = one ? 0.0 : 1.0 / (PI * R * R * t->class[WEAKENING].a[k]),
                     lever = one ? all_lever : beta / R, pull = one ? all_pull : own / law->tension,
                     cut = one ? all_cut : own / law->cohesion;
        const fl_disc_motion q = fl_disc_motion_of(
            row3(t->d, k), v3(0.0, 0.0, 0.0), row3(t->v, k), row3(t->wi, k), row3(t->wj, k),
            memory3(S0, S1, S2, k), memory3(M0, M1, M2, k), CLASS(length, LENGTH), kn, ratio, R, share, dt);
        const double used = fl_disc_strength_bound(q, lever, pull, cut);
        const double on = used < WHOLE_LIMIT * s * s * t->whole.a[k] ? 1.0 : 0.0;
        fl_vec3 F = v3_madd(v3_scale(q.N, q.e), 1.0, q.S), M = q.M;
        if (damped) {
            const fl_vec3 drag = fl_disc_damping_force(q, kn, ratio, damping),
                          brake = fl_disc_damping_couple(q, kn, ratio, R, damping);
            const double more =
                0.5 * dt *
                fl_disc_power(q, v3_add(memory3(f0, f1, f2, k), drag), v3_add(memory3(c0, c1, c2, k), brake));
            t->damped.a[k] = used_up[k] + more;
            set_row3(t->force, k, drag);
            set_row3(t->couple, k, brake);
            F = v3_add(F, drag);
            M = v3_add(brake, M);
        }
        set_row3(t->S, k, q.S);
        set_row3(t->M, k, q.M);
        const fl_vec3 arm = v3_cross(q.e, F);
        set_row3(t->out, k, F);
        set_row3(t->out + 3, k, v3_madd(M, share * q.r, arm));
        set_row3(t->out + 6, k, v3_madd(v3_neg(M), (1.0 - share) * q.r, arm));
        t->done.a[k] = on;
        t->size.a[k] = on > 0.0 ? v3_norm(F) : 0.0;
        left += 1.0 - on;
    }
    return (int)left;
}

FL_SIMD_VERSIONS static int evaluate_elastic(disc_rows *restrict t, const memory_rows *restrict m,
                                             const fl_disc_law *restrict law,
                                             const fl_disc_class *restrict all, double dt, int n)
{
    return all ? evaluate_rows(t, m, law, *all, dt, n, 0, 1)
               : evaluate_rows(t, m, law, (fl_disc_class){0}, dt, n, 0, 0);
}

FL_SIMD_VERSIONS static int evaluate_damped(disc_rows *restrict t, const memory_rows *restrict m,
                                            const fl_disc_law *restrict law,
                                            const fl_disc_class *restrict all, double dt, int n)
{
    return all ? evaluate_rows(t, m, law, *all, dt, n, 1, 1)
               : evaluate_rows(t, m, law, (fl_disc_class){0}, dt, n, 1, 0);
}

/* Stores the forces of all n discs. */
FL_SIMD4_VERSIONS static void store_forces(const disc_rows *restrict t, fl_disc_wrench *restrict out, int n)
{
    for (int k = 0; k < n; k += FL_SIMD_WIDTH) {
        double *const to = (double *)(void *)&out[k];
        FL_SIMD_UNROLL
        for (int from = 0; from < OUTPUT - 1; from += FL_SIMD_WIDTH) {
            fl_simd r[FL_SIMD_WIDTH];
            FL_SIMD_UNROLL
            for (int c = 0; c < FL_SIMD_WIDTH; c++) r[c] = FL_SIMD_LOAD(&t->out[from + c].a[k]);
            fl_simd_transpose(r);
            FL_SIMD_UNROLL
            for (int l = 0; l < FL_SIMD_WIDTH; l++) FL_SIMD_STORE(to + OUTPUT * l + from) = r[l];
        }
        FL_SIMD_UNROLL
        for (int l = 0; l < FL_SIMD_WIDTH; l++) to[OUTPUT * l + OUTPUT - 1] = t->out[OUTPUT - 1].a[k + l];
    }
}

/* Copies the new memory of discs that are done. */
static void keep_row(double *restrict to, const disc_row *restrict from, const disc_row *restrict done, int n,
                     int all)
{
    if (all) memcpy(to, from->a, (size_t)n * sizeof *to);
    for (int k = 0; k < n && !all; k++)
        if (done->a[k] > 0.0) to[k] = from->a[k];
}

static void keep_memory(const disc_rows *restrict t, const memory_rows *restrict m, int n, int all)
{
    for (int e = 0; e < 3; e++) {
        keep_row(m->S[e], &t->S[e], &t->done, n, all);
        keep_row(m->M[e], &t->M[e], &t->done, n, all);
        if (!m->damped) continue;
        keep_row(m->force[e], &t->force[e], &t->done, n, all);
        keep_row(m->couple[e], &t->couple[e], &t->done, n, all);
    }
    if (m->damped) keep_row(m->damped, &t->damped, &t->done, n, all);
}

/* Rows of n numbers, a multiple of FL_LANE_COUNT; returns 1 if classes differ. */
FL_SIMD_VERSIONS static int load_numbers(disc_rows *restrict t, const uint16_t *restrict which,
                                         const uint8_t *restrict whole, const double *restrict scatter, int n)
{
    const uint16_t first = which[0];
    unsigned other = 0;
#pragma omp simd reduction(| : other)
    for (int k = 0; k < (n & -FL_LANE_COUNT); k++) other |= (unsigned)(which[k] ^ first);
#pragma omp simd
    for (int k = 0; k < (n & -FL_LANE_COUNT); k++) t->whole.a[k] = whole[k];
    if (scatter) {
#pragma omp simd
        for (int k = 0; k < (n & -FL_LANE_COUNT); k++) t->scatter.a[k] = scatter[k];
    } else {
#pragma omp simd
        for (int k = 0; k < (n & -FL_LANE_COUNT); k++) t->scatter.a[k] = 1.0;
    }
    return other != 0;
}

/* Loads what the discs have beside their memory; returns the class of all of them, NULL if they differ. */
static const fl_disc_class *load_discs(disc_rows *restrict t, const fl_disc_arrays *a, int32_t from, int n,
                                       const fl_disc_class *classes)
{
    const uint16_t *which = a->which + from;
    if (!load_numbers(t, which, a->is_whole + from, a->scatter ? a->scatter + from : NULL, n))
        return &classes[which[0]];
    for (int k = 0; k < n; k++) {
        const double *const number = fl_lane_column(&classes[which[k]]);
        for (int c = 0; c < FL_DISC_CLASS_NUMBERS; c++) t->class[c].a[k] = number[c];
    }
    return NULL;
}

int fl_disc_batch_force(const fl_disc_arrays *a, int32_t from, int n, const fl_disc_law *law,
                        const fl_disc_class *classes, const fl_bodies *b, const fl_vec3 *shift, double dt,
                        fl_disc_batch_result *out)
{
    disc_rows t;
    memory_rows m = {.damped = a->damped ? a->damped + from : NULL};
    for (int e = 0; e < 3; e++) {
        m.S[e] = a->S[e] + from, m.M[e] = a->M[e] + from;
        m.force[e] = a->damped ? a->damping_force[e] + from : NULL;
        m.couple[e] = a->damped ? a->damping_couple[e] + from : NULL;
    }
    const fl_disc_class *all = load_discs(&t, a, from, n, classes);
    load_bodies(&t, b, a->i + from, a->j + from, n);
    for (int k = 0; k < n && shift; k++) set_row3(t.d, k, v3_add(row3(t.d, k), shift[k]));
    const int left =
        a->damped ? evaluate_damped(&t, &m, law, all, dt, n) : evaluate_elastic(&t, &m, law, all, dt, n);
    store_forces(&t, a->out + from, n);
    keep_memory(&t, &m, n, left == 0);
    memcpy(out->size, t.size.a, (size_t)n * sizeof *out->size);
    for (int k = 0; k < n && left; k++) out->done[k] = t.done.a[k] > 0.0;
    return left;
}
