/* SPDX-License-Identifier: GPL-3.0-or-later */
/* dem-solve: a scene in, the load on the structure out. */
#include <errno.h>
#include <signal.h>
#include <string.h>
#include <unistd.h>
#include "base/array.h"
#include "base/parallel.h"
#include "base/stream.h"
#include "options.h"
#include "run.h"
#include "save.h"
#include "sim/setup.h"
#include "targets.h"
#include "scene/ice_field.h"
#include "scene/ice_field_order.h"
#include "mesh/gstruct.h"
#include "scene/scene_check.h"
#include "scene/scene_read.h"
#include "scene/scene_print.h"
#include "world/access.h"

/* The scene with what the command line says of it. */
static int read_scene(fl_scene *s, const struct options *o, fl_err *err)
{
    char key[FL_SCENE_PATH + 32];
    if (fl_scene_read(s, o->scene, err)) return -1;
    for (int k = 0; k < o->sets; k++)
        if (fl_scene_set(s, o->set[k], err)) return -1;
    if (o->ice) {
        snprintf(key, sizeof key, "ice.file=%s", o->ice);
        if (fl_scene_set(s, key, err)) return -1;
    }
    if (o->structure) {
        snprintf(key, sizeof key, "structure.file=%s", o->structure);
        if (fl_scene_set(s, key, err)) return -1;
    }
    if (o->threads) s->run.threads = o->threads;
    return fl_scene_check(s, err);
}

/* The histories of both inputs, one after the other; NULL when there are none. */
static int join_history(char **out, const char *a, const char *b, fl_err *err)
{
    const size_t na = a ? strlen(a) : 0, nb = b ? strlen(b) : 0;
    *out = fl_alloc((int64_t)(na + nb + 1), 1, err);
    if (!*out) return -1;
    if (na) memcpy(*out, a, na);
    if (nb) memcpy(*out + na, b, nb);
    return 0;
}

/* A run of hours whose report or checkpoint cannot be written is to end before it begins. */
static int open_report(const struct run *r, fl_out *report, fl_err *err)
{
    fl_out checkpoint = {0};
    if (r->scene->output.checkpoint[0]) {
        if (fl_out_open(&checkpoint, r->scene->output.checkpoint, 0, err)) return -1;
        fl_out_abort(&checkpoint);
    }
    return r->o->report ? fl_out_open(report, r->o->report, 0, err) : 0;
}

static int write_report(const struct run *r, fl_out *report, fl_err *err)
{
    if (!r->o->report) {
        if (!r->o->quiet) report_write(r, stderr);
        return 0;
    }
    report_write(r, report->f);
    return fl_out_close(report, err);
}

/* What was asked for, with everything read. */
static int act(struct run *r, fl_err *err)
{
    fl_out out = {0};
    if (r->o->plan || r->o->probe >= 0.0) {
        if (fl_out_open(&out, r->out, r->gzip, err)) return -1;
        if (r->o->plan ? look_plan(r, out.f, err) : look_probe(r, out.f, err)) {
            fl_out_abort(&out);
            return -1;
        }
        return fl_out_close(&out, err);
    }
    if (open_report(r, &out, err)) return -1;
    const int rc = run_scene(r, err);
    if (r->going && err->code != FL_SYSTEM && write_report(r, &out, err)) return -1;
    fl_out_abort(&out);
    return rc;
}

/* What a run is made from. */
struct inputs {
    fl_scene scene;
    fl_ice_field field, feed; /* feed: what comes in, of another file */
    fl_surface surface;
    fl_restart saved;
    fl_restart_part kept[KEPT];
    char *text[KEPT]; /* of kept, where it is owned */
    char *history;
    fl_history_line by;
};

/* A file that is not there is told by the line of the scene that names it; any other trouble, and what the
 * command line names, by its reader. */
static int file_there(const fl_scene *s, const char *key, const char *path, fl_err *err)
{
    fl_err why = {0};
    if (!path[0] || strcmp(path, "-") == 0 || access(path, R_OK) == 0) return 0;
    fl_scene_fail(s, key, &why, "%s: %s", path, strerror(errno));
    if (why.code != FL_INPUT) return 0;
    *err = why;
    return -1;
}

static int files_there(const fl_scene *s, fl_err *err)
{
    char key[128];
    if (file_there(s, "ice.file", s->ice.file, err) ||
        file_there(s, "structure.file", s->structure.file, err) ||
        file_there(s, "structure.track", s->structure.motion.track, err) ||
        file_there(s, "boundary.inflow_file", s->boundary.inflow_file, err) ||
        file_there(s, "water.profile_file", s->water.profile_file, err))
        return -1;
    for (int32_t k = 0; k < s->n_part; k++) {
        snprintf(key, sizeof key, "part %s.track", s->part[k].name);
        if (file_there(s, key, s->part[k].motion.track, err)) return -1;
    }
    return 0;
}

static int read_inputs(struct inputs *in, const struct options *o, fl_err *err)
{
    if (o->resume)
        return fl_restart_read(&in->saved, o->resume, err) || fl_restart_current(&in->saved, err) ||
                       save_inputs(&in->saved, o, &in->scene, &in->field, &in->feed, &in->surface, err) ||
                       save_history(&in->saved, &in->history, &in->by, err)
                   ? -1
                   : 0;
    if (read_scene(&in->scene, o, err)) return -1;
    if (o->echo) return 0;
    if (files_there(&in->scene, err)) return -1;
    if (fl_ice_field_read(&in->field, in->scene.ice.file, err)) return -1;
    if (in->scene.boundary.inflow == FL_INFLOW_FILE &&
        fl_ice_field_read(&in->feed, in->scene.boundary.inflow_file, err))
        return -1;
    if (in->scene.structure.head.present && in->scene.structure.file[0] &&
        fl_gstruct_read(&in->surface, in->scene.structure.file, err))
        return -1;
    options_by(o, &in->by);
    return join_history(&in->history, in->field.history, in->surface.history, err);
}

/* The texts that checkpoints carry on: those of the checkpoint resumed from, or the inputs just read. */
static int keep_texts(struct inputs *in, const fl_surface *surface, fl_err *err)
{
    static const char *const NAME[KEPT] = {"ice", "structure", "inflow"};
    if (!in->scene.output.checkpoint[0]) return 0;
    if (!in->saved.data) {
        const int rc = save_keep(in->kept, &in->field, surface, &in->feed, &in->by, err);
        for (int k = 0; k < KEPT; k++) memcpy(&in->text[k], &in->kept[k].text, sizeof in->text[k]);
        return rc;
    }
    for (int k = 0; k < KEPT; k++) {
        const fl_restart_part *part = fl_restart_find(&in->saved, NAME[k]);
        if (part) in->kept[k] = *part;
    }
    return 0;
}

/* Bring a field into the order of its places; where the k-th body has gone into *at, NULL: nobody asks. */
static int order(fl_ice_field *field, int32_t **at, fl_err *err)
{
    int32_t *to = fl_alloc(field->n, sizeof *to, err);
    const int bad = !to || fl_ice_field_order(field, to, err);
    if (at) *at = to;
    else free(to);
    return bad ? -1 : 0;
}

/* The tables tell the bodies of the ice file first, in its order, then who has come in. */
static int places(int32_t **at, int32_t n, int32_t all, fl_err *err)
{
    int32_t cap = n;
    if (fl_grow(at, &cap, all, sizeof **at, err)) return -1;
    for (int32_t i = n; i < all; i++) (*at)[i] = i;
    return 0;
}

/* A signal is answered by a checkpoint; when a reader has gone the last one stays. */
static void tell_stop(const struct run *r)
{
    const char *checkpoint = r->scene->output.checkpoint;
    const int gone = r->stopped == SIGPIPE, on = checkpoint[0] && (!gone || r->saves || r->saved);
    fprintf(stderr, "dem-solve: stopped %s in step %lld (t = %g s)%s%s%s\n",
            gone ? "when a reader of its output had gone," : "by a signal", (long long)r->w->step,
            fl_world_time(r->w), on ? ", dem-solve --resume " : "", on ? checkpoint : "",
            on ? " goes on" : "");
}

static int run(const struct options *o, int *stopped, fl_err *err)
{
    struct inputs in = {0};
    fl_world world = {0};
    fl_error_budget budget = {0};
    char path[FL_SCENE_PATH];
    int32_t *at = NULL;
    int rc = -1;
    if (o->explain) return fl_scene_explain(stdout, o->explain, err);
    if (read_inputs(&in, o, err)) goto done;
    if (o->echo) {
        fl_scene_write(stdout, &in.scene);
        rc = 0;
        goto done;
    }
    const fl_surface *surface = in.surface.n ? &in.surface : NULL;
    if (in.field.n == 0) {
        fl_fail(err, FL_INPUT, "%s: no body in it, a field of ice is expected", in.scene.ice.file);
        goto done;
    }
    const int fed = in.scene.boundary.inflow != FL_INFLOW_NONE;
    if (keep_texts(&in, surface, err) || order(&in.field, &at, err) ||
        (in.feed.n && order(&in.feed, NULL, err)) ||
        fl_world_make_with_inflow(&world, &in.scene, &in.field, in.feed.n ? &in.feed : &in.field, surface,
                                  err) ||
        (!o->resume && fl_world_check_walls(&world, err)) || places(&at, in.field.n, world.n, err) ||
        (in.scene.run.error > 0.0 &&
         fl_error_budget_make(&budget, &in.scene, &in.field, in.feed.n ? &in.feed : &in.field, surface, err)))
        goto done;
    if (!fed) fl_ice_field_free(&in.field);
    struct run r = {.o = o,
                    .scene = &in.scene,
                    .at = at,
                    .surface = surface,
                    .history = in.history,
                    .by = &in.by,
                    .saved = o->resume ? &in.saved : NULL,
                    .kept = in.kept,
                    .out = o->out ? o->out : "-",
                    .gzip = o->gzip,
                    .w = &world,
                    .budget = in.scene.run.error > 0.0 ? &budget : NULL};
    if (o->resume && !o->out) {
        const fl_restart_part *loads = fl_restart_find(&in.saved, "loads");
        snprintf(path, sizeof path, "%.*s",
                 loads ? (int)(loads->n < FL_SCENE_PATH ? loads->n : FL_SCENE_PATH) : 1,
                 loads ? loads->text : "-");
        r.out = path;
    }
    if (targets_check(&in.scene, o, r.out, err)) goto done;
    run_step_size(&r);
    if (run_countable(&r, err)) goto done;
    if (!o->quiet && world.bonds.n) report_bonds(&world, stderr);
    rc = act(&r, err);
    *stopped = r.stopped;
    if (r.stopped && !o->quiet) tell_stop(&r);
done:
    free(at);
    for (int k = 0; k < KEPT; k++) free(in.text[k]);
    free(in.history);
    fl_restart_free(&in.saved);
    fl_world_free(&world);
    fl_error_budget_free(&budget);
    fl_surface_free(&in.surface);
    fl_ice_field_free(&in.field);
    fl_ice_field_free(&in.feed);
    fl_scene_free(&in.scene);
    return rc;
}

int main(int argc, char **argv)
{
    struct options o;
    fl_err err = {0};
    int stopped = 0;
    fl_tool_begin();
    fl_parallel_limit_spin(argv);
    int rc = options_parse(&o, argc, argv, &err);
    if (rc == 0 && !o.ended) rc = run(&o, &stopped, &err);
    if (rc == 0 && stopped == SIGPIPE) { /* quietly, as what stands in a pipe does */
        signal(SIGPIPE, SIG_DFL);
        raise(SIGPIPE);
    }
    rc = fl_tool_end("dem-solve", rc, &err);
    if (rc == 0 && stopped) raise(stopped); /* whoever sent it sees that it was heeded */
    return rc;
}
