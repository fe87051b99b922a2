/* SPDX-License-Identifier: GPL-3.0-or-later */
/* dem-solve: a scene in, the load on the structure out. */
#include <string.h>
#include "base/mem.h"
#include "base/par.h"
#include "base/stream.h"
#include "options.h"
#include "run.h"
#include "scene/field.h"
#include "mesh/gstruct.h"
#include "scene/scene_check.h"
#include "scene/scene_read.h"
#include "scene/scene_show.h"

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

static int write_report(struct run *r, fl_err *err)
{
    fl_out out = {0};
    if (!r->o->report) {
        if (!r->o->quiet) report_write(r, stderr);
        return 0;
    }
    if (fl_out_open(&out, r->o->report, 0, err)) return -1;
    report_write(r, out.f);
    return fl_out_close(&out, err);
}

/* What was asked for, with everything read. */
static int act(struct run *r, fl_err *err)
{
    fl_out out = {0};
    if (r->o->plan || r->o->probe >= 0.0) {
        if (fl_out_open(&out, r->o->out, r->o->gzip, err)) return -1;
        if (r->o->plan ? look_plan(r, out.f, err) : look_probe(r, out.f, err)) {
            fl_out_abort(&out);
            return -1;
        }
        return fl_out_close(&out, err);
    }
    const int rc = run_scene(r, err);
    if (err->code != FL_SYSTEM && write_report(r, err)) return -1;
    return rc;
}

static int run(const struct options *o, fl_err *err)
{
    fl_scene scene = {0};
    fl_field field = {0};
    fl_surface surface = {0};
    fl_world world = {0};
    fl_by by;
    char *history = NULL;
    int rc = -1;
    if (o->explain) return fl_scene_explain(stdout, o->explain, err);
    if (read_scene(&scene, o, err)) goto done;
    if (o->echo) {
        fl_scene_write(stdout, &scene);
        rc = 0;
        goto done;
    }
    const int built = scene.structure.head.present && scene.structure.file[0];
    if (fl_field_read(&field, scene.ice.file, err)) goto done;
    if (built && fl_gstruct_read(&surface, scene.structure.file, err)) goto done;
    if (field.n == 0) {
        fl_fail(err, FL_INPUT, "%s: no body in it, a field of ice was wanted", scene.ice.file);
        goto done;
    }
    if (fl_world_make(&world, &scene, &field, built ? &surface : NULL, err)) goto done;
    if (join_history(&history, field.history, surface.history, err)) goto done;
    fl_field_free(&field);
    options_by(o, &by);
    struct run r = {.o = o,
                    .scene = &scene,
                    .surface = built ? &surface : NULL,
                    .history = history,
                    .by = &by,
                    .w = &world};
    run_step_size(&r);
    rc = act(&r, err);
done:
    free(history);
    fl_world_free(&world);
    fl_surface_free(&surface);
    fl_field_free(&field);
    fl_scene_free(&scene);
    return rc;
}

int main(int argc, char **argv)
{
    struct options o;
    fl_err err = {0};
    fl_par_wait_briefly(argv);
    int rc = options_parse(&o, argc, argv, &err);
    if (rc == 0 && !o.ended) rc = run(&o, &err);
    return fl_tool_end("dem-solve", rc, &err);
}
