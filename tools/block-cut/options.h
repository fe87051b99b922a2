/* SPDX-License-Identifier: GPL-3.0-or-later */
/* options.h -- the command line of block-cut. */
#ifndef BLOCK_CUT_OPTIONS_H
#define BLOCK_CUT_OPTIONS_H
#include "base/tool.h"
#include "block/joint_set.h"

enum { REGIONS_MAX = 64 };

/* NAME=REGION */
struct named_region {
    char name[64];
    const char *in;
    int cut; /* 1: --region, which cuts; 0: --group */
};

struct options {
    const char *in;
    double z[2], y[2]; /* of an outline: --height or --depth; NAN: not given */
    fl_joint_sets joints;
    const char *joint_text[REGIONS_MAX]; /* as given, for the history */
    int32_t joint_texts;
    const char *joint_file;
    struct named_region region[REGIONS_MAX];
    int32_t regions;
    const char *remove[REGIONS_MAX];
    int32_t removes;
    double radius, min_thickness, min_volume; /* NAN: not given */
    int keep_slivers;
    uint64_t seed;
    const char *material, *group;
    const char *certificate, *plot, *format;
    const char *out;
    int gzip, quiet, verbose, threads;
    int ended;
};

/* Answers --help and --version itself.  -1 with FL_USAGE or FL_INPUT. */
int options_parse(struct options *o, int argc, char **argv, fl_err *err);
void options_free(struct options *o);

/* What bears on the result, for the history. */
void options_by(const struct options *o, fl_history_line *by);

#endif
