/* SPDX-License-Identifier: GPL-3.0-or-later */
/* voronoi-ice -- a field of ice floes: a recipe from the command line, a generator, a g-polys file. */
#include <omp.h>
#include "base/output_guard.h"
#include "base/parallel.h"
#include "base/tool.h"
#include "options.h"
#include "recipe.h"

static int check_output_files(const struct recipe *o, fl_err *err)
{
    const fl_named_path out[] = {{"--output", o->out}, {"--certificate", o->certificate}};
    fl_named_path in[4 + KEEP_OUT_MAX] = {{.path = o->thickness_law},
                                          {.path = o->sizes_file ? o->sizes : NULL},
                                          {.path = o->outline},
                                          {.path = o->grade_file}};
    for (int k = 0; k < o->structures; k++) in[4 + k].path = o->structure[k];
    return fl_output_guard_check(out, sizeof out / sizeof *out, in, sizeof in / sizeof *in, err);
}

static int run(struct recipe *o, fl_err *err)
{
    if (check_output_files(o, err)) return -1;
    if (o->threads) omp_set_num_threads(o->threads);
    return o->generator->make(o, err);
}

int main(int argc, char **argv)
{
    struct recipe o;
    fl_err err = {0};
    int rc, ended;
    fl_tool_begin();
    fl_parallel_limit_spin(argv);
    rc = options_parse(&o, &ended, argc, argv, &err); /* answers --help and --version itself */
    if (rc == 0 && !ended) rc = run(&o, &err);
    return fl_tool_end("voronoi-ice", rc, &err); /* closes stdout, prints err, picks the status */
}
