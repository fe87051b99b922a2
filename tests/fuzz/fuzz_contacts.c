/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include "stat/run_summary.h"
#include "support/fuzz.h"

/* Rows of one time are combined, with a row filter, as in the summary with constant memory. */
static int fuzz_one(const unsigned char *data, size_t n)
{
    const char *const fn[] = {"fn", "gap"}, *const where[] = {"mode=VF"};
    const fl_record_selection ask = {.signal = fn,
                                     .signals = 2,
                                     .from = -INFINITY,
                                     .to = INFINITY,
                                     .reduction = FL_REDUCE_MEAN,
                                     .where = where,
                                     .wheres = 1};
    const fl_summary_settings how = {.separation = 0.5, .block = 1.0};
    fl_err err = {0};
    fl_run r = {0};
    int rc = fl_run_open(&r, fuzz_file(data, n), &ask, &how, &err), more = rc ? -1 : 1, sound = 1;
    while (rc == 0 && more > 0) {
        more = fl_run_next(&r, &err);
        if (more < 0) rc = -1;
        if (more > 0)
            sound &= r.record.edge[1] >= r.record.edge[0] && isfinite(r.record.x[0]) && r.record.parts == 1;
    }
    if (rc == 0) rc = fl_run_finish(&r, "#by fuzz --summary\n", &err);
    if (rc == 0)
        sound &= r.sum.n == 2 && r.sum.entry[0].rows == r.sum.entry[1].rows &&
                 r.sum.entry[0].min <= r.sum.entry[0].max && isfinite(r.sum.entry[0].run[FL_RUN_MEAN].v[0].x);
    fl_run_close(&r);
    return sound ? fuzz_verdict(rc, &err) : FUZZ_BROKEN;
}

int main(int argc, char **argv) { return fuzz_main(argc, argv, "contacts", fuzz_one); }
