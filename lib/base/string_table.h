/* SPDX-License-Identifier: GPL-3.0-or-later */
/* string_table.h -- words to numbers: each different word is kept once and numbered from 0 as it first appears. */
#ifndef FL_BASE_STRING_TABLE_H
#define FL_BASE_STRING_TABLE_H
#include <stdint.h>
#include "base/err.h"

typedef struct {
    int32_t n, cap, slots; /* slots: 0 or a power of two above 3 n / 2 */
    char **name;           /* [n] */
    int32_t *slot;         /* [slots] number of the word that hashes here, plus one; 0 when free */
} fl_string_table;

/* The number of word, which is added when it is new.  -1 with FL_SYSTEM in err, and nothing added. */
int32_t fl_string_table_add(fl_string_table *s, const char *word, fl_err *err);

/* The number of word, -1 when it is not there. */
int32_t fl_string_table_find(const fl_string_table *s, const char *word);

void fl_string_table_free(fl_string_table *s); /* accepts a zeroed struct, leaves one */

#endif
