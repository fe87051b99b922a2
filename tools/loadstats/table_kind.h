/* SPDX-License-Identifier: GPL-3.0-or-later */
/* table_kind.h -- a kind of table: its columns, its rows, its picture, its needs and its place in the report.
 *
 * table_list.c holds one entry for each kind.  Options, history line, pictures and report read the entry, so
 * a new table is its rows and one entry. */
#ifndef LOADSTATS_TABLE_KIND_H
#define LOADSTATS_TABLE_KIND_H
#include "base/err.h"
#include "base/tool.h"
#include "cell.h"
#include "settings.h"

struct load_map;
struct load_picture;
struct picture_kind;
struct run_set;

/* Where the rows come from: a record, a table of contacts or panels, or the summaries of runs. */
enum table_source { FROM_RECORD, FROM_CONTACTS, FROM_RUNS };

/* Options that change the rows; they stand in the history line. */
enum table_option {
    USES_AREAS = 1 << 0,
    USES_BINS = 1 << 1,
    USES_BLOCK = 1 << 2,
    USES_HEIGHTS = 1 << 3,
    USES_LEVEL = 1 << 4,
    USES_OSCILLATOR = 1 << 5,
    USES_QUANTILES = 1 << 6,
    USES_RETURNS = 1 << 7,
    USES_RULE = 1 << 8,
    USES_SAMPLE = 1 << 9,
    USES_SEGMENT = 1 << 10,
    USES_SN = 1 << 11,
    USES_SPEED = 1 << 12,
    USES_WATERLINE = 1 << 13
};

/* Options without which a table does not exist, and data without which the report omits it. */
enum table_need {
    NEEDS_OSCILLATOR = 1 << 0,
    NEEDS_RETURNS = 1 << 1,
    NEEDS_WATERLINE = 1 << 2,
    NEEDS_PARTS = 1 << 3,   /* two parts or more */
    NEEDS_RECORD = 1 << 4,  /* one whole record */
    NEEDS_RUNS = 1 << 5,    /* many runs */
    NEEDS_SEGMENT = 1 << 6, /* rows for one segment of a spectrum or more */
};

/* How the report prints a table: as it is; transposed, part by part; fits by likelihood only, the best one in
 * bold; a selection of the numbers of runs; or intervals in one cell with their values. */
enum report_layout { LAYOUT_ROWS, LAYOUT_TRANSPOSED, LAYOUT_FITS, LAYOUT_RUNS, LAYOUT_OVERVIEW };

struct table {
    const char *name; /* of --table; also the kind of the file */
    enum table_source source;
    unsigned uses, needs; /* table_option, table_need */
    const char *columns;  /* names, separated by tabs; NULL where the rows bring them */
    /* Print further columns, whose names depend on options; may be NULL. */
    void (*more_columns)(FILE *f, const struct options *o);

    /* The rows, by one of the following.  0, or -1 with err. */
    /* Of one view of a signal of a part. */
    int (*view_rows)(FILE *f, const struct record_views *r, const struct options *o, int32_t part,
                     int32_t signal, int w, fl_err *err);
    /* Of all views of a signal of a part. */
    int (*signal_rows)(FILE *f, const struct record_views *r, const struct options *o, int32_t part,
                       int32_t signal, fl_err *err);
    int by_signal; /* print signal by signal, then part by part; else the other way round */
    /* Of one entry of the summary of many runs. */
    int (*run_rows)(FILE *f, const struct run_set *runs, int32_t entry, const struct options *o, fl_err *err);
    int follows; /* run_rows may be printed while a record grows */
    int per_run; /* run_rows need the values of each run beside the summary of all */
    /* Of contacts or panels. */
    void (*contact_rows)(FILE *f, const struct load_map *p);

    const struct picture_kind *picture;         /* of a record, or NULL */
    const struct load_picture *contact_picture; /* of contacts or panels */
    int (*draw_runs)(const struct run_set *runs, const struct options *o, const fl_history_line *by,
                     fl_err *err); /* or NULL */

    struct {
        int position;   /* 1, 2, ... among the tables that every report has; 0 for none */
        unsigned needs; /* beyond those of the table; its picture has them too */
        const char *heading, *heading_of_runs; /* the second one may be NULL */
        const char *note;                      /* HTML below the heading, or NULL */
        enum report_layout layout;
    } report;
};

/* Print the line of column names. */
void table_write_columns(FILE *f, const struct options *o);

#endif
