/* SPDX-License-Identifier: GPL-3.0-or-later */
/* arc-path -- the equilibrium path of a structure of bars and beams: a model in, a table of points out. */
#include <omp.h>
#include <stdio.h>
#include "base/parallel.h"
#include "base/stream.h"
#include "member/path_table.h"
#include "options.h"
#include "path_run.h"

int main(int argc, char **argv)
{
    struct options o;
    fl_err err = {0};
    fl_tool_begin();
    fl_parallel_limit_spin(argv);
    int rc = options_parse(&o, argc, argv, &err);
    if (rc == 0 && !o.ended) {
        if (o.threads) omp_set_num_threads(o.threads);
        rc = path_run(&o, &err);
    }
    options_free(&o);
    return fl_tool_end("arc-path", rc, &err);
}
