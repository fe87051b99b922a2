/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <inttypes.h>
#include <string.h>
#include "base/fast_math.h"
#include "base/array.h"
#include "out/state_io.h"
#include "sim/setup.h"
#include "sphere/contact_list.h"
#include "sim/error_budget.h"
#include "sim/critical_step.h"
#include "sim/neighbour_list.h"
#include "sim/snapshot.h"
#include "sim/step.h"
#include "world/access.h"

/* The estimate itself is off by some, and a peak is one value, in which nothing cancels: so much of the goal
 * is used. */
#define MARGIN 0.92
#define MARGIN_PEAK 0.65
/* A meeting of this much more momentum than any before is news. */
#define NEWS 1.15
/* Two steps nearer to one another than this are as good as one. */
#define NEAR 1.2
/* Half a step, or less of it, leaves no more than this of what it was off by where the step is what it is. */
#define BETTER 0.7
/* Momenta of floes may be off by as much as the load, of what they took; where a peak is asked for by half of
 * it, since to its own error that of the speed it comes from is added. */
#define LOOSE 1.0
#define LOOSE_PEAK 0.5
/* Floes are moved by this share of their size where two states are to part: far above rounding, and far below
 * what a contact yields by. */
#define SHIFT 0x1p-26

enum {
    FLOES,            /* kinds of meetings: floe and floe, */
    WALLS,            /* floe and wall, */
    PARTS,            /* and so on: floe and part */
    WINDOW = 64,      /* steps in a window at the least */
    FOLLOW = 10,      /* windows that what meets in the first of them is followed for, */
    BEFORE = 8,       /* and where in them the load is looked at as well: */
    MARKS = 2,        /* looks */
    ROUNDS = 8,       /* steps tried in one look at the most */
    FUTILE = 4,       /* of which so many may fail, down to a 32nd: it is not the step then; */
    VAIN = 2,         /* nor where so many, of half the best one or less, are no better than it */
    MOST = 100000,    /* steps in a row there may be with the largest step */
    FINEST = 1 << 12, /* the largest step over the smallest there may be */
    AGAIN = 10,       /* steps between looks over those of a look */
    ALLOWED = 64,     /* windows of trials that are allowed at once, and */
    SHARE = 3,        /* beyond them: steps of the run over steps of trials */
    PARTING = 24      /* time so far over a window that measures how states part */
};

/* --- a trial ----------------------------------------------------------------------------------- */

static int ends_alloc(fl_error_budget *g, fl_err *err)
{
    for (int k = 0; k < 3; k++) {
        fl_window_end *e = &g->end[k];
        const struct {
            void *array;
            int32_t n;
            size_t size;
        } want[] = {{&e->load, MARKS * g->trial.parts, sizeof *e->load},
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

static int take_state(fl_error_budget *g, fl_world *w, fl_err *err)
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
    const int32_t part = w->structure.piece[p->j - w->n].part;
    return part < 0 ? WALLS : PARTS + part;
}

/* The hardest meetings under way. */
static void watch(fl_error_budget *g)
{
    const fl_world *w = &g->trial;
    fl_pair_iterator at = {.w = w};
    for (const fl_pair *p; (p = fl_pair_next(&at)) != NULL;) {
        if (p->touching == 0) continue;
        const int kind = kind_of(w, p);
        g->trial_momentum[kind] = fmax(g->trial_momentum[kind], p->mass * p->max_approach_speed);
    }
}

/* Rows of a window that follows what met: FOLLOW times as long, but shorter than states take to part. */
static int32_t reach_of(const fl_error_budget *g)
{
    const double parting = g->divergence_rate > 0.0 ? 1.0 / (g->divergence_rate * g->row_interval) : INFINITY;
    return (int32_t)fmax(g->window_rows, fmin(parting, (double)FOLLOW * g->window_rows));
}

/* The row behind which the load is looked at. */
static int32_t mark_row(const fl_error_budget *g, int32_t rows, int32_t c)
{
    return c == 0 && rows > BEFORE * g->window_rows ? BEFORE * g->window_rows : rows;
}

static void mark(const fl_error_budget *g, fl_window_end *end, int32_t c)
{
    const fl_world *w = &g->trial;
    for (int32_t p = 0; p < w->parts; p++)
        end->load[c * w->parts + p] = (fl_total_load){w->part_impulse[p], w->part_moment[p], w->part_peak[p]};
}

/* The state through `rows` rows of m steps each; rows < 0: through -rows, and as many again up to FOLLOW
 * times where anything met or touched in them; returns the number of rows.  shift: how far floes are moved
 * before, in their own sizes.  -1 with FL_SYSTEM, or with no error where it was broken off; a step above the
 * critical one is told in the end. */
static int32_t trial(fl_error_budget *g, int32_t m, int32_t rows, double shift, fl_window_end *end,
                     fl_err *err)
{
    fl_world *w = &g->trial;
    fl_text in = {0};
    fl_err why = {0};
    const int open = rows < 0;
    int32_t last = open ? -rows : rows, row = 0;
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
            if (fl_step(w, &why) == 0) watch(g);
        }
        if (open && row + 1 == -rows && w->impulse_sum > before) last = reach_of(g);
        for (int32_t c = 0; c < MARKS; c++)
            if (row + 1 == mark_row(g, last, c)) mark(g, end, c);
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

/* --- what trials tell -------------------------------------------------------------------------- */

/* The load that is asked for, of one part. */
static fl_vec3 load_of(const fl_error_budget *g, const fl_window_end *e, int32_t p)
{
    return fl_load_component(g->load, e->load[p]);
}

/* |X - Y| at a mark, added up over the parts; Y NULL: |X|.  *along: its part in the direction of X. */
static double apart_at(const fl_error_budget *g, int32_t c, const fl_window_end *x, const fl_window_end *y,
                       double *along)
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

/* The larger one of both marks, each relative to the load until then and times that of the last: what is off
 * in the middle of a hit is made good by the next one, and at one time alone may be nothing by chance. */
static double apart(const fl_error_budget *g, const fl_window_end *x, const fl_window_end *y, double *along)
{
    double most = 0.0, none, one;
    const double whole = apart_at(g, MARKS - 1, x, NULL, &none);
    *along = 0.0;
    if (!y) return whole;
    for (int32_t c = 0; c < MARKS; c++) {
        const double size = apart_at(g, c, x, NULL, &none);
        const double rel = size > 0.0 ? apart_at(g, c, x, y, &one) / size : 0.0;
        if (size > 0.0) *along += one / size * whole / MARKS;
        most = fmax(most, rel);
    }
    return whole * most;
}

/* By how much momenta differ, half of it: in a contact of two floes it counts twice. */
static double astray(const fl_error_budget *g, const fl_window_end *x, const fl_window_end *y)
{
    double sum = 0.0;
    for (int32_t i = 0; i < g->trial.n; i++) sum += v3_norm(v3_sub(x->momentum[i], y->momentum[i]));
    return 0.5 * sum;
}

/* How much less half the step is off by. */
static double finer(double order) { return fl_exp(order * fl_log(2.0)); }

/* e and p from the three differences.  No order above 2 is believed: sliding, and impacts one after the
 * other, are not as smooth as one window may look. */
static double richardson(double first, double second, double both, double *order)
{
    *order = 2.0;
    if (first > 0.0 && second > 0.0) *order = fl_log(first / second) / fl_log(2.0);
    *order = fmin(fmax(*order, 1.0), 2.0);
    return both + second / (finer(*order) - 1.0);
}

/* What the ends of h, h/2 and, where the orders are not known yet, h/4 tell. */
static void compare(const fl_error_budget *g, double h, int ends, fl_error_window *v)
{
    const fl_window_end *a = &g->end[0], *b = &g->end[1], *c = &g->end[ends - 1];
    const double order = v->order, astray_order = v->momentum_order;
    double none, along;
    *v = (fl_error_window){.h = h, .order = 2.0, .momentum_order = 2.0};
    if (c->failed) { /* nothing is known but that it is far too long */
        v->error = v->momentum_error = INFINITY;
        v->size = v->impulse = 1.0;
        return;
    }
    v->size = apart(g, c, NULL, &none);
    v->impulse = fmax(c->contact_impulse, c->momentum_change);
    const double both = apart(g, c, a, &along), all = astray(g, a, c);
    if (ends == 3) {
        v->error = richardson(apart(g, b, a, &none), apart(g, c, b, &none), both, &v->order);
        v->momentum_error = richardson(astray(g, a, b), astray(g, b, c), all, &v->momentum_order);
    } else {
        v->order = order, v->momentum_order = astray_order;
        v->error = both / (1.0 - 1.0 / finer(order));
        v->momentum_error = all / (1.0 - 1.0 / finer(astray_order));
    }
    v->signed_error = both > 0.0 ? along * v->error / both : 0.0;
    if (a->failed || b->failed) v->error = v->momentum_error = INFINITY;
}

/* --- the step that they ask for ---------------------------------------------------------------- */

static double grown(double e, double order, double h, double from)
{
    return e > 0.0 && isfinite(e) ? e * fl_pow(h / from, order) : e;
}

double fl_error_budget_estimate(const fl_error_budget *g, double h)
{
    double along = 0.0, squares = 0.0, size = 0.0, most = 0.0, largest = 0.0;
    for (int32_t k = 0; k < g->windows; k++) {
        const fl_error_window *v = &g->window[k];
        const double e = grown(v->error, v->order, h, v->h);
        along += v->error > 0.0 ? v->signed_error * (e / v->error) : 0.0;
        squares += e * e;
        size += v->size;
        if (v->size > 0.0) most = fmax(most, e);
        largest = fmax(largest, v->size);
    }
    if (size <= 0.0) return 0.0;
    if (g->load == FL_ERROR_OF_PEAK) return most / largest;
    return isfinite(squares) ? fmax(fabs(along), sqrt(squares)) / size : INFINITY;
}

static double momenta_astray(const fl_error_budget *g, double h)
{
    double off = 0.0, size = 0.0;
    for (int32_t k = 0; k < g->windows; k++) {
        const fl_error_window *v = &g->window[k];
        off += grown(v->momentum_error, v->momentum_order, h, v->h);
        size += v->impulse;
    }
    return size > 0.0 ? off / size : 0.0;
}

/* 1 is what is allowed. */
static double strain(const fl_error_budget *g, double h)
{
    const int peak = g->load == FL_ERROR_OF_PEAK;
    const double goal = (peak ? MARGIN_PEAK : MARGIN) * g->goal;
    return fmax(fl_error_budget_estimate(g, h), momenta_astray(g, h) / (peak ? LOOSE_PEAK : LOOSE)) / goal;
}

/* Where the strain is 1: between h/4 and 4 h, by halving of the exponent. */
static double wanted(const fl_error_budget *g, double h)
{
    double lo = -2.0, hi = 2.0;
    for (int k = 0; k < 24; k++) {
        const double mid = 0.5 * (lo + hi);
        if (strain(g, h * fl_exp(mid * fl_log(2.0))) <= 1.0) lo = mid;
        else hi = mid;
    }
    return h * fl_exp(lo * fl_log(2.0));
}

/* Steps in a row, so that they are of h at the most. */
static int32_t steps_of(const fl_error_budget *g, double h)
{
    const double m = ceil(g->row_interval / h * (1.0 - 1e-12)), most = (double)g->min_row_steps * FINEST;
    return (int32_t)fmin(fmax(m, g->min_row_steps), most);
}

/* Steps in a row with the largest step that is taken. */
static int32_t fewest(const fl_error_budget *g)
{
    return (int32_t)fmin(ceil(g->min_row_steps / g->lateral_share * (1.0 - 1e-12)),
                         (double)g->min_row_steps * FINEST);
}

/* Try steps from m a row on; *m becomes what is to be taken.  end[0] is that of m already. */
static int calibrate(fl_error_budget *g, int32_t *m, int32_t rows, fl_err *err)
{
    fl_error_window *v, good = {0}, tried = {0};
    double passed = 0.0, refused = INFINITY;
    double least = INFINITY; /* strain of the best so far, and its steps */
    int32_t best = *m;
    int known = 0, failed = 0, vain = 0; /* the orders; how often the finest has; rounds in vain */
    g->latest_window = (g->latest_window + 1) % FL_ERROR_WINDOWS;
    if (g->windows < FL_ERROR_WINDOWS) g->latest_window = g->windows++;
    v = &g->window[g->latest_window];
    for (int round = 0; round < ROUNDS; round++) {
        const double h = g->row_interval / *m;
        const int ends = known ? 2 : 3;
        for (int k = round ? 0 : 1; k < ends; k++)
            if (trial(g, *m << k, rows, 0.0, &g->end[k], err) < 0) return -1;
        compare(g, h, ends, v);
        known = isfinite(v->error);
        failed += g->end[ends - 1].failed;
        if (failed == FUTILE && passed == 0.0) break; /* the run will tell what it is */
        const double off = strain(g, h);
        if (off < BETTER * least) vain = 0, least = off, best = *m, tried = *v;
        else if (isfinite(off) && *m >= 2 * best) vain++;
        if (vain == VAIN && passed == 0.0) {
            *m = best, *v = tried;
            break;
        }
        double next;
        if (off <= 1.0) {
            passed = h;
            good = *v;
            next = wanted(g, h);
            if (*m == g->min_row_steps || next < NEAR * h || refused < NEAR * h) break;
        } else {
            refused = h;
            next = wanted(g, h);
            if (passed > 0.0 && refused < NEAR * passed) break;
        }
        if (next >= refused || next <= passed) next = passed > 0.0 ? sqrt(passed * refused) : 0.5 * refused;
        const int32_t was = *m;
        *m = steps_of(g, next);
        if (*m == was) break;
    }
    if (passed > 0.0) {
        *v = good;
        *m = steps_of(g, passed);
    }
    return 0;
}

/* --- when to look ------------------------------------------------------------------------------ */

/* May two things meet in the window to come, or touch already, as none did before? */
static int something_new(const fl_error_budget *g, const fl_world *w)
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
            /* speeds change on the way: half as much again, and by gravity */
            if (p->free_travel - b->odometer[p->i] - b->odometer[p->j] > T * (1.5 * speed + fall)) continue;
        }
        if (known < 0.0 || p->mass * speed > NEWS * known) return 1;
    }
    return 0;
}

/* List the pairs that may meet in the window to come; which ones are listed bears on no bit of a step. */
static int list_far(const fl_error_budget *g, fl_world *w, fl_err *err)
{
    const fl_bodies *b = &w->b;
    const double T = g->row_interval * g->window_rows, fall = v3_norm(w->gravity) * T;
    double most = 0.0, used = 0.0;
    for (int32_t k = 0; k < b->total; k++) {
        most = fmax(most, T * (1.5 * (v3_norm(b->v[k]) + v3_norm(b->w[k]) * b->bounding_radius[k]) + fall));
        used = fmax(used, b->odometer[k] - w->odometer_at_search[k]);
    }
    if (2.0 * (most + used) <= w->skin) return 0;
    w->skin = fmax(w->skin, 4.0 * most);
    w->last_search_step = -1;
    return fl_neighbour_list_update(w, err);
}

static int afford(const fl_error_budget *g, const fl_world *w)
{
    return g->trial_steps < w->step / SHARE + (int64_t)ALLOWED * g->window_rows * steps_of(g, w->dt);
}

/* Distance of two ends, positions and what velocities amount to in time T: root of the mean square. */
static double distance(const fl_error_budget *g, const fl_window_end *x, const fl_window_end *y, double T)
{
    double sum = 0.0;
    for (int32_t i = 0; i < g->trial.n; i++) {
        const fl_vec3 speed = v3_scale(g->trial.b.invm[i], v3_sub(x->momentum[i], y->momentum[i]));
        sum += v3_norm2(v3_sub(x->position[i], y->position[i])) + T * T * v3_norm2(speed);
    }
    return sqrt(sum / g->trial.n);
}

/* How fast states part that differ by little, beyond what they would in free flight: shifted by s, and
 * as much again by their speed, to which the speed itself comes. */
static int measure_parting(fl_error_budget *g, const fl_world *w, int64_t row, int32_t m, fl_err *err)
{
    const int32_t rows = (int32_t)fmax(g->window_rows, (double)(row / PARTING));
    double start = 0.0;
    for (int k = 0; k < 2; k++)
        if (trial(g, m, rows, k ? SHIFT : 0.0, &g->end[k], err) < 0) return -1;
    for (int32_t i = 0; i < w->n; i++) {
        const double s = SHIFT * (w->b.bounding_radius[i] + w->b.radius[i]);
        start += 5.0 * s * s;
    }
    start = sqrt(start / w->n);
    const double end = distance(g, &g->end[0], &g->end[1], g->row_interval * rows);
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

/* Forget what a look has told that was broken off; what trials work in stays. */
static void forget(fl_error_budget *g, const fl_error_budget *before)
{
    const fl_error_budget now = *g;
    *g = *before;
    g->trial = now.trial;
    g->state_text = now.state_text;
    g->state_bytes = now.state_bytes;
}

/* From now on so many a row. */
static void take_steps(fl_error_budget *g, fl_world *w, int32_t m, double t)
{
    if (m != steps_of(g, w->dt)) fl_step_set_size(w, g->row_interval / m, t);
    g->min_dt = g->min_dt > 0.0 ? fmin(g->min_dt, w->dt) : w->dt;
    g->max_dt = fmax(g->max_dt, w->dt);
}

/* Look, by trials, where there is reason to.  -1 with FL_SYSTEM, or with no error where it was broken off. */
static int look(fl_error_budget *g, fl_world *w, int64_t row, fl_err *err)
{
    const double t = (double)row * g->row_interval;
    const int first = g->last_search_step < 0;
    const int due = !first && w->step - g->last_search_step >= AGAIN * g->last_search_cost;
    if (list_far(g, w, err)) return -1;
    if (t > 0.0 && t >= g->next_rate_time &&
        (take_state(g, w, err) || measure_parting(g, w, row, steps_of(g, w->dt), err)))
        return -1;
    if (!due && !(something_new(g, w) && afford(g, w))) return 0;
    int32_t m = steps_of(g, w->dt), rows;
    int news = 0;
    const int64_t before = g->trial_steps;
    if (m <= fewest(g)) m = g->min_row_steps; /* not what was found, then, but the largest there may be */
    if (take_state(g, w, err)) return -1;
    for (int32_t k = 0; k < PARTS + w->parts; k++) g->trial_momentum[k] = -1.0;
    rows = trial(g, m, -g->window_rows, 0.0, &g->end[0], err);
    if (rows < 0) return -1;
    for (int32_t k = 0; k < PARTS + w->parts; k++) {
        if (g->trial_momentum[k] < 0.0) continue;
        if (g->known_momentum[k] < 0.0 || g->trial_momentum[k] > NEWS * g->known_momentum[k]) news = 1;
    }
    if (news || (due && g->end[0].contact_impulse > 0.0) || g->end[0].failed) {
        if (calibrate(g, &m, rows, err)) return -1;
        for (int32_t k = 0; k < PARTS + w->parts; k++)
            g->known_momentum[k] = fmax(g->known_momentum[k], g->trial_momentum[k]);
        g->n_searches++;
    }
    if (news || due) {
        g->last_search_step = w->step;
        g->last_search_cost = g->trial_steps - before;
    }
    if (m < fewest(g)) m = fewest(g);
    take_steps(g, w, m, t);
    return 0;
}

int fl_error_budget_update(fl_error_budget *g, fl_world *w, int64_t row, fl_err *err)
{
    const double t = (double)row * g->row_interval;
    if (g->last_search_step == w->step) return 0;
    /* rows end on their very times, whatever the steps in them were */
    w->t0 = t;
    w->step0 = w->step;
    /* What touches may be stiffer together than what was known beforehand. */
    const double longest = fl_longest_step(&g->limit, w->dt_critical);
    if (w->dt > g->lateral_share * longest) {
        const int32_t fine = steps_of(g, longest);
        const int32_t taken = steps_of(g, g->lateral_share * longest);
        take_steps(g, w, taken, t);
        if (fine > g->min_row_steps) g->min_row_steps = fine < MOST ? fine : MOST;
    }
    if (row % g->window_rows) return 0;
    const fl_error_budget before = *g;
    if (look(g, w, row, err) == 0) return 0;
    if (err->code) return -1;
    forget(g, &before);
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

double fl_error_budget_run_error(const fl_error_budget *g, double *apart)
{
    *apart = fl_companion_difference(&g->companion, g->load);
    return fl_companion_error(&g->companion, *apart, order_of(g));
}

/* --- made and kept ----------------------------------------------------------------------------- */

int fl_error_budget_make(fl_error_budget *g, const fl_scene *scene, const fl_ice_field *field,
                         const fl_ice_field *feed, const fl_surface *surface, fl_err *err)
{
    int32_t body;
    *g = (fl_error_budget){.goal = scene->run.error,
                           .load = scene->run.error_of,
                           .row_interval = scene->output.loads_every,
                           .latest_window = -1,
                           .last_search_step = -1};
    if (fl_world_make_with_inflow(&g->trial, scene, field, feed, surface, err) ||
        fl_companion_make(&g->companion, scene, field, feed, surface, err)) {
        fl_error_budget_free(g);
        return -1;
    }
    const double most = fmin(fl_automatic_step(&g->trial, &body), fmin(g->row_interval, scene->run.duration));
    g->limit = fl_predict_step_limit(&g->trial);
    g->lateral_share = fl_lateral_share(&g->trial);
    g->min_row_steps = (int32_t)fmin(ceil(g->row_interval / most * (1.0 - 1e-12)), MOST);
    g->window_rows = (int32_t)ceil((double)WINDOW / g->min_row_steps);
    g->known_momentum = fl_alloc(PARTS + g->trial.parts, sizeof *g->known_momentum, err);
    g->trial_momentum = fl_alloc(PARTS + g->trial.parts, sizeof *g->trial_momentum, err);
    if (!g->known_momentum || !g->trial_momentum || ends_alloc(g, err)) {
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

double fl_error_budget_first_step(const fl_error_budget *g) { return g->row_interval / fewest(g); }

/* A finite number; an error, which is infinite of steps that failed. */
static void pass(fl_state_io *t, double *x, int error)
{
    fl_state_io_real(t, x);
    if (t->in && !t->err->code && !(isfinite(*x) || (error && *x > 0.0)))
        fl_text_fail(t->in, t->err, "not a finite number");
}

static int exchange(FILE *f, fl_text *in, fl_error_budget *g, fl_err *err)
{
    fl_state_io t = {f, in, err};
    int64_t *const count[] = {&g->n_searches, &g->last_search_step, &g->trial_steps, &g->last_search_cost};
    double *const real[] = {&g->divergence_rate, &g->growth_log_sum, &g->growth_time,
                            &g->next_rate_time,  &g->min_dt,         &g->max_dt};
    fl_state_io_open(&t, "budget");
    fl_state_io_int(&t, 1, WINDOW, &g->window_rows);
    fl_state_io_int(&t, 0, FL_ERROR_WINDOWS, &g->windows);
    fl_state_io_int(&t, -1, g->windows - 1, &g->latest_window);
    fl_state_io_int(&t, 1, MOST, &g->min_row_steps);
    for (size_t k = 0; k < sizeof count / sizeof *count; k++) fl_state_io_count(&t, count[k]);
    for (size_t k = 0; k < sizeof real / sizeof *real; k++) pass(&t, real[k], 0);
    fl_state_io_close(&t);
    fl_state_io_open(&t, "known");
    for (int32_t k = 0; k < PARTS + g->trial.parts; k++) pass(&t, &g->known_momentum[k], 0);
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
            pass(&t, all[k], all[k] == &v->error || all[k] == &v->momentum_error);
        fl_state_io_close(&t);
        if (in && !err->code && !(v->h > 0.0 && v->order >= 1.0 && v->momentum_order >= 1.0))
            return fl_text_fail(in, err, "this is no window of an error budget");
    }
    return err->code ? -1 : fl_companion_state_io(f, in, &g->companion, err);
}

void fl_error_budget_write(FILE *f, const fl_error_budget *g)
{
    fl_err none = {0};
    fl_error_budget copy = *g; /* the list is of what can be written to; nothing is */
    exchange(f, NULL, &copy, &none);
}

int fl_error_budget_read(fl_error_budget *g, fl_text *in, fl_err *err)
{
    if (exchange(NULL, in, g, err)) return -1;
    const int more = fl_text_row(in, err);
    if (more > 0) fl_text_fail(in, err, "\"%.40s\" behind the budget was not expected", in->field[0]);
    return more ? -1 : 0;
}
