/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <string.h>
#include "base/array.h"
#include "broad/pairs.h"

/* Block size of the parallel loop; largest number of periodic images to each side; code of the central
 * image. */
enum { BLOCK = 64, IMAGES_MAX = 15, IMAGE_CENTRE = 16 << 10 | 16 << 5 | 16 };

static int compare_keys(const void *a, const void *b)
{
    const int64_t x = *(const int64_t *)a, y = *(const int64_t *)b;
    return (x > y) - (x < y);
}

/* Scratch of one thread: results of a query, and partners with their images as j << 32 | image. */
typedef struct {
    int32_t *hit, hit_cap;
    int64_t *key;
    int32_t key_cap, keys;
    int64_t *all; /* keys of all bodies of a block */
    int32_t all_cap, alls;
} pair_scratch;

/* Adds the boxes of the tree that overlap q, with the given image. */
static int add_overlapping(const fl_pairs *p, const fl_aabb *box, fl_aabb q, int32_t i, int32_t image,
                           pair_scratch *s, fl_err *err)
{
    int32_t hit = fl_bvh_query(&p->tree, box, q, s->hit, s->hit_cap);
    if (hit > s->hit_cap) {
        if (fl_grow(&s->hit, &s->hit_cap, hit, sizeof *s->hit, err)) return -1;
        hit = fl_bvh_query(&p->tree, box, q, s->hit, s->hit_cap);
    }
    if (fl_grow(&s->key, &s->key_cap, (int64_t)s->keys + hit, sizeof *s->key, err)) return -1;
    for (int32_t c = 0; c < hit; c++)
        if (s->hit[c] > i) s->key[s->keys++] = (int64_t)s->hit[c] << 32 | image;
    return 0;
}

/* Range of images along one direction: shifts of the tree's box by e periods that overlap [lo, hi]. */
static void image_range(double period, double lo, double hi, double tree_lo, double tree_hi, int *from,
                        int *to)
{
    *from = *to = 0;
    if (!(period > 0.0)) return;
    *from = (int)fmax(-IMAGES_MAX, ceil((lo - tree_hi) / period));
    *to = (int)fmin(IMAGES_MAX, floor((hi - tree_lo) / period));
}

/* Finds the partners of i, sorted by (j, image). */
static int find_partners(const fl_pairs *p, const fl_aabb *box, int32_t i, int32_t total, int32_t wide,
                         pair_scratch *s, fl_err *err)
{
    const fl_vec3 L = p->period;
    const fl_aabb b = box[i];
    s->keys = 0;
    if (p->absent && p->absent[i]) return 0;
    if (!(L.x > 0.0 || L.y > 0.0 || L.z > 0.0)) {
        if (add_overlapping(p, box, b, i, IMAGE_CENTRE, s, err)) return -1;
    } else if (p->tree.nodes) {
        const fl_aabb all = p->tree.node[0].box;
        int from[3], to[3];
        image_range(L.x, b.lo.x, b.hi.x, all.lo.x, all.hi.x, &from[0], &to[0]);
        image_range(L.y, b.lo.y, b.hi.y, all.lo.y, all.hi.y, &from[1], &to[1]);
        image_range(L.z, b.lo.z, b.hi.z, all.lo.z, all.hi.z, &from[2], &to[2]);
        for (int x = from[0]; x <= to[0]; x++) {
            for (int y = from[1]; y <= to[1]; y++) {
                for (int z = from[2]; z <= to[2]; z++) {
                    const fl_vec3 shift = v3(x * L.x, y * L.y, z * L.z);
                    const fl_aabb q = {v3_sub(b.lo, shift), v3_sub(b.hi, shift)};
                    const int32_t image = (x + 16) << 10 | (y + 16) << 5 | (z + 16);
                    if (add_overlapping(p, box, q, i, image, s, err)) return -1;
                }
            }
        }
    }
    if (fl_grow(&s->key, &s->key_cap, (int64_t)s->keys + wide, sizeof *s->key, err)) return -1;
    for (int32_t j = total - wide; j < total; j++)
        if (aabb_overlap(b, box[j])) s->key[s->keys++] = (int64_t)j << 32 | IMAGE_CENTRE;
    qsort(s->key, (size_t)s->keys, sizeof *s->key, compare_keys);
    return 0;
}

/* Finds the partners of the bodies of block b, in order, and writes their counts to p->first.  Returns NULL
 * when memory runs out, here or before. */
static int64_t *find_block_partners(fl_pairs *p, const fl_aabb *box, int32_t b, int32_t n, int32_t total,
                                    int32_t wide, pair_scratch *s, fl_err *err)
{
    int64_t *keys = NULL;
    s->alls = 0;
    for (int32_t i = b * BLOCK; i < n && i < (b + 1) * BLOCK; i++) {
        if (err->code || find_partners(p, box, i, total, wide, s, err)) return NULL;
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
    /* Each block keeps its results until all offsets are known. */
    const int32_t blocks = (n + BLOCK - 1) / BLOCK;
    int64_t **found = fl_alloc(blocks, sizeof *found, err);
    if (!found) return -1;
#pragma omp parallel
    {
        pair_scratch s = {0};
        fl_err lost = {0};
#pragma omp for schedule(dynamic)
        for (int32_t b = 0; b < blocks; b++)
            found[b] = find_block_partners(p, box, b, n, total, wide, &s, &lost);
        free(s.hit), free(s.key), free(s.all);
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
