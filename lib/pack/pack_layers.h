/* SPDX-License-Identifier: GPL-3.0-or-later */
/* pack_layers.h -- layers of a region, each with a grading of its own.
 *
 * A layer is what a second region, of any form, has in common with the region that is filled; of two that
 * overlap the first counts. What no layer holds takes the grading of the rest. The part f_k of the volume in
 * layer k is the mean over POINTS points of the sequence of Halton (bases 2, 3, 5), the same for every run,
 * with an error of some 1e-4; the parts add up to 1, so that the solid volume of the whole is exact. Each
 * layer is filled to the solid part of the whole with sizes of its own, fl_grading_draw().
 *
 * Bodies are thrown where their centre is in their layer. They move by less than their size while they grow,
 * so that a layer is sharp to about one size.
 * Source: Halton, Numerische Mathematik 2 (1960) 84. */
#ifndef FL_PACK_PACK_LAYERS_H
#define FL_PACK_PACK_LAYERS_H
#include "pack/grading.h"
#include "pack/pack_region.h"

/* Most layers of a packing, without the rest. */
enum { FL_PACK_LAYERS_MAX = 32 };

typedef struct {
    int32_t n;                                  /* without the rest, which is layer n */
    fl_pack_region region[FL_PACK_LAYERS_MAX];  /* [n] */
    fl_grading grading[FL_PACK_LAYERS_MAX + 1]; /* [n + 1]; the last one may be empty */
    double part[FL_PACK_LAYERS_MAX + 1];        /* of the volume [n + 1] */
    int32_t *of;                                /* layer of each body that was drawn */
} fl_pack_layers;

/* Adds a layer. text: REGION=GRADING, a region as for fl_region_make() and a law or a file as for
 * fl_grading_law(), fl_grading_read().  -1 with FL_USAGE, FL_INPUT or FL_SYSTEM; the sentence names text. */
int fl_pack_layers_add(fl_pack_layers *l, const char *text, int dim, int linear, fl_err *err);

/* Measures the parts in region r.  rest: the grading of what is left, or NULL, where nothing may be left.
 *   all  out: the curve of all bodies: the pieces of all layers, weighted with the parts
 * -1 with FL_INPUT (a layer outside the region; a part without a grading) or FL_SYSTEM. */
int fl_pack_layers_measure(fl_pack_layers *l, const fl_pack_region *r, const fl_grading *rest,
                           fl_grading *all, fl_err *err);

/* Layer of a point of the region, l->n for the rest. */
int32_t fl_pack_layers_find(const fl_pack_layers *l, fl_vec3 x);

/* Draws the bodies of all layers in descending order of size, and sets l->of. Arguments as of
 * fl_grading_draw(); volume: of all bodies. */
int fl_pack_layers_draw(fl_pack_layers *l, int dim, double v, double volume, double **size, int32_t *n,
                        int32_t *empty, fl_err *err);

void fl_pack_layers_free(fl_pack_layers *l); /* accepts a zeroed struct, leaves one */

#endif
