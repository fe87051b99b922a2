/* SPDX-License-Identifier: GPL-3.0-or-later */
/* string_table.h -- hash table of strings.  Distinct strings are numbered from 0 in order of appearance. */
#ifndef FL_BASE_STRING_TABLE_H
#define FL_BASE_STRING_TABLE_H
#include <stdint.h>
#include "base/err.h"

typedef struct {
    int32_t n, cap, slots; /* slots: 0 or a power of two above 3 n / 2 */
    char **name;           /* [n] */
    int32_t *slot;         /* [slots] number of the string in this slot, plus one; 0 when free */
} fl_string_table;

/* Number of the string, which is added if new.  -1 with FL_SYSTEM, and nothing added. */
int32_t fl_string_table_add(fl_string_table *s, const char *word, fl_err *err);

/* Number of the string, or -1. */
int32_t fl_string_table_find(const fl_string_table *s, const char *word);

void fl_string_table_free(fl_string_table *s); /* accepts a zeroed struct, leaves one */

#endif
