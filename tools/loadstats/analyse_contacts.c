/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdio.h>
#include "base/stream.h"
#include "analyse_contacts.h"
#include "history_line.h"
#include "html_report.h"
#include "load_map.h"
#include "plot_pressure.h"
#include "table_kind.h"

static void print_fits(const load_map *p, const struct options *o)
{
    if (o->quiet || !(o->table->uses & USES_AREAS)) return;
    for (int32_t k = 0; k < p->parts; k++) {
        double c, e;
        fit_pressure_area(p, &p->part[k], &c, &e);
        if (isfinite(c))
            fprintf(stderr, "loadstats: part %d: the largest pressures fit %.3g MPa A^%.2f, A in m2\n",
                    p->part[k].part, 1e-6 * c, -e);
    }
    if (p->parts == 0)
        fputs("loadstats: no contact of the structure is selected, the table is empty\n", stderr);
}

static void write_intro(FILE *f, const void *what)
{
    const load_map *p = what;
    fputs(p->o->table->report.note, f);
    if (p->across || p->parts)
        fputs(" From contacts at single times; contacts between them are not recorded.", f);
}

static int write_table(FILE *f, const void *what, const struct options *o, fl_err *err)
{
    const load_map *p = what;
    fl_history_line by;
    (void)err;
    history_line_run(o, &by);
    fl_write_file_header(f, o->table->name, 1, p->history, &by);
    table_write_columns(f, o);
    o->table->contact_rows(f, p);
    return 0;
}

static int draw_picture(const void *what, const struct options *o, fl_err *err)
{
    fl_history_line by;
    history_line_run(o, &by);
    return plot_load_map(what, o, &by, err);
}

int analyse_contacts(const struct options *o, fl_err *err)
{
    load_map p;
    fl_out out = {0};
    int rc = -1;
    if (load_map_read(&p, o, err)) goto done;
    print_fits(&p, o);
    if (fl_out_open(&out, o->out, o->gzip, err) || write_table(out.f, &p, o, err) || fl_out_close(&out, err))
        goto done;
    if (o->plot && draw_picture(&p, o, err)) goto done;
    rc = 0;
    if (o->report) {
        const report_source from = {.what = &p,
                                    .title = "Ice loads by location",
                                    .alone = 1,
                                    .history = p.history,
                                    .intro = write_intro,
                                    .table = write_table,
                                    .draw = draw_picture};
        rc = html_report_write(&from, o, err);
    }
done:
    fl_out_abort(&out);
    load_map_free(&p);
    return rc;
}
