/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "base/number_text.h"
#include "base/option.h"
#include "base/text.h"
#include "stat/butterworth.h"
#include "stat/signal_view.h"
#include "base/tool.h"
#include "cell.h"
#include "options.h"
#include "export_loads.h"
#include "options_check.h"
#include "table_list.h"
#include "table_regimes.h"

static const char USAGE[] =
    "usage: loadstats [options] [FILE ...]\n"
    "Statistics of a load record: moments, quantiles, peaks, histogram, exceedance, plots.\n"
    "FILE is a loads table, or any table with a column t; - or nothing is standard input.\n"
    "\n";

static const char *const SAMPLES[] = {"peaks", "pot", "blocks", "runs", NULL};
static const char *const COMPONENT[] = {"fx", "fy", "fz", "mx", "my", "mz", "fh", "f", "mh", NULL};
static const char *const REDUCTIONS[] = {"sum", "mean",  "min",
                                         "max", "count", NULL};         /* as fl_reduction_name() */
static const char *const CYCLE_RULE[] = {"astm", "iso", NULL};          /* as fl_rainflow_rule_name() */
static const char *const RESIDUES[] = {"half", "repeat", "none", NULL}; /* as fl_residue_name() */
static const char *const TAPERS[] = {"hann", "hamming", "blackman", "none", NULL}; /* as fl_taper_name() */
static const char *const FILTERS[] = {"low", "high", "band", "mean", NULL};        /* as fl_filter_name() */
static const char *const PEAKS[] = {"max", "min", "abs", NULL}; /* as fl_peak_side_name() */
static const char *const FORMATS[] = {"svg", "png", "pdf", NULL};
#define COUNT(list) ((int)(sizeof(list) / sizeof *(list)))
#define TINY 1e-300
#define HUGE_NUMBER 1e300

static int set_export(void *options, const char *text, fl_err *err)
{
    const char *name[TABLES_MAX + 1] = {NULL};
    int k;
    for (int j = 0; j < TABLES_MAX && export_form_name(j); j++) name[j] = export_form_name(j);
    if (fl_option_choice("export", text, name, &k, err)) return -1;
    ((struct options *)options)->exports = 1 + k;
    return 0;
}

static int choose_table(void *options, const char *text, fl_err *err)
{
    struct options *const o = options;
    const char *name[TABLES_MAX + 1] = {NULL};
    int k;
    for (int j = 0; j < table_count(); j++) name[j] = table_at(j)->name;
    if (fl_option_choice("table", text, name, &k, err)) return -1;
    o->table = table_at(k);
    o->table_given = 1;
    return 0;
}

/* words moves when it grows, so the list keeps offsets until options_parse() is done. */
static int parse_signal(void *options, const char *word, fl_err *err)
{
    struct options *const o = options;
    const int32_t bytes = (int32_t)strnlen(word, 1000) + 1;
    if (o->signals == SIGNALS_MAX)
        return fl_fail(err, FL_USAGE, "expected at most %d components and columns", SIGNALS_MAX);
    if (fl_grow(&o->words, &o->words_cap, (int64_t)o->words_len + bytes, 1, err)) return -1;
    memcpy(o->words + o->words_len, word, (size_t)bytes - 1);
    o->words_len += bytes;
    o->words[o->words_len - 1] = '\0';
    o->signals++;
    return 0;
}

static int parse_component(void *options, const char *word, fl_err *err)
{
    struct options *const o = options;
    int k;
    return fl_option_choice("component", word, COMPONENT, &k, err) ? -1 : parse_signal(o, word, err);
}

static int parse_quantile(void *options, const char *word, fl_err *err)
{
    struct options *const o = options;
    if (o->quantiles == QUANTILES_MAX)
        return fl_fail(err, FL_USAGE, "expected at most %d quantiles", QUANTILES_MAX);
    double *q = &o->quantile[o->quantiles];
    if (fl_option_number("quantiles", word, 0.0, 1.0, "a number from 0 to 1", q, err)) return -1;
    for (int32_t k = 0; k < o->quantiles; k++) /* a quantile names a column, and names are unique */
        if (o->quantile[k] == *q) return fl_fail(err, FL_USAGE, "--quantiles has %.40s twice", word);
    o->quantiles++;
    return 0;
}

static int parse_return(void *options, const char *word, fl_err *err)
{
    struct options *const o = options;
    if (o->returns == RETURNS_MAX)
        return fl_fail(err, FL_USAGE, "expected at most %d return periods", RETURNS_MAX);
    return fl_option_time("return", word, &o->period[o->returns++], err);
}

static int parse_about(void *options, const char *word, fl_err *err)
{
    struct options *const o = options;
    if (o->abouts == 3) return fl_fail(err, FL_USAGE, "--about has more than X,Y,Z");
    return fl_option_number("about", word, -1e9, 1e9, "a coordinate in m", &o->about[o->abouts++], err);
}

static int parse_skip(void *options, const char *word, fl_err *err)
{
    struct options *const o = options;
    static const char *const wanted[] = {"a number of diameters above 0", "a diameter above 0",
                                         "a distance from 0 on"};
    if (o->skips == 3) return fl_fail(err, FL_USAGE, "--skip has more than N,D,GAP");
    const double least = o->skips < 2 ? 1e-100 : 0.0;
    double *to = &o->skip[o->skips];
    return fl_option_number("skip", word, least, 1e100, wanted[o->skips++], to, err);
}

/* HZ, low:HZ, high:HZ, band:HZ,HZ or mean:S. */
static int parse_filter(void *options, const char *text, fl_err *err)
{
    struct options *const o = options;
    const char *colon = strchr(text, ':'), *value = colon ? colon + 1 : text, *comma = strchr(value, ',');
    char word[40];
    o->filter_kind = FL_FILTER_LOW;
    if (colon) {
        snprintf(word, sizeof word, "%.*s", (int)(colon - text), text);
        if (fl_option_choice("filter", word, FILTERS, &o->filter_kind, err)) return -1;
    }
    if (o->filter_kind == FL_FILTER_MEAN) return fl_option_time("filter", value, &o->filter, err);
    if (o->filter_kind != FL_FILTER_BAND)
        return fl_option_number("filter", value, 1e-300, 1e300, "a frequency above 0", &o->filter, err);
    if (!comma || comma - value >= (int)sizeof word)
        return fl_fail(err, FL_USAGE, "--filter is \"%.40s\", expected band:HZ,HZ", text);
    snprintf(word, sizeof word, "%.*s", (int)(comma - value), value);
    if (fl_option_number("filter", word, 1e-300, 1e300, "a frequency above 0", &o->filter, err) ||
        fl_option_number("filter", comma + 1, 1e-300, 1e300, "a frequency above 0", &o->upper, err))
        return -1;
    if (o->upper > o->filter) return 0;
    return fl_fail(err, FL_USAGE, "--filter \"%.40s\" has its second frequency below the first", text);
}

/* One word of --sn; add_sn() counts the curve when all its words are read. */
static int parse_sn_word(void *options, const char *word, fl_err *err)
{
    struct options *const o = options;
    fl_sn_curve *sn = &o->sn[o->sn_curves];
    switch (o->sn_words++) {
    case 0: return fl_option_number("sn", word, 1e-3, 100.0, "an exponent above 0", &sn->m, err);
    case 1:
        return fl_option_number("sn", word, TINY, HUGE_NUMBER, "cycles to failure at a stress of 1", &sn->a,
                                err);
    case 2:
        sn->m2 = INFINITY;
        if (strcmp(word, "inf") == 0) return 0;
        return fl_option_number("sn", word, 1e-3, 100.0, "an exponent below the knee or inf", &sn->m2, err);
    case 3: return fl_option_number("sn", word, TINY, HUGE_NUMBER, "the stress at the knee", &sn->knee, err);
    default: return fl_fail(err, FL_USAGE, "--sn has more than M,A,M2,KNEE");
    }
}

static int add_sn(void *options, const char *text, fl_err *err)
{
    struct options *const o = options;
    if (o->sn_curves == SN_CURVES_MAX)
        return fl_fail(err, FL_USAGE, "expected at most %d S-N curves", SN_CURVES_MAX);
    o->sn[o->sn_curves] = (fl_sn_curve){.a = NAN};
    o->sn_words = 0;
    if (fl_option_each("sn", text, parse_sn_word, o, err)) return -1;
    if (o->sn_words == 3)
        return fl_fail(err, FL_USAGE, "--sn \"%.60s\" has a second slope but no knee", text);
    o->sn_curves++;
    return 0;
}

/* One word of --oscillator; add_oscillator() counts it when all its words are read. */
static int parse_oscillator_word(void *options, const char *word, fl_err *err)
{
    struct options *const o = options;
    struct oscillator_case *a = &o->oscillator[o->oscillators];
    const double tiny = 1e-100, huge = 1e100;
    const size_t len = strlen(word);
    const int mass = len > 2 && strcmp(word + len - 2, "kg") == 0;
    char number[64];
    double k;
    switch (o->oscillator_words++) {
    case 0:
        return fl_option_number("oscillator", word, tiny, huge, "a natural frequency above 0",
                                &a->o.frequency, err);
    case 1:
        return fl_option_number("oscillator", word, 0.0, 100.0, "a damping ratio from 0 on", &a->o.damping,
                                err);
    case 2:
        snprintf(number, sizeof number, "%.*s", (int)(mass ? len - 2 : len), word);
        if (fl_option_number("oscillator", number, tiny, huge, "a stiffness or a mass above 0", &k, err))
            return -1;
        a->stiffness = mass ? k * pow(6.283185307179586 * a->o.frequency, 2.0) : k;
        return 0;
    default: return fl_fail(err, FL_USAGE, "--oscillator has more than F,Z,K");
    }
}

static int add_oscillator(void *options, const char *text, fl_err *err)
{
    struct options *const o = options;
    if (o->oscillators == OSCILLATORS_MAX)
        return fl_fail(err, FL_USAGE, "expected at most %d oscillators", OSCILLATORS_MAX);
    o->oscillator[o->oscillators] = (struct oscillator_case){.stiffness = NAN, .text = text};
    o->oscillator_words = 0;
    if (fl_option_each("oscillator", text, parse_oscillator_word, o, err)) return -1;
    if (o->oscillator_words < 2)
        return fl_fail(err, FL_USAGE, "--oscillator \"%.60s\" has no damping, expected F,Z", text);
    o->oscillators++;
    return 0;
}

static int parse_mode(void *options, const char *word, fl_err *err)
{
    struct options *const o = options;
    if (o->modes == MODES_MAX)
        return fl_fail(err, FL_USAGE, "expected at most %d natural frequencies", MODES_MAX);
    return fl_option_number("mode", word, 1e-100, 1e100, "a natural frequency above 0", &o->mode[o->modes++],
                            err);
}

static int parse_area(void *options, const char *word, fl_err *err)
{
    struct options *const o = options;
    if (o->areas == AREAS_MAX) return fl_fail(err, FL_USAGE, "expected at most %d areas", AREAS_MAX);
    return fl_option_number("areas", word, 1e-12, 1e12, "an area above 0", &o->area[o->areas++], err);
}

static int parse_height(void *options, const char *word, fl_err *err)
{
    struct options *const o = options;
    double *z = &o->height[o->heights];
    if (o->heights == HEIGHTS_MAX) return fl_fail(err, FL_USAGE, "expected at most %d heights", HEIGHTS_MAX);
    if (fl_option_number("heights", word, -1e6, 1e6, "a height", z, err)) return -1;
    if (o->heights && !(*z > z[-1]))
        return fl_fail(err, FL_USAGE, "--heights do not rise at \"%.40s\"", word);
    o->heights++;
    return 0;
}

/* --- one function for each option that has a form of its own ------------------------------------ */

static int add_components(void *options, const char *text, fl_err *err)
{
    return fl_option_each("component", text, parse_component, options, err);
}

static int add_columns(void *options, const char *text, fl_err *err)
{
    return fl_option_each("column", text, parse_signal, options, err);
}

static int set_quantiles(void *options, const char *text, fl_err *err)
{
    struct options *const o = options;
    o->quantiles = 0;
    o->quantiles_text = text;
    return fl_option_each("quantiles", text, parse_quantile, o, err);
}

static int set_areas(void *options, const char *text, fl_err *err)
{
    struct options *const o = options;
    o->areas = 0;
    o->areas_text = text;
    return fl_option_each("areas", text, parse_area, o, err);
}

static int set_heights(void *options, const char *text, fl_err *err)
{
    struct options *const o = options;
    o->heights = 0;
    o->heights_text = text;
    return fl_option_each("heights", text, parse_height, o, err);
}

static int set_modes(void *options, const char *text, fl_err *err)
{
    struct options *const o = options;
    o->modes = 0;
    o->modes_text = text;
    return fl_option_each("mode", text, parse_mode, o, err);
}

static int add_returns(void *options, const char *text, fl_err *err)
{
    return fl_option_each("return", text, parse_return, options, err);
}

static int choose_summary(void *options, const char *text, fl_err *err)
{
    (void)text;
    return choose_table(options, "summary", err);
}

static int add_condition(void *options, const char *text, fl_err *err)
{
    struct options *const o = options;
    if (o->wheres == CONDITIONS_MAX)
        return fl_fail(err, FL_USAGE, "expected at most %d conditions", CONDITIONS_MAX);
    o->where[o->wheres++] = text;
    return 0;
}

static int set_reduction(void *options, const char *text, fl_err *err)
{
    int k;
    if (fl_option_choice("over", text, REDUCTIONS, &k, err)) return -1;
    ((struct options *)options)->over = k + 1;
    return 0;
}

static int set_about(void *options, const char *text, fl_err *err)
{
    struct options *const o = options;
    o->abouts = 0;
    if (fl_option_each("about", text, parse_about, o, err)) return -1;
    return o->abouts == 3 ? 0 : fl_fail(err, FL_USAGE, "--about is \"%.40s\", expected X,Y,Z", text);
}

static int set_skip(void *options, const char *text, fl_err *err)
{
    struct options *const o = options;
    o->skips = 0;
    o->skip[2] = NAN;
    o->keep_start = strcmp(text, "none") == 0;
    if (o->keep_start) return 0;
    if (fl_option_each("skip", text, parse_skip, o, err)) return -1;
    return o->skips >= 2
               ? 0
               : fl_fail(err, FL_USAGE, "--skip is \"%.40s\", expected N,D or N,D,GAP or none", text);
}

static int set_gap(void *options, const char *text, fl_err *err)
{
    return strcmp(text, "0") == 0 ? 0 : fl_option_time("gap", text, &((struct options *)options)->gap, err);
}

static int set_patience(void *options, const char *text, fl_err *err)
{
    return strcmp(text, "0") == 0
               ? 0
               : fl_option_time("patience", text, &((struct options *)options)->patience, err);
}

static int set_format(void *options, const char *text, fl_err *err)
{
    int k;
    if (fl_option_choice("format", text, FORMATS, &k, err)) return -1;
    ((struct options *)options)->format = FORMATS[k];
    return 0;
}

static int count_file(void *options, const char *text, fl_err *err)
{
    (void)text, (void)err;
    ((struct options *)options)->files++;
    return 0;
}

/* --- the table --------------------------------------------------------------------------------- */

#define AT(member) offsetof(struct options, member)

/* The first row's help lists the kinds of tables; options_parse() writes it. */
static char tables_help[500];

static const fl_option OPTION[] = {
    {.word = "table",
     .letter = 't',
     .argument = "WHAT",
     .help = tables_help,
     .kind = FL_OPTION_CALL,
     .call = choose_table},
    {.word = "summary",
     .help = "the table summary, of one run or of many files",
     .kind = FL_OPTION_CALL,
     .call = choose_summary},
    {.word = "merge", .help = "merge files that are summaries", .at = AT(merge)},
    {.word = "force", .help = "count runs that stopped early among others", .at = AT(force)},
    {.word = "stream",
     .help = "stats, histogram in constant memory, values in classes of 0.8 %",
     .at = AT(stream)},
    {.word = "follow",
     .argument = "S",
     .help = "stats of a record that grows, every S seconds of its data",
     .kind = FL_OPTION_TIME,
     .at = AT(follow)},
    {.word = "patience",
     .argument = "S",
     .help = "of --follow: stop when the file has not grown for S seconds (0)",
     .kind = FL_OPTION_CALL,
     .call = set_patience},
    {.word = "digits",
     .argument = "N",
     .help = "of numbers in tables, 6 to 17; shorter ones stay as they are (6)",
     .kind = FL_OPTION_INTEGER,
     .at = AT(digits),
     .lo = LEAST_DIGITS,
     .hi = ALL_DIGITS},
    {.word = "component",
     .letter = 'c',
     .argument = "LIST",
     .help = "of fx fy fz mx my mz, fh (horizontal), f (all of it) (fx,fy,fz,fh)",
     .kind = FL_OPTION_CALL,
     .call = add_components},
    {.word = "column",
     .letter = 'C',
     .argument = "LIST",
     .help = "columns of the table by name",
     .kind = FL_OPTION_CALL,
     .call = add_columns},
    {.word = "part",
     .letter = 'p',
     .argument = "NAME",
     .help = "one part of the structure, or total",
     .kind = FL_OPTION_TEXT,
     .at = AT(part)},
    {.word = "where",
     .argument = "COLUMN=WORD",
     .help = "only rows with that word in that column",
     .kind = FL_OPTION_CALL,
     .call = add_condition},
    {.word = "over",
     .argument = "WHAT",
     .help = "combine the rows of one time: sum, mean, min, max or count",
     .kind = FL_OPTION_CALL,
     .call = set_reduction},
    {.word = "from",
     .argument = "T",
     .help = "drop rows before T seconds",
     .kind = FL_OPTION_NUMBER,
     .at = AT(from),
     .lo = -HUGE_NUMBER,
     .hi = HUGE_NUMBER,
     .expected = "a time"},
    {.word = "to",
     .argument = "T",
     .help = "drop rows after T seconds",
     .kind = FL_OPTION_NUMBER,
     .at = AT(to),
     .lo = -HUGE_NUMBER,
     .hi = HUGE_NUMBER,
     .expected = "a time"},
    {.word = "about",
     .argument = "X,Y,Z",
     .help = "moments of loads about this point, from the reference of each part (0,0,0)",
     .kind = FL_OPTION_CALL,
     .call = set_about},
    {.word = "skip",
     .argument = "N,D[,GAP]",
     .help = "drop the start, until an ice front of --speed has passed N diameters D;\n"
             "GAP is its distance at time 0; without it, it arrives with the first load;\n"
             "none: keep a start-up that would be left out",
     .kind = FL_OPTION_CALL,
     .call = set_skip},
    {.word = "window",
     .letter = 'w',
     .argument = "S",
     .help = "only the last S seconds",
     .kind = FL_OPTION_NUMBER,
     .at = AT(window),
     .lo = TINY,
     .hi = HUGE_NUMBER,
     .expected = "a time above 0"},
    {.word = "step",
     .argument = "S",
     .help = "resample the record to equal steps by means",
     .kind = FL_OPTION_TIME,
     .at = AT(step)},
    {.word = "filter",
     .letter = 'f',
     .argument = "WHAT",
     .help = "add the view through a zero-phase Butterworth filter, HZ or low:HZ, high:HZ\n"
             "or band:HZ,HZ, or a moving mean, mean:S",
     .kind = FL_OPTION_CALL,
     .call = parse_filter},
    {.word = "order",
     .argument = "N",
     .help = "order of one pass of the filter (4)",
     .kind = FL_OPTION_INTEGER,
     .at = AT(order),
     .lo = 1,
     .hi = FL_BUTTERWORTH_ORDER_MAX},
    {.word = "separation",
     .letter = 's',
     .argument = "R",
     .help = "peaks are separate when the load falls below R times the smaller (0.5)",
     .kind = FL_OPTION_NUMBER,
     .at = AT(separation),
     .lo = 0.0,
     .hi = 1.0,
     .expected = "a number from 0 to 1"},
    {.word = "peaks",
     .argument = "WHAT",
     .help = "peaks of the signal, max, of its negative, min, or of its absolute value, abs (max)",
     .kind = FL_OPTION_CHOICE,
     .at = AT(peaks),
     .choice = PEAKS},
    {.word = "threshold",
     .argument = "X",
     .help = "only peaks above X, in the unit of the signal (0)",
     .kind = FL_OPTION_NUMBER,
     .at = AT(threshold),
     .lo = -HUGE_NUMBER,
     .hi = HUGE_NUMBER,
     .expected = "a number"},
    {.word = "bins",
     .letter = 'b',
     .argument = "N",
     .help = "classes of the histogram (20)",
     .kind = FL_OPTION_INTEGER,
     .at = AT(bins),
     .lo = 1,
     .hi = 1000000},
    {.word = "quantiles",
     .argument = "LIST",
     .help = "of 0 .. 1 (0.5,0.9,0.95,0.99)",
     .kind = FL_OPTION_CALL,
     .call = set_quantiles},
    {.word = "sample",
     .argument = "WHAT",
     .help = "fit distributions to peaks, pot (over threshold), blocks or runs (peaks)",
     .kind = FL_OPTION_CHOICE,
     .at = AT(sample),
     .choice = SAMPLES},
    {.word = "gap",
     .argument = "S",
     .help = "of pot: time below the threshold that separates two of them (0)",
     .kind = FL_OPTION_CALL,
     .call = set_gap},
    {.word = "block",
     .argument = "S",
     .help = "of blocks: their length",
     .kind = FL_OPTION_TIME,
     .at = AT(block)},
    {.word = "areas",
     .argument = "LIST",
     .help = "of pressure-area: areas of the window (0.01,0.02,0.05 ... 10)",
     .kind = FL_OPTION_CALL,
     .call = set_areas},
    {.word = "waterline",
     .argument = "LINE",
     .help = "of line-load, map: circle:X,Y,R or X,Y:X,Y:...; --bins sections",
     .kind = FL_OPTION_TEXT,
     .at = AT(waterline)},
    {.word = "heights",
     .argument = "LIST",
     .help = "of map: rising, edges of the rows of panels",
     .kind = FL_OPTION_CALL,
     .call = set_heights},
    {.word = "level",
     .argument = "R",
     .help = "of legs, events: durations are those above R times the peak (0.5)",
     .kind = FL_OPTION_NUMBER,
     .at = AT(level),
     .lo = 1e-9,
     .hi = 1.0 - 1e-9,
     .expected = "a number between 0 and 1"},
    {.word = "rule",
     .argument = "RULE",
     .help = "of load cycles: astm (E1049) or iso (12110-2) (astm)",
     .kind = FL_OPTION_CHOICE,
     .at = AT(rule),
     .choice = CYCLE_RULE},
    {.word = "residue",
     .argument = "WHAT",
     .help = "residue of iso: half cycles, repeat, or none (half)",
     .kind = FL_OPTION_CHOICE,
     .at = AT(residue),
     .choice = RESIDUES},
    {.word = "sn",
     .argument = "M[,A[,M2,KNEE]]",
     .help = "of damage: N = A S^-M cycles to failure, slope M2 below S = KNEE (3; 5)",
     .kind = FL_OPTION_CALL,
     .call = add_sn},
    {.word = "stress",
     .argument = "X",
     .help = "of damage: stress per unit of the load (1)",
     .kind = FL_OPTION_NUMBER,
     .at = AT(stress),
     .lo = TINY,
     .hi = HUGE_NUMBER,
     .expected = "a number above 0"},
    {.word = "segment",
     .argument = "S",
     .help = "of spectra: length of a segment, they overlap by half (8 or a few more of them)",
     .kind = FL_OPTION_TIME,
     .at = AT(segment)},
    {.word = "taper",
     .argument = "WINDOW",
     .help = "of spectra: hann, hamming, blackman or none (hann)",
     .kind = FL_OPTION_CHOICE,
     .at = AT(taper),
     .choice = TAPERS},
    {.word = "speed",
     .argument = "V",
     .help = "of the ice, in m/s: for the breaking length V / f",
     .kind = FL_OPTION_NUMBER,
     .at = AT(speed),
     .lo = TINY,
     .hi = HUGE_NUMBER,
     .expected = "a speed above 0"},
    {.word = "oscillator",
     .argument = "F,Z[,K]",
     .help = "of response, motion: natural frequency, damping (1 is critical), stiffness,\n"
             "or mass, as 2e6kg; may be repeated",
     .kind = FL_OPTION_CALL,
     .call = add_oscillator},
    {.word = "mode",
     .argument = "LIST",
     .help = "of regimes: natural frequencies in Hz; their windows are --segment long (20 s)",
     .kind = FL_OPTION_CALL,
     .call = set_modes},
    {.word = "return",
     .argument = "LIST",
     .help = "of levels: return periods, seconds or with a unit, 100h (s min h d a)",
     .kind = FL_OPTION_CALL,
     .call = add_returns},
    {.word = "resamples",
     .argument = "N",
     .help = "for intervals and probabilities, 0 for none (199)",
     .kind = FL_OPTION_INTEGER,
     .at = AT(resamples),
     .lo = 0,
     .hi = 100000},
    {.word = "seed",
     .argument = "N",
     .help = "of their random numbers (1)",
     .kind = FL_OPTION_INTEGER,
     .at = AT(seed),
     .lo = 0,
     .hi = INT32_MAX},
    {.word = "plot",
     .argument = "DIR",
     .help = "draw history and peak distribution into DIR",
     .kind = FL_OPTION_TEXT,
     .at = AT(plot)},
    {.word = "export",
     .argument = "FORM",
     .help = "write the load as input of another program: openfast, orcaflex, ansys, sacs",
     .kind = FL_OPTION_CALL,
     .call = set_export},
    {.word = "report",
     .argument = "FILE",
     .help = "write numbers, pictures and history as one HTML page",
     .kind = FL_OPTION_TEXT,
     .at = AT(report)},
    {.word = "page",
     .argument = "FILE",
     .help = "page of ice-view --html that the report links",
     .kind = FL_OPTION_FILE,
     .at = AT(page)},
    {.word = "format",
     .argument = "FORMAT",
     .help = "of the pictures, svg, png or pdf (svg)",
     .kind = FL_OPTION_CALL,
     .call = set_format},
    FL_COMMON_OPTIONS(struct options, "write there, - is standard output", "compress the table",
                      "threads (one per processor)", "no notes on standard error", "more of them"),
};

static const fl_option_table TABLE = {"loadstats", USAGE, OPTION, count_file, 0};

static void write_tables_help(void)
{
    size_t line = 0;
    tables_help[0] = '\0';
    for (int k = 0; k < table_count(); k++) {
        const char *name = table_at(k)->name, *mark = k == 0 ? "" : line > 60 ? ",\n" : ", ";
        const size_t at = strlen(tables_help);
        line = line > 60 ? strlen(name) : line + strlen(mark) + strlen(name);
        snprintf(tables_help + at, sizeof tables_help - at, "%s%s", mark, name);
    }
    const size_t at = strlen(tables_help);
    snprintf(tables_help + at, sizeof tables_help - at, " (%s)", table_default()->name);
}

/* The files are the last arguments: getopt_long() moves them there. */
static void set_files(struct options *o, int argc, char *const *argv)
{
    static char input[] = "-";
    static char *const only[] = {input};
    o->file = o->files ? argv + argc - o->files : only;
    if (!o->files) o->files = 1;
    o->in = o->file[0];
}

int options_parse(struct options *o, int argc, char **argv, fl_err *err)
{
    static const double usual[] = {0.5, 0.9, 0.95, 0.99},
                        areas[] = {0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0};
    *o = (struct options){.in = "-",
                          .out = "-",
                          .format = "svg",
                          .table = table_default(),
                          .from = -INFINITY,
                          .to = INFINITY,
                          .order = 4,
                          .digits = LEAST_DIGITS,
                          .separation = 0.5,
                          .bins = 20,
                          .level = 0.5,
                          .stress = 1.0,
                          .resamples = 199,
                          .seed = 1,
                          .quantiles = COUNT(usual)};
    memcpy(o->quantile, usual, sizeof usual);
    memcpy(o->area, areas, sizeof areas);
    o->areas = COUNT(areas);
    write_tables_help();
    if (fl_options_read(&TABLE, o, NULL, argc, argv, err)) return -1;
    if (o->ended) return 0;
    set_files(o, argc, argv);
    if (options_check(o, err)) return -1;
    char *word = o->words;
    for (int32_t k = 0; k < o->signals; k++) {
        o->signal[k] = word;
        word += strlen(word) + 1;
    }
    if (o->table->needs & NEEDS_MODES) o->signals = regime_signals(o->signal, o->speed > 0.0);
    return 0;
}

void options_free(struct options *o)
{
    free(o->words);
    o->words = NULL;
}
