/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "base/parallel.h"
#include "geom/topology.h"

static size_t loop_length(const fl_poly *p) { return (size_t)p->first[p->nf]; }

/* Edges and neighbours of a vertex follow from the faces. */
static uint64_t key_of(const fl_poly *p)
{
    const int32_t size[2] = {p->nv, p->nf};
    uint64_t h = fl_hash(FL_HASH_START, size, sizeof size);
    h = fl_hash(h, p->first, (p->nf + (int64_t)1) * (int64_t)sizeof *p->first);
    return fl_hash(h, p->loop, (int64_t)(loop_length(p) * sizeof *p->loop));
}

/* Points the arrays of p to those of a topology. */
static void borrow_arrays(fl_poly *p, const fl_topology *t)
{
    p->edge = t->mem;
    p->first = (int32_t *)(void *)(p->edge + t->ne);
    p->loop = p->first + t->nf + 1;
    p->neighbour_first = p->loop + p->first[t->nf];
    p->neighbour = p->neighbour_first + t->nv + 1;
    p->shared = 1;
}

static int is_same_topology(const fl_topology *t, const fl_poly *p)
{
    if (t->nv != p->nv || t->nf != p->nf || t->ne != p->ne) return 0;
    const int32_t *first = (const int32_t *)(const void *)((const fl_edge *)t->mem + t->ne);
    const size_t faces = (size_t)p->nf + 1;
    return memcmp(first, p->first, faces * sizeof *first) == 0 &&
           memcmp(first + faces, p->loop, loop_length(p) * sizeof *first) == 0;
}

/* First slot to search for a key. */
static int32_t slot_of(const fl_topologies *t, uint64_t key) { return (int32_t)(key % (uint64_t)t->slots); }

static int32_t next_slot(const fl_topologies *t, int32_t s) { return s + 1 < t->slots ? s + 1 : 0; }

static int reserve_kind(fl_topologies *t, fl_err *err)
{
    if (fl_grow(&t->kind, &t->kind_cap, (int64_t)t->n + 1, sizeof *t->kind, err)) return -1;
    if (2 * (int64_t)t->n + 2 <= t->slots) return 0;
    const int64_t slots = t->slots ? 2 * (int64_t)t->slots : 64;
    int32_t *fresh = slots <= INT32_MAX ? fl_alloc(slots, sizeof *fresh, err) : NULL;
    if (!fresh) return err->code ? -1 : fl_fail(err, FL_SYSTEM, "out of memory: %d shapes", t->n);
    free(t->slot);
    t->slot = fresh;
    t->slots = (int32_t)slots;
    for (int32_t k = 0; k < t->n; k++) {
        int32_t s = slot_of(t, t->kind[k].key);
        while (t->slot[s]) s = next_slot(t, s);
        t->slot[s] = k + 1;
    }
    return 0;
}

/* The topology of p, added if it is new. */
static const fl_topology *find_or_add(fl_topologies *t, const fl_poly *p, fl_err *err)
{
    const uint64_t key = key_of(p);
    if (reserve_kind(t, err)) return NULL;
    int32_t s = slot_of(t, key);
    for (; t->slot[s]; s = next_slot(t, s)) {
        const fl_topology *k = &t->kind[t->slot[s] - 1];
        if (k->key == key && is_same_topology(k, p)) return k;
    }
    const size_t nv = (size_t)p->nv, nf = (size_t)p->nf, ne = (size_t)p->ne, nl = loop_length(p);
    fl_topology k = {.key = key, .nv = p->nv, .nf = p->nf, .ne = p->ne};
    const size_t whole = nf + 1 + nl + nv + 1 + 2 * ne;
    if (fl_grow(&k.mem, &k.bytes, (int64_t)(ne * sizeof *p->edge + whole * sizeof(int32_t)), 1, err))
        return NULL;
    char *at = k.mem;
    at = (char *)memcpy(at, p->edge, ne * sizeof *p->edge) + ne * sizeof *p->edge;
    at = (char *)memcpy(at, p->first, (nf + 1) * sizeof *p->first) + (nf + 1) * sizeof *p->first;
    at = (char *)memcpy(at, p->loop, nl * sizeof *p->loop) + nl * sizeof *p->loop;
    at = (char *)memcpy(at, p->neighbour_first, (nv + 1) * sizeof *p->neighbour_first) +
         (nv + 1) * sizeof *p->neighbour_first;
    memcpy(at, p->neighbour, 2 * ne * sizeof *p->neighbour);
    t->kind[t->n] = k;
    t->slot[s] = ++t->n;
    return &t->kind[t->n - 1];
}

/* With more angles than this, all are kept. */
enum { KEPT_ANGLES_MAX = 8 };

/* Collects the angles below the blunt limits and the edge or vertex of each.  Returns KEPT_ANGLES_MAX + 1 if
 * there are more. */
static int16_t collect_blunt_angles(const fl_poly *p, double angle[KEPT_ANGLES_MAX],
                                    int32_t of[KEPT_ANGLES_MAX])
{
    int16_t n = 0;
    for (int32_t k = 0; k < p->ne + p->nv; k++) {
        const double a = k < p->ne ? fl_poly_edge_angle(p, k) : fl_poly_corner_angle(p, k - p->ne);
        if (a >= (k < p->ne ? FL_POLY_BLUNT_EDGE : FL_POLY_BLUNT_CORNER)) continue;
        if (n == KEPT_ANGLES_MAX) return KEPT_ANGLES_MAX + 1;
        angle[n] = a;
        of[n++] = k;
    }
    return n;
}

int fl_topologies_share(fl_topologies *t, fl_poly *p, unsigned keep, fl_err *err)
{
    const size_t nv = (size_t)p->nv, nf = (size_t)p->nf, ne = (size_t)p->ne;
    const fl_topology *kind = find_or_add(t, p, err);
    fl_poly q = *p;
    double angle[KEPT_ANGLES_MAX];
    int32_t of[KEPT_ANGLES_MAX], bytes = 0;
    const int16_t few = keep & FL_KEEP_ANGLES ? collect_blunt_angles(p, angle, of) : 0;
    const int all = few > KEPT_ANGLES_MAX;
    const size_t kept = all ? 0 : (size_t)few, offsets = keep & FL_KEEP_OFFSETS ? nf : 0;
    q.v = NULL;
    q.kept_angles = (int16_t)kept;
    if (!kind || fl_grow(&q.v, &bytes,
                         (int64_t)((nv + nf) * sizeof *q.v + offsets * sizeof *q.c +
                                   (all ? (ne + nv) * sizeof *q.bend : 0) + kept * sizeof *angle +
                                   (kept + 1) / 2 * 2 * sizeof *of),
                         1, err))
        return -1;
    memcpy(q.v, p->v, nv * sizeof *q.v);
    q.n = memcpy(q.v + nv, p->n, nf * sizeof *q.n);
    double *at = (double *)(void *)(q.n + nf);
    memcpy(at, angle, kept * sizeof *angle);
    memcpy(at += kept, of, kept * sizeof *of);
    at += (kept + 1) / 2;
    q.bend = all ? memcpy(at, p->bend, ne * sizeof *at) : NULL;
    q.defect = all ? memcpy(at + ne, p->defect, nv * sizeof *at) : NULL;
    at += all ? ne + nv : 0;
    q.c = offsets || nf == 0 ? memcpy(at, p->c, offsets * sizeof *at) : NULL;
    borrow_arrays(&q, kind);
    fl_poly_free(p);
    *p = q;
    return 0;
}

double fl_topologies_bytes(const fl_topologies *t)
{
    size_t sum = (size_t)t->kind_cap * sizeof *t->kind + (size_t)t->slots * sizeof *t->slot;
    for (int32_t k = 0; k < t->n; k++) sum += (size_t)t->kind[k].bytes;
    return (double)sum;
}

void fl_topologies_free(fl_topologies *t)
{
    for (int32_t k = 0; k < t->n; k++) free(t->kind[k].mem);
    free(t->kind), free(t->slot);
    *t = (fl_topologies){0};
}
