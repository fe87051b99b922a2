/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <string.h>
#include <sys/stat.h>
#include "targets.h"

static int is_file(const char *path, struct stat *of)
{
    return path && path[0] && strcmp(path, "-") != 0 && stat(path, of) == 0 && S_ISREG(of->st_mode);
}

static int is_same(const struct stat *of, const char *path)
{
    struct stat other;
    return is_file(path, &other) && other.st_dev == of->st_dev && other.st_ino == of->st_ino;
}

/* Is the file `to`, which `what` names, the input? */
static int is_input(const char *what, const char *to, const struct stat *of, const char *input, fl_err *err)
{
    if (!is_same(of, input)) return 0;
    fl_fail(err, FL_USAGE, "%s is \"%s\", which is an input, %s", what, to, input);
    return 1;
}

static int check(const fl_scene *s, const struct options *o, const char *what, const char *to, fl_err *err)
{
    struct stat of;
    if (!is_file(to, &of) || (strcmp(what, "output.checkpoint") == 0 && is_same(&of, o->resume))) return 0;
    const char *const input[] = {o->resume,
                                 o->scene,
                                 s->ice.file,
                                 s->structure.file,
                                 s->structure.motion.track,
                                 s->boundary.inflow_file,
                                 s->water.profile_file};
    for (size_t k = 0; k < sizeof input / sizeof *input; k++)
        if (is_input(what, to, &of, input[k], err)) return -1;
    for (int32_t k = 0; k < s->n_part; k++)
        if (is_input(what, to, &of, s->part[k].motion.track, err)) return -1;
    for (int32_t k = 0; k < s->n_file; k++)
        if (is_input(what, to, &of, s->file[k], err)) return -1;
    return 0;
}

int targets_check(const fl_scene *s, const struct options *o, fl_err *err)
{
    const struct {
        const char *what, *to;
    } IT[] = {{"--output", o->out},
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
    for (size_t k = 0; k < sizeof IT / sizeof *IT; k++)
        if (check(s, o, IT[k].what, IT[k].to, err)) return -1;
    return 0;
}
