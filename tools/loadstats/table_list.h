/* SPDX-License-Identifier: GPL-3.0-or-later */
/* table_list.h -- the list of all kinds of tables. */
#ifndef LOADSTATS_TABLE_LIST_H
#define LOADSTATS_TABLE_LIST_H
#include "table_kind.h"

enum { TABLES_MAX = 40 };

/* The number of kinds, at most TABLES_MAX, and kind k. */
int table_count(void);
const struct table *table_at(int k);

/* The kind that is printed unless another one is chosen. */
const struct table *table_default(void);

/* The kind of a name, which must exist. */
const struct table *table_named(const char *name);

/* The kind at position 1, 2, ... of a report; NULL behind the last one. */
const struct table *table_in_report(int position);

/* Options used by any table of the report of one record, table_option. */
unsigned table_report_uses(void);

#endif
