/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "pack_report.h"
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include "base/number_text.h"
#include "base/stream.h"

enum { ROWS = 64 + 512 };

struct row {
    char quantity[80], unit[8], note[80];
    double asked, achieved; /* NAN: none */
    int digits;
};

struct table {
    int n;
    struct row row[ROWS];
};

static void add_row(struct table *t, const char *unit, double asked, double achieved, int digits,
                    const char *note, const char *quantity, ...) __attribute__((format(printf, 7, 8)));
static void add_row(struct table *t, const char *unit, double asked, double achieved, int digits,
                    const char *note, const char *quantity, ...)
{
    if (t->n == ROWS) return;
    struct row *r = &t->row[t->n++];
    va_list ap;
    *r = (struct row){.asked = asked, .achieved = achieved, .digits = digits};
    va_start(ap, quantity);
    vsnprintf(r->quantity, sizeof r->quantity, quantity, ap);
    va_end(ap);
    snprintf(r->unit, sizeof r->unit, "%s", unit);
    snprintf(r->note, sizeof r->note, "%s", note);
}

static void add_density(struct table *t, const struct options *o, const struct result *r)
{
    const fl_packing_certificate *c = &r->certificate;
    const int dim = r->packing.dim;
    const char *const volume = dim == 2 ? "m2" : "m3";
    add_row(t, volume, NAN, r->region.volume, 8, "", "region");
    add_row(t, "", o->number ? (double)o->number : (double)NAN, r->packing.n, 10, "", "bodies");
    add_row(t, "", 1.0 - r->asked, 1.0 - c->solid, 6, "", "porosity");
    add_row(t, "", r->asked, c->solid, 6, r->packing.q ? "outer sharp shapes" : "", "solid part");
    if (r->packing.q) add_row(t, "", NAN, c->rounded, 6, "rounded shapes, Steiner", "solid part, rounded");
    add_row(t, "", 1.0, r->packing.s, 8, r->growth.jammed ? "jammed" : "", "scale of the radii");
    if (r->growth.jam_scale > 0.0) {
        const double s = r->growth.jam_scale, phi = fl_packing_volume(&r->packing, s, 0) / r->region.volume;
        add_row(t, "", NAN, phi, 6, "where the pressure vanishes", "solid part, densest");
    }
    add_row(t, "", NAN, 1.0 - r->packing.s * r->growth.trimmed, 4,
            r->growth.trimmed < 1.0 ? "near helper walls" : "", "trimmed of the radii");
}

static void add_grading(struct table *t, const struct options *o, const struct result *r)
{
    const fl_packing_certificate *c = &r->certificate;
    const double least = options_graded(o) ? fl_grading_least(&r->grading) : NAN,
                 most = options_graded(o) ? fl_grading_most(&r->grading) : NAN;
    add_row(t, "m", least, c->least, 6, "", "size, smallest");
    add_row(t, "m", most, c->most, 6, "", "size, largest");
    if (!options_graded(o) || r->grading.n) return;
    add_row(t, "", 0.0, c->mass_gap, 3, "largest distance of the curves", "grading by mass");
    add_row(t, "", 0.0, c->count_gap, 3, "largest distance of the curves", "grading by number");
    add_row(t, "", NAN, c->largest_share, 3, "", "mass in the largest body");
    if (r->empty) add_row(t, "", 0.0, r->empty, 4, "less than half a body each", "sieves without a body");
    for (int32_t k = 0; k < r->grading.pieces && r->grading.pieces > 1 && !r->layers.n; k++) {
        const double d = r->grading.piece[k].hi;
        double below = 0.0, all = 0.0;
        for (int32_t i = 0; i < r->packing.n; i++) {
            const double v = pow(r->packing.size[i], r->packing.dim);
            all += v;
            if (r->packing.size[i] <= d) below += v;
        }
        add_row(t, "", fl_grading_mass(&r->grading, r->packing.dim, d), below / all, 6, "before trimming",
                "passing %.6g m", d);
    }
}

static void add_layers(struct table *t, const struct result *r)
{
    for (int32_t k = 0; k <= r->layers.n && r->layers.n; k++) {
        const fl_packing_layer l = r->layer[k];
        char name[24];
        if (r->layers.part[k] == 0.0 || r->layers.grading[k].pieces == 0) continue;
        snprintf(name, sizeof name, k < r->layers.n ? "layer %d" : "rest", k + 1);
        add_row(t, "", NAN, r->layers.part[k], 6, "of the region", "%s, part", name);
        add_row(t, "", NAN, l.bodies, 10, "", "%s, bodies", name);
        add_row(t, "", r->asked, l.volume / (r->layers.part[k] * r->region.volume), 4, "of centres in it",
                "%s, solid part", name);
        add_row(t, "m", fl_grading_least(&r->layers.grading[k]), l.least, 6, "", "%s, smallest", name);
        add_row(t, "m", fl_grading_most(&r->layers.grading[k]), l.most, 6, "", "%s, largest", name);
        add_row(t, "", 0.0, l.mass_gap, 3, "largest distance of the curves", "%s, grading by mass", name);
    }
}

static void add_contacts(struct table *t, const struct result *r)
{
    const fl_packing_certificate *c = &r->certificate;
    add_row(t, "", 0.0, c->max_overlap, 3, "over the smaller radius", "overlap, largest");
    add_row(t, "m", NAN, c->mean_overlap, 3, "", "overlap, mean");
    if (r->rest.steps == 0) /* weight is no force of the overlaps */
        add_row(t, "", 0.0, c->unbalanced, 3, "over the mean force", "unbalanced force, largest");
    for (int32_t k = 0; k < r->region.walls && k < 512; k++)
        add_row(t, "", NAN, c->mean_overlap > 0.0 ? r->overlaps.wall_force[k] / c->mean_overlap : 0.0, 6,
                r->region.wall[k].helper ? "helper, over the mean force" : "over the mean force",
                "force on %s", r->region.wall[k].name);
    add_row(t, "", NAN, (double)c->contacts, 10, "", "contacts");
    add_row(t, "", NAN, c->coordination, 5, "", "contacts of a body");
    add_row(t, "", NAN, c->without_rattlers, 5, "", "contacts without rattlers");
    add_row(t, "", NAN, c->rattlers, 10, "", "rattlers");
    for (int k = 0; k < r->packing.dim; k++)
        add_row(t, "", 1.0 / r->packing.dim, c->fabric[k], 4, "of contacts between bodies",
                "fabric, value %d", k + 1);
    if (r->packing.dim == 3)
        add_row(t, "", NAN, c->q6, 3, c->q6 > 0.1 && c->contacts > 500 ? "crystal" : "", "order Q6");
    add_row(t, "", 1.0, c->room, 6, "over the radius", "distance from outside, least");
    add_row(t, "", 0.0, c->outside, 10, "", "bodies outside");
    if (r->rest.steps) {
        add_row(t, "s", NAN, r->rest.time, 5, r->rest.settled ? "at rest" : "not at rest",
                "time under gravity");
        add_row(t, "", 1e-3, r->rest.speed, 3, "over sqrt(g d)", "speed, root mean square");
    }
    if (r->moved.steps) add_row(t, "", NAN, (double)r->moved.steps, 10, "", "steps of growth");
    add_row(t, "", NAN, (double)r->overlaps.steps, 10, "", "steps of relaxation");
}

static void make_table(struct table *t, const struct options *o, const struct result *r)
{
    t->n = 0;
    add_density(t, o, r);
    add_grading(t, o, r);
    add_layers(t, r);
    add_contacts(t, r);
}

/* Words of a table have no blanks. */
static void put_word(FILE *f, const char *text)
{
    if (!*text) putc('-', f);
    for (; *text; text++) {
        if (*text == ',' || *text == '(' || *text == ')') continue;
        putc(*text == ' ' ? '-' : *text, f);
    }
}

static void put_number(FILE *f, double x)
{
    char text[FL_NUMBER_LEN];
    fputs(isnan(x) ? "-" : fl_number_text(x, text), f);
}

int report_write(const struct options *o, const struct result *r, const fl_history_line *by, fl_err *err)
{
    static struct table t;
    fl_out out = {0};
    make_table(&t, o, r);
    if (fl_out_open(&out, o->certificate, 0, err)) return -1;
    fl_write_file_header(out.f, "certificate", 1, NULL, by);
    fputs("quantity\tunit\tasked\tachieved\tdistance\tnote\n", out.f);
    for (int k = 0; k < t.n; k++) {
        const struct row *row = &t.row[k];
        put_word(out.f, row->quantity);
        putc('\t', out.f);
        put_word(out.f, row->unit);
        putc('\t', out.f);
        put_number(out.f, row->asked);
        putc('\t', out.f);
        put_number(out.f, row->achieved);
        putc('\t', out.f);
        put_number(out.f, fabs(row->achieved - row->asked));
        putc('\t', out.f);
        put_word(out.f, row->note);
        putc('\n', out.f);
    }
    return fl_out_close(&out, err);
}

void report_print(const struct options *o, const struct result *r)
{
    static struct table t;
    make_table(&t, o, r);
    fprintf(stderr, "pack: certificate\n%-34s %10s   %-14s\n", "", "asked", "achieved");
    for (int k = 0; k < t.n; k++) {
        const struct row *row = &t.row[k];
        char name[100], asked[40] = "", got[40] = "", line[300];
        snprintf(name, sizeof name, "%s%s%s%s", row->quantity, *row->unit ? " [" : "", row->unit,
                 *row->unit ? "]" : "");
        if (!isnan(row->asked)) snprintf(asked, sizeof asked, "%.6g", row->asked);
        if (!isnan(row->achieved)) snprintf(got, sizeof got, "%.*g", row->digits, row->achieved);
        snprintf(line, sizeof line, "%-34s %10s   %-14s %s", name, asked, got, row->note);
        size_t end = strlen(line);
        while (end && line[end - 1] == ' ') line[--end] = '\0';
        fprintf(stderr, "%s\n", line);
    }
}
