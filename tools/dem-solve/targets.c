/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "targets.h"
#include "base/mem.h"
#include "base/clobber.h"

/* An input, or NULL for the checkpoint that is gone on from, where that is to be renewed. */
static const char *kept(const char *input, const fl_scene *s, const struct options *o)
{
    const int renewed = o->resume && fl_same_file(o->resume, s->output.checkpoint);
    return renewed && fl_same_file(o->resume, input) ? NULL : input;
}

int targets_check(const fl_scene *s, const struct options *o, const char *loads, fl_err *err)
{
    const fl_target out[] = {{"--output", loads},
                             {"--report", o->report},
                             {"output.frames", s->output.frames},
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
    fl_target *in = fl_alloc((int64_t)ones + s->n_part + s->n_file, sizeof *in, err);
    if (!in) return -1;
    for (size_t k = 0; k < ones; k++) in[n++].path = kept(one[k], s, o);
    for (int32_t k = 0; k < s->n_part; k++) in[n++].path = s->part[k].motion.track;
    for (int32_t k = 0; k < s->n_file; k++) in[n++].path = kept(s->file[k], s, o);
    const int rc = fl_clobber_check(out, sizeof out / sizeof *out, in, n, err);
    free(in);
    return rc;
}
