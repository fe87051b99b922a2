/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include "base/array.h"
#include "stat/extreme.h"
#include "stat/return_level.h"
#include "stat/sample.h"
#include "table_fits.h"

enum { FEW = 20 }; /* values: a law fitted to fewer says little */

/* Levels beyond this many record lengths rest on the law, not on the record. */
static const double REACH = 4.0;

typedef struct {
    int found;
    fl_dist d;
    fl_goodness_of_fit g;
    fl_return_level r[RETURNS_MAX];
} law;

/* From rows to their values, the largest first. */
static int take(extreme_sample *s, const fl_signal_view *v, const fl_peaks *p, fl_err *err)
{
    double *x = fl_alloc(p->n, sizeof *x, err);
    int32_t *rank = x ? fl_alloc(p->n, sizeof *rank, err) : NULL;
    s->x = rank ? fl_alloc(p->n, sizeof *s->x, err) : NULL;
    int rc = s->x ? 0 : -1;
    s->n = p->n;
    for (int32_t k = 0; rc == 0 && k < p->n; k++) x[k] = v->x[p->row[k]];
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
        rc = take(s, v, &v->peaks, err);
    } else if (o->sample == SAMPLE_POT) {
        rc = fl_sample_peaks_over_threshold(v->n, v->x, v->edge, o->threshold, o->gap, &p, err);
        if (rc == 0) rc = take(s, v, &p, err);
    } else {
        rc = fl_sample_block_maxima(v->n, v->x, v->edge, o->block, &p, &blocks, err);
        if (rc == 0) rc = take(s, v, &p, err);
    }
    /* a block without a row has no largest value: those that have one come less often */
    s->rate =
        o->sample >= SAMPLE_BLOCKS ? (blocks > 0 ? s->n / (blocks * o->block) : 1.0 / o->block) : s->n / span;
    fl_peaks_free(&p);
    return rc;
}

/* The law of one kind by likelihood, with its levels.  Its random numbers are its own: the entity is the
 * kind. */
static int make_law(law *l, int kind, const extreme_sample *s, const struct options *o, fl_err *err)
{
    fl_fit_work w = {0};
    int rc = -1;
    if (fl_fit_work_make(&w, s->n, err)) return -1;
    l->found = (kind != FL_GPD || s->excesses) &&
               fl_fit(&l->d, kind, FL_FIT_LIKELIHOOD, s->n, s->x, s->threshold, &w);
    if (l->found) {
        const int levels = o->table == TABLE_LEVELS;
        for (int32_t k = 0; k < o->returns; k++)
            l->r[k] = (fl_return_level){.tail = 1.0 / (s->rate * o->period[k])};
        /* Of a level that is exceeded more often than values come nothing can be said. */
        int32_t m = 0;
        for (int32_t k = 0; levels && k < o->returns; k++)
            if (l->r[k].tail < 1.0) l->r[m++] = l->r[k];
        rc = fl_compute_return_levels(&l->d, s->n, s->x, m, l->r, &l->g, o->resamples, (uint64_t)o->seed,
                                      kind, &w, err);
    } else {
        rc = 0;
    }
    fl_fit_work_free(&w);
    return rc;
}

static int make_laws(law *l, const extreme_sample *s, const struct options *o, fl_err *err)
{
    int failed = FL_DISTS;
#pragma omp parallel for schedule(dynamic)
    for (int kind = 0; kind < FL_DISTS; kind++) {
        fl_err own = {0};
        if (make_law(&l[kind], kind, s, o, &own) == 0) continue;
#pragma omp critical(loadstats_laws)
        if (kind < failed) {
            failed = kind;
            *err = own;
        }
    }
    return failed < FL_DISTS ? -1 : 0;
}

static int fits(FILE *f, const struct result *r, const struct options *o, int32_t p, int32_t s, int w,
                const extreme_sample *c, const law *l, fl_err *err)
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
            fprintf(f, "\t%s\t%d\t%s\t%s", options_sample(o->sample), c->n, fl_dist_name(kind),
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
            putc('\n', f);
        }
    }
    fl_fit_work_free(&work);
    return 0;
}

static void levels(FILE *f, const struct result *r, const struct options *o, int32_t p, int32_t s, int w,
                   const extreme_sample *c, const law *l, double span)
{
    for (int kind = 0; kind < FL_DISTS; kind++) {
        int32_t j = 0;
        if (!l[kind].found) continue;
        for (int32_t k = 0; k < o->returns; k++) {
            const int known = c->rate * o->period[k] > 1.0;
            const fl_return_level none = {NAN, NAN, {NAN, NAN}, {NAN, NAN}},
                                  *v = known ? &l[kind].r[j++] : &none;
            write_labels(f, r, p, s, w);
            fprintf(f, "\t%s\t%d\t%s", options_sample(o->sample), c->n, fl_dist_name(kind));
            write_cell(f, o->period[k]);
            write_cell(f, v->level);
            write_cell(f, v->profile[0]);
            write_cell(f, v->profile[1]);
            write_cell(f, v->bootstrap[0]);
            write_cell(f, v->bootstrap[1]);
            write_cell(f, o->period[k] / span);
            putc('\n', f);
        }
    }
}

void fits_header(FILE *f, const struct options *o)
{
    if (o->table == TABLE_FITS)
        fputs("\tsample\tn\tlaw\tmethod\tlocation\tscale\tshape\tlogL\tAIC\tks\tks_p\tad\tad_p\n", f);
    else
        fputs("\tsample\tn\tlaw\tT[s]\tlevel\tprofile_low\tprofile_high\tbootstrap_low\tbootstrap_"
              "high\trecords\n",
              f);
}

static void warn(const struct result *r, const struct options *o, int32_t p, int32_t s, int w,
                 const extreme_sample *c, double span)
{
    const char *part = r->s->part[p], *signal = r->s->signal[s];
    if (o->quiet) return;
    if (c->n < FEW)
        fprintf(stderr, "loadstats: %s %s %s: laws are fitted to %d value(s), %d or more are expected\n",
                part, signal, view_name(w), c->n, FEW);
    for (int32_t k = 0; o->table == TABLE_LEVELS && k < o->returns; k++)
        if (o->period[k] > REACH * span && s == 0 && p == 0 && w == 0)
            fprintf(
                stderr,
                "loadstats: a return period of %.6g s is %.3g times the record of %.6g s, beyond %g times "
                "it rests on the law alone\n",
                o->period[k], o->period[k] / span, span, REACH);
}

int fits_write(FILE *f, const struct result *r, const struct options *o, int32_t part, int32_t signal, int w,
               fl_err *err)
{
    const fl_signal_view *v = view_of(r, part, signal, w);
    const double span = v->edge[v->n] - v->edge[0];
    extreme_sample s = {0};
    law *l = fl_alloc(FL_DISTS, sizeof *l, err);
    int rc = l ? extreme_sample_make(&s, v, o, err) : -1;
    if (rc == 0) warn(r, o, part, signal, w, &s, span);
    if (rc == 0) rc = make_laws(l, &s, o, err);
    if (rc == 0 && o->table == TABLE_FITS) rc = fits(f, r, o, part, signal, w, &s, l, err);
    if (rc == 0 && o->table == TABLE_LEVELS) levels(f, r, o, part, signal, w, &s, l, span);
    free(s.x);
    free(l);
    return rc;
}
