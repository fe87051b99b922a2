/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <getopt.h>
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
#include "options.h"
#include "table_list.h"

static const char HELP[] =
    "usage: loadstats [options] [FILE ...]\n"
    "Statistics of a load record: moments, quantiles, peaks, histogram, exceedance, plots.\n"
    "FILE is a loads table, or any table with a column t; - or nothing is standard input.\n"
    "\n"
    "  -t, --table WHAT        stats, peaks, histogram, exceedance, fits, levels, legs, events,\n"
    "                          rainflow, damage, spectrum, frequency, response, motion, summary, ensemble,\n"
    "                          cycles; or, of contacts, pressure-area, line-load, map (stats)\n"
    "      --summary           the table summary, of one run or of many files\n"
    "      --merge             merge files that are summaries\n"
    "      --stream            stats, histogram in constant memory, values in classes of 0.8 %\n"
    "      --follow S          stats of a record that grows, every S seconds of its data\n"
    "      --patience S        of --follow: stop when the file has not grown for S seconds (0)\n"
    "  -c, --component LIST    of fx fy fz mx my mz, fh (horizontal), f (all of it) (fx,fy,fz,fh)\n"
    "  -C, --column LIST       columns of the table by name\n"
    "  -p, --part NAME         one part of the structure, or total\n"
    "      --where COLUMN=WORD only rows with that word in that column\n"
    "      --over WHAT         combine the rows of one time: sum, mean, min, max or count\n"
    "      --from T            drop rows before T seconds\n"
    "      --to T              drop rows after T seconds\n"
    "      --skip N,D[,GAP]    drop the start, until an ice front of --speed has passed N diameters D;\n"
    "                          GAP is its distance at time 0; without it, it arrives with the first load\n"
    "  -w, --window S          only the last S seconds\n"
    "      --step S            resample the record to equal steps by means\n"
    "  -f, --filter WHAT       add the view through a zero-phase Butterworth filter, HZ or low:HZ, high:HZ\n"
    "                          or band:HZ,HZ, or a moving mean, mean:S\n"
    "      --order N           order of one pass of the filter (4)\n"
    "  -s, --separation R      peaks are separate when the load falls below R times the smaller (0.5)\n"
    "      --threshold X       only peaks above X, in the unit of the signal (0)\n"
    "  -b, --bins N            classes of the histogram (20)\n"
    "      --quantiles LIST    of 0 .. 1 (0.5,0.9,0.95,0.99)\n"
    "      --sample WHAT       fit distributions to peaks, pot (over threshold), blocks or runs (peaks)\n"
    "      --gap S             of pot: time below the threshold that separates two of them (0)\n"
    "      --block S           of blocks: their length\n";

/* Second half: a string literal of C has at most 4095 characters. */
static const char HELP_MORE[] =
    "      --areas LIST        of pressure-area: areas of the window (0.01,0.02,0.05 ... 10)\n"
    "      --waterline LINE    of line-load, map: circle:X,Y,R or X,Y:X,Y:...; --bins sections\n"
    "      --heights LIST      of map: rising, edges of the rows of panels\n"
    "      --level R           of legs, events: durations are those above R times the peak (0.5)\n"
    "      --rule RULE         of load cycles: astm (E1049) or iso (12110-2) (astm)\n"
    "      --residue WHAT      residue of iso: half cycles, repeat, or none (half)\n"
    "      --sn M[,A[,M2,KNEE]] of damage: N = A S^-M cycles to failure, slope M2 below S = KNEE (3; 5)\n"
    "      --stress X          of damage: stress per unit of the load (1)\n"
    "      --segment S         of spectra: length of a segment, they overlap by half (8 or a few more of "
    "them)\n"
    "      --taper WINDOW      of spectra: hann, hamming, blackman or none (hann)\n"
    "      --speed V           of the ice, in m/s: for the breaking length V / f\n"
    "      --oscillator F,Z[,K] of response, motion: natural frequency, damping (1 is critical), stiffness,\n"
    "                          or mass, as 2e6kg; may be repeated\n"
    "      --return LIST       of levels: return periods, seconds or with a unit, 100h (s min h d a)\n"
    "      --resamples N       for intervals and probabilities, 0 for none (199)\n"
    "      --seed N            of their random numbers (1)\n"
    "      --plot DIR          draw history and peak distribution into DIR\n"
    "      --report FILE       write numbers, pictures and history as one HTML page\n"
    "      --format FORMAT     of the pictures, svg or png (svg)\n"
    "  -o, --output FILE       write there, - is standard output\n"
    "  -z, --gzip              compress the table\n"
    "  -j, --threads N         threads (one per processor)\n"
    "  -q, --quiet             no notes on standard error\n"
    "  -v, --verbose           more of them\n"
    "  -h, --help              this text\n"
    "      --version           the version\n";

enum {
    FROM = 256,
    TO,
    ORDER,
    THRESHOLD,
    QUANTILES,
    PLOT,
    FORMAT,
    VERSION,
    SAMPLE,
    GAP,
    BLOCK,
    RETURN,
    RESAMPLES,
    SEED,
    SUMMARY,
    MERGE,
    STREAM,
    FOLLOW,
    REPORT,
    WHERE,
    OVER,
    PATIENCE,
    LEVEL,
    AREAS,
    WATERLINE,
    HEIGHTS,
    RULE,
    RESIDUE,
    SN,
    STRESS,
    SEGMENT,
    TAPER,
    SPEED,
    SKIP,
    STEP,
    OSCILLATOR
};

static const struct option LONG[] = {{"table", required_argument, NULL, 't'},
                                     {"component", required_argument, NULL, 'c'},
                                     {"column", required_argument, NULL, 'C'},
                                     {"part", required_argument, NULL, 'p'},
                                     {"from", required_argument, NULL, FROM},
                                     {"to", required_argument, NULL, TO},
                                     {"window", required_argument, NULL, 'w'},
                                     {"filter", required_argument, NULL, 'f'},
                                     {"order", required_argument, NULL, ORDER},
                                     {"separation", required_argument, NULL, 's'},
                                     {"threshold", required_argument, NULL, THRESHOLD},
                                     {"bins", required_argument, NULL, 'b'},
                                     {"quantiles", required_argument, NULL, QUANTILES},
                                     {"sample", required_argument, NULL, SAMPLE},
                                     {"gap", required_argument, NULL, GAP},
                                     {"block", required_argument, NULL, BLOCK},
                                     {"level", required_argument, NULL, LEVEL},
                                     {"areas", required_argument, NULL, AREAS},
                                     {"waterline", required_argument, NULL, WATERLINE},
                                     {"heights", required_argument, NULL, HEIGHTS},
                                     {"return", required_argument, NULL, RETURN},
                                     {"resamples", required_argument, NULL, RESAMPLES},
                                     {"seed", required_argument, NULL, SEED},
                                     {"plot", required_argument, NULL, PLOT},
                                     {"format", required_argument, NULL, FORMAT},
                                     {"summary", no_argument, NULL, SUMMARY},
                                     {"report", required_argument, NULL, REPORT},
                                     {"where", required_argument, NULL, WHERE},
                                     {"over", required_argument, NULL, OVER},
                                     {"patience", required_argument, NULL, PATIENCE},
                                     {"rule", required_argument, NULL, RULE},
                                     {"residue", required_argument, NULL, RESIDUE},
                                     {"sn", required_argument, NULL, SN},
                                     {"segment", required_argument, NULL, SEGMENT},
                                     {"taper", required_argument, NULL, TAPER},
                                     {"speed", required_argument, NULL, SPEED},
                                     {"oscillator", required_argument, NULL, OSCILLATOR},
                                     {"skip", required_argument, NULL, SKIP},
                                     {"step", required_argument, NULL, STEP},
                                     {"stress", required_argument, NULL, STRESS},
                                     {"merge", no_argument, NULL, MERGE},
                                     {"stream", no_argument, NULL, STREAM},
                                     {"follow", required_argument, NULL, FOLLOW},
                                     {"output", required_argument, NULL, 'o'},
                                     {"gzip", no_argument, NULL, 'z'},
                                     {"threads", required_argument, NULL, 'j'},
                                     {"quiet", no_argument, NULL, 'q'},
                                     {"verbose", no_argument, NULL, 'v'},
                                     {"help", no_argument, NULL, 'h'},
                                     {"version", no_argument, NULL, VERSION},
                                     {NULL, 0, NULL, 0}};

static const char *const SAMPLES[] = {"peaks", "pot", "blocks", "runs"};
static const char *const COMPONENT[] = {"fx", "fy", "fz", "mx", "my", "mz", "fh", "f"};
static const char *const REDUCTIONS[] = {"sum", "mean", "min", "max", "count"}; /* as fl_reduction_name() */
static const char *const CYCLE_RULE[] = {"astm", "iso"};                     /* as fl_rainflow_rule_name() */
static const char *const RESIDUES[] = {"half", "repeat", "none"};            /* as fl_residue_name() */
static const char *const TAPERS[] = {"hann", "hamming", "blackman", "none"}; /* as fl_taper_name() */
static const char *const FILTERS[] = {"low", "high", "band", "mean"};        /* as fl_filter_name() */
static const char *const FORMATS[] = {"svg", "png"};
#define COUNT(list) ((int)(sizeof(list) / sizeof *(list)))

static int parse_number(const char *option, const char *text, double lo, double hi, const char *wanted,
                        double *x, fl_err *err)
{
    if (fl_number_f64(text, x) == 0 && *x >= lo && *x <= hi) return 0;
    return fl_fail(err, FL_USAGE, "--%s is \"%.40s\", %s is expected", option, text, wanted);
}

static int parse_choice(const char *option, const char *text, const char *const *list, int n, fl_err *err)
{
    for (int k = 0; k < n; k++)
        if (strcmp(text, list[k]) == 0) return k;
    return fl_fail(err, FL_USAGE, "--%s does not know \"%.40s\", the nearest is %s", option, text,
                   fl_text_nearest(text, list, n));
}

static int choose_table(struct options *o, const char *text, fl_err *err)
{
    const char *name[TABLES_MAX];
    for (int k = 0; k < table_count(); k++) name[k] = table_at(k)->name;
    const int k = parse_choice("table", text, name, table_count(), err);
    if (k >= 0) o->table = table_at(k);
    return k < 0 ? -1 : 0;
}

/* Split a list at its commas and pass each word to `parse_word`. */
static int parse_list(struct options *o, const char *option, const char *text,
                      int (*parse_word)(struct options *, char *, fl_err *), fl_err *err)
{
    char *word = fl_alloc_text(text, err), *copy = word;
    int rc = word ? 0 : -1;
    while (rc == 0 && word) {
        char *comma = strchr(word, ',');
        if (comma) *comma++ = '\0';
        rc = word[0] ? parse_word(o, word, err)
                     : fl_fail(err, FL_USAGE, "--%s has an empty entry in \"%.60s\"", option, text);
        word = comma;
    }
    free(copy);
    return rc;
}

/* words moves when it grows, so the list keeps offsets until options_parse() is done. */
static int parse_signal(struct options *o, char *word, fl_err *err)
{
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

static int parse_component(struct options *o, char *word, fl_err *err)
{
    return parse_choice("component", word, COMPONENT, COUNT(COMPONENT), err) < 0 ? -1
                                                                                 : parse_signal(o, word, err);
}

static int parse_quantile(struct options *o, char *word, fl_err *err)
{
    if (o->quantiles == QUANTILES_MAX)
        return fl_fail(err, FL_USAGE, "expected at most %d quantiles", QUANTILES_MAX);
    double *q = &o->quantile[o->quantiles];
    if (parse_number("quantiles", word, 0.0, 1.0, "a number from 0 to 1", q, err)) return -1;
    for (int32_t k = 0; k < o->quantiles; k++) /* a quantile names a column, and names are unique */
        if (o->quantile[k] == *q) return fl_fail(err, FL_USAGE, "--quantiles has %.40s twice", word);
    o->quantiles++;
    return 0;
}

/* A time in seconds, or with its unit: 90s 10min 3h 2d 50a. */
static int parse_time(const char *option, const char *text, double *t, fl_err *err)
{
    static const struct {
        const char *unit;
        double seconds;
    } known[] = {{"", 1.0}, {"s", 1.0}, {"min", 60.0}, {"h", 3600.0}, {"d", 86400.0}, {"a", 31557600.0}};
    const size_t digits = strspn(text, "+-0123456789.eE");
    char number_text[40];
    if (digits < sizeof number_text) {
        memcpy(number_text, text, digits);
        number_text[digits] = '\0';
        for (size_t k = 0; k < sizeof known / sizeof *known; k++) {
            if (strcmp(text + digits, known[k].unit) != 0 || fl_number_f64(number_text, t) || !(*t > 0.0))
                continue;
            *t *= known[k].seconds;
            if (*t <= 1e300) return 0;
        }
    }
    return fl_fail(err, FL_USAGE, "--%s is \"%.40s\", expected a time above 0, as 90, 10min, 3h, 2d or 50a",
                   option, text);
}

static int parse_return(struct options *o, char *word, fl_err *err)
{
    if (o->returns == RETURNS_MAX)
        return fl_fail(err, FL_USAGE, "expected at most %d return periods", RETURNS_MAX);
    return parse_time("return", word, &o->period[o->returns++], err);
}

static int parse_skip(struct options *o, char *word, fl_err *err)
{
    static const char *const wanted[] = {"a number of diameters above 0", "a diameter above 0",
                                         "a distance from 0 on"};
    if (o->skips == 3) return fl_fail(err, FL_USAGE, "--skip has more than N,D,GAP");
    const double least = o->skips < 2 ? 1e-100 : 0.0;
    double *to = &o->skip[o->skips];
    return parse_number("skip", word, least, 1e100, wanted[o->skips++], to, err);
}

/* HZ, low:HZ, high:HZ, band:HZ,HZ or mean:S. */
static int parse_filter(struct options *o, const char *text, fl_err *err)
{
    const char *colon = strchr(text, ':'), *value = colon ? colon + 1 : text, *comma = strchr(value, ',');
    char word[40];
    o->filter_kind = FL_FILTER_LOW;
    if (colon) {
        snprintf(word, sizeof word, "%.*s", (int)(colon - text), text);
        o->filter_kind = parse_choice("filter", word, FILTERS, COUNT(FILTERS), err);
        if (o->filter_kind < 0) return -1;
    }
    if (o->filter_kind == FL_FILTER_MEAN) return parse_time("filter", value, &o->filter, err);
    if (o->filter_kind != FL_FILTER_BAND)
        return parse_number("filter", value, 1e-300, 1e300, "a frequency above 0", &o->filter, err);
    if (!comma || comma - value >= (int)sizeof word)
        return fl_fail(err, FL_USAGE, "--filter is \"%.40s\", expected band:HZ,HZ", text);
    snprintf(word, sizeof word, "%.*s", (int)(comma - value), value);
    if (parse_number("filter", word, 1e-300, 1e300, "a frequency above 0", &o->filter, err) ||
        parse_number("filter", comma + 1, 1e-300, 1e300, "a frequency above 0", &o->upper, err))
        return -1;
    if (o->upper > o->filter) return 0;
    return fl_fail(err, FL_USAGE, "--filter \"%.40s\" has its second frequency below the first", text);
}

/* One word of --sn; add_sn() counts the curve when all its words are read. */
static int parse_sn_word(struct options *o, char *word, fl_err *err)
{
    fl_sn_curve *sn = &o->sn[o->sn_curves];
    const double tiny = 1e-300, huge = 1e300;
    switch (o->sn_words++) {
    case 0: return parse_number("sn", word, 1e-3, 100.0, "an exponent above 0", &sn->m, err);
    case 1: return parse_number("sn", word, tiny, huge, "cycles to failure at a stress of 1", &sn->a, err);
    case 2:
        sn->m2 = INFINITY;
        if (strcmp(word, "inf") == 0) return 0;
        return parse_number("sn", word, 1e-3, 100.0, "the exponent below the knee, or inf,", &sn->m2, err);
    case 3: return parse_number("sn", word, tiny, huge, "the stress at the knee", &sn->knee, err);
    default: return fl_fail(err, FL_USAGE, "--sn has more than M,A,M2,KNEE");
    }
}

static int add_sn(struct options *o, const char *text, fl_err *err)
{
    if (o->sn_curves == SN_CURVES_MAX)
        return fl_fail(err, FL_USAGE, "expected at most %d S-N curves", SN_CURVES_MAX);
    o->sn[o->sn_curves] = (fl_sn_curve){.a = NAN};
    o->sn_words = 0;
    if (parse_list(o, "sn", text, parse_sn_word, err)) return -1;
    if (o->sn_words == 3)
        return fl_fail(err, FL_USAGE, "--sn \"%.60s\" has a second slope but no knee", text);
    o->sn_curves++;
    return 0;
}

/* One word of --oscillator; add_oscillator() counts it when all its words are read. */
static int parse_oscillator_word(struct options *o, char *word, fl_err *err)
{
    struct oscillator_case *a = &o->oscillator[o->oscillators];
    const double tiny = 1e-100, huge = 1e100;
    const size_t len = strlen(word);
    const int mass = len > 2 && strcmp(word + len - 2, "kg") == 0;
    double k;
    switch (o->oscillator_words++) {
    case 0:
        return parse_number("oscillator", word, tiny, huge, "a natural frequency above 0", &a->o.frequency,
                            err);
    case 1:
        return parse_number("oscillator", word, 0.0, 100.0, "a damping ratio from 0 on", &a->o.damping, err);
    case 2:
        if (mass) word[len - 2] = '\0';
        if (parse_number("oscillator", word, tiny, huge, "a stiffness or a mass above 0", &k, err)) return -1;
        a->stiffness = mass ? k * pow(6.283185307179586 * a->o.frequency, 2.0) : k;
        return 0;
    default: return fl_fail(err, FL_USAGE, "--oscillator has more than F,Z,K");
    }
}

static int add_oscillator(struct options *o, const char *text, fl_err *err)
{
    if (o->oscillators == OSCILLATORS_MAX)
        return fl_fail(err, FL_USAGE, "expected at most %d oscillators", OSCILLATORS_MAX);
    o->oscillator[o->oscillators] = (struct oscillator_case){.stiffness = NAN, .text = text};
    o->oscillator_words = 0;
    if (parse_list(o, "oscillator", text, parse_oscillator_word, err)) return -1;
    if (o->oscillator_words < 2)
        return fl_fail(err, FL_USAGE, "--oscillator \"%.60s\" has no damping, expected F,Z", text);
    o->oscillators++;
    return 0;
}

static int parse_area(struct options *o, char *word, fl_err *err)
{
    if (o->areas == AREAS_MAX) return fl_fail(err, FL_USAGE, "expected at most %d areas", AREAS_MAX);
    return parse_number("areas", word, 1e-12, 1e12, "an area above 0", &o->area[o->areas++], err);
}

static int parse_height(struct options *o, char *word, fl_err *err)
{
    double *z = &o->height[o->heights];
    if (o->heights == HEIGHTS_MAX) return fl_fail(err, FL_USAGE, "expected at most %d heights", HEIGHTS_MAX);
    if (parse_number("heights", word, -1e6, 1e6, "a height", z, err)) return -1;
    if (o->heights && !(*z > z[-1]))
        return fl_fail(err, FL_USAGE, "--heights do not rise at \"%.40s\"", word);
    o->heights++;
    return 0;
}

static int apply_option(struct options *o, int c, const char *arg, fl_err *err)
{
    const double tiny = 1e-300, huge = 1e300;
    int k;
    switch (c) {
    case 't': o->table_given = 1; return choose_table(o, arg, err);
    case 'c': return parse_list(o, "component", arg, parse_component, err);
    case 'C': return parse_list(o, "column", arg, parse_signal, err);
    case 'p': o->part = arg; return 0;
    case FROM: return parse_number("from", arg, -huge, huge, "a time", &o->from, err);
    case TO: return parse_number("to", arg, -huge, huge, "a time", &o->to, err);
    case 'w': return parse_number("window", arg, tiny, huge, "a time above 0", &o->window, err);
    case 'f': return parse_filter(o, arg, err);
    case ORDER: return fl_option_whole("order", arg, 1, FL_BUTTERWORTH_ORDER_MAX, &o->order, err);
    case 's': return parse_number("separation", arg, 0.0, 1.0, "a number from 0 to 1", &o->separation, err);
    case THRESHOLD:
        return parse_number("threshold", arg, 0.0, huge, "a number not below 0", &o->threshold, err);
    case 'b': return fl_option_whole("bins", arg, 1, 1000000, &o->bins, err);
    case QUANTILES:
        o->quantiles = 0;
        o->quantiles_text = arg;
        return parse_list(o, "quantiles", arg, parse_quantile, err);
    case SAMPLE:
        k = parse_choice("sample", arg, SAMPLES, COUNT(SAMPLES), err);
        o->sample = k < 0 ? SAMPLE_PEAKS : (enum sample)k;
        return k < 0 ? -1 : 0;
    case GAP: return strcmp(arg, "0") == 0 ? 0 : parse_time("gap", arg, &o->gap, err);
    case BLOCK: return parse_time("block", arg, &o->block, err);
    case AREAS:
        o->areas = 0;
        o->areas_text = arg;
        return parse_list(o, "areas", arg, parse_area, err);
    case WATERLINE: o->waterline = arg; return 0;
    case HEIGHTS:
        o->heights = 0;
        o->heights_text = arg;
        return parse_list(o, "heights", arg, parse_height, err);
    case LEVEL:
        return parse_number("level", arg, 1e-9, 1.0 - 1e-9, "a number between 0 and 1", &o->level, err);
    case RETURN: return parse_list(o, "return", arg, parse_return, err);
    case RESAMPLES: return fl_option_whole("resamples", arg, 0, 100000, &o->resamples, err);
    case SEED: return fl_option_whole("seed", arg, 0, INT32_MAX, &o->seed, err);
    case PLOT: o->plot = arg; return 0;
    case SUMMARY:
        o->table = table_named("summary");
        o->table_given = 1;
        return 0;
    case MERGE: o->merge = 1; return 0;
    case STREAM: o->stream = 1; return 0;
    case REPORT: o->report = arg; return 0;
    case WHERE:
        if (o->wheres == CONDITIONS_MAX)
            return fl_fail(err, FL_USAGE, "expected at most %d conditions", CONDITIONS_MAX);
        o->where[o->wheres++] = arg;
        return 0;
    case OVER:
        k = parse_choice("over", arg, REDUCTIONS, COUNT(REDUCTIONS), err);
        o->over = k + 1;
        return k < 0 ? -1 : 0;
    case RULE:
        o->rule = parse_choice("rule", arg, CYCLE_RULE, COUNT(CYCLE_RULE), err);
        return o->rule < 0 ? -1 : 0;
    case RESIDUE:
        o->residue = parse_choice("residue", arg, RESIDUES, COUNT(RESIDUES), err);
        return o->residue < 0 ? -1 : 0;
    case SEGMENT: return parse_time("segment", arg, &o->segment, err);
    case TAPER:
        o->taper = parse_choice("taper", arg, TAPERS, COUNT(TAPERS), err);
        return o->taper < 0 ? -1 : 0;
    case SPEED: return parse_number("speed", arg, tiny, huge, "a speed above 0", &o->speed, err);
    case OSCILLATOR: return add_oscillator(o, arg, err);
    case SKIP:
        o->skips = 0;
        o->skip[2] = NAN;
        if (parse_list(o, "skip", arg, parse_skip, err)) return -1;
        return o->skips >= 2 ? 0
                             : fl_fail(err, FL_USAGE, "--skip is \"%.40s\", expected N,D or N,D,GAP", arg);
    case STEP: return parse_time("step", arg, &o->step, err);
    case SN: return add_sn(o, arg, err);
    case STRESS: return parse_number("stress", arg, tiny, huge, "a number above 0", &o->stress, err);
    case PATIENCE: return strcmp(arg, "0") == 0 ? 0 : parse_time("patience", arg, &o->patience, err);
    case FOLLOW: return parse_time("follow", arg, &o->follow, err);
    case FORMAT:
        k = parse_choice("format", arg, FORMATS, COUNT(FORMATS), err);
        if (k >= 0) o->format = FORMATS[k];
        return k < 0 ? -1 : 0;
    case 'o': o->out = arg; return 0;
    case 'z': o->gzip = 1; return 0;
    case 'j': return fl_option_whole("threads", arg, 1, 1024, &o->threads, err);
    case 'q': o->quiet = 1; return 0;
    case 'v': o->verbose = 1; return 0;
    case 'h':
        fputs(HELP, stdout);
        fputs(HELP_MORE, stdout);
        o->ended = 1;
        return 0;
    case VERSION:
        fl_tool_version("loadstats");
        o->ended = 1;
        return 0;
    default: return fl_fail(err, FL_USAGE, "see loadstats --help");
    }
}

static void set_files(struct options *o, int n, char *const *file)
{
    static char input[] = "-";
    static char *const only[] = {input};
    o->file = n ? file : only;
    o->files = n ? n : 1;
    o->in = o->file[0];
}

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

int options_parse(struct options *o, int argc, char **argv, fl_err *err)
{
    static const double usual[] = {0.5, 0.9, 0.95, 0.99},
                        areas[] = {0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0};
    int c;
    *o = (struct options){.in = "-",
                          .out = "-",
                          .format = "svg",
                          .table = table_default(),
                          .from = -INFINITY,
                          .to = INFINITY,
                          .order = 4,
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
    opterr = 0;
    while (!o->ended && (c = getopt_long(argc, argv, ":t:c:C:p:w:f:s:b:o:zj:qvh", LONG, NULL)) != -1) {
        if (c == ':' || c == '?')
            return fl_option_unknown("loadstats", LONG, c, optopt, argv[optind - 1], err);
        if (apply_option(o, c, optarg, err)) return -1;
    }
    if (o->ended) return 0;
    set_files(o, argc - optind, argv + optind);
    if (check_contacts(o, err) || check_summary(o, err)) return -1;
    if (o->skips && !(o->speed > 0.0)) return fl_fail(err, FL_USAGE, "--skip needs --speed, that of the ice");
    if (!(o->from < o->to))
        return fl_fail(err, FL_USAGE, "--from %g s is not before --to %g s", o->from, o->to);
    if (o->sample == SAMPLE_RUNS && !settings_many_runs(o))
        return fl_fail(err, FL_USAGE, "--sample runs needs several runs, --merge or --stream");
    if (o->sample == SAMPLE_BLOCKS && !o->merge && !(o->block > 0.0))
        return fl_fail(err, FL_USAGE, "--sample blocks needs --block");
    if (o->residue && !o->rule) return fl_fail(err, FL_USAGE, "--residue needs --rule iso");
    if (o->report && strcmp(o->report, "-") == 0 && strcmp(o->out, "-") == 0)
        return fl_fail(err, FL_USAGE, "--report - needs --output for the table");
    if ((o->table->needs & NEEDS_OSCILLATOR) && !o->oscillators)
        return fl_fail(err, FL_USAGE, "--table %s needs --oscillator, F,Z", o->table->name);
    if ((o->table->needs & NEEDS_RETURNS) && !o->returns)
        return fl_fail(err, FL_USAGE, "--table %s needs --return, the return periods", o->table->name);
    char *word = o->words;
    for (int32_t k = 0; k < o->signals; k++) {
        o->signal[k] = word;
        word += strlen(word) + 1;
    }
    return 0;
}

void options_free(struct options *o)
{
    free(o->words);
    o->words = NULL;
}
