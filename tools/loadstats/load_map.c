/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "base/number_text.h"
#include "base/stream.h"
#include "stat/panels.h"
#include "load_map.h"
#include "table_kind.h"

static int has_heights(const struct options *o) { return (o->table->uses & USES_HEIGHTS) != 0; }

/* --- loads against time --------------------------------------------------------------------------------- */

/* A time is complete: add its load, which lasts for w. */
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

static part_pressure *find_part(load_map *p, int32_t part, fl_err *err)
{
    int32_t k = 0;
    while (k < p->parts && p->part[k].part > part) k++; /* -1 is the first */
    if (k < p->parts && p->part[k].part == part) return &p->part[k];
    if (fl_grow(&p->part, &p->part_cap, (int64_t)p->parts + 1, sizeof *p->part, err)) return NULL;
    memmove(p->part + k + 1, p->part + k, (size_t)(p->parts - k) * sizeof *p->part);
    p->parts++;
    p->part[k] = (part_pressure){.part = part};
    return &p->part[k];
}

static int add_pressures(load_map *p, const fl_contact_events *h, fl_window_work *w, fl_err *err)
{
    for (int32_t i = 0; i < h->n; i++)
        if (!find_part(p, h->event[i].part, err)) return -1;
    for (int32_t k = 0; h->n && k < p->parts; k++) {
        part_pressure *part = &p->part[k];
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

/* Add the contacts of a time to their panels; contacts outside the heights are on none. */
static int add_panel_loads(load_map *p, const fl_contact_events *h, fl_err *err)
{
    const int line = !has_heights(p->o);
    for (int32_t i = 0; i < h->n; i++) {
        const fl_contact_event *c = &h->event[i];
        if (p->only && c->part != p->only)
            return fl_fail(err, FL_USAGE,
                           "%s: contacts of parts %d and %d, but one waterline; choose a part with --part",
                           fl_in_name(h->table.text.in), p->only, c->part);
        p->only = c->part;
        const double s = fl_waterline_nearest(&p->line, c->p.x, c->p.y), flat = hypot(c->n.x, c->n.y);
        int32_t row = 0, column = (int32_t)(s / p->line.length * p->across);
        if (column >= p->across) column = p->across - 1;
        while (!line && row + 1 < p->o->heights && c->p.z >= p->o->height[row + 1]) row++;
        if (!line && (c->p.z < p->o->height[0] || row + 1 == p->o->heights)) continue;
        /* A line load is the horizontal inward force; a pressure comes from the normal force. */
        const double level = flat > 0.0 ? -(c->force.x * c->n.x + c->force.y * c->n.y) / flat : 0.0;
        p->panel[row * p->across + column].load.now += line ? level : c->normal_force;
    }
    for (int32_t k = 0; k < p->panels; k++) close_load(&p->panel[k].load, h->t, 1.0);
    return 0;
}

/* --- panels --------------------------------------------------------------------------------------------- */

static load_panel *add_panel(load_map *p, fl_err *err)
{
    if (fl_grow(&p->panel, &p->panel_cap, (int64_t)p->panels + 1, sizeof *p->panel, err)) return NULL;
    p->panel[p->panels] = (load_panel){.from = NAN, .to = NAN, .bottom = NAN, .top = NAN, .area = 1.0};
    return &p->panel[p->panels++];
}

static int make_grid(load_map *p, fl_err *err)
{
    const struct options *o = p->o;
    const int32_t rows = has_heights(o) ? o->heights - 1 : 1;
    if (fl_waterline_make(&p->line, o->waterline, err)) return -1;
    p->across = o->bins;
    for (int32_t k = 0; k < rows * p->across; k++) {
        load_panel *q = add_panel(p, err);
        if (!q) return -1;
        q->from = p->line.length * (k % p->across) / p->across;
        q->to = p->line.length * (k % p->across + 1) / p->across;
        fl_waterline_point(&p->line, 0.5 * (q->from + q->to), &q->middle.x, &q->middle.y);
        if (!has_heights(o)) continue;
        q->bottom = o->height[k / p->across];
        q->top = o->height[k / p->across + 1];
        q->middle.z = 0.5 * (q->bottom + q->top);
        q->area = (q->to - q->from) * (q->top - q->bottom);
    }
    return 0;
}

/* The first time defines the panels. */
static int copy_panels(load_map *p, const fl_panels *from, fl_err *err)
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

static int read_panels(load_map *p, fl_err *err)
{
    fl_panels r = {0};
    int more, rc = -1;
    if (fl_panels_open(&r, p->o->in, err)) goto done;
    while ((more = fl_panels_next(&r, err)) > 0) {
        if (r.times == 1 && copy_panels(p, &r, err)) goto done;
        if (r.edge[0] < p->o->from || r.edge[1] > p->o->to) continue;
        p->weight += r.edge[1] - r.edge[0];
        for (int32_t k = 0; k < r.n; k++) {
            p->panel[k].load.now = v3_norm(r.panel[k].force);
            close_load(&p->panel[k].load, r.t, r.edge[1] - r.edge[0]);
        }
    }
    if (more < 0) goto done;
    if (!(p->weight > 0.0)) {
        fl_fail(err, FL_INPUT, "%s: no interval lies between the selected times",
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

/* A part by its number below 0, or by its name in a line "#part NUMBER NAME". */
static int choose_part(fl_contact_events *h, const char *part, fl_err *err)
{
    int number, used;
    if (fl_number_i32(part, INT32_MIN, -1, &h->selection.part) == 0) return 0;
    for (const char *line = h->table.text.run_lines; line && *line; line = strchr(line, '\n') + 1) {
        if (sscanf(line, "#part %d %n", &number, &used) != 1) continue;
        if (strcspn(line + used, "\n") != strlen(part) || strncmp(line + used, part, strlen(part)) != 0)
            continue;
        h->selection.part = number;
        return 0;
    }
    return fl_fail(
        err, FL_USAGE,
        "--part is \"%.40s\", expected a number below 0 for contacts, as -1, or a name in a line #part "
        "of the table",
        part);
}

static int read_contacts(load_map *p, fl_err *err)
{
    const struct options *o = p->o;
    fl_contact_selection selection = {.from = o->from, .to = o->to, .where = o->where, .wheres = o->wheres};
    fl_contact_events h = {0};
    fl_window_work w = {0};
    int more, rc = -1;
    int64_t times;
    double step;
    const int windows = (o->table->uses & USES_AREAS) != 0;
    if (!windows && make_grid(p, err)) return -1;
    if (fl_contact_events_open(&h, o->in, &selection, err)) goto done;
    if (o->part && choose_part(&h, o->part, err)) goto done;
    while ((more = fl_contact_events_next(&h, err)) > 0) {
        if (windows ? add_pressures(p, &h, &w, err) : add_panel_loads(p, &h, err)) goto done;
    }
    if (more < 0 || fl_contact_events_span(&h, &times, &step, err)) goto done;
    p->weight = (double)times;
    if (!o->quiet && o->verbose)
        fprintf(stderr, "loadstats: %lld times, %.6g s apart, %lld of them without any contact\n",
                (long long)times, step, (long long)(times - h.times));
    if (h.table.text.history && !(p->history = strdup(h.table.text.history)))
        fl_fail(err, FL_SYSTEM, "out of memory");
    else if (h.table.text.run_lines && !(p->run_lines = strdup(h.table.text.run_lines)))
        fl_fail(err, FL_SYSTEM, "out of memory");
    else rc = 0;
done:
    fl_window_work_free(&w);
    fl_contact_events_close(&h);
    return rc;
}

const char *load_map_part(const load_map *p, int32_t part, char text[PART_TEXT])
{
    int number, used;
    for (const char *line = p->run_lines; line && *line; line = strchr(line, '\n') + 1)
        if (sscanf(line, "#part %d %n", &number, &used) == 1 && number == part) {
            snprintf(text, PART_TEXT, "%.*s", (int)strcspn(line + used, "\n"), line + used);
            return text;
        }
    snprintf(text, PART_TEXT, "%d", part);
    return text;
}

/* --- load map ------------------------------------------------------------------------------------------- */

int load_map_read(load_map *p, const struct options *o, fl_err *err)
{
    *p = (load_map){.o = o};
    return has_heights(o) && !o->waterline ? read_panels(p, err) : read_contacts(p, err);
}

void fit_pressure_area(const load_map *p, const part_pressure *part, double *c, double *k)
{
    double max[AREAS_MAX];
    for (int32_t a = 0; a < p->o->areas; a++) max[a] = part->p[a].max;
    fl_pressure_fit(p->o->areas, p->o->area, max, c, k);
}

void load_map_free(load_map *p)
{
    for (int32_t k = 0; k < p->panels; k++) free(p->panel[k].name);
    free(p->panel);
    free(p->part);
    free(p->history);
    free(p->run_lines);
    *p = (load_map){0};
}
