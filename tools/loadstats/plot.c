/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <errno.h>
#include <string.h>
#include <sys/stat.h>
#include "stat/power_spectrum.h"
#include "picture.h"
#include "plot.h"
#include "plot_history.h"
#include "table_list.h"

enum { PARTS_MAX = 24 };

/* Data and options that are available for a report of this record, table_need. */
static unsigned available(const struct record_views *r, const struct options *o)
{
    return NEEDS_RECORD | (o->returns ? NEEDS_RETURNS : 0u) | (o->oscillators ? NEEDS_OSCILLATOR : 0u) |
           (r->series->parts > 2 ? NEEDS_PARTS : 0u) |
           (r->series->n >= FL_SPECTRUM_SHORTEST_SEGMENT ? NEEDS_SEGMENT : 0u);
}

/* True if the picture of kind k is drawn: that of the table, and in a report those of all kinds whose needs
 * are met.  Kinds that share a picture draw it once. */
static int is_drawn(int k, const struct record_views *r, const struct options *o)
{
    const struct table *t = table_at(k);
    if (!t->picture) return 0;
    for (int j = 0; j < k; j++)
        if (table_at(j)->picture == t->picture) return 0;
    if (o->table->picture == t->picture) return 1;
    return o->report_page && ((t->needs | t->report.needs) & ~available(r, o)) == 0;
}

/* Draw a picture where it has something to show; *made counts it. */
static int draw_kind(picture *p, const struct picture_kind *kind, int *made, fl_err *err)
{
    p->name = kind->name;
    const int drawable = kind->drawable ? kind->drawable(p, err) : 1;
    if (drawable <= 0) return drawable;
    if (make_picture(p, kind->fill, err)) return -1;
    ++*made;
    return 0;
}

/* The pictures of one part. */
static int draw_part(picture *p, int *made, fl_err *err)
{
    const int before = *made + 1;
    const int of_page = p->o->report_page && !picture_of_sum(p);
    if (of_page && !plot_part_varies(p, err)) return 0; /* the overview has its zeros */
    if (draw_kind(p, &history_picture, made, err)) return -1;
    /* A report of several parts has all pictures of their sum, and the history of each of them. */
    if (of_page) return 0;
    if (draw_kind(p, &peaks_picture, made, err)) return -1;
    if (*made == before && !p->o->quiet)
        fprintf(stderr, "loadstats: %s has no peaks to draw\n", p->r->series->part[p->part]);
    for (int k = 0; k < table_count(); k++)
        if (is_drawn(k, p->r, p->o) && table_at(k)->picture->fill &&
            draw_kind(p, table_at(k)->picture, made, err))
            return -1;
    return 0;
}

static int part_exists(const struct record_views *r, int32_t part)
{
    for (int32_t s = 0; s < r->series->signals; s++)
        if (find_view(r, part, s, 0)) return 1;
    return 0;
}

/* Of a part beside its own sum the sum is drawn, unless it lacks a signal of the part, as the resistance. */
static int sum_is_enough(const struct record_views *r)
{
    for (int32_t s = 0; s < r->series->signals; s++)
        if (find_view(r, 0, s, 0) && !find_view(r, 1, s, 0)) return 0;
    return 1;
}

int plot_record(const struct record_views *r, const struct options *o, const fl_history_line *by, fl_err *err)
{
    const int32_t parts = r->series->parts, alone = parts == 2 && strcmp(r->series->part[1], "total") == 0;
    const int32_t first = alone && sum_is_enough(r), end = alone ? first + 1 : parts;
    picture p = {.r = r, .o = o, .by = by};
    int made = 0;
    if (parts > PARTS_MAX)
        return fl_fail(err, FL_USAGE, "--plot draws at most %d parts, here are %d: choose one with --part",
                       PARTS_MAX, parts);
    if (mkdir(o->plot, 0777) != 0 && errno != EEXIST)
        return fl_fail(err, FL_SYSTEM, "%s: %s", o->plot, strerror(errno));
    for (p.part = first; p.part < end; p.part++)
        if (part_exists(r, p.part) && draw_part(&p, &made, err)) return -1;
    for (int k = 0; k < table_count(); k++) {
        const struct picture_kind *kind = table_at(k)->picture;
        if (!is_drawn(k, r, o) || !kind->draw_all_parts) continue;
        if (kind->draw_all_parts(r, o, by, err)) return -1;
        made++;
    }
    if (!o->quiet) fprintf(stderr, "loadstats: %d picture(s) in %s\n", made, o->plot);
    return 0;
}
