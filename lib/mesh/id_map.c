/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdlib.h>
#include "base/array.h"
#include "mesh/id_map.h"

/* Mix all bits of the key into the low ones: files number their nodes 1, 2, 3 ... or in tens of thousands.
 * Constants: finaliser of SplitMix64, Steele, Lea & Flood, OOPSLA (2014). */
static uint64_t hash_pair(int32_t scope, int64_t id)
{
    uint64_t h = (uint64_t)id + (uint64_t)scope * UINT64_C(0x9e3779b97f4a7c15);
    h = (h ^ h >> 30) * UINT64_C(0xbf58476d1ce4e5b9);
    h = (h ^ h >> 27) * UINT64_C(0x94d049bb133111eb);
    return h ^ h >> 31;
}

/* Slot of the pair, or the free slot where it would go; slots > 0, and at least one is free. */
static int32_t find_slot(const fl_id_map *s, int32_t scope, int64_t id)
{
    int32_t k = (int32_t)(hash_pair(scope, id) & (uint64_t)(s->slots - 1));
    while (s->slot[k] && (s->id[s->slot[k] - 1] != id || s->scope[s->slot[k] - 1] != scope))
        k = (k + 1) & (s->slots - 1);
    return k;
}

/* Double the slots until all pairs and one more fill at most two thirds of them, and rehash. */
static int grow_slots(fl_id_map *s, fl_err *err)
{
    fl_id_map t = *s;
    if (t.slots == 0) t.slots = 16;
    while (3 * ((int64_t)t.n + 1) > 2 * (int64_t)t.slots) t.slots *= 2;
    t.slot = fl_alloc(t.slots, sizeof *t.slot, err);
    if (!t.slot) return -1;
    for (int32_t k = 0; k < s->n; k++) t.slot[find_slot(&t, s->scope[k], s->id[k])] = k + 1;
    free(s->slot);
    *s = t;
    return 0;
}

/* Index of the pair if numbers are consecutive from the one at k, else -1. */
static int32_t find_consecutive(const fl_id_map *s, int32_t k, int32_t scope, int64_t id)
{
    int64_t d;
    if (k >= s->n) return -1;
    d = (int64_t)((uint64_t)id - (uint64_t)s->id[k]);
    if (d < -(int64_t)k || d >= (int64_t)s->n - k) return -1;
    k += (int32_t)d;
    return s->id[k] == id && s->scope[k] == scope ? k : -1;
}

static int precedes(const fl_id_map *s, int32_t k, int32_t scope, int64_t id)
{
    return s->scope[k] != scope ? s->scope[k] < scope : s->id[k] < id;
}

/* Without slots, all pairs are in ascending order. */
static int32_t find_sorted(const fl_id_map *s, int32_t scope, int64_t id)
{
    int32_t lo = 0, hi = s->n;
    while (lo < hi) {
        const int32_t mid = lo + (hi - lo) / 2;
        if (precedes(s, mid, scope, id)) lo = mid + 1;
        else hi = mid;
    }
    return lo < s->n && s->id[lo] == id && s->scope[lo] == scope ? lo : -1;
}

int32_t fl_id_map_find(const fl_id_map *s, int32_t scope, int64_t id)
{
    const int32_t k = find_consecutive(s, s->last, scope, id);
    if (k >= 0) return k;
    return s->slots ? s->slot[find_slot(s, scope, id)] - 1 : find_sorted(s, scope, id);
}

int32_t fl_id_map_add(fl_id_map *s, int32_t scope, int64_t id, fl_err *err)
{
    const int rising = s->slots == 0 && (s->n == 0 || precedes(s, s->n - 1, scope, id));
    const int32_t found = rising ? -1 : fl_id_map_find(s, scope, id);
    if (found >= 0) return s->last = found;
    if (s->n >= INT32_MAX / 4) return fl_fail(err, FL_SYSTEM, "more than %d different numbers", s->n);
    if (!rising && 3 * ((int64_t)s->n + 1) > 2 * (int64_t)s->slots && grow_slots(s, err)) return -1;
    if (fl_grow(&s->id, &s->id_cap, (int64_t)s->n + 1, sizeof *s->id, err) ||
        fl_grow(&s->scope, &s->scope_cap, (int64_t)s->n + 1, sizeof *s->scope, err))
        return -1;
    if (!rising) s->slot[find_slot(s, scope, id)] = s->n + 1;
    s->id[s->n] = id;
    s->scope[s->n] = scope;
    return s->last = s->n++;
}

void fl_id_map_free(fl_id_map *s)
{
    free(s->id);
    free(s->scope);
    free(s->slot);
    *s = (fl_id_map){0};
}
