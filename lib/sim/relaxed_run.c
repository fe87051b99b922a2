/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "sim/relaxed_run.h"
#include <stddef.h>
#include <stdlib.h>
#include "base/array.h"
#include "sim/zone_step.h"
#include "world/access.h"

static const double LOCAL = 0.8;
/* Largest rate times step: beyond it a force at the velocity in the middle of a step is unstable. */
static const double LARGEST_SHARE = 0.5;

int fl_relaxed_run_make(fl_world *w, fl_err *err)
{
    fl_relax_state *s = &w->relax;
    s->kind = w->scene->run.relax;
    if (!s->kind) return 0;
    s->r = fl_relaxation_start(s->kind == FL_RELAX_KINETIC ? FL_RELAXATION_KINETIC : FL_RELAXATION_ADAPTIVE,
                               0.0);
    if (!(s->damping = fl_alloc(w->n, sizeof *s->damping, err))) return -1;
    if (s->kind != FL_RELAX_ADAPTIVE) return 0;
    if (!(s->force = fl_alloc(w->n, sizeof *s->force, err))) return -1;
    if (!w->zones.set.blocks) return 0;
    return (s->node_force = fl_alloc(w->zones.set.nodes, sizeof *s->node_force, err)) ? 0 : -1;
}

void fl_relaxed_run_free(fl_relax_state *s)
{
    free(s->damping), free(s->force), free(s->node_force);
    *s = (fl_relax_state){0};
}

static double against(double force, double velocity)
{
    if (!(velocity > 0.0) && !(velocity < 0.0)) return 0.0;
    return velocity > 0.0 ? -LOCAL * fabs(force) : LOCAL * fabs(force);
}

/* x without the components in fixed directions; a fixed rotation takes all of them. */
static fl_vec3 free_part(const fl_bodies *b, int32_t k, fl_vec3 x)
{
    const unsigned held = b->fixed_dof[k];
    return v3(held & FL_DOF_X ? 0.0 : x.x, held & FL_DOF_Y ? 0.0 : x.y, held & FL_DOF_Z ? 0.0 : x.z);
}

static fl_vec3 free_turn(const fl_bodies *b, int32_t k, fl_vec3 x)
{
    return b->fixed_dof[k] & (FL_DOF_RX | FL_DOF_RY | FL_DOF_RZ) ? v3(0, 0, 0) : x;
}

void fl_relaxed_run_damp(fl_world *w, int32_t k, fl_contact_sum *sum)
{
    fl_bodies *b = &w->b;
    const fl_vec3 v = b->v[k], spin = b->w[k];
    fl_vec3 f, t;
    if (w->relax.kind == FL_RELAX_LOCAL) {
        f = v3(against(b->f[k].x, v.x), against(b->f[k].y, v.y), against(b->f[k].z, v.z));
        t = v3(against(b->t[k].x, spin.x), against(b->t[k].y, spin.y), against(b->t[k].z, spin.z));
    } else if (w->relax.kind == FL_RELAX_ADAPTIVE) {
        f = v3_scale(-w->relax.rate * b->m[k], v);
        t = v3_scale(-w->relax.rate, b->L[k]);
    } else {
        return;
    }
    f = free_part(b, k, f), t = free_turn(b, k, t);
    b->f[k] = v3_add(b->f[k], f), b->t[k] = v3_add(b->t[k], t);
    w->relax.damping[k][0] = f, w->relax.damping[k][1] = t;
    fl_relaxed_run_add_sum(w, k, sum);
}

void fl_relaxed_run_add_sum(const fl_world *w, int32_t k, fl_contact_sum *sum)
{
    if (w->relax.kind == FL_RELAX_KINETIC || fl_body_absent(w, k)) return;
    sum->contacts++;
    sum->damping = v3_add(sum->damping, w->relax.damping[k][0]);
    sum->damping_torque = v3_add(sum->damping_torque, w->relax.damping[k][1]);
}

/* Of the nodes of all zones: chunks in their order. */
static double sum_of_nodes(const fl_world *w, size_t member)
{
    const fl_zone_set *s = &w->zones.set;
    double sum = 0.0;
    for (int32_t c = 0; c < s->node_chunks; c++) {
        const fl_zone_sum *q = &s->sum[c];
        if (!s->block[s->node_chunk[c].block].absent)
            sum += *(const double *)(const void *)((const char *)q + member);
    }
    return sum;
}

/* Kinetic energy of the bodies that damping may stop. */
static double free_kinetic(const fl_world *w)
{
    double sum = 0.0;
    for (int32_t k = 0; k < w->n; k++)
        if (!w->b.fixed_dof[k] && !fl_body_absent(w, k)) sum += fl_body_kinetic_energy(&w->b, k);
    return sum + 0.5 * sum_of_nodes(w, offsetof(fl_zone_sum, motion));
}

static void stop_bodies(fl_world *w)
{
    for (int32_t k = 0; k < w->n; k++)
        if (!w->b.fixed_dof[k] && !fl_body_absent(w, k)) w->b.v[k] = w->b.w[k] = w->b.L[k] = v3(0, 0, 0);
    fl_zones_stop(w);
}

/* The frequency of the motion from the work of the change of forces. */
static void adapt_rate(fl_world *w)
{
    fl_relax_state *s = &w->relax;
    const double dt = w->dt;
    double work = -dt * sum_of_nodes(w, offsetof(fl_zone_sum, release)),
           inertia = dt * dt * sum_of_nodes(w, offsetof(fl_zone_sum, motion));
    for (int32_t k = 0; k < w->n; k++) {
        if (fl_body_absent(w, k) || w->b.fixed_dof[k]) continue;
        const fl_vec3 v = w->b.v[k], f = v3_sub(w->b.f[k], fl_sums_now(w, k)->damping),
                      change = v3_sub(f, s->force[k]);
        work -= dt * v3_dot(v, change);
        inertia += dt * dt * w->b.m[k] * v3_norm2(v);
        s->force[k] = f;
    }
    fl_relaxation_adapt(&s->r, work, inertia, dt);
    s->rate = fmin(s->r.c, LARGEST_SHARE) / dt;
}

void fl_relaxed_run_end_step(fl_world *w)
{
    fl_relax_state *s = &w->relax;
    if (s->kind == FL_RELAX_ADAPTIVE) adapt_rate(w);
    if (s->kind == FL_RELAX_KINETIC) {
        const double energy = free_kinetic(w);
        if (fl_relaxation_peak(&s->r, energy)) {
            stop_bodies(w);
            w->ledger.damping += energy;
        }
    }
    s->settled = (w->step - w->stage_step) % FL_RELAX_EVERY == 0 &&
                 fl_relaxed_run_ratio(w) < w->scene->run.relax_until;
}

double fl_relaxed_run_ratio(const fl_world *w)
{
    double most = 0.0, sum = 0.0;
    int64_t n = 0;
    for (int32_t k = 0; k < w->n; k++) {
        if (fl_body_absent(w, k)) continue;
        const fl_vec3 f =
            w->relax.kind == FL_RELAX_KINETIC ? w->b.f[k] : v3_sub(w->b.f[k], fl_sums_now(w, k)->damping);
        most = fmax(most, v3_norm(free_part(&w->b, k, f)));
    }
    for (int32_t k = 0; k < w->bonds.n; k++) {
        const double f = v3_norm(w->bonds.bond[k].force);
        sum += f, n += f > 0.0;
    }
    for (int32_t c = 0; c < w->n_touching; c++) {
        const double f = v3_norm(w->pair[w->touching_pairs[c]].contact->force);
        sum += f, n += f > 0.0;
    }
    const double bodies = sum > 0.0 ? most * (double)n / sum : INFINITY;
    if (!w->zones.set.blocks) return bodies;
    return fmax(sum > 0.0 ? bodies : 0.0, fl_zones_force_ratio(w));
}
