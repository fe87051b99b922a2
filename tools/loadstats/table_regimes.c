/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "stat/rainflow.h"
#include "stat/resample.h"
#include "table_regimes.h"

#define USUAL_WINDOW 20.0 /* [s] */
enum { FX, FY, UX, UY, VX, VY, CLOSING, BREAKS };

int regime_signals(const char *signal[REGIME_SIGNALS], int speed)
{
    static const char *const name[REGIME_SIGNALS] = {"fx", "fy", "ux", "uy", "vx", "vy", "closing", "breaks"};
    for (int k = 0; k < REGIME_SIGNALS; k++) signal[k] = name[k];
    return speed ? CLOSING : REGIME_SIGNALS;
}

/* Number of windows; each is at least of four rows. */
static int count_windows(struct regime_windows *w, const struct record_views *r, const struct options *o,
                         fl_err *err)
{
    const fl_signal_view *v = NULL; /* any: all have the rows of the record */
    for (int32_t s = 0; s < r->series->signals && !v; s++) v = find_view(r, 0, s, 0);
    if (!v) return fl_fail(err, FL_INPUT, "the record has no signal that is more than rounding");
    const double even = fl_resample_common_interval(v->n, v->edge),
                 length = o->segment > 0.0 ? o->segment : USUAL_WINDOW;
    double fastest = 0.0;
    if (!(even > 0.0))
        return fl_fail(err, FL_INPUT, "the intervals of the record are not equal: --step is expected");
    for (int32_t k = 0; k < o->modes; k++) fastest = fmax(fastest, o->mode[k]);
    w->dt = even;
    w->each = (int32_t)fmin(INT32_MAX / 2, length / even + 0.5);
    w->rows = v->n;
    if (w->each < 4 || w->each > v->n)
        return fl_fail(err, FL_INPUT, "windows of %g s do not fit a record of %g s in rows of %g s", length,
                       even * v->n, even);
    w->n = v->n / w->each;
    if (!o->quiet && even * fastest > 0.1 * (1.0 + 1e-9))
        fprintf(
            stderr,
            "loadstats: rows of %.4g s are long for a mode of %.4g Hz, ten or more a period are expected\n",
            even, fastest);
    return 0;
}

int regimes_make(struct regime_windows *w, const struct record_views *r, const struct options *o,
                 int32_t part, fl_err *err)
{
    *w = (struct regime_windows){0};
    if (count_windows(w, r, o, err)) return -1;
    const int32_t n = w->rows;
    const double *x[REGIME_SIGNALS] = {NULL};
    w->memory = fl_alloc(5 * (int64_t)n, sizeof *w->memory, err);
    w->window = fl_alloc(w->n, sizeof *w->window, err);
    if (err->code) return -1;
    double *load = w->memory, *u = load + n, *v = u + n, *ice = v + n, *none = ice + n, fx = 0.0, fy = 0.0;
    for (int32_t s = 0; s < r->series->signals; s++) { /* what is left out as rounding is 0 */
        const fl_signal_view *seen = find_view(r, part, s, 0);
        x[s] = seen ? seen->x : none;
    }
    for (int32_t k = 0; k < n; k++) fx += x[FX][k] / n, fy += x[FY][k] / n;
    const double size = hypot(fx, fy), c = size > 0.0 ? fx / size : 1.0, s = size > 0.0 ? fy / size : 0.0;
    for (int32_t k = 0; k < n; k++) {
        load[k] = c * x[FX][k] + s * x[FY][k];
        u[k] = c * x[UX][k] + s * x[UY][k];
        v[k] = c * x[VX][k] + s * x[VY][k];
        ice[k] = x[CLOSING] ? x[CLOSING][k] + v[k] : o->speed;
    }
    const fl_regime_rows rows = {n, w->dt, load, u, v, ice, x[BREAKS]};
    for (int32_t k = 0; k < w->n; k++)
        if (fl_regime_classify(&w->window[k], &rows, k * w->each, (k + 1) * w->each, o->mode, o->modes, err))
            return -1;
    return 0;
}

void regimes_free(struct regime_windows *w)
{
    free(w->window), free(w->memory);
    *w = (struct regime_windows){0};
}

/* The total has no motion. */
static int has_motion(const struct record_views *r, int32_t part, int32_t signal, int w)
{
    return signal == FX && w == 0 && find_view(r, part, UX, 0) != NULL;
}

static void write_mode(FILE *f, const struct options *o, int32_t mode)
{
    if (mode < 0) fputs("\t-", f);
    else write_cell(f, o->mode[mode]);
}

int regime_rows(FILE *f, const struct record_views *r, const struct options *o, int32_t part, int32_t signal,
                int w, fl_err *err)
{
    struct regime_windows q;
    if (!has_motion(r, part, signal, w)) return 0;
    const int rc = regimes_make(&q, r, o, part, err);
    for (int32_t k = 0; rc == 0 && k < q.n; k++) {
        const fl_regime_window *a = &q.window[k];
        const double *edge = find_view(r, part, FX, 0)->edge;
        fputs(r->series->part[part], f);
        write_cell(f, edge[k * q.each]);
        write_cell(f, edge[(k + 1) * q.each]);
        fprintf(f, "\t%s", fl_regime_name(a->regime));
        write_mode(f, o, a->mode);
        write_cell(f, a->speed);
        write_cell(f, a->beta);
        write_cell(f, a->peak);
        write_cell(f, a->frequency);
        write_cell(f, a->load);
        write_cell(f, a->load_std);
        write_cell(f, a->load_max);
        write_cell(f, a->x_mean);
        write_cell(f, a->x_std);
        write_cell(f, r->series->signals > BREAKS ? a->breaks : NAN);
        putc('\n', f);
    }
    regimes_free(&q);
    return rc;
}

/* Sums over the windows of one regime, and of lock-in in one mode. */
struct regime_sum {
    int32_t windows, cycles_n;
    double slowest, fastest, load, load_max, beta_max, cycles, range_max, power;
};

static int add_window(struct regime_sum *s, const struct regime_windows *q, int32_t k,
                      const struct options *o, double m, fl_err *err)
{
    const fl_regime_window *a = &q->window[k];
    fl_rainflow flow = {0};
    const double *x = q->memory + q->rows + (int64_t)k * q->each; /* of x, after the loads */
    s->slowest = s->windows ? fmin(s->slowest, a->speed) : a->speed;
    s->fastest = s->windows ? fmax(s->fastest, a->speed) : a->speed;
    s->load_max = s->windows ? fmax(s->load_max, a->load_max) : a->load_max;
    s->beta_max = fmax(s->beta_max, a->beta);
    s->load += a->load;
    s->windows++;
    if (fl_rainflow_count(&flow, o->rule, o->residue, q->each, x, err)) return -1;
    for (int32_t j = 0; j < flow.cycles; j++) {
        s->cycles += flow.cycle[j].count;
        s->range_max = fmax(s->range_max, flow.cycle[j].range);
        s->power += flow.cycle[j].count * pow(flow.cycle[j].range, m);
    }
    fl_rainflow_free(&flow);
    return 0;
}

static void write_share(FILE *f, const char *part, int regime, const struct options *o, int32_t mode,
                        const struct regime_sum *s, int32_t all, double m)
{
    const double none = s->windows ? 1.0 : NAN;
    fprintf(f, "%s\t%s", part, fl_regime_name(regime));
    write_mode(f, o, mode);
    fprintf(f, "\t%d", s->windows);
    write_cell(f, (double)s->windows / all);
    write_cell(f, none * s->slowest);
    write_cell(f, none * s->fastest);
    write_cell(f, none * s->beta_max);
    write_cell(f, none * s->load / s->windows);
    write_cell(f, none * s->load_max);
    write_cell(f, none * s->cycles);
    write_cell(f, none * s->range_max);
    write_cell(f, m);
    write_cell(f, s->cycles > 0.0 ? pow(s->power / s->cycles, 1.0 / m) : NAN);
    putc('\n', f);
}

int regime_share_rows(FILE *f, const struct record_views *r, const struct options *o, int32_t part,
                      int32_t signal, int w, fl_err *err)
{
    struct regime_windows q;
    const double m = o->sn_curves ? o->sn[0].m : 5.0;
    if (!has_motion(r, part, signal, w)) return 0;
    int rc = regimes_make(&q, r, o, part, err);
    for (int regime = 0; rc == 0 && regime < FL_REGIMES; regime++)
        for (int32_t mode = 0; rc == 0 && mode < (regime == FL_REGIME_LOCK_IN ? o->modes : 1); mode++) {
            const int32_t wanted = regime == FL_REGIME_LOCK_IN ? mode : -1;
            struct regime_sum s = {0};
            for (int32_t k = 0; k < q.n && rc == 0; k++)
                if (q.window[k].regime == regime && q.window[k].mode == wanted)
                    rc = add_window(&s, &q, k, o, m, err);
            if (rc == 0) write_share(f, r->series->part[part], regime, o, wanted, &s, q.n, m);
        }
    regimes_free(&q);
    return rc;
}
