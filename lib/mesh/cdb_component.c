/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdlib.h>
#include "base/array.h"
#include "mesh/cdb_component.h"

void fl_cdb_component_free(fl_cdb_components *c)
{
    free(c->range);
    *c = (fl_cdb_components){0};
}

int fl_cdb_component_add(fl_cdb_components *c, int32_t set, int64_t lo, int64_t hi, fl_err *err)
{
    if (fl_grow(&c->range, &c->cap, (int64_t)c->n + 1, sizeof *c->range, err)) return -1;
    c->range[c->n++] = (fl_cdb_range){lo, hi, set};
    return 0;
}

static int by_set(const void *pa, const void *pb)
{
    const fl_cdb_range *a = pa, *b = pb;
    if (a->set != b->set) return a->set < b->set ? -1 : 1;
    if (a->lo != b->lo) return a->lo < b->lo ? -1 : 1;
    return a->hi < b->hi ? -1 : a->hi > b->hi;
}

typedef struct {
    int64_t id;
    int32_t element;
} numbered_element;

static int by_id(const void *pa, const void *pb)
{
    const numbered_element *a = pa, *b = pb;
    return a->id < b->id ? -1 : a->id > b->id;
}

/* Merge overlapping ranges of a component, so that it holds an element once. */
static void merge_ranges(fl_cdb_components *c)
{
    int32_t n = 0;
    qsort(c->range, (size_t)c->n, sizeof *c->range, by_set);
    for (int32_t i = 1; i < c->n; i++) {
        fl_cdb_range *last = &c->range[n];
        if (c->range[i].set == last->set && c->range[i].lo <= last->hi + 1) {
            if (c->range[i].hi > last->hi) last->hi = c->range[i].hi;
        } else {
            c->range[++n] = c->range[i];
        }
    }
    c->n = n + 1;
}

/* First of the sorted numbers that is not below id. */
static int32_t lower_bound(const numbered_element *at, int32_t n, int64_t id)
{
    int32_t lo = 0, hi = n;
    while (lo < hi) {
        const int32_t mid = lo + (hi - lo) / 2;
        if (at[mid].id < id) lo = mid + 1;
        else hi = mid;
    }
    return lo;
}

/* Assign each element to the smallest component that holds it, the first of equals; with picks, also add it
 * to the set of each component. */
static int assign_elements(const fl_cdb_components *c, fl_elements *e, const numbered_element *at, int32_t n,
                           int picks, fl_err *err)
{
    const int32_t sets = e->sets.n;
    int64_t *size = fl_alloc(sets, sizeof *size, err);
    int32_t *best = fl_alloc(e->element_id.n, sizeof *best, err); /* set plus one */
    int rc = -1;
    if (!size || !best) goto done;
    for (int pass = 0; pass < 2; pass++)
        for (int32_t i = 0; i < c->n; i++) {
            const fl_cdb_range *r = &c->range[i];
            for (int32_t k = lower_bound(at, n, r->lo); k < n && at[k].id <= r->hi; k++) {
                int32_t *b = &best[at[k].element];
                if (pass == 0) size[r->set]++;
                else if (*b == 0 || size[r->set] < size[*b - 1]) *b = r->set + 1;
                if (pass && picks &&
                    fl_elements_pick(e, (fl_pick){at[k].element, r->set, FL_PICK_WHOLE, 0}, err))
                    goto done;
            }
        }
    for (int32_t i = 0; i < e->element_id.n; i++) {
        int32_t part;
        if (best[i] == 0) continue;
        part = fl_string_table_add(&e->parts, e->sets.name[best[i] - 1], err);
        if (part < 0) goto done;
        e->element[i].part = part;
    }
    rc = 0;
done:
    free(size);
    free(best);
    return rc;
}

int fl_cdb_component_assign(fl_cdb_components *c, fl_elements *e, int picks, fl_err *err)
{
    numbered_element *at;
    int32_t n = 0;
    int rc;
    if (c->n == 0) return 0;
    at = fl_alloc(e->element_id.n, sizeof *at, err);
    if (!at) return -1;
    merge_ranges(c);
    for (int32_t i = 0; i < e->element_id.n; i++)
        if (e->element_id.scope[i] == 0) at[n++] = (numbered_element){e->element_id.id[i], i};
    qsort(at, (size_t)n, sizeof *at, by_id);
    rc = assign_elements(c, e, at, n, picks, err);
    free(at);
    return rc;
}
