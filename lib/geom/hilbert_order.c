/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include "base/array.h"
#include "geom/hilbert_order.h"

enum { LEVELS = 16, DIGIT = 11, DIGITS = 1 << DIGIT };

/* A square has its quarters in the order lower left, upper left, upper right, lower right.  In the first one
 * the curve is turned: its axes are exchanged; in the last one they are exchanged and reversed.  Both are
 * kept as masks of all bits or none, since a branch on a bit of a coordinate is guessed wrong every other
 * time. */
uint32_t fl_hilbert_index(uint32_t x, uint32_t y)
{
    uint32_t place = 0, swap = 0, flip = 0;
    for (int k = LEVELS - 1; k >= 0; k--) {
        const uint32_t bx = (x >> k) & 1, by = (y >> k) & 1, differ = (bx ^ by) & swap;
        const uint32_t a = bx ^ differ ^ flip, b = by ^ differ ^ flip, low = b ^ 1;
        place = place << 2 | (a << 1 | (a ^ b));
        flip ^= a & low;
        swap ^= low;
    }
    return place;
}

struct item {
    uint32_t place;
    int32_t i;
};

/* One digit of a radix sort, which keeps the order of equal ones. */
static void sort_digit(int32_t n, int shift, const struct item *from, struct item *to)
{
    int32_t first[DIGITS] = {0}, sum = 0;
    for (int32_t k = 0; k < n; k++) first[from[k].place >> shift & (DIGITS - 1)]++;
    for (int d = 0; d < DIGITS; d++) {
        const int32_t count = first[d];
        first[d] = sum;
        sum += count;
    }
    for (int32_t k = 0; k < n; k++) to[first[from[k].place >> shift & (DIGITS - 1)]++] = from[k];
}

int fl_hilbert_order(int32_t n, const fl_vec2 *x, int32_t *order, fl_err *err)
{
    struct item *a = fl_alloc(n, sizeof *a, err), *b = fl_alloc(n, sizeof *b, err);
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
    /* Just short of 2^16, so that the point at the far end has a square; all points may be one. */
    scale = 65535.5 / fmax(fmax(hi.x - lo.x, hi.y - lo.y), 1e-300);
    for (int32_t i = 0; i < n; i++)
        a[i] = (struct item){
            fl_hilbert_index((uint32_t)(scale * (x[i].x - lo.x)), (uint32_t)(scale * (x[i].y - lo.y))), i};
    sort_digit(n, 0, a, b);
    sort_digit(n, DIGIT, b, a);
    sort_digit(n, 2 * DIGIT, a, b); /* three times eleven bits are more than the 32 there are */
    for (int32_t k = 0; k < n; k++) order[k] = b[k].i;
    free(a);
    free(b);
    return 0;
}
