/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "path_run.h"
#include <math.h>
#include <omp.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include "base/stream.h"
#include "member/path_table.h"

static volatile sig_atomic_t stop_signal;
static void note_signal(int number)
{
    stop_signal = number;
    signal(number, SIG_DFL); /* a second one ends the program at once */
}

struct run {
    const struct options *o;
    fl_member_model model;
    fl_member_chain chain;
    fl_path path;
    fl_path_table table;
    int until_column[UNTIL_MAX]; /* watched displacement; -1 lambda, -2 along, -3 arc, -4 length */
    double until_start[UNTIL_MAX];
};

static int find_columns(struct run *r, fl_err *err)
{
    static const char *const own[] = {"lambda", "along", "arc", "length"};
    const struct options *o = r->o;
    for (int k = 0; k < o->watches; k++)
        if (fl_path_watch_parse(&r->table.watch[r->table.watches++], &r->model, o->watch[k], err)) return -1;
    if (o->watches == 0) fl_path_table_watch_loads(&r->table, &r->model);
    for (int u = 0; u < o->untils; u++) {
        fl_path_watch w;
        r->until_column[u] = 0;
        for (int k = 0; k < 4; k++)
            if (strcmp(o->until[u].name, own[k]) == 0) r->until_column[u] = -1 - k;
        if (r->until_column[u] < 0) continue;
        if (fl_path_watch_parse(&w, &r->model, o->until[u].name, err)) return -1;
        int k = 0;
        while (k < r->table.watches && (r->table.watch[k].node != w.node || r->table.watch[k].dof != w.dof)) k++;
        if (k == FL_PATH_WATCH_MAX) return fl_fail(err, FL_USAGE, "more than %d displacements are watched", FL_PATH_WATCH_MAX);
        if (k == r->table.watches) r->table.watch[r->table.watches++] = w;
        r->until_column[u] = k;
    }
    return 0;
}

static int reached(const struct run *r)
{
    const fl_path_point *p = &r->path.point;
    for (int u = 0; u < r->o->untils; u++) {
        const int k = r->until_column[u];
        const double x = k == -1   ? p->lambda
                         : k == -2 ? p->along
                         : k == -3 ? p->arc
                         : k == -4 ? p->length
                                   : r->table.value[r->table.known - 1][k];
        const double v = r->o->until[u].value;
        if (v < 0.0 ? x <= v : x >= v) return 1;
    }
    return 0;
}

static int follow(struct run *r, FILE *f, fl_err *err)
{
    int64_t written = 0;
    if (fl_path_table_add(&r->table, &r->path, &r->model, err)) return -1;
    while (r->path.point.number < r->o->points && !stop_signal) {
        if (fl_path_next(&r->path, err)) return -1;
        if (fl_path_table_add(&r->table, &r->path, &r->model, err)) return -1;
        fwrite(r->table.text + written, 1, (size_t)(r->table.len - written), f);
        written = r->table.len;
        if (r->o->verbose)
            fprintf(stderr, "point %lld: lambda %g, along %g, %lld steps, dl %g\n", (long long)r->path.point.number,
                    r->path.point.lambda, r->path.point.along, (long long)r->path.point.steps, r->path.dl);
        if (reached(r)) break;
    }
    return 0;
}

int path_run(const struct options *o, fl_err *err)
{
    struct run r = {.o = o};
    fl_history_line by;
    fl_out out = {0};
    int rc = fl_member_model_read(&r.model, o->model, err);
    if (rc == 0) rc = find_columns(&r, err);
    if (rc == 0) rc = fl_member_chain_make(&r.chain, &r.model, 1.0, err);
    if (rc == 0) {
        r.chain.threads = omp_get_max_threads();
        rc = fl_path_start(&r.path, &r.chain, &o->path, err);
    }
    if (rc == 0) rc = fl_out_open(&out, o->out, o->gzip, err);
    if (rc == 0) {
        signal(SIGINT, note_signal);
        signal(SIGTERM, note_signal);
        options_by(o, &by);
        fl_path_table_header(out.f, &r.table, &r.model, &by);
        rc = follow(&r, out.f, err);
        fl_err closing = {0};
        if (fl_out_close(&out, &closing) && rc == 0) rc = fl_fail(err, closing.code, "%s", closing.text);
    }
    fl_path_table_free(&r.table);
    fl_path_free(&r.path);
    fl_member_chain_free(&r.chain);
    fl_member_model_free(&r.model);
    return rc;
}
