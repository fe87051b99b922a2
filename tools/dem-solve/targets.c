/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "targets.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/output_guard.h"
#include "outputs.h"
#include "base/array.h"
#include "base/number_text.h"

/* The input, or NULL if it is the checkpoint that is resumed and will be replaced. */
static const char *input_path(const char *input, const fl_scene *s, const struct options *o)
{
    const int renewed = o->resume && fl_same_file(o->resume, s->output.checkpoint);
    return renewed && fl_same_file(o->resume, input) ? NULL : input;
}

/* 1 if path is one of the files of the frames, NAME.0 and up. */
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
    char key[TABLES][32];
    fl_named_path out[TABLES + 2] = {{"--output", loads}, {"--report", o->report}};
    size_t outs = 2;
    for (int k = 0; k < TABLES; k++) {
        if (k == TABLE_LOADS) continue;
        snprintf(key[k], sizeof key[k], "output.%s", table_name(k));
        out[outs++] = (fl_named_path){key[k], k == TABLE_FRAMES && split ? NULL : scene_path(s, k)};
    }
    out[outs++] = (fl_named_path){"output.checkpoint", s->output.checkpoint};
    const char *const one[] = {o->resume,
                               o->scene,
                               s->ice.file,
                               s->structure.file,
                               s->structure.members,
                               s->structure.motion.track,
                               s->boundary.inflow_file,
                               s->water.profile_file};
    const size_t ones = sizeof one / sizeof *one;
    size_t n = 0;
    fl_named_path *in = fl_alloc((int64_t)ones + s->n_part + s->n_file, sizeof *in, err);
    if (!in) return -1;
    for (size_t k = 0; k < ones; k++) in[n++].path = input_path(one[k], s, o);
    for (int32_t k = 0; k < s->n_part; k++) in[n++].path = s->part[k].motion.track;
    for (int32_t k = 0; k < s->n_file; k++) in[n++].path = input_path(s->file[k], s, o);
    const int rc =
        fl_output_guard_check(out, outs, in, n, err) || (split && check_frames(s, out, outs, in, n, err)) ? -1
                                                                                                          : 0;
    free(in);
    return rc;
}
