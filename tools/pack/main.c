/* SPDX-License-Identifier: GPL-3.0-or-later */
/* pack -- fills a region with bodies by radius growth: a grading and a porosity in, g-polys out. */
#include <omp.h>
#include "base/parallel.h"
#include "options.h"
#include "pack_run.h"

int main(int argc, char **argv)
{
    struct options o;
    fl_err err = {0};
    fl_tool_begin();
    fl_parallel_limit_spin(argv);
    int rc = options_parse(&o, argc, argv, &err);
    if (rc == 0 && !o.ended) {
        if (o.threads) omp_set_num_threads(o.threads);
        rc = pack_run(&o, &err);
    }
    return fl_tool_end("pack", rc, &err);
}
