/* SPDX-License-Identifier: GPL-3.0-or-later */
/* options.h -- the command line of loadstats. */
#ifndef LOADSTATS_OPTIONS_H
#define LOADSTATS_OPTIONS_H
#include <stdint.h>
#include "base/err.h"
#include "base/tool.h"
#include "stat/oscillator.h"
#include "stat/rainflow.h"

enum {
    SIGNALS_MAX = 20,
    QUANTILES_MAX = 50,
    RETURNS_MAX = 50,
    WHERES_MAX = 16,
    SNS_MAX = 8,
    AREAS_MAX = 30,
    HEIGHTS_MAX = 200,
    SWAYS_MAX = 50
};
enum table {
    TABLE_STATS,
    TABLE_PEAKS,
    TABLE_HISTOGRAM,
    TABLE_EXCEEDANCE,
    TABLE_FITS,
    TABLE_LEVELS,
    TABLE_LEGS,
    TABLE_EVENTS,
    TABLE_RAINFLOW,
    TABLE_DAMAGE,
    TABLE_SPECTRUM,
    TABLE_FREQUENCY,
    TABLE_RESPONSE,
    TABLE_MOTION,
    TABLE_PRESSURE,
    TABLE_LINE,
    TABLE_MAP,
    TABLE_SUMMARY,
    TABLE_ENSEMBLE,
    TABLE_CYCLES
};
enum sample { SAMPLE_PEAKS, SAMPLE_POT, SAMPLE_BLOCKS, SAMPLE_RUNS };

/* An oscillator as it was asked for; stiffness is NAN where it was not given [unit of the load / m]. */
struct sway {
    fl_oscillator o;
    double stiffness;
    const char *text; /* borrowed from argv */
};

struct options {
    const char *in, *out, *part, *plot, *format, *report; /* borrowed from argv */
    const char *signal[SIGNALS_MAX];                      /* into words */
    char *words;                                          /* the lists of the command line, cut in place */
    int32_t signals, words_len, words_cap;
    double from, to, window; /* [s] */
    double skip[3];          /* diameters, diameter, distance at time 0; NAN: by the first load */
    int skips;               /* how many of them were given */
    double step;             /* [s], 0 for the rows as they are */
    double filter, upper;    /* [Hz], of a moving mean [s]; 0 for none; upper is of a band */
    int pass, order;         /* fl_filter_kind */
    double separation, threshold;
    int32_t bins;
    double quantile[QUANTILES_MAX];
    int32_t quantiles;
    const char *quantiles_text; /* as given, or NULL */
    enum table table;
    int table_given;
    enum sample sample;         /* what laws are fitted to */
    double gap, block;          /* [s] */
    double area[AREAS_MAX];     /* of windows of local pressure [m^2] */
    double height[HEIGHTS_MAX]; /* rising, of the edges of panels [m] */
    int32_t areas, heights;
    const char *areas_text, *heights_text, *waterline; /* as given, or NULL; borrowed from argv */
    double level;               /* of a peak or of the largest value, what is above it lasts */
    double period[RETURNS_MAX]; /* [s] */
    int32_t returns, resamples, seed;
    int gzip, quiet, verbose, threads;
    int page;          /* the history line is that of a report, which holds several tables */
    char *const *file; /* [files] the inputs, in is the first of them */
    int files, merge, stream;
    double patience;
    const char *where[WHERES_MAX]; /* "COLUMN=WORD", borrowed from argv */
    int32_t wheres;
    int over;                /* fl_time_reduction */
    int rule, residue;       /* of the cycles, fl_rainflow_rule and fl_residue */
    fl_sn_curve sn[SNS_MAX]; /* a is NAN where only the exponent was given */
    int32_t sns, sn_words;
    double segment, speed; /* [s] of a spectrum, 0 for what suits the record; [m/s] 0 for not known */
    int taper;             /* fl_taper */
    struct sway sway[SWAYS_MAX];
    int32_t sways, sway_words;
    double stress; /* per unit of the load */
    double follow; /* [s] of data between two reports, 0 for one at the end */
    int ended;     /* --help or --version was answered */
};

/* Defaults, then the command line.  0, or -1 with FL_USAGE or FL_SYSTEM in err.  Free with options_free(). */
int options_parse(struct options *o, int argc, char **argv, fl_err *err);
void options_free(struct options *o);

/* What is left out at the start [s]: all before a time, and what is less than so long after the first load.
 */
double options_from(const struct options *o);
double options_after(const struct options *o);

/* Of a picture: "2 Hz", "above 0.1 Hz", "0.1 to 2 Hz", "mean of 5 s". */
void options_filter(const struct options *o, char *text, size_t size);

/* Of many runs the record is not held, only what adds up. */
int options_many_runs(const struct options *o);

/* "stats", "peaks" ... : the word of --table, which is also the kind of the file. */
const char *options_table(enum table t);

/* "peaks", "pot", "blocks", "runs" */
const char *options_sample(enum sample s);

#endif
