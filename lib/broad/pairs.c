/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <string.h>
#include "base/array.h"
#include "broad/pairs.h"

/* How many images of one body to each side of the middle another may meet, and the code of the middle. */
enum { BLOCK = 64, IMAGES = 15, CENTRE = 16 << 10 | 16 << 5 | 16 };

static int ascending(const void *a, const void *b)
{
    const int64_t x = *(const int64_t *)a, y = *(const int64_t *)b;
    return (x > y) - (x < y);
}

/* Scratch of one thread: what a query found, and partners with their images, j << 32 | image. */
typedef struct {
    int32_t *met, met_cap;
    int64_t *key;
    int32_t key_cap, keys;
    int64_t *all; /* of all bodies of a block */
    int32_t all_cap, alls;
} scratch;

/* Add what of the tree, and of the wide boxes where the image is the middle one, meets q. */
static int add_met(const fl_pairs *p, const fl_aabb *box, fl_aabb q, int32_t i, int32_t image, scratch *s,
                   fl_err *err)
{
    int32_t met = fl_bvh_query(&p->tree, box, q, s->met, s->met_cap);
    if (met > s->met_cap) {
        if (fl_grow(&s->met, &s->met_cap, met, sizeof *s->met, err)) return -1;
        met = fl_bvh_query(&p->tree, box, q, s->met, s->met_cap);
    }
    if (fl_grow(&s->key, &s->key_cap, (int64_t)s->keys + met, sizeof *s->key, err)) return -1;
    for (int32_t c = 0; c < met; c++)
        if (s->met[c] > i) s->key[s->keys++] = (int64_t)s->met[c] << 32 | image;
    return 0;
}

/* Images e to try along one direction: those of the tree's box, moved by e periods, that meet [lo, hi]. */
static void images_along(double period, double lo, double hi, double tree_lo, double tree_hi, int *from,
                         int *to)
{
    *from = *to = 0;
    if (!(period > 0.0)) return;
    *from = (int)fmax(-IMAGES, ceil((lo - tree_hi) / period));
    *to = (int)fmin(IMAGES, floor((hi - tree_lo) / period));
}

/* Partners of i, sorted by (j, image). */
static int partners(const fl_pairs *p, const fl_aabb *box, int32_t i, int32_t total, int32_t wide, scratch *s,
                    fl_err *err)
{
    const fl_vec3 L = p->period;
    const fl_aabb b = box[i];
    s->keys = 0;
    if (p->absent && p->absent[i]) return 0;
    if (!(L.x > 0.0 || L.y > 0.0 || L.z > 0.0)) {
        if (add_met(p, box, b, i, CENTRE, s, err)) return -1;
    } else if (p->tree.nodes) {
        const fl_aabb all = p->tree.node[0].box;
        int from[3], to[3];
        images_along(L.x, b.lo.x, b.hi.x, all.lo.x, all.hi.x, &from[0], &to[0]);
        images_along(L.y, b.lo.y, b.hi.y, all.lo.y, all.hi.y, &from[1], &to[1]);
        images_along(L.z, b.lo.z, b.hi.z, all.lo.z, all.hi.z, &from[2], &to[2]);
        for (int x = from[0]; x <= to[0]; x++) {
            for (int y = from[1]; y <= to[1]; y++) {
                for (int z = from[2]; z <= to[2]; z++) {
                    const fl_vec3 way = v3(x * L.x, y * L.y, z * L.z);
                    const fl_aabb q = {v3_sub(b.lo, way), v3_sub(b.hi, way)};
                    const int32_t image = (x + 16) << 10 | (y + 16) << 5 | (z + 16);
                    if (add_met(p, box, q, i, image, s, err)) return -1;
                }
            }
        }
    }
    if (fl_grow(&s->key, &s->key_cap, (int64_t)s->keys + wide, sizeof *s->key, err)) return -1;
    for (int32_t j = total - wide; j < total; j++)
        if (aabb_overlap(b, box[j])) s->key[s->keys++] = (int64_t)j << 32 | CENTRE;
    qsort(s->key, (size_t)s->keys, sizeof *s->key, ascending);
    return 0;
}

/* Partners of the bodies of block b, one after the other, and their numbers into p->first; NULL when memory
 * runs out, then or before. */
static int64_t *find_block(fl_pairs *p, const fl_aabb *box, int32_t b, int32_t n, int32_t total, int32_t wide,
                           scratch *s, fl_err *err)
{
    int64_t *keys = NULL;
    s->alls = 0;
    for (int32_t i = b * BLOCK; i < n && i < (b + 1) * BLOCK; i++) {
        if (err->code || partners(p, box, i, total, wide, s, err)) return NULL;
        if (fl_grow(&s->all, &s->all_cap, (int64_t)s->alls + s->keys, sizeof *s->all, err)) return NULL;
        if (s->keys) memcpy(s->all + s->alls, s->key, (size_t)s->keys * sizeof *s->all);
        s->alls += s->keys;
        p->first[i + 1] = s->keys;
    }
    keys = fl_alloc(s->alls, sizeof *keys, err);
    if (keys && s->alls) memcpy(keys, s->all, (size_t)s->alls * sizeof *keys);
    return keys;
}

int fl_pairs_find(fl_pairs *p, const fl_aabb *box, int32_t n, int32_t total, int32_t wide, fl_err *err)
{
    int failed = 0;
    const int wraps = p->period.x > 0.0 || p->period.y > 0.0 || p->period.z > 0.0;
    if (fl_bvh_build_present(&p->tree, box, total - wide, n, p->absent, err)) return -1;
    if (fl_grow(&p->first, &p->first_cap, (int64_t)n + 1, sizeof *p->first, err)) return -1;
    /* Each block of bodies keeps what it finds until all know where it belongs. */
    const int32_t blocks = (n + BLOCK - 1) / BLOCK;
    int64_t **found = fl_alloc(blocks, sizeof *found, err);
    if (!found) return -1;
#pragma omp parallel
    {
        scratch s = {0};
        fl_err lost = {0};
#pragma omp for schedule(dynamic)
        for (int32_t b = 0; b < blocks; b++) found[b] = find_block(p, box, b, n, total, wide, &s, &lost);
        free(s.met), free(s.key), free(s.all);
        if (lost.code) {
#pragma omp atomic write
            failed = 1;
        }
    }
    p->first[0] = 0;
    for (int32_t i = 0; i < n && !failed; i++) p->first[i + 1] += p->first[i];
    fl_err lost = {0};
    failed = failed || fl_grow(&p->partner, &p->partner_cap, p->first[n], sizeof *p->partner, &lost) ||
             (wraps && fl_grow(&p->image, &p->image_cap, p->first[n], sizeof *p->image, &lost));
    if (!failed) {
#pragma omp parallel for schedule(static)
        for (int32_t b = 0; b < blocks; b++) {
            const int64_t from = p->first[b * BLOCK];
            const int64_t to = p->first[(b + 1) * BLOCK < n ? (b + 1) * BLOCK : n];
            for (int64_t k = from; k < to; k++) {
                p->partner[k] = (int32_t)(found[b][k - from] >> 32);
                if (wraps) p->image[k] = (int32_t)(found[b][k - from] & 0x7fff);
            }
        }
    }
    for (int32_t b = 0; b < blocks; b++) free(found[b]);
    free(found);
    return failed ? fl_fail(err, FL_SYSTEM, "out of memory while searching neighbours") : 0;
}

int fl_pairs_image_shift(int32_t image, int axis) { return (image >> (10 - 5 * axis) & 31) - 16; }

void fl_pairs_clear(fl_pairs *p)
{
    fl_bvh_free(&p->tree);
    free(p->first);
    free(p->partner);
    free(p->image);
    *p = (fl_pairs){.period = p->period, .absent = p->absent};
}

void fl_pairs_free(fl_pairs *p)
{
    fl_pairs_clear(p);
    *p = (fl_pairs){0};
}
