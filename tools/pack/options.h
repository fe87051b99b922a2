/* SPDX-License-Identifier: GPL-3.0-or-later */
/* options.h -- the command line of pack. */
#ifndef PACK_OPTIONS_H
#define PACK_OPTIONS_H
#include "base/tool.h"
#include "pack/growth.h"
#include "pack/pack_world.h"
#include "pack/throwing.h"

enum target { TARGET_NONE, TARGET_POROSITY, TARGET_SOLID, TARGET_NUMBER };
enum grow { GROW_RELAX, GROW_DYNAMIC };
enum straight { STRAIGHT_LOG, STRAIGHT_LINEAR };

struct options {
    const char *in, *periodic, *helper, *grading, *shapes;
    const char *layer[FL_PACK_LAYERS_MAX]; /* [layer_count] REGION=GRADING */
    int layer_count;
    int dim, straight;
    double porosity, solid; /* NAN: not given */
    int32_t number;         /* 0: not given */
    int throwing, grow, trim;
    double layers;
    double gravity; /* 0: none */
    double friction, young, density, restitution;
    uint64_t seed;
    double until; /* growth ends at this scale, for a checkpoint */
    const char *material, *group;
    const char *certificate, *plot, *format;
    const char *checkpoint, *resume;
    const char *out;
    int gzip, quiet, verbose, threads;
    int ended;
};

/* Answers --help and --version itself.  -1 with FL_USAGE. */
int options_parse(struct options *o, int argc, char **argv, fl_err *err);

/* What is asked: the solid part of the region, or NAN for a number of bodies. */
double options_solid(const struct options *o);

/* Whether sizes follow a curve or a list, and not the shapes. */
int options_graded(const struct options *o);

/* What bears on the result, for the history. */
void options_by(const struct options *o, fl_history_line *by);

#endif
