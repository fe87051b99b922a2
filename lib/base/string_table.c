/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <string.h>
#include "base/array.h"
#include "base/string_table.h"
#include "base/parallel.h"

/* The slot of word, or the free slot where it belongs.  slots > 0, and at least one slot is free. */
static int32_t slot_of(const fl_string_table *s, const char *word)
{
    uint64_t h = fl_hash(FL_HASH_START, word, (int64_t)strlen(word));
    h = (h ^ h >> 32) * UINT64_C(0x9e3779b97f4a7c15); /* names of few letters differ in few bits of h */
    int32_t k = (int32_t)(h >> 32 & (uint64_t)(s->slots - 1));
    while (s->slot[k] && strcmp(s->name[s->slot[k] - 1], word) != 0) k = (k + 1) & (s->slots - 1);
    return k;
}

static int grow_slots(fl_string_table *s, fl_err *err)
{
    fl_string_table t = *s;
    t.slots = s->slots ? 2 * s->slots : 16;
    t.slot = fl_alloc(t.slots, sizeof *t.slot, err);
    if (!t.slot) return -1;
    for (int32_t k = 0; k < s->n; k++) t.slot[slot_of(&t, s->name[k])] = k + 1;
    free(s->slot);
    *s = t;
    return 0;
}

int32_t fl_string_table_find(const fl_string_table *s, const char *word)
{
    return s->slots ? s->slot[slot_of(s, word)] - 1 : -1;
}

int32_t fl_string_table_add(fl_string_table *s, const char *word, fl_err *err)
{
    const int32_t found = fl_string_table_find(s, word);
    const size_t bytes = strlen(word) + 1;
    char *copy;
    if (found >= 0) return found;
    if (s->n >= INT32_MAX / 4) return fl_fail(err, FL_SYSTEM, "more than %d different names", s->n);
    if (3 * (s->n + 1) > 2 * s->slots && grow_slots(s, err)) return -1;
    if (fl_grow(&s->name, &s->cap, s->n + 1, sizeof *s->name, err)) return -1;
    copy = fl_alloc((int64_t)bytes, 1, err);
    if (!copy) return -1;
    memcpy(copy, word, bytes);
    s->slot[slot_of(s, word)] = s->n + 1;
    s->name[s->n] = copy;
    return s->n++;
}

void fl_string_table_free(fl_string_table *s)
{
    for (int32_t k = 0; k < s->n; k++) free(s->name[k]);
    free(s->name);
    free(s->slot);
    *s = (fl_string_table){0};
}
