/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "out/frame_codec.h"

enum { COLUMNS = 6, SAMPLES = 1000 };
/* The component of the frame before stays the one left out while it is above this. */
#define STAYS_ABOVE 0.45

static uint32_t zigzag(uint32_t d) { return d << 1 ^ (d >> 31 ? 0xffffffffu : 0u); }
static uint32_t unzigzag(uint32_t z) { return z >> 1 ^ (z & 1u ? 0xffffffffu : 0u); }

int fl_frame_codec_room(fl_frame_codec *c, int32_t n, fl_err *err)
{
    int32_t cap[7];
    const int64_t columns = (int64_t)COLUMNS * n;
    if (fl_grow(&c->planes, &c->planes_cap, fl_frame_codec_size(n, 1), 1, err)) return -1;
    if (n <= c->cap) return 0;
    for (int k = 0; k < 7; k++) cap[k] = 0;
    if (fl_grow(&c->id, &cap[0], n, sizeof *c->id, err)) return -1;
    for (int k = 0; k < 3; k++)
        if (fl_grow(&c->column[k], &cap[1 + k], columns, sizeof *c->column[k], err) ||
            fl_grow(&c->left_out[k], &cap[4 + k], n, 1, err))
            return -1;
    c->cap = n;
    return 0;
}

static double component(const fl_quat *q, int k)
{
    return k == 0 ? q->w : k == 1 ? q->x : k == 2 ? q->y : q->z;
}

static int quantise(fl_frame_codec *c, int32_t n, const fl_vec3 *x, const fl_quat *q, int same, fl_err *err)
{
    const double ix = 0.5 / c->bound_x, iq = 4.0 / c->bound_q, most = 2147483647.0;
    int32_t *a = c->column[0];
    for (int32_t i = 0; i < n; i++) {
        const double p[3] = {x[i].x * ix, x[i].y * ix, x[i].z * ix};
        for (int k = 0; k < 3; k++) {
            if (!(fabs(p[k]) < most))
                return fl_fail(err, FL_INPUT,
                               "packed frames: body %d is beyond %g m, which their bound of %g m allows",
                               c->id[i], 2.0 * c->bound_x * most, c->bound_x);
            a[(int64_t)k * n + i] = (int32_t)llrint(p[k]);
        }
        int m = 0;
        for (int k = 1; k < 4; k++)
            if (fabs(component(&q[i], k)) > fabs(component(&q[i], m))) m = k;
        if (same && fabs(component(&q[i], c->left_out[1][i])) > STAYS_ABOVE) m = c->left_out[1][i];
        const double f = component(&q[i], m) < 0.0 ? -iq : iq;
        for (int k = 0, j = 3; k < 4; k++)
            if (k != m) a[(int64_t)j++ * n + i] = (int32_t)llrint(component(&q[i], k) * f);
        c->left_out[0][i] = (uint8_t)m;
    }
    return 0;
}

/* Order of column k of body i where that of the frame is `order`. */
static inline int order_here(const fl_frame_codec *c, int order, int k, int32_t i)
{
    if (k < 3 || order == 0) return order;
    if (c->left_out[0][i] != c->left_out[1][i]) return 0;
    return order == 2 && c->left_out[1][i] != c->left_out[2][i] ? 1 : order;
}

static inline uint32_t predicted(const fl_frame_codec *c, int order, int64_t at)
{
    const uint32_t b = (uint32_t)c->column[1][at];
    return order == 0 ? 0u : order == 1 ? b : 2u * b - (uint32_t)c->column[2][at];
}

static uint32_t residual(const fl_frame_codec *c, int order, int k, int32_t i)
{
    const int64_t at = (int64_t)k * c->n + i;
    return zigzag((uint32_t)c->column[0][at] - predicted(c, order_here(c, order, k, i), at));
}

/* Length of a number in bits. */
static int bits_of(uint32_t z)
{
    int n = 0;
    for (; z; z >>= 1) n++;
    return n;
}

/* The order from 1 to most that needs fewer bits for a thousand bodies. */
static int choose_order(const fl_frame_codec *c, int most)
{
    int64_t sum[2] = {0, 0};
    const int32_t step = c->n / SAMPLES + 1;
    if (most < 2) return most;
    for (int32_t i = 0; i < c->n; i += step)
        for (int k = 0; k < COLUMNS; k++)
            for (int o = 0; o < 2; o++) sum[o] += bits_of(residual(c, o + 1, k, i));
    return sum[1] < sum[0] ? 2 : 1;
}

static uint8_t *put_planes(uint8_t *to, int32_t n, int32_t i, uint32_t z)
{
    for (int b = 0; b < 4; b++) to[(int64_t)b * n + i] = (uint8_t)(z >> (8 * b));
    return to;
}

static uint32_t get_planes(const uint8_t *from, int32_t n, int32_t i)
{
    uint32_t z = 0;
    for (int b = 0; b < 4; b++) z |= (uint32_t)from[(int64_t)b * n + i] << (8 * b);
    return z;
}

/* The frame just handled becomes the one before. */
static void rotate(fl_frame_codec *c)
{
    int32_t *a = c->column[2];
    uint8_t *m = c->left_out[2];
    for (int k = 2; k > 0; k--) {
        c->column[k] = c->column[k - 1];
        c->left_out[k] = c->left_out[k - 1];
    }
    c->column[0] = a;
    c->left_out[0] = m;
}

int fl_frame_codec_encode(fl_frame_codec *c, int32_t n, const int32_t *id, const fl_vec3 *x, const fl_quat *q,
                          int32_t key_every, int *order, fl_err *err)
{
    const int same = c->since_key > 0 && c->since_key < key_every && n == c->n &&
                     (n == 0 || memcmp(c->id, id, (size_t)n * sizeof *id) == 0);
    if (fl_frame_codec_room(c, n, err)) return -1;
    if (n) memcpy(c->id, id, (size_t)n * sizeof *id);
    c->n = n;
    if (!same) c->since_key = 0;
    if (quantise(c, n, x, q, same, err)) return -1;
    *order = same ? choose_order(c, c->since_key < 2 ? 1 : 2) : 0;
    uint8_t *to = c->planes;
    if (!same) {
        for (int32_t i = 0; i < n; i++)
            put_planes(to, n, i, zigzag((uint32_t)id[i] - (i ? (uint32_t)id[i - 1] : 0u) - 1u));
        to += 4 * (int64_t)n;
    }
    for (int k = 0; k < COLUMNS; k++, to += 4 * (int64_t)n)
        for (int32_t i = 0; i < n; i++) put_planes(to, n, i, residual(c, *order, k, i));
    for (int32_t i = 0; i < n; i++) to[i] = (uint8_t)(c->left_out[0][i] ^ (same ? c->left_out[1][i] : 0));
    c->planes_len = (int32_t)(to + n - c->planes);
    rotate(c);
    c->since_key++;
    return 0;
}

int fl_frame_codec_decode(fl_frame_codec *c, int32_t n, int is_key, int order)
{
    const uint8_t *from = c->planes;
    if (is_key ? order != 0 : !c->since_key || n != c->n || order > c->since_key || order > 2) return -1;
    c->n = n;
    if (is_key) {
        uint32_t last = 0;
        for (int32_t i = 0; i < n; i++) {
            last += unzigzag(get_planes(from, n, i)) + 1u;
            c->id[i] = (int32_t)last;
        }
        from += 4 * (int64_t)n;
        c->since_key = 0;
    }
    const uint8_t *const m = from + 4 * COLUMNS * (int64_t)n;
    for (int32_t i = 0; i < n; i++)
        c->left_out[0][i] = (uint8_t)((m[i] ^ (is_key ? 0 : c->left_out[1][i])) & 3);
    for (int k = 0; k < COLUMNS; k++, from += 4 * (int64_t)n)
        for (int32_t i = 0; i < n; i++) {
            const int64_t at = (int64_t)k * n + i;
            const uint32_t d = unzigzag(get_planes(from, n, i));
            c->column[0][at] = (int32_t)(d + predicted(c, order_here(c, order, k, i), at));
        }
    rotate(c);
    c->since_key++;
    return 0;
}

fl_vec3 fl_frame_codec_place(const fl_frame_codec *c, int32_t i)
{
    const int32_t *a = c->column[1];
    const double s = 2.0 * c->bound_x;
    return v3(s * a[i], s * a[(int64_t)c->n + i], s * a[2 * (int64_t)c->n + i]);
}

fl_quat fl_frame_codec_rotation(const fl_frame_codec *c, int32_t i)
{
    const int32_t *a = c->column[1];
    const int m = c->left_out[1][i];
    double q[4] = {0}, sum = 0.0;
    for (int k = 0, j = 3; k < 4; k++) {
        if (k == m) continue;
        q[k] = 0.25 * c->bound_q * a[(int64_t)j++ * c->n + i];
        sum += q[k] * q[k];
    }
    q[m] = sum < 1.0 ? sqrt(1.0 - sum) : 0.0;
    return (fl_quat){q[0], q[1], q[2], q[3]};
}

void fl_frame_codec_free(fl_frame_codec *c)
{
    free(c->id);
    free(c->planes);
    for (int k = 0; k < 3; k++) {
        free(c->column[k]);
        free(c->left_out[k]);
    }
    *c = (fl_frame_codec){0};
}
