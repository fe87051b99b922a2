/* SPDX-License-Identifier: GPL-3.0-or-later */
/* id_map.h -- map from sparse numbers of nodes and elements to indices.
 *
 * Each different pair of a scope and a number gets an index, counted from 0 in the order of first appearance.
 * Most files number upward and refer to nearby numbers: as long as all numbers rise no hash table is built,
 * and the first guess is that numbers are consecutive from the last one found.  Any other order needs the
 * hash table. */
#ifndef FL_MESH_ID_MAP_H
#define FL_MESH_ID_MAP_H
#include <stdint.h>
#include "base/err.h"

typedef struct {
    int32_t n, last, id_cap, scope_cap;
    int32_t slots;  /* 0 while all numbers rise, else a power of two above 3 n / 2 */
    int64_t *id;    /* [n] the number in the file */
    int32_t *scope; /* [n] the name space of the number: an instance of a part, 0 in a flat file */
    int32_t *slot;  /* [slots] index plus one, 0 when free */
} fl_id_map;

/* Index of (scope, id), which is added if new.  -1 with FL_SYSTEM in err, and nothing added. */
int32_t fl_id_map_add(fl_id_map *s, int32_t scope, int64_t id, fl_err *err);

/* Index of (scope, id), -1 if there is none. */
int32_t fl_id_map_find(const fl_id_map *s, int32_t scope, int64_t id);

void fl_id_map_free(fl_id_map *s); /* accepts a zeroed struct, leaves one */

#endif
