/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/mem.h"
#include "body/integrate.h"
#include "law/damping.h"
#include "law/normal.h"
#include "law/sphere.h"
#include "sphere/sphere_pair.h"
#include "step/lead.h"
#include "step/leans.h"
#include "contact/pair_law.h"
#include "contact/pair_response.h"
#include "contact/pair_store.h"
#include "step/rolls.h"
#include "step/stiff.h"

/* --- which there are --------------------------------------------------------------------------- */

int fl_leans_push(fl_world *w, int32_t i, int32_t j, int hit, const fl_ball_row *row, const fl_roll *roll,
                  fl_err *err)
{
    fl_balls *s = &w->balls;
    const int64_t n = (int64_t)s->leans + 1;
    if (fl_grow(&s->lean, &s->lean_cap, n, sizeof *s->lean, err)) return -1;
    if (w->rolls) {
        if (fl_grow(&s->lean_roll, &s->lean_roll_cap, n, sizeof *s->lean_roll, err)) return -1;
        s->lean_roll[s->leans] = *roll;
    }
    s->lean[s->leans++] = (fl_ball_lean){
        .i = i, .j = j, .law = (int32_t)(fl_pairing_law(w, i, j) - w->law), .hit = hit, .row = *row};
    return 0;
}

static int before(const fl_ball_lean *a, int32_t i, int32_t j) { return a->i != i ? a->i < i : a->j < j; }

int fl_leans_list(fl_world *w, int64_t n, fl_err *err)
{
    fl_balls *s = &w->balls;
    fl_ball_lean *const old = s->lean;
    fl_roll *const rolled = s->lean_roll, none = {.k = 0.0};
    const int32_t n_old = s->leans;
    int32_t at = 0;
    if (n > INT32_MAX) return fl_fail(err, FL_SYSTEM, "out of memory: %lld spheres at walls", (long long)n);
    s->leans = s->lean_cap = s->lean_roll_cap = 0;
    s->lean = fl_alloc(n, sizeof *s->lean, err);
    s->lean_roll = w->rolls && s->lean ? fl_alloc(n, sizeof *s->lean_roll, err) : NULL;
    if (!s->lean || (w->rolls && !s->lean_roll)) {
        free(old), free(rolled);
        return -1;
    }
    s->lean_cap = (int32_t)n;
    s->lean_roll_cap = w->rolls ? (int32_t)n : 0;
    for (int32_t i = 0; i < w->n; i++) {
        for (int64_t k = w->near.first[i]; k < w->near.first[i + 1]; k++) {
            const int32_t j = w->near.partner[k];
            double exponent;
            if (fl_sphere_pair_kind(w, i, j) != FL_SPHERE_WALL) continue;
            while (at < n_old && before(&old[at], i, j)) at++;
            if (at < n_old && old[at].i == i && old[at].j == j) {
                if (rolled) s->lean_roll[s->leans] = rolled[at];
                s->lean[s->leans++] = old[at];
            } else {
                const fl_ball_row fresh = {.k = fl_pairing_stiffness(w, i, j, &exponent)};
                fl_leans_push(w, i, j, 0, &fresh, &none, err);
            }
        }
    }
    free(old), free(rolled);
    return 0;
}

int fl_leans_drop(fl_world *w)
{
    fl_balls *s = &w->balls;
    int32_t kept = 0;
    for (int32_t c = 0; c < s->leans; c++) {
        if (fl_world_away(w, s->lean[c].i)) continue;
        if (s->lean_roll) s->lean_roll[kept] = s->lean_roll[c];
        s->lean[kept++] = s->lean[c];
    }
    const int dropped = kept < s->leans;
    s->leans = kept;
    return dropped;
}

void fl_leans_index(fl_balls *s)
{
    int32_t c = 0;
    for (int32_t a = 0; a < s->chunks; a++) {
        s->lean_first[a] = c;
        for (; c < s->leans && s->lean[c].i < (a + 1) * FL_BALLS_CHUNK; c++)
            s->touching[s->lean[c].i] += s->lean[c].hit;
    }
    s->lean_first[s->chunks] = c;
}

/* --- their forces ------------------------------------------------------------------------------ */

/* Normal of wall j, away from what is behind it, and height of i over it. */
static fl_vec3 normal_of(const fl_world *w, int32_t j) { return m3_col(fl_body_axes(&w->b, j), 2); }
static double height(const fl_world *w, int32_t i, int32_t j, fl_vec3 n)
{
    return v3_dot(n, v3_sub(w->b.x[i], w->b.x[j]));
}

static double overlap(const fl_world *w, const fl_ball_lean *c, fl_vec3 n)
{
    return w->b.radius[c->i] - height(w, c->i, c->j, n);
}

/* The m-th of some: a centre behind the wall, whose foot would be on the wrong side of it, finds a sphere in
 * place of the wall that is as far below as it takes. */
static void load(const fl_world *w, fl_spheres *a, int32_t m, const fl_ball_lean *c, fl_vec3 n, double z)
{
    const fl_bodies *b = &w->b;
    const fl_touching *law = &w->law[c->law];
    const fl_ball_row *r = &c->row;
    const double radius = b->radius[c->i], below = z > 0.0 ? 0.0 : radius - 2.0 * z;
    const fl_vec3 d = v3_scale(z + below, n), u = b->v[c->i], spin = b->w[c->i];
    const fl_ball_seen *const seen = &w->balls.seen[c->i];
    a->d[0][m] = d.x, a->d[1][m] = d.y, a->d[2][m] = d.z;
    a->u[0][m] = u.x, a->u[1][m] = u.y, a->u[2][m] = u.z;
    a->wi[0][m] = spin.x, a->wi[1][m] = spin.y, a->wi[2][m] = spin.z;
    a->wj[0][m] = a->wj[1][m] = a->wj[2][m] = 0.0;
    /* of both arms the law takes the same part; the sphere's own is r - s/2 */
    const double s = radius - z, both = radius + below - s, own = (radius - 0.5 * s) / radius,
                 arm = both > 0.0 ? own * (radius + below) / both : 1.0;
    const fl_vec3 rdw = v3_scale(arm, seen->rdw);
    a->du[0][m] = seen->dv.x, a->du[1][m] = seen->dv.y, a->du[2][m] = seen->dv.z;
    a->rdw[0][m] = rdw.x, a->rdw[1][m] = rdw.y, a->rdw[2][m] = rdw.z;
    a->ri[m] = radius;
    a->rj[m] = below;
    a->yields[m] = fl_body_free(b, c->i) ? b->invm[c->i] : fl_body_yields(b, c->i, n);
    a->invm[m] = law->rest * law->rest * a->yields[m];
    a->turns[m] = arm * arm * seen->turns;
    a->across[m] = b->invm[c->i];
    a->many[m] = fl_damping_among(seen->crowd, 0.0, b->invm[c->i]);
    a->k[m] = r->k;
    a->friction[m] = law->friction;
    a->tangential[m] = law->tangential;
    a->chi[m] = law->chi;
    a->touch[m] = r->touch;
    a->slip[0][m] = r->slip.x, a->slip[1][m] = r->slip.y, a->slip[2][m] = r->slip.z;
    a->stiff[m] = r->stiff;
    a->rub[0][m] = r->rub.x, a->rub[1][m] = r->rub.y, a->rub[2][m] = r->rub.z;
    a->damped[m] = r->damped;
}

static fl_vec3 vector(const double a[3][FL_SPHERES_MOST], int32_t m) { return v3(a[0][m], a[1][m], a[2][m]); }

static void save(fl_ball_row *r, const fl_spheres *a, int32_t m)
{
    r->slip = vector(a->slip, m);
    r->stiff = a->stiff[m];
    r->rub = vector(a->rub, m);
    r->damped = a->damped[m];
    r->touch = a->touch[m];
}

static void hand_out(fl_ball_sum *sum, const fl_spheres *a, int32_t m)
{
    sum->elastic = v3_add(sum->elastic, vector(a->push, m));
    sum->damping = v3_add(sum->damping, vector(a->damping, m));
    sum->friction = v3_add(sum->friction, vector(a->rub, m));
    sum->torque = v3_add(sum->torque, vector(a->ti, m));
}

static void count(fl_ball_tally *t, const fl_spheres *a, int32_t m, int32_t c)
{
    const double deep = a->overlap[m] / a->ri[m];
    t->force += a->size[m];
    t->touching++;
    if (deep > t->worst) t->worst = deep, t->worst_row = ~c;
}

/* Middle of the overlap, from the wall's point. */
static fl_vec3 middle(const fl_world *w, const fl_ball_lean *c, fl_vec3 n, double over)
{
    return v3_madd(v3_sub(w->b.x[c->i], w->b.x[c->j]), 0.5 * over - w->b.radius[c->i], n);
}

/* What the m-th of them does to the wall, roll being what keeps it from rolling. */
static void press(const fl_world *w, fl_ball_load *load, const fl_ball_lean *c, const fl_roll *roll,
                  fl_vec3 n, const fl_spheres *a, int32_t m)
{
    const fl_vec3 F = v3_madd(vector(a->rub, m), a->elastic[m] + a->damped[m], n);
    load->f = v3_sub(load->f, F);
    load->t = v3_sub(load->t, v3_cross(middle(w, c, n, a->overlap[m]), F));
    load->t = v3_sub(load->t, fl_rolls_moment(roll));
}

/* What those of chunk a do to wall j. */
static fl_ball_load *load_of(const fl_world *w, int32_t a, int32_t j)
{
    return &w->balls.load[a * w->walls + (j - w->n - w->pieces)];
}

/* Rows of a chunk in work. */
typedef struct {
    fl_spheres at;
    int32_t row[FL_SPHERES_MOST];
    fl_vec3 n[FL_SPHERES_MOST];
    int32_t m;
} batch;

/* What keeps them from rolling. */
static void roll(const fl_world *w, batch *q, double dt)
{
    const fl_balls *s = &w->balls;
    fl_rolls_row row[FL_SPHERES_MOST];
    for (int32_t m = 0; m < q->m; m++) {
        const fl_ball_lean *const c = &s->lean[q->row[m]];
        row[m] = (fl_rolls_row){&w->law[c->law], &s->lean_roll[q->row[m]], c->i, -1};
    }
    fl_rolls_meet(w, &q->at, row, q->m, dt);
}

/* Row c, or NULL. */
static const fl_roll *roll_of(const fl_balls *s, int32_t c) { return s->lean_roll ? &s->lean_roll[c] : NULL; }

static void finish(fl_world *w, int32_t chunk, batch *q, double dt, int survey)
{
    fl_balls *s = &w->balls;
    fl_spheres *a = &q->at;
    if (dt < 0.0) fl_spheres_place(a, q->m);
    else fl_spheres_meet(a, q->m, dt, fl_lead_span(w, dt).half);
    if (s->lean_roll) roll(w, q, dt);
    for (int32_t m = 0; m < q->m; m++) {
        fl_ball_lean *const c = &s->lean[q->row[m]];
        const fl_roll *const rolls = roll_of(s, q->row[m]);
        if (dt >= 0.0) save(&c->row, a, m);
        hand_out(&s->sum[c->i], a, m);
        press(w, load_of(w, chunk, c->j), c, rolls, q->n[m], a, m);
        count(&s->tally[chunk], a, m, q->row[m]);
        if (survey)
            s->stiff[c->i] +=
                fl_stiff_point(&w->b, c->i, a->slope[m], a->stiff[m], a->ri[m] - 0.5 * a->overlap[m],
                               rolls ? fl_rolls_stiff(rolls) : 0.0);
    }
    q->m = 0;
}

void fl_leans_touch(fl_world *w, int32_t a, double dt, int survey)
{
    fl_balls *s = &w->balls;
    batch q; /* large: not cleared */
    fl_vec3 up = v3(0, 0, 0);
    q.m = 0;
    for (int32_t k = 0; k < w->walls; k++) s->load[a * w->walls + k] = (fl_ball_load){0};
    for (int32_t c = s->lean_first[a], wall = -1; c < s->lean_first[a + 1]; c++) {
        fl_ball_lean *const l = &s->lean[c];
        if (l->j != wall) up = normal_of(w, wall = l->j);
        const double z = height(w, l->i, l->j, up);
        const int touches = z < w->b.radius[l->i];
        if (dt >= 0.0 && touches != l->hit) {
            if (l->hit) l->row = (fl_ball_row){.k = l->row.k};
            if (l->hit && s->lean_roll) s->lean_roll[c] = (fl_roll){.k = 0.0};
            l->hit = touches;
            fl_balls_turn(s, l->i, touches ? 1 : -1);
        }
        if (!l->hit) continue;
        load(w, &q.at, q.m, l, up, z);
        q.n[q.m] = up;
        q.row[q.m++] = c;
        if (q.m == FL_SPHERES_MOST) finish(w, a, &q, dt, survey);
    }
    if (q.m) finish(w, a, &q, dt, survey);
}

void fl_leans_press(const fl_world *w, int32_t j, fl_vec3 *f, fl_vec3 *t)
{
    for (int32_t a = 0; a < w->balls.chunks; a++) {
        const fl_ball_load *const load = load_of(w, a, j);
        *f = v3_add(*f, load->f);
        *t = v3_add(*t, load->t);
    }
}

void fl_leans_energy(const fl_world *w, int32_t a, double *all, double *springs)
{
    const fl_balls *s = &w->balls;
    for (int32_t c = s->lean_first[a]; c < s->lean_first[a + 1]; c++) {
        const fl_ball_lean *const l = &s->lean[c];
        if (!l->hit) continue;
        const double held = fl_ball_spring(&l->row, roll_of(s, c));
        *all += l->row.k * fl_normal_phi(overlap(w, l, normal_of(w, l->j)), 1.5) + held;
        *springs += held;
    }
}

void fl_leans_pair(const fl_world *w, int32_t c, fl_pair *p)
{
    const fl_ball_lean *const l = &w->balls.lean[c];
    const fl_vec3 n = normal_of(w, l->j);
    const double over = overlap(w, l, n);
    const fl_vec3 at = middle(w, l, n, over);
    fl_ball_pair(w, l->i, l->j, &l->row, roll_of(&w->balls, c), l->hit, n, over, p);
    if (!p->n) return;
    const fl_vec3 moment = v3_neg(fl_rolls_moment(roll_of(&w->balls, c)));
    p->tj = v3_sub(moment, v3_cross(at, p->f));
    p->dj = v3_neg(v3_cross(at, p->fd));
    p->sj = v3_sub(moment, v3_cross(at, p->fs));
}
