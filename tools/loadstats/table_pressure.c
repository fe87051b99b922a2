/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include "cell.h"
#include "table_pressure.h"

static void write_point(FILE *f, fl_vec3 x)
{
    write_cell(f, x.x);
    write_cell(f, x.y);
    write_cell(f, x.z);
}

void pressure_rows(FILE *f, const load_map *p)
{
    for (int32_t k = 0; k < p->parts; k++) {
        const part_pressure *part = &p->part[k];
        char name[PART_TEXT];
        double c, e;
        fit_pressure_area(p, part, &c, &e);
        for (int32_t a = 0; a < p->o->areas; a++) {
            const panel_load_stats *l = &part->p[a];
            const double area = p->o->area[a], none = l->max > 0.0 ? 1.0 : (double)NAN;
            fputs(load_map_part(p, part->part, name), f);
            write_cell(f, area);
            write_cell(f, l->max);
            write_cell(f, l->sum / p->weight);
            write_cell(f, part->best[a].force);
            write_cell(f, none * l->t_max);
            write_point(f, v3_scale(none, part->best[a].centre));
            fprintf(f, "\t%d", part->best[a].contacts);
            write_cell(f, c * pow(area, -e));
            write_cell(f, fl_pressure_iso19906(area));
            putc('\n', f);
        }
    }
}

static void write_load_cells(FILE *f, const load_map *p, const panel_load_stats *l, double over)
{
    write_cell(f, l->sum / p->weight / over);
    write_cell(f, l->max / over);
    write_cell(f, l->max > 0.0 ? l->t_max : (double)NAN);
    write_cell(f, l->loaded / p->weight);
    putc('\n', f);
}

void line_rows(FILE *f, const load_map *p)
{
    for (int32_t k = 0; k < p->panels; k++) {
        const load_panel *q = &p->panel[k];
        write_number(f, q->from);
        write_cell(f, q->to);
        write_cell(f, q->middle.x);
        write_cell(f, q->middle.y);
        write_load_cells(f, p, &q->load, q->to - q->from);
    }
}

void map_rows(FILE *f, const load_map *p)
{
    for (int32_t k = 0; k < p->panels; k++) {
        const load_panel *q = &p->panel[k];
        if (q->name) fputs(q->name, f);
        else fprintf(f, "%d", k + 1);
        write_cell(f, q->from);
        write_cell(f, q->to);
        write_cell(f, q->bottom);
        write_cell(f, q->top);
        write_point(f, q->middle);
        write_cell(f, q->area);
        write_load_cells(f, p, &q->load, q->area);
    }
}
