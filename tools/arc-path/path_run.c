/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "path_run.h"
#include <math.h>
#include <omp.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "base/output_guard.h"
#include "base/stream.h"
#include "member/imperfection.h"
#include "member/mechanism.h"
#include "member/member_modes.h"
#include "member/path_state.h"
#include "path_frames.h"
#include "path_plot.h"

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
    struct path_frames frames;
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
        while (k < r->table.watches && (r->table.watch[k].node != w.node || r->table.watch[k].dof != w.dof))
            k++;
        if (k == FL_PATH_WATCH_MAX)
            return fl_fail(err, FL_USAGE, "more than %d displacements are watched", FL_PATH_WATCH_MAX);
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

/* Shapes that were asked for. */
static int draw_shape(const struct run *r, fl_err *err)
{
    const struct options *o = r->o;
    for (int k = 0; k < o->shapes; k++)
        if (o->shape_at[k] == r->path.point.number)
            return path_plot_shape(o, &r->model, &r->chain, r->path.point.number, err);
    return 0;
}

static void tell_point(const struct run *r)
{
    const fl_path_point *p = &r->path.point;
    fprintf(stderr, "point %lld: lambda %g, along %g, %lld steps, dl %g\n", (long long)p->number, p->lambda,
            p->along, (long long)p->steps, r->path.dl);
}

static int follow(struct run *r, fl_out *out, fl_err *err)
{
    int64_t written = 0;
    if (r->o->resume ? fl_path_state_read(&r->path, &r->table, r->o->resume, err)
                     : fl_path_table_add(&r->table, &r->path, &r->model, err))
        return -1;
    if (r->o->frames && path_frames_begin(&r->frames, r->o, &r->model, err)) return -1;
    for (;;) {
        path_frames_point(&r->frames, &r->chain, r->path.point.number);
        if (r->table.len > written)
            fwrite(r->table.text + written, 1, (size_t)(r->table.len - written), out->f);
        written = r->table.len;
        if (fl_out_flush(out, err)) return -1;
        if (r->path.point.number >= r->o->points || stop_signal || (r->path.point.number > 0 && reached(r)))
            return 0;
        if (fl_path_next(&r->path, err) || fl_path_table_add(&r->table, &r->path, &r->model, err)) return -1;
        if (draw_shape(r, err)) return -1;
        if (r->o->verbose) tell_point(r);
    }
}

static void tell_summary(const struct run *r)
{
    const fl_path_point *p = &r->path.point;
    fprintf(
        stderr,
        "%lld points, %lld steps of %d contacts, %d maxima and minima; load factor %g, energy balance %.1e\n",
        (long long)p->number, (long long)r->path.total_steps, (int)r->chain.contacts, r->table.limits,
        p->lambda, p->balance);
    if (r->path.damping != r->o->path.damping)
        fputs("kinetic damping did not settle, adaptive damping took its place\n", stderr);
}

/* What was reached is written, whatever ended the path. */
static int finish(struct run *r, fl_out *out, int rc, fl_err *err)
{
    const struct options *o = r->o;
    fl_err more = {0};
    int failed = 0;
    if (rc && err->code != FL_NO && err->code != FL_INPUT) {
        fl_out_abort(out);
        return rc;
    }
    if (fl_out_close(out, &more) || path_frames_end(&r->frames, 1, &more)) failed = 1;
    if (!failed && o->checkpoint && r->path.point.number > 0 &&
        fl_path_state_write(&r->path, &r->table, o->checkpoint, &more))
        failed = 1;
    if (!failed && o->plot && r->path.point.number > 0 && path_plot_curve(o, &r->table, &more)) failed = 1;
    if (!o->quiet) tell_summary(r);
    if (failed && rc == 0) return fl_fail(err, more.code, "%s", more.text);
    return rc;
}

static int check_files(const struct options *o, fl_err *err)
{
    const fl_named_path out[] = {
        {"--output", o->out}, {"--checkpoint", o->checkpoint}, {"--frames", o->frames}};
    const fl_named_path in[] = {{.path = o->model}, {.path = o->shape}, {.path = o->reference}};
    return fl_output_guard_check(out, 3, in, 3, err);
}

static int read_model(struct run *r, fl_err *err)
{
    const struct options *o = r->o;
    if (check_files(o, err) || fl_member_model_read(&r->model, o->model, err) || find_columns(r, err))
        return -1;
    if (o->scatter > 0.0) fl_member_scatter(&r->model, o->scatter, o->seed);
    if (o->shape && fl_member_add_shape(&r->model, o->shape, o->amplitude, err)) return -1;
    if (fl_member_check_mechanism(&r->model, err)) return -1;
    return fl_member_chain_make(&r->chain, &r->model, 1.0, err);
}

static int prepare(struct run *r, fl_err *err)
{
    const struct options *o = r->o;
    if (read_model(r, err)) return -1;
    r->chain.threads = omp_get_max_threads();
    if (!(r->chain.load_norm > 0.0) && r->chain.moves == 0)
        return fl_fail(err, FL_INPUT, "%s: no load acts on a free node", o->model);
    if (o->path.constraint != FL_ARC_LOAD && !fl_member_chain_has_force(&r->chain))
        return fl_fail(err, FL_USAGE,
                       "--constraint: the loads are moments or imposed displacements, expected load");
    fl_path_options path = o->path;
    if (o->control) {
        fl_path_watch w;
        if (fl_path_watch_parse(&w, &r->model, o->control, err)) return -1;
        const int32_t load = r->chain.ball[w.node].load;
        if (w.dof > 2 || load < 0 || v3_at(r->chain.load[load].force, w.dof) == 0.0)
            return fl_fail(err, FL_USAGE,
                           "--control %.60s: no load acts along it, expected a displacement with a load",
                           o->control);
        path.control = 1;
        path.control_ball = w.node;
        path.control_axis = w.dof;
    }
    if (o->plot && path_plot_begin(o, err)) return -1;
    return fl_path_start(&r->path, &r->chain, &path, err);
}

/* The table of modes in place of a path. */
static int write_modes(struct run *r, fl_err *err)
{
    const struct options *o = r->o;
    fl_member_stiffness k = {0};
    fl_member_modes modes = {0};
    fl_history_line by;
    fl_out out = {0};
    int rc = read_model(r, err);
    double *mass = fl_alloc(r->chain.balls, sizeof *mass, err),
           *inertia = fl_alloc(r->chain.balls, sizeof *inertia, err);
    if (rc == 0 && err->code) rc = -1;
    if (rc == 0) rc = fl_member_masses(&r->chain, &r->model, mass, inertia, err);
    if (rc == 0) rc = fl_member_stiffness_make(&k, &r->chain, r->model.file, err);
    if (rc == 0) rc = fl_member_modes_find(&modes, &k, r->chain.balls, mass, inertia, o->modes, err);
    if (rc == 0) rc = fl_out_open(&out, o->out, o->gzip, err);
    if (rc == 0) {
        options_by(o, &by);
        fl_member_modes_write(out.f, &modes, &r->model, o->ratio, &by);
        rc = fl_out_close(&out, err);
    }
    if (rc == 0 && modes.n < o->modes && !o->quiet)
        fprintf(stderr, "arc-path: note: the structure has %d modes, fewer than %d\n", (int)modes.n,
                (int)o->modes);
    fl_member_modes_free(&modes);
    fl_member_stiffness_free(&k);
    free(mass), free(inertia);
    return rc;
}

int path_run(const struct options *o, fl_err *err)
{
    struct run r = {.o = o};
    fl_history_line by;
    fl_out out = {0};
    if (o->modes) {
        const int bad = write_modes(&r, err);
        fl_member_chain_free(&r.chain);
        fl_member_model_free(&r.model);
        return bad;
    }
    int rc = prepare(&r, err);
    if (rc == 0) rc = fl_out_open(&out, o->out, o->gzip, err);
    if (rc == 0) {
        signal(SIGINT, note_signal);
        signal(SIGTERM, note_signal);
        options_by(o, &by);
        fl_path_table_header(out.f, &r.table, &r.model, &by);
        rc = finish(&r, &out, follow(&r, &out, err), err);
    }
    path_frames_end(&r.frames, 0, err);
    fl_path_table_free(&r.table);
    fl_path_free(&r.path);
    fl_member_chain_free(&r.chain);
    fl_member_model_free(&r.model);
    return rc;
}
