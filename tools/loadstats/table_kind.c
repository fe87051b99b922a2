/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "table_kind.h"

void table_write_columns(FILE *f, const struct options *o)
{
    fputs(o->table->columns, f);
    if (o->table->more_columns) o->table->more_columns(f, o);
    putc('\n', f);
}
