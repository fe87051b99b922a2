/* SPDX-License-Identifier: GPL-3.0-or-later */
/* block-cut -- cuts a model of rock into blocks by joint sets: g-polys out, and a certificate. */
#include <omp.h>
#include "base/parallel.h"
#include "block_run.h"
#include "options.h"

int main(int argc, char **argv)
{
    struct options o;
    fl_err err = {0};
    fl_tool_begin();
    fl_parallel_limit_spin(argv);
    int rc = options_parse(&o, argc, argv, &err);
    if (rc == 0 && !o.ended) {
        if (o.threads) omp_set_num_threads(o.threads);
        rc = block_run(&o, &err);
    }
    options_free(&o);
    return fl_tool_end("block-cut", rc, &err);
}
