/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdio.h>
#include <string.h>
#include "base/number_text.h"
#include "stat/record.h"
#include "stat/signal_view.h"
#include "stat/power_spectrum.h"
#include "cell.h"
#include "history_line.h"
#include "table_list.h"

static void add_number(fl_history_line *by, const char *option, double x)
{
    char buf[FL_NUMBER_LEN];
    fl_history_line_add(by, "--%s %s", option, fl_number_text(x, buf));
}

static void add_sn_curve(fl_history_line *by, const fl_sn_curve *sn)
{
    char m[FL_NUMBER_LEN], a[FL_NUMBER_LEN], m2[FL_NUMBER_LEN] = "inf", knee[FL_NUMBER_LEN];
    fl_number_text(sn->m, m);
    if (isnan(sn->a)) {
        fl_history_line_add(by, "--sn %s", m);
        return;
    }
    fl_number_text(sn->a, a);
    if (isfinite(sn->m2)) fl_number_text(sn->m2, m2);
    if (sn->knee > 0.0) fl_history_line_add(by, "--sn %s,%s,%s,%s", m, a, m2, fl_number_text(sn->knee, knee));
    else fl_history_line_add(by, "--sn %s,%s", m, a);
}

/* The selection of signals and rows. */
static void add_selection(const struct options *o, fl_history_line *by)
{
    for (int32_t k = 0; k < o->signals; k++) fl_history_line_add(by, "--column %s", o->signal[k]);
    if (o->part) fl_history_line_add(by, "--part %s", o->part);
    for (int32_t k = 0; k < o->wheres; k++) fl_history_line_add(by, "--where %s", o->where[k]);
    if (o->over) fl_history_line_add(by, "--over %s", fl_reduction_name(o->over));
    if (isfinite(o->from)) add_number(by, "from", o->from);
    if (isfinite(o->to)) add_number(by, "to", o->to);
    if (o->abouts) {
        char x[3][FL_NUMBER_LEN];
        for (int k = 0; k < 3; k++) fl_number_text(o->about[k], x[k]);
        fl_history_line_add(by, "--about %s,%s,%s", x[0], x[1], x[2]);
    }
    if (o->keep_start) fl_history_line_add(by, "--skip none");
    if (o->skips) {
        char n[FL_NUMBER_LEN], d[FL_NUMBER_LEN], gap[FL_NUMBER_LEN];
        fl_number_text(o->skip[0], n);
        fl_number_text(o->skip[1], d);
        if (isnan(o->skip[2])) fl_history_line_add(by, "--skip %s,%s", n, d);
        else fl_history_line_add(by, "--skip %s,%s,%s", n, d, fl_number_text(o->skip[2], gap));
        add_number(by, "speed", o->speed);
    }
}

static void add_files(const struct options *o, fl_history_line *by)
{
    for (int k = 0; k < o->files; k++)
        if (strcmp(o->file[k], "-") != 0) fl_history_line_word(by, "", o->file[k]);
}

/* Of tables of contacts and panels. */
static void add_contact_options(const struct options *o, fl_history_line *by)
{
    if (o->report_page) fl_history_line_add(by, "--table %s", o->table->name);
    if ((o->table->uses & USES_AREAS) && o->areas_text) fl_history_line_add(by, "--areas %s", o->areas_text);
    if ((o->table->uses & USES_WATERLINE) && o->waterline)
        fl_history_line_add(by, "--waterline %s --bins %d", o->waterline, o->bins);
    if ((o->table->uses & USES_HEIGHTS) && o->heights_text)
        fl_history_line_add(by, "--heights %s", o->heights_text);
    add_files(o, by);
}

static void add_filter(const struct options *o, fl_history_line *by)
{
    if (!(o->filter > 0.0)) return;
    char x[FL_NUMBER_LEN], y[FL_NUMBER_LEN];
    fl_number_text(o->filter, x);
    if (o->filter_kind == FL_FILTER_LOW) fl_history_line_add(by, "--filter %s", x);
    else if (o->filter_kind == FL_FILTER_BAND)
        fl_history_line_add(by, "--filter band:%s,%s", x, fl_number_text(o->upper, y));
    else fl_history_line_add(by, "--filter %s:%s", fl_filter_name(o->filter_kind), x);
    if (o->filter_kind != FL_FILTER_MEAN) fl_history_line_add(by, "--order %d", o->order);
}

/* Extreme-value analysis. */
static void add_sample(const struct options *o, unsigned uses, fl_history_line *by)
{
    if (o->sample) fl_history_line_add(by, "--sample %s", sample_name((enum sample)o->sample));
    if (o->sample == SAMPLE_POT && o->gap > 0.0) add_number(by, "gap", o->gap);
    if (o->block > 0.0) add_number(by, "block", o->block);
    for (int32_t k = 0; (uses & USES_RETURNS) && k < o->returns; k++) add_number(by, "return", o->period[k]);
    fl_history_line_add(by, "--resamples %d --seed %d", o->resamples, o->seed);
}

void history_line_run(const struct options *o, fl_history_line *by)
{
    const unsigned own = o->table->uses, uses = own | (o->report_page ? table_report_uses() : 0u);
    fl_history_line_start(by, "loadstats");
    add_selection(o, by);
    if (o->window > 0.0) add_number(by, "window", o->window);
    if (o->step > 0.0) add_number(by, "step", o->step);
    add_filter(o, by);
    if (o->table->source == FROM_CONTACTS) {
        add_contact_options(o, by);
        return;
    }
    add_number(by, "separation", o->separation);
    if (o->peaks) fl_history_line_add(by, "--peaks %s", fl_peak_side_name(o->peaks));
    if (o->threshold != 0.0) add_number(by, "threshold", o->threshold);
    if ((uses & USES_BINS) && !settings_many_runs(o)) fl_history_line_add(by, "--bins %d", o->bins);
    if ((uses & USES_QUANTILES) && o->quantiles_text)
        fl_history_line_add(by, "--quantiles %s", o->quantiles_text);
    if (uses & USES_SAMPLE) add_sample(o, uses, by);
    if ((uses & USES_LEVEL) && o->level != 0.5) add_number(by, "level", o->level);
    if (o->report_page && o->table != table_default()) fl_history_line_add(by, "--table %s", o->table->name);
    if ((uses & USES_RULE) && o->rule && !o->merge) {
        fl_history_line_add(by, "--rule %s", fl_rainflow_rule_name(o->rule));
        fl_history_line_add(by, "--residue %s", fl_residue_name(o->residue));
    }
    for (int32_t k = 0; (uses & USES_OSCILLATOR) && k < o->oscillators; k++)
        fl_history_line_add(by, "--oscillator %s", o->oscillator[k].text);
    if ((uses & USES_SEGMENT) && o->segment > 0.0) add_number(by, "segment", o->segment);
    if ((uses & USES_SEGMENT) && o->taper) fl_history_line_add(by, "--taper %s", fl_taper_name(o->taper));
    if ((uses & USES_MODES) && o->modes_text) fl_history_line_add(by, "--mode %s", o->modes_text);
    if ((uses & USES_SPEED) && o->speed > 0.0 && !o->skips) add_number(by, "speed", o->speed);
    for (int32_t k = 0; (uses & USES_SN) && k < o->sn_curves; k++) add_sn_curve(by, &o->sn[k]);
    if ((uses & USES_SN) && o->stress != 1.0) add_number(by, "stress", o->stress);
    if (o->digits != LEAST_DIGITS) fl_history_line_add(by, "--digits %d", o->digits);
    if (o->merge) fl_history_line_add(by, "--merge");
    if (o->stream) fl_history_line_add(by, "--stream");
    if (o->follow > 0.0) add_number(by, "follow", o->follow);
    if ((own & USES_BLOCK) && o->block > 0.0) add_number(by, "block", o->block);
    add_files(o, by);
}

void history_line_summary(const struct options *o, char *text)
{
    fl_history_line by;
    fl_history_line_start(&by, "loadstats");
    fl_history_line_add(&by, "--summary");
    add_selection(o, &by);
    add_number(&by, "separation", o->separation);
    if (o->threshold > 0.0) add_number(&by, "threshold", o->threshold);
    if (o->peaks) fl_history_line_add(&by, "--peaks %s", fl_peak_side_name(o->peaks));
    if (o->block > 0.0) add_number(&by, "block", o->block);
    if (o->rule) fl_history_line_add(&by, "--rule %s", fl_rainflow_rule_name(o->rule));
    if (o->rule) fl_history_line_add(&by, "--residue %s", fl_residue_name(o->residue));
    snprintf(text, FL_HISTORY_LINE_MAX + 2, "%s\n", by.text);
}
