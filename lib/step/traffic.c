/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/mem.h"
#include "narrow/gjk.h"
#include "step/balls.h"
#include "step/frozen.h"
#include "step/search.h"
#include "step/sleep.h"
#include "step/pairing.h"
#include "step/step.h"
#include "step/traffic.h"
#include "step/works.h"

/* Copies stand where rounding puts them: neighbours that touch in the field may overlap by this fraction of
 * a floe's size, a million times the rounding of coordinates of a kilometre, and no contact feels it. */
#define TOUCH 1e-7

/* A floe that waits asks for its place once in so many steps. */
enum { PATIENCE = 16 };

int32_t fl_traffic_there(const fl_world *w)
{
    int32_t n = 0;
    for (int32_t i = 0; i < w->n; i++) n += !fl_world_away(w, i);
    return n;
}

static double along(const fl_traffic *t, fl_vec3 x) { return t->sign * (t->axis ? x.y : x.x); }

/* --- who leaves -------------------------------------------------------------------------------- */

static int beyond(const fl_world *w, int32_t i)
{
    const fl_traffic *t = &w->traffic;
    const fl_vec3 x = w->b.x[i];
    const double r = w->b.bound[i] + w->b.radius[i];
    return x.x + r < t->lo.x || x.x - r > t->hi.x || x.y + r < t->lo.y || x.y - r > t->hi.y ||
           x.z + r < t->lo.z || x.z - r > t->hi.z;
}

static void take_out(fl_world *w, int32_t i)
{
    fl_traffic *t = &w->traffic;
    fl_bodies *b = &w->b;
    t->away[i] = 1;
    if (w->critical_body == i) w->critical_body = -1; /* its name goes with it */
    t->left++;
    t->mass_left += b->m[i];
    t->momentum_left = v3_madd(t->momentum_left, b->m[i], b->v[i]);
    b->v[i] = b->L[i] = b->w[i] = b->f[i] = b->t[i] = v3(0, 0, 0);
    fl_works_clear(w, i);
}

/* End the pairs of those that are away, and let their partners feel it. */
static int drop_pairs(fl_world *w, fl_err *err)
{
    int32_t kept = 0;
    fl_frozen_drop(w);
    for (int32_t c = 0; c < w->n_pair; c++) {
        fl_near *p = &w->pair[c];
        const int32_t i = p->i, j = p->j;
        if (!fl_world_away(w, i) && !(j < w->n && fl_world_away(w, j))) {
            w->pair[kept++] = *p;
            continue;
        }
        fl_near_end(w, p);
        p->n = 0;
    }
    w->n_pair = kept;
    kept = 0;
    for (int32_t k = 0; k < w->press.n_now; k++)
        if (!fl_world_away(w, w->press.now[k].i)) w->press.now[kept++] = w->press.now[k];
    w->press.n_now = kept;
    if (fl_search_index(w, err) || fl_balls_drop(w, err)) return -1;
    for (int32_t k = 0; k < w->b.total; k++)
        if (k >= w->n || !fl_world_away(w, k)) fl_step_gather(w, k);
    return 0;
}

/* --- who comes --------------------------------------------------------------------------------- */

/* The vertices of the core of thing k about `origin`, in world axes. */
static int around(const fl_world *w, int32_t k, fl_vec3 origin, fl_vec3 **v, int32_t *cap, fl_err *err)
{
    const fl_poly *p = &w->b.core[k];
    const fl_vec3 x = v3_sub(w->b.x[k], origin);
    const fl_mat3 R = fl_body_axes(&w->b, k);
    if (fl_grow(v, cap, p->nv, sizeof **v, err)) return -1;
    for (int32_t n = 0; n < p->nv; n++) (*v)[n] = v3_add(x, m3_mul(R, p->v[n]));
    return 0;
}

/* The number of lengths between two coordinates, to the nearest image. */
static double nearest(double apart, double length) { return length > 0.0 ? round(apart / length) : 0.0; }

/* 1 when nothing that is there overlaps floe i, 0 when something does. */
static int is_free(const fl_world *w, int32_t i, fl_err *err)
{
    const fl_bodies *b = &w->b;
    const fl_vec3 L = w->cell.length;
    const double size = b->bound[i] + b->radius[i];
    fl_vec3 *va = NULL, *vb = NULL;
    int32_t cap_a = 0, cap_b = 0;
    int is = around(w, i, b->x[i], &va, &cap_a, err) ? -1 : 1;
    for (int32_t k = 0; k < b->total - w->walls && is == 1; k++) {
        if (k == i || (k < w->n && fl_world_away(w, k))) continue;
        fl_vec3 off = v3_sub(b->x[k], b->x[i]), origin = b->x[i];
        if (w->cell.wraps) {
            const fl_vec3 way =
                fl_cell_way(&w->cell, v3(nearest(off.x, L.x), nearest(off.y, L.y), nearest(off.z, L.z)));
            off = v3_sub(off, way);
            origin = v3_add(origin, way);
        }
        const double R = b->radius[i] + b->radius[k];
        if (v3_norm(off) > size + b->bound[k] + b->radius[k]) continue;
        fl_gap gap;
        if (around(w, k, origin, &vb, &cap_b, err)) {
            is = -1;
            break;
        }
        fl_gjk((fl_core){va, b->core[i].nv, &b->core[i]}, (fl_core){vb, b->core[k].nv, &b->core[k]}, NULL,
               &gap);
        if (gap.overlap || gap.d < R - TOUCH * size) is = 0;
    }
    free(va), free(vb);
    return is;
}

/* Put the next copy of floe k into place i, its foremost point `in` beyond the bound. */
static int stand(fl_world *w, int32_t i, int32_t k, double in, fl_err *err)
{
    fl_traffic *t = &w->traffic;
    fl_bodies *b = &w->b;
    double front = -INFINITY;
    t->floe[i] = k;
    if (fl_world_put(w, i, t->feed, k, err)) return -1;
    const fl_mat3 R = fl_body_axes(b, i);
    for (int32_t v = 0; v < b->core[i].nv; v++)
        front = fmax(front, along(t, v3_add(b->x[i], m3_mul(R, b->core[i].v[v]))));
    const double way = t->sign * (t->entry + in - front - b->radius[i]);
    const fl_vec3 drift = v3(t->axis ? 0.0 : t->sign * t->speed, t->axis ? t->sign * t->speed : 0.0, 0.0);
    b->x[i] = v3_add(b->x[i], v3(t->axis ? 0.0 : way, t->axis ? way : 0.0, 0.0));
    b->v[i] = drift;
    fl_body_spin(b, i, v3(0, 0, 0));
    return 0;
}

static void take_in(fl_world *w, int32_t i)
{
    fl_traffic *t = &w->traffic;
    fl_bodies *b = &w->b;
    t->away[i] = 0;
    fl_sleep_new(w, i);
    t->guided[i] = 1;
    t->hold[i] = b->hold[i];
    b->hold[i] = FL_HOLD_X | FL_HOLD_Y | FL_HOLD_RZ;
    w->id[i] = t->next_id++;
    t->born[i] = w->step;
    t->entered++;
    t->mass_entered += b->m[i];
    t->momentum_entered = v3_madd(t->momentum_entered, b->m[i], b->v[i]);
    fl_step_gather(w, i);
    w->found_at = -1;
}

/* Fields that do not come in because nobody looked: more in one step are a scene gone wrong. */
#define MOST_BEHIND 1e9

/* The copies of floe k that are due.  Returns 0 or -1; *came counts who comes in. */
static int let_in(fl_world *w, int32_t k, int32_t *place, int *came, fl_err *err)
{
    fl_traffic *t = &w->traffic;
    const double way = t->speed * fl_world_time(w), step = t->speed * w->dt;
    for (;;) {
        const double late = way - t->lag[k] - (double)t->tile[k] * t->pitch;
        if (late < 0.0) return 0;
        if (late >= t->pitch) {
            const double behind = floor(late / t->pitch);
            if (!(behind < MOST_BEHIND))
                return fl_fail(err, FL_NUMERIC, "inflow is %.3g fields behind in step %lld (t = %g s)",
                               behind, (long long)w->step, fl_world_time(w));
            t->tile[k] += (int64_t)behind;
            t->missed += (int64_t)behind;
            continue;
        }
        const int first = late < step * (1.0 + 1e-9); /* also what is due at the start */
        if (!first && w->step % PATIENCE) return 0;
        while (*place < w->n && !t->away[*place]) ++*place;
        int is = 0;
        if (*place < w->n) {
            if (stand(w, *place, k, first ? late : 0.0, err)) return -1;
            is = is_free(w, *place, err);
            if (is < 0) return -1;
        }
        if (!is) {
            t->waited += first;
            return 0;
        }
        if (t->next_id == INT32_MAX) return fl_fail(err, FL_NUMERIC, "there is no number left for a floe");
        take_in(w, *place);
        t->tile[k]++;
        ++*came;
    }
}

/* Floes whose last point has passed the bound go on by themselves. */
static void let_go(fl_world *w)
{
    fl_traffic *t = &w->traffic;
    const fl_bodies *b = &w->b;
    for (int32_t i = 0; i < w->n; i++) {
        if (!t->guided[i] || t->away[i]) continue;
        double last = INFINITY;
        const fl_mat3 R = fl_body_axes(b, i);
        for (int32_t v = 0; v < b->core[i].nv; v++)
            last = fmin(last, along(t, v3_add(b->x[i], m3_mul(R, b->core[i].v[v]))));
        if (last - b->radius[i] < t->entry) continue;
        t->guided[i] = 0;
        b->hold[i] = t->hold[i];
    }
}

/* --- both -------------------------------------------------------------------------------------- */

static int due(const fl_world *w)
{
    const fl_traffic *t = &w->traffic;
    const double way = t->speed * fl_world_time(w);
    for (int32_t k = 0; t->feed && k < t->feed->n; k++)
        if (way >= t->lag[k] + (double)t->tile[k] * t->pitch) return 1;
    return 0;
}

int fl_traffic_step(fl_world *w, fl_err *err)
{
    fl_traffic *t = &w->traffic;
    fl_ledger *g = &w->ledger;
    fl_works before, after;
    int out = 0, came = 0;
    int32_t place = 0;
    if (t->feed) let_go(w);
    for (int32_t i = 0; i < w->n && !out; i++) out = !t->away[i] && !t->guided[i] && beyond(w, i);
    if (!out && !due(w)) return 0;
    fl_sleep_look(w);
    fl_step_ledger(w);
    const double residual = g->residual, throughput = g->throughput;
    if (out) {
        /* What lies ahead is booked, and will not be given by the contacts that end. */
        before = fl_works_ahead(w);
        for (int32_t i = 0; i < w->n; i++)
            if (!t->away[i] && !t->guided[i] && beyond(w, i)) take_out(w, i);
        if (drop_pairs(w, err)) return -1;
        fl_sleep_wake(w);
        after = fl_works_ahead(w);
        g->damping -= before.damping - after.damping;
        g->friction -= before.friction - after.friction;
        g->drive -= before.drive - after.drive;
    }
    for (int32_t k = 0; t->feed && k < t->feed->n; k++)
        if (let_in(w, k, &place, &came, err)) return -1;
    fl_step_ledger(w);
    g->carried += g->residual - residual;
    g->throughput = throughput;
    fl_sleep_back(w);
    return 0;
}
