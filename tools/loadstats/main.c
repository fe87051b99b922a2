/* SPDX-License-Identifier: GPL-3.0-or-later */
/* loadstats -- statistics of load records. */
#include <stdlib.h>
#include "base/array.h"
#include "base/output_guard.h"
#include "base/tool.h"
#include "analyse_contacts.h"
#include "analyse_record.h"
#include "analyse_runs.h"
#include "cell.h"
#include "export_loads.h"
#include "options.h"
#include "table_kind.h"

static int check_targets(const struct options *o, fl_err *err)
{
    const fl_named_path out[] = {{"--output", o->out}, {"--report", o->report}};
    fl_named_path *in = fl_alloc(o->files, sizeof *in, err);
    if (!in) return -1;
    for (int k = 0; k < o->files; k++) in[k].path = o->file[k];
    const int rc = fl_output_guard_check(out, sizeof out / sizeof *out, in, (size_t)o->files, err);
    free(in);
    return rc;
}

int main(int argc, char **argv)
{
    struct options o;
    fl_err err = {0};
    fl_tool_begin();
    int rc = options_parse(&o, argc, argv, &err);
    if (rc == 0 && !o.ended) rc = check_targets(&o, &err);
    write_digits(o.digits);
    if (rc == 0 && !o.ended)
        rc = o.exports                          ? export_loads(&o, &err)
             : o.table->source == FROM_CONTACTS ? analyse_contacts(&o, &err)
             : runs_selected(&o)                ? analyse_runs(&o, &err)
                                                : analyse_record(&o, &err);
    options_free(&o);
    return fl_tool_end("loadstats", rc, &err);
}
