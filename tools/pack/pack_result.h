/* SPDX-License-Identifier: GPL-3.0-or-later */
/* pack_result.h -- what a run of pack has reached, for certificate and pictures. */
#ifndef PACK_PACK_RESULT_H
#define PACK_PACK_RESULT_H
#include "options.h"
#include "pack/packing_certificate.h"

struct result {
    fl_pack_region region;
    fl_grading grading;
    fl_pack_layers layers; /* n = 0: none */
    fl_grading others;     /* of what no layer holds */
    fl_pack_shapes shapes;
    fl_packing packing;
    fl_overlaps overlaps;
    fl_growth growth;
    fl_pack_moved moved; /* of --grow dynamic */
    fl_pack_moved rest;  /* of --gravity */
    fl_packing_certificate certificate;
    fl_packing_layer layer[FL_PACK_LAYERS_MAX + 1];
    double asked; /* solid part; NAN for a number of bodies */
    int32_t empty, halved;
    int stopped; /* by --until or a signal */
};

#endif
