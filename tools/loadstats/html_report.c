/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <ctype.h>
#include <dirent.h>
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include "base/array.h"
#include "base/gnuplot.h"
#include "base/number_text.h"
#include "base/stream.h"
#include "history_line.h"
#include "html_report.h"
#include "table_list.h"

enum { PATH_LEN = 4096, DIR_LEN = 3000, WORD_MAX = 200, LINE_MAX_SHOWN = 2000, ROWS_MAX = 400 };

/* Beyond this many record lengths a level is an extrapolation of the distribution. */
static const double REACH = 4.0;

static const char STYLE[] =
    "body { font: 15px/1.5 system-ui, sans-serif; color: #1a1a1a; max-width: 66rem; margin: 2.5rem auto; "
    "padding: 0 1.5rem; }\n"
    "h1 { font-size: 1.6rem; margin: 0 0 .3rem; }\n"
    "h2 { font-size: 1.15rem; margin: 2.4rem 0 .6rem; }\n"
    "p { max-width: 46rem; }\n"
    "div { overflow-x: auto; }\n"
    "table { border-collapse: collapse; font-size: .85rem; font-variant-numeric: tabular-nums; }\n"
    "th, td { padding: .22rem .7rem; text-align: right; white-space: nowrap; }\n"
    "th { font-weight: 600; border-bottom: 1px solid #888; }\n"
    "th:first-child, .word { text-align: left; }\n"
    "tr:nth-child(even) td { background: #f4f7fa; }\n"
    "tr.best td { font-weight: 600; }\n"
    "pre { background: #f4f7fa; padding: .8rem 1rem; white-space: pre-wrap; font-size: .82rem; }\n"
    "svg { width: 100%; height: auto; margin: .4rem 0 1.2rem; font: 14px sans-serif; }\n";

/* --- text ----------------------------------------------------------------------------------------------- */

static void write_text(FILE *f, const char *text)
{
    for (; *text; text++) {
        if (*text == '<') fputs("&lt;", f);
        else if (*text == '>') fputs("&gt;", f);
        else if (*text == '&') fputs("&amp;", f);
        else if (*text == '"') fputs("&quot;", f);
        else putc(*text, f);
    }
}

static void write_html_cell(FILE *f, const char *word)
{
    double x;
    if (fl_number_f64(word, &x) == 0) {
        fprintf(f, "<td>%.6g</td>", x);
    } else {
        fputs(strcmp(word, "-") == 0 ? "<td>" : "<td class=\"word\">", f);
        write_text(f, word);
        fputs("</td>", f);
    }
}

/* --- tables --------------------------------------------------------------------------------------------- */

/* A table of loadstats in memory, split into rows. */
typedef struct {
    char *text;
    char **row; /* [rows] the first one holds the column names */
    int32_t rows, cap;
} sheet;

static void sheet_free(sheet *s)
{
    free(s->text);
    free(s->row);
    *s = (sheet){0};
}

static int sheet_make(sheet *s, const report_source *from, const struct options *o, const struct table *table,
                      fl_err *err)
{
    struct options own = *o;
    size_t size = 0;
    own.table = table;
    own.quiet = 1; /* warnings were printed with the table itself */
    FILE *f = open_memstream(&s->text, &size);
    if (!f) return fl_fail(err, FL_SYSTEM, "out of memory");
    int rc = from->table(f, from->what, &own, err);
    if (fclose(f) != 0 && rc == 0) rc = fl_fail(err, FL_SYSTEM, "out of memory");
    for (char *line = s->text; rc == 0 && line && *line;) {
        char *end = strchr(line, '\n');
        if (end) *end++ = '\0';
        if (*line != '#') {
            rc = fl_grow(&s->row, &s->cap, (int64_t)s->rows + 1, sizeof *s->row, err);
            if (rc == 0) s->row[s->rows++] = line;
        }
        line = end;
    }
    return rc;
}

/* Copy the next field of a row; returns the start of the field after it, or NULL. */
static const char *next_word(const char *p, char word[WORD_MAX])
{
    const size_t len = strcspn(p, "\t"), take = len < WORD_MAX - 1 ? len : WORD_MAX - 1;
    memcpy(word, p, take);
    word[take] = '\0';
    return p[len] ? p + len + 1 : NULL;
}

static void field_of(const char *row, int k, char word[WORD_MAX])
{
    word[0] = '\0';
    for (const char *p = row; p && k >= 0; k--) p = next_word(p, word);
}

static int column_of(const sheet *s, const char *name)
{
    char word[WORD_MAX];
    int k = 0;
    for (const char *p = s->row[0]; p; k++) {
        p = next_word(p, word);
        if (strcmp(word, name) == 0) return k;
    }
    return -1;
}

static void write_column_names(FILE *f, const sheet *s)
{
    char word[WORD_MAX], below[WORD_MAX];
    double x;
    int k = 0;
    fputs("<tr>", f);
    for (const char *p = s->row[0]; p; k++) {
        p = next_word(p, word);
        field_of(s->row[1], k, below);
        fputs(fl_number_f64(below, &x) == 0 || strcmp(below, "-") == 0 ? "<th>" : "<th class=\"word\">", f);
        write_text(f, word);
        fputs("</th>", f);
    }
    fputs("</tr>\n", f);
}

static void write_html_row(FILE *f, const char *row, int best)
{
    char word[WORD_MAX];
    fputs(best ? "<tr class=\"best\">" : "<tr>", f);
    for (const char *p = row; p;) {
        p = next_word(p, word);
        write_html_cell(f, word);
    }
    fputs("</tr>\n", f);
}

static void write_all_rows(FILE *f, const sheet *s)
{
    const int32_t n = s->rows < ROWS_MAX ? s->rows : ROWS_MAX;
    fputs("<div><table>\n", f);
    write_column_names(f, s);
    for (int32_t k = 1; k < n; k++) write_html_row(f, s->row[k], 0);
    fputs("</table></div>\n", f);
    if (n < s->rows) fprintf(f, "<p>%d more rows are in the table itself.</p>\n", s->rows - n);
}

/* True if two rows of the table fits belong to the same sample. */
static int same_sample(const char *a, const char *b)
{
    enum { LABELS = 5 };
    char x[WORD_MAX], y[WORD_MAX];
    for (int k = 0; k < LABELS; k++) {
        field_of(a, k, x);
        field_of(b, k, y);
        if (strcmp(x, y) != 0) return 0;
    }
    return 1;
}

/* Only fits by likelihood, which have an AIC; the smallest one of each sample is in bold type. */
static void write_likelihood_fits(FILE *f, const sheet *s)
{
    const int aic = column_of(s, "AIC");
    char word[WORD_MAX];
    int laws = 0;
    double x;
    for (int32_t k = 1; k < s->rows; k++) {
        field_of(s->row[k], aic, word);
        laws += fl_number_f64(word, &x) == 0;
    }
    if (laws == 0) {
        fputs("<p>There are too few values to fit a distribution.</p>\n", f);
        return;
    }
    fputs("<p>By maximum likelihood; the distribution with the smallest AIC of each sample is in bold type. "
          "ks_p and ad_p are the probabilities that a sample of the distribution itself lies as far from its "
          "fit.</p>\n<div><table>\n",
          f);
    write_column_names(f, s);
    for (int32_t from = 1, to; from < s->rows; from = to) {
        double least = INFINITY;
        int32_t best = -1;
        for (to = from; to < s->rows && same_sample(s->row[from], s->row[to]); to++) {
            field_of(s->row[to], aic, word);
            if (fl_number_f64(word, &x) == 0 && x < least) {
                least = x;
                best = to;
            }
        }
        for (int32_t k = from; k < to; k++) {
            field_of(s->row[k], aic, word);
            if (fl_number_f64(word, &x) == 0) write_html_row(f, s->row[k], k == best);
        }
    }
    fputs("</table></div>\n", f);
}

/* A table of few rows and many columns is transposed, part by part. */
static void write_transposed(FILE *f, const sheet *s)
{
    enum { LABELS = 4 };
    char part[WORD_MAX], word[WORD_MAX], label[LABELS][WORD_MAX];
    for (int32_t from = 1, to; from < s->rows; from = to) {
        field_of(s->row[from], 0, part);
        for (to = from + 1; to < s->rows; to++) {
            field_of(s->row[to], 0, word);
            if (strcmp(word, part) != 0) break;
        }
        if (strcmp(part, "-") != 0) {
            fputs("<h3>", f);
            write_text(f, part);
            fputs("</h3>\n", f);
        }
        fputs("<div><table>\n<tr><th></th>", f);
        for (int32_t k = from; k < to; k++) {
            for (int i = 0; i < LABELS; i++) field_of(s->row[k], i, label[i]);
            fputs("<th>", f);
            write_text(f, label[1]);
            if (strcmp(label[2], "-") != 0) {
                fputs(" [", f);
                write_text(f, label[2]);
                putc(']', f);
            }
            fprintf(f, ", %s</th>", label[3]);
        }
        fputs("</tr>\n", f);
        int column = 0;
        for (const char *name = s->row[0]; name; column++) {
            name = next_word(name, word);
            if (column < LABELS) continue;
            fputs("<tr><td class=\"word\">", f);
            write_text(f, word);
            fputs("</td>", f);
            for (int32_t k = from; k < to; k++) {
                field_of(s->row[k], column, label[0]);
                write_html_cell(f, label[0]);
            }
            fputs("</tr>\n", f);
        }
        fputs("</table></div>\n", f);
    }
}

/* The warning that the table levels prints on standard error. */
static void write_extrapolation(FILE *f, double span, const struct options *o)
{
    double most = 0.0;
    for (int32_t k = 0; k < o->returns; k++) most = fmax(most, o->period[k]);
    if (most > REACH * span)
        fprintf(f,
                "<p>The record lasts for %.6g s. A return period of more than %g times that, here up to %.3g "
                "times, is an extrapolation of the fitted distribution.</p>\n",
                span, REACH, most / span);
}

/* The rows of an ensemble for 2, 5, tens and hundreds of runs, and the last one. */
static void write_some_runs(FILE *f, const sheet *s)
{
    const int runs = column_of(s, "runs");
    char word[WORD_MAX], next[WORD_MAX];
    fputs("<div><table>\n", f);
    write_column_names(f, s);
    for (int32_t k = 1; k < s->rows; k++) {
        field_of(s->row[k], runs, word);
        if (k + 1 < s->rows) field_of(s->row[k + 1], runs, next);
        double n = 0.0, then = 0.0;
        if (fl_number_f64(word, &n) || (k + 1 < s->rows && fl_number_f64(next, &then))) continue;
        const int last = then <= n, round = n == 2.0 || n == 5.0 || (n >= 10.0 && fmod(n, 10.0) == 0.0);
        if (last || (round && n <= 100.0) || (n > 100.0 && fmod(n, 100.0) == 0.0))
            write_html_row(f, s->row[k], 0);
    }
    fputs("</table></div>\n", f);
}

/* A field of a row by the name of its column, "" for none. */
static void field_named(const sheet *s, int32_t row, const char *name, char word[WORD_MAX])
{
    const int k = column_of(s, name);
    word[0] = '\0';
    if (k >= 0) field_of(s->row[row], k, word);
    if (strcmp(word, "-") == 0) word[0] = '\0';
}

static void write_field(FILE *f, const sheet *s, int32_t row, const char *name)
{
    char word[WORD_MAX];
    field_named(s, row, name, word);
    write_html_cell(f, word[0] ? word : "-");
}

/* Three digits or four, without an exponent where it can be. */
static const char *short_number(double x, char text[32])
{
    snprintf(text, 32, fabs(x) >= 100.0 && fabs(x) < 1e7 ? "%.0f" : "%.3g", x);
    return text;
}

/* "81.1 (51.8 to 110)" */
static void write_with_interval(FILE *f, const sheet *s, int32_t row, const char *name)
{
    char word[WORD_MAX], low[WORD_MAX], high[WORD_MAX], column[WORD_MAX];
    char short_x[32], short_a[32], short_b[32];
    double x, a, b;
    field_named(s, row, name, word);
    snprintf(column, sizeof column, "%s_low", name);
    field_named(s, row, column, low);
    snprintf(column, sizeof column, "%s_high", name);
    field_named(s, row, column, high);
    if (fl_number_f64(word, &x)) fputs("<td>&ndash;</td>", f);
    else if (fl_number_f64(low, &a) || fl_number_f64(high, &b))
        fprintf(f, "<td>%s</td>", short_number(x, short_x));
    else
        fprintf(f, "<td><b>%s</b> (%s to %s)</td>", short_number(x, short_x), short_number(a, short_a),
                short_number(b, short_b));
}

/* Values with their intervals, a row for each signal of each part. */
static void write_overview(FILE *f, const sheet *s)
{
    static const char *const PLAIN[] = {"min", "max", "q95", "std"};
    char period[WORD_MAX], word[WORD_MAX];
    double T = 0.0;
    field_named(s, 1, "T[s]", period);
    if (fl_number_f64(period, &T)) T = 0.0;
    fprintf(f,
            "<div><table>\n<tr><th>part</th><th class=\"word\">signal</th><th>mean "
            "(95&nbsp;%%)</th><th>smallest</th>"
            "<th>largest</th><th>95&nbsp;%% of time</th><th>std</th><th>peaks</th><th>once in %.4g s "
            "(95&nbsp;%%)</th>"
            "<th class=\"word\">law</th></tr>\n",
            T);
    for (int32_t k = 1; k < s->rows; k++) {
        fputs("<tr>", f);
        write_field(f, s, k, "part");
        fputs("<td class=\"word\">", f);
        field_named(s, k, "signal", word);
        write_text(f, word);
        field_named(s, k, "unit", word);
        fputs(word[0] ? " [" : "", f);
        write_text(f, word);
        fputs(word[0] ? "]" : "", f);
        field_named(s, k, "view", word);
        if (strcmp(word, "raw") != 0) fprintf(f, ", %s", word);
        fputs("</td>", f);
        write_with_interval(f, s, k, "mean");
        for (size_t i = 0; i < sizeof PLAIN / sizeof *PLAIN; i++) write_field(f, s, k, PLAIN[i]);
        write_field(f, s, k, "peaks");
        write_with_interval(f, s, k, "level");
        write_field(f, s, k, "law");
        fputs("</tr>\n", f);
    }
    fputs("</table></div>\n", f);
}

static int write_section(FILE *f, const report_source *from, const struct options *o,
                         const struct table *table, const char *heading, fl_err *err)
{
    sheet s = {0};
    const int rc = sheet_make(&s, from, o, table, err);
    if (rc == 0 && s.rows > 1) {
        fprintf(f, "<h2>%s</h2>\n", heading);
        if (table->uses & USES_RETURNS) write_extrapolation(f, from->span, o);
        if (table->report.note && !from->alone) fprintf(f, "<p>%s</p>\n", table->report.note);
        switch (table->report.layout) {
        case LAYOUT_TRANSPOSED: write_transposed(f, &s); break;
        case LAYOUT_FITS: write_likelihood_fits(f, &s); break;
        case LAYOUT_RUNS: write_some_runs(f, &s); break;
        case LAYOUT_OVERVIEW: write_overview(f, &s); break;
        case LAYOUT_ROWS: write_all_rows(f, &s); break;
        }
    }
    sheet_free(&s);
    return rc;
}

/* --- pictures ------------------------------------------------------------------------------------------- */

static int is_picture(const char *name)
{
    const size_t len = strlen(name);
    return len > 4 && strcmp(name + len - 4, ".svg") == 0;
}

static int is_picture_entry(const struct dirent *d) { return is_picture(d->d_name); }

/* DIR/NAME; dir is shorter than DIR_LEN. */
static void join_path(char path[PATH_LEN], const char *dir, const char *name)
{
    snprintf(path, PATH_LEN, "%.*s/%.*s", DIR_LEN, dir, PATH_LEN - DIR_LEN - 2, name);
}

/* Length of a colour as "rgb( 33, 113, 181)", which is written as #2171b5; 0: none is there. */
static size_t write_short_colour(FILE *f, const char *text)
{
    int red, green, blue, len = 0;
    if (strncmp(text, "rgb(", 4) != 0 || sscanf(text, "rgb(%d,%d,%d)%n", &red, &green, &blue, &len) != 3 ||
        !len)
        return 0;
    fprintf(f, "#%02x%02x%02x", (unsigned)red & 255u, (unsigned)green & 255u, (unsigned)blue & 255u);
    return (size_t)len;
}

/* Copy the text of a picture without groups that hold nothing, attributes that SVG or the page has anyway and
 * indents, with one decimal of a pixel in its paths and short colours: half of its size. */
static void write_small_svg(FILE *f, const char *text)
{
    static const char *const POINTS[] = {" d='", " points = '"}, *const USUAL[] = {
                                                                     " stroke-linecap=\"butt\"",
                                                                     " stroke-linejoin=\"miter\"",
                                                                     " stroke-width=\"1.00\"",
                                                                     " font-family=\"sans-serif\"",
                                                                     " font-size=\"14.00\""};
    int in_path = 0;
    while (*text) {
        for (size_t k = 0; k < sizeof USUAL / sizeof *USUAL; k++)
            if (strncmp(text, USUAL[k], strlen(USUAL[k])) == 0) text += strlen(USUAL[k]);
        if (*text == '\'') in_path = 0;
        for (size_t k = 0; k < sizeof POINTS / sizeof *POINTS; k++) {
            if (strncmp(text, POINTS[k], strlen(POINTS[k])) != 0) continue;
            fputs(POINTS[k], f);
            text += strlen(POINTS[k]);
            in_path = 1;
        }
        if (!*text) break;
        const size_t colour = write_short_colour(f, text);
        if (colour || *text == '\t') {
            text += colour ? colour : 1;
            continue;
        }
        if (strncmp(text, "<g ", 3) == 0) {
            const char *end = strchr(text, '>'), *inside = end ? end + 1 : text + strlen(text);
            inside += strspn(inside, "\n ");
            if (end && strncmp(inside, "</g>", 4) == 0) {
                text = inside + 4;
                text += *text == '\n';
                continue;
            }
        }
        if (in_path && text[0] == '.' && isdigit((unsigned char)text[1]) && isdigit((unsigned char)text[2]) &&
            !isdigit((unsigned char)text[3])) {
            if (text[1] != '0') fprintf(f, ".%c", text[1]);
            text += 3;
            continue;
        }
        if (text[0] == '\n' && text[1] == '\n') {
            text++;
            continue;
        }
        putc(*text++, f);
    }
}

/* The picture from its svg tag on, without the XML header of a separate file. */
static int write_picture(FILE *f, const char *dir, const char *name, fl_err *err)
{
    char path[PATH_LEN], *text = NULL;
    int32_t cap = 0;
    int64_t n = 0, k = 1;
    join_path(path, dir, name);
    fl_in *in = fl_in_open(path, err);
    while (in && k > 0) {
        k = fl_grow(&text, &cap, n + 65537, 1, err) ? -1 : fl_in_read(in, text + n, 65536, err);
        if (k > 0) n += k;
    }
    fl_in_close(in);
    if (in && k == 0) {
        text[n] = '\0';
        const char *tag = strstr(text, "<svg");
        if (tag) write_small_svg(f, tag);
        else k = fl_fail(err, FL_SYSTEM, "%s: gnuplot wrote no picture", name);
    }
    free(text);
    return in && k == 0 ? 0 : -1;
}

static int write_pictures(FILE *f, const char *dir, fl_err *err)
{
    struct dirent **list = NULL;
    const int n = scandir(dir, &list, is_picture_entry, alphasort);
    int rc = n < 0 ? fl_fail(err, FL_SYSTEM, "%s: %s", dir, strerror(errno)) : 0;
    if (n > 0) fputs("<h2>Pictures</h2>\n", f);
    else fputs("<p>gnuplot was not found when this page was made: it has no pictures.</p>\n", f);
    for (int k = 0; k < n; k++) {
        if (rc == 0) rc = write_picture(f, dir, list[k]->d_name, err);
        free(list[k]);
    }
    free(list);
    return rc;
}

static void remove_folder(const char *dir)
{
    char path[PATH_LEN];
    DIR *d = opendir(dir);
    for (struct dirent *e; d && (e = readdir(d));) {
        if (strcmp(e->d_name, ".") == 0 || strcmp(e->d_name, "..") == 0) continue;
        join_path(path, dir, e->d_name);
        unlink(path);
    }
    if (d) closedir(d);
    rmdir(dir);
}

/* --- the page ------------------------------------------------------------------------------------------- */

/* The lines that begin with a word, without it. */
static void write_lines_of(FILE *f, const char *lines, const char *word)
{
    char line[LINE_MAX_SHOWN];
    const size_t skip = strlen(word);
    for (const char *p = lines; p && *p; p = strchr(p, '\n') + 1) {
        if (strncmp(p, word, skip) != 0) continue;
        snprintf(line, sizeof line, "%.*s", (int)strcspn(p + skip, "\n"), p + skip);
        write_text(f, line);
        putc('\n', f);
    }
}

static void write_head(FILE *f, const report_source *from, const struct options *o)
{
    fputs("<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" "
          "content=\"width=device-width, initial-scale=1\">\n",
          f);
    fprintf(f, "<title>%s</title>\n<style>\n%s</style>\n</head>\n<body>\n<h1>%s</h1>\n<p>", from->title,
            STYLE, from->title);
    from->intro(f, from->what);
    fputs("</p>\n", f);
    if (from->history && strstr(from->history, "#stopped ")) {
        fputs("<p><strong>A run stopped early:</strong> ", f);
        write_lines_of(f, from->history, "#stopped ");
        fputs("</p>\n", f);
    }
    if (o->page) {
        fputs("<p><a href=\"", f);
        write_text(f, o->page);
        fputs("\">The ice in motion</a>, a page of ice-view.</p>\n", f);
    }
}

/* Data and options that are available for the report, table_need. */
static unsigned available(const report_source *from, const struct options *o)
{
    return (from->many ? NEEDS_RUNS : NEEDS_RECORD) | (from->legs ? NEEDS_PARTS : 0u) |
           (from->spectra ? NEEDS_SEGMENT : 0u) | (o->returns ? NEEDS_RETURNS : 0u) |
           (o->oscillators ? NEEDS_OSCILLATOR : 0u);
}

/* True if the report holds the table whichever --table is chosen. */
static int is_standard(const struct table *t, const report_source *from, const struct options *o)
{
    return t->report.position && ((t->needs | t->report.needs) & ~available(from, o)) == 0;
}

/* The scene of the run, as far as it differs from defaults, and its closing report. */
static void write_run(FILE *f, const report_source *from)
{
    if (!from->run_lines) return;
    fputs(
        "<h2>The run</h2>\n<p>Keys of the scene that differ from their defaults, scene(5); dem-solve --again "
        "makes a scene of them.</p>\n<pre>",
        f);
    write_lines_of(f, from->run_lines, "#set ");
    fputs("</pre>\n<p>The closing report of the run, dem-solve(1).</p>\n<pre>", f);
    write_lines_of(f, from->run_lines, "#report ");
    write_lines_of(f, from->history, "#stopped ");
    fputs("</pre>\n", f);
}

/* What a reviewer asks of a load report: what this page has, and what its author adds. */
static void write_review_list(FILE *f, const report_source *from)
{
    static const char *const HAS[] = {"statistics with intervals, fits and their rank, peaks of all parts",
                                      "time history",
                                      "scene, step, stiffness, residuals, overlaps and warnings",
                                      "programs, versions, input and options, and how to repeat the run"};
    static const char *const ADD[] = {
        "basis and edition of the rules; site ice and the source of each value",
        "which scene this is and what bounds its load: momentum, driving force or crushing",
        "drawing of the geometry, draft, axes, points about which moments act",
        "convergence: seeds, width and length of the field, floe size, stiffness, step",
        "sensitivity to concentration, thickness, speed and friction",
        "closed forms and measurements beside the numbers; local pressure against ISO 19906",
        "a close-up of the largest event; fatigue cycles where they count",
        "what is not modelled; the events a year of this scene, without which a maximum is no design load"};
    fputs("<h2>For a load report</h2>\n<p>On this page:</p>\n<ul>\n", f);
    for (size_t k = 0; k < sizeof HAS / sizeof *HAS; k++)
        if (k != 2 || from->run_lines) fprintf(f, "<li>%s</li>\n", HAS[k]);
    fputs("</ul>\n<p>To be added by its author:</p>\n<ul>\n", f);
    for (size_t k = 0; k < sizeof ADD / sizeof *ADD; k++) fprintf(f, "<li>%s</li>\n", ADD[k]);
    fputs("</ul>\n", f);
}

static void write_end(FILE *f, const report_source *from, const fl_history_line *by)
{
    write_run(f, from);
    if (!from->alone) write_review_list(f, from);
    fputs("<h2>How to reproduce it</h2>\n<p>The programs in the order in which they ran, with their options; "
          "the same line gives the same bytes. Numbers above are rounded to six digits; the tables that "
          "loadstats prints have all of them. loadstats(1) says how they are defined.</p>\n<pre>",
          f);
    if (from->history) write_text(f, from->history);
    write_text(f, by->text);
    fputs("\n</pre>\n</body>\n</html>\n", f);
}

static int write_page(FILE *f, const char *dir, const report_source *from, const struct options *o,
                      const fl_history_line *by, fl_err *err)
{
    const struct table *t;
    write_head(f, from, o);
    if (from->alone) {
        if (write_pictures(f, dir, err) || write_section(f, from, o, o->table, "Numbers", err)) return -1;
        write_end(f, from, by);
        return 0;
    }
    for (int k = 1; (t = table_in_report(k)); k++) {
        const char *heading =
            from->many && t->report.heading_of_runs ? t->report.heading_of_runs : t->report.heading;
        if (is_standard(t, from, o) && write_section(f, from, o, t, heading, err)) return -1;
        if (k == 1 && write_pictures(f, dir, err)) return -1;
    }
    if (!is_standard(o->table, from, o) && write_section(f, from, o, o->table, o->table->name, err))
        return -1;
    write_end(f, from, by);
    return 0;
}

/* The page is made in memory, so that the folder of the pictures is removed before anything is written: a
 * reader that closes the pipe ends the program. */
static int make_page(char **text, size_t *size, const report_source *from, const struct options *o,
                     fl_err *err)
{
    const char *tmp = getenv("TMPDIR");
    char dir[PATH_LEN];
    struct options own = *o;
    fl_history_line by;
    int rc = -1;
    snprintf(dir, sizeof dir, "%.*s/loadstats-XXXXXX", DIR_LEN - 20, tmp && *tmp ? tmp : "/tmp");
    if (!mkdtemp(dir)) return fl_fail(err, FL_SYSTEM, "%s: %s", dir, strerror(errno));
    own.report_page = 1;
    history_line_run(&own, &by); /* report_page also selects all pictures */
    own.plot = dir;
    own.format = "svg";
    own.quiet = 1;
    const int draws = fl_gnuplot_is_there();
    if (!draws && !o->quiet) fputs("loadstats: gnuplot was not found: the report has no pictures\n", stderr);
    if (!draws || from->draw(from->what, &own, err) == 0) {
        FILE *f = open_memstream(text, size);
        rc = f ? write_page(f, dir, from, o, &by, err) : fl_fail(err, FL_SYSTEM, "out of memory");
        if (f && fclose(f) != 0 && rc == 0) rc = fl_fail(err, FL_SYSTEM, "out of memory");
    }
    remove_folder(dir);
    return rc;
}

int html_report_write(const report_source *from, const struct options *o, fl_err *err)
{
    fl_out out = {0};
    char *text = NULL;
    size_t size = 0;
    int rc = make_page(&text, &size, from, o, err) ? -1 : fl_out_open(&out, o->report, 0, err);
    if (rc == 0) {
        fwrite(text, 1, size, out.f);
        rc = fl_out_close(&out, err);
    }
    fl_out_abort(&out);
    free(text);
    return rc;
}
