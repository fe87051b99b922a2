/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdlib.h>
#include "base/array.h"
#include "mesh/id_map.h"

/* Mixes all bits of the key into the low ones: files number their nodes 1, 2, 3 ... or in tens of thousands.
 * Constants: the finaliser of SplitMix64, Steele, Lea & Flood, OOPSLA (2014). */
static uint64_t mix(int32_t scope, int64_t id)
{
    uint64_t h = (uint64_t)id + (uint64_t)scope * UINT64_C(0x9e3779b97f4a7c15);
    h = (h ^ h >> 30) * UINT64_C(0xbf58476d1ce4e5b9);
    h = (h ^ h >> 27) * UINT64_C(0x94d049bb133111eb);
    return h ^ h >> 31;
}

/* The slot where the pair is, or the free one where it would go; slots > 0, and one at least is free. */
static int32_t slot_of(const fl_id_map *s, int32_t scope, int64_t id)
{
    int32_t k = (int32_t)(mix(scope, id) & (uint64_t)(s->slots - 1));
    while (s->slot[k] && (s->id[s->slot[k] - 1] != id || s->scope[s->slot[k] - 1] != scope))
        k = (k + 1) & (s->slots - 1);
    return k;
}

/* Slots for all that is there and one more: twice as many as there are, until a third of them is free. */
static int more_slots(fl_id_map *s, fl_err *err)
{
    fl_id_map t = *s;
    if (t.slots == 0) t.slots = 16;
    while (3 * ((int64_t)t.n + 1) > 2 * (int64_t)t.slots) t.slots *= 2;
    t.slot = fl_alloc(t.slots, sizeof *t.slot, err);
    if (!t.slot) return -1;
    for (int32_t k = 0; k < s->n; k++) t.slot[slot_of(&t, s->scope[k], s->id[k])] = k + 1;
    free(s->slot);
    *s = t;
    return 0;
}

/* Where the pair would be if numbers went on by one from that at k; -1 where it is not there. */
static int32_t as_from(const fl_id_map *s, int32_t k, int32_t scope, int64_t id)
{
    int64_t d;
    if (k >= s->n) return -1;
    d = (int64_t)((uint64_t)id - (uint64_t)s->id[k]);
    if (d < -(int64_t)k || d >= (int64_t)s->n - k) return -1;
    k += (int32_t)d;
    return s->id[k] == id && s->scope[k] == scope ? k : -1;
}

static int comes_before(const fl_id_map *s, int32_t k, int32_t scope, int64_t id)
{
    return s->scope[k] != scope ? s->scope[k] < scope : s->id[k] < id;
}

/* As long as there are no slots all are in ascending order. */
static int32_t bisect(const fl_id_map *s, int32_t scope, int64_t id)
{
    int32_t lo = 0, hi = s->n;
    while (lo < hi) {
        const int32_t mid = lo + (hi - lo) / 2;
        if (comes_before(s, mid, scope, id)) lo = mid + 1;
        else hi = mid;
    }
    return lo < s->n && s->id[lo] == id && s->scope[lo] == scope ? lo : -1;
}

int32_t fl_id_map_find(const fl_id_map *s, int32_t scope, int64_t id)
{
    const int32_t k = as_from(s, s->last, scope, id);
    if (k >= 0) return k;
    return s->slots ? s->slot[slot_of(s, scope, id)] - 1 : bisect(s, scope, id);
}

int32_t fl_id_map_add(fl_id_map *s, int32_t scope, int64_t id, fl_err *err)
{
    const int rising = s->slots == 0 && (s->n == 0 || comes_before(s, s->n - 1, scope, id));
    const int32_t found = rising ? -1 : fl_id_map_find(s, scope, id);
    if (found >= 0) return s->last = found;
    if (s->n >= INT32_MAX / 4) return fl_fail(err, FL_SYSTEM, "more than %d different numbers", s->n);
    if (!rising && 3 * ((int64_t)s->n + 1) > 2 * (int64_t)s->slots && more_slots(s, err)) return -1;
    if (fl_grow(&s->id, &s->id_cap, (int64_t)s->n + 1, sizeof *s->id, err) ||
        fl_grow(&s->scope, &s->scope_cap, (int64_t)s->n + 1, sizeof *s->scope, err))
        return -1;
    if (!rising) s->slot[slot_of(s, scope, id)] = s->n + 1;
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
