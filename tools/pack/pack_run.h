/* SPDX-License-Identifier: GPL-3.0-or-later */
/* pack_run.h -- the run of pack: region, bodies, throwing, growth, rest, certificate, files. */
#ifndef PACK_PACK_RUN_H
#define PACK_PACK_RUN_H
#include "options.h"
#include "pack/packing_certificate.h"

/* What a run has reached, for certificate and pictures. */
struct result {
    fl_pack_region region;
    fl_grading grading;
    fl_pack_shapes shapes;
    fl_packing packing;
    fl_overlaps overlaps;
    fl_growth growth;
    fl_pack_moved moved; /* of --grow dynamic */
    fl_pack_moved rest;  /* of --gravity */
    fl_packing_certificate certificate;
    double asked; /* solid part; NAN for a number of bodies */
    int32_t empty, halved;
    int stopped; /* by --until or a signal */
};

/* -1 with an error; FL_NO where the bodies jam before the porosity that was asked: all files are written then. */
int pack_run(const struct options *o, fl_err *err);

#endif
