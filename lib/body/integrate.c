/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/simd.h"
#include "body/held_sphere_kernel.h"
#include "body/integrate.h"
#include "body/sphere_motion_kernel.h"

fl_quat fl_drift_rotation(fl_quat q, fl_vec3 L, fl_vec3 invI, double dt, fl_vec3 *mean)
{
    const double less = invI.x - invI.y, more = invI.z - invI.y, a0 = 0.5 * dt * less, a2 = dt * more;
    fl_vec3 e = m3_col(q_matrix(q), 0);
    double l = v3_dot(e, L);
    const fl_vec3 first = v3_scale(l, e);
    if (a0 != 0.0) q = q_mul(q, q_about_axis(0, a0 * l));
    e = m3_col(q_matrix(q), 2);
    l = v3_dot(e, L);
    if (a2 != 0.0) q = q_mul(q, q_about_axis(2, a2 * l));
    q = q_mul(q_of_vector(v3_scale(dt * invI.y, L)), q);
    const fl_mat3 R = q_matrix(q);
    const fl_vec3 top = v3_madd(v3_scale(invI.y, L), 0.5 * more * l, v3_add(e, m3_col(R, 2)));
    e = m3_col(R, 0);
    l = v3_dot(e, L);
    if (a0 != 0.0) q = q_mul(q, q_about_axis(0, a0 * l));
    *mean = v3_madd(top, 0.5 * less, v3_madd(first, l, e));
    return fl_quat_renormalised(q);
}

void fl_kick(fl_bodies *b, int32_t i, double h)
{
    const fl_vec3 v0 = b->v[i], w0 = b->w[i];
    b->v[i] = b->added_mass || b->heave_mass ? v3_madd(v0, h, fl_body_velocity_of_momentum(b, i, b->f[i]))
                                             : v3_madd(v0, h * b->invm[i], b->f[i]);
    b->L[i] = v3_madd(b->L[i], h, b->t[i]);
    b->w[i] = fl_body_apply_inverse_inertia(b, i, b->L[i]);
    if (b->fixed_dof[i]) fl_body_apply_fixed_dof(b, i, v0, w0);
}

/* Solves the k x k system a x = y, k <= 3, with a symmetric and positive definite (Cholesky). */
static void solve_spd(int k, double a[3][3], const double *y, double *x)
{
    for (int i = 0; i < k; i++) {
        for (int j = 0; j <= i; j++) {
            double s = a[i][j];
            for (int l = 0; l < j; l++) s -= a[i][l] * a[j][l];
            a[i][j] = i == j ? sqrt(s) : s / a[j][j];
        }
    }
    for (int i = 0; i < k; i++) {
        x[i] = y[i];
        for (int l = 0; l < i; l++) x[i] -= a[i][l] * x[l];
        x[i] /= a[i][i];
    }
    for (int i = k - 1; i >= 0; i--) {
        for (int l = i + 1; l < k; l++) x[i] -= a[l][i] * x[l];
        x[i] /= a[i][i];
    }
}

/* The vector u with the given fixed components whose free components satisfy Y = A u; A is `diag` in the axes
 * of R. hold: bit r fixes world axis r. */
static fl_vec3 solve_free_dof(const fl_mat3 *R, fl_vec3 diag, unsigned hold, fl_vec3 given, fl_vec3 Y)
{
    double A[3][3], a[3][3], y[3], s[3], u[3];
    int free_axis[3], k = 0;
    if ((hold & 7) == 7) return given;
    for (int r = 0; r < 3; r++) {
        u[r] = hold & 1u << r ? v3_at(given, r) : 0.0;
        if (!(hold & 1u << r)) free_axis[k++] = r;
        for (int c = 0; c < 3; c++) {
            const double *ri = R->m[r], *rc = R->m[c];
            A[r][c] = ri[0] * diag.x * rc[0] + ri[1] * diag.y * rc[1] + ri[2] * diag.z * rc[2];
        }
    }
    for (int r = 0; r < k; r++) {
        const double *row = A[free_axis[r]];
        y[r] = v3_at(Y, free_axis[r]) - row[0] * u[0] - row[1] * u[1] - row[2] * u[2];
        for (int c = 0; c < k; c++) a[r][c] = row[free_axis[c]];
    }
    solve_spd(k, a, y, s);
    for (int r = 0; r < k; r++) u[free_axis[r]] = s[r];
    return v3(u[0], u[1], u[2]);
}

/* Angular velocity, or its change, of body i with the fixed components of w_held, at the angular momentum L.
 * The axes of a sphere do not count. */
static fl_vec3 spin_with_fixed_dof(const fl_bodies *b, int32_t i, unsigned hold, fl_vec3 w_held, fl_vec3 L)
{
    if (b->is_isotropic[i]) return fl_held_spin(hold, w_held, L, b->invI[i].x);
    const fl_mat3 R = fl_body_axes(b, i);
    return solve_free_dof(&R, b->I[i], hold / FL_DOF_RX, w_held, L);
}

/* Sets the fixed components of w as given, and the free ones from L. */
static void apply_fixed_rotation(fl_bodies *b, int32_t i, unsigned hold, fl_vec3 w_held)
{
    fl_body_set_spin(b, i, spin_with_fixed_dof(b, i, hold, w_held, b->L[i]));
}

/* Velocity of body i at momentum P, with its fixed components as given. */
static fl_vec3 velocity_with_fixed_dof(const fl_bodies *b, int32_t i, fl_vec3 v_held, fl_vec3 P)
{
    const unsigned hold = b->fixed_dof[i] & (FL_DOF_X | FL_DOF_Y | FL_DOF_Z);
    const fl_vec3 m = v3(b->m[i], b->m[i], b->m[i]);
    if (!hold) return fl_body_velocity_of_momentum(b, i, P);
    const fl_mat3 R = fl_body_axes(b, i);
    return solve_free_dof(&R, v3_add(m, b->added_mass[i]), hold, v_held, P);
}

/* Work of a constraint impulse. It acts along fixed axes only; other components are rounding. */
static double linear_constraint_work(unsigned hold, fl_vec3 impulse, fl_vec3 v)
{
    return (hold & FL_DOF_X ? impulse.x * v.x : 0.0) + (hold & FL_DOF_Y ? impulse.y * v.y : 0.0) +
           (hold & FL_DOF_Z ? impulse.z * v.z : 0.0);
}

/* A constraint of rotation acts between kicks too: with products of inertia, rotation about one axis needs a
 * torque about the others. It has no component about the free axes, so L keeps its free components and w its
 * fixed ones. Midpoint rule, order 2. */
static void drift_fixed_rotation(fl_bodies *b, int32_t i, double dt)
{
    const unsigned hold = b->fixed_dof[i];
    const fl_quat q = b->q[i];
    const fl_vec3 w = b->w[i], L = b->L[i];
    if (b->is_isotropic[i]) {
        fl_sphere_motion a = {b->v[i], L, w};
        b->q[i] = fl_held_turned(q, &a, hold, b->invI[i].x, b->I[i].x, dt, &b->work_of_constraints[i]);
        b->L[i] = a.L, b->w[i] = a.w;
        return;
    }
    b->q[i] = q_mul(q_of_vector(v3_scale(0.5 * dt, w)), q);
    apply_fixed_rotation(b, i, hold, w);
    b->q[i] = fl_quat_renormalised(q_mul(q_of_vector(v3_scale(dt, b->w[i])), q));
    b->L[i] = L;
    apply_fixed_rotation(b, i, hold, w);
    b->work_of_constraints[i] += fl_held_turning_work(hold, v3_sub(b->L[i], L), w);
}

/* Largest path of a point at distance 1 in the rotation from q to r: the chord 2 sin(angle/2). |w| dt is no
 * bound, since w changes within the step. */
static double chord_of_turn(fl_quat q, fl_quat r)
{
    const fl_quat d = q_mul(r, q_conj(q));
    return 2.0 * sqrt(d.x * d.x + d.y * d.y + d.z * d.z);
}

static void drift_rotation(fl_bodies *b, int32_t i, double dt)
{
    const fl_quat q = b->q[i];
    const int held = b->fixed_dof[i] & (FL_DOF_RX | FL_DOF_RY | FL_DOF_RZ);
    if (b->L[i].x == 0.0 && b->L[i].y == 0.0 && b->L[i].z == 0.0) {
        if (!held) b->w[i] = v3(0, 0, 0);
        return;
    }
    if (held) {
        drift_fixed_rotation(b, i, dt);
    } else if (b->is_isotropic[i]) { /* it turns about L, and no point of its core moves by that */
        b->q[i] = fl_sphere_turned(q, b->L[i], b->invI[i].x, dt);
        return;
    } else {
        b->q[i] = fl_drift_rotation(q, b->L[i], b->invI[i], dt, &b->w[i]);
    }
    b->odometer[i] += chord_of_turn(q, b->q[i]) * b->bounding_radius[i];
}

/* Half a translation, with Munk's moment; P is the momentum of the velocity u through the water. */
static void translate_with_water(fl_bodies *b, int32_t i, double h, fl_vec3 P)
{
    const unsigned hold = b->fixed_dof[i];
    const fl_vec3 v = b->v[i], w = b->w[i];
    b->x[i] = v3_madd(b->x[i], h, v);
    b->odometer[i] += fabs(h) * v3_norm(v);
    b->L[i] = v3_madd(b->L[i], h, v3_cross(P, v3_sub(v, b->flow_velocity[i])));
    b->w[i] = fl_body_apply_inverse_inertia(b, i, b->L[i]);
    if (hold & (FL_DOF_RX | FL_DOF_RY | FL_DOF_RZ)) {
        const fl_vec3 L = b->L[i];
        apply_fixed_rotation(b, i, hold, w);
        b->work_of_constraints[i] += fl_held_turning_work(hold, v3_sub(b->L[i], L), w);
    }
}

/* 1/2 U.M_a U */
static double flow_energy(const fl_bodies *b, int32_t i)
{
    const fl_vec3 u = m3_tmul(fl_body_axes(b, i), b->flow_velocity[i]);
    return 0.5 * v3_dot(u, v3_mul(b->added_mass[i], u));
}

static void drift_with_water(fl_bodies *b, int32_t i, double dt)
{
    const fl_vec3 U = b->flow_velocity[i], v = b->v[i];
    const double before = flow_energy(b, i);
    fl_vec3 P = fl_body_momentum(b, i, v3_sub(v, U));
    translate_with_water(b, i, 0.5 * dt, P);
    drift_rotation(b, i, dt);
    const fl_vec3 mean = b->w[i];
    b->v[i] = v3_add(U, velocity_with_fixed_dof(b, i, v3_sub(v, U), P));
    if (b->fixed_dof[i]) {
        const fl_vec3 now = fl_body_momentum(b, i, v3_sub(b->v[i], U));
        b->work_of_constraints[i] += linear_constraint_work(b->fixed_dof[i], v3_sub(now, P), v);
        P = now;
    }
    b->flow_work[i] += flow_energy(b, i) - before;
    translate_with_water(b, i, 0.5 * dt, P);
    if (!(b->fixed_dof[i] & (FL_DOF_RX | FL_DOF_RY | FL_DOF_RZ))) b->w[i] = mean;
}

void fl_drift(fl_bodies *b, int32_t i, double dt)
{
    if (b->added_mass && i < b->n) {
        drift_with_water(b, i, dt);
        return;
    }
    b->x[i] = v3_madd(b->x[i], dt, b->v[i]);
    b->odometer[i] += fabs(dt) * v3_norm(b->v[i]);
    drift_rotation(b, i, dt);
}

void fl_body_accelerations(const fl_bodies *b, int32_t i, fl_vec3 *a, fl_vec3 *turn)
{
    const unsigned hold = b->fixed_dof[i];
    const fl_vec3 rest = v3(0, 0, 0);
    if (b->added_mass) {
        *a = velocity_with_fixed_dof(b, i, rest, b->f[i]);
    } else {
        *a = fl_body_velocity_of_momentum(b, i, b->f[i]);
        if (hold & FL_DOF_X) a->x = 0.0;
        if (hold & FL_DOF_Y) a->y = 0.0;
        if (hold & FL_DOF_Z) a->z = 0.0;
    }
    if (!(hold & (FL_DOF_RX | FL_DOF_RY | FL_DOF_RZ))) {
        *turn = fl_body_apply_inverse_inertia(b, i, b->t[i]);
        return;
    }
    *turn = spin_with_fixed_dof(b, i, hold, rest, b->t[i]);
}

/* --- isotropic bodies, four at a time ---------------------------------------------------------- */

/* Arrays from the first body of the run on. */
typedef struct {
    const double *invm;
    const fl_vec3 *invI, *f, *t;
    fl_vec3 *v, *L, *w, *x;
    fl_quat *q;
    double *odometer;
} isotropic_run;

#define NORM2(a) (a[0] * a[0] + a[1] * a[1] + a[2] * a[2])

/* q_versine() and q_sinc() of four lanes. */
FL_SIMD_INLINE void versine_and_sinc(const fl_simd *x2, fl_simd *versine, fl_simd *sinc)
{
    const fl_simd x = *x2, v = x * (1.0 / 2 - x * (1.0 / 24 - x * (1.0 / 720))),
                  f = 1.0 - x * (1.0 / 6 - x * (1.0 / 120 - x * (1.0 / 5040)));
    const fl_simd_mask few = x <= Q_HALF_ANGLE2_SMALL;
    *versine = v, *sinc = f;
    if (few[0] & few[1] & few[2] & few[3]) return;
    fl_simd cosine = 1.0 / 479001600 - x * (1.0 / 87178291200.0);
    fl_simd sine = 1.0 / 39916800 - x * (1.0 / 6227020800.0);
    cosine = 1.0 / 3628800 - x * cosine, sine = 1.0 / 362880 - x * sine;
    cosine = 1.0 / 40320 - x * cosine, sine = 1.0 / 5040 - x * sine;
    cosine = 1.0 / 720 - x * cosine, sine = 1.0 / 120 - x * sine;
    cosine = 1.0 / 24 - x * cosine, sine = 1.0 / 6 - x * sine;
    cosine = x * (1.0 / 2 - x * cosine), sine = 1.0 - x * sine;
    *versine = FL_SIMD_SELECT(few, v, cosine), *sinc = FL_SIMD_SELECT(few, f, sine);
}

/* Kick, if `kicks`, and drift of the four bodies from k on. Returns 0, without the drift, if one turns beyond
 * the range of the series. */
FL_SIMD_INLINE int kick_drift_four(const isotropic_run *a, int32_t k, double h, double dt, int kicks)
{
    fl_simd ease[3], f[3], t[3], v[3], L[3], w[3], r[3], x[3], q[4];
    fl_simd_from_triples(ease, &a->invI[k]);
    fl_simd_from_triples(v, &a->v[k]);
    fl_simd_from_triples(L, &a->L[k]);
    if (kicks) {
        const fl_simd s = h * FL_SIMD_LOAD(&a->invm[k]);
        fl_simd_from_triples(f, &a->f[k]);
        fl_simd_from_triples(t, &a->t[k]);
        FL_SIMD_UNROLL for (int c = 0; c < 3; c++)
        {
            v[c] += s * f[c];
            L[c] += h * t[c];
            w[c] = ease[0] * L[c];
        }
        fl_simd_to_triples(&a->v[k], v);
        fl_simd_to_triples(&a->L[k], L);
        fl_simd_to_triples(&a->w[k], w);
    }
    if (dt == 0.0) return 1;
    const fl_simd turns = dt * ease[0];
    FL_SIMD_UNROLL for (int c = 0; c < 3; c++) r[c] = turns * L[c];
    const fl_simd half2 = 0.25 * NORM2(r), room = Q_HALF_ANGLE2_MAX - half2;
    const fl_simd_mask known = room >= 0.0;
    if (!(known[0] & known[1] & known[2] & known[3])) return 0;
    fl_simd cosine, sine;
    versine_and_sinc(&half2, &cosine, &sine);
    const fl_simd c = 1.0 - cosine, d = 0.5 * sine, hx = d * r[0], hy = d * r[1], hz = d * r[2];
    FL_SIMD_UNROLL for (int l = 0; l < FL_SIMD_WIDTH; l++) q[l] = FL_SIMD_LOAD(&a->q[k + l]);
    fl_simd_transpose(q);
    const fl_simd qw = q[0], qx = q[1], qy = q[2], qz = q[3];
    q[0] = c * qw - hx * qx - hy * qy - hz * qz;
    q[1] = c * qx + hx * qw + hy * qz - hz * qy;
    q[2] = c * qy - hx * qz + hy * qw + hz * qx;
    q[3] = c * qz + hx * qy - hy * qx + hz * qw;
    const fl_simd one = 1.5 - 0.5 * (q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    FL_SIMD_UNROLL for (int l = 0; l < FL_SIMD_WIDTH; l++) q[l] *= one;
    fl_simd_transpose(q);
    FL_SIMD_UNROLL for (int l = 0; l < FL_SIMD_WIDTH; l++)
    {
        if (L[0][l] != 0.0 || L[1][l] != 0.0 || L[2][l] != 0.0) FL_SIMD_STORE(&a->q[k + l]) = q[l];
    }
    const fl_simd speed2 = NORM2(v);
    fl_simd_from_triples(x, &a->x[k]);
    FL_SIMD_UNROLL for (int axis = 0; axis < 3; axis++) x[axis] += dt * v[axis];
    fl_simd_to_triples(&a->x[k], x);
    FL_SIMD_UNROLL for (int l = 0; l < FL_SIMD_WIDTH; l++) a->odometer[k + l] += fabs(dt) * sqrt(speed2[l]);
    return 1;
}

/* Runs until four bodies turn beyond the series: returns the first of those four, kicked and not drifted, or
 * n. n is a multiple of four. */
FL_SIMD4_VERSIONS static int32_t kick_drift_run(const isotropic_run *restrict a, int32_t from, int32_t n,
                                                double h, double dt)
{
    for (int32_t k = from; k < n; k += FL_SIMD_WIDTH)
        if (!kick_drift_four(a, k, h, dt, 1)) return k;
    return n;
}

FL_SIMD4_VERSIONS static int32_t drift_run(const isotropic_run *restrict a, int32_t from, int32_t n,
                                           double dt)
{
    for (int32_t k = from; k < n; k += FL_SIMD_WIDTH)
        if (!kick_drift_four(a, k, 0.0, dt, 0)) return k;
    return n;
}

static isotropic_run run_from(const fl_bodies *b, int32_t from)
{
    return (isotropic_run){b->invm + from, b->invI + from, b->f + from, b->t + from, b->v + from,
                           b->L + from,    b->w + from,    b->x + from, b->q + from, b->odometer + from};
}

void fl_kick_drift_isotropic(fl_bodies *b, int32_t from, int32_t to, double h, double dt)
{
    const int32_t n = to - from, four = n - n % FL_SIMD_WIDTH;
    const isotropic_run a = run_from(b, from);
    for (int32_t k = 0; k < four;) {
        const int32_t wild = kick_drift_run(&a, k, four, h, dt);
        for (k = wild; k < four && k < wild + FL_SIMD_WIDTH; k++) fl_drift(b, from + k, dt);
    }
    for (int32_t k = four; k < n; k++) {
        fl_kick(b, from + k, h);
        if (dt != 0.0) fl_drift(b, from + k, dt);
    }
}

void fl_drift_isotropic(fl_bodies *b, int32_t from, int32_t to, double dt)
{
    const int32_t n = to - from, four = n - n % FL_SIMD_WIDTH;
    const isotropic_run a = run_from(b, from);
    for (int32_t k = 0; k < four;) {
        const int32_t wild = drift_run(&a, k, four, dt);
        for (k = wild; k < four && k < wild + FL_SIMD_WIDTH; k++) fl_drift(b, from + k, dt);
    }
    for (int32_t k = four; k < n; k++) fl_drift(b, from + k, dt);
}

/* The matrix from Y to u of solve_free_dof() with the fixed components zero. */
static fl_sym3 free_inverse(const fl_mat3 *R, fl_vec3 diag, unsigned hold)
{
    const fl_vec3 none = v3(0, 0, 0), x = solve_free_dof(R, diag, hold, none, v3(1, 0, 0)),
                  y = solve_free_dof(R, diag, hold, none, v3(0, 1, 0)),
                  z = solve_free_dof(R, diag, hold, none, v3(0, 0, 1));
    return (fl_sym3){x.x, x.y, x.z, y.y, y.z, z.z};
}

fl_mobility fl_body_mobility(const fl_bodies *b, int32_t i)
{
    fl_mobility e = {.linear = s3_isotropic(0.0), .angular = s3_isotropic(0.0)};
    if (i >= b->n) return e;
    const unsigned stands = fl_body_fixed_translations(b, i), turns = b->fixed_dof[i] / FL_DOF_RX;
    const fl_mat3 R = fl_body_axes(b, i);
    e.angular = !turns               ? s3_from_principal(&R, b->invI[i])
                : b->is_isotropic[i] ? fl_held_inverse_inertia(b->fixed_dof[i], b->I[i].x)
                                     : free_inverse(&R, b->I[i], turns);
    if (b->added_mass) {
        const fl_vec3 m = v3_add(v3(b->m[i], b->m[i], b->m[i]), b->added_mass[i]);
        e.linear =
            stands ? free_inverse(&R, m, stands) : s3_from_principal(&R, v3(1.0 / m.x, 1.0 / m.y, 1.0 / m.z));
    } else {
        const double each = b->invm[i], up = b->heave_mass ? 1.0 / (b->m[i] + b->heave_mass[i]) : each;
        e.linear = (fl_sym3){.xx = stands & FL_DOF_X ? 0.0 : each,
                             .yy = stands & FL_DOF_Y ? 0.0 : each,
                             .zz = stands & FL_DOF_Z ? 0.0 : up};
    }
    return e;
}

void fl_body_apply_fixed_dof(fl_bodies *b, int32_t i, fl_vec3 v_held, fl_vec3 w_held)
{
    const unsigned hold = b->fixed_dof[i];
    const fl_vec3 v = b->v[i], L = b->L[i];
    if (b->added_mass) {
        const fl_vec3 P = fl_body_momentum(b, i, v);
        b->v[i] = velocity_with_fixed_dof(b, i, v_held, P);
        if (hold & (FL_DOF_RX | FL_DOF_RY | FL_DOF_RZ)) apply_fixed_rotation(b, i, hold, w_held);
        b->work_of_constraints[i] +=
            linear_constraint_work(hold, v3_sub(fl_body_momentum(b, i, b->v[i]), P), v_held) +
            fl_held_turning_work(hold, v3_sub(b->L[i], L), w_held);
        return;
    }
    if (b->is_isotropic[i]) {
        const fl_sphere_motion a = fl_held_motion((fl_sphere_motion){v, L, b->w[i]}, hold, v_held, w_held,
                                                  b->m[i], b->heave_mass ? b->heave_mass[i] : 0.0,
                                                  b->invI[i].x, b->I[i].x, &b->work_of_constraints[i]);
        b->v[i] = a.v, b->L[i] = a.L, b->w[i] = a.w;
        return;
    }
    b->v[i] = fl_held_components(hold, v_held, v);
    if (hold & FL_DOF_TURNS) apply_fixed_rotation(b, i, hold, w_held);
    const fl_vec3 change = v3_sub(b->v[i], v);
    const double rising = b->heave_mass ? b->heave_mass[i] * change.z * v_held.z : 0.0;
    b->work_of_constraints[i] +=
        b->m[i] * v3_dot(change, v_held) + rising + fl_held_turning_work(hold, v3_sub(b->L[i], L), w_held);
}
