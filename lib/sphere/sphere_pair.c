/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "contact/pair_law.h"
#include "contact/pair_store.h"
#include "law/normal.h"
#include "step/balls.h"
#include "sphere/sphere_pair.h"
#include "step/rolls.h"

enum fl_sphere_kind fl_sphere_pair_kind(const fl_world *w, int32_t i, int32_t j)
{
    if (!w->b.ball[i]) return FL_SPHERE_NONE;
    const int wall = j >= w->n + w->pieces && !w->structure.piece[j - w->n].elastic;
    if (!wall && (j >= w->n || !w->b.ball[j])) return FL_SPHERE_NONE;
    const int32_t law = fl_pairing_law(w, i, j)->kind;
    if (law != FL_LAW_PATCH && law != FL_LAW_CORE) return FL_SPHERE_NONE;
    return wall ? FL_SPHERE_WALL : FL_SPHERE_SPHERE;
}

void fl_ball_pair(const fl_world *w, int32_t i, int32_t j, const fl_ball_row *r, const fl_roll *roll, int hit,
                  fl_vec3 n, double over, fl_pair *p)
{
    const fl_bodies *b = &w->b;
    const double arm = b->radius[i] - 0.5 * over;
    fl_pair_start(w, p, i, j);
    p->asleep = b->odometer[i] + b->odometer[j] + (over < 0.0 ? -over : 0.0);
    p->n = hit;
    if (!hit) return;
    p->slip.force = r->slip;
    p->slip.k = r->stiff;
    p->touch = r->touch;
    p->overlap = over;
    p->fd = v3_scale(r->damped, n);
    p->fs = r->rub;
    p->f = v3_madd(r->rub, r->k * fl_normal_power(over, 1.5) + r->damped, n);
    p->si = p->ti = v3_madd(fl_rolls_moment(roll), -arm, v3_cross(n, r->rub));
    p->spring = fl_ball_spring(r, roll);
    p->energy = r->k * fl_normal_phi(over, 1.5) + p->spring;
    p->stiff_i = fl_stiff_point(b, i, r->k * fl_normal_slope(over, 1.5), r->stiff, arm,
                                roll ? fl_rolls_stiff(roll) : 0.0);
}
