/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "water/wave_path.h"
#include <math.h>

void fl_wave_block_load(const fl_wave_block *c, const fl_wave_water *sea, const fl_wave_body *body,
                        double time, fl_vec3 x, fl_quat q, fl_wave_values *v, fl_submerged *wet, fl_vec3 *f,
                        fl_vec3 *t)
{
    const fl_mat3 R = q_matrix(q);
    fl_vec3 force, turn;
    fl_wave_block_values(c, sea->grid, time, x, q, v);
    if (body->mesh) { /* buoyancy is in the samples */
        *wet = (fl_submerged){.wetted_area = v->wetted};
        *f = v->f, *t = v->t;
        return;
    }
    const double n = 1.0 / sqrt(1.0 + v->slope[0] * v->slope[0] + v->slope[1] * v->slope[1]),
                 level = n * (v->z + sea->level - x.z);
    const fl_vec3 up = m3_tmul(R, v3(-n * v->slope[0], -n * v->slope[1], n));
    fl_wave_body_submerged(body, up, level, wet);
    fl_buoyancy_force(wet, up, level, sea->weight / n, &force, &turn);
    *f = v3_add(m3_mul(R, force), v->f);
    *t = v3_add(m3_mul(R, turn), v->t);
}

/* Components of the degrees of freedom from `first` on that are free. */
static fl_vec3 free_part(unsigned fixed, unsigned first, fl_vec3 a)
{
    return v3(fixed & first ? 0.0 : a.x, fixed & first << 1 ? 0.0 : a.y, fixed & first << 2 ? 0.0 : a.z);
}

/* A body on its way through a block. */
typedef struct {
    fl_vec3 x, v, turn, spin, a, alpha;
    double t;
} path_state;

typedef struct {
    const fl_wave_block *before; /* NULL: none */
    const fl_wave_water *sea;
    const fl_wave_body *body;
    const fl_bodies *b;
    int32_t i;
} path_forces;

/* Accelerations by water and weight, from the block before. */
static void path_acceleration(const path_forces *k, const fl_wave_block *next, path_state *p)
{
    const fl_bodies *b = k->b;
    const int32_t i = k->i;
    fl_wave_values v;
    fl_submerged wet;
    fl_vec3 f, t;
    if (!k->before) return;
    fl_wave_block_load(k->before, k->sea, k->body, p->t, p->x, fl_wave_block_attitude(next, p->turn), &v,
                       &wet, &f, &t);
    if (k->body->mesh) f = v3_add(f, k->body->other), t = v3_add(t, k->body->other_moment);
    else f = v3_sub(f, v3(0, 0, b->m[i] * k->sea->grid->gravity));
    p->a = free_part(b->fixed_dof[i], FL_DOF_X, fl_body_velocity_of_momentum(b, i, f));
    if (!b->is_isotropic[i])
        p->alpha = free_part(b->fixed_dof[i], FL_DOF_RX, fl_body_apply_inverse_inertia(b, i, t));
}

/* Steps from one sample to the next, and most of them for a mesh. */
enum { PATH_STEPS = 2, MOST_STEPS = 100 };
/* Step of the path of a mesh, over 1/omega of its stiffest motion. */
#define MESH_STEP 0.5

/* Waves may be much longer than a structure oscillates. Between the samples the oscillation needs no
 * resolution, as load and path are interpolated alike. */
static int path_steps(const path_forces *f, double left)
{
    const fl_bodies *b = f->b;
    const fl_wave_block *c = f->before;
    double omega2 = 0.0;
    if (!(left > 0.0)) return 1;
    if (!f->body->mesh || !c) return PATH_STEPS;
    for (int e = 0; e < 2; e++) {
        const double heave = fabs(c->change[e][2][2]) * b->invm[f->i];
        omega2 = fmax(omega2, heave);
        for (int k = 3; k < FL_WAVE_CHANGES; k++)
            omega2 = fmax(omega2, fabs(c->change[e][k][k]) * fl_body_max_inverse_inertia(b, f->i));
    }
    return (int)fmin(fmax(PATH_STEPS, ceil(left * sqrt(omega2) / MESH_STEP)), MOST_STEPS);
}

static void predict_path(const path_forces *f, double time, fl_wave_block *next)
{
    const fl_bodies *b = f->b;
    const int32_t i = f->i;
    path_state p = {.x = b->x[i], .v = b->v[i], .t = time};
    next->q = *fl_body_attitude(b, i);
    if (!b->is_isotropic[i]) p.spin = b->w[i];
    path_acceleration(f, next, &p);
    for (int k = 0; k < FL_WAVE_SAMPLES; k++) {
        const double left = fl_wave_sample_time(next, f->sea->grid, k) - p.t;
        const int steps = path_steps(f, left);
        const double h = left / steps;
        path_state q = p;
        for (int n = 0; n < steps; n++) {
            const fl_vec3 a = q.a, alpha = q.alpha;
            q.x = v3_madd(v3_madd(q.x, h, q.v), 0.5 * h * h, a);
            q.turn = v3_madd(v3_madd(q.turn, h, q.spin), 0.5 * h * h, alpha);
            q.t += h;
            if (left > 0.0) path_acceleration(f, next, &q);
            q.v = v3_madd(q.v, 0.5 * h, v3_add(a, q.a));
            q.spin = v3_madd(q.spin, 0.5 * h, v3_add(alpha, q.alpha));
        }
        next->x[k] = q.x, next->turn[k] = q.turn;
        if (left > 0.0) p = q;
    }
}

/* Long blocks that a body takes in halves after its load has jumped. */
enum { SHORT_BLOCKS = 3 };

/* A block that ended more than its own length ago does not tell the path. */
void fl_wave_block_begin(fl_wave_block *c, const fl_wave_water *sea, const fl_wave_body *body,
                         const fl_bodies *b, int32_t i, double time)
{
    const fl_quat q = *fl_body_attitude(b, i);
    const int64_t group = fl_wave_group(sea->grid, time);
    const int has_block = c->level != FL_WAVE_NO_BLOCK && time < fl_wave_sample_time(c, sea->grid, 6),
              ends = has_block && c->level + 3 * (int64_t)c->span == group;
    const path_forces forces = {has_block ? c : NULL, sea, body, b, i};
    fl_wave_block next = *c;
    fl_wave_values v;
    fl_submerged wet;
    fl_vec3 f, t, f2, t2;
    if (ends) fl_wave_block_load(c, sea, body, time, b->x[i], q, &v, &wet, &f, &t);
    if (!has_block || c->level < group || c->level >= group + FL_WAVE_GROUP) /* the start of a long block */
        next.span = c->short_blocks_left > 0 ? 1 : 2;
    next.level = fl_wave_block_level(sea->grid, time, next.span);
    predict_path(&forces, time, &next);
    fl_wave_block_fill(&next, sea, body);
    if (!has_block) { /* again, with its own forces in place of constant velocity */
        const fl_wave_block first = next;
        const path_forces own = {&first, sea, body, b, i};
        predict_path(&own, time, &next);
        fl_wave_block_fill(&next, sea, body);
    }
    *c = next;
    if (!ends) return;
    fl_wave_block_load(c, sea, body, time, b->x[i], q, &v, &wet, &f2, &t2);
    const double most = sea->grid->error * sea->weight * body->nodes->section * sea->deviation,
                 turn = most * body->reach;
    const int jumped = v3_norm2(v3_sub(f2, f)) > most * most || v3_norm2(v3_sub(t2, t)) > turn * turn;
    c->short_blocks_left = jumped ? SHORT_BLOCKS : c->short_blocks_left > 0 ? c->short_blocks_left - 1 : 0;
}
