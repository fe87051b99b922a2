/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <string.h>
#include "options_check.h"
#include "stat/signal_view.h"
#include "table_list.h"

/* Tables of contacts or panels have no signals. */
static int check_contacts(const struct options *o, fl_err *err)
{
    const char *not = o->signals        ? "column"
                      : o->filter > 0.0 ? "filter"
                      : o->window > 0.0 ? "window"
                      : o->over         ? "over"
                      : o->merge        ? "merge"
                      : o->stream       ? "stream"
                      : o->follow > 0.0 ? "follow"
                                        : NULL;
    const int map = (o->table->uses & USES_HEIGHTS) != 0;
    if (o->table->source != FROM_CONTACTS) return 0;
    if (not ) return fl_fail(err, FL_USAGE, "--%s is for loads, not for --table %s", not, o->table->name);
    if ((o->table->needs & NEEDS_WATERLINE) && !o->waterline)
        return fl_fail(err, FL_USAGE, "--table %s needs --waterline, as circle:0,0,2", o->table->name);
    if (map && o->waterline && o->heights < 2)
        return fl_fail(err, FL_USAGE,
                       "--table map of contacts needs --heights, two or more, as -1,-0.5,0,0.5");
    if (map && !o->waterline && (o->heights || o->part || o->wheres))
        return fl_fail(err, FL_USAGE, "--%s is for --table map of contacts, which needs --waterline",
                       o->part      ? "part"
                       : o->heights ? "heights"
                                    : "where");
    return 0;
}

/* An exported load is rows of a record: no table, no pictures. */
static int check_export(const struct options *o, fl_err *err)
{
    const char *not = o->signals        ? "column"
                      : o->filter > 0.0 ? "filter"
                      : o->table_given  ? "table"
                      : o->plot         ? "plot"
                      : o->report       ? "report"
                      : o->merge        ? "merge"
                      : o->stream       ? "stream"
                      : o->follow > 0.0 ? "follow"
                                        : NULL;
    if (!o->exports || (!not &&o->files <= 1)) return 0;
    if (not ) return fl_fail(err, FL_USAGE, "--export excludes --%s", not );
    return fl_fail(err, FL_USAGE, "--export reads one record");
}

/* Options of summaries: constant memory, many files. */
static int check_summary(struct options *o, fl_err *err)
{
    const int many = o->table->source == FROM_RUNS || o->merge;
    const char *how = o->follow > 0.0 ? "follow" : o->merge ? "merge" : "stream";
    if (o->merge && !o->table_given) o->table = table_named("summary");
    const int table = o->table->source == FROM_RUNS || o->table->run_rows;
    if (o->files > 1 && !many && !o->stream)
        return fl_fail(err, FL_USAGE, "expected one file, \"%.60s\" is another one", o->file[1]);
    if (!many && !o->stream && !(o->follow > 0.0)) return 0;
    if (o->follow > 0.0 && !o->table->follows)
        return fl_fail(err, FL_USAGE, "--follow prints the table stats, not %s", o->table->name);
    if (!table)
        return fl_fail(err, FL_USAGE, "--table %s needs the whole record, not --%s", o->table->name, how);
    if (o->follow > 0.0 && (o->files > 1 || o->merge))
        return fl_fail(err, FL_USAGE, "--follow reads one record");
    const int pictures = (o->plot || o->report) && !o->table->draw_runs;
    if (o->peaks && o->merge)
        return fl_fail(err, FL_USAGE, "--peaks %s is a setting of the summaries, not of --merge",
                       fl_peak_side_name(o->peaks));
    if (o->peaks == FL_PEAK_ABS && o->sample == SAMPLE_RUNS)
        return fl_fail(err, FL_USAGE,
                       "--peaks abs has no --sample runs: a summary keeps the smallest and the "
                       "largest value of each run by itself");
    const int first = o->skips && isnan(o->skip[2]); /* the first load is not known in advance */
    const char *whole = first             ? "skip without GAP"
                        : o->step > 0.0   ? "step"
                        : o->filter > 0.0 ? "filter"
                        : o->window > 0.0 ? "window"
                        : o->plot         ? "plot"
                                          : "report";
    if (first || o->step > 0.0 || o->filter > 0.0 || o->window > 0.0 || pictures)
        return fl_fail(err, FL_USAGE, "--%s needs the whole record, not %s%s", whole,
                       many ? "--table " : "--", many ? o->table->name : how);
    return 0;
}

int options_check(struct options *o, fl_err *err)
{
    if (check_export(o, err) || check_contacts(o, err) || check_summary(o, err)) return -1;
    if (o->skips && !(o->speed > 0.0)) return fl_fail(err, FL_USAGE, "--skip needs --speed, that of the ice");
    if (!(o->from < o->to))
        return fl_fail(err, FL_USAGE, "--from %g s is not before --to %g s", o->from, o->to);
    if (o->sample == SAMPLE_RUNS && !settings_many_runs(o))
        return fl_fail(err, FL_USAGE, "--sample runs needs several runs, --merge or --stream");
    if (o->sample == SAMPLE_BLOCKS && !o->merge && !(o->block > 0.0))
        return fl_fail(err, FL_USAGE, "--sample blocks needs --block");
    if (o->threshold < 0.0 && o->peaks == FL_PEAK_MIN && o->sample != SAMPLE_POT)
        o->threshold = -o->threshold; /* of the signal, whose negative has the peaks */
    if (o->threshold < 0.0 && o->sample != SAMPLE_POT)
        return fl_fail(err, FL_USAGE,
                       "--threshold %g is below 0, which separate peaks are not: --peaks min has those of a "
                       "negative load, and --sample pot takes any threshold",
                       o->threshold);
    if (o->residue && !o->rule) return fl_fail(err, FL_USAGE, "--residue needs --rule iso");
    if (o->page && !o->report) return fl_fail(err, FL_USAGE, "--page needs --report");
    if (o->report && strcmp(o->report, "-") == 0 && strcmp(o->out, "-") == 0)
        return fl_fail(err, FL_USAGE, "--report - needs --output for the table");
    if ((o->table->needs & NEEDS_OSCILLATOR) && !o->oscillators)
        return fl_fail(err, FL_USAGE, "--table %s needs --oscillator, F,Z", o->table->name);
    if ((o->table->needs & NEEDS_RETURNS) && !o->returns)
        return fl_fail(err, FL_USAGE, "--table %s needs --return, the return periods", o->table->name);
    return 0;
}
