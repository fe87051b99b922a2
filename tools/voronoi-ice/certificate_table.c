/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "certificate_table.h"
#include <assert.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include "base/number_text.h"
#include "base/stream.h"

/* Distances below this are rounding of sums and of coordinates far from the origin, and depend on the
 * machine: the terminal says only that they are below. */
#define ROUNDING 1e-12

static struct certificate_row *append_row(struct certificate_table *c, const char *quantity, const char *note,
                                          va_list ap)
{
    assert(c->n < CERTIFICATE_ROWS);
    struct certificate_row *r = &c->row[c->n++];
    *r = (struct certificate_row){.requested = NAN, .achieved = NAN, .distance = NAN};
    snprintf(r->quantity, sizeof r->quantity, "%s", quantity);
    if (note) vsnprintf(r->note, sizeof r->note, note, ap);
    return r;
}

void certificate_add(struct certificate_table *c, const char *quantity, double requested, double achieved,
                     double distance, int digits, const char *note, ...)
{
    va_list ap;
    va_start(ap, note);
    struct certificate_row *r = append_row(c, quantity, note, ap);
    va_end(ap);
    r->requested = requested;
    r->achieved = achieved;
    r->distance = distance;
    r->digits = digits;
}

void certificate_add_text(struct certificate_table *c, const char *quantity, const char *requested,
                          const char *note, ...)
{
    va_list ap;
    va_start(ap, note);
    struct certificate_row *r = append_row(c, quantity, note, ap);
    va_end(ap);
    snprintf(r->text, sizeof r->text, "%s", requested);
}

/* --- the terminal --------------------------------------------------------------------------------------- */

static void print_distance(double asked, double x, char *text, size_t size)
{
    if (isnan(x)) text[0] = '\0';
    else if (x == 0.0 && asked == floor(asked)) snprintf(text, size, "0");
    else if (x < ROUNDING) snprintf(text, size, "<%.0e", ROUNDING);
    else snprintf(text, size, "%.2g", x);
}

void certificate_print(const struct certificate_table *c)
{
    fprintf(stderr, "voronoi-ice: certificate\n%-32s %10s   %-14s %s\n", "", "asked", "achieved", "distance");
    for (int k = 0; k < c->n; k++) {
        const struct certificate_row *r = &c->row[k];
        char asked[64] = "", achieved[64] = "", distance[32], line[400];
        size_t end;
        if (!isnan(r->requested)) snprintf(asked, sizeof asked, "%.10g", r->requested);
        if (!isnan(r->achieved)) snprintf(achieved, sizeof achieved, "%.*g", r->digits, r->achieved);
        print_distance(r->requested, r->distance, distance, sizeof distance);
        if (r->text[0]) /* too long for its column, and alone in the row */
            snprintf(line, sizeof line, "%-32s %10s   %s", r->quantity, r->text, r->note);
        else
            snprintf(line, sizeof line, "%-32s %10s   %-14s %-8s %s", r->quantity, asked, achieved, distance,
                     r->note);
        for (end = strlen(line); end && line[end - 1] == ' '; end--) line[end - 1] = '\0';
        fprintf(stderr, "%s\n", line);
    }
}

/* --- the file ------------------------------------------------------------------------------------------- */

static void write_word(FILE *f, const char *text, size_t len)
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

static void write_number(FILE *f, double x)
{
    char text[FL_NUMBER_LEN];
    fputs(isnan(x) ? "-" : fl_number_text(x, text), f);
}

int certificate_write(const struct certificate_table *c, const char *path, const fl_history_line *by,
                      fl_err *err)
{
    fl_out out = {0};
    if (fl_out_open(&out, path, 0, err)) return -1;
    fl_write_file_header(out.f, "certificate", 1, NULL, by);
    fputs("quantity\tunit\tasked\tachieved\tdistance\tnote\n", out.f);
    for (int k = 0; k < c->n; k++) {
        const struct certificate_row *r = &c->row[k];
        const char *unit = strchr(r->quantity, '['), *end = unit ? strchr(unit, ']') : NULL;
        write_word(out.f, r->quantity, unit ? (size_t)(unit - r->quantity) : strlen(r->quantity));
        putc('\t', out.f);
        if (end) write_word(out.f, unit + 1, (size_t)(end - unit - 1));
        else putc('-', out.f);
        putc('\t', out.f);
        if (r->text[0]) fputs(r->text, out.f);
        else write_number(out.f, r->requested);
        putc('\t', out.f);
        write_number(out.f, r->achieved);
        putc('\t', out.f);
        write_number(out.f, r->distance);
        putc('\t', out.f);
        write_word(out.f, r->note, strlen(r->note));
        putc('\n', out.f);
    }
    return fl_out_close(&out, err);
}
