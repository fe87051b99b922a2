/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "targets.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/output_guard.h"
#include "base/array.h"
#include "base/number_text.h"

/* An input, or NULL for the checkpoint that is gone on from, where that is to be renewed. */
static const char *kept(const char *input, const fl_scene *s, const struct options *o)
{
    const int renewed = o->resume && fl_same_file(o->resume, s->output.checkpoint);
    return renewed && fl_same_file(o->resume, input) ? NULL : input;
}

/* Whether path is one of the files over which the frames are split, NAME.0 and up. */
static int is_frame(const fl_scene *s, const char *path)
{
    char stem[FL_SCENE_PATH];
    int32_t k;
    const char *dot = path ? strrchr(path, '.') : NULL;
    if (!dot || (size_t)(dot - path) >= sizeof stem || fl_number_i32(dot + 1, 0, s->output.files - 1, &k))
        return 0;
    snprintf(stem, sizeof stem, "%.*s", (int)(dot - path), path);
    return fl_same_file(stem, s->output.frames);
}

static int check_frames(const fl_scene *s, const fl_named_path *out, size_t outs, const fl_named_path *in,
                        size_t ins, fl_err *err)
{
    for (size_t k = 0; k < outs; k++)
        if (is_frame(s, out[k].path))
            return fl_fail(err, FL_USAGE,
                           "%s is \"%.200s\", which is one of the %d files of output.frames already",
                           out[k].what, out[k].path, s->output.files);
    for (size_t k = 0; k < ins; k++)
        if (is_frame(s, in[k].path))
            return fl_fail(err, FL_USAGE, "one of the %d files of output.frames is an input, %.200s",
                           s->output.files, in[k].path);
    return 0;
}

int targets_check(const fl_scene *s, const struct options *o, const char *loads, fl_err *err)
{
    const int split = s->output.files > 1 && s->output.frames[0];
    const fl_named_path out[] = {{"--output", loads},
                                 {"--report", o->report},
                                 {"output.frames", split ? NULL : s->output.frames},
                                 {"output.state", s->output.state},
                                 {"output.energy", s->output.energy},
                                 {"output.contacts", s->output.contacts},
                                 {"output.hash", s->output.hash},
                                 {"output.panels", s->output.panels},
                                 {"output.events", s->output.events},
                                 {"output.bonds", s->output.bonds},
                                 {"output.checkpoint", s->output.checkpoint}};
    const char *const one[] = {o->resume,
                               o->scene,
                               s->ice.file,
                               s->structure.file,
                               s->structure.motion.track,
                               s->boundary.inflow_file,
                               s->water.profile_file};
    const size_t ones = sizeof one / sizeof *one;
    size_t n = 0;
    fl_named_path *in = fl_alloc((int64_t)ones + s->n_part + s->n_file, sizeof *in, err);
    if (!in) return -1;
    for (size_t k = 0; k < ones; k++) in[n++].path = kept(one[k], s, o);
    for (int32_t k = 0; k < s->n_part; k++) in[n++].path = s->part[k].motion.track;
    for (int32_t k = 0; k < s->n_file; k++) in[n++].path = kept(s->file[k], s, o);
    const size_t outs = sizeof out / sizeof *out;
    const int rc =
        fl_output_guard_check(out, outs, in, n, err) || (split && check_frames(s, out, outs, in, n, err)) ? -1
                                                                                                          : 0;
    free(in);
    return rc;
}
