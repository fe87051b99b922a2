/* SPDX-License-Identifier: GPL-3.0-or-later */
/* block_cuts.h -- a box of rock, cut by joint sets: blocks, pairs of faces, certificate. */
#ifndef FL_TESTS_BLOCK_CUTS_H
#define FL_TESTS_BLOCK_CUTS_H
#include "block/block_certificate.h"
#include "support/small_world.h"

typedef struct {
    fl_joint_sets sets;
    fl_block_model m;
    fl_face_pairs pairs;
    fl_block_certificate c;
} rock_cut;

/* Cuts the box lo .. hi by the sets, texts as for --joint of block-cut(1), up to a NULL.  A failure ends the
 * program with its message. */
void rock_cut_box(rock_cut *t, fl_vec3 lo, fl_vec3 hi, const char *const *set, uint64_t seed);

/* The number of blocks alone: no pairs, no certificate. */
int32_t rock_cut_count(fl_vec3 lo, fl_vec3 hi, const char *const *set, uint64_t seed);

/* Area of the joints of a set; nan for an unknown name [m2]. */
double rock_cut_area(const rock_cut *t, const char *name);

/* Puts the blocks and joints into a lab that has begun.  Block `loose` (-1: none) has no group, the others
 * are of the group rock. */
void rock_cut_fill(const rock_cut *t, lab *l, double radius, int32_t loose);

void rock_cut_free(rock_cut *t);

#endif
