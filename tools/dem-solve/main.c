/* SPDX-License-Identifier: GPL-3.0-or-later */
/* dem-solve: a scene in, the load on the structure out. */
#include <errno.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include "base/array.h"
#include "base/parallel.h"
#include "base/pi.h"
#include "base/stream.h"
#include "mesh/gstruct.h"
#include "factor.h"
#include "options.h"
#include "plan_probe.h"
#include "report.h"
#include "run.h"
#include "save.h"
#include "scene/ice_field.h"
#include "scene/ice_field_order.h"
#include "scene/plausibility.h"
#include "scene/scene_check.h"
#include "scene/scene_print.h"
#include "scene/scene_read.h"
#include "sim/device_step.h"
#include "sim/setup.h"
#include "step_choice.h"
#include "targets.h"
#include "world/access.h"

/* Read the scene, with the changes of the command line. */
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
        const int members = fl_member_model_is(o->structure);
        snprintf(key, sizeof key, "structure.%s=%s", members ? "members" : "file", o->structure);
        if (fl_scene_set(s, key, err) ||
            fl_scene_set(s, members ? "structure.file=none" : "structure.members=none", err))
            return -1;
    }
    if (o->direction) {
        snprintf(key, sizeof key, "structure.direction=%s", o->direction);
        if (fl_scene_set(s, key, err)) return -1;
    }
    if (o->threads) s->run.threads = o->threads;
    return fl_scene_check(s, err);
}

/* The histories of both inputs, one after the other. */
static int join_history(char **out, const char *a, const char *b, fl_err *err)
{
    const size_t na = a ? strlen(a) : 0, nb = b ? strlen(b) : 0;
    *out = fl_alloc((int64_t)(na + nb + 1), 1, err);
    if (!*out) return -1;
    if (na) memcpy(*out, a, na);
    if (nb) memcpy(*out + na, b, nb);
    return 0;
}

/* Open the report, and check that a checkpoint can be written, before a run of hours begins. */
static int open_report(const struct run *r, fl_out *report, fl_err *err)
{
    fl_out checkpoint = {0};
    if (r->scene->output.checkpoint[0]) {
        if (fl_out_open(&checkpoint, r->scene->output.checkpoint, 0, err)) return -1;
        fl_out_abort(&checkpoint);
    }
    return r->o->report ? fl_out_open(report, r->o->report, 0, err) : 0;
}

static int print_report(const struct run *r, fl_out *report, fl_err *err)
{
    if (!r->o->report) {
        if (!r->o->quiet) write_report(r, stderr, REPORT_WHOLE);
        return 0;
    }
    write_report(r, report->f, REPORT_WHOLE);
    return fl_out_close(report, err);
}

/* Run, or print the plan or the probe. */
static int run_or_print(struct run *r, fl_err *err)
{
    fl_out out = {0};
    if (r->o->plan || r->o->probe >= 0.0) {
        if (fl_out_open(&out, r->loads_path, r->gzip, err)) return -1;
        if (r->o->plan ? print_plan(r, out.f, err) : print_probe(r, out.f, err)) {
            fl_out_abort(&out);
            return -1;
        }
        return fl_out_close(&out, err);
    }
    if (open_report(r, &out, err)) return -1;
    const int rc = run_scene(r, err);
    if (r->started && err->code != FL_SYSTEM && print_report(r, &out, err)) return -1;
    fl_out_abort(&out);
    return rc;
}

/* The inputs of a run. */
struct inputs {
    fl_scene scene;
    fl_ice_field field, feed;           /* feed: the field of inflow_file */
    fl_surface surface, frames_surface; /* frames_surface: of members alone */
    fl_member_model members;            /* file is NULL where there are none */
    fl_restart saved;
    fl_restart_part input_text[INPUT_TEXTS];
    char *text[INPUT_TEXTS]; /* of input_text, where it is owned */
    fl_floe_extent floes;
    char *history;
    fl_history_line by;
};

/* If a file named by the scene does not exist, fail with the line of the scene.  Its reader reports other
 * failures, and files named on the command line. */
static int check_file(const fl_scene *s, const char *key, const char *path, fl_err *err)
{
    fl_err why = {0};
    if (!path[0] || strcmp(path, "-") == 0 || access(path, R_OK) == 0) return 0;
    fl_scene_fail(s, key, &why, "%s: %s", path, strerror(errno));
    if (why.code != FL_INPUT) return 0;
    *err = why;
    return -1;
}

static int check_files(const fl_scene *s, fl_err *err)
{
    char key[128];
    if (check_file(s, "ice.file", s->ice.file, err) ||
        check_file(s, "structure.file", s->structure.file, err) ||
        check_file(s, "structure.members", s->structure.members, err) ||
        check_file(s, "structure.track", s->structure.motion.track, err) ||
        check_file(s, "boundary.inflow_file", s->boundary.inflow_file, err) ||
        check_file(s, "water.profile_file", s->water.profile_file, err))
        return -1;
    for (int32_t k = 0; k < s->n_part; k++) {
        snprintf(key, sizeof key, "part %s.track", s->part[k].name);
        if (check_file(s, key, s->part[k].motion.track, err)) return -1;
    }
    return 0;
}

/* What ice meets of a structure of members, and what is drawn. */
static int make_surfaces(struct inputs *in, fl_err *err)
{
    const fl_scene *s = &in->scene;
    const double level = s->water.head.present ? s->water.level : 0.0;
    if (!in->members.file) return 0;
    return fl_member_motion_surface(&in->surface, &in->members, level, err) ||
                   fl_member_motion_frames_surface(&in->frames_surface, &in->members, 0.0, err)
               ? -1
               : 0;
}

static int read_inputs(struct inputs *in, const struct options *o, fl_err *err)
{
    if (o->resume)
        return fl_restart_read(&in->saved, o->resume, err) || fl_restart_current(&in->saved, err) ||
                       save_read_inputs(&in->saved, o, &in->scene, &in->field, &in->feed, &in->surface,
                                        &in->members, err) ||
                       save_read_history(&in->saved, &in->history, &in->by, err) || make_surfaces(in, err)
                   ? -1
                   : 0;
    if (read_scene(&in->scene, o, err)) return -1;
    if (o->echo) return 0;
    if (check_files(&in->scene, err)) return -1;
    if (fl_ice_field_read(&in->field, in->scene.ice.file, err)) return -1;
    in->floes = fl_floe_extent_of(&in->field);
    if (!o->force && fl_scene_check_plausible(&in->scene, &in->floes, err)) return -1;
    if (in->scene.boundary.inflow == FL_INFLOW_FILE &&
        fl_ice_field_read(&in->feed, in->scene.boundary.inflow_file, err))
        return -1;
    if (in->scene.structure.head.present && in->scene.structure.file[0] &&
        fl_gstruct_read(&in->surface, in->scene.structure.file, err))
        return -1;
    if (in->scene.structure.head.present && in->scene.structure.members[0] &&
        fl_member_model_read(&in->members, in->scene.structure.members, err))
        return -1;
    if (make_surfaces(in, err)) return -1;
    options_by(o, &in->by);
    return join_history(&in->history, in->field.history,
                        in->members.file ? in->members.history : in->surface.history, err);
}

/* The input texts for checkpoints: those of the checkpoint that is resumed, or the inputs just read. */
static int make_input_texts(struct inputs *in, const fl_surface *surface, fl_err *err)
{
    static const char *const NAME[INPUT_TEXTS] = {"ice", "structure", "inflow"};
    if (!in->scene.output.checkpoint[0]) return 0;
    if (!in->saved.data) {
        const int rc = save_inputs_as_text(in->input_text, &in->field, surface,
                                           in->members.file ? &in->members : NULL, &in->feed, &in->by, err);
        for (int k = 0; k < INPUT_TEXTS; k++)
            memcpy(&in->text[k], &in->input_text[k].text, sizeof in->text[k]);
        return rc;
    }
    for (int k = 0; k < INPUT_TEXTS; k++) {
        const fl_restart_part *part = fl_restart_find(&in->saved, NAME[k]);
        if (part) in->input_text[k] = *part;
    }
    return 0;
}

/* Sort a field along its Hilbert curve; *at: new index of the k-th body, NULL: not needed. */
static int sort_field(fl_ice_field *field, int32_t **at, fl_err *err)
{
    int32_t *to = fl_alloc(field->n, sizeof *to, err);
    const int bad = !to || fl_ice_field_order(field, to, err);
    if (at) *at = to;
    else free(to);
    return bad ? -1 : 0;
}

/* Extend the order of the tables: the bodies of the ice file in its order, then those that come in. */
static int extend_order(int32_t **at, int32_t n, int32_t all, fl_err *err)
{
    int32_t cap = n;
    if (fl_grow(at, &cap, all, sizeof **at, err)) return -1;
    for (int32_t i = n; i < all; i++) (*at)[i] = i;
    return 0;
}

/* After a signal there is a checkpoint; after SIGPIPE the last one, if any. */
static void print_stop(const struct run *r)
{
    const char *checkpoint = r->scene->output.checkpoint;
    const int pipe = r->stopped == SIGPIPE,
              has_checkpoint = checkpoint[0] && (!pipe || r->saves || r->resumed);
    fprintf(stderr, "dem-solve: stopped %s in step %lld (t = %g s)%s%s\n",
            pipe ? "because the reader of its output ended," : "by a signal", (long long)r->w->step,
            fl_world_time(r->w), has_checkpoint ? "; continue with dem-solve --resume " : "",
            has_checkpoint ? checkpoint : "");
}

static int make_trial_world(void *with, fl_world *w, fl_err *err)
{
    const struct inputs *in = with;
    return fl_world_make_with_inflow(w, &in->scene, &in->field, &in->field,
                                     in->surface.n ? &in->surface : NULL,
                                     in->members.file ? &in->members : NULL, err);
}

/* The scene of the run that wrote a table, with the changes of the command line. */
static int write_scene_again(const struct options *o, fl_err *err)
{
    fl_scene scene = {0};
    fl_out out = {0};
    char *history;
    int rc = fl_scene_read_sets(&scene, o->again, &history, err);
    for (int k = 0; k < o->sets && rc == 0; k++) rc = fl_scene_set(&scene, o->set[k], err);
    if (rc == 0) rc = fl_out_open(&out, o->out ? o->out : "-", o->gzip, err);
    if (rc == 0) {
        fprintf(out.f, "#scene 1\n%s", history ? history : "");
        fl_scene_write_given(out.f, &scene);
        rc = fl_out_close(&out, err);
    }
    fl_out_abort(&out);
    free(history);
    fl_scene_free(&scene);
    return rc ? -1 : 0;
}

/* Turn the structure back by structure.direction, about the vertical through its reference: the scene keeps
 * its axes, and so do bounds and inflow. */
static void turn_structure(fl_surface *surface, const fl_scene *scene)
{
    const fl_vec3 at = scene->structure.motion.reference;
    const fl_quat q = q_of_vector(v3(0, 0, -PI / 180.0 * scene->structure.direction));
    for (int32_t k = 0; k < surface->n && scene->structure.direction != 0.0; k++) {
        fl_part *const p = &surface->part[k];
        for (int32_t v = 0; v < p->nv; v++) p->v[v] = v3_add(at, q_rotate(q, v3_sub(p->v[v], at)));
        for (int32_t c = 0; c < p->nc; c++) {
            p->cone[c].p0 = v3_add(at, q_rotate(q, v3_sub(p->cone[c].p0, at)));
            p->cone[c].p1 = v3_add(at, q_rotate(q, v3_sub(p->cone[c].p1, at)));
        }
    }
}

static int run(const struct options *o, int *stopped, fl_err *err)
{
    struct inputs in = {0};
    fl_world world = {0};
    fl_error_budget budget = {0};
    char path[FL_SCENE_PATH];
    int32_t *order = NULL, *group = NULL;
    fl_string_table groups = {0};
    int rc = -1;
    if (o->explain) return fl_scene_explain(stdout, o->explain, err);
    if (o->again) return write_scene_again(o, err);
    if (read_inputs(&in, o, err)) goto done;
    if (o->echo) {
        fl_scene_write(stdout, &in.scene);
        rc = 0;
        goto done;
    }
    const fl_surface *surface = in.surface.n ? &in.surface : NULL;
    const fl_member_model *members = in.members.file ? &in.members : NULL;
    if (in.field.n == 0) {
        fl_fail(err, FL_INPUT, "%s: the file has no body; an ice field expected", in.scene.ice.file);
        goto done;
    }
    const int has_inflow = in.scene.boundary.inflow != FL_INFLOW_NONE;
    if (make_input_texts(&in, surface, err)) goto done;
    turn_structure(&in.surface, &in.scene);
    if (sort_field(&in.field, &order, err) || (in.feed.n && sort_field(&in.feed, NULL, err)) ||
        fl_world_make_with_inflow(&world, &in.scene, &in.field, in.feed.n ? &in.feed : &in.field, surface,
                                  members, err) ||
        (!o->resume && fl_world_check_walls(&world, err)) || extend_order(&order, in.field.n, world.n, err) ||
        (in.scene.run.error > 0.0 &&
         fl_error_budget_make(&budget, &in.scene, &in.field, in.feed.n ? &in.feed : &in.field, surface,
                              members, err)))
        goto done;
    /* the groups of the bodies, for stages; the field goes */
    if (!has_inflow && !o->factor) {
        group = in.field.group, groups = in.field.groups;
        in.field.group = NULL, in.field.groups = (fl_string_table){0};
        fl_ice_field_free(&in.field);
    }
    struct run r = {.o = o,
                    .scene = &in.scene,
                    .floes = in.floes,
                    .order = order,
                    .surface = surface,
                    .frames_surface = members ? &in.frames_surface : surface,
                    .members = members,
                    .history = in.history,
                    .by = &in.by,
                    .resumed = o->resume ? &in.saved : NULL,
                    .input_text = in.input_text,
                    .loads_path = o->out ? o->out : "-",
                    .gzip = o->gzip,
                    .w = &world,
                    .group = group,
                    .groups = &groups,
                    .settles = in.scene.run.relax || in.scene.n_stage,
                    .budget = in.scene.run.error > 0.0 ? &budget : NULL};
    if (o->resume && !o->out) {
        const fl_restart_part *loads = fl_restart_find(&in.saved, "loads");
        snprintf(path, sizeof path, "%.*s",
                 loads ? (int)(loads->n < FL_SCENE_PATH ? loads->n : FL_SCENE_PATH) : 1,
                 loads ? loads->text : "-");
        r.loads_path = path;
    }
    if (o->factor) {
        r.group = in.field.group, r.groups = &in.field.groups;
        if (has_inflow)
            fl_fail(err, FL_USAGE, "--factor: boundary.inflow changes the model, none is expected");
        else rc = factor_search(&r, o->factor, make_trial_world, &in, err);
        goto done;
    }
    if (targets_check(&in.scene, o, r.loads_path, err)) goto done;
    if (fl_device_choose(&world, r.device, err)) goto done;
    choose_step(&r);
    if (check_step_count(&r, err)) goto done;
    if (!o->quiet && fl_world_bonds(&world)) note_long_bonds(&world, stderr);
    rc = run_or_print(&r, err);
    *stopped = r.stopped;
    if (r.stopped && !o->quiet) print_stop(&r);
done:
    free(order), free(group);
    fl_string_table_free(&groups);
    for (int k = 0; k < INPUT_TEXTS; k++) free(in.text[k]);
    free(in.history);
    fl_restart_free(&in.saved);
    fl_world_free(&world);
    fl_error_budget_free(&budget);
    fl_surface_free(&in.surface);
    fl_surface_free(&in.frames_surface);
    fl_member_model_free(&in.members);
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
    if (rc == 0 && stopped == SIGPIPE) { /* end silently, as programs in a pipe do */
        signal(SIGPIPE, SIG_DFL);
        raise(SIGPIPE);
    }
    rc = fl_tool_end("dem-solve", rc, &err);
    if (rc == 0 && stopped) raise(stopped); /* so that the sender sees it */
    return rc;
}
