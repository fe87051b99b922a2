/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "sim/body_step.h"
#include "body/integrate.h"
#include "contact/bond_list.h"
#include "sim/relaxed_run.h"
#include "sphere/contact_force.h"
#include "sphere/contact_list.h"
#include "sphere/wall_contact.h"
#include "world/access.h"

void fl_body_kick(fl_world *w, int32_t k, double h)
{
    const fl_vec3 v = w->b.v[k], spin = w->b.w[k];
    fl_kick(&w->b, k, h);
    if (w->sea.waves) fl_environment_add_work(&w->sea, &w->b, k, h, v, spin);
}

void fl_body_first_half(fl_world *w, int32_t k, double s)
{
    if (w->sea.n) fl_environment_drag(&w->sea, &w->b, k, 0.5 * s, 0);
    fl_body_kick(w, k, 0.5 * s);
    fl_drift(&w->b, k, s);
}

void fl_body_external_force(fl_world *w, int32_t k)
{
    fl_bodies *b = &w->b;
    b->f[k] = v3_scale(b->m[k], w->gravity);
    b->t[k] = v3(0, 0, 0);
    if (w->sea.water) fl_environment_force(&w->sea, b, k);
    if (w->driven_floes.n) b->f[k].z -= fl_driven_floe_force(w, k);
}

int fl_body_contact_force(fl_world *w, int32_t k)
{
    fl_bodies *b = &w->b;
    fl_contact_sum *sum = fl_sums_now(w, k);
    if (sum->contacts) *sum = (fl_contact_sum){0};
    if (w->spheres.bodies && k < w->n) fl_sphere_add_forces(w, k, &b->f[k], &b->t[k]);
    if (w->spheres.walls && k >= w->n + w->pieces) fl_wall_add_forces(w, k, &b->f[k], &b->t[k]);
    for (int64_t c = w->first_pair_of_body[k]; c < w->first_pair_of_body[k + 1]; c++) {
        if (!w->pair_touches[w->pairs_of_body[c]]) continue;
        const fl_pair *p = w->pair[w->pairs_of_body[c]].contact;
        b->f[k] = v3_madd(b->f[k], p->i == k ? 1.0 : -1.0, p->force);
        b->t[k] = v3_add(b->t[k], p->i == k ? p->torque_i : p->torque_j);
        fl_contact_sum_add(sum, p, p->i == k);
    }
    if (fl_body_has_bonds(w, k)) fl_bond_list_add_forces(w, k, &b->f[k], &b->t[k], sum);
    if (w->relax.kind && k < w->n) fl_relaxed_run_damp(w, k, sum);
    return sum->contacts != 0;
}

void fl_body_sum_forces(fl_world *w, int32_t k)
{
    w->b.f[k] = w->b.t[k] = v3(0, 0, 0);
    if (k < w->n && fl_body_absent(w, k)) {
        fl_sums_clear(w, k);
        return;
    }
    if (k < w->n) fl_body_external_force(w, k);
    fl_body_contact_force(w, k);
}
