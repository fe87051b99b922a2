/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include "base/array.h"
#include "geom/hilbert_order.h"

enum { LEVELS = 16, DIGIT = 11, DIGITS = 1 << DIGIT };

/* The quarters of a square come in the order lower left, upper left, upper right, lower right.  In the first
 * the axes of the curve are exchanged; in the last they are exchanged and reversed.  Both states are masks of
 * all bits or none, since a branch on a coordinate bit is mispredicted half of the time. */
uint32_t fl_hilbert_index(uint32_t x, uint32_t y)
{
    uint32_t index = 0, swap = 0, flip = 0;
    for (int k = LEVELS - 1; k >= 0; k--) {
        const uint32_t bx = (x >> k) & 1, by = (y >> k) & 1, differ = (bx ^ by) & swap;
        const uint32_t a = bx ^ differ ^ flip, b = by ^ differ ^ flip, low = b ^ 1;
        index = index << 2 | (a << 1 | (a ^ b));
        flip ^= a & low;
        swap ^= low;
    }
    return index;
}

enum { LEVELS3 = 21 };

/* Skilling: the coordinates become the transposed index by undoing exchanges and inversions, then a Gray
 * code. */
uint64_t fl_hilbert_index3(uint32_t x, uint32_t y, uint32_t z)
{
    uint32_t a[3] = {x, y, z}, t = 0;
    uint64_t index = 0;
    for (uint32_t q = 1u << (LEVELS3 - 1); q > 1; q >>= 1) {
        const uint32_t low = q - 1;
        for (int k = 0; k < 3; k++) {
            const uint32_t differ = (a[0] ^ a[k]) & low;
            if (a[k] & q) a[0] ^= low;
            else a[0] ^= differ, a[k] ^= differ;
        }
    }
    a[1] ^= a[0], a[2] ^= a[1];
    for (uint32_t q = 1u << (LEVELS3 - 1); q > 1; q >>= 1)
        if (a[2] & q) t ^= q - 1;
    for (int k = 0; k < 3; k++) a[k] ^= t;
    for (int bit = LEVELS3 - 1; bit >= 0; bit--)
        for (int k = 0; k < 3; k++) index = index << 1 | (a[k] >> bit & 1);
    return index;
}

struct indexed_point {
    uint32_t index;
    int32_t i;
};

/* One digit of a radix sort, which is stable. */
static void sort_digit(int32_t n, int shift, const struct indexed_point *from, struct indexed_point *to)
{
    int32_t first[DIGITS] = {0}, sum = 0;
    for (int32_t k = 0; k < n; k++) first[from[k].index >> shift & (DIGITS - 1)]++;
    for (int d = 0; d < DIGITS; d++) {
        const int32_t count = first[d];
        first[d] = sum;
        sum += count;
    }
    for (int32_t k = 0; k < n; k++) to[first[from[k].index >> shift & (DIGITS - 1)]++] = from[k];
}

int fl_hilbert_order(int32_t n, const fl_vec2 *x, int32_t *order, fl_err *err)
{
    struct indexed_point *a = fl_alloc(n, sizeof *a, err), *b = fl_alloc(n, sizeof *b, err);
    fl_vec2 lo = {INFINITY, INFINITY}, hi = {-INFINITY, -INFINITY};
    double scale;
    if (!a || !b) {
        free(a);
        free(b);
        return -1;
    }
    for (int32_t i = 0; i < n; i++) {
        lo = (fl_vec2){x[i].x < lo.x ? x[i].x : lo.x, x[i].y < lo.y ? x[i].y : lo.y};
        hi = (fl_vec2){x[i].x > hi.x ? x[i].x : hi.x, x[i].y > hi.y ? x[i].y : hi.y};
    }
    /* just below 2^16, so that the far point has a square; all points may coincide */
    scale = 65535.5 / fmax(fmax(hi.x - lo.x, hi.y - lo.y), 1e-300);
    for (int32_t i = 0; i < n; i++)
        a[i] = (struct indexed_point){
            fl_hilbert_index((uint32_t)(scale * (x[i].x - lo.x)), (uint32_t)(scale * (x[i].y - lo.y))), i};
    sort_digit(n, 0, a, b);
    sort_digit(n, DIGIT, b, a);
    sort_digit(n, 2 * DIGIT, a, b); /* three digits of 11 bits cover 32 bits */
    for (int32_t k = 0; k < n; k++) order[k] = b[k].i;
    free(a);
    free(b);
    return 0;
}
