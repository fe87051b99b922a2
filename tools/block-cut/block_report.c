/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "block_report.h"
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "base/number_text.h"
#include "base/stream.h"

/* Relative errors of sums of some thousand terms, each right to a few roundings. */
static const double VOLUME_TOL = 1e-11, AREA_TOL = 1e-7;

struct block_row {
    char quantity[100];
    const char *unit, *note;
    double expected, found; /* NAN: none */
};

struct block_table {
    int32_t n, cap;
    struct block_row *row;
    int failed;
};

static void put_row(struct block_table *t, const char *unit, double expected, double found, const char *note,
                    const char *quantity, ...) __attribute__((format(printf, 6, 7)));
static void put_row(struct block_table *t, const char *unit, double expected, double found, const char *note,
                    const char *quantity, ...)
{
    va_list ap;
    if (fl_grow_quiet(&t->row, &t->cap, (int64_t)t->n + 1, sizeof *t->row)) {
        t->failed = 1;
        return;
    }
    struct block_row *r = &t->row[t->n++];
    *r = (struct block_row){.unit = unit, .note = note, .expected = expected, .found = found};
    va_start(ap, quantity);
    vsnprintf(r->quantity, sizeof r->quantity, quantity, ap);
    va_end(ap);
}

static double expected_blocks(const fl_block_certificate *c)
{
    return c->full && !c->special ? (double)(c->pieces + c->planes + c->lines + c->points) : (double)NAN;
}

static void add_counts(struct block_table *t, const struct result *r)
{
    const fl_block_certificate *c = &r->certificate;
    put_row(t, "", NAN, (double)c->pieces, "convex", "pieces of the model");
    put_row(t, "", NAN, (double)c->planes, "", "planes through pieces");
    put_row(t, "", NAN, (double)c->lines, "", "lines through pieces");
    put_row(t, "", NAN, (double)c->points, c->special ? "planes in special position" : "",
            "points inside pieces");
    put_row(t, "", expected_blocks(c), c->blocks,
            !c->full     ? "persistence"
            : c->special ? "special position, no count"
                         : "pieces + planes + lines + points",
            "blocks cut");
    put_row(t, "m3", r->model.volume, c->volume, "", "volume");
    put_row(t, "m3", NAN, c->least, "", "volume, smallest block");
    put_row(t, "m3", NAN, c->most, "", "volume, largest block");
    put_row(t, "m6", NAN, c->square_sum, "", "sum of squared volumes");
    put_row(t, "", NAN, c->least_faces, "", "faces of a block, fewest");
    put_row(t, "", NAN, c->most_faces, "", "faces of a block, most");
}

static void add_sets(struct block_table *t, const struct result *r)
{
    const fl_block_certificate *c = &r->certificate;
    for (int32_t s = 0; s < r->sets.n; s++) {
        put_row(t, "m2", c->full ? c->section[s] : (double)NAN, c->area[s],
                c->full ? "sections of its planes" : "", "area of joint %s", r->sets.set[s].name);
        if (c->intact[s] > 0.0)
            put_row(t, "m2", NAN, c->intact[s], "", "intact area of joint %s", r->sets.set[s].name);
    }
    if (c->surfaces > 0.0) put_row(t, "m2", NAN, c->surfaces, "between pieces", "intact area of surfaces");
}

static void add_results(struct block_table *t, const struct result *r)
{
    if (r->deleted) {
        put_row(t, "", NAN, r->deleted, "", "blocks deleted");
        put_row(t, "m3", NAN, r->deleted_volume, "", "volume deleted");
    }
    put_row(t, "m", NAN, r->radius, "", "dilation radius");
    put_row(t, "m", NAN, r->min_thickness, "thinner ones are slivers", "least thickness");
    put_row(t, "", NAN, r->slivers.n, "", "slivers");
    put_row(t, "", NAN, r->slivers.merged, "", "slivers merged");
    put_row(t, "m3", NAN, r->slivers.lost, "", "volume of slivers left out");
    put_row(t, "", NAN, r->model.n, "", "blocks written");
    put_row(t, "", NAN, r->joints, "", "joints written");
    if (r->lost_joints) {
        put_row(t, "", 0.0, r->lost_joints, "the core has lost their face", "joints left out");
        put_row(t, "m2", 0.0, r->lost_area, "", "area of joints left out");
    }
}

static int make_table(struct block_table *t, const struct result *r)
{
    *t = (struct block_table){0};
    add_counts(t, r);
    add_sets(t, r);
    add_results(t, r);
    return t->failed ? -1 : 0;
}

/* Words of a table have no blanks. */
static void put_word(FILE *f, const char *text)
{
    if (!*text) putc('-', f);
    for (; *text; text++)
        if (*text != ',') putc(*text == ' ' ? '-' : *text, f);
}

static void put_number(FILE *f, double x)
{
    char text[FL_NUMBER_LEN];
    fputs(isnan(x) ? "-" : fl_number_text(x, text), f);
}

int block_report_write(const struct options *o, const struct result *r, const fl_history_line *by,
                       fl_err *err)
{
    struct block_table t;
    fl_out out = {0};
    int rc = make_table(&t, r) ? fl_fail(err, FL_SYSTEM, "out of memory")
                               : fl_out_open(&out, o->certificate, 0, err);
    if (rc == 0) {
        fl_write_file_header(out.f, "certificate", 1, NULL, by);
        fputs("quantity\tunit\tasked\tachieved\tdistance\tnote\n", out.f);
        for (int32_t k = 0; k < t.n; k++) {
            const struct block_row *row = &t.row[k];
            put_word(out.f, row->quantity);
            putc('\t', out.f);
            put_word(out.f, row->unit);
            putc('\t', out.f);
            put_number(out.f, row->expected);
            putc('\t', out.f);
            put_number(out.f, row->found);
            putc('\t', out.f);
            put_number(out.f, fabs(row->found - row->expected));
            putc('\t', out.f);
            put_word(out.f, row->note);
            putc('\n', out.f);
        }
        rc = fl_out_close(&out, err);
    }
    fl_out_abort(&out);
    free(t.row);
    return rc;
}

void block_report_print(const struct options *o, const struct result *r)
{
    struct block_table t;
    if (make_table(&t, r) == 0) {
        fprintf(stderr, "block-cut: certificate\n%-34s %16s   %-16s\n", "", "expected", "found");
        for (int32_t k = 0; k < t.n; k++) {
            const struct block_row *row = &t.row[k];
            char name[120], expected[40] = "", found[40], line[300];
            snprintf(name, sizeof name, "%s%s%s%s", row->quantity, *row->unit ? " [" : "", row->unit,
                     *row->unit ? "]" : "");
            if (!isnan(row->expected)) snprintf(expected, sizeof expected, "%.9g", row->expected);
            snprintf(found, sizeof found, "%.9g", row->found);
            snprintf(line, sizeof line, "%-34s %16s   %-16s %s", name, expected, found, row->note);
            size_t end = strlen(line);
            while (end && line[end - 1] == ' ') line[--end] = '\0';
            fprintf(stderr, "%s\n", line);
        }
    }
    free(t.row);
    for (int32_t k = 0; k < r->slivers.n && o->verbose; k++) {
        const fl_sliver *s = &r->slivers.sliver[k];
        fprintf(stderr, "sliver at (%.6g, %.6g, %.6g): %.6g m thick, %.6g m3, %s\n", s->x.x, s->x.y, s->x.z,
                s->width, s->volume,
                s->merged         ? "merged"
                : o->keep_slivers ? "kept"
                                  : "left out");
    }
}

int block_report_answer(const struct result *r, fl_err *err)
{
    const fl_block_certificate *c = &r->certificate;
    const double blocks = expected_blocks(c);
    if (!isnan(blocks) && blocks != c->blocks)
        return fl_fail(err, FL_NUMERIC, "%d blocks are cut, the count of planes, lines and points is %.0f",
                       c->blocks, blocks);
    if (fabs(c->volume - r->model.volume) > VOLUME_TOL * r->model.volume)
        return fl_fail(err, FL_NUMERIC, "the blocks have %.15g m3 together, the model %.15g m3", c->volume,
                       r->model.volume);
    for (int32_t s = 0; s < r->sets.n && c->full; s++)
        if (fabs(c->area[s] - c->section[s]) > AREA_TOL * c->section[s])
            return fl_fail(err, FL_NUMERIC, "joint %s has %.9g m2 of faces, %.9g m2 of sections",
                           r->sets.set[s].name, c->area[s], c->section[s]);
    return 0;
}
