/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "stat/peaks.h"
#include "stat/rainflow.h"
#include "stat/run_summary.h"

/* Times in the table are decimal: an edge may differ from the cut, or the end of a block, by rounding.  This
 * fraction of the interval (of the block) is far above rounding and far below any intended difference. */
static const double SLACK = 1e-6;

/* State of the peak search, one value after the other; the rule is that of fl_peaks_rayleigh(). */
typedef struct {
    double before, now; /* the last two values that differ; now may be a run of equal ones */
    int runs;           /* of equal values so far, up to 3 */
    int held;           /* a maximum is held, which a larger one may replace */
    double top, low;    /* the held maximum, and the smallest value since */
} peak_state;

typedef struct {
    double start, whole; /* start of the first block [s]; whole blocks before the current one */
    double top;
    int open; /* the current block has a row */
} block_state;

struct fl_run_state {
    int32_t at;   /* in the summary */
    int32_t same; /* entry of the total where it equals this signal, else -1 */
    int32_t of;   /* in the record */
    peak_state peak;
    block_state block;
    fl_rainflow cycle;
};

/* --- peaks ---------------------------------------------------------------------------------------------- */

static int add_peak(fl_summary_signal *s, double x, fl_err *err)
{
    s->peaks++;
    return fl_exact_add(&s->peak_sum, x, err) ||
                   fl_log_histogram_add(&s->peak, fl_log_bin_key(x), 1, (fl_fixed_time){0, 0}, err)
               ? -1
               : 0;
}

static int push_peak(peak_state *p, fl_summary_signal *s, const fl_summary_settings *settings, double x,
                     fl_err *err)
{
    if (p->runs && x == p->now) return 0;
    /* A run of equal values has ended: test whether it is a maximum.  The first value of the record is
     * neither a maximum nor a minimum between two of them. */
    if (p->runs >= 2) {
        if (p->now < p->low) p->low = p->now;
        if (p->before < p->now && x < p->now && p->now > settings->threshold) {
            const int separate = p->held && p->low < settings->separation * fmin(p->top, p->now);
            if (separate && add_peak(s, p->top, err)) return -1;
            if (!p->held || separate || p->now > p->top) {
                p->held = 1;
                p->top = p->now;
                p->low = INFINITY;
            }
        }
    }
    p->before = p->now;
    p->now = x;
    if (p->runs < 2) p->runs++;
    return 0;
}

/* --- blocks and cycles ---------------------------------------------------------------------------------- */

static int close_block(block_state *b, fl_summary_signal *s, fl_err *err)
{
    if (!b->open) return 0;
    b->open = 0;
    return fl_multiset_add(&s->block, b->top, 1, err);
}

/* A row belongs to the block that contains its middle. */
static int push_block(block_state *b, fl_summary_signal *s, double length, const double *edge, double x,
                      fl_err *err)
{
    const double at = floor((0.5 * (edge[0] + edge[1]) - b->start) / length);
    if (at > b->whole) {
        if (close_block(b, s, err)) return -1;
        b->whole = at;
    }
    if (!b->open || x > b->top) b->top = x;
    b->open = 1;
    return 0;
}

static int add_cycles(fl_rainflow *f, fl_summary_signal *s, fl_err *err)
{
    for (int32_t k = 0; k < f->cycles; k++)
        if (fl_log_histogram_add(&s->cycle, fl_log_bin_key(f->cycle[k].range),
                                 f->cycle[k].count < 0.75 ? 1 : 2, (fl_fixed_time){0, 0}, err))
            return -1;
    f->cycles = 0;
    return 0;
}

/* --- a run ---------------------------------------------------------------------------------------------- */

int fl_run_open(fl_run *r, const char *path, const fl_record_selection *selection,
                const fl_summary_settings *settings, fl_err *err)
{
    *r = (fl_run){.selection = *selection, .sum = {.settings = *settings}};
    return fl_record_open(&r->record, path, selection, err);
}

/* The index of a signal in the summary, or -1. */
static int32_t signal_index(fl_run *r, int32_t part, int32_t signal, fl_err *err)
{
    const fl_record *rec = &r->record;
    const fl_summary_signal *s = fl_summary_get_signal(&r->sum, rec->part[part], rec->signal[signal],
                                                       rec->unit[signal], fl_record_name(rec), err);
    return s ? (int32_t)(s - r->sum.entry) : -1;
}

/* The first time defines the signals.  Inserting one moves the others, so indices are taken after all are
 * in. */
static int start_states(fl_run *r, fl_err *err)
{
    const fl_record *rec = &r->record;
    for (int32_t k = 0; k < rec->parts * rec->signals; k++)
        if (rec->defined[k] && signal_index(r, k / rec->signals, k % rec->signals, err) < 0) return -1;
    r->state = fl_alloc(r->sum.n, sizeof *r->state, err);
    if (!r->state) return -1;
    /* With one part the sum equals it to the bit. */
    const int alone = rec->parts == 2 && strcmp(rec->part[1], "total") == 0;
    for (int32_t k = 0; k < rec->parts * rec->signals; k++) {
        const int32_t p = k / rec->signals, s = k % rec->signals;
        if (!rec->defined[k] || (alone && p == 1)) continue;
        const int32_t at = signal_index(r, p, s, err),
                      same = alone && rec->defined[k + rec->signals] ? signal_index(r, 1, s, err) : -1;
        if (at < 0) return -1;
        r->state[r->states++] = (struct fl_run_state){.at = at,
                                                      .same = same,
                                                      .of = k,
                                                      .peak = {.low = INFINITY},
                                                      .block = {.start = rec->edge[0]},
                                                      .cycle = {.rule = r->sum.settings.rule}};
    }
    return 0;
}

static int add_value(fl_run *r, struct fl_run_state *state, double w, fl_fixed_time time, fl_err *err)
{
    const fl_record *rec = &r->record;
    const fl_summary_settings *settings = &r->sum.settings;
    fl_summary_signal *s = &r->sum.entry[state->at];
    const double x = rec->x[state->of], y = fl_peak_turned(settings->side, x);
    if (s->rows == 0) {
        s->from = rec->edge[0];
        s->min = s->max = x;
        s->t_min = s->t_max = rec->t;
    }
    s->to = rec->edge[1];
    s->rows++;
    if (x < s->min) {
        s->min = x;
        s->t_min = rec->t;
    }
    if (x > s->max) {
        s->max = x;
        s->t_max = rec->t;
    }
    if (fl_exact_add_powers(s->sum, w, x, err) ||
        fl_log_histogram_add(&s->level, fl_log_bin_key(x), 1, time, err) ||
        push_peak(&state->peak, s, settings, y, err))
        return -1;
    if (settings->block > 0.0 && push_block(&state->block, s, settings->block, rec->edge, y, err)) return -1;
    if (fl_rainflow_push(&state->cycle, x, err)) return -1;
    return state->cycle.cycles ? add_cycles(&state->cycle, s, err) : 0;
}

int fl_run_next(fl_run *r, fl_err *err)
{
    const fl_record *rec = &r->record;
    for (;;) {
        const int more = fl_record_next(&r->record, err);
        if (more <= 0) return more;
        const double w = rec->edge[1] - rec->edge[0], slack = SLACK * w;
        if (rec->edge[0] < r->selection.from - slack) continue;
        if (rec->edge[1] > r->selection.to + slack) continue;
        if (!(w <= FL_LOG_HISTOGRAM_LONGEST))
            return fl_fail(err, FL_INPUT, "%s: a row lasts for %g s, at most %g s can be summed up",
                           fl_record_name(rec), w, FL_LOG_HISTOGRAM_LONGEST);
        if (!r->state && start_states(r, err)) return -1;
        const fl_fixed_time time = fl_fixed_time_of(w);
        for (int32_t k = 0; k < r->states; k++)
            if (add_value(r, &r->state[k], w, time, err)) return -1;
        r->end = rec->edge[1];
        return 1;
    }
}

static int end_signal(fl_run *r, struct fl_run_state *state, fl_err *err)
{
    fl_summary_signal *s = &r->sum.entry[state->at];
    const fl_summary_settings *settings = &r->sum.settings;
    double moment[4];
    if (state->peak.held && add_peak(s, state->peak.top, err)) return -1;
    if (settings->block > 0.0 && state->block.open) {
        /* An incomplete block at the end is dropped. */
        const double whole = floor((r->end - state->block.start) / settings->block + SLACK);
        if (state->block.whole < whole && close_block(&state->block, s, err)) return -1;
    }
    if (fl_rainflow_end(&state->cycle, settings->residue, err) || add_cycles(&state->cycle, s, err))
        return -1;
    fl_summary_moments(s, moment);
    if (fl_multiset_add(&s->run[FL_RUN_MEAN], moment[0], 1, err) ||
        fl_multiset_add(&s->run[FL_RUN_STD], moment[1], 1, err) ||
        fl_multiset_add(&s->run[FL_RUN_MIN], s->min, 1, err) ||
        fl_multiset_add(&s->run[FL_RUN_MAX], s->max, 1, err))
        return -1;
    return 0;
}

int fl_run_update(fl_run *r, fl_err *err)
{
    for (int32_t k = 0; k < r->states; k++) {
        const struct fl_run_state *s = &r->state[k];
        if (s->same >= 0 && fl_summary_copy_signal(&r->sum.entry[s->same], &r->sum.entry[s->at], err))
            return -1;
    }
    return 0;
}

int fl_run_finish(fl_run *r, const char *by, fl_err *err)
{
    const char *history = fl_record_history(&r->record);
    r->end_of_run = fl_record_end(&r->record, r->why);
    if (!r->state || r->states == 0)
        return fl_fail(err, FL_INPUT, "%s: the cut leaves no row, the record ends at %.10g s",
                       fl_record_name(&r->record), r->record.edge[1]);
    if (!(fl_exact_value(&r->sum.entry[r->state[0].at].sum[0]) > 0.0))
        return fl_fail(err, FL_INPUT, "%s: its rows have no duration, their times are too close together",
                       fl_record_name(&r->record));
    for (int32_t k = 0; k < r->states; k++)
        if (end_signal(r, &r->state[k], err)) return -1;
    if (fl_run_update(r, err)) return -1;
    /* A table without its end is told by a line of its own. */
    const char *open = r->end_of_run == FL_RUN_OPEN ? FL_RUN_OPEN_LINE : "";
    const size_t len = history ? strlen(history) : 0, more = strlen(open), own = strlen(by);
    char *chain = fl_alloc((int64_t)(len + more + own) + 1, 1, err);
    if (!chain) return -1;
    if (len) memcpy(chain, history, len);
    memcpy(chain + len, open, more);
    memcpy(chain + len + more, by, own);
    const int rc = fl_summary_add_history(&r->sum, chain, err);
    free(chain);
    return rc;
}

void fl_run_close(fl_run *r)
{
    for (int32_t k = 0; k < r->states; k++) fl_rainflow_free(&r->state[k].cycle);
    free(r->state);
    fl_summary_free(&r->sum);
    fl_record_close(&r->record);
    *r = (fl_run){0};
}
