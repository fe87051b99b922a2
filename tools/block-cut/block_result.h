/* SPDX-License-Identifier: GPL-3.0-or-later */
/* block_result.h -- what a run of block-cut has made. */
#ifndef BLOCK_CUT_BLOCK_RESULT_H
#define BLOCK_CUT_BLOCK_RESULT_H
#include "block/block_certificate.h"
#include "block/sliver.h"

struct result {
    fl_joint_sets sets; /* sorted */
    fl_block_model model;
    fl_face_pairs pairs;
    fl_block_certificate certificate;
    fl_slivers slivers;
    double radius, min_thickness;
    int32_t deleted;
    double deleted_volume;
    int32_t joints, lost_joints; /* written; of faces that the core has lost */
    double lost_area;
};

#endif
