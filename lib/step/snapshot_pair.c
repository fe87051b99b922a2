/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "step/snapshot_pair.h"
#include <string.h>
#include "base/mem.h"
#include "sphere/sphere_pair.h"
#include "step/balls.h"
#include "step/frozen.h"
#include "step/interact.h"
#include "contact/pair_law.h"
#include "contact/pair_response.h"
#include "contact/pair_store.h"
#include "step/rolls.h"

/* Rows at right angles, of length 1. */
static int turns(const fl_mat3 *M)
{
    for (int k = 0; k < 3; k++)
        for (int l = 0; l < 3; l++) {
            double sum = k == l ? -1.0 : 0.0;
            for (int m = 0; m < 3; m++) sum += M->m[k][m] * M->m[l][m];
            if (!(fabs(sum) < 1e-9)) return 0;
        }
    return 1;
}

/* What a pair remembers of its past. */
static void memory(fl_relay *t, fl_pair *p)
{
    int32_t mode = (int32_t)p->mode;
    fl_relay_whole(t, FL_MODE_NONE, FL_FF, &mode);
    p->mode = (fl_mode)mode;
    fl_relay_whole(t, 0, 1, &p->deep);
    fl_relay_whole(t, 0, 1, &p->has_axis);
    fl_relay_vec3(t, &p->axis);
    fl_relay_whole(t, 0, 4, &p->cache.n);
    for (int k = 0; k < p->cache.n && !t->err->code; k++) {
        fl_relay_whole(t, 0, INT32_MAX, &p->cache.a[k]);
        fl_relay_whole(t, 0, INT32_MAX, &p->cache.b[k]);
    }
    fl_relay_real(t, &p->asleep);
    fl_relay_real(t, &p->touch);
    fl_relay_vec3(t, &p->slip.force);
    fl_relay_real(t, &p->slip.k);
    fl_relay_real(t, &p->slip.moment);
    fl_relay_real(t, &p->slip.k_turn);
}

static void rolling(fl_relay *t, fl_roll *r)
{
    fl_relay_vec3(t, &r->kept);
    fl_relay_real(t, &r->k);
    fl_relay_vec3(t, &r->all);
    fl_relay_real(t, &r->arm);
}

/* What keeps a sphere from rolling, where anything does and it touches. */
static void roll_of(fl_relay *t, const fl_world *w, fl_pair *p)
{
    if (!p->n || !fl_rolls_pair(w, p)) return;
    if (!p->roll && !(p->roll = fl_alloc(1, sizeof *p->roll, t->err))) return;
    rolling(t, p->roll);
}

/* What its last evaluation found. */
static void forces(fl_relay *t, fl_pair *p)
{
    fl_vec3 *const all[] = {&p->f, &p->ti, &p->tj, &p->fd, &p->di, &p->dj, &p->fs, &p->si, &p->sj};
    for (int k = 0; k < 9; k++) fl_relay_vec3(t, all[k]);
    fl_relay_real(t, &p->energy);
    fl_relay_real(t, &p->spring);
    fl_relay_real(t, &p->overlap);
    fl_relay_real(t, &p->stiff_i);
    fl_relay_real(t, &p->stiff_j);
}

/* Unit or nothing. */
static int points(const double e[6])
{
    double sum = 0.0;
    for (int k = 0; k < 6; k++) sum += e[k] * e[k];
    return sum == 0.0 || fabs(sum - 1.0) < 1e-9;
}

/* What was learnt of the way can be. */
static int learnt(const fl_surrogate *s)
{
    double zero = 0.0 * (s->before.energy + s->steeper + s->back + s->owed + s->spreads + s->leans);
    for (int k = 0; k < 6; k++) zero += 0.0 * (s->third[k] + s->before.slope[k] + s->before.way[k]);
    return zero == 0.0 && points(s->along) && s->before.energy >= 0.0 && s->spreads >= 0.0 && s->leans >= 0.0;
}

/* What a contact remembers of its last look; all else follows from how the two stood then. */
static void look(fl_relay *t, const fl_pair *p, fl_surrogate *s)
{
    fl_relay_whole(t, 0, p->exponent == 0.0, &s->live);
    if (!s->live) return;
    fl_relay_whole(t, 0, 1, &s->used);
    for (int k = 0; k < 9; k++) fl_relay_real(t, &s->M.m[k / 3][k % 3]);
    fl_relay_vec3(t, &s->o);
    fl_relay_vec3(t, &s->own);
    fl_relay_real(t, &s->arm);
    fl_relay_real(t, &s->reach);
    fl_relay_real(t, &s->stiff_i);
    fl_relay_real(t, &s->stiff_j);
    for (int r = 0; r < 6; r++)
        for (int k = r; k < 6; k++) {
            fl_relay_real(t, &s->learnt[r][k]);
            s->learnt[k][r] = s->learnt[r][k];
        }
    for (int k = 0; k < 6; k++) {
        fl_relay_real(t, &s->along[k]);
        fl_relay_real(t, &s->third[k]);
        fl_relay_real(t, &s->before.slope[k]);
        fl_relay_real(t, &s->before.way[k]);
    }
    fl_relay_real(t, &s->before.energy);
    fl_relay_real(t, &s->steeper);
    fl_relay_real(t, &s->back);
    fl_relay_real(t, &s->owed);
    fl_relay_real(t, &s->spreads);
    fl_relay_real(t, &s->leans);
    if (t->in && !t->err->code &&
        !(turns(&s->M) && s->arm > 0.0 && s->reach > 0.0 && s->reach <= FL_SURROGATE_MOST && learnt(s)))
        fl_text_fail(t->in, t->err, "a look at a contact that is none");
}

/* The surrogate that was read gets what it looked at. */
static void look_again(fl_world *w, fl_pair *p, const fl_surrogate *seen, fl_err *err)
{
    p->surrogate = fl_alloc(1, sizeof *p->surrogate, err);
    if (!p->surrogate) return;
    *p->surrogate = *seen;
    p->surrogate->live = 0;
    p->surrogate->less = fl_surrogate_less(p->law->surrogate);
    if (fl_interact_again(w, p, &seen->M, seen->o))
        fl_fail(err, FL_SYSTEM, "out of memory for pair %d and %d", p->i, p->j);
    p->surrogate->used = seen->used;
}

void fl_snapshot_pair(fl_relay *t, fl_world *w, int32_t c)
{
    fl_near *near = &w->pair[c];
    fl_pair made = {0}, *p = near->full ? near->full : &made;
    if (t->f && p == &made) fl_near_pair(w, near, p);
    int32_t i = p->i, j = p->j;
    fl_relay_open(t, "pair");
    fl_relay_whole(t, 0, w->n - 1, &i);
    fl_relay_whole(t, 0, w->b.total - 1, &j);
    if (t->in) {
        const fl_near *q = c > 0 ? near - 1 : NULL;
        if (t->err->code) return;
        if (i >= j || (q && (q->i > i || (q->i == i && (w->cell.wraps ? q->j > j : q->j >= j))))) {
            fl_text_fail(t->in, t->err, "pair %d and %d found, pairs in rising order were wanted", i, j);
            return;
        }
        if (fl_sphere_pair_kind(w, i, j)) {
            fl_text_fail(t->in, t->err, "pair %d and %d is of spheres, a row \"ball\" was wanted", i, j);
            return;
        }
        fl_pair_start(w, p, i, j);
    }
    for (int axis = 0; w->cell.wraps && axis < 3; axis++)
        fl_relay_whole(t, -INT32_MAX, INT32_MAX, &p->image[axis]);
    if (t->in && !t->err->code && fl_frozen_stands(w, i, j, p->image))
        fl_text_fail(t->in, t->err, "pair %d and %d found, and their bond stands", i, j);
    if (t->in && !t->err->code) fl_frozen_enter(w, p);
    fl_relay_whole(t, 0, 1, &p->n);
    memory(t, p);
    if (p->n) forces(t, p);
    roll_of(t, w, p);
    fl_surrogate seen = {0};
    if (t->f && p->surrogate) seen = *p->surrogate;
    if (p->n && p->law->surrogate > 0.0) look(t, p, &seen);
    fl_relay_close(t);
    if (!t->in || t->err->code) return;
    fl_near_start(near, i, j, p->image);
    if (fl_near_keep(w, near, p)) fl_fail(t->err, FL_SYSTEM, "out of memory for pair %d and %d", i, j);
    else if (seen.live) look_again(w, near->full, &seen, t->err);
}

void fl_snapshot_ball(fl_relay *t, fl_world *w, int32_t c, int32_t last[2])
{
    const fl_balls *s = &w->balls;
    fl_ball_row r = {0};
    fl_roll roll = {.k = 0.0};
    int32_t i = 0, j = 0, hit = 0, image[3] = {0};
    double n;
    if (t->f && c < 0) {
        const fl_ball_lean *const l = &s->lean[~c];
        i = l->i, j = l->j, hit = l->hit, r = l->row;
        if (w->rolls) roll = s->lean_roll[~c];
    } else if (t->f) {
        i = s->i[c], j = s->j[c], hit = s->hit[c], r = s->row[c];
        if (w->rolls) roll = s->roll[c];
        if (s->image) memcpy(image, &s->image[3 * c], sizeof image);
    }
    fl_relay_open(t, "ball");
    fl_relay_whole(t, 0, w->n - 1, &i);
    fl_relay_whole(t, 0, w->b.total - 1, &j);
    for (int axis = 0; w->cell.wraps && axis < 3; axis++)
        fl_relay_whole(t, -INT32_MAX, INT32_MAX, &image[axis]);
    fl_relay_whole(t, 0, 1, &hit);
    fl_relay_real(t, &r.touch);
    fl_relay_vec3(t, &r.slip);
    fl_relay_real(t, &r.stiff);
    fl_relay_vec3(t, &r.rub);
    fl_relay_real(t, &r.damped);
    if (w->rolls) rolling(t, &roll);
    fl_relay_close(t);
    if (t->f || t->err->code) return;
    if (i >= j || i < last[0] || (i == last[0] && (w->cell.wraps ? j < last[1] : j <= last[1])) ||
        !fl_sphere_pair_kind(w, i, j)) {
        fl_text_fail(t->in, t->err, "spheres %d and %d found, pairs of spheres in rising order were wanted",
                     i, j);
        return;
    }
    last[0] = i, last[1] = j;
    r.k = fl_pairing_stiffness(w, i, j, &n);
    fl_balls_push(w, i, j, image, hit, &r, &roll, t->err);
}
