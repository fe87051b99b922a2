/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "contact/pair_damping.h"

double fl_pair_damping_factor(fl_pair *p, double now, double mass)
{
    p->max_approach_speed = p->touching && p->max_approach_speed > now ? p->max_approach_speed : now;
    return fl_damping_chi(p->law->impact_damping, p->law->slow_damping_factor, p->max_approach_speed,
                          p->energy, mass);
}

int fl_pair_is_on_facets(const fl_world *w, const fl_pair *p)
{
    const fl_piece *piece = fl_world_piece(w, p->j);
    return piece && piece->kind != FL_PIECE_PLANE;
}

double fl_pair_sustained_share(const fl_world *w, fl_pair *p, double load, double slope, double mass,
                               fl_vec3 u, fl_vec3 spin, double sigma2)
{
    const double now = (double)w->step, omega2 = slope > 0.0 && mass < INFINITY ? slope / mass : 0.0,
                 dt = p->touching ? (now - p->sustained_step) * w->dt : 0.0;
    const fl_low_pass pass = fl_damping_low_pass(dt, omega2);
    const fl_vec3 w0 = p->sustained_spin, g0 = p->sustained_spin_rate;
    const double load_now = fl_low_pass_after(&pass, p->sustained_load, p->sustained_load_rate, load, dt);
    const fl_vec3 spin_now =
        v3(fl_low_pass_after(&pass, w0.x, g0.x, spin.x, dt), fl_low_pass_after(&pass, w0.y, g0.y, spin.y, dt),
           fl_low_pass_after(&pass, w0.z, g0.z, spin.z, dt));
    p->sustained_load = load_now;
    p->sustained_load_rate = pass.rate * (load - load_now);
    p->sustained_spin = spin_now;
    p->sustained_spin_rate = v3_scale(pass.rate, v3_sub(spin, spin_now));
    p->sustained_step = now;
    return fl_damping_sustained_share(load_now, load) * fl_damping_passing_share(v3_norm2(u), sigma2) *
           fl_damping_steady_share(v3_dot(spin, spin_now), v3_norm2(spin), v3_norm2(spin_now));
}

void fl_pair_stabilise_damping(fl_pair *p, double total_pressure, double chi, const fl_relative_pose *r,
                               const fl_pair_prediction *a)
{
    const fl_wrench to = fl_stabilised_damping(
        fl_wrench_about_middle(p->force, p->torque_i, p->torque_j),
        fl_wrench_about_middle(p->force_damping, p->torque_i_damping, p->torque_j_damping), total_pressure,
        2.0 * a->step.half_step * chi * total_pressure / p->mass, a->change.contact_count, a->before,
        a->step.at_start);
    const fl_vec3 half = v3_scale(0.5, v3_cross(r->off, to.f));
    p->force_damping = to.f, p->torque_i_damping = v3_add(half, to.m),
    p->torque_j_damping = v3_sub(half, to.m);
}
