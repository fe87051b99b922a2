/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/mem.h"
#include "broad/pairs.h"

static int ascending(const void *a, const void *b)
{
    const int32_t x = *(const int32_t *)a, y = *(const int32_t *)b;
    return (x > y) - (x < y);
}

/* Partners of i into out[0 .. room); returns how many, which may exceed room. */
static int32_t partners(const fl_pairs *p, const fl_aabb *box, int32_t i, int32_t total, int32_t wide,
                        int32_t *out, int32_t room)
{
    int32_t k = 0;
    const int32_t met = fl_bvh_query(&p->tree, box, box[i], out, room);
    if (met + wide > room) return met + wide;
    for (int32_t c = 0; c < met; c++)
        if (out[c] > i) out[k++] = out[c];
    for (int32_t j = total - wide; j < total; j++)
        if (aabb_meet(box[i], box[j])) out[k++] = j;
    qsort(out, (size_t)k, sizeof *out, ascending);
    return k;
}

int fl_pairs_find(fl_pairs *p, const fl_aabb *box, int32_t n, int32_t total, int32_t wide, fl_err *err)
{
    int failed = 0;
    if (fl_bvh_build(&p->tree, box, total - wide, err)) return -1;
    if (fl_grow(&p->first, &p->first_cap, (int64_t)n + 1, sizeof *p->first, err)) return -1;
    /* Twice the same queries: the first counts, the second fills its stretch.  No thread waits for another.
     */
    for (int pass = 0; pass < 2; pass++) {
#pragma omp parallel
        {
            int32_t *out = NULL, cap = 0;
            fl_err lost = {0};
#pragma omp for schedule(dynamic, 64)
            for (int32_t i = 0; i < n; i++) {
                int32_t k = partners(p, box, i, total, wide, out, cap);
                while (k > cap && !lost.code) {
                    if (fl_grow(&out, &cap, k, sizeof *out, &lost)) break;
                    k = partners(p, box, i, total, wide, out, cap);
                }
                if (lost.code) continue;
                if (pass == 0) p->first[i + 1] = k;
                else
                    for (int32_t c = 0; c < k; c++) p->partner[p->first[i] + c] = out[c];
            }
            free(out);
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
    }
    return 0;
}

void fl_pairs_free(fl_pairs *p)
{
    fl_bvh_free(&p->tree);
    free(p->first);
    free(p->partner);
    *p = (fl_pairs){0};
}
