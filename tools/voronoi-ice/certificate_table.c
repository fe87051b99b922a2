/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <assert.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include "base/number_text.h"
#include "base/stream.h"
#include "certificate_table.h"

/* Distances below this are the rounding of sums and of corners far from the origin, and differ from machine
 * to machine: the terminal says no more than that they are below it. */
#define ROUNDING 1e-12

static struct certify_row *next(struct certify *c, const char *what, const char *note, va_list ap)
{
    assert(c->n < CERTIFY_ROWS);
    struct certify_row *r = &c->row[c->n++];
    *r = (struct certify_row){.asked = NAN, .achieved = NAN, .distance = NAN};
    snprintf(r->what, sizeof r->what, "%s", what);
    if (note) vsnprintf(r->note, sizeof r->note, note, ap);
    return r;
}

void certify_add(struct certify *c, const char *what, double asked, double achieved, double distance,
                 int digits, const char *note, ...)
{
    va_list ap;
    va_start(ap, note);
    struct certify_row *r = next(c, what, note, ap);
    va_end(ap);
    r->asked = asked;
    r->achieved = achieved;
    r->distance = distance;
    r->digits = digits;
}

void certify_add_word(struct certify *c, const char *what, const char *asked, const char *note, ...)
{
    va_list ap;
    va_start(ap, note);
    struct certify_row *r = next(c, what, note, ap);
    va_end(ap);
    snprintf(r->word, sizeof r->word, "%s", asked);
}

/* --- the terminal --------------------------------------------------------------------------------------- */

static void distance_text(double asked, double x, char *text, size_t size)
{
    if (isnan(x)) text[0] = '\0';
    else if (x == 0.0 && asked == floor(asked)) snprintf(text, size, "0");
    else if (x < ROUNDING) snprintf(text, size, "<%.0e", ROUNDING);
    else snprintf(text, size, "%.2g", x);
}

void certify_print(const struct certify *c)
{
    fprintf(stderr, "voronoi-ice: certificate\n%-32s %10s   %-14s %s\n", "", "asked", "achieved", "distance");
    for (int k = 0; k < c->n; k++) {
        const struct certify_row *r = &c->row[k];
        char asked[64] = "", achieved[64] = "", distance[32], line[400];
        size_t end;
        if (!isnan(r->asked)) snprintf(asked, sizeof asked, "%.10g", r->asked);
        if (!isnan(r->achieved)) snprintf(achieved, sizeof achieved, "%.*g", r->digits, r->achieved);
        distance_text(r->asked, r->distance, distance, sizeof distance);
        if (r->word[0]) /* too long for its column, and alone in the row */
            snprintf(line, sizeof line, "%-32s %10s   %s", r->what, r->word, r->note);
        else
            snprintf(line, sizeof line, "%-32s %10s   %-14s %-8s %s", r->what, asked, achieved, distance,
                     r->note);
        for (end = strlen(line); end && line[end - 1] == ' '; end--) line[end - 1] = '\0';
        fprintf(stderr, "%s\n", line);
    }
}

/* --- the file ------------------------------------------------------------------------------------------- */

static void put_word(FILE *f, const char *text, size_t len)
{
    int blank = 0;
    if (len == 0) putc('-', f);
    for (size_t k = 0; k < len; k++) {
        const int none = strchr(" ,:()", text[k]) != NULL;
        if (none && k + 1 < len) blank = 1;
        if (none) continue;
        if (blank) putc('-', f);
        blank = 0;
        putc(text[k], f);
    }
}

static void put_number(FILE *f, double x)
{
    char text[FL_NUMBER_LEN];
    fputs(isnan(x) ? "-" : fl_number_text(x, text), f);
}

int certify_write(const struct certify *c, const char *path, const fl_history_line *by, fl_err *err)
{
    fl_out out = {0};
    if (fl_out_open(&out, path, 0, err)) return -1;
    fl_write_file_header(out.f, "certificate", 1, NULL, by);
    fputs("quantity\tunit\tasked\tachieved\tdistance\tnote\n", out.f);
    for (int k = 0; k < c->n; k++) {
        const struct certify_row *r = &c->row[k];
        const char *unit = strchr(r->what, '['), *end = unit ? strchr(unit, ']') : NULL;
        put_word(out.f, r->what, unit ? (size_t)(unit - r->what) : strlen(r->what));
        putc('\t', out.f);
        if (end) put_word(out.f, unit + 1, (size_t)(end - unit - 1));
        else putc('-', out.f);
        putc('\t', out.f);
        if (r->word[0]) fputs(r->word, out.f);
        else put_number(out.f, r->asked);
        putc('\t', out.f);
        put_number(out.f, r->achieved);
        putc('\t', out.f);
        put_number(out.f, r->distance);
        putc('\t', out.f);
        put_word(out.f, r->note, strlen(r->note));
        putc('\n', out.f);
    }
    return fl_out_close(&out, err);
}
