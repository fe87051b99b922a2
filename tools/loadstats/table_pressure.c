/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "base/number_text.h"
#include "base/stream.h"
#include "stat/panels.h"
#include "history_line.h"
#include "table_pressure.h"
#include "html_report.h"
#include "load_map.h"
#include "table_stats.h"

int pressure_selected(const struct options *o)
{
    return o->table == TABLE_PRESSURE || o->table == TABLE_LINE || o->table == TABLE_MAP;
}

/* --- loads against time --------------------------------------------------------------------------------- */

/* A time is complete: `now` lasts for w. */
static void close_load(panel_load_stats *l, double t, double w)
{
    l->sum += w * l->now;
    if (l->now > 0.0) l->loaded += w;
    if (l->now > l->max) {
        l->max = l->now;
        l->t_max = t;
    }
    l->now = 0.0;
}

static place_part *part_of(place *p, int32_t part, fl_err *err)
{
    int32_t k = 0;
    while (k < p->parts && p->part[k].part > part) k++; /* -1 is the first */
    if (k < p->parts && p->part[k].part == part) return &p->part[k];
    if (fl_grow(&p->part, &p->part_cap, (int64_t)p->parts + 1, sizeof *p->part, err)) return NULL;
    memmove(p->part + k + 1, p->part + k, (size_t)(p->parts - k) * sizeof *p->part);
    p->parts++;
    p->part[k] = (place_part){.part = part};
    return &p->part[k];
}

static int close_pressures(place *p, const fl_contact_events *h, fl_window_work *w, fl_err *err)
{
    for (int32_t i = 0; i < h->n; i++)
        if (!part_of(p, h->event[i].part, err)) return -1;
    for (int32_t k = 0; h->n && k < p->parts; k++) {
        place_part *part = &p->part[k];
        for (int32_t a = 0; a < p->o->areas; a++) {
            fl_window best;
            panel_load_stats *l = &part->p[a];
            if (fl_largest_load_window(h->n, h->event, part->part, p->o->area[a], &best, w, err)) return -1;
            l->now = best.force / p->o->area[a];
            if (l->now > l->max) part->best[a] = best;
            close_load(l, h->t, 1.0);
        }
    }
    return 0;
}

/* The contacts of a time go to their panels; those above, below and beyond are on none. */
static int close_panels(place *p, const fl_contact_events *h, fl_err *err)
{
    const int line = p->o->table == TABLE_LINE;
    for (int32_t i = 0; i < h->n; i++) {
        const fl_contact_event *c = &h->event[i];
        if (p->only && c->part != p->only)
            return fl_fail(err, FL_USAGE,
                           "%s: contacts of parts %d and %d have one waterline, choose one with --part",
                           fl_in_name(h->table.text.in), p->only, c->part);
        p->only = c->part;
        const double s = fl_waterline_nearest(&p->line, c->p.x, c->p.y), flat = hypot(c->n.x, c->n.y);
        int32_t row = 0, column = (int32_t)(s / p->line.length * p->across);
        if (column >= p->across) column = p->across - 1;
        while (!line && row + 1 < p->o->heights && c->p.z >= p->o->height[row + 1]) row++;
        if (!line && (c->p.z < p->o->height[0] || row + 1 == p->o->heights)) continue;
        /* A line load is what presses inward, level; a pressure what presses along the normal. */
        const double level = flat > 0.0 ? -(c->force.x * c->n.x + c->force.y * c->n.y) / flat : 0.0;
        p->panel[row * p->across + column].load.now += line ? level : c->normal_force;
    }
    for (int32_t k = 0; k < p->panels; k++) close_load(&p->panel[k].load, h->t, 1.0);
    return 0;
}

/* --- panels --------------------------------------------------------------------------------------------- */

static load_panel *add_panel(place *p, fl_err *err)
{
    if (fl_grow(&p->panel, &p->panel_cap, (int64_t)p->panels + 1, sizeof *p->panel, err)) return NULL;
    p->panel[p->panels] = (load_panel){.from = NAN, .to = NAN, .bottom = NAN, .top = NAN, .area = 1.0};
    return &p->panel[p->panels++];
}

static int make_grid(place *p, fl_err *err)
{
    const struct options *o = p->o;
    const int32_t rows = o->table == TABLE_MAP ? o->heights - 1 : 1;
    if (fl_waterline_make(&p->line, o->waterline, err)) return -1;
    p->across = o->bins;
    for (int32_t k = 0; k < rows * p->across; k++) {
        load_panel *q = add_panel(p, err);
        if (!q) return -1;
        q->from = p->line.length * (k % p->across) / p->across;
        q->to = p->line.length * (k % p->across + 1) / p->across;
        fl_waterline_point(&p->line, 0.5 * (q->from + q->to), &q->middle.x, &q->middle.y);
        if (o->table != TABLE_MAP) continue;
        q->bottom = o->height[k / p->across];
        q->top = o->height[k / p->across + 1];
        q->middle.z = 0.5 * (q->bottom + q->top);
        q->area = (q->to - q->from) * (q->top - q->bottom);
    }
    return 0;
}

/* Panels are known with the first time. */
static int name_panels(place *p, const fl_panels *from, fl_err *err)
{
    for (int32_t k = 0; k < from->n; k++) {
        load_panel *q = add_panel(p, err);
        if (!q) return -1;
        q->middle = from->panel[k].middle;
        q->area = from->panel[k].area;
        q->name = strdup(from->panel[k].name);
        if (!q->name) return fl_fail(err, FL_SYSTEM, "out of memory");
    }
    return 0;
}

static int read_panels(place *p, fl_err *err)
{
    fl_panels r = {0};
    int more, rc = -1;
    if (fl_panels_open(&r, p->o->in, err)) goto done;
    while ((more = fl_panels_next(&r, err)) > 0) {
        if (r.times == 1 && name_panels(p, &r, err)) goto done;
        if (r.edge[0] < p->o->from || r.edge[1] > p->o->to) continue;
        p->weight += r.edge[1] - r.edge[0];
        for (int32_t k = 0; k < r.n; k++) {
            p->panel[k].load.now = v3_norm(r.panel[k].force);
            close_load(&p->panel[k].load, r.t, r.edge[1] - r.edge[0]);
        }
    }
    if (more < 0) goto done;
    if (!(p->weight > 0.0)) {
        fl_fail(err, FL_INPUT, "%s: no interval of it is between the times that were asked for",
                fl_in_name(r.table.text.in));
        goto done;
    }
    if (r.table.text.history && !(p->history = strdup(r.table.text.history)))
        fl_fail(err, FL_SYSTEM, "out of memory");
    else rc = 0;
done:
    fl_panels_close(&r);
    return rc;
}

/* --- contacts ------------------------------------------------------------------------------------------- */

static int read_contacts(place *p, fl_err *err)
{
    const struct options *o = p->o;
    fl_contact_selection ask = {.from = o->from, .to = o->to, .where = o->where, .wheres = o->wheres};
    fl_contact_events h = {0};
    fl_window_work w = {0};
    int more, rc = -1;
    int64_t times;
    double step;
    if (o->part && (fl_number_i32(o->part, INT32_MIN, -1, &ask.part)))
        return fl_fail(err, FL_USAGE, "--part is \"%.40s\", of contacts it is a number below 0, as -1",
                       o->part);
    if (o->table != TABLE_PRESSURE && make_grid(p, err)) return -1;
    if (fl_contact_events_open(&h, o->in, &ask, err)) goto done;
    while ((more = fl_contact_events_next(&h, err)) > 0) {
        if (o->table == TABLE_PRESSURE ? close_pressures(p, &h, &w, err) : close_panels(p, &h, err))
            goto done;
    }
    if (more < 0 || fl_contact_events_span(&h, &times, &step, err)) goto done;
    p->weight = (double)times;
    if (!o->quiet && o->verbose)
        fprintf(stderr, "loadstats: %lld times, %.6g s apart, %lld of them without any contact\n",
                (long long)times, step, (long long)(times - h.times));
    if (h.table.text.history && !(p->history = strdup(h.table.text.history)))
        fl_fail(err, FL_SYSTEM, "out of memory");
    else rc = 0;
done:
    fl_window_work_free(&w);
    fl_contact_events_close(&h);
    return rc;
}

/* --- tables --------------------------------------------------------------------------------------------- */

void fit_pressure_area(const place *p, const place_part *part, double *c, double *k)
{
    double max[AREAS_MAX];
    for (int32_t a = 0; a < p->o->areas; a++) max[a] = part->p[a].max;
    fl_pressure_fit(p->o->areas, p->o->area, max, c, k);
}

static void put_place(FILE *f, fl_vec3 x)
{
    write_cell(f, x.x);
    write_cell(f, x.y);
    write_cell(f, x.z);
}

static void pressure_rows(FILE *f, const place *p)
{
    fputs("part\tarea[m2]\tp_max[Pa]\tp_mean[Pa]\tF_max[N]\tt_max[s]\tx[m]\ty[m]\tz[m]\tcontacts\tfit[Pa]"
          "\tiso_19906[Pa]\n",
          f);
    for (int32_t k = 0; k < p->parts; k++) {
        const place_part *part = &p->part[k];
        double c, e;
        fit_pressure_area(p, part, &c, &e);
        for (int32_t a = 0; a < p->o->areas; a++) {
            const panel_load_stats *l = &part->p[a];
            const double area = p->o->area[a], none = l->max > 0.0 ? 1.0 : (double)NAN;
            fprintf(f, "%d", part->part);
            write_cell(f, area);
            write_cell(f, l->max);
            write_cell(f, l->sum / p->weight);
            write_cell(f, part->best[a].force);
            write_cell(f, none * l->t_max);
            put_place(f, v3_scale(none, part->best[a].centre));
            fprintf(f, "\t%d", part->best[a].contacts);
            write_cell(f, c * pow(area, -e));
            write_cell(f, fl_pressure_iso19906(area));
            putc('\n', f);
        }
    }
}

static void load_fields(FILE *f, const place *p, const panel_load_stats *l, double over)
{
    write_cell(f, l->sum / p->weight / over);
    write_cell(f, l->max / over);
    write_cell(f, l->max > 0.0 ? l->t_max : (double)NAN);
    write_cell(f, l->loaded / p->weight);
    putc('\n', f);
}

static void line_rows(FILE *f, const place *p)
{
    fputs("from[m]\tto[m]\tx[m]\ty[m]\tq_mean[N/m]\tq_max[N/m]\tt_max[s]\tloaded\n", f);
    for (int32_t k = 0; k < p->panels; k++) {
        const load_panel *q = &p->panel[k];
        put_number(f, q->from);
        write_cell(f, q->to);
        write_cell(f, q->middle.x);
        write_cell(f, q->middle.y);
        load_fields(f, p, &q->load, q->to - q->from);
    }
}

static void map_rows(FILE *f, const place *p)
{
    fputs("panel\tfrom[m]\tto[m]\tbottom[m]\ttop[m]\tx[m]\ty[m]\tz[m]\tarea[m2]\tp_mean[Pa]\tp_max[Pa]\t"
          "t_max[s]\tloaded\n",
          f);
    for (int32_t k = 0; k < p->panels; k++) {
        const load_panel *q = &p->panel[k];
        if (q->name) fputs(q->name, f);
        else fprintf(f, "%d", k + 1);
        write_cell(f, q->from);
        write_cell(f, q->to);
        write_cell(f, q->bottom);
        write_cell(f, q->top);
        put_place(f, q->middle);
        write_cell(f, q->area);
        load_fields(f, p, &q->load, q->area);
    }
}

void load_map_write(FILE *f, const place *p, const fl_history_line *by)
{
    fl_write_file_header(f, options_table(p->o->table), 1, p->history, by);
    if (p->o->table == TABLE_PRESSURE) pressure_rows(f, p);
    else if (p->o->table == TABLE_LINE) line_rows(f, p);
    else map_rows(f, p);
}

/* --- all of it ------------------------------------------------------------------------------------------ */

static void notes(const place *p, const struct options *o)
{
    for (int32_t k = 0; !o->quiet && o->table == TABLE_PRESSURE && k < p->parts; k++) {
        double c, e;
        fit_pressure_area(p, &p->part[k], &c, &e);
        if (isfinite(c))
            fprintf(stderr,
                    "loadstats: part %d: the largest pressures are near to %.3g MPa A^%.2f, A in m2\n",
                    p->part[k].part, 1e-6 * c, -e);
    }
    if (!o->quiet && o->table == TABLE_PRESSURE && p->parts == 0)
        fputs("loadstats: no contact of the structure has that, the table is empty\n", stderr);
}

static void intro(FILE *f, const void *what)
{
    const place *p = what;
    static const char *const text[] = {
        ("The largest force on a round window of given area, wherever it lies on the structure, over that "
         "area."),
        "The load along the waterline: what presses inward, level, over the length of each piece.",
        "The load on panels: what presses on each, over its area."};
    fputs(text[p->o->table == TABLE_PRESSURE ? 0 : p->o->table == TABLE_LINE ? 1 : 2], f);
    if (p->across || p->parts)
        fputs(" From contacts at single times; what was between them was not seen.", f);
}

static int page_table(FILE *f, const void *what, const struct options *o, fl_err *err)
{
    fl_history_line by;
    (void)err;
    history_line_run(o, &by);
    load_map_write(f, what, &by);
    return 0;
}

static int page_draw(const void *what, const struct options *o, fl_err *err)
{
    fl_history_line by;
    history_line_run(o, &by);
    return plot_load_map(what, o, &by, err);
}

int pressure_run(const struct options *o, fl_err *err)
{
    place p = {.o = o};
    fl_out out = {0};
    fl_history_line by;
    int rc = -1;
    history_line_run(o, &by);
    if (o->table == TABLE_MAP && !o->waterline ? read_panels(&p, err) : read_contacts(&p, err)) goto done;
    notes(&p, o);
    if (fl_out_open(&out, o->out, o->gzip, err)) goto done;
    load_map_write(out.f, &p, &by);
    if (fl_out_close(&out, err)) goto done;
    if (o->plot && plot_load_map(&p, o, &by, err)) goto done;
    rc = 0;
    if (o->report) {
        const report_source from = {.what = &p,
                                    .title = "Where the ice presses",
                                    .alone = 1,
                                    .history = p.history,
                                    .intro = intro,
                                    .table = page_table,
                                    .draw = page_draw};
        rc = html_report_write(&from, o, err);
    }
done:
    fl_out_abort(&out);
    for (int32_t k = 0; k < p.panels; k++) free(p.panel[k].name);
    free(p.panel);
    free(p.part);
    free(p.history);
    return rc;
}
