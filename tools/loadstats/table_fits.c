/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include "base/array.h"
#include "stat/extreme.h"
#include "stat/return_level.h"
#include "stat/sample.h"
#include "table_fits.h"

enum { FEW = 20 }; /* values: a distribution fitted to fewer is unreliable */

/* Beyond this many record lengths a level is an extrapolation of the distribution. */
static const double REACH = 4.0;

/* A distribution that lies as far from its sample as one in twenty of its own samples do has failed. */
static const double REJECTED = 0.05;

/* A level whose interval reaches beyond this many times the level is not determined by the sample. */
static const double UNDETERMINED = 10.0;

typedef struct {
    int found;
    fl_dist d;
    double aic;
    fl_goodness_of_fit g;
    fl_return_level r[RETURNS_MAX];
} law;

/* The values of the selected rows in descending order. */
static int sorted_values(extreme_sample *s, const fl_signal_view *v, const fl_peaks *p, fl_err *err)
{
    double *x = fl_alloc(p->n, sizeof *x, err);
    int32_t *rank = x ? fl_alloc(p->n, sizeof *rank, err) : NULL;
    s->x = rank ? fl_alloc(p->n, sizeof *s->x, err) : NULL;
    int rc = s->x ? 0 : -1;
    s->n = p->n;
    for (int32_t k = 0; rc == 0 && k < p->n; k++) x[k] = v->y[p->row[k]];
    if (rc == 0) rc = fl_rank_descending(p->n, x, rank, err);
    for (int32_t k = 0; rc == 0 && k < p->n; k++) s->x[k] = x[rank[k]];
    free(x);
    free(rank);
    return rc;
}

int extreme_sample_make(extreme_sample *s, const fl_signal_view *v, const struct options *o, fl_err *err)
{
    const double span = v->edge[v->n] - v->edge[0];
    fl_peaks p = {0};
    int32_t blocks = 0;
    int rc;
    *s = (extreme_sample){.threshold = o->threshold, .excesses = o->sample < SAMPLE_BLOCKS};
    if (o->sample == SAMPLE_PEAKS) {
        rc = sorted_values(s, v, &v->peaks, err);
    } else if (o->sample == SAMPLE_POT) {
        rc = fl_sample_peaks_over_threshold(v->n, v->y, v->edge, o->threshold, o->gap, &p, err);
        if (rc == 0) rc = sorted_values(s, v, &p, err);
    } else {
        rc = fl_sample_block_maxima(v->n, v->y, v->edge, o->block, &p, &blocks, err);
        if (rc == 0) rc = sorted_values(s, v, &p, err);
    }
    /* A block without rows has no maximum, which lowers the rate of the others. */
    s->rate =
        o->sample >= SAMPLE_BLOCKS ? (blocks > 0 ? s->n / (blocks * o->block) : 1.0 / o->block) : s->n / span;
    fl_peaks_free(&p);
    return rc;
}

/* Fit one kind of distribution by likelihood and compute its levels.  Its kind is the entity of its random
 * numbers. */
static int make_law(law *l, int kind, const extreme_sample *s, const struct options *o, int32_t levels,
                    fl_err *err)
{
    fl_fit_work w = {0};
    int rc = -1;
    if (fl_fit_work_make(&w, s->n, err)) return -1;
    l->found = (kind != FL_GPD || s->excesses) &&
               fl_fit(&l->d, kind, FL_FIT_LIKELIHOOD, s->n, s->x, s->threshold, &w);
    if (l->found) {
        for (int32_t k = 0; k < levels; k++)
            l->r[k] = (fl_return_level){.tail = 1.0 / (s->rate * o->period[k])};
        /* A level exceeded more often than values occur is undefined. */
        int32_t m = 0;
        for (int32_t k = 0; k < levels; k++)
            if (l->r[k].tail < 1.0) l->r[m++] = l->r[k];
        rc = fl_compute_return_levels(&l->d, s->n, s->x, m, l->r, &l->g, o->resamples, (uint64_t)o->seed,
                                      kind, &w, err);
    } else {
        rc = 0;
    }
    if (l->found) l->aic = fl_fit_aic(&l->d, fl_fit_log_likelihood(&l->d, s->n, s->x));
    fl_fit_work_free(&w);
    return rc;
}

/* 1 if the sample does not contradict the distribution, as far as resamples tell. */
static int is_fit(const law *l)
{
    return l->found && isfinite(l->aic) && !(l->g.p_kolmogorov < REJECTED) && !(l->g.p_anderson < REJECTED);
}

/* Rank of a distribution among those that fit, by AIC, from 1; 0 for one that fails. */
static int rank_of(const law *l, int kind)
{
    int rank = is_fit(&l[kind]);
    for (int k = 0; k < FL_DISTS && rank; k++)
        rank += is_fit(&l[k]) && (l[k].aic < l[kind].aic || (l[k].aic == l[kind].aic && k < kind));
    return rank;
}

/* The distribution of a rank; -1 where there is none. */
static int kind_of_rank(const law *l, int rank)
{
    for (int kind = 0; kind < FL_DISTS; kind++)
        if (rank_of(l, kind) == rank) return kind;
    return -1;
}

static int is_determined(const fl_return_level *v)
{
    return isfinite(v->level) && isfinite(v->profile[1]) &&
           v->profile[1] <= UNDETERMINED * fmax(fabs(v->level), fabs(v->profile[0]));
}

static int make_laws(law *l, const extreme_sample *s, const struct options *o, int32_t levels, fl_err *err)
{
    int failed = FL_DISTS;
#pragma omp parallel for schedule(dynamic)
    for (int kind = 0; kind < FL_DISTS; kind++) {
        fl_err own = {0};
        if (make_law(&l[kind], kind, s, o, levels, &own) == 0) continue;
#pragma omp critical(loadstats_laws)
        if (kind < failed) {
            failed = kind;
            *err = own;
        }
    }
    return failed < FL_DISTS ? -1 : 0;
}

static int write_fits(FILE *f, const struct record_views *r, const struct options *o, int32_t p, int32_t s,
                      int w, const extreme_sample *c, const law *l, fl_err *err)
{
    fl_fit_work work = {0};
    if (fl_fit_work_make(&work, c->n, err)) return -1;
    for (int kind = 0; kind < FL_DISTS; kind++) {
        if (kind == FL_GPD && !c->excesses) continue;
        for (int method = 0; method < FL_FIT_METHODS; method++) {
            fl_dist d;
            const int ok = fl_fit(&d, kind, method, c->n, c->x, c->threshold, &work);
            const double likelihood = ok ? fl_fit_log_likelihood(&d, c->n, c->x) : NAN;
            const int best = ok && method == FL_FIT_LIKELIHOOD;
            write_labels(f, r, p, s, w);
            fprintf(f, "\t%s\t%d\t%s\t%s", sample_name((enum sample)o->sample), c->n, fl_dist_name(kind),
                    fl_fit_method_name(method));
            write_cell(f, ok && kind != FL_WEIBULL && kind != FL_LOGNORMAL ? d.location : NAN);
            write_cell(f, ok ? d.scale : NAN);
            write_cell(f, ok && kind != FL_GUMBEL ? d.shape : NAN);
            write_cell(f, likelihood);
            write_cell(f, best ? fl_fit_aic(&d, likelihood) : NAN);
            write_cell(f, ok ? fl_fit_kolmogorov(&d, c->n, c->x) : NAN);
            write_cell(f, best ? l[kind].g.p_kolmogorov : NAN);
            write_cell(f, ok ? fl_fit_anderson(&d, c->n, c->x) : NAN);
            write_cell(f, best ? l[kind].g.p_anderson : NAN);
            const int rank = best ? rank_of(l, kind) : 0;
            if (rank) fprintf(f, "\t%d\n", rank);
            else fputs("\t-\n", f);
        }
    }
    fl_fit_work_free(&work);
    return 0;
}

/* The distributions that fit, the best first. */
static void write_levels(FILE *f, const struct record_views *r, const struct options *o, int32_t p, int32_t s,
                         int w, const extreme_sample *c, const law *l, double span)
{
    for (int rank = 1, kind; (kind = kind_of_rank(l, rank)) >= 0; rank++) {
        int32_t j = 0;
        for (int32_t k = 0; k < o->returns; k++) {
            const int known = c->rate * o->period[k] > 1.0;
            const fl_return_level none = {NAN, NAN, {NAN, NAN}, {NAN, NAN}},
                                  *v = known ? &l[kind].r[j++] : &none;
            write_labels(f, r, p, s, w);
            fprintf(f, "\t%s\t%d\t%s", sample_name((enum sample)o->sample), c->n, fl_dist_name(kind));
            write_cell(f, o->period[k]);
            write_cell(f, v->level);
            write_cell(f, v->profile[0]);
            write_cell(f, v->profile[1]);
            write_cell(f, v->bootstrap[0]);
            write_cell(f, v->bootstrap[1]);
            write_cell(f, o->period[k] / span);
            fprintf(f, "\t%d\n", rank);
        }
    }
}

/* The distributions without rows in the table levels, and levels that mean nothing. */
static void warn_failed(const struct record_views *r, const struct options *o, int32_t part, int32_t signal,
                        int w, const extreme_sample *c, const law *l)
{
    const char *before = "";
    int failed = 0, loose = 0;
    for (int kind = 0; kind < FL_DISTS; kind++) {
        failed += l[kind].found && !rank_of(l, kind);
        for (int32_t k = 0, j = 0; k < o->returns; k++)
            loose += c->rate * o->period[k] > 1.0 && rank_of(l, kind) && !is_determined(&l[kind].r[j++]);
    }
    if (o->quiet || !(failed || loose)) return;
    fprintf(stderr, "loadstats: %s %s %s: ", r->series->part[part], r->series->signal[signal], view_name(w));
    if (failed) fputs("the sample contradicts ", stderr);
    for (int kind = 0; kind < FL_DISTS && failed; kind++) {
        if (!l[kind].found || rank_of(l, kind)) continue;
        fprintf(stderr, "%s%s", before, fl_dist_name(kind));
        before = ", ";
    }
    if (failed && loose) fputs("; ", stderr);
    if (loose)
        fprintf(stderr, "%d level%s of no use: the interval has no end, or one beyond %g times the level",
                loose, loose == 1 ? " is" : "s are", UNDETERMINED);
    putc('\n', stderr);
}

static void warn_few(const struct record_views *r, const struct options *o, int32_t part, int32_t signal,
                     int w, const extreme_sample *c)
{
    if (!o->quiet && c->n < FEW)
        fprintf(stderr, "loadstats: %s %s %s: fitted to %d value(s), expected %d or more\n",
                r->series->part[part], r->series->signal[signal], view_name(w), c->n, FEW);
}

static void warn_extrapolation(const struct options *o, double span)
{
    for (int32_t k = 0; !o->quiet && k < o->returns; k++)
        if (o->period[k] > REACH * span)
            fprintf(stderr,
                    "loadstats: a return period of %.6g s is %.3g times the record of %.6g s, beyond %g "
                    "times it is an extrapolation\n",
                    o->period[k], o->period[k] / span, span, REACH);
}

int fits_rows(FILE *f, const struct record_views *r, const struct options *o, int32_t part, int32_t signal,
              int w, fl_err *err)
{
    extreme_sample s = {0};
    law *l = fl_alloc(FL_DISTS, sizeof *l, err);
    int rc = l ? extreme_sample_make(&s, find_view(r, part, signal, w), o, err) : -1;
    if (rc == 0) warn_few(r, o, part, signal, w, &s);
    if (rc == 0) rc = make_laws(l, &s, o, 0, err);
    if (rc == 0) rc = write_fits(f, r, o, part, signal, w, &s, l, err);
    free(s.x);
    free(l);
    return rc;
}

int levels_rows(FILE *f, const struct record_views *r, const struct options *o, int32_t part, int32_t signal,
                int w, fl_err *err)
{
    const fl_signal_view *v = find_view(r, part, signal, w);
    const double span = v->edge[v->n] - v->edge[0];
    extreme_sample s = {0};
    law *l = fl_alloc(FL_DISTS, sizeof *l, err);
    int rc = l ? extreme_sample_make(&s, v, o, err) : -1;
    if (rc == 0) warn_few(r, o, part, signal, w, &s);
    if (rc == 0 && part == 0 && signal == 0 && w == 0) warn_extrapolation(o, span);
    if (rc == 0) rc = make_laws(l, &s, o, o->returns, err);
    if (rc == 0) warn_failed(r, o, part, signal, w, &s, l);
    if (rc == 0) write_levels(f, r, o, part, signal, w, &s, l, span);
    free(s.x);
    free(l);
    return rc;
}

int best_level_make(best_level *b, const fl_signal_view *v, const struct options *o, double period,
                    fl_err *err)
{
    struct options own = *o;
    extreme_sample s = {0};
    law *l = fl_alloc(FL_DISTS, sizeof *l, err);
    int rc = l ? extreme_sample_make(&s, v, o, err) : -1, kind = -1;
    own.period[0] = period;
    *b = (best_level){.n = s.n, .law = NULL, .level = NAN, .low = NAN, .high = NAN};
    if (rc == 0 && s.n >= BEST_LEVEL_LEAST && s.rate * period > 1.0) {
        rc = make_laws(l, &s, &own, 1, err);
        for (int rank = 1; rc == 0 && !b->law && (kind = kind_of_rank(l, rank)) >= 0; rank++) {
            const fl_return_level *q = &l[kind].r[0];
            if (is_determined(q))
                *b = (best_level){s.n, fl_dist_name(kind), q->level, q->profile[0], q->profile[1]};
        }
    }
    free(s.x);
    free(l);
    return rc;
}
