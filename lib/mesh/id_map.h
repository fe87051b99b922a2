/* SPDX-License-Identifier: GPL-3.0-or-later */
/* id_map.h -- sparse numbers of nodes and elements to indices: each different pair of a scope and a number
 * is kept once and counted from 0 as it first appears.
 *
 * Most files count up, and speak of numbers near one another: as long as all rise nothing is hashed, and the
 * first guess is that numbers go on by one from the last that was met.  Any other order costs a hash. */
#ifndef FL_MESH_ID_MAP_H
#define FL_MESH_ID_MAP_H
#include <stdint.h>
#include "base/err.h"

typedef struct {
    int32_t n, last, id_cap, scope_cap;
    int32_t slots;  /* 0 as long as all rise, else a power of two above 3 n / 2 */
    int64_t *id;    /* [n] the number in the file */
    int32_t *scope; /* [n] whose number it is: the instance of a part, 0 in a flat file */
    int32_t *slot;  /* [slots] index plus one, 0 when free */
} fl_id_map;

/* The index of (scope, id), which is added when it is new.  -1 with FL_SYSTEM in err, and nothing added. */
int32_t fl_id_map_add(fl_id_map *s, int32_t scope, int64_t id, fl_err *err);

/* The index of (scope, id), -1 when it is not there. */
int32_t fl_id_map_find(const fl_id_map *s, int32_t scope, int64_t id);

void fl_id_map_free(fl_id_map *s); /* accepts a zeroed struct, leaves one */

#endif
