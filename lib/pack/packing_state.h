/* SPDX-License-Identifier: GPL-3.0-or-later */
/* packing_state.h -- a packing on its way: written after a stage of growth, read to go on to the same bytes.
 *
 *     #packing-state 1
 *     hash H                    of what the run depends on, given by the caller
 *     growth ...                members of fl_growth, the scale
 *     body X Y Z SIZE RADIUS BOUND [QW QX QY QZ SHAPE]     one a body */
#ifndef FL_PACK_PACKING_STATE_H
#define FL_PACK_PACKING_STATE_H
#include "pack/growth.h"

/* hash: of regions, gradings and options.  -1 with FL_SYSTEM. */
int fl_packing_state_write(const fl_packing *p, const fl_growth *g, uint64_t hash, const char *path,
                           fl_err *err);

/* Into a packing made from the same options.  -1 with FL_INPUT (another kind, other options, cut short). */
int fl_packing_state_read(fl_packing *p, fl_growth *g, uint64_t hash, const char *path, fl_err *err);

#endif
