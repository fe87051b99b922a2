/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <omp.h>
#include "base/array.h"
#include "body/integrate.h"
#include "sim/body_step.h"
#include "sim/sleep.h"
#include "sim/energy_ledger.h"

enum {
    WINDOW = 64,    /* steps over which it is seen whether a floe rests */
    LEAST = 4,      /* steps: a shorter sleep is not worth while, and who cannot sleep is not asked before */
    SELDOM = 64,    /* steps: and not much later */
    MOST = 1 << 14, /* steps: doubling ends here */
    LONGEST = 1 << 20 /* windows of rest */
};

/* What fl_sleep_advance_to_now() changes of a floe. */
struct fl_sleep_saved {
    fl_vec3 x, v, L, w, f, t;
    fl_quat q;
    double held, odometer, carried, drained, blown, waved;
    fl_sleep_state nap;
};

int fl_sleep_make(fl_world *w, fl_err *err)
{
    fl_sleep *s = &w->sleep;
    if (!(w->scene->run.sleep > 0.0)) return 0;
    s->tol = w->scene->run.sleep;
    s->state = fl_alloc(w->n, sizeof *s->state, err);
    s->phase = fl_alloc(w->n, sizeof *s->phase, err);
    s->phase_end = fl_alloc(w->n, sizeof *s->phase_end, err);
    s->saved = fl_alloc(w->n, sizeof *s->saved, err);
    s->stack = fl_alloc(w->n, sizeof *s->stack, err);
    if (!s->state || !s->phase || !s->phase_end || !s->saved || !s->stack) return -1;
    for (int32_t j = 0; j < w->sea.wave.n; j++) {
        s->surface_speed += w->sea.wave.train[j].a * w->sea.wave.train[j].omega;
        s->surface_slope += w->sea.wave.train[j].a * w->sea.wave.train[j].k;
    }
    for (int32_t k = 0; k < w->n; k++) fl_sleep_reset_body(w, k);
    return 0;
}

void fl_sleep_reset_body(fl_world *w, int32_t i)
{
    if (!w->sleep.state) return;
    fl_sleep_state *nap = &w->sleep.state[i];
    *nap = (fl_sleep_state){.since_step = w->step,
                            .next_skip = LEAST,
                            .window_odometer = -1.0,
                            .max_error = nap->max_error,
                            .sum_error = nap->sum_error,
                            .ballistic_steps = nap->ballistic_steps,
                            .n_skips = nap->n_skips,
                            .resting_steps = nap->resting_steps};
    w->sleep.phase[i] = FL_AWAKE;
    w->sleep.phase_end[i] = 0;
}

double fl_sleep_bytes(const fl_world *w)
{
    const fl_sleep *s = &w->sleep;
    return s->state ? (double)w->n * (double)(sizeof *s->state + sizeof *s->saved + sizeof *s->phase +
                                              sizeof *s->phase_end + sizeof *s->stack) +
                          (double)s->pair_due_cap * (double)sizeof *s->pair_due
                    : 0.0;
}

void fl_sleep_free(fl_sleep *s)
{
    free(s->state), free(s->phase), free(s->phase_end), free(s->saved), free(s->stack), free(s->pair_due);
    *s = (fl_sleep){0};
}

/* --- who coasts -------------------------------------------------------------------------------- */

/* The floe k over s seconds by what acts at the begin: weight, water, springs, wind.  First half ... */
void fl_sleep_first_half(fl_world *w, int32_t k)
{
    fl_sleep_state *nap = &w->sleep.state[k];
    fl_body_accelerations(&w->b, k, &nap->acceleration, &nap->angular_acceleration);
}

static void out(fl_world *w, int32_t k, double s)
{
    fl_sleep_first_half(w, k);
    fl_body_first_half(w, k, s);
}

/* What a step of s seconds is off by, when it has been made: the forces of now are those that stay, and v and
 * spin what the speeds were before the last drag [m]. */
static double off_by(fl_world *w, int32_t k, double s, fl_vec3 v, fl_vec3 spin)
{
    fl_sleep_state *nap = &w->sleep.state[k];
    const fl_bodies *b = &w->b;
    const double slowed = nap->drag_rate, r = b->bounding_radius[k], turned = v3_norm(spin) * s;
    fl_vec3 a, turn;
    fl_body_accelerations(b, k, &a, &turn);
    nap->drag_rate = (v3_norm(v3_sub(b->v[k], v)) + r * v3_norm(v3_sub(b->w[k], spin))) / (0.5 * s);
    return s * s / 12.0 *
               (v3_norm(v3_sub(a, nap->acceleration)) + r * v3_norm(v3_sub(turn, nap->angular_acceleration)) +
                fabs(nap->drag_rate - slowed)) +
           r * turned * turned * turned / 12.0;
}

/* ... and second; returns what it is off by [m]. */
static double back(fl_world *w, int32_t k, double s)
{
    const fl_bodies *b = &w->b;
    fl_body_kick(w, k, 0.5 * s);
    const fl_vec3 v = b->v[k], spin = b->w[k];
    if (w->sea.n) fl_environment_drag(&w->sea, &w->b, k, 0.5 * s, 1);
    return off_by(w, k, s, v, spin);
}

/* How a floe goes: bounds of the speeds of its points and of what changes these [m/s], [m/s2]. */
typedef struct {
    double speed, turn;     /* of the centre; about it [1/s]       */
    double faster, turning; /* the same by what acts, drag apart; [1/s2] */
} pace;

static pace pace_of(const fl_world *w, int32_t k)
{
    const fl_bodies *b = &w->b;
    const double ease = fl_body_max_inverse_inertia(b, k);
    fl_vec3 a, turn;
    fl_body_accelerations(b, k, &a, &turn);
    double torque = v3_norm(b->t[k]);
    if (b->added_mass) {
        const fl_vec3 u = v3_sub(b->v[k], b->flow_velocity[k]);
        torque += v3_norm(fl_body_momentum(b, k, u)) * v3_norm(u);
    }
    return (pace){v3_norm(b->v[k]), v3_norm(b->L[k]) * ease, v3_norm(a), torque * ease};
}

/* The bound of the path of floe k over s seconds from now on. */
static double way_of(const fl_world *w, int32_t k, const pace *p, double s)
{
    const double r = w->b.bounding_radius[k];
    return s * (p->speed + r * p->turn) +
           s * s * (0.5 * (p->faster + r * p->turning) + w->sleep.state[k].drag_rate);
}

/* It may be beyond the bounds of the domain by now. */
static int may_have_left(const fl_world *w, int32_t k)
{
    const fl_inflow_state *t = &w->inflow;
    const fl_vec3 x = w->b.x[k];
    const double r = w->b.bounding_radius[k] + w->b.radius[k] - w->sleep.state[k].path_bound;
    return t->absent && (x.x + r < t->lo.x || x.x - r > t->hi.x || x.y + r < t->lo.y || x.y - r > t->hi.y ||
                         x.z + r < t->lo.z || x.z - r > t->hi.z);
}

/* Several threads may have a body in hand. */
static void end_sleep(uint8_t *kind)
{
    uint8_t is;
#pragma omp atomic read
    is = *kind;
    if (is != FL_BALLISTIC) return;
#pragma omp atomic write
    *kind = FL_WAKING;
}

/* The pairs of thing k that have to be looked at. */
static void call_pairs(fl_world *w, int32_t k)
{
    fl_sleep *s = &w->sleep;
    for (int64_t i = w->first_pair_of_body[k]; i < w->first_pair_of_body[k + 1]; i++) {
        const int32_t c = w->pairs_of_body[i];
        if (fl_next_check_pending(w, c)) continue;
#pragma omp atomic write
        s->pair_due[c] = 1;
        end_sleep(&s->phase[w->next_check[c].i]);
        if (w->next_check[c].j < w->n) end_sleep(&s->phase[w->next_check[c].j]);
    }
}

/* Only who moves can have come too near to another: ways of those that coast are in the odometers already,
 * and to wake somebody brings no pair nearer.  Of pairs that have just been found nothing is known. */
void fl_sleep_find_waking(fl_world *w, int thread, int threads)
{
    fl_sleep *s = &w->sleep;
    const int32_t end = (int32_t)((int64_t)w->n * (thread + 1) / threads);
    const int found = w->last_search_step == w->step;
    for (int32_t k = (int32_t)((int64_t)w->n * thread / threads); k < end; k++) {
        uint8_t kind;
#pragma omp atomic read
        kind = s->phase[k];
        if (kind == FL_BALLISTIC) {
            if (w->step >= s->phase_end[k] || (w->inflow.absent && may_have_left(w, k)))
                end_sleep(&s->phase[k]);
            else if (!found) continue;
        }
        call_pairs(w, k);
    }
    for (int32_t k = w->n + thread; k < w->b.total && w->moving.movers.n; k += threads)
        if (w->moving.mover_of_piece[k - w->n] >= 0) call_pairs(w, k);
}

/* A sleep of floe k over s seconds has ended, off by that.  What it is off by goes with the third power of s.
 */
static void slept(fl_world *w, int32_t k, double off)
{
    fl_sleep *all = &w->sleep;
    fl_sleep_state *nap = &all->state[k];
    const double most = all->tol * w->b.radius[k];
    const int32_t steps = (int32_t)(w->step - nap->since_step);
    const int32_t span = off <= 0.0625 * most ? 2 * steps : off <= 0.5 * most ? steps : steps / 2;
    nap->max_error = fmax(nap->max_error, off / w->b.radius[k]);
    nap->sum_error += off / w->b.radius[k];
    if (w->step >= all->phase_end[k] || span < nap->next_skip)
        nap->next_skip = span < LEAST ? LEAST : span > MOST ? MOST : span;
    nap->ballistic_steps += steps;
    nap->n_skips++;
    all->phase_end[k] = nap->since_step = w->step;
}

void fl_sleep_finish_skip(fl_world *w, int32_t k, fl_vec3 v, fl_vec3 spin)
{
    slept(w, k, off_by(w, k, fl_sleep_duration(w, k), v, spin));
}

void fl_sleep_second_half(fl_world *w, int32_t k)
{
    fl_body_external_force(w, k);
    slept(w, k, back(w, k, fl_sleep_duration(w, k)));
    /* what came to touch it in the last step presses for that */
    if (!fl_body_contact_force(w, k)) return;
    const fl_vec3 f = w->b.f[k], t = w->b.t[k];
    fl_body_external_force(w, k);
    w->b.f[k] = v3_sub(f, w->b.f[k]);
    w->b.t[k] = v3_sub(t, w->b.t[k]);
    fl_kick(&w->b, k, 0.5 * w->dt);
    w->b.f[k] = f;
    w->b.t[k] = t;
}

/* How many of `left` steps of floe k stay within the tolerance together, whatever it meets.  What acts
 * smoothly pulls a point back with no more than omega^2 = rho g A (1/m + r^2/2I), A the largest area that the
 * water cuts out of it, at most half of its surface, and springs; so it changes by no more than omega^2 times
 * the way of its points against the surface of the water, at a speed u that grows by their acceleration a: s
 * seconds are off by up to s^3/12 omega^2 (u + s a).  Three quarters of the tolerance for that, a quarter for
 * turns. */
static int32_t within(const fl_world *w, int32_t k, const pace *p, int32_t left)
{
    const fl_bodies *b = &w->b;
    const double r = b->bounding_radius[k] + b->radius[k], most = w->sleep.tol * b->radius[k];
    const fl_vec3 v = b->v[k], spin = b->w[k];
    double drawn, stiff = fl_driven_floe_spring(w, k, &drawn) * b->invm[k];
    if (w->sea.water)
        stiff += 0.5 * w->sea.specific_weight * w->sea.hull[k].surface_area *
                 (b->invm[k] + 0.5 * r * r * fl_body_max_inverse_inertia(b, k));
    const double u = fabs(v.z) + r * sqrt(spin.x * spin.x + spin.y * spin.y) + w->sleep.surface_speed +
                     w->sleep.surface_slope * sqrt(v.x * v.x + v.y * v.y),
                 faster = p->faster + r * p->turning, turn3 = p->turn * p->turn * p->turn;
    for (; left >= LEAST; left -= (left + 3) / 4) {
        const double s = left * w->dt, s3 = s * s * s;
        if (s3 * stiff * (u + s * faster) <= 9.0 * most && s3 * r * turn3 <= 3.0 * most) break;
    }
    return left;
}

/* How long, in steps, floe k may coast from now on before it could touch a neighbour that goes on as it does.
 * One that is so far that it had to be three times as fast is not asked how fast it is. */
static double time_left(const fl_world *w, int32_t k, double left, double speed)
{
    const fl_bodies *b = &w->b;
    for (int64_t c = w->first_pair_of_body[k]; c < w->first_pair_of_body[k + 1]; c++) {
        const fl_next_check p = w->next_check[w->pairs_of_body[c]];
        const int32_t o = p.i == k ? p.j : p.i;
        const double gap = p.free_travel - b->odometer[p.i] - b->odometer[p.j], step = gap / w->dt;
        if (gap <= 0.0) return 0.0;
        if (4.0 * speed * left <= step) continue;
        const double both = speed + v3_norm(b->v[o]) + b->bounding_radius[o] * v3_norm(b->w[o]);
        if (both * left > step) left = step / both;
    }
    return left;
}

static int may_sleep(const fl_world *w, int32_t k)
{
    const fl_inflow_state *t = &w->inflow;
    if (w->b.added_mass && w->sea.waves) return 0; /* the drift is of order 1 in a flow that changes */
    return !fl_body_absent(w, k) && !w->b.is_isotropic[k] && w->b.radius[k] > 0.0 &&
           !(t->absent && t->feed && t->guided[k]);
}

/* Floe k, which is awake, coasts from now on, if there is something to be gained: of so many steps, else 0.
 * Its way is known, but not yet in its odometer, by which others are asked as well. */
static int32_t span_of(fl_world *w, int32_t k)
{
    if (w->body_touches[k] || fl_sums_now(w, k)->contacts || fl_sums_before(w, k)->contacts ||
        !may_sleep(w, k))
        return 0;
    const pace p = pace_of(w, k);
    const int32_t steps = within(w, k, &p, w->sleep.state[k].next_skip);
    if (steps < LEAST) return 0;
    const double s = steps * w->dt, left = time_left(w, k, steps, way_of(w, k, &p, s) / s);
    if (left < LEAST) return 0;
    w->sleep.state[k].path_bound = way_of(w, k, &p, (int32_t)left * w->dt) * (1.0 + 1e-9);
    return (int32_t)left;
}

static void let_coast(fl_world *w, int32_t k)
{
    fl_sleep_state *nap = &w->sleep.state[k];
    w->sleep.phase[k] = FL_BALLISTIC;
    nap->since_step = w->step;
    nap->window_odometer = -1.0;
    w->b.odometer[k] += nap->path_bound;
}

/* --- looked at -------------------------------------------------------------------------------- */

void fl_sleep_advance_to_now(fl_world *w)
{
    fl_sleep *s = &w->sleep;
    const fl_bodies *b = &w->b;
    if (!s->state) return;
#pragma omp parallel for schedule(dynamic, 16) num_threads(w->threads) /* each has cells of the sea */
    for (int32_t k = 0; k < w->n; k++) {
        if (s->phase[k] != FL_BALLISTIC) continue;
        s->saved[k] = (fl_sleep_saved){.x = b->x[k],
                                       .v = b->v[k],
                                       .L = b->L[k],
                                       .w = b->w[k],
                                       .f = b->f[k],
                                       .t = b->t[k],
                                       .q = b->q[k],
                                       .held = b->work_of_constraints[k],
                                       .odometer = b->odometer[k],
                                       .carried = b->added_mass ? b->flow_work[k] : 0.0,
                                       .drained = w->sea.n ? w->sea.drag_loss[k] : 0.0,
                                       .blown = w->sea.wind_work ? w->sea.wind_work[k] : 0.0,
                                       .waved = w->sea.waves ? w->sea.water_work[k] : 0.0,
                                       .nap = s->state[k]};
        const double t = fl_sleep_duration(w, k);
        if (t == 0.0) continue;
        out(w, k, t);
        fl_body_external_force(w, k);
        back(w, k, t);
    }
}

void fl_sleep_restore(fl_world *w)
{
    fl_sleep *s = &w->sleep;
    fl_bodies *b = &w->b;
    const double now = w->sea.time;
    for (int32_t k = 0; k < w->n && s->state; k++) {
        const fl_sleep_saved *m = &s->saved[k];
        if (s->phase[k] != FL_BALLISTIC) continue;
        b->x[k] = m->x, b->v[k] = m->v, b->L[k] = m->L, b->w[k] = m->w, b->f[k] = m->f, b->t[k] = m->t;
        b->q[k] = m->q, b->work_of_constraints[k] = m->held, b->odometer[k] = m->odometer;
        s->state[k] = m->nap;
        if (b->added_mass) b->flow_work[k] = m->carried;
        if (!w->sea.n) continue;
        w->sea.drag_loss[k] = m->drained;
        if (w->sea.wind_work) w->sea.wind_work[k] = m->blown;
        if (w->sea.waves) w->sea.water_work[k] = m->waved;
        w->sea.time = fl_sleep_start_time(w, k);
        fl_environment_refresh(&w->sea, b, k);
    }
    w->sea.time = now;
}

/* --- who rests --------------------------------------------------------------------------------- */

static void rise(fl_world *w, int32_t k)
{
    fl_sleep *s = &w->sleep;
    fl_sleep_state *nap = &s->state[k];
    if (s->phase[k] == FL_RESTING) { /* who was only about to has been awake */
        s->n_resting--;
        nap->resting_steps += w->step - nap->since_step;
        nap->window_odometer = -1.0;
        fl_velocity_change *const gain =
            fl_kick_change(w, k); /* it did not move in the first half of a step */
        if (gain) *gain = (fl_velocity_change){0};
    }
    s->phase[k] = FL_AWAKE;
    s->phase_end[k] = nap->since_step = w->step;
}

/* From the n on the stack to all that touch them and are of that kind: they are awake. */
static void spread(fl_world *w, int32_t n, enum fl_sleep_phase kind)
{
    fl_sleep *s = &w->sleep;
    while (n > 0) {
        const int32_t k = s->stack[--n];
        for (int64_t c = w->first_pair_of_body[k]; c < w->first_pair_of_body[k + 1]; c++) {
            const fl_neighbour_pair *p = &w->pair[w->pairs_of_body[c]];
            const int32_t o = p->i == k ? p->j : p->i;
            if (!p->touching || o >= w->n || s->phase[o] != (uint8_t)kind) continue;
            rise(w, o);
            s->stack[n++] = o;
        }
    }
}

/* The island of k, which rests. */
static void wake(fl_world *w, int32_t k)
{
    rise(w, k);
    w->sleep.stack[0] = k;
    spread(w, 1, FL_RESTING);
}

void fl_sleep_wake_touched(fl_world *w)
{
    for (int32_t c = 0; c < w->n_touching && w->sleep.n_resting; c++) {
        const fl_neighbour_pair *p = &w->pair[w->touching_pairs[c]];
        const int rests = fl_sleep_phase_of(w, p->i) == FL_RESTING;
        if (p->j < w->n && rests != (fl_sleep_phase_of(w, p->j) == FL_RESTING)) wake(w, rests ? p->i : p->j);
        else if (rests && p->j >= w->n && !fl_thing_is_still(w, p->j)) wake(w, p->i);
    }
}

void fl_sleep_wake_resting(fl_world *w)
{
    for (int32_t k = 0; k < w->n && w->sleep.state; k++)
        if (w->sleep.phase[k] == FL_RESTING) rise(w, k);
}

/* A wave may reach k, which lies still: what it presses with changes all the same. */
static int lapped(const fl_world *w, int32_t k)
{
    const fl_bodies *b = &w->b;
    return w->sea.waves &&
           b->x[k].z - b->bounding_radius[k] - b->radius[k] < w->sea.level + w->sea.wave.max_crest;
}

/* It is held at a speed, and goes however slow that is. */
static int led(const fl_world *w, int32_t k)
{
    const unsigned hold = w->b.fixed_dof[k];
    const fl_vec3 v = w->b.v[k];
    return (hold & FL_DOF_X && v.x != 0.0) || (hold & FL_DOF_Y && v.y != 0.0) ||
           (hold & FL_DOF_Z && v.z != 0.0);
}

/* What acts on it stays as it is while it lies still. */
static int may_rest(const fl_world *w, int32_t k)
{
    return may_sleep(w, k) && fl_sums_now(w, k)->contacts > 0 && !lapped(w, k) && !led(w, k);
}

/* Who has been quiet for a window is FL_CANDIDATE until it is known whether all are that touch it. */
static void find_quiet(fl_world *w)
{
    fl_sleep *s = &w->sleep;
    for (int32_t k = 0; k < w->n; k++) {
        fl_sleep_state *nap = &s->state[k];
        if (s->phase[k] != FL_AWAKE) continue;
        const double path = w->b.odometer[k] - nap->window_odometer, most = s->tol * w->b.radius[k];
        const int seen = nap->window_odometer >= 0.0;
        nap->window_odometer = w->b.odometer[k];
        if (!seen || path > 0.25 * most || !may_rest(w, k)) continue;
        const double windows = path > 0.0 ? sqrt(most / path) : LONGEST;
        nap->path_bound = path;
        nap->since_step = w->step;
        s->phase_end[k] = w->step + WINDOW * (int64_t)(windows < LONGEST ? windows : LONGEST);
        s->phase[k] = FL_CANDIDATE;
    }
}

/* The island of k, who are quiet: they rest, unless they go faster now than in the mean of the window.  What
 * begins to fall off an edge does, and of that the path of a window foretells nothing, for it grows by a
 * factor in a time. */
static void settle(fl_world *w, int32_t k)
{
    fl_sleep *s = &w->sleep;
    const fl_bodies *b = &w->b;
    const double window = WINDOW * w->dt;
    double gained = 0.0;
    int32_t n = 0;
    s->phase[k] = FL_RESTING;
    s->stack[n++] = k;
    for (int32_t head = 0; head < n; head++) {
        const int32_t i = s->stack[head];
        gained +=
            window * (v3_norm(b->v[i]) + b->bounding_radius[i] * v3_norm(b->w[i])) - s->state[i].path_bound;
        for (int64_t c = w->first_pair_of_body[i]; c < w->first_pair_of_body[i + 1]; c++) {
            const fl_neighbour_pair *p = &w->pair[w->pairs_of_body[c]];
            const int32_t o = p->i == i ? p->j : p->i;
            if (!p->touching || o >= w->n || s->phase[o] != FL_CANDIDATE) continue;
            s->phase[o] = FL_RESTING;
            s->stack[n++] = o;
        }
    }
    s->n_resting += n;
    for (int32_t i = 0; i < n && gained > 0.0; i++) {
        s->n_resting--;
        s->phase[s->stack[i]] = FL_AWAKE;
        s->phase_end[s->stack[i]] = w->step;
    }
}

static void let_rest(fl_world *w)
{
    fl_sleep *s = &w->sleep;
    int32_t n = 0;
    find_quiet(w);
    for (int32_t c = 0; c < w->n_touching; c++) {
        const fl_neighbour_pair *p = &w->pair[w->touching_pairs[c]];
        const int32_t ends[2] = {p->i, p->j};
        for (int e = 0; e < 2; e++) {
            const int32_t k = ends[e], o = ends[1 - e];
            if (k >= w->n || s->phase[k] != FL_CANDIDATE) continue;
            if (o >= w->n ? fl_thing_is_still(w, o) : s->phase[o] != FL_AWAKE) continue;
            s->phase[k] = FL_AWAKE;
            s->phase_end[k] = s->state[k].since_step = w->step;
            s->stack[n++] = k;
        }
    }
    spread(w, n, FL_CANDIDATE);
    for (int32_t k = 0; k < w->n; k++)
        if (s->phase[k] == FL_CANDIDATE) settle(w, k);
}

fl_sleep_totals fl_sleep_sum_totals(const fl_world *w)
{
    fl_sleep_totals all = {0};
    for (int32_t k = 0; k < w->n && w->sleep.state; k++) {
        const fl_sleep_state *nap = &w->sleep.state[k];
        const int64_t now = fl_is_asleep(w, k) ? w->step - nap->since_step : 0;
        all.ballistic_steps += nap->ballistic_steps + (w->sleep.phase[k] == FL_BALLISTIC ? now : 0);
        all.resting_steps += nap->resting_steps + (w->sleep.phase[k] == FL_RESTING ? now : 0);
        all.n_skips += nap->n_skips;
        all.max_error = fmax(all.max_error, nap->max_error);
        all.max_error_sum = fmax(all.max_error_sum, nap->sum_error);
    }
    return all;
}

/* --- both -------------------------------------------------------------------------------------- */

/* Steps after which a floe that is awake is asked again: the longer it has been so, the later. */
static int32_t patience(const fl_world *w, int32_t k)
{
    const int64_t awake = w->step - w->sleep.state[k].since_step;
    return LEAST + (int32_t)(awake < 8 * SELDOM ? awake / 8 : SELDOM);
}

/* Of floes [from, to) that are awake those that are asked, then of these who may: how many, to the begin of
 * their part of the stack. */
static int32_t find_spans(fl_world *w, int32_t from, int32_t to)
{
    fl_sleep *s = &w->sleep;
    int32_t *const list = s->stack + from, n = 0;
    const int32_t up = fl_sleep_list_active(w, from, to, list);
    for (int32_t i = 0; i < up; i++) {
        const int32_t k = list[i];
        if (s->phase[k] != FL_AWAKE || w->step < s->phase_end[k]) continue;
        const int32_t span = span_of(w, k);
        s->phase_end[k] = w->step + (span ? span : patience(w, k));
        list[n] = k;
        n += span != 0;
    }
    return n;
}

static void fall_asleep(fl_world *w, int32_t from, int32_t n)
{
    for (int32_t i = 0; i < n; i++) let_coast(w, w->sleep.stack[from + i]);
}

/* Who met another that fell asleep with him does so for a step alone. */
static void look_round(fl_world *w, int32_t k)
{
    for (int64_t c = w->first_pair_of_body[k]; c < w->first_pair_of_body[k + 1]; c++)
        if (!fl_next_check_pending(w, w->pairs_of_body[c])) w->sleep.phase_end[k] = w->step + 1;
}

static void look_round_all(fl_world *w, int32_t from, int32_t n)
{
    for (int32_t i = 0; i < n; i++) look_round(w, w->sleep.stack[from + i]);
}

void fl_sleep_after_read(fl_world *w)
{
    for (int32_t k = 0; k < w->n && w->sleep.state; k++)
        if (w->sleep.phase[k] == FL_BALLISTIC) look_round(w, k);
}

/* All of them, by the same odometers. */
static void lull_all(fl_world *w)
{
    if (w->team.n == 1) { /* a team of one takes its time */
        const int32_t n = find_spans(w, 0, w->n);
        fall_asleep(w, 0, n);
        look_round_all(w, 0, n);
        return;
    }
#pragma omp parallel num_threads(w->team.n)
    {
        const int thread = omp_get_thread_num(), threads = omp_get_num_threads();
        const int32_t from = (int32_t)((int64_t)w->n * thread / threads),
                      n = find_spans(w, from, (int32_t)((int64_t)w->n * (thread + 1) / threads));
#pragma omp barrier
        fall_asleep(w, from, n);
#pragma omp barrier
        look_round_all(w, from, n);
    }
}

void fl_sleep_update(fl_world *w)
{
    fl_sleep *s = &w->sleep;
    for (int32_t k = 0; k < w->n && s->n_resting; k++)
        if (s->phase[k] == FL_RESTING && w->step >= s->phase_end[k]) wake(w, k);
    lull_all(w);
    if (w->step % WINDOW == 0) let_rest(w);
}
