/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/mem.h"
#include "broad/pairs.h"

/* How many images of one body to each side of the middle another may meet, and the code of the middle. */
enum { IMAGES = 15, CENTRE = 16 << 10 | 16 << 5 | 16 };

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
        if (aabb_meet(b, box[j])) s->key[s->keys++] = (int64_t)j << 32 | CENTRE;
    qsort(s->key, (size_t)s->keys, sizeof *s->key, ascending);
    return 0;
}

int fl_pairs_find(fl_pairs *p, const fl_aabb *box, int32_t n, int32_t total, int32_t wide, fl_err *err)
{
    int failed = 0;
    const int wraps = p->period.x > 0.0 || p->period.y > 0.0 || p->period.z > 0.0;
    if (fl_bvh_build_some(&p->tree, box, total - wide, n, p->absent, err)) return -1;
    if (fl_grow(&p->first, &p->first_cap, (int64_t)n + 1, sizeof *p->first, err)) return -1;
    /* Twice the same queries: the first counts, the second fills its stretch.  No thread waits for another.
     */
    for (int pass = 0; pass < 2; pass++) {
#pragma omp parallel
        {
            scratch s = {0};
            fl_err lost = {0};
#pragma omp for schedule(dynamic, 64)
            for (int32_t i = 0; i < n; i++) {
                if (lost.code || partners(p, box, i, total, wide, &s, &lost)) continue;
                if (pass == 0) p->first[i + 1] = s.keys;
                else
                    for (int32_t c = 0; c < s.keys; c++) {
                        p->partner[p->first[i] + c] = (int32_t)(s.key[c] >> 32);
                        if (wraps) p->image[p->first[i] + c] = (int32_t)(s.key[c] & 0x7fff);
                    }
            }
            free(s.met), free(s.key);
            if (lost.code) {
#pragma omp atomic write
                failed = 1;
            }
        }
        if (failed) return fl_fail(err, FL_SYSTEM, "out of memory while searching neighbours");
        if (pass == 1) break;
        p->first[0] = 0;
        for (int32_t i = 0; i < n; i++) p->first[i + 1] += p->first[i];
        if (fl_grow(&p->partner, &p->partner_cap, p->first[n], sizeof *p->partner, err)) return -1;
        if (wraps && fl_grow(&p->image, &p->image_cap, p->first[n], sizeof *p->image, err)) return -1;
    }
    return 0;
}

int fl_pairs_image(int32_t image, int axis) { return (image >> (10 - 5 * axis) & 31) - 16; }

void fl_pairs_free(fl_pairs *p)
{
    fl_bvh_free(&p->tree);
    free(p->first);
    free(p->partner);
    free(p->image);
    *p = (fl_pairs){0};
}
