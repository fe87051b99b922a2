/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <string.h>
#include "base/array.h"
#include "body/integrate.h"
#include "structure/rigid_motion.h"

enum { ROTATIONS = FL_DOF_RX | FL_DOF_RY | FL_DOF_RZ, ALL_DOF = 63 };

int32_t fl_rigid_motions_add(fl_rigid_motions *v, fl_rigid_motion *m, fl_err *err)
{
    if (fl_grow(&v->motion, &v->cap, (int64_t)v->n + 1, sizeof *v->motion, err)) return -1;
    v->motion[v->n] = *m;
    *m = (fl_rigid_motion){0};
    return v->n++;
}

/* The prescribed motion at time t: displacement and rotation, their rates and second derivatives. */
static void prescribed_at(const fl_rigid_motion *m, double t, fl_pose6 *x, fl_pose6 *rate, fl_pose6 *second)
{
    if (m->track.n) {
        fl_track_evaluate(&m->track, t, x, rate, second);
        return;
    }
    *x = (fl_pose6){v3_scale(t, m->velocity), v3_scale(t, m->spin)};
    *rate = (fl_pose6){m->velocity, m->spin};
    *second = (fl_pose6){0};
}

/* Below this |r|^2 the series of the two quotients is exact to rounding: r^8 is left out. */
#define SMALL_TURN 1e-4

/* Angular velocity of exp(r(t)): w = r' + (1 - cos a)/a^2 r x r' + (a - sin a)/a^3 r x (r x r'), a = |r|.
 * Cosine and sine come from the quaternion of the rotation. */
static fl_vec3 angular_velocity(fl_vec3 r, fl_vec3 rate)
{
    const double a2 = v3_norm2(r);
    const fl_vec3 across = v3_cross(r, rate);
    double one = 0.5 - a2 * (1.0 / 24 - a2 * (1.0 / 720 - a2 / 40320)),
           two = 1.0 / 6 - a2 * (1.0 / 120 - a2 * (1.0 / 5040 - a2 / 362880));
    if (!v3_nonzero(across)) return rate;
    if (a2 > SMALL_TURN) {
        const fl_quat q = q_of_vector(r);
        const double s2 = q.x * q.x + q.y * q.y + q.z * q.z, a = sqrt(a2);
        const double sine = 2.0 * q.w * v3_dot(v3(q.x, q.y, q.z), r) / a;
        one = 2.0 * s2 / a2;
        two = (a - sine) / (a * a2);
    }
    return v3_add(v3_madd(rate, one, across), v3_scale(two, v3_cross(r, across)));
}

static void set_component(fl_vec3 *a, int k, double x)
{
    if (k == 0) a->x = x;
    else if (k == 1) a->y = x;
    else a->z = x;
}

/* Sets the prescribed components of a free mover's velocity; the constraint does work at the mean of old and
 * new velocity. */
static void set_prescribed_velocity(fl_rigid_motions *m, int32_t k, fl_vec3 v)
{
    fl_bodies *b = &m->b;
    const double before = b->added_mass ? fl_body_kinetic_energy(b, k) : 0.0;
    for (int c = 0; c < 3; c++) {
        const double old = v3_at(b->v[k], c), now = v3_at(v, c);
        if (!(b->fixed_dof[k] & (unsigned)(FL_DOF_X << c)) || old == now) continue;
        if (!b->added_mass) m->prescribed_work[k] += b->m[k] * (now - old) * 0.5 * (now + old);
        set_component(&b->v[k], c, now);
    }
    if (b->added_mass) m->prescribed_work[k] += fl_body_kinetic_energy(b, k) - before;
}

int fl_rigid_motions_start(fl_rigid_motions *v, double t, fl_err *err)
{
    const int32_t n = v->n;
    fl_bodies *b = &v->b;
    if (fl_bodies_alloc(b, n, n, err)) return -1;
    v->prescribed = fl_alloc(n, sizeof *v->prescribed, err);
    v->prescribed_velocity = fl_alloc(n, sizeof *v->prescribed_velocity, err);
    v->spring_force = fl_alloc(n, sizeof *v->spring_force, err);
    v->spring_torque = fl_alloc(n, sizeof *v->spring_torque, err);
    v->spring_energy = fl_alloc(n, sizeof *v->spring_energy, err);
    v->damper_loss = fl_alloc(n, sizeof *v->damper_loss, err);
    v->prescribed_work = fl_alloc(n, sizeof *v->prescribed_work, err);
    v->decay = fl_alloc(n, sizeof *v->decay, err);
    v->angular_decay = fl_alloc(n, sizeof *v->angular_decay, err);
    if (err->code) return -1;
    for (int32_t k = 0; k < n; k++)
        if (v3_nonzero(v->motion[k].added_mass) && !b->added_mass && fl_bodies_alloc_added_mass(b, err))
            return -1;
    for (int32_t k = 0; k < n; k++) {
        const fl_rigid_motion *m = &v->motion[k];
        fl_pose6 x, rate, second;
        if (b->added_mass) b->added_mass[k] = m->added_mass;
        prescribed_at(m, t, &x, &rate, &second);
        if (m->free_dof) {
            b->m[k] = m->mass > 0.0 ? m->mass : 1.0;
            b->invm[k] = 1.0 / b->m[k];
            b->fixed_dof[k] = (uint8_t)(ALL_DOF & ~m->free_dof);
            fl_body_set_inertia(b, k,
                                v3(m->inertia.x > 0.0 ? m->inertia.x : 1.0,
                                   m->inertia.y > 0.0 ? m->inertia.y : 1.0,
                                   m->inertia.z > 0.0 ? m->inertia.z : 1.0));
        }
        b->x[k] = v3_add(m->reference, x.x);
        b->q[k] = q_of_vector(x.r);
        b->v[k] = v->prescribed_velocity[k] = rate.x;
        b->w[k] = angular_velocity(x.r, rate.r);
        v->prescribed[k] = x.x;
    }
    return 0;
}

void fl_rigid_motions_set_step(fl_rigid_motions *v, double dt)
{
    for (int32_t k = 0; k < v->n; k++) {
        const fl_rigid_motion *m = &v->motion[k];
        if (m->modes) fl_modes_set_step(m->mode, m->modes, dt);
        const double h = 0.5 * dt, c[] = {m->c.x, m->c.y, m->c.z, m->ct.x, m->ct.y, m->ct.z};
        for (int i = 0; i < 3 && m->free_dof; i++) {
            set_component(&v->decay[k], i, exp(-c[i] * h / (v->b.m[k] + v3_at(m->added_mass, i))));
            set_component(&v->angular_decay[k], i, exp(-c[3 + i] * h / v3_at(v->b.I[k], i)));
        }
    }
}

/* Energy that the dampers take out of a velocity that was `old`, relative to the prescribed one, and the work
 * of that one. */
static void book_damping(fl_rigid_motions *v, int32_t k, fl_vec3 pull, fl_vec3 old, fl_vec3 now)
{
    const fl_bodies *b = &v->b;
    if (!b->added_mass) {
        v->damper_loss[k] += 0.5 * b->m[k] * (v3_norm2(old) - v3_norm2(now));
        v->prescribed_work[k] += b->m[k] * v3_dot(pull, v3_sub(now, old));
        return;
    }
    const fl_vec3 P = fl_body_momentum(b, k, old), Q = fl_body_momentum(b, k, now);
    v->damper_loss[k] += 0.5 * (v3_dot(old, P) - v3_dot(now, Q));
    v->prescribed_work[k] += v3_dot(pull, v3_sub(Q, P));
}

static void apply_dampers(fl_rigid_motions *v, int32_t k)
{
    fl_bodies *b = &v->b;
    const fl_rigid_motion *m = &v->motion[k];
    if (m->modes) {
        fl_modes_damp(m->mode, m->modes);
        b->v[k] = fl_modes_velocity(m->mode, m->modes);
        return;
    }
    if (m->free_dof && v3_nonzero(m->c)) {
        const fl_vec3 pull = v->prescribed_velocity[k], old = v3_sub(b->v[k], pull), f = v->decay[k];
        const unsigned hold = b->fixed_dof[k];
        const fl_vec3 now = v3(hold & FL_DOF_X ? old.x : f.x * old.x, hold & FL_DOF_Y ? old.y : f.y * old.y,
                               hold & FL_DOF_Z ? old.z : f.z * old.z);
        book_damping(v, k, pull, old, now);
        b->v[k] = v3_add(pull, now);
    }
    if (m->free_dof & ROTATIONS && v3_nonzero(m->ct)) {
        const double before = v3_dot(b->w[k], b->L[k]);
        const fl_mat3 R = fl_body_axes(b, k);
        const fl_vec3 own = m3_tmul(R, b->L[k]), f = v->angular_decay[k], w = b->w[k];
        b->L[k] = m3_mul(R, v3(f.x * own.x, f.y * own.y, f.z * own.z));
        b->w[k] = fl_body_apply_inverse_inertia(b, k, b->L[k]);
        if (b->fixed_dof[k] & ROTATIONS) fl_body_apply_fixed_dof(b, k, b->v[k], w);
        v->damper_loss[k] += 0.5 * (before - v3_dot(b->w[k], b->L[k]));
    }
}

void fl_rigid_motion_damp(fl_rigid_motions *v, int32_t k, double h)
{
    apply_dampers(v, k);
    if (fl_floating_hulls_has(&v->hulls, k)) fl_floating_hull_drag(&v->hulls, &v->b, k, h);
}

static void kick_motion(fl_rigid_motions *v, int32_t k, double h)
{
    const fl_rigid_motion *m = &v->motion[k];
    if (m->modes) {
        fl_modes_kick(m->mode, m->modes, h);
        v->b.v[k] = fl_modes_velocity(m->mode, m->modes);
        return;
    }
    const fl_vec3 v0 = v->b.v[k], w0 = v->b.w[k];
    fl_kick(&v->b, k, h);
    if (fl_floating_hulls_has(&v->hulls, k)) fl_floating_hull_add_work(&v->hulls, &v->b, k, h, v0, w0);
    v->prescribed_work[k] += h * v3_dot(v->spring_force[k], v->prescribed_velocity[k]);
}

/* Removes the rounding of x in the fixed directions, where it follows the prescribed displacement. */
static void reset_fixed_position(fl_rigid_motions *v, int32_t k)
{
    fl_bodies *b = &v->b;
    const fl_vec3 x = v3_add(v->motion[k].reference, v->prescribed[k]);
    for (int c = 0; c < 3; c++)
        if (b->fixed_dof[k] & (unsigned)(FL_DOF_X << c)) set_component(&b->x[k], c, v3_at(x, c));
}

void fl_rigid_motion_first_half(fl_rigid_motions *v, int32_t k, double t, double dt)
{
    fl_bodies *b = &v->b;
    const fl_rigid_motion *m = &v->motion[k];
    fl_pose6 x, rate, second;
    if (m->modes) {
        fl_modes_damp(m->mode, m->modes);
        kick_motion(v, k, 0.5 * dt);
        fl_modes_drift(m->mode, m->modes, dt);
        b->x[k] = v3_add(m->reference, fl_modes_displacement(m->mode, m->modes));
        return;
    }
    prescribed_at(m, t + dt, &x, &rate, &second);
    v->prescribed_velocity[k] = m->track.n ? v3_scale(1.0 / dt, v3_sub(x.x, v->prescribed[k])) : m->velocity;
    v->prescribed[k] = x.x;
    if (m->free_dof) {
        set_prescribed_velocity(v, k, v->prescribed_velocity[k]);
        if (fl_floating_hulls_has(&v->hulls, k)) fl_floating_hull_drag(&v->hulls, b, k, 0.5 * dt);
        apply_dampers(v, k);
        kick_motion(v, k, 0.5 * dt);
        fl_drift(b, k, dt);
        reset_fixed_position(v, k);
        return;
    }
    fl_pose6 middle;
    prescribed_at(m, t + 0.5 * dt, &middle, &rate, &second);
    b->x[k] = v3_add(m->reference, x.x);
    b->v[k] = v->prescribed_velocity[k];
    b->w[k] = angular_velocity(middle.r, rate.r);
    if (!v3_nonzero(x.r) && !v3_nonzero(b->w[k])) return;
    b->q[k] = q_of_vector(x.r);
}

void fl_rigid_motion_add_springs(fl_rigid_motions *v, int32_t k)
{
    fl_bodies *b = &v->b;
    const fl_rigid_motion *m = &v->motion[k];
    if (!m->free_dof) return;
    if (m->modes) { /* b.f becomes the force that gives b.m the acceleration */
        fl_modes_load(m->mode, m->modes, b->f[k]);
        b->f[k] = v3_scale(b->m[k], fl_modes_acceleration(m->mode, m->modes, 0));
        return;
    }
    const fl_vec3 u = v3_sub(v3_sub(b->x[k], m->reference), v->prescribed[k]),
                  q = v3(b->q[k].x, b->q[k].y, b->q[k].z);
    const double y[6] = {u.x, u.y, u.z, 2.0 * q.x, 2.0 * q.y, 2.0 * q.z};
    double g[6], W = 0.0;
    for (int r = 0; r < 6; r++) {
        g[r] = 0.0;
        for (int c = 0; c < 6; c++) g[r] += m->K[r][c] * y[c];
        W += 0.5 * y[r] * g[r];
    }
    const fl_vec3 turn = v3(g[3], g[4], g[5]);
    v->spring_energy[k] = W;
    v->spring_force[k] = v3(-g[0], -g[1], -g[2]);
    v->spring_torque[k] = v3_neg(v3_madd(v3_cross(q, turn), b->q[k].w, turn));
    b->f[k] = v3_add(b->f[k], v->spring_force[k]);
    b->t[k] = v3_add(b->t[k], v->spring_torque[k]);
    if (fl_floating_hulls_has(&v->hulls, k)) fl_floating_hull_force(&v->hulls, b, k);
}

void fl_rigid_motion_second_kick(fl_rigid_motions *v, int32_t k, double t, double h)
{
    fl_pose6 x, rate, second;
    if (v->motion[k].free_dof) {
        kick_motion(v, k, h);
        return;
    }
    prescribed_at(&v->motion[k], t, &x, &rate, &second);
    v->b.v[k] = rate.x;
    v->b.w[k] = angular_velocity(x.r, rate.r);
}

double fl_rigid_motion_spring_energy(const fl_rigid_motions *v, int32_t k)
{
    const fl_rigid_motion *m = &v->motion[k];
    double sum = v->spring_energy[k];
    for (int32_t j = 0; j < m->modes; j++) sum += m->mode[j].spring_energy;
    return sum;
}

double fl_rigid_motion_damper_loss(const fl_rigid_motions *v, int32_t k)
{
    const fl_rigid_motion *m = &v->motion[k];
    double sum = v->damper_loss[k];
    for (int32_t j = 0; j < m->modes; j++) sum += m->mode[j].damped;
    return sum;
}

double fl_rigid_motion_kinetic_energy(const fl_rigid_motions *v, int32_t k)
{
    const fl_rigid_motion *m = &v->motion[k];
    double sum = 0.0;
    for (int32_t j = 0; j < m->modes; j++) sum += fl_mode_kinetic_energy(&m->mode[j]);
    if (m->modes) return sum;
    return v->motion[k].free_dof ? fl_body_kinetic_energy(&v->b, k) : 0.0;
}

/* Half the interval of a central difference [s], for rates up to 1 rad/s.  Its truncation, of order 1e-8, and
 * the rounding that it magnifies, 1e-12, are both far below the accuracy of a table of motion. */
#define DIFFERENCE 1e-4

void fl_rigid_motion_acceleration(const fl_rigid_motions *v, int32_t k, double t, fl_vec3 *a, fl_vec3 *turn)
{
    const fl_bodies *b = &v->b;
    const fl_rigid_motion *m = &v->motion[k];
    fl_pose6 x, rate, second;
    if (m->modes) {
        *a = fl_modes_acceleration(m->mode, m->modes, 1);
        *turn = v3(0, 0, 0);
        return;
    }
    prescribed_at(m, t, &x, &rate, &second);
    *a = second.x;
    /* w changes with r'' directly, and with r along r': a central difference */
    if (!m->free_dof) {
        const double h = DIFFERENCE / (1.0 + v3_norm(rate.r));
        const fl_vec3 late = angular_velocity(v3_madd(x.r, h, rate.r), rate.r),
                      early = angular_velocity(v3_madd(x.r, -h, rate.r), rate.r);
        *turn = v3_madd(angular_velocity(x.r, second.r), 0.5 / h, v3_sub(late, early));
        return;
    }
    const fl_mat3 R = fl_body_axes(b, k);
    const fl_vec3 slip = v3_sub(b->v[k], v->prescribed_velocity[k]), own = m3_tmul(R, b->w[k]);
    const fl_vec3 drag = m3_mul(R, v3(m->ct.x * own.x, m->ct.y * own.y, m->ct.z * own.z));
    const fl_vec3 torque = v3_sub(v3_sub(b->t[k], drag), v3_cross(b->w[k], b->L[k]));
    *turn = m->free_dof & ROTATIONS ? fl_body_apply_inverse_inertia(b, k, torque) : v3(0, 0, 0);
    for (int c = 0; c < 3; c++) {
        const double force = v3_at(b->f[k], c) - v3_at(m->c, c) * v3_at(slip, c);
        if (m->free_dof >> c & 1u)
            set_component(a, c,
                          b->added_mass ? force / (b->m[k] + v3_at(m->added_mass, c)) : force * b->invm[k]);
        if (!(m->free_dof >> (3 + c) & 1u)) set_component(turn, c, 0.0);
    }
}

static double inertia_of(const fl_rigid_motion *m, int k)
{
    return k < 3 ? m->mass : k == 3 ? m->inertia.x : k == 4 ? m->inertia.y : m->inertia.z;
}

double fl_rigid_motion_max_omega2(const fl_rigid_motion *m)
{
    double most = 0.0;
    if (m->modes) return fl_modes_max_omega2(m->mode, m->modes);
    for (int r = 0; r < 6; r++) {
        double row = 0.0;
        for (int c = 0; c < 6; c++)
            if (m->free_dof >> r & m->free_dof >> c & 1u)
                row +=
                    (fabs(m->K[r][c]) + fabs(m->water_K[r][c])) / sqrt(inertia_of(m, r) * inertia_of(m, c));
        most = row > most ? row : most;
    }
    return most;
}

double fl_rigid_motion_compliance(const fl_rigid_motion *m, double arm)
{
    double turn = 0.0;
    if (m->modes) return fl_modes_compliance(m->mode, m->modes);
    for (int k = 3; k < 6; k++)
        if (m->free_dof >> k & 1u && 1.0 / inertia_of(m, k) > turn) turn = 1.0 / inertia_of(m, k);
    return (m->free_dof & 7u ? 1.0 / m->mass : 0.0) + arm * arm * turn;
}

void fl_rigid_motions_free(fl_rigid_motions *v)
{
    for (int32_t k = 0; k < v->n; k++) {
        fl_track_free(&v->motion[k].track);
        free(v->motion[k].mode);
    }
    free(v->motion), free(v->prescribed), free(v->prescribed_velocity), free(v->spring_force),
        free(v->spring_torque), free(v->spring_energy);
    free(v->damper_loss), free(v->prescribed_work), free(v->decay), free(v->angular_decay);
    fl_floating_hulls_free(&v->hulls);
    fl_bodies_free(&v->b);
    *v = (fl_rigid_motions){0};
}
