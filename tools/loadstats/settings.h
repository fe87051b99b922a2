/* SPDX-License-Identifier: GPL-3.0-or-later */
/* settings.h -- the settings of an analysis, as the command line gives them. */
#ifndef LOADSTATS_SETTINGS_H
#define LOADSTATS_SETTINGS_H
#include <stddef.h>
#include <stdint.h>
#include "stat/oscillator.h"
#include "stat/rainflow.h"

enum {
    SIGNALS_MAX = 20,
    QUANTILES_MAX = 50,
    RETURNS_MAX = 50,
    CONDITIONS_MAX = 16,
    SN_CURVES_MAX = 8,
    AREAS_MAX = 30,
    HEIGHTS_MAX = 200,
    OSCILLATORS_MAX = 50,
    MODES_MAX = 64
};
enum sample { SAMPLE_PEAKS, SAMPLE_POT, SAMPLE_BLOCKS, SAMPLE_RUNS };

/* One --oscillator; stiffness is NAN where it was not given [unit of the load / m]. */
struct oscillator_case {
    fl_oscillator o;
    double stiffness;
    const char *text; /* borrowed from argv */
};

struct options {
    const char *in, *out, *part, *plot, *format, *report, *page; /* borrowed from argv */
    const char *signal[SIGNALS_MAX];                             /* into words */
    char *words; /* the lists of the command line, cut in place */
    int32_t signals, words_len, words_cap;
    double from, to, window; /* [s] */
    double about[3];         /* point of the moments, from the reference of each part [m] */
    int abouts;              /* number of values given */
    double skip[3];          /* diameters, diameter, distance at time 0; NAN: from the first load */
    int skips;               /* number of values given */
    int32_t digits;          /* of numbers in tables */
    int keep_start;          /* --skip none */
    double step;             /* uniform step [s], 0 for the rows as they are */
    double filter, upper;    /* [Hz], length of a moving mean [s]; 0 for none; upper limit of a band */
    int filter_kind, order;  /* fl_filter_kind */
    double separation, threshold;
    int peaks; /* fl_peak_side */
    int32_t bins;
    double quantile[QUANTILES_MAX];
    int32_t quantiles;
    const char *quantiles_text; /* as given, or NULL */
    const struct table *table;  /* table_kind.h */
    int table_given;
    int sample;                 /* enum sample: values to which distributions are fitted */
    double gap, block;          /* [s] */
    double area[AREAS_MAX];     /* of windows of local pressure [m^2] */
    double height[HEIGHTS_MAX]; /* rising, of the edges of panels [m] */
    int32_t areas, heights;
    const char *areas_text, *heights_text, *waterline; /* as given, or NULL; borrowed from argv */
    double level;               /* fraction of a peak or of the largest value; durations are above it */
    double period[RETURNS_MAX]; /* return periods [s] */
    int32_t returns, resamples, seed;
    int gzip, quiet, verbose, threads, force;
    int report_page;   /* the history line is that of a report, which holds several tables */
    char *const *file; /* [files] the inputs, in is the first of them */
    int files, merge, stream;
    double patience;
    const char *where[CONDITIONS_MAX]; /* "COLUMN=WORD", borrowed from argv */
    int32_t wheres;
    int over;                      /* fl_time_reduction */
    int rule, residue;             /* of the cycles, fl_rainflow_rule and fl_residue */
    fl_sn_curve sn[SN_CURVES_MAX]; /* a is NAN where only the exponent was given */
    int32_t sn_curves, sn_words;
    double segment, speed; /* of a spectrum [s], 0 for the default; of the ice [m/s], 0 for unknown */
    int taper;             /* fl_taper */
    struct oscillator_case oscillator[OSCILLATORS_MAX];
    int32_t oscillators, oscillator_words;
    double mode[MODES_MAX]; /* natural frequencies [Hz] */
    int32_t modes;
    const char *modes_text; /* as given, or NULL; borrowed from argv */
    double stress;          /* per unit of the load */
    int exports;            /* 0, or 1 + the form of --export */
    double follow;          /* data time between two outputs [s], 0 for one at the end */
    int ended;              /* --help or --version was answered */
};

/* Start of the analysis [s], and the time to drop after the first load [s], 0 for none. */
double settings_from(const struct options *o);
double settings_after_first_load(const struct options *o);

/* The filter for a picture: "2 Hz", "above 0.1 Hz", "0.1 to 2 Hz", "mean of 5 s". */
void settings_filter_text(const struct options *o, char *text, size_t size);

/* True for many runs: only summaries are held, not records. */
int settings_many_runs(const struct options *o);

/* "peaks", "pot", "blocks", "runs" */
const char *sample_name(enum sample s);

#endif
