/* SPDX-License-Identifier: GPL-3.0-or-later */
/* gpu_near_kernel.h -- what one thread of a device does for a sphere near the structure, a held or a driven
 * one: its contacts with pieces (contact/point_kernel.h), and its step, which is that of begin_body() and
 * end_body() of the CPU where the sphere is in no batch there. */
#ifndef FL_GPU_GPU_NEAR_KERNEL_H
#define FL_GPU_GPU_NEAR_KERNEL_H
#include "body/held_sphere_kernel.h"
#include "gpu/gpu_body_kernel.h"
#include "narrow/closest_kernel.h"
#include "structure/mesh_sphere_kernel.h"

/* --- contacts with pieces -------------------------------------------------------------------------- */

static inline fl_point_memory fl_gpu_no_memory(void)
{
    const fl_vec3 none = v3(0, 0, 0);
    fl_point_memory m;
    m.springs.force = m.springs.damping = none;
    m.springs.k = m.springs.moment = m.springs.k_turn = m.springs.energy = m.springs.damping_moment = 0.0;
    m.sustained_spin = m.sustained_spin_rate = none;
    m.max_approach_speed = m.sustained_load = m.sustained_load_rate = m.sustained_step = 0.0;
    return m;
}

static inline fl_point_forces fl_gpu_no_forces(void)
{
    fl_point_forces f;
    f.force = f.torque_i = f.torque_j = f.force_damping = f.torque_i_damping = f.torque_j_damping =
        f.force_friction = f.torque_i_friction = f.torque_j_friction = v3(0, 0, 0);
    f.energy = f.spring_energy = f.overlap = 0.0;
    return f;
}

/* Free directions of body k per impulse, as fl_body_mobility(). */
static inline void fl_gpu_mobility(const fl_gpu_view *a, int32_t k, uint32_t hold, fl_point_body *b)
{
    const fl_mat3 R = q_matrix(q_one());
    const double invm = a->invm[k], up = a->heave_mass ? 1.0 / (a->m[k] + a->heave_mass[k]) : invm,
                 turn = a->turn[k];
    b->linear.xx = hold & FL_DOF_X ? 0.0 : invm, b->linear.yy = hold & FL_DOF_Y ? 0.0 : invm;
    b->linear.zz = hold & FL_DOF_Z ? 0.0 : up, b->linear.xy = b->linear.xz = b->linear.yz = 0.0;
    b->angular = hold & FL_DOF_TURNS ? fl_held_inverse_inertia(hold, a->inertia[k])
                                     : s3_from_principal(&R, v3(turn, turn, turn));
}

static inline fl_point_body fl_gpu_moving_piece(const fl_gpu_piece *p)
{
    fl_point_body b;
    b.v = p->v, b.w = p->w, b.change_v = p->change_v, b.change_w = p->change_w;
    b.linear.xx = b.linear.yy = b.linear.zz = b.linear.xy = b.linear.xz = b.linear.yz = 0.0;
    b.angular = b.linear;
    return b;
}

/* Sum of the odometers at which cores at this distance may touch, as fl_pair_set_free_travel(). */
static inline double fl_gpu_free_travel(double odometers, double distance, double R)
{
    return odometers + (distance > R ? (distance - R) * (1.0 - 1e-9) : 0.0);
}

/* Nearest point of a mesh to x in front of it, and its distance for the free travel, as
 * fl_mesh_contact_sphere(); 0 if x may be behind, which the CPU finds out. */
static inline int fl_gpu_nearest_on_mesh(const fl_gpu_view *a, const fl_gpu_pair *p, const fl_gpu_piece *b,
                                         fl_vec3 x, double ra, fl_closest_point *at, double *distance)
{
    const int32_t *const tile = &a->tile[p->first_tile];
    fl_nearest_search best = fl_nearest_of_none(&b->core, 0);
    for (int32_t c = 0; c < p->tiles; c++) fl_nearest_try(&best, &b->core, tile[c], x);
    *at = best.at, *distance = best.least;
    if (best.least > p->known) {
        *distance = best.least - b->facet_error;
        return 1;
    }
    if (!fl_nearest_is_in_front(&best, &b->core, tile, p->tiles, x)) return 0;
    if (b->cone_of_face && b->cone_of_face[best.of] >= 0 &&
        fl_blend_with_cone(at, &b->free_cone[b->cone_of_face[best.of]], x, ra))
        *distance = fabs(at->d);
    return 1;
}

static inline void fl_gpu_near_pair(const fl_gpu_view *a, int32_t c)
{
    fl_gpu_pair *const p = &a->pair[c];
    const fl_gpu_piece *const piece = &a->piece[p->piece];
    const int32_t i = p->body;
    const fl_gpu_near *const near = &a->near_body[a->near_of[i] - 1];
    const double odometers = a->odometer[i] + piece->odometer;
    a->pair_count[c] = 0;
    if (!p->touching && odometers < p->free_travel) return;
    const fl_sphere_state s = a->state[i];
    const fl_vec3 off = v3_sub(piece->x, s.x), x = v3_neg(m3_tmul(piece->R, off));
    const double ra = s.r, R = ra + piece->radius; /* the piece may be dilated as well */
    fl_closest_point at;
    double distance;
    if (piece->kind == FL_PIECE_MESH) {
        p->undecided = !fl_gpu_nearest_on_mesh(a, p, piece, x, ra, &at, &distance);
        if (p->undecided) {
            a->pair_count[c] = 1;
            return;
        }
    } else {
        at = piece->kind == FL_PIECE_CONE ? fl_point_on_cone(piece->r0, piece->r1, piece->h, x)
             : piece->core.nv == 1        ? fl_closest_of_point(piece->core.v[0], x)
                                          : fl_point_on_poly(&piece->core, x);
        distance = at.d;
    }
    if (!(distance < R)) {
        p->memory = fl_gpu_no_memory(), p->forces = fl_gpu_no_forces();
        p->touching = 0;
        p->free_travel = fl_gpu_free_travel(odometers, distance, R);
        return;
    }
    fl_point_contact q;
    q.overlap = R - at.d;
    q.n = m3_mul(piece->R, at.n);
    q.aj = m3_mul(piece->R, v3_madd(x, 0.5 * q.overlap - ra, at.n));
    q.ai = v3_add(q.aj, off);
    q.i.v = s.v, q.i.w = s.w;
    q.i.change_v = q.i.change_w = v3(0, 0, 0);
    if (near->before.contacts) q.i.change_v = near->change_v, q.i.change_w = near->change_w;
    fl_gpu_mobility(a, i, near->hold, &q.i);
    q.j = fl_gpu_moving_piece(piece);
    q.lag = v3(0, 0, 0);
    q.reduced_mass = p->mass;
    const int64_t many = a->contact_count[i] + near->before.contacts;
    const double each = a->inverse[i];
    q.contact_count = fl_effective_contact_count(many > 1 ? (double)(many - 1) * each : 0.0, 0.0, each + 0.0);
    q.dt = a->dt, q.half_step = 0.5 * a->dt, q.at_start = 0.0;
    q.step = a->step, q.step_size = a->dt;
    q.is_reduced = !a->heave_mass && !(near->hold & (FL_DOF_X | FL_DOF_Y | FL_DOF_Z));
    q.sustains = 1;
    q.law = p->law;
    const fl_point_before before = fl_point_before_of(&p->forces, &p->memory);
    const fl_point_normal f = fl_point_evaluate(&q, p->touching, before, &p->memory, &p->forces);
    p->forces.energy += p->forces.spring_energy;
    p->n = q.n, p->aj = q.aj, p->off = off, p->normal = f.normal;
    p->moved = a->dt * (v3_norm(s.v) + v3_norm(s.w) * 0.0) +
               a->dt * (v3_norm(piece->v) + v3_norm(piece->w) * (v3_norm(off) + 0.0));
    p->touching = 1;
    a->pair_count[c] = 1;
}

/* Copies a pair that touches, or is left to the CPU, to its place among those. */
static inline void fl_gpu_tell_pair(const fl_gpu_view *a, int32_t c)
{
    const int32_t at = a->pair_count[c];
    const int told = a->pair[c].touching || a->pair[c].undecided;
    if (told) a->told_pair[at] = a->pair[c];
    if (c == a->pairs - 1) a->control->touching = at + told;
}

/* Adds the pairs of a body in their order, as fl_body_contact_force(). */
static inline void fl_gpu_add_pairs(const fl_gpu_view *a, fl_gpu_near *b, fl_vec3 *f, fl_vec3 *t)
{
    fl_gpu_pair_sum s;
    s.damping = s.damping_torque = s.friction = s.friction_torque = v3(0, 0, 0), s.contacts = 0;
    for (int32_t c = b->first; c < b->end; c++) {
        const fl_gpu_pair *p = &a->pair[c];
        if (!p->touching) continue;
        *f = v3_madd(*f, 1.0, p->forces.force);
        *t = v3_add(*t, p->forces.torque_i);
        s.contacts++;
        s.damping = v3_madd(s.damping, 1.0, p->forces.force_damping);
        s.damping_torque = v3_add(s.damping_torque, p->forces.torque_i_damping);
        s.friction = v3_madd(s.friction, 1.0, p->forces.force_friction);
        s.friction_torque = v3_add(s.friction_torque, p->forces.torque_i_friction);
    }
    b->now = s;
}

/* --- the step -------------------------------------------------------------------------------------- */

/* True if the CPU moves the body alone, begin_body(); else in a run of free spheres. */
static inline int fl_gpu_is_single(const fl_gpu_view *a, const fl_gpu_near *b)
{
    return a->heave_mass != NULL || b->hold != 0;
}

/* Change of the velocities by a kick of h. */
static inline void fl_gpu_kick_change(const fl_gpu_view *a, int32_t k, int single, double h, fl_vec3 *dv,
                                      fl_vec3 *dw)
{
    const double turn = a->turn[k];
    *dv = fl_gpu_change(a, a->f[k], h, a->invm[k], fl_gpu_mass_up(a, k));
    *dw = single ? v3_scale(turn, v3_scale(h, a->t[k])) : v3_scale(h * turn, a->t[k]);
}

/* Accelerations times h, as fl_body_accelerations(). */
static inline void fl_gpu_acceleration(const fl_gpu_view *a, int32_t k, uint32_t hold, double h, fl_vec3 *dv,
                                       fl_vec3 *dw)
{
    const fl_vec3 none = v3(0, 0, 0), f = a->f[k];
    const double invm = a->invm[k];
    const fl_vec3 free_v =
        a->heave_mass ? v3(invm * f.x, invm * f.y, f.z / fl_gpu_mass_up(a, k)) : v3_scale(invm, f);
    *dv = v3_scale(h, fl_held_components(hold, none, free_v));
    *dw = v3_scale(h, fl_held_spin(hold, none, a->t[k], a->turn[k]));
}

static inline fl_sphere_motion fl_gpu_hold(const fl_gpu_view *a, int32_t k, fl_gpu_near *b,
                                           fl_sphere_motion now, fl_sphere_motion before)
{
    if (!b->hold) return now;
    return fl_held_motion(now, b->hold, before.v, before.w, a->m[k], a->heave_mass ? a->heave_mass[k] : 0.0,
                          a->turn[k], a->inertia[k], &b->work_of_constraints);
}

/* Drag over h, as apply_water_drag(). */
static inline fl_sphere_motion fl_gpu_near_drag(const fl_gpu_view *a, int32_t k, fl_gpu_near *b,
                                                fl_sphere_motion now, double h)
{
    const int heavy = a->heave_mass != NULL;
    const double up = fl_gpu_mass_up(a, k);
    double lost;
    fl_sphere_drag d = a->drag;
    if (!a->floats || !(a->wetted_area[k] > 0.0)) return now;
    d.h = h;
    fl_sphere_motion end =
        fl_sphere_decay(now, a->m[k], up, a->wetted_area[k], a->drag_radius[k], d, heavy, &lost);
    const double from =
        fl_sphere_kinetic(a->m[k], up, now.v, v3_dot(now.w, now.L), heavy) - b->work_of_constraints;
    end = fl_gpu_hold(a, k, b, end, now);
    lost = fl_sphere_kinetic(a->m[k], up, end.v, v3_dot(end.w, end.L), heavy) - b->work_of_constraints - from;
    a->drag_loss[k] = a->drag_loss[k] - lost;
    return end;
}

/* Kick by h; *dv, *dw: its change as the works take it. */
static inline fl_sphere_motion fl_gpu_near_kick(const fl_gpu_view *a, int32_t k, fl_gpu_near *b,
                                                fl_sphere_motion now, double h, fl_vec3 *dv, fl_vec3 *dw)
{
    const int heavy = a->heave_mass != NULL;
    fl_gpu_kick_change(a, k, fl_gpu_is_single(a, b), h, dv, dw);
    const fl_sphere_motion end = fl_gpu_hold(
        a, k, b,
        fl_sphere_kick(now, a->f[k], a->t[k], h, a->invm[k], a->turn[k], fl_gpu_mass_up(a, k), heavy), now);
    if (b->hold) *dv = v3_sub(end.v, now.v);
    if (b->hold & FL_DOF_TURNS) *dw = v3_sub(end.w, now.w);
    return end;
}

static inline void fl_gpu_near_first_half(const fl_gpu_view *a, int32_t k, fl_gpu_near *b)
{
    const double dt = a->dt, h = 0.5 * dt;
    b->before = b->now;
    const fl_sphere_motion before = fl_gpu_motion(a, k), dragged = fl_gpu_near_drag(a, k, b, before, h);
    fl_sphere_motion now = fl_gpu_near_kick(a, k, b, dragged, h, &b->kick_v, &b->kick_w);
    b->change_v = v3_add(b->kick_v, v3_sub(dragged.v, before.v));
    b->change_w = v3_add(b->kick_w, v3_sub(dragged.w, before.w));
    const fl_vec3 x = v3_madd(a->state[k].x, dt, now.v);
    a->odometer[k] += fabs(dt) * v3_norm(now.v);
    if (now.L.x == 0.0 && now.L.y == 0.0 && now.L.z == 0.0) {
        if (!(b->hold & FL_DOF_TURNS)) now.w = v3(0, 0, 0);
    } else if (b->hold & FL_DOF_TURNS) {
        a->q[k] =
            fl_held_turned(a->q[k], &now, b->hold, a->turn[k], a->inertia[k], dt, &b->work_of_constraints);
    } else {
        a->q[k] = fl_sphere_turned(a->q[k], now.L, a->turn[k], dt);
    }
    a->L[k] = now.L;
    /* what contacts read, as fl_sphere_states_update() */
    fl_vec3 dv, dw;
    fl_gpu_acceleration(a, k, b->hold, h, &dv, &dw);
    if (a->floats) dv = v3_add(dv, v3_sub(dragged.v, before.v)), dw = v3_add(dw, v3_sub(dragged.w, before.w));
    const double invm = a->invm[k], r = a->state[k].r,
                 n = fl_sphere_contacts_in_line(a->contact_count[k] + (int32_t)b->before.contacts);
    const int stands = (b->hold & (FL_DOF_X | FL_DOF_Y | FL_DOF_Z)) != 0;
    fl_sphere_state s;
    s.x = x, s.r = r, s.v = now.v, s.inv_mass = a->heave_mass || stands ? NAN : invm;
    s.w = now.w, s.r_copy = r, s.dv = dv, s.contact_inv_mass = n > 1.0 ? (n - 1.0) * a->inverse[k] : 0.0;
    s.rdw = v3_scale(r, dw);
    s.inv_inertia = (b->hold & FL_DOF_TURNS) == FL_DOF_TURNS ? 0.0 : r * r * a->turn[k];
    a->state[k] = s;
    if (a->heave_mass) {
        const double up = 1.0 / (a->m[k] + a->heave_mass[k]);
        a->yields[k] = fl_held_components(b->hold, v3(0, 0, 0), v3(invm, invm, up));
    }
}

/* Works of damping and friction of the pairs, as fl_work_of_step(). */
static inline void fl_gpu_pair_works(const fl_gpu_view *a, const fl_gpu_near *b, fl_sphere_motion end,
                                     fl_vec3 first_v, fl_vec3 first_w, fl_vec3 back_v, fl_vec3 back_w,
                                     double *damping, double *friction)
{
    const fl_gpu_pair_sum *f0 = &b->before, *f1 = &b->now;
    *damping = *friction = 0.0;
    if (f1->contacts) {
        *damping -= a->dt * fl_gpu_power(f1->damping, f1->damping_torque, end.v, end.w);
        *friction -= a->dt * fl_gpu_power(f1->friction, f1->friction_torque, end.v, end.w);
    }
    if (!f0->contacts) return;
    const double sixth = a->dt / 6.0;
    *damping -= sixth * (fl_gpu_power(f1->damping, f1->damping_torque, first_v, first_w) -
                         fl_gpu_power(f0->damping, f0->damping_torque, back_v, back_w));
    *friction -= sixth * (fl_gpu_power(f1->friction, f1->friction_torque, first_v, first_w) -
                          fl_gpu_power(f0->friction, f0->friction_torque, back_v, back_w));
}

static inline int fl_gpu_touches_pieces(const fl_gpu_view *a, const fl_gpu_near *b)
{
    for (int32_t c = b->first; c < b->end; c++)
        if (a->pair[c].touching) return 1;
    return 0;
}

/* True if the sphere goes the way of begin_body() or of free spheres with pairs in the first half of a step,
 * and in the second. */
static inline int fl_gpu_near_begins(const fl_gpu_near *b)
{
    return b->hold || b->is_driven || b->is_always_single || b->now.contacts > 0;
}

static inline int fl_gpu_near_ends(const fl_gpu_view *a, const fl_gpu_near *b)
{
    return b->hold || b->is_driven || b->is_always_single || b->before.contacts > 0 ||
           fl_gpu_touches_pieces(a, b);
}

static inline void fl_gpu_near_second_half(const fl_gpu_view *a, int32_t k, fl_gpu_near *b)
{
    const double dt = a->dt, h = 0.5 * dt, m = a->m[k];
    const int single = fl_gpu_is_single(a, b);
    fl_sphere_sum s1;
    const fl_sphere_sum s0 = a->previous_sum[k];
    const int32_t touching = fl_gpu_sum(a, k, &s1);
    fl_vec3 first_v = b->kick_v, first_w = b->kick_w, back_v, back_w;
    if (!single) fl_gpu_kick_change(a, k, 0, h, &first_v, &first_w);
    else if (!b->before.contacts) fl_gpu_acceleration(a, k, b->hold, h, &first_v, &first_w);
    const fl_sphere_motion now = fl_gpu_motion(a, k);
    /* weight, buoyancy, spring of driven ones, contacts, pairs, bonds */
    fl_vec3 f = v3_scale(m, a->gravity), t = v3(0, 0, 0), lift = v3(0, 0, 0);
    if (a->floats) lift = fl_gpu_float(a, k, now.v.z), f = v3_add(f, lift);
    const double drawn = b->is_driven ? a->state[k].x.z - b->rest_height : 0.0;
    if (b->is_driven) f.z -= b->spring * drawn;
    f = v3_add(f, v3_add(v3_add(s1.elastic, s1.damping), s1.friction));
    t = v3_add(t, s1.torque);
    fl_gpu_add_pairs(a, b, &f, &t);
    fl_gpu_add_discs(a, k, &f, &t);
    a->f[k] = f, a->t[k] = t;
    const fl_sphere_motion kicked = fl_gpu_near_kick(a, k, b, now, h, &back_v, &back_w),
                           end = fl_gpu_near_drag(a, k, b, kicked, h);
    a->L[k] = end.L;
    a->state[k].v = end.v, a->state[k].w = end.w;
    a->sum[k] = s1;
    a->contact_count[k] = touching;
    /* works */
    double damping, friction;
    const double sixth = dt / 6.0;
    fl_gpu_pair_works(a, b, end, first_v, first_w, back_v, back_w, &damping, &friction);
    a->damping_work[k] = damping - (dt * v3_dot(s1.damping, end.v) +
                                    sixth * (v3_dot(s1.damping, first_v) - v3_dot(s0.damping, back_v)));
    a->friction_work[k] = friction - (dt * fl_gpu_power(s1.friction, s1.torque, end.v, end.w) +
                                      sixth * (fl_gpu_power(s1.friction, s1.torque, first_v, first_w) -
                                               fl_gpu_power(s0.friction, s0.torque, back_v, back_w)));
    const int has_contact = touching > 0 || b->now.contacts || fl_gpu_has_discs(a, k);
    if (b->is_driven) f.z += b->spring * drawn;
    fl_vec3 by = v3_madd(f, -m, a->gravity);
    if (a->floats) by = v3_sub(by, lift);
    a->contact_force[k] = has_contact ? by : v3(0, 0, 0);
    fl_gpu_note_finite(a, k, a->f[k], t, end);
}

#endif
