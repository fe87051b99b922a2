/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "sim/error_budget.h"
#include <inttypes.h>
#include <string.h>
#include "base/array.h"
#include "base/fast_math.h"
#include "out/state_io.h"
#include "sim/critical_step.h"
#include "sim/neighbour_list.h"
#include "sim/setup.h"
#include "sim/snapshot.h"
#include "sim/step.h"
#include "sphere/contact_list.h"
#include "world/access.h"

/* The part of the goal that is used, as the estimate has an error of its own; a peak is one value, in
 * which nothing cancels. */
#define GOAL_SHARE 0.92
#define GOAL_SHARE_PEAK 0.65
/* A contact with this factor more momentum than any before starts a search. */
#define NEW_MOMENTUM 1.15
/* Two steps whose ratio is below this count as equal. */
#define EQUAL_STEPS 1.2
/* Half a step or less reduces the error at least to this share, where the step causes it. */
#define IMPROVED 0.7
/* Allowed error of the momenta of floes over that of the load; half for a peak, whose error adds to that
 * of the speed of impact. */
#define MOMENTUM_SHARE 1.0
#define MOMENTUM_SHARE_PEAK 0.5
/* Shift of floes over their size to measure divergence: far above rounding, far below contact overlaps. */
#define SHIFT 0x1p-26

enum {
    FLOES,               /* kinds of contact: floe and floe, */
    WALLS,               /* floe and wall, */
    PARTS,               /* and so on: floe and part */
    WINDOW_STEPS = 64,   /* smallest number of steps in a window */
    FOLLOW_WINDOWS = 10, /* windows in which a contact of the first one is followed, */
    EARLY_WINDOWS = 8,   /* and after which the load is compared, too: */
    COMPARISONS = 2,     /* comparisons */
    ROUNDS = 8,          /* most steps tried in one search */
    MAX_FAILED = 4,      /* failed trials, down to 1/32 of the step, after which the search ends; */
    MAX_USELESS = 2,     /* trials with half the best step or less that are no better, after which it ends */
    MAX_ROW_STEPS = 100000,  /* most steps in a row with the largest step */
    STEP_RANGE = 1 << 12,    /* largest over smallest allowed step */
    SEARCH_INTERVAL = 10,    /* steps between two searches over those of a search */
    FREE_WINDOWS = 64,       /* windows of trials that are allowed at any time, and */
    RUN_SHARE = 3,           /* above these: steps of the run over steps of trials */
    DIVERGENCE_INTERVAL = 24 /* time so far over the window that measures divergence */
};

/* --- a trial ----------------------------------------------------------------------------------- */

static int alloc_ends(fl_error_budget *g, fl_err *err)
{
    for (int k = 0; k < 3; k++) {
        fl_window_end *e = &g->end[k];
        const struct {
            void *array;
            int32_t n;
            size_t size;
        } want[] = {{&e->load, COMPARISONS * g->trial.parts, sizeof *e->load},
                    {&e->momentum, g->trial.n, sizeof *e->momentum},
                    {&e->position, g->trial.n, sizeof *e->position}};
        for (size_t a = 0; a < sizeof want / sizeof *want; a++) {
            void *p = fl_alloc(want[a].n, want[a].size, err);
            if (!p) return -1;
            *(void **)want[a].array = p;
        }
    }
    return 0;
}

static int save_state(fl_error_budget *g, fl_world *w, fl_err *err)
{
    free(g->state_text);
    g->state_text = NULL;
    FILE *f = open_memstream(&g->state_text, &g->state_bytes);
    if (!f) return fl_fail(err, FL_SYSTEM, "out of memory for a trial");
    fl_snapshot_write(f, w);
    const int bad = ferror(f);
    return fclose(f) || bad ? fl_fail(err, FL_SYSTEM, "out of memory for a trial") : 0;
}

static int kind_of(const fl_world *w, const fl_pair *p)
{
    if (p->j < w->n) return FLOES;
    const int32_t part = p->load_part >= 0 ? p->load_part : w->structure.piece[p->j - w->n].part;
    return part < 0 ? WALLS : PARTS + part;
}

/* Largest momentum of the present contacts, by kind. */
static void record_momenta(fl_error_budget *g)
{
    const fl_world *w = &g->trial;
    fl_pair_iterator at = {.w = w};
    for (const fl_pair *p; (p = fl_pair_next(&at)) != NULL;) {
        if (p->touching == 0) continue;
        const int kind = kind_of(w, p);
        g->trial_momentum[kind] = fmax(g->trial_momentum[kind], p->mass * p->max_approach_speed);
    }
}

/* Rows of a window that follows a contact: FOLLOW times as long, but shorter than the time of divergence. */
static int32_t followed_rows(const fl_error_budget *g)
{
    const double time = g->divergence_rate > 0.0 ? 1.0 / (g->divergence_rate * g->row_interval) : INFINITY;
    return (int32_t)fmax(g->window_rows, fmin(time, (double)FOLLOW_WINDOWS * g->window_rows));
}

/* The row after which comparison c takes the load. */
static int32_t comparison_row(const fl_error_budget *g, int32_t rows, int32_t c)
{
    return c == 0 && rows > EARLY_WINDOWS * g->window_rows ? EARLY_WINDOWS * g->window_rows : rows;
}

static void record_load(const fl_error_budget *g, fl_window_end *end, int32_t c)
{
    const fl_world *w = &g->trial;
    for (int32_t p = 0; p < w->parts; p++)
        end->load[c * w->parts + p] = (fl_total_load){w->part_impulse[p], w->part_moment[p], w->part_peak[p]};
}

/* Run the stored state through `rows` rows of m steps each; returns the number of rows.
 *   rows < 0  -rows, and up to FOLLOW times as many if there is a contact in them
 *   shift     of the floes before, in their own sizes
 * -1 with FL_SYSTEM, or without an error if it was abandoned.  end->failed: the step was above the
 * critical one. */
static int32_t run_trial(fl_error_budget *g, int32_t m, int32_t rows, double shift, fl_window_end *end,
                         fl_err *err)
{
    fl_world *w = &g->trial;
    fl_text in = {0};
    fl_err why = {0};
    const int extend = rows < 0;
    int32_t last = extend ? -rows : rows, row = 0;
    if (fl_text_open_bytes(&in, "trial", g->state_text, (int64_t)g->state_bytes, err)) return -1;
    const int bad = fl_snapshot_read(w, &in, err);
    fl_text_close(&in);
    if (bad) return -1;
    for (int32_t i = 0; i < w->n && shift > 0.0; i++) {
        const double by = (i % 2 ? shift : -shift) * (w->b.bounding_radius[i] + w->b.radius[i]);
        w->b.x[i].x += by;
        w->b.v[i].x += by / (g->row_interval * last);
    }
    fl_step_set_size(w, g->row_interval / m, fl_world_time(w));
    const double before = w->impulse_sum;
    for (int32_t i = 0; i < w->n; i++) end->momentum[i] = v3_scale(w->b.m[i], w->b.v[i]);
    for (int32_t p = 0; p < w->parts; p++) {
        w->part_impulse[p] = w->part_moment[p] = v3(0, 0, 0);
        w->part_peak[p] = 0.0;
    }
    for (; row < last && !why.code; row++) {
        for (int32_t k = 0; k < m && !why.code; k++) {
            if (g->stop && *g->stop) return -1;
            g->trial_steps++;
            if (fl_step(w, &why) == 0) record_momenta(g);
        }
        if (extend && row + 1 == -rows && w->impulse_sum > before) last = followed_rows(g);
        for (int32_t c = 0; c < COMPARISONS; c++)
            if (row + 1 == comparison_row(g, last, c)) record_load(g, end, c);
    }
    if (why.code == FL_SYSTEM) {
        *err = why;
        return -1;
    }
    end->failed = why.code != 0;
    end->contact_impulse = w->impulse_sum - before;
    end->momentum_change = 0.0;
    for (int32_t i = 0; i < w->n; i++) {
        const fl_vec3 p = v3_scale(w->b.m[i], w->b.v[i]);
        end->momentum_change += 0.5 * v3_norm(v3_sub(p, end->momentum[i]));
        end->momentum[i] = p;
        end->position[i] = w->b.x[i];
    }
    return row;
}

/* --- comparison of trials ------------------------------------------------------------------------ */

/* The load of the goal, of one part. */
static fl_vec3 load_of(const fl_error_budget *g, const fl_window_end *e, int32_t p)
{
    return fl_load_component(g->load, e->load[p]);
}

/* |X - Y| at comparison c, summed over the parts; Y = NULL: |X|.  *along: its component along X. */
static double difference_at(const fl_error_budget *g, int32_t c, const fl_window_end *x,
                            const fl_window_end *y, double *along)
{
    double sum = 0.0;
    *along = 0.0;
    for (int32_t p = c * g->trial.parts; p < (c + 1) * g->trial.parts; p++) {
        const fl_vec3 a = load_of(g, x, p), d = y ? v3_sub(load_of(g, y, p), a) : a;
        const double size = v3_norm(a);
        sum += v3_norm(d);
        if (size > 0.0) *along += v3_dot(d, a) / size;
    }
    return sum;
}

/* The larger one of both comparisons, each relative to its load and times the last load.  At one time
 * alone the difference may be small by chance, as a later impact cancels the error of an earlier one. */
static double load_difference(const fl_error_budget *g, const fl_window_end *x, const fl_window_end *y,
                              double *along)
{
    double largest = 0.0, unused, one;
    const double whole = difference_at(g, COMPARISONS - 1, x, NULL, &unused);
    *along = 0.0;
    if (!y) return whole;
    for (int32_t c = 0; c < COMPARISONS; c++) {
        const double size = difference_at(g, c, x, NULL, &unused);
        const double rel = size > 0.0 ? difference_at(g, c, x, y, &one) / size : 0.0;
        if (size > 0.0) *along += one / size * whole / COMPARISONS;
        largest = fmax(largest, rel);
    }
    return whole * largest;
}

/* Half of the sum of momentum differences: a contact of two floes counts twice. */
static double momentum_difference(const fl_error_budget *g, const fl_window_end *x, const fl_window_end *y)
{
    double sum = 0.0;
    for (int32_t i = 0; i < g->trial.n; i++) sum += v3_norm(v3_sub(x->momentum[i], y->momentum[i]));
    return 0.5 * sum;
}

/* Ratio of the errors of a step and of half of it. */
static double halving_ratio(double order) { return fl_exp(order * fl_log(2.0)); }

/* e and p from three differences.  An order above 2 is not accepted: sliding and successive impacts are
 * less smooth than a window may suggest. */
static double richardson_error(double first, double second, double both, double *order)
{
    *order = 2.0;
    if (first > 0.0 && second > 0.0) *order = fl_log(first / second) / fl_log(2.0);
    *order = fmin(fmax(*order, 1.0), 2.0);
    return both + second / (halving_ratio(*order) - 1.0);
}

/* The result of a window from trials with h, h/2 and, while the orders are not known, h/4. */
static void compare_ends(const fl_error_budget *g, double h, int ends, fl_error_window *v)
{
    const fl_window_end *a = &g->end[0], *b = &g->end[1], *c = &g->end[ends - 1];
    const double order = v->order, astray_order = v->momentum_order;
    double unused, along;
    *v = (fl_error_window){.h = h, .order = 2.0, .momentum_order = 2.0};
    if (c->failed) { /* the step is far too long */
        v->error = v->momentum_error = INFINITY;
        v->size = v->impulse = 1.0;
        return;
    }
    v->size = load_difference(g, c, NULL, &unused);
    v->impulse = fmax(c->contact_impulse, c->momentum_change);
    const double both = load_difference(g, c, a, &along), all = momentum_difference(g, a, c);
    if (ends == 3) {
        v->error = richardson_error(load_difference(g, b, a, &unused), load_difference(g, c, b, &unused),
                                    both, &v->order);
        v->momentum_error = richardson_error(momentum_difference(g, a, b), momentum_difference(g, b, c), all,
                                             &v->momentum_order);
    } else {
        v->order = order, v->momentum_order = astray_order;
        v->error = both / (1.0 - 1.0 / halving_ratio(order));
        v->momentum_error = all / (1.0 - 1.0 / halving_ratio(astray_order));
    }
    v->signed_error = both > 0.0 ? along * v->error / both : 0.0;
    if (a->failed || b->failed) v->error = v->momentum_error = INFINITY;
}

/* --- choice of the step -------------------------------------------------------------------------- */

/* Error e of step `from`, scaled to step h. */

static double scaled_error(double e, double order, double h, double from)
{
    return e > 0.0 && isfinite(e) ? e * fl_pow(h / from, order) : e;
}

double fl_error_budget_estimate(const fl_error_budget *g, double h)
{
    double along = 0.0, squares = 0.0, size = 0.0, max_error = 0.0, largest = 0.0;
    for (int32_t k = 0; k < g->windows; k++) {
        const fl_error_window *v = &g->window[k];
        const double e = scaled_error(v->error, v->order, h, v->h);
        along += v->error > 0.0 ? v->signed_error * (e / v->error) : 0.0;
        squares += e * e;
        size += v->size;
        if (v->size > 0.0) max_error = fmax(max_error, e);
        largest = fmax(largest, v->size);
    }
    if (size <= 0.0) return 0.0;
    if (g->load == FL_ERROR_OF_PEAK) return max_error / largest;
    return isfinite(squares) ? fmax(fabs(along), sqrt(squares)) / size : INFINITY;
}

static double momentum_error_of(const fl_error_budget *g, double h)
{
    double error = 0.0, size = 0.0;
    for (int32_t k = 0; k < g->windows; k++) {
        const fl_error_window *v = &g->window[k];
        error += scaled_error(v->momentum_error, v->momentum_order, h, v->h);
        size += v->impulse;
    }
    return size > 0.0 ? error / size : 0.0;
}

/* Error over the allowed error. */
static double error_ratio(const fl_error_budget *g, double h)
{
    const int peak = g->load == FL_ERROR_OF_PEAK;
    const double goal = (peak ? GOAL_SHARE_PEAK : GOAL_SHARE) * g->goal;
    return fmax(fl_error_budget_estimate(g, h),
                momentum_error_of(g, h) / (peak ? MOMENTUM_SHARE_PEAK : MOMENTUM_SHARE)) /
           goal;
}

/* The step in [h/4, 4 h] with error_ratio() = 1, by bisection of the exponent. */
static double largest_step(const fl_error_budget *g, double h)
{
    double lo = -2.0, hi = 2.0;
    for (int k = 0; k < 24; k++) {
        const double mid = 0.5 * (lo + hi);
        if (error_ratio(g, h * fl_exp(mid * fl_log(2.0))) <= 1.0) lo = mid;
        else hi = mid;
    }
    return h * fl_exp(lo * fl_log(2.0));
}

/* Number of steps in a row that are at most h. */
static int32_t row_steps(const fl_error_budget *g, double h)
{
    const double m = ceil(g->row_interval / h * (1.0 - 1e-12)),
                 max_steps = (double)g->min_row_steps * STEP_RANGE;
    return (int32_t)fmin(fmax(m, g->min_row_steps), max_steps);
}

/* Number of steps in a row with the largest step used. */
static int32_t min_used_steps(const fl_error_budget *g)
{
    return (int32_t)fmin(ceil(g->min_row_steps / g->lateral_share * (1.0 - 1e-12)),
                         (double)g->min_row_steps * STEP_RANGE);
}

/* Search the step, from *m steps a row on; *m becomes the number to use.  end[0] is the trial with *m
 * already. */
static int search_step(fl_error_budget *g, int32_t *m, int32_t rows, fl_err *err)
{
    fl_error_window *v, accepted = {0}, tried = {0};
    double passed = 0.0, rejected = INFINITY;
    double least = INFINITY; /* error ratio of the best so far, and its steps */
    int32_t best = *m;
    int known = 0, failed = 0,
        useless = 0; /* orders are known; failed finest trials; rounds without progress */
    g->latest_window = (g->latest_window + 1) % FL_ERROR_WINDOWS;
    if (g->windows < FL_ERROR_WINDOWS) g->latest_window = g->windows++;
    v = &g->window[g->latest_window];
    for (int round = 0; round < ROUNDS; round++) {
        const double h = g->row_interval / *m;
        const int ends = known ? 2 : 3;
        for (int k = round ? 0 : 1; k < ends; k++)
            if (run_trial(g, *m << k, rows, 0.0, &g->end[k], err) < 0) return -1;
        compare_ends(g, h, ends, v);
        known = isfinite(v->error);
        failed += g->end[ends - 1].failed;
        if (failed == MAX_FAILED && passed == 0.0) break; /* the run will fail with a message of its own */
        const double error = error_ratio(g, h);
        if (error < IMPROVED * least) useless = 0, least = error, best = *m, tried = *v;
        else if (isfinite(error) && *m >= 2 * best) useless++;
        if (useless == MAX_USELESS && passed == 0.0) {
            *m = best, *v = tried;
            break;
        }
        double next;
        if (error <= 1.0) {
            passed = h;
            accepted = *v;
            next = largest_step(g, h);
            if (*m == g->min_row_steps || next < EQUAL_STEPS * h || rejected < EQUAL_STEPS * h) break;
        } else {
            rejected = h;
            next = largest_step(g, h);
            if (passed > 0.0 && rejected < EQUAL_STEPS * passed) break;
        }
        if (next >= rejected || next <= passed)
            next = passed > 0.0 ? sqrt(passed * rejected) : 0.5 * rejected;
        const int32_t was = *m;
        *m = row_steps(g, next);
        if (*m == was) break;
    }
    if (passed > 0.0) {
        *v = accepted;
        *m = row_steps(g, passed);
    }
    return 0;
}

/* --- when to search ------------------------------------------------------------------------------ */

/* 1 if two things may meet in the next window, or touch now, with more momentum than known. */
static int has_new_contact(const fl_error_budget *g, const fl_world *w)
{
    const fl_bodies *b = &w->b;
    const double T = g->row_interval * g->window_rows, fall = v3_norm(w->gravity) * T;
    fl_pair_iterator at = {.w = w};
    for (const fl_pair *p; (p = fl_pair_next(&at)) != NULL;) {
        const double known = g->known_momentum[kind_of(w, p)];
        double speed = p->max_approach_speed;
        if (p->touching == 0) {
            speed = v3_norm(v3_sub(b->v[p->i], b->v[p->j])) + v3_norm(b->w[p->i]) * b->bounding_radius[p->i] +
                    v3_norm(b->w[p->j]) * b->bounding_radius[p->j];
            /* speeds may change by half, and by gravity */
            if (p->free_travel - b->odometer[p->i] - b->odometer[p->j] > T * (1.5 * speed + fall)) continue;
        }
        if (known < 0.0 || p->mass * speed > NEW_MOMENTUM * known) return 1;
    }
    return 0;
}

/* Widen the neighbour list to the pairs that may meet in the next window; no bit of a step depends on it. */
static int widen_list(const fl_error_budget *g, fl_world *w, fl_err *err)
{
    const fl_bodies *b = &w->b;
    const double T = g->row_interval * g->window_rows, fall = v3_norm(w->gravity) * T;
    double longest = 0.0, used = 0.0;
    for (int32_t k = 0; k < b->total; k++) {
        longest =
            fmax(longest, T * (1.5 * (v3_norm(b->v[k]) + v3_norm(b->w[k]) * b->bounding_radius[k]) + fall));
        used = fmax(used, b->odometer[k] - w->odometer_at_search[k]);
    }
    if (2.0 * (longest + used) <= w->skin) return 0;
    w->skin = fmax(w->skin, 4.0 * longest);
    w->last_search_step = -1;
    return fl_neighbour_list_update(w, err);
}

static int can_afford(const fl_error_budget *g, const fl_world *w)
{
    return g->trial_steps <
           w->step / RUN_SHARE + (int64_t)FREE_WINDOWS * g->window_rows * row_steps(g, w->dt);
}

/* Root mean square distance of two ends: positions, and velocities times T. */
static double state_distance(const fl_error_budget *g, const fl_window_end *x, const fl_window_end *y,
                             double T)
{
    double sum = 0.0;
    for (int32_t i = 0; i < g->trial.n; i++) {
        const fl_vec3 speed = v3_scale(g->trial.b.invm[i], v3_sub(x->momentum[i], y->momentum[i]));
        sum += v3_norm2(v3_sub(x->position[i], y->position[i])) + T * T * v3_norm2(speed);
    }
    return sqrt(sum / g->trial.n);
}

/* Measure the divergence of two states that differ by a shift s and by s/T in speed.  In free flight they
 * end at a squared distance of (2 s)^2 + s^2. */
static int measure_divergence(fl_error_budget *g, const fl_world *w, int64_t row, int32_t m, fl_err *err)
{
    const int32_t rows = (int32_t)fmax(g->window_rows, (double)(row / DIVERGENCE_INTERVAL));
    double start = 0.0;
    for (int k = 0; k < 2; k++)
        if (run_trial(g, m, rows, k ? SHIFT : 0.0, &g->end[k], err) < 0) return -1;
    for (int32_t i = 0; i < w->n; i++) {
        const double s = SHIFT * (w->b.bounding_radius[i] + w->b.radius[i]);
        start += 5.0 * s * s;
    }
    start = sqrt(start / w->n);
    const double end = state_distance(g, &g->end[0], &g->end[1], g->row_interval * rows);
    if (start > 0.0 && end > 0.0 && isfinite(end) && !g->end[1].failed) {
        g->growth_log_sum += fl_log(end / start);
        g->growth_time += g->row_interval * rows;
    }
    g->divergence_rate = g->growth_log_sum > 0.0 ? g->growth_log_sum / g->growth_time : 0.0;
    g->next_rate_time = 2.0 * g->row_interval * (double)(row + rows);
    if (g->divergence_rate * g->row_interval * g->window_rows > 1.0)
        g->window_rows = (int32_t)fmax(1.0, 1.0 / (g->divergence_rate * g->row_interval));
    return 0;
}

double fl_error_budget_horizon(const fl_error_budget *g)
{
    return g->divergence_rate > 0.0 ? fl_log(g->goal * 0x1p52) / g->divergence_rate : INFINITY;
}

/* Undo an abandoned search; the memory of trials stays allocated. */
static void undo_search(fl_error_budget *g, const fl_error_budget *before)
{
    const fl_error_budget now = *g;
    *g = *before;
    g->trial = now.trial;
    g->state_text = now.state_text;
    g->state_bytes = now.state_bytes;
}

/* Use m steps a row from now on. */
static void use_steps(fl_error_budget *g, fl_world *w, int32_t m, double t)
{
    if (m != row_steps(g, w->dt)) fl_step_set_size(w, g->row_interval / m, t);
    g->min_dt = g->min_dt > 0.0 ? fmin(g->min_dt, w->dt) : w->dt;
    g->max_dt = fmax(g->max_dt, w->dt);
}

/* Run a search if there is reason to.  -1 with FL_SYSTEM, or without an error if it was abandoned. */
static int update_step(fl_error_budget *g, fl_world *w, int64_t row, fl_err *err)
{
    const double t = (double)row * g->row_interval;
    const int first = g->last_search_step < 0;
    const int due = !first && w->step - g->last_search_step >= SEARCH_INTERVAL * g->last_search_cost;
    if (widen_list(g, w, err)) return -1;
    if (t > 0.0 && t >= g->next_rate_time &&
        (save_state(g, w, err) || measure_divergence(g, w, row, row_steps(g, w->dt), err)))
        return -1;
    if (!due && !(has_new_contact(g, w) && can_afford(g, w))) return 0;
    int32_t m = row_steps(g, w->dt), rows;
    int is_new = 0;
    const int64_t before = g->trial_steps;
    if (m <= min_used_steps(g)) m = g->min_row_steps; /* start from the largest step allowed */
    if (save_state(g, w, err)) return -1;
    for (int32_t k = 0; k < PARTS + w->parts; k++) g->trial_momentum[k] = -1.0;
    rows = run_trial(g, m, -g->window_rows, 0.0, &g->end[0], err);
    if (rows < 0) return -1;
    for (int32_t k = 0; k < PARTS + w->parts; k++) {
        if (g->trial_momentum[k] < 0.0) continue;
        if (g->known_momentum[k] < 0.0 || g->trial_momentum[k] > NEW_MOMENTUM * g->known_momentum[k])
            is_new = 1;
    }
    if (is_new || (due && g->end[0].contact_impulse > 0.0) || g->end[0].failed) {
        if (search_step(g, &m, rows, err)) return -1;
        for (int32_t k = 0; k < PARTS + w->parts; k++)
            g->known_momentum[k] = fmax(g->known_momentum[k], g->trial_momentum[k]);
        g->n_searches++;
    }
    if (is_new || due) {
        g->last_search_step = w->step;
        g->last_search_cost = g->trial_steps - before;
    }
    if (m < min_used_steps(g)) m = min_used_steps(g);
    use_steps(g, w, m, t);
    return 0;
}

int fl_error_budget_update(fl_error_budget *g, fl_world *w, int64_t row, fl_err *err)
{
    const double t = (double)row * g->row_interval;
    if (g->last_search_step == w->step) return 0;
    /* rows end exactly at their times, whatever the steps in them were */
    w->t0 = t;
    w->step0 = w->step;
    /* Contacts together may be stiffer than predicted. */
    const double longest = fl_longest_step(&g->limit, w->dt_critical);
    if (w->dt > g->lateral_share * longest) {
        const int32_t fine = row_steps(g, longest);
        const int32_t taken = row_steps(g, g->lateral_share * longest);
        use_steps(g, w, taken, t);
        if (fine > g->min_row_steps) g->min_row_steps = fine < MAX_ROW_STEPS ? fine : MAX_ROW_STEPS;
    }
    if (row % g->window_rows) return 0;
    const fl_error_budget before = *g;
    if (update_step(g, w, row, err) == 0) return 0;
    if (err->code) return -1;
    undo_search(g, &before);
    return 0;
}

/* --- the run as a whole ------------------------------------------------------------------------ */

/* The order of the last window. */
static double order_of(const fl_error_budget *g)
{
    return g->latest_window < 0 ? 2.0 : g->window[g->latest_window].order;
}

int fl_error_budget_follow(fl_error_budget *g, const fl_world *w, fl_err *err)
{
    return fl_companion_follow(&g->companion, w, g->row_interval, g->load, g->goal, order_of(g), err);
}

double fl_error_budget_run_error(const fl_error_budget *g, double *difference)
{
    *difference = fl_companion_difference(&g->companion, g->load);
    return fl_companion_error(&g->companion, *difference, order_of(g));
}

/* --- set-up and checkpoint ----------------------------------------------------------------------- */

int fl_error_budget_make(fl_error_budget *g, const fl_scene *scene, const fl_ice_field *field,
                         const fl_ice_field *feed, const fl_surface *surface, const fl_member_model *members,
                         fl_err *err)
{
    int32_t body;
    *g = (fl_error_budget){.goal = scene->run.error,
                           .load = scene->run.error_of,
                           .row_interval = scene->output.loads_every,
                           .latest_window = -1,
                           .last_search_step = -1};
    if (fl_world_make_with_inflow(&g->trial, scene, field, feed, surface, members, err) ||
        fl_companion_make(&g->companion, scene, field, feed, surface, members, err)) {
        fl_error_budget_free(g);
        return -1;
    }
    const double longest =
        fmin(fl_automatic_step(&g->trial, &body), fmin(g->row_interval, scene->run.duration));
    g->limit = fl_predict_step_limit(&g->trial);
    g->lateral_share = fl_lateral_share(&g->trial);
    g->min_row_steps = (int32_t)fmin(ceil(g->row_interval / longest * (1.0 - 1e-12)), MAX_ROW_STEPS);
    g->window_rows = (int32_t)ceil((double)WINDOW_STEPS / g->min_row_steps);
    g->known_momentum = fl_alloc(PARTS + g->trial.parts, sizeof *g->known_momentum, err);
    g->trial_momentum = fl_alloc(PARTS + g->trial.parts, sizeof *g->trial_momentum, err);
    if (!g->known_momentum || !g->trial_momentum || alloc_ends(g, err)) {
        fl_error_budget_free(g);
        return -1;
    }
    for (int32_t k = 0; k < PARTS + g->trial.parts; k++) g->known_momentum[k] = -1.0;
    return 0;
}

void fl_error_budget_free(fl_error_budget *g)
{
    fl_world_free(&g->trial);
    fl_companion_free(&g->companion);
    for (int k = 0; k < 3; k++) {
        fl_window_end *e = &g->end[k];
        free(e->load), free(e->momentum), free(e->position);
    }
    free(g->known_momentum), free(g->trial_momentum), free(g->state_text);
    *g = (fl_error_budget){0};
}

double fl_error_budget_first_step(const fl_error_budget *g) { return g->row_interval / min_used_steps(g); }

/* A finite number; an error may be infinite, for steps that failed. */
static void exchange_real(fl_state_io *t, double *x, int error)
{
    fl_state_io_real(t, x);
    if (t->in && !t->err->code && !(isfinite(*x) || (error && *x > 0.0)))
        fl_text_fail(t->in, t->err, "not a finite number");
}

static int exchange_budget(FILE *f, fl_text *in, fl_error_budget *g, fl_err *err)
{
    fl_state_io t = {f, in, err};
    int64_t *const count[] = {&g->n_searches, &g->last_search_step, &g->trial_steps, &g->last_search_cost};
    double *const real[] = {&g->divergence_rate, &g->growth_log_sum, &g->growth_time,
                            &g->next_rate_time,  &g->min_dt,         &g->max_dt};
    fl_state_io_open(&t, "budget");
    fl_state_io_int(&t, 1, WINDOW_STEPS, &g->window_rows);
    fl_state_io_int(&t, 0, FL_ERROR_WINDOWS, &g->windows);
    fl_state_io_int(&t, -1, g->windows - 1, &g->latest_window);
    fl_state_io_int(&t, 1, MAX_ROW_STEPS, &g->min_row_steps);
    for (size_t k = 0; k < sizeof count / sizeof *count; k++) fl_state_io_count(&t, count[k]);
    for (size_t k = 0; k < sizeof real / sizeof *real; k++) exchange_real(&t, real[k], 0);
    fl_state_io_close(&t);
    fl_state_io_open(&t, "known");
    for (int32_t k = 0; k < PARTS + g->trial.parts; k++) exchange_real(&t, &g->known_momentum[k], 0);
    fl_state_io_close(&t);
    for (int32_t c = 0; c < g->windows && !err->code; c++) {
        fl_error_window *v = &g->window[c];
        double *const all[] = {&v->h,
                               &v->error,
                               &v->order,
                               &v->size,
                               &v->signed_error,
                               &v->momentum_error,
                               &v->momentum_order,
                               &v->impulse};
        fl_state_io_open(&t, "window");
        for (size_t k = 0; k < sizeof all / sizeof *all; k++)
            exchange_real(&t, all[k], all[k] == &v->error || all[k] == &v->momentum_error);
        fl_state_io_close(&t);
        if (in && !err->code && !(v->h > 0.0 && v->order >= 1.0 && v->momentum_order >= 1.0))
            return fl_text_fail(in, err, "the row is not a window of an error budget");
    }
    return err->code ? -1 : fl_companion_state_io(f, in, &g->companion, err);
}

void fl_error_budget_write(FILE *f, const fl_error_budget *g)
{
    fl_err unused = {0};
    fl_error_budget copy = *g; /* exchange() takes pointers to non-const; nothing is changed */
    exchange_budget(f, NULL, &copy, &unused);
}

int fl_error_budget_read(fl_error_budget *g, fl_text *in, fl_err *err)
{
    if (exchange_budget(NULL, in, g, err)) return -1;
    const int more = fl_text_row(in, err);
    if (more > 0) fl_text_fail(in, err, "unexpected \"%.40s\" after the error budget", in->field[0]);
    return more ? -1 : 0;
}
