/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "sim/sleep.h"
#include <math.h>
#include <omp.h>
#include "base/array.h"
#include "body/integrate.h"
#include "sim/body_step.h"
#include "sim/energy_ledger.h"

enum {
    WINDOW = 64,      /* steps: window of the test for rest */
    LEAST = 4,        /* steps: shortest skip, and shortest time between two tests of a floe that is awake */
    SELDOM = 64,      /* steps: longest such time, less LEAST */
    MOST = 1 << 14,   /* steps: longest skip */
    LONGEST = 1 << 20 /* windows: longest rest */
};

/* The state of a floe that fl_sleep_advance_to_now() changes. */
struct fl_sleep_saved {
    fl_vec3 x, v, L, w, f, t;
    fl_quat q;
    double constraint_work, odometer, flow_work, drag_loss, wind_work, water_work;
    fl_sleep_state state;
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
    fl_sleep_state *state = &w->sleep.state[i];
    *state = (fl_sleep_state){.since_step = w->step,
                              .next_skip = LEAST,
                              .window_odometer = -1.0,
                              .max_error = state->max_error,
                              .sum_error = state->sum_error,
                              .ballistic_steps = state->ballistic_steps,
                              .n_skips = state->n_skips,
                              .resting_steps = state->resting_steps};
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

/* --- ballistic bodies ---------------------------------------------------------------------------- */

void fl_sleep_first_half(fl_world *w, int32_t k)
{
    fl_sleep_state *state = &w->sleep.state[k];
    fl_body_accelerations(&w->b, k, &state->acceleration, &state->angular_acceleration);
}

/* First half of a step of s seconds. */
static void start_skip(fl_world *w, int32_t k, double s)
{
    fl_sleep_first_half(w, k);
    fl_body_first_half(w, k, s);
}

/* Error of a step of s seconds after its end [m].  The forces are those of now; v and spin are the
 * velocities before the last drag. */
static double error_of_skip(fl_world *w, int32_t k, double s, fl_vec3 v, fl_vec3 spin)
{
    fl_sleep_state *state = &w->sleep.state[k];
    const fl_bodies *b = &w->b;
    const double drag_before = state->drag_rate, r = b->bounding_radius[k], rotation = v3_norm(spin) * s;
    fl_vec3 a, turn;
    fl_body_accelerations(b, k, &a, &turn);
    state->drag_rate = (v3_norm(v3_sub(b->v[k], v)) + r * v3_norm(v3_sub(b->w[k], spin))) / (0.5 * s);
    return s * s / 12.0 *
               (v3_norm(v3_sub(a, state->acceleration)) +
                r * v3_norm(v3_sub(turn, state->angular_acceleration)) +
                fabs(state->drag_rate - drag_before)) +
           r * rotation * rotation * rotation / 12.0;
}

/* Second half of a step of s seconds; returns its error [m]. */
static double end_skip(fl_world *w, int32_t k, double s)
{
    const fl_bodies *b = &w->b;
    fl_body_kick(w, k, 0.5 * s);
    const fl_vec3 v = b->v[k], spin = b->w[k];
    if (w->sea.n) fl_environment_drag(&w->sea, &w->b, k, 0.5 * s, 1);
    return error_of_skip(w, k, s, v, spin);
}

/* Bounds of the motion of a floe. */
typedef struct {
    double speed, turn; /* speed of the centre [m/s]; angular velocity [1/s] */
    double acceleration_bound, angular_acceleration_bound; /* accelerations by all but drag [m/s2], [1/s2] */
} motion_bounds;

static motion_bounds motion_bounds_of(const fl_world *w, int32_t k)
{
    const fl_bodies *b = &w->b;
    const double inv_inertia = fl_body_max_inverse_inertia(b, k);
    fl_vec3 a, turn;
    fl_body_accelerations(b, k, &a, &turn);
    double torque = v3_norm(b->t[k]);
    if (b->added_mass) {
        const fl_vec3 u = v3_sub(b->v[k], b->flow_velocity[k]);
        torque += v3_norm(fl_body_momentum(b, k, u)) * v3_norm(u);
    }
    return (motion_bounds){v3_norm(b->v[k]), v3_norm(b->L[k]) * inv_inertia, v3_norm(a),
                           torque * inv_inertia};
}

/* Bound of the path of floe k in s seconds from now on [m]. */
static double path_bound_of(const fl_world *w, int32_t k, const motion_bounds *p, double s)
{
    const double r = w->b.bounding_radius[k];
    return s * (p->speed + r * p->turn) +
           s * s *
               (0.5 * (p->acceleration_bound + r * p->angular_acceleration_bound) +
                w->sleep.state[k].drag_rate);
}

/* 1 if floe k may be outside the domain by now. */
static int may_have_left(const fl_world *w, int32_t k)
{
    const fl_inflow_state *t = &w->inflow;
    const fl_vec3 x = w->b.x[k];
    const double r = w->b.bounding_radius[k] + w->b.radius[k] - w->sleep.state[k].path_bound;
    return t->absent && (x.x + r < t->lo.x || x.x - r > t->hi.x || x.y + r < t->lo.y || x.y - r > t->hi.y ||
                         x.z + r < t->lo.z || x.z - r > t->hi.z);
}

/* Several threads may reach the same body. */
static void set_waking(uint8_t *phase)
{
    uint8_t phase_now;
#pragma omp atomic read
    phase_now = *phase;
    if (phase_now != FL_BALLISTIC) return;
#pragma omp atomic write
    *phase = FL_WAKING;
}

/* Mark the pairs of thing k that must be evaluated, and wake their bodies. */
static void mark_pairs(fl_world *w, int32_t k)
{
    fl_sleep *s = &w->sleep;
    for (int64_t i = w->first_pair_of_body[k]; i < w->first_pair_of_body[k + 1]; i++) {
        const int32_t c = w->pairs_of_body[i];
        if (!fl_pair_may_touch(w, c)) continue;
#pragma omp atomic write
        s->pair_due[c] = 1;
        set_waking(&s->phase[w->next_check[c].i]);
        if (w->next_check[c].j < w->n) set_waking(&s->phase[w->next_check[c].j]);
    }
}

/* Only bodies that move can have come too near to another: the paths of ballistic bodies are in their
 * odometers already, and waking a body brings no pair nearer.  Pairs of a new list have not been
 * evaluated yet. */
void fl_sleep_find_waking(fl_world *w, int thread, int threads)
{
    fl_sleep *s = &w->sleep;
    const int32_t end = (int32_t)((int64_t)w->n * (thread + 1) / threads);
    const int found = w->last_search_step == w->step;
    for (int32_t k = (int32_t)((int64_t)w->n * thread / threads); k < end; k++) {
        uint8_t phase;
#pragma omp atomic read
        phase = s->phase[k];
        if (phase == FL_BALLISTIC) {
            if (w->step >= s->phase_end[k] || (w->inflow.absent && may_have_left(w, k)))
                set_waking(&s->phase[k]);
            else if (!found) continue;
        }
        mark_pairs(w, k);
    }
    for (int32_t k = w->n + thread; k < w->b.total && fl_structure_moves(w); k += threads)
        if (fl_piece_moves(w, k)) mark_pairs(w, k);
}

/* Book a skip of floe k with this error, and choose the length of the next; the error goes with its third
 * power. */
static void book_skip(fl_world *w, int32_t k, double error)
{
    fl_sleep *all = &w->sleep;
    fl_sleep_state *state = &all->state[k];
    const double tolerance = all->tol * w->b.radius[k];
    const int32_t steps = (int32_t)(w->step - state->since_step);
    const int32_t skip = error <= 0.0625 * tolerance ? 2 * steps
                         : error <= 0.5 * tolerance  ? steps
                                                     : steps / 2;
    state->max_error = fmax(state->max_error, error / w->b.radius[k]);
    state->sum_error += error / w->b.radius[k];
    if (w->step >= all->phase_end[k] || skip < state->next_skip)
        state->next_skip = skip < LEAST ? LEAST : skip > MOST ? MOST : skip;
    state->ballistic_steps += steps;
    state->n_skips++;
    all->phase_end[k] = state->since_step = w->step;
}

void fl_sleep_finish_skip(fl_world *w, int32_t k, fl_vec3 v, fl_vec3 spin)
{
    book_skip(w, k, error_of_skip(w, k, fl_sleep_duration(w, k), v, spin));
}

void fl_sleep_second_half(fl_world *w, int32_t k)
{
    fl_body_external_force(w, k);
    book_skip(w, k, end_skip(w, k, fl_sleep_duration(w, k)));
    /* a contact that began in the last step acts for that step */
    if (!fl_body_contact_force(w, k)) return;
    const fl_vec3 f = w->b.f[k], t = w->b.t[k];
    fl_body_external_force(w, k);
    w->b.f[k] = v3_sub(f, w->b.f[k]);
    w->b.t[k] = v3_sub(t, w->b.t[k]);
    fl_kick(&w->b, k, 0.5 * w->dt);
    w->b.f[k] = f;
    w->b.t[k] = t;
}

/* Number of steps, at most `left`, whose common error stays within the tolerance.  Water and springs pull
 * a point back with at most omega^2 = rho g A (1/m + r^2/2I), with A the largest waterplane, at most half
 * of the surface.  So the acceleration changes by at most omega^2 times the path of the points relative
 * to the water surface, whose speed u grows by their acceleration a: the error of s seconds is up to
 * s^3/12 omega^2 (u + s a).  It may use three quarters of the tolerance, rotations a quarter. */
static int32_t steps_within_tolerance(const fl_world *w, int32_t k, const motion_bounds *p, int32_t left)
{
    const fl_bodies *b = &w->b;
    const double r = b->bounding_radius[k] + b->radius[k], tolerance = w->sleep.tol * b->radius[k];
    const fl_vec3 v = b->v[k], spin = b->w[k];
    double extension, stiff = fl_driven_floe_spring(w, k, &extension) * b->invm[k];
    if (w->sea.water)
        stiff += 0.5 * w->sea.specific_weight * w->sea.hull[k].surface_area *
                 (b->invm[k] + 0.5 * r * r * fl_body_max_inverse_inertia(b, k));
    const double u = fabs(v.z) + r * sqrt(spin.x * spin.x + spin.y * spin.y) + w->sleep.surface_speed +
                     w->sleep.surface_slope * sqrt(v.x * v.x + v.y * v.y),
                 acceleration_bound = p->acceleration_bound + r * p->angular_acceleration_bound,
                 rate3 = p->turn * p->turn * p->turn;
    for (; left >= LEAST; left -= (left + 3) / 4) {
        const double s = left * w->dt, s3 = s * s * s;
        if (s3 * stiff * (u + s * acceleration_bound) <= 9.0 * tolerance && s3 * r * rate3 <= 3.0 * tolerance)
            break;
    }
    return left;
}

/* Number of steps, at most `left`, in which floe k cannot touch a neighbour that moves on with its
 * speed.  The speed of a neighbour is not computed if it would have to be three times as fast. */
static double steps_to_neighbour(const fl_world *w, int32_t k, double left, double speed)
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
    if (w->b.added_mass && w->sea.waves) return 0; /* the drift is of order 1 in a changing flow */
    return !fl_body_absent(w, k) && !w->b.is_isotropic[k] && w->b.radius[k] > 0.0 &&
           !(t->absent && t->feed && t->guided[k]);
}

/* Number of steps that floe k, which is awake, can skip from now on; 0: not enough.  Its path is stored,
 * but not yet added to its odometer, which other bodies read. */
static int32_t skip_length(fl_world *w, int32_t k)
{
    if (w->body_touches[k] || fl_sums_now(w, k)->contacts || fl_sums_before(w, k)->contacts ||
        !may_sleep(w, k))
        return 0;
    const motion_bounds p = motion_bounds_of(w, k);
    const int32_t steps = steps_within_tolerance(w, k, &p, w->sleep.state[k].next_skip);
    if (steps < LEAST) return 0;
    const double s = steps * w->dt, left = steps_to_neighbour(w, k, steps, path_bound_of(w, k, &p, s) / s);
    if (left < LEAST) return 0;
    w->sleep.state[k].path_bound = path_bound_of(w, k, &p, (int32_t)left * w->dt) * (1.0 + 1e-9);
    return (int32_t)left;
}

static void start_ballistic(fl_world *w, int32_t k)
{
    fl_sleep_state *state = &w->sleep.state[k];
    w->sleep.phase[k] = FL_BALLISTIC;
    state->since_step = w->step;
    state->window_odometer = -1.0;
    w->b.odometer[k] += state->path_bound;
}

/* --- output -------------------------------------------------------------------------------------- */

void fl_sleep_advance_to_now(fl_world *w)
{
    fl_sleep *s = &w->sleep;
    const fl_bodies *b = &w->b;
    if (!s->state) return;
#pragma omp parallel for schedule(dynamic, 16)                                                               \
    num_threads(w->threads) /* scratch of the water is per thread */
    for (int32_t k = 0; k < w->n; k++) {
        if (s->phase[k] != FL_BALLISTIC) continue;
        s->saved[k] = (fl_sleep_saved){.x = b->x[k],
                                       .v = b->v[k],
                                       .L = b->L[k],
                                       .w = b->w[k],
                                       .f = b->f[k],
                                       .t = b->t[k],
                                       .q = b->q[k],
                                       .constraint_work = b->work_of_constraints[k],
                                       .odometer = b->odometer[k],
                                       .flow_work = b->added_mass ? b->flow_work[k] : 0.0,
                                       .drag_loss = w->sea.n ? w->sea.drag_loss[k] : 0.0,
                                       .wind_work = w->sea.wind_work ? w->sea.wind_work[k] : 0.0,
                                       .water_work = w->sea.waves ? w->sea.water_work[k] : 0.0,
                                       .state = s->state[k]};
        const double t = fl_sleep_duration(w, k);
        if (t == 0.0) continue;
        start_skip(w, k, t);
        fl_body_external_force(w, k);
        end_skip(w, k, t);
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
        b->q[k] = m->q, b->work_of_constraints[k] = m->constraint_work, b->odometer[k] = m->odometer;
        s->state[k] = m->state;
        if (b->added_mass) b->flow_work[k] = m->flow_work;
        if (!w->sea.n) continue;
        w->sea.drag_loss[k] = m->drag_loss;
        if (w->sea.wind_work) w->sea.wind_work[k] = m->wind_work;
        if (w->sea.waves) w->sea.water_work[k] = m->water_work;
        w->sea.time = fl_sleep_start_time(w, k);
        fl_environment_refresh(&w->sea, b, k);
    }
    w->sea.time = now;
}

/* --- resting bodies ------------------------------------------------------------------------------ */

static void set_awake(fl_world *w, int32_t k)
{
    fl_sleep *s = &w->sleep;
    fl_sleep_state *state = &s->state[k];
    if (s->phase[k] == FL_RESTING) { /* a candidate has been awake all the time */
        s->n_resting--;
        state->resting_steps += w->step - state->since_step;
        state->window_odometer = -1.0;
        fl_velocity_change *const change =
            fl_kick_change(w, k); /* it did not move in the first half of the step */
        if (change) *change = (fl_velocity_change){0};
    }
    s->phase[k] = FL_AWAKE;
    s->phase_end[k] = state->since_step = w->step;
}

/* Wake all bodies of that phase that are connected by contacts to the n bodies on the stack. */
static void wake_connected(fl_world *w, int32_t n, enum fl_sleep_phase phase)
{
    fl_sleep *s = &w->sleep;
    while (n > 0) {
        const int32_t k = s->stack[--n];
        for (int64_t c = w->first_pair_of_body[k]; c < w->first_pair_of_body[k + 1]; c++) {
            const fl_neighbour_pair *p = &w->pair[w->pairs_of_body[c]];
            const int32_t o = p->i == k ? p->j : p->i;
            if (!p->touching || o >= w->n || s->phase[o] != (uint8_t)phase) continue;
            set_awake(w, o);
            s->stack[n++] = o;
        }
    }
}

/* Wake the island of k, which rests. */
static void wake_island(fl_world *w, int32_t k)
{
    set_awake(w, k);
    w->sleep.stack[0] = k;
    wake_connected(w, 1, FL_RESTING);
}

void fl_sleep_wake_touched(fl_world *w)
{
    for (int32_t c = 0; c < w->n_touching && w->sleep.n_resting; c++) {
        const fl_neighbour_pair *p = &w->pair[w->touching_pairs[c]];
        const int rests = fl_sleep_phase_of(w, p->i) == FL_RESTING;
        if (p->j < w->n && rests != (fl_sleep_phase_of(w, p->j) == FL_RESTING))
            wake_island(w, rests ? p->i : p->j);
        else if (rests && p->j >= w->n && !fl_thing_is_still(w, p->j)) wake_island(w, p->i);
    }
}

void fl_sleep_wake_resting(fl_world *w)
{
    for (int32_t k = 0; k < w->n && w->sleep.state; k++)
        if (w->sleep.phase[k] == FL_RESTING) set_awake(w, k);
}

/* 1 if waves may reach k: the forces on it change although it lies still. */
static int reached_by_waves(const fl_world *w, int32_t k)
{
    const fl_bodies *b = &w->b;
    return w->sea.waves &&
           b->x[k].z - b->bounding_radius[k] - b->radius[k] < w->sea.level + w->sea.wave.max_crest;
}

/* 1 if k has a prescribed velocity, however slow. */
static int is_driven(const fl_world *w, int32_t k)
{
    const unsigned fixed = w->b.fixed_dof[k];
    const fl_vec3 v = w->b.v[k];
    return (fixed & FL_DOF_X && v.x != 0.0) || (fixed & FL_DOF_Y && v.y != 0.0) ||
           (fixed & FL_DOF_Z && v.z != 0.0);
}

/* 1 if the forces on k do not change while it lies still. */
static int may_rest(const fl_world *w, int32_t k)
{
    return may_sleep(w, k) && fl_sums_now(w, k)->contacts > 0 && !reached_by_waves(w, k) && !is_driven(w, k);
}

/* A body that was quiet for a window is FL_CANDIDATE until it is known whether all that touch it are. */
static void find_candidates(fl_world *w)
{
    fl_sleep *s = &w->sleep;
    for (int32_t k = 0; k < w->n; k++) {
        fl_sleep_state *state = &s->state[k];
        if (s->phase[k] != FL_AWAKE) continue;
        const double path = w->b.odometer[k] - state->window_odometer, tolerance = s->tol * w->b.radius[k];
        const int has_window = state->window_odometer >= 0.0;
        state->window_odometer = w->b.odometer[k];
        if (!has_window || path > 0.25 * tolerance || !may_rest(w, k)) continue;
        const double windows = path > 0.0 ? sqrt(tolerance / path) : LONGEST;
        state->path_bound = path;
        state->since_step = w->step;
        s->phase_end[k] = w->step + WINDOW * (int64_t)(windows < LONGEST ? windows : LONGEST);
        s->phase[k] = FL_CANDIDATE;
    }
}

/* The island of candidate k rests, unless it is faster now than in the mean of the window.  What begins
 * to fall off an edge is faster: its path grows exponentially, so that of a window does not bound the
 * next. */
static void rest_island(fl_world *w, int32_t k)
{
    fl_sleep *s = &w->sleep;
    const fl_bodies *b = &w->b;
    const double window = WINDOW * w->dt;
    double excess = 0.0;
    int32_t n = 0;
    s->phase[k] = FL_RESTING;
    s->stack[n++] = k;
    for (int32_t head = 0; head < n; head++) {
        const int32_t i = s->stack[head];
        excess +=
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
    for (int32_t i = 0; i < n && excess > 0.0; i++) {
        s->n_resting--;
        s->phase[s->stack[i]] = FL_AWAKE;
        s->phase_end[s->stack[i]] = w->step;
    }
}

static void find_resting(fl_world *w)
{
    fl_sleep *s = &w->sleep;
    int32_t n = 0;
    find_candidates(w);
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
    wake_connected(w, n, FL_CANDIDATE);
    for (int32_t k = 0; k < w->n; k++)
        if (s->phase[k] == FL_CANDIDATE) rest_island(w, k);
}

fl_sleep_totals fl_sleep_sum_totals(const fl_world *w)
{
    fl_sleep_totals all = {0};
    for (int32_t k = 0; k < w->n && w->sleep.state; k++) {
        const fl_sleep_state *state = &w->sleep.state[k];
        const int64_t now = fl_is_asleep(w, k) ? w->step - state->since_step : 0;
        all.ballistic_steps += state->ballistic_steps + (w->sleep.phase[k] == FL_BALLISTIC ? now : 0);
        all.resting_steps += state->resting_steps + (w->sleep.phase[k] == FL_RESTING ? now : 0);
        all.n_skips += state->n_skips;
        all.max_error = fmax(all.max_error, state->max_error);
        all.max_error_sum = fmax(all.max_error_sum, state->sum_error);
    }
    return all;
}

/* --- end of a step ------------------------------------------------------------------------------- */

/* Steps until a floe that is awake is tested again: more, the longer it has been awake. */
static int32_t retry_interval(const fl_world *w, int32_t k)
{
    const int64_t awake = w->step - w->sleep.state[k].since_step;
    return LEAST + (int32_t)(awake < 8 * SELDOM ? awake / 8 : SELDOM);
}

/* List those of floes [from, to) that fall asleep now in s->stack + from; returns their number. */
static int32_t find_sleepers(fl_world *w, int32_t from, int32_t to)
{
    fl_sleep *s = &w->sleep;
    int32_t *const list = s->stack + from, n = 0;
    const int32_t n_active = fl_sleep_list_active(w, from, to, list);
    for (int32_t i = 0; i < n_active; i++) {
        const int32_t k = list[i];
        if (s->phase[k] != FL_AWAKE || w->step < s->phase_end[k]) continue;
        const int32_t skip = skip_length(w, k);
        s->phase_end[k] = w->step + (skip ? skip : retry_interval(w, k));
        list[n] = k;
        n += skip != 0;
    }
    return n;
}

static void start_sleepers(fl_world *w, int32_t from, int32_t n)
{
    for (int32_t i = 0; i < n; i++) start_ballistic(w, w->sleep.stack[from + i]);
}

/* A body whose neighbour fell asleep in the same step may now be too near: it skips one step only. */
static void shorten_skip(fl_world *w, int32_t k)
{
    for (int64_t c = w->first_pair_of_body[k]; c < w->first_pair_of_body[k + 1]; c++)
        if (fl_pair_may_touch(w, w->pairs_of_body[c])) w->sleep.phase_end[k] = w->step + 1;
}

static void shorten_skips(fl_world *w, int32_t from, int32_t n)
{
    for (int32_t i = 0; i < n; i++) shorten_skip(w, w->sleep.stack[from + i]);
}

void fl_sleep_after_read(fl_world *w)
{
    for (int32_t k = 0; k < w->n && w->sleep.state; k++)
        if (w->sleep.phase[k] == FL_BALLISTIC) shorten_skip(w, k);
}

/* Let bodies fall asleep.  All decide by the odometers of the same moment. */
static void find_ballistic(fl_world *w)
{
    if (w->team.n == 1) { /* a parallel region costs time */
        const int32_t n = find_sleepers(w, 0, w->n);
        start_sleepers(w, 0, n);
        shorten_skips(w, 0, n);
        return;
    }
#pragma omp parallel num_threads(w->team.n)
    {
        const int thread = omp_get_thread_num(), threads = omp_get_num_threads();
        const int32_t from = (int32_t)((int64_t)w->n * thread / threads),
                      n = find_sleepers(w, from, (int32_t)((int64_t)w->n * (thread + 1) / threads));
#pragma omp barrier
        start_sleepers(w, from, n);
#pragma omp barrier
        shorten_skips(w, from, n);
    }
}

void fl_sleep_update(fl_world *w)
{
    fl_sleep *s = &w->sleep;
    for (int32_t k = 0; k < w->n && s->n_resting; k++)
        if (s->phase[k] == FL_RESTING && w->step >= s->phase_end[k]) wake_island(w, k);
    find_ballistic(w);
    if (w->step % WINDOW == 0) find_resting(w);
}
