/* SPDX-License-Identifier: GPL-3.0-or-later */
/* gpu_step_kernel.h -- what one thread of a device does in a step of spheres: a row, a bond, a body.  The
 * launchers (gpu_serial.c, cuda.cu) call each function for k = 0 .. n - 1, in any order; a function writes
 * only what belongs to k.
 *
 * The arithmetic is that of the loops of the CPU, from the same headers (*_kernel.h of law, bond, body and
 * water), and each sum has the order of the CPU:
 *     a body   rows of its chunk of which it is the j, its own, its walls, rows of chunks before; then its
 *              bonds as i, and as j
 *     a block  its 32 bodies;  a chunk  its touching rows by 16 in four lanes, then its walls by 24
 * so that the state of a run has the bits of the CPU path. */
#ifndef FL_GPU_GPU_STEP_KERNEL_H
#define FL_GPU_GPU_STEP_KERNEL_H
#include "body/domain_kernel.h"
#include "gpu/gpu_near_kernel.h"

/* --- bodies, first half ---------------------------------------------------------------------------- */

/* Mean change of velocities by the forces of the start, as fl_sphere_states_update(). */
static inline void fl_gpu_show(const fl_gpu_view *a, int32_t k, fl_vec3 x, fl_sphere_motion now,
                               fl_sphere_motion dragged, fl_sphere_motion before, double h)
{
    const double invm = a->invm[k], turn = a->turn[k], r = a->state[k].r;
    const fl_vec3 f = a->f[k];
    const fl_vec3 acceleration =
        a->heave_mass ? v3(invm * f.x, invm * f.y, f.z / (a->m[k] + a->heave_mass[k])) : v3_scale(invm, f);
    fl_vec3 dv = v3_scale(h, acceleration), dw = v3_scale(h, v3_scale(turn, a->t[k]));
    if (a->floats) dv = v3_add(dv, v3_sub(dragged.v, before.v)), dw = v3_add(dw, v3_sub(dragged.w, before.w));
    const double n = fl_sphere_contacts_in_line(a->contact_count[k]);
    fl_sphere_state s;
    s.x = x, s.r = r, s.v = now.v, s.inv_mass = a->heave_mass ? NAN : invm;
    s.w = now.w, s.r_copy = r, s.dv = dv, s.contact_inv_mass = n > 1.0 ? (n - 1.0) * invm : 0.0;
    s.rdw = v3_scale(r, dw), s.inv_inertia = r * r * turn;
    a->state[k] = s;
    if (a->heave_mass) a->yields[k] = v3(invm, invm, 1.0 / (a->m[k] + a->heave_mass[k]));
}

static inline void fl_gpu_first_half(const fl_gpu_view *a, int32_t k)
{
    if (a->host[k]) return;
    if (a->near_of && a->near_of[k]) {
        fl_gpu_near *const near = &a->near_body[a->near_of[k] - 1];
        if (fl_gpu_near_begins(near)) {
            fl_gpu_near_first_half(a, k, near);
            return;
        }
        near->before = near->now;
    }
    const double dt = a->dt, h = 0.5 * dt, invm = a->invm[k], turn = a->turn[k], up = fl_gpu_mass_up(a, k);
    const int heavy = a->heave_mass != NULL;
    const fl_sphere_motion before = fl_gpu_motion(a, k);
    fl_sphere_motion dragged = before;
    if (a->floats) {
        double lost;
        fl_sphere_drag d = a->drag;
        d.h = h;
        dragged = fl_sphere_decay(before, a->m[k], up, a->wetted_area[k], a->drag_radius[k], d, heavy, &lost);
        a->drag_loss[k] = a->drag_loss[k] - lost;
    }
    fl_sphere_motion now = fl_sphere_kick(dragged, a->f[k], a->t[k], h, invm, turn, up, heavy);
    if (a->floats == 2) now = fl_sphere_kick(now, a->f[k], a->t[k], 0.0, invm, turn, up, 0);
    a->q[k] = fl_sphere_turned(a->q[k], now.L, turn, dt);
    a->odometer[k] += fabs(dt) * sqrt(v3_norm2(now.v));
    a->L[k] = now.L;
    fl_gpu_show(a, k, v3_madd(a->state[k].x, dt, now.v), now, dragged, before, h);
}

static inline void fl_gpu_take_guest(const fl_gpu_view *a, int32_t g)
{
    const int32_t k = a->guest[g];
    if (!(a->guest_state[g].state.r > 0.0)) return; /* its state is there */
    a->state[k] = a->guest_state[g].state;
    a->yields[k] = a->guest_state[g].yields, a->inverse[k] = a->guest_state[g].inverse;
}

static inline void fl_gpu_block_moves(const fl_gpu_view *a, int32_t g)
{
    const int32_t from = g * FL_BODY_BLOCK, to = from + FL_BODY_BLOCK < a->n ? from + FL_BODY_BLOCK : a->n;
    double most = 0.0, next = 0.0;
    for (int32_t k = from; k < to; k++) {
        const double x = a->host[k] ? 0.0 : a->odometer[k] - a->odometer_at_search[k];
        if (x > most) next = most, most = x;
        else if (x > next) next = x;
    }
    a->moves[2 * g] = most, a->moves[2 * g + 1] = next;
}

/* --- contacts ---------------------------------------------------------------------------------------- */

/* Inverse mass along n. */
static inline double fl_gpu_yields_along(const fl_gpu_view *a, int32_t k, fl_vec3 n)
{
    fl_sym3 e;
    e.xx = a->yields[k].x, e.yy = a->yields[k].y, e.zz = a->yields[k].z, e.xy = e.xz = e.yz = 0.0;
    return v3_dot(n, s3_mul(e, n));
}

/* All that the law reads of a contact but its memory. */
typedef struct {
    fl_vec3 d, u, du, wi, wj, rdw;
    double ri, rj, inv_mass, inv_mass_tangent, inv_inertia, contact_count, slow_inv_mass;
} fl_gpu_approach;

static inline fl_sphere_contact fl_gpu_forgotten(double k)
{
    fl_sphere_contact c;
    c.spring_force = c.friction_force = v3(0, 0, 0);
    c.spring_stiffness = c.normal_damping = c.max_approach_speed = 0.0;
    c.k = k;
    return c;
}

static inline fl_rolling_spring fl_gpu_no_roll(void)
{
    fl_rolling_spring r;
    r.elastic = r.total = v3(0, 0, 0), r.k = r.arm = 0.0;
    return r;
}

/* Evaluates a contact: updates its memory, and its rolling spring (NULL: none) over arm with the change dw of
 * w_i - w_j and the inverse mass roll_inverse. */
static inline fl_gpu_row_result fl_gpu_evaluate(const fl_gpu_view *a, const fl_gpu_law *law,
                                                fl_gpu_approach p, fl_sphere_contact *c,
                                                fl_rolling_spring *roll, double arm, fl_vec3 dw,
                                                double roll_inverse)
{
    fl_sphere_step by;
    by.dt = a->dt, by.half = 0.5 * a->dt, by.at_start = 0.0;
    const fl_sphere_geometry g = fl_sphere_geometry_of(p.d.x, p.d.y, p.d.z, p.ri, p.rj, c->k, a->linear);
    const fl_sphere_normal q = fl_sphere_normal_of(
        g.n, g.overlap, g.elastic, c->k, p.u, p.du, c->max_approach_speed, c->normal_damping, p.slow_inv_mass,
        law->impact_damping, p.inv_mass, p.contact_count, by, a->linear);
    fl_tangent_spring spring;
    spring.k = law->tangential * g.slope;
    spring.g = law->tangential * (q.damping_factor * g.elastic);
    spring.limit = law->friction * (g.elastic + q.normal_damping);
    spring.inv_mass = p.inv_mass_tangent;
    spring.contact_count = p.contact_count;
    fl_sphere_friction before;
    before.spring_force = c->spring_force, before.spring_stiffness = c->spring_stiffness;
    before.friction_force = c->friction_force;
    const int on = spring.limit > 0.0 && law->tangential > 0.0;
    const fl_sphere_friction now = fl_sphere_friction_of(g.n, g.overlap, p.ri, p.rj, p.u, p.du, p.wi, p.wj,
                                                         p.rdw, before, spring, p.inv_inertia, on, by);
    c->spring_force = now.spring_force, c->spring_stiffness = now.spring_stiffness;
    c->friction_force = now.friction_force;
    c->normal_damping = q.normal_damping, c->max_approach_speed = q.max_approach_speed;
    if (roll) {
        const double mu = law->rolling, part = fl_rolling_stiffness_ratio(mu);
        fl_tangent_spring turns;
        turns.k = part * g.slope;
        turns.g = part * (q.damping_factor * g.elastic);
        turns.limit = mu * (g.elastic + q.normal_damping);
        turns.inv_mass = roll_inverse;
        turns.contact_count = p.contact_count;
        roll->arm = arm;
        *roll = fl_sphere_rolling_of(*roll, turns, p.wi, p.wj, dw, by);
    }
    const fl_sphere_forces all =
        fl_sphere_forces_of(g.n, g.overlap, p.ri, p.rj, g.elastic, q.normal_damping, now.friction_force);
    fl_gpu_row_result out;
    out.n = g.n, out.elastic = g.elastic, out.overlap = g.overlap, out.slope = g.slope,
    out.size = all.magnitude;
    return out;
}

/* 1/I of a sphere, 0 if it cannot rotate, and the predicted change of its angular velocity. */
static inline double fl_gpu_inverse_inertia(const fl_sphere_state *s, fl_vec3 *dw)
{
    const double each = 1.0 / s->r;
    *dw = v3_scale(each, s->rdw);
    return each * each * s->inv_inertia;
}

static inline void fl_gpu_row(const fl_gpu_view *a, int32_t c)
{
    const int32_t i = a->row_i[c], j = a->row_j[c];
    const fl_sphere_state si = a->state[i], sj = a->state[j];
    fl_vec3 d = v3_sub(si.x, sj.x);
    if (a->row_image) {
        const int32_t *e = &a->row_image[3 * (int64_t)c];
        d = v3_sub(d, v3(e[0] * a->cell_length.x, e[1] * a->cell_length.y, e[2] * a->cell_length.z));
    }
    const double R = si.r + sj.r;
    const int touches = d.x * d.x + d.y * d.y + d.z * d.z - R * R < 0.0;
    if (!touches) {
        if (a->touches[c]) {
            a->contact[c] = fl_gpu_forgotten(a->contact[c].k);
            if (a->rolling) a->rolling[c] = fl_gpu_no_roll();
            a->touches[c] = 0;
        }
        return;
    }
    a->touches[c] = 1;
    const fl_gpu_law *law = &a->law[a->row_law[c]];
    fl_gpu_approach p;
    p.d = d, p.u = v3_sub(si.v, sj.v), p.du = v3_sub(si.dv, sj.dv), p.wi = si.w, p.wj = sj.w;
    p.rdw = v3_add(si.rdw, sj.rdw), p.ri = si.r, p.rj = sj.r;
    p.inv_mass = p.inv_mass_tangent = si.inv_mass + sj.inv_mass;
    p.inv_inertia = si.inv_inertia + sj.inv_inertia;
    p.contact_count = fl_sphere_contact_count(si.contact_inv_mass, sj.contact_inv_mass, p.inv_mass);
    p.slow_inv_mass = law->slow_factor2 * p.inv_mass;
    if (!(p.slow_inv_mass == p.slow_inv_mass)) { /* an inverse mass depends on the direction */
        const fl_vec3 n = v3_unit(d);
        p.inv_mass = fl_gpu_yields_along(a, i, n) + fl_gpu_yields_along(a, j, n);
        p.inv_mass_tangent = a->inverse[i] + a->inverse[j];
        p.contact_count =
            fl_effective_contact_count(si.contact_inv_mass, sj.contact_inv_mass, p.inv_mass_tangent);
        p.slow_inv_mass = law->slow_factor2 * p.inv_mass;
    }
    fl_sphere_contact m = a->contact[c];
    fl_vec3 dw = v3(0, 0, 0);
    double arm = 0.0, roll_inverse = 0.0;
    if (a->rolling) {
        fl_vec3 dwj;
        roll_inverse = fl_gpu_inverse_inertia(&si, &dw);
        roll_inverse += fl_gpu_inverse_inertia(&sj, &dwj);
        dw = v3_sub(dw, dwj);
        arm = si.r * sj.r / (si.r + sj.r);
        roll_inverse = arm * arm * roll_inverse;
    }
    a->result[c] = fl_gpu_evaluate(a, law, p, &m, a->rolling ? &a->rolling[c] : NULL, arm, dw, roll_inverse);
    a->contact[c] = m;
}

/* As load_contact() of sphere/wall_contact.c. */
static inline void fl_gpu_wall_row(const fl_gpu_view *a, int32_t c)
{
    fl_wall_contact *w = &a->wall[c];
    const int32_t i = w->i;
    const fl_gpu_wall plane = a->plane[w->j - a->plane_first];
    const fl_sphere_state s = a->state[i];
    const fl_vec3 n = plane.n;
    const double z = v3_dot(n, v3_sub(s.x, plane.x)), radius = s.r;
    const int touches = z < radius;
    if (!touches) {
        if (w->touches) {
            w->contact = fl_gpu_forgotten(w->contact.k);
            if (a->wall_rolling) a->wall_rolling[c] = fl_gpu_no_roll();
            w->touches = 0;
        }
        return;
    }
    w->touches = 1;
    const fl_gpu_law *law = &a->law[w->law];
    const double below = z > 0.0 ? 0.0 : radius - 2.0 * z, over = radius - z, both = radius + below - over,
                 own = (radius - 0.5 * over) / radius,
                 part = both > 0.0 ? own * (radius + below) / both : 1.0;
    fl_gpu_approach p;
    p.d = v3_scale(z + below, n), p.u = s.v, p.du = s.dv, p.wi = s.w, p.wj = v3(0, 0, 0);
    p.rdw = v3_scale(part, s.rdw), p.ri = radius, p.rj = below;
    p.inv_mass = s.inv_mass == s.inv_mass ? s.inv_mass : fl_gpu_yields_along(a, i, n);
    p.slow_inv_mass = law->slow_factor2 * p.inv_mass;
    p.inv_inertia = part * part * s.inv_inertia;
    p.inv_mass_tangent = a->invm[i];
    p.contact_count = fl_effective_contact_count(s.contact_inv_mass, 0.0, a->invm[i]);
    fl_vec3 dw;
    const double turns = fl_gpu_inverse_inertia(&s, &dw);
    a->wall_result[c] = fl_gpu_evaluate(a, law, p, &w->contact, a->wall_rolling ? &a->wall_rolling[c] : NULL,
                                        radius, dw, radius * radius * turns);
}

/* --- bonds ------------------------------------------------------------------------------------------- */

/* A disc whose bound of lambda^2 is less stays whole, as in disc_batch.c. */
#define FL_GPU_WHOLE (1.0 - 1e-9)

/* Ends bond k, as end_disc() of contact/disc_list.c. */
static inline void fl_gpu_end_disc(const fl_gpu_view *a, int32_t k, fl_disc_class c, fl_disc_memory *m,
                                   fl_vec3 d, fl_vec3 S)
{
    const double over = a->state[a->disc_i[k]].r + a->state[a->disc_j[k]].r - v3_norm(d);
    const double left = over > 0.0 ? a->disc_k[k] * fl_normal_phi(over, a->linear ? 1.0 : 1.5) : 0.0;
    a->disc_pending[k] = left;
    m->dissipated += fl_disc_stored(c, *m, d) - left;
    m->S = S, m->M = m->damping_force = m->damping_couple = v3(0, 0, 0);
    a->disc_ended[k] = 1;
#ifdef __CUDA_ARCH__
    atomicAdd(&a->control->ended, 1);
#else
    a->control->ended++;
#endif
}

static inline void fl_gpu_disc(const fl_gpu_view *a, int32_t k)
{
    const fl_disc_class c = a->disc_class[a->disc_which[k]];
    const double scatter = a->disc_scatter ? a->disc_scatter[k] : 1.0,
                 own = 1.0 / (PI * c.radius * c.radius * c.weakening);
    fl_disc_wrench out;
    a->disc_done[k] = 0, a->disc_size[k] = 0.0;
    if (a->disc_ended[k]) {
        out.force = out.couple_i = out.couple_j = v3(0, 0, 0);
        a->disc_out[k] = out;
        return;
    }
    const fl_sphere_state *si = &a->state[a->disc_i[k]], *sj = &a->state[a->disc_j[k]];
    fl_disc_pose at;
    at.d = v3_sub(sj->x, si->x);
    at.d = v3_add(at.d, a->disc_shift ? a->disc_shift[k] : v3(0, 0, 0));
    at.vi = si->v, at.vj = sj->v, at.wi = si->w, at.wj = sj->w;
    fl_disc_memory m = a->disc[k];
    const fl_disc_motion q = fl_disc_motion_of(at.d, at.vi, at.vj, at.wi, at.wj, m.S, m.M, c.length, c.kn,
                                               c.shear_ratio, c.radius, c.share, a->dt);
    const double used = fl_disc_strength_bound(q, a->disc_law.moment_factor / c.radius,
                                               own / a->disc_law.tension, own / a->disc_law.cohesion);
    if (a->disc_whole[k] && used < FL_GPU_WHOLE * scatter * scatter) {
        fl_vec3 F = v3_madd(v3_scale(q.N, q.e), 1.0, q.S), M = q.M;
        if (a->damped_discs) {
            const fl_vec3 drag = fl_disc_damping_force(q, c.kn, c.shear_ratio, c.damping),
                          brake = fl_disc_damping_couple(q, c.kn, c.shear_ratio, c.radius, c.damping);
            m.damped += 0.5 * a->dt *
                        fl_disc_power(q, v3_add(m.damping_force, drag), v3_add(m.damping_couple, brake));
            m.damping_force = drag, m.damping_couple = brake;
            F = v3_add(F, drag), M = v3_add(brake, M);
        }
        m.S = q.S, m.M = q.M;
        const fl_vec3 arm = v3_cross(q.e, F);
        out.force = F;
        out.couple_i = v3_madd(M, c.share * q.r, arm);
        out.couple_j = v3_madd(v3_neg(M), (1.0 - c.share) * q.r, arm);
        a->disc_done[k] = 1;
    } else {
        const fl_disc_result now = fl_disc_step(a->disc_law, c, scatter, at, a->dt, m);
        m = now.memory, out = now.force;
        if (m.lambda >= 1.0 && m.lambda >= c.ductility) {
            const fl_vec3 e = v3_unit(at.d);
            fl_gpu_end_disc(a, k, c, &m, at.d, v3_madd(out.force, -v3_dot(out.force, e), e));
        }
        a->disc_whole[k] = (uint8_t)(!a->disc_ended[k] && fl_disc_integrity_of(c, m.lambda) == 1.0);
        if (!a->damped_discs) { /* arrays without dashpots keep none of it */
            m.damping_force = m.damping_couple = v3(0, 0, 0);
            m.damped = 0.0;
        }
    }
    a->disc_size[k] = v3_norm(out.force);
    a->disc[k] = m;
    a->disc_out[k] = out;
}

/* --- sums of a body ---------------------------------------------------------------------------------- */

static inline void fl_gpu_tell_guest(const fl_gpu_view *a, int32_t g)
{
    const int32_t k = a->guest[g];
    fl_sphere_sum s;
    const int32_t touching = fl_gpu_sum(a, k, &s);
    a->sum[k] = s;
    a->contact_count[k] = touching;
    a->guest_sum[g].sum = s;
    a->guest_sum[g].contacts = touching;
}

static inline void fl_gpu_tell_guest_disc(const fl_gpu_view *a, int32_t e)
{
    a->guest_wrench[e] = a->disc_out[a->guest_disc[e]];
}

/* A place of no body. */
static inline void fl_gpu_clear(const fl_gpu_view *a, int32_t k)
{
    const fl_vec3 none = v3(0, 0, 0);
    fl_sphere_sum s;
    s.elastic = s.damping = s.friction = s.torque = none;
    a->sum[k] = s, a->contact_count[k] = 0;
    a->contact_force[k] = none, a->damping_work[k] = a->friction_work[k] = 0.0, a->bad[k] = 0;
}

static inline void fl_gpu_second_half(const fl_gpu_view *a, int32_t k)
{
    if (a->host[k] == FL_GPU_EMPTY) fl_gpu_clear(a, k);
    if (a->host[k]) return;
    if (a->near_of && a->near_of[k]) {
        fl_gpu_near *const near = &a->near_body[a->near_of[k] - 1];
        if (fl_gpu_near_ends(a, near)) {
            fl_gpu_near_second_half(a, k, near);
            return;
        }
        near->now = near->before; /* without contacts */
    }
    const double dt = a->dt, h = 0.5 * dt, m = a->m[k], invm = a->invm[k], turn = a->turn[k];
    const int heavy = a->heave_mass != NULL;
    double up = fl_gpu_mass_up(a, k);
    fl_sphere_sum s1;
    const fl_sphere_sum s0 = a->previous_sum[k];
    const int32_t touching = fl_gpu_sum(a, k, &s1);
    const fl_vec3 first_v = fl_gpu_change(a, a->f[k], h, invm, up), first_w = v3_scale(h * turn, a->t[k]);
    fl_sphere_motion now = fl_gpu_motion(a, k);
    /* weight, buoyancy, contacts, bonds */
    fl_vec3 f = v3_scale(m, a->gravity), t = v3(0, 0, 0), lift = v3(0, 0, 0);
    if (a->floats) {
        lift = fl_gpu_float(a, k, now.v.z);
        f = v3_add(f, lift);
        up = fl_gpu_mass_up(a, k);
    }
    f = v3_add(f, v3_add(v3_add(s1.elastic, s1.damping), s1.friction));
    t = v3_add(t, s1.torque);
    fl_gpu_add_discs(a, k, &f, &t);
    const fl_vec3 second_v = fl_gpu_change(a, f, h, invm, up), second_w = v3_scale(h * turn, t);
    now = fl_sphere_kick(now, f, t, h, invm, turn, up, heavy);
    fl_sphere_motion end = now;
    if (a->floats) {
        double lost;
        fl_sphere_drag d = a->drag;
        d.h = h;
        end = fl_sphere_decay(now, m, up, a->wetted_area[k], a->drag_radius[k], d, heavy, &lost);
        a->drag_loss[k] = a->drag_loss[k] - lost;
    }
    a->f[k] = f, a->t[k] = t, a->L[k] = end.L;
    a->state[k].v = end.v, a->state[k].w = end.w;
    a->sum[k] = s1;
    a->contact_count[k] = touching;
    /* works */
    const double sixth = dt / 6.0;
    a->damping_work[k] = 0.0 - (dt * v3_dot(s1.damping, end.v) +
                                sixth * (v3_dot(s1.damping, first_v) - v3_dot(s0.damping, second_v)));
    a->friction_work[k] = 0.0 - (dt * fl_gpu_power(s1.friction, s1.torque, end.v, end.w) +
                                 sixth * (fl_gpu_power(s1.friction, s1.torque, first_v, first_w) -
                                          fl_gpu_power(s0.friction, s0.torque, second_v, second_w)));
    const int has_contact = touching > 0 || fl_gpu_has_discs(a, k);
    fl_vec3 by = v3_madd(f, -m, a->gravity);
    if (a->floats) by = v3_sub(by, lift);
    a->contact_force[k] = has_contact ? by : v3(0, 0, 0);
    fl_gpu_note_finite(a, k, f, t, end);
}

/* After a partner has left, between two steps: sums and forces without it. */
static inline void fl_gpu_sum_again(const fl_gpu_view *a, int32_t e)
{
    const int32_t k = a->again[e];
    if (a->host[k]) return;
    fl_sphere_sum s;
    const int32_t touching = fl_gpu_sum(a, k, &s);
    fl_vec3 f = v3_scale(a->m[k], a->gravity), t = v3(0, 0, 0);
    if (a->floats) f = v3_add(f, v3(0, 0, a->buoyancy[k]));
    f = v3_add(f, v3_add(v3_add(s.elastic, s.damping), s.friction));
    t = v3_add(t, s.torque);
    fl_gpu_add_discs(a, k, &f, &t);
    a->f[k] = f, a->t[k] = t, a->sum[k] = s;
    a->contact_count[k] = touching;
}

static inline void fl_gpu_take_guest_work(const fl_gpu_view *a, int32_t g)
{
    const int32_t k = a->guest[g];
    const fl_gpu_guest_work w = a->guest_work[g];
    a->contact_force[k] = w.contact_force;
    a->damping_work[k] = w.damping_work, a->friction_work[k] = w.friction_work;
    a->bad[k] = (uint8_t)!w.is_finite;
}

/* --- sums for the books ------------------------------------------------------------------------------ */

static inline void fl_gpu_block(const fl_gpu_view *a, int32_t g)
{
    const int32_t from = g * FL_BODY_BLOCK, to = from + FL_BODY_BLOCK < a->n ? from + FL_BODY_BLOCK : a->n;
    fl_body_block b;
    b.contact_force = v3(0, 0, 0), b.damping_work = b.friction_work = 0.0, b.not_finite = -1;
    b.largest_moves[0] = b.largest_moves[1] = 0.0;
    for (int32_t k = from; k < to; k++) {
        b.contact_force = v3_add(b.contact_force, a->contact_force[k]);
        b.damping_work += a->damping_work[k], b.friction_work += a->friction_work[k];
        if (a->bad[k] && b.not_finite < 0) b.not_finite = k;
    }
    a->block[g] = b;
    if (!a->extent) return;
    int leaves = 0;
    for (int32_t k = from; k < to; k++)
        leaves |= !a->host[k] && fl_is_beyond(a->domain_lo, a->domain_hi, a->state[k].x, a->extent[k]);
    a->leaves[g] = (uint8_t)leaves;
}

/* A batch of touching rows: 16 in four lanes. */
typedef struct {
    double lane[4], rest[4];
    int32_t m, lanes;
} fl_gpu_batch;

static inline void fl_gpu_batch_end(fl_gpu_batch *b, fl_chunk_totals *t)
{
    double rest = 0.0;
    for (int32_t l = 0; l < b->lanes; l++) rest += b->rest[l];
    t->force_sum += ((b->lane[0] + b->lane[2]) + (b->lane[1] + b->lane[3])) + rest;
    for (int32_t l = 0; l < 4; l++) b->lane[l] = 0.0;
    b->m = b->lanes = 0;
}

static inline void fl_gpu_deepest(fl_chunk_totals *t, double overlap, double both, int32_t i, int32_t j)
{
    if (overlap > t->max_overlap * both)
        t->max_overlap = overlap / both, t->max_overlap_i = i, t->max_overlap_j = j;
}

/* Load of wall contact c, as add_to_load() of sphere/wall_contact.c. */
static inline void fl_gpu_load_wall(const fl_gpu_view *a, fl_wall_load *load, int32_t c)
{
    const fl_wall_contact *w = &a->wall[c];
    const fl_gpu_row_result *q = &a->wall_result[c];
    const fl_gpu_wall plane = a->plane[w->j - a->plane_first];
    const fl_vec3 F = v3_madd(w->contact.friction_force, q->elastic + w->contact.normal_damping, plane.n),
                  middle = v3_madd(v3_sub(a->state[w->i].x, plane.x), 0.5 * q->overlap - a->state[w->i].r,
                                   plane.n);
    load->f = v3_sub(load->f, F);
    load->t = v3_sub(load->t, v3_cross(middle, F));
    load->t = v3_sub(load->t, a->wall_rolling ? v3_scale(a->wall_rolling[c].arm, a->wall_rolling[c].total)
                                              : v3(0, 0, 0));
}

static inline void fl_gpu_chunk(const fl_gpu_view *a, int32_t g)
{
    const int32_t begin = g * FL_SPHERE_CHUNK,
                  end = begin + FL_SPHERE_CHUNK < a->n ? begin + FL_SPHERE_CHUNK : a->n;
    fl_chunk_totals t;
    fl_gpu_batch b;
    t.touching = 0, t.force_sum = t.max_overlap = t.elastic = t.spring = 0.0,
    t.max_overlap_i = t.max_overlap_j = -1;
    b.m = b.lanes = 0, b.lane[0] = b.lane[1] = b.lane[2] = b.lane[3] = 0.0;
    for (int32_t c = a->first[begin]; c < a->first[end]; c++) {
        if (!a->touches[c]) continue;
        const fl_gpu_row_result *q = &a->result[c];
        b.rest[b.lanes++] = q->size;
        if (b.lanes == 4) {
            for (int32_t l = 0; l < 4; l++) b.lane[l] += b.rest[l];
            b.lanes = 0;
        }
        t.touching++;
        if (++b.m == 16) fl_gpu_batch_end(&b, &t);
        fl_gpu_deepest(&t, q->overlap, a->state[a->row_i[c]].r + a->state[a->row_j[c]].r, a->row_i[c],
                       a->row_j[c]);
    }
    if (b.m) fl_gpu_batch_end(&b, &t);
    for (int32_t k = 0; k < a->wall_planes; k++) {
        fl_wall_load *load = &a->wall_load[(int64_t)g * a->wall_planes + k];
        load->f = load->t = v3(0, 0, 0);
    }
    for (int32_t c = a->wall_of_chunk[g]; c < a->wall_of_chunk[g + 1]; c++) {
        if (!a->wall[c].touches) continue;
        const fl_gpu_row_result *q = &a->wall_result[c];
        const double deep = q->overlap / a->state[a->wall[c].i].r;
        fl_gpu_load_wall(a, &a->wall_load[(int64_t)g * a->wall_planes + (a->wall[c].j - a->plane_first)], c);
        t.force_sum += q->size;
        t.touching++;
        if (deep > t.max_overlap)
            t.max_overlap = deep, t.max_overlap_i = a->wall[c].i, t.max_overlap_j = a->wall[c].j;
    }
    a->totals[g] = t;
}

/* Sum of |F| of 64 bonds: by eight those that stayed whole, then the others of the eight. */
static inline void fl_gpu_disc_run(const fl_gpu_view *a, int32_t g)
{
    const int32_t from = g * 64, to = from + 64 < a->discs ? from + 64 : a->discs;
    double sum = 0.0;
    for (int32_t k = from; k < to; k += 8) {
        const int32_t end = k + 8 < to ? k + 8 : to;
        double whole = 0.0;
        for (int32_t l = k; l < end; l++) whole += a->disc_done[l] ? a->disc_size[l] : 0.0;
        sum += whole;
        for (int32_t l = k; l < end; l++)
            if (!a->disc_done[l]) sum += a->disc_size[l];
    }
    a->disc_force_sum[g] = sum;
}

/* --- stiffness --------------------------------------------------------------------------------------- */

/* fl_stiffness_of_point() */
static inline double fl_gpu_stiffness_of_point(const fl_gpu_view *a, int32_t k, double along, double across,
                                               double arm, double turning)
{
    const double one = along * a->invm[k],
                 two = across * (a->invm[k] + arm * arm / a->inertia[k]) + turning / a->inertia[k];
    return one > two ? one : two;
}

/* fl_rolling_turn_stiffness() of contact/rolling_pair.h */
static inline double fl_gpu_turn_stiffness(const fl_rolling_spring *r) { return r->k * r->arm * r->arm; }

/* Bound of omega^2 of body k by its contacts, in the order of its sums. */
static inline void fl_gpu_stiffness(const fl_gpu_view *a, int32_t k)
{
    const int32_t begin = k / FL_SPHERE_CHUNK * FL_SPHERE_CHUNK, end = a->link_first[k + 1];
    int32_t at = a->link_first[k];
    double sum = 0.0;
    for (int part = 0; part < 2; part++) {
        for (; at < end; at++) {
            const int32_t c = a->link[at] >> 1, i = a->row_i[c], j = a->row_j[c];
            if (part == 0 && i < begin) break;
            if (!a->touches[c]) continue;
            const fl_gpu_row_result *q = &a->result[c];
            const double half = 0.5 * q->overlap,
                         rolls = a->rolling ? fl_gpu_turn_stiffness(&a->rolling[c]) : 0.0,
                         across = a->contact[c].spring_stiffness;
            const double ki = fl_gpu_stiffness_of_point(a, i, q->slope, across, a->state[i].r - half, rolls),
                         kj = fl_gpu_stiffness_of_point(a, j, q->slope, across, a->state[j].r - half, rolls),
                         both = sqrt(ki * kj);
            sum += (a->link[at] & 1 ? kj : ki) + both;
        }
        for (int32_t c = a->wall_of_body[k]; part == 0 && c < a->wall_of_body[k + 1]; c++) {
            if (!a->wall[c].touches) continue;
            const fl_gpu_row_result *q = &a->wall_result[c];
            sum += fl_gpu_stiffness_of_point(
                a, k, q->slope, a->wall[c].contact.spring_stiffness, a->state[k].r - 0.5 * q->overlap,
                a->wall_rolling ? fl_gpu_turn_stiffness(&a->wall_rolling[c]) : 0.0);
        }
    }
    a->omega2[k] = sum;
}

#endif
