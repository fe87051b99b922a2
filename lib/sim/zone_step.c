/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "sim/zone_step.h"
#include <omp.h>
#include "base/fast_math.h"
#include "base/pi.h"
#include "world/access.h"

/* Share of the force that damping takes, as of rigid blocks. */
static const double LOCAL_SHARE = 0.8;

/* Waits for the team.  The barrier of OpenMP would spin where there are more threads than processors. */
static void meet_team(fl_world *w) { fl_barrier_wait(&w->barrier, omp_get_num_threads(), NULL, NULL); }

/* --- motion ------------------------------------------------------------------------------------- */

/* Kick of a node by h: its velocity, and the works of damping, of waves and of prescribed motion. */
static void kick_node(const fl_zone_state *z, int32_t n, double h, fl_zone_sum *sum)
{
    const fl_zone_set *s = &z->set;
    const unsigned fixed = s->fixed[n];
    const fl_vec3 f = s->f[n], before = s->v[n], a = fl_zone_free_part(fixed, f),
                  v = v3_madd(before, h / s->inertia[n], a), mean = v3_scale(0.5 * h, v3_add(before, v));
    s->v[n] = v;
    if (z->drag) sum->damping_work -= v3_dot(z->drag[n], mean);
    if (z->push) sum->input_work += v3_dot(z->push[n], mean);
    if (fixed) sum->drive_work -= v3_dot(v3_sub(f, a), mean);
}

void fl_zones_first_half(fl_world *w, double h)
{
    fl_zone_state *z = &w->zones;
    fl_zone_set *s = &z->set;
#pragma omp for schedule(static) nowait
    for (int32_t c = 0; c < s->node_chunks; c++) {
        const fl_zone_chunk q = s->node_chunk[c];
        fl_zone_sum *sum = &s->sum[c];
        sum->damping_work = sum->input_work = sum->drive_work = 0.0;
        if (s->block[q.block].absent) continue;
        for (int32_t n = q.from; n < q.to; n++) {
            kick_node(z, n, h, sum);
            s->x[n] = v3_madd(s->x[n], 2.0 * h, s->v[n]);
        }
        fl_zone_chunk_sums(s, &w->b, c);
    }
    meet_team(w);
#pragma omp for schedule(static) nowait
    for (int32_t k = 0; k < s->blocks; k++)
        if (!s->block[k].absent) fl_zone_set_pose(s, k, &w->b);
    meet_team(w);
}

/* --- forces ------------------------------------------------------------------------------------- */

void fl_zones_stress(fl_world *w)
{
    fl_zone_set *s = &w->zones.set;
#pragma omp for schedule(static) nowait
    for (int32_t c = 0; c < s->zone_chunks; c++)
        if (!s->block[s->zone_chunk[c].block].absent) fl_zone_deform(s, c, c + 1);
    meet_team(w);
    if (s->node_stress) {
#pragma omp for schedule(static) nowait
        for (int32_t c = 0; c < s->node_chunks; c++)
            if (!s->block[s->node_chunk[c].block].absent) fl_zone_average(s, c, c + 1);
        meet_team(w);
    }
#pragma omp for schedule(static) nowait
    for (int32_t c = 0; c < s->zone_chunks; c++)
        if (!s->block[s->zone_chunk[c].block].absent) fl_zone_corner_forces(s, c, c + 1);
    meet_team(w);
}

/* Stress that comes in through quiet sides now, as traction [Pa]. */
static fl_vec3 wave_now(const fl_world *w)
{
    const fl_scene_zones *z = &w->scene->zones;
    const double t = fl_world_time(w), T = z->wave_duration;
    if (!(t > 0.0) || (T > 0.0 && t >= T)) return v3(0, 0, 0);
    if (!(T > 0.0)) return z->wave_stress;
    double c, s;
    fl_cos_sin(PI * t / T, &c, &s);
    return v3_scale(s * s, z->wave_stress);
}

static int is_wave_side(const fl_scene *s, fl_vec3 normal)
{
    return v3_at(normal, s->zones.wave_side / 2) * (s->zones.wave_side % 2 ? 1.0 : -1.0) > 0.5;
}

/* Tensor of inertia of the nodes of a block about its centre, and J^-1 t. */
static fl_vec3 turning(const fl_zone_set *s, const fl_zone_block *q, fl_vec3 o, fl_vec3 t)
{
    double xx = 0, yy = 0, zz = 0, xy = 0, xz = 0, yz = 0;
    for (int32_t n = q->node; n < q->node_end; n++) {
        const fl_vec3 r = v3_sub(s->x[n], o);
        const double m = s->m[n];
        xx += m * (r.y * r.y + r.z * r.z), yy += m * (r.x * r.x + r.z * r.z),
            zz += m * (r.x * r.x + r.y * r.y);
        xy -= m * r.x * r.y, xz -= m * r.x * r.z, yz -= m * r.y * r.z;
    }
    const fl_vec3 a = v3(xx, xy, xz), b = v3(xy, yy, yz), c = v3(xz, yz, zz), u = v3_cross(b, c);
    const double det = v3_dot(a, u);
    return v3_scale(1.0 / det, v3_madd(v3_madd(v3_scale(t.x, u), t.y, v3_cross(c, a)), t.z, v3_cross(a, b)));
}

/* Forces on the nodes of a block but those of its zones. */
static void load_block(fl_world *w, int32_t k, fl_vec3 wave)
{
    fl_zone_state *z = &w->zones;
    fl_zone_set *s = &z->set;
    const fl_zone_block *q = &s->block[k];
    const int32_t i = q->body;
    fl_vec3 whole = w->b.f[i];
    /* joints act on their nodes */
    for (int64_t e = w->bonds.n ? w->bonds.first[i] : 0; w->bonds.n && e < w->bonds.first[i + 1]; e++) {
        const fl_bond *c = &w->bonds.bond[w->bonds.of[e]];
        if (c->state != FL_BOND_ENDED) whole = v3_madd(whole, c->i == i ? -1.0 : 1.0, c->force);
    }
    const fl_vec3 a = v3_scale(1.0 / q->mass, whole), t = w->b.t[i], o = w->b.x[i];
    const int turns = v3_nonzero(t);
    const fl_vec3 alpha = turns ? turning(s, q, o, t) : v3(0, 0, 0);
    for (int32_t n = q->node; n < q->node_end; n++) {
        s->f[n] = v3_scale(s->m[n], a);
        if (turns) s->f[n] = v3_madd(s->f[n], s->m[n], v3_cross(alpha, v3_sub(s->x[n], o)));
        if (z->drag) z->drag[n] = v3(0, 0, 0);
        if (z->push) z->push[n] = v3(0, 0, 0);
    }
    for (int32_t e = z->joints.first[k]; e < z->joints.first[k + 1]; e++) {
        const int32_t j = z->joints.of[e];
        if (w->bonds.bond[z->joints.joint[j].bond].state != FL_BOND_ENDED)
            fl_zone_joint_add(&z->joints, j, k, s);
    }
    for (int32_t d = q->dashpot; d < q->dashpot_end; d++) {
        fl_vec3 own;
        const int32_t n = s->dashpot[d].node;
        const fl_vec3 in = is_wave_side(w->scene, s->dashpot[d].normal) ? wave : v3(0, 0, 0),
                      all = fl_zone_dashpot_force(s, d, in, &own);
        z->drag[n] = v3_add(z->drag[n], own);
        if (z->push) z->push[n] = v3_add(z->push[n], v3_sub(all, own));
    }
}

static double against(double force, double velocity)
{
    if (!(velocity > 0.0) && !(velocity < 0.0)) return 0.0;
    return velocity > 0.0 ? -LOCAL_SHARE * fabs(force) : LOCAL_SHARE * fabs(force);
}

/* Damping to rest of the free force f on a node. */
static fl_vec3 damping_of(const fl_world *w, int32_t n, fl_vec3 f)
{
    const fl_zone_set *s = &w->zones.set;
    const fl_vec3 v = s->v[n];
    if (w->relax.kind == FL_RELAX_LOCAL) return v3(against(f.x, v.x), against(f.y, v.y), against(f.z, v.z));
    if (w->relax.kind != FL_RELAX_ADAPTIVE) return v3(0, 0, 0);
    return v3_scale(-w->relax.rate * s->inertia[n], fl_zone_free_part(s->fixed[n], v));
}

/* What runs to rest need to know of the motion of a node. */
static void add_motion(const fl_world *w, int32_t n, fl_zone_sum *sum)
{
    const fl_zone_set *s = &w->zones.set;
    const fl_vec3 v = fl_zone_free_part(s->fixed[n], s->v[n]);
    sum->motion += s->inertia[n] * v3_norm2(v);
    if (w->relax.kind != FL_RELAX_ADAPTIVE) return;
    const fl_vec3 f = v3_sub(s->f[n], w->zones.drag[n]);
    sum->release += v3_dot(v, v3_sub(f, w->relax.node_force[n]));
    w->relax.node_force[n] = f;
}

/* All forces on a node, and damping to rest; returns the force that is not balanced. */
static double sum_node(const fl_world *w, int32_t n)
{
    const fl_zone_state *z = &w->zones;
    const fl_zone_set *s = &z->set;
    fl_vec3 f = v3_add(s->f[n], fl_zone_node_force(s, n));
    if (z->drag) f = v3_add(f, z->drag[n]);
    if (z->push) f = v3_add(f, z->push[n]);
    const fl_vec3 free_force = fl_zone_free_part(s->fixed[n], f);
    if (w->relax.kind) {
        const fl_vec3 d = damping_of(w, n, free_force);
        z->drag[n] = v3_add(z->drag[n], d);
        f = v3_add(f, d);
    }
    s->f[n] = f;
    return v3_norm2(free_force);
}

void fl_zones_second_half(fl_world *w, double h)
{
    fl_zone_state *z = &w->zones;
    fl_zone_set *s = &z->set;
    const fl_vec3 wave = z->push ? wave_now(w) : v3(0, 0, 0);
#pragma omp for schedule(static, 1) nowait
    for (int32_t k = 0; k < s->blocks; k++)
        if (!s->block[k].absent) load_block(w, k, wave);
    meet_team(w);
#pragma omp for schedule(static) nowait
    for (int32_t c = 0; c < s->node_chunks; c++) {
        const fl_zone_chunk q = s->node_chunk[c];
        double most = 0.0;
        if (s->block[q.block].absent) continue;
        s->sum[c].motion = s->sum[c].release = 0.0;
        for (int32_t n = q.from; n < q.to; n++) {
            most = fmax(most, sum_node(w, n));
            if (h > 0.0) kick_node(z, n, h, &s->sum[c]);
            if (w->relax.kind > FL_RELAX_LOCAL) add_motion(w, n, &s->sum[c]);
        }
        s->sum[c].unbalanced = most;
    }
    meet_team(w);
}

/* --- results ------------------------------------------------------------------------------------ */

void fl_zones_book(fl_world *w)
{
    fl_zone_state *z = &w->zones;
    for (int32_t c = 0; c < z->set.node_chunks; c++) {
        const fl_zone_sum *q = &z->set.sum[c];
        z->damping += q->damping_work;
        z->drive += q->input_work + q->drive_work;
    }
}

int fl_zones_fail(const fl_world *w, fl_err *err)
{
    const fl_zone_set *s = &w->zones.set;
    const int32_t zone = s->inside_out;
    int32_t k = 0;
    while (k + 1 < s->blocks && zone >= s->block[k].zone_end) k++;
    const fl_vec3 x = s->x[s->zone[zone][0]];
    return fl_fail(
        err, FL_NUMERIC,
        "body %d: a zone at (%g, %g, %g) m is turned inside out in step %lld (t = %g s); a smaller "
        "run.safety or stronger material is expected",
        w->id[s->block[k].body], x.x, x.y, x.z, (long long)w->step, fl_world_time(w));
}

double fl_zones_force_ratio(const fl_world *w)
{
    const fl_zone_set *s = &w->zones.set;
    double most = 0.0, sum = 0.0;
    int64_t n = 0;
    for (int32_t c = 0; c < s->node_chunks; c++)
        if (!s->block[s->node_chunk[c].block].absent) most = fmax(most, s->sum[c].unbalanced);
    for (int32_t b = 0; b < s->blocks; b++)
        for (int32_t k = s->block[b].zone; k < s->block[b].zone_end && !s->block[b].absent; k++)
            for (int e = 0; e < 4; e++) sum += v3_norm(s->work[k][e]), n++;
    return sum > 0.0 ? sqrt(most) * (double)n / sum : INFINITY;
}

void fl_zones_drop_absent(fl_world *w)
{
    fl_zone_set *s = &w->zones.set;
    for (int32_t k = 0; k < s->blocks; k++) s->block[k].absent = fl_body_absent(w, s->block[k].body);
}

void fl_zones_stop(fl_world *w)
{
    fl_zone_set *s = &w->zones.set;
    for (int32_t n = 0; n < s->nodes; n++) s->v[n] = v3_sub(s->v[n], fl_zone_free_part(s->fixed[n], s->v[n]));
}
