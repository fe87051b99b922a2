/* SPDX-License-Identifier: GPL-3.0-or-later */
/* block_field.h -- ice blocks as bodies of a field. */
#ifndef VORONOI_ICE_BLOCK_FIELD_H
#define VORONOI_ICE_BLOCK_FIELD_H
#include "ice/blocks.h"
#include "recipe.h"

/* Random numbers of region k (k = 1, 2, ...) start at this entity, times k: none is that of a floe. */
#define BLOCK_FIELD_FIRST_SITE ((int64_t)1 << 32)

/* Append the blocks, moved by shift [m], as bodies with the ids *id, *id + 1, ...; *id is advanced.
 * Returns 0, or -1 with FL_INPUT (ids are exhausted) or FL_SYSTEM. */
int block_field_add(const fl_blocks *b, const struct recipe *o, int64_t *id, fl_vec3 shift, fl_ice_field *out,
                    fl_err *err);

#endif
