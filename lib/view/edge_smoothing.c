/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stddef.h>
#include <stdlib.h>
#include <string.h>
#include "base/simd.h"
#include "view/edge_smoothing.h"

/* An edge: luminance differs by more than this among the neighbours, and by more than an eighth of the
 * largest. */
enum { CONTRAST = 10, CONTRAST_SHIFT = 3, REACH = 6 * 256, ROW = 256 };

/* The four bytes of a pixel, and their numbers in one register. */
typedef unsigned char pixel_bytes __attribute__((vector_size(4), aligned(1), may_alias));
typedef int pixel_lanes __attribute__((vector_size(16)));

FL_SIMD_INLINE pixel_lanes lanes_at(const unsigned char *p)
{
    return __builtin_convertvector(*(const pixel_bytes *)(const void *)p, pixel_lanes);
}

/* The colour between pixels; x, y with 8 bits of fraction, centres at whole numbers. */
FL_SIMD_INLINE pixel_lanes tap_at(const unsigned char *p, int w, int h, int x, int y)
{
    const int fx = x & 255, fy = y & 255;
    int i = x >> 8, j = y >> 8;
    i = i < 0 ? 0 : i > w - 2 ? w - 2 : i;
    j = j < 0 ? 0 : j > h - 2 ? h - 2 : j;
    const unsigned char *a = p + 4 * ((size_t)j * (size_t)w + (size_t)i), *b = a + 4 * (size_t)w;
    return ((lanes_at(a) * (256 - fx) + lanes_at(a + 4) * fx) * (256 - fy) +
            (lanes_at(b) * (256 - fx) + lanes_at(b + 4) * fx) * fy + 32768) >>
           16;
}

FL_SIMD_INLINE int lesser(int a, int b) { return a < b ? a : b; }
FL_SIMD_INLINE int greater(int a, int b) { return a > b ? a : b; }
FL_SIMD_INLINE int within(int x, int most) { return x > most ? most : x < -most ? -most : x; }

FL_SIMD_INLINE void smooth_pixel(const unsigned char *p, int w, int h, const unsigned char *m, int x, int y,
                                 unsigned char *d)
{
    const int a = m[x - 1 - w], b = m[x + 1 - w], c = m[x - 1 + w], e = m[x + 1 + w];
    const int lo = lesser(m[x], lesser(lesser(a, b), lesser(c, e))),
              hi = greater(m[x], greater(greater(a, b), greater(c, e)));
    int gx = -((a + b) - (c + e)), gy = (a + c) - (b + e);
    const int divisor = lesser(abs(gx), abs(gy)) + (a + b + c + e) / 32 + 1;
    gx = within(256 * gx / divisor, REACH);
    gy = within(256 * gy / divisor, REACH);
    const int px = x << 8, py = y << 8;
    const pixel_lanes near = tap_at(p, w, h, px - gx / 6, py - gy / 6) +
                             tap_at(p, w, h, px + gx / 6, py + gy / 6),
                      wide = near + tap_at(p, w, h, px - gx / 2, py - gy / 2) +
                             tap_at(p, w, h, px + gx / 2, py + gy / 2);
    const int l = (77 * wide[0] + 150 * wide[1] + 29 * wide[2]) >> 10, far = l < lo || l > hi;
    const pixel_lanes mean = far ? (near + 1) >> 1 : (wide + 2) >> 2;
    for (int k = 0; k < 3; k++) d[k] = (unsigned char)mean[k];
}

/* Marks pixels 1 .. n - 2 that are at edges; m: luminance from there on, rows of w.  Bytes alone, so that
 * compilers make vectors of it. */
FL_SIMD_INLINE void mark_edges(const unsigned char *restrict m, int n, int w, unsigned char *restrict at)
{
    const unsigned char *restrict u = m - w, *restrict l = m + w;
    for (int x = 1; x < n - 1; x++) {
        const unsigned char a = u[x - 1], b = u[x + 1], c = l[x - 1], e = l[x + 1], o = m[x];
        unsigned char lo = a < b ? a : b, hi = a < b ? b : a;
        const unsigned char lo2 = c < e ? c : e, hi2 = c < e ? e : c;
        lo = lo < lo2 ? lo : lo2;
        hi = hi > hi2 ? hi : hi2;
        lo = lo < o ? lo : o;
        hi = hi > o ? hi : o;
        const unsigned char d = (unsigned char)(hi - lo);
        at[x] = (unsigned char)((d > CONTRAST) & (d > (hi >> CONTRAST_SHIFT)));
    }
}

FL_SIMD_VERSIONS void fl_smooth_edges(const unsigned char *restrict from, int w, int h,
                                      unsigned char *restrict luminance, unsigned char *restrict to)
{
    const size_t n = (size_t)w * (size_t)h;
    for (size_t i = 0; i < n; i++)
        luminance[i] =
            (unsigned char)((77 * from[4 * i] + 150 * from[4 * i + 1] + 29 * from[4 * i + 2]) >> 8);
    for (int y = 0; y < h; y++) {
        const unsigned char *s = from + 4 * (size_t)y * (size_t)w, *m = luminance + (size_t)y * (size_t)w;
        unsigned char *d = to + 4 * (size_t)y * (size_t)w;
        memcpy(d, s, 4 * (size_t)w);
        if (y == 0 || y == h - 1) continue;
        for (int x0 = 0; x0 < w; x0 += ROW - 2) { /* in pieces, with a pixel on either side */
            unsigned char at[ROW] = {0};
            const int piece = w - x0 < ROW ? w - x0 : ROW;
            mark_edges(m + x0, piece, w, at);
            for (int x = 1; x < piece - 1; x++)
                if (at[x]) smooth_pixel(from, w, h, m, x0 + x, y, d + 4 * (x0 + x));
        }
    }
}

FL_SIMD_VERSIONS void fl_picture_to_yuv(const unsigned char *restrict from, int w, int h,
                                        unsigned char *restrict to)
{
    unsigned char *u = to + (size_t)w * (size_t)h, *v = u + (size_t)(w / 2) * (size_t)(h / 2);
    for (size_t i = 0; i < (size_t)w * (size_t)h; i++)
        to[i] = (unsigned char)((47 * from[4 * i] + 157 * from[4 * i + 1] + 16 * from[4 * i + 2] + 128 +
                                 16 * 256) >>
                                8);
    for (int y = 0; y < h / 2; y++) {
        const unsigned char *restrict a = from + 8 * (size_t)y * (size_t)w, *restrict b = a + 4 * (size_t)w;
        for (int x = 0; x < w / 2; x++) {
            const int r = a[8 * x] + a[8 * x + 4] + b[8 * x] + b[8 * x + 4];
            const int g = a[8 * x + 1] + a[8 * x + 5] + b[8 * x + 1] + b[8 * x + 5];
            const int c = a[8 * x + 2] + a[8 * x + 6] + b[8 * x + 2] + b[8 * x + 6];
            *u++ = (unsigned char)((-26 * r - 87 * g + 113 * c + 512 + 128 * 1024) >> 10);
            *v++ = (unsigned char)((112 * r - 102 * g - 10 * c + 512 + 128 * 1024) >> 10);
        }
    }
}
