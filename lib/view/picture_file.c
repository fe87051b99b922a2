/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdlib.h>
#include <string.h>
#include <zlib.h>
#include "base/array.h"
#include "view/picture_file.h"

static void put_big(unsigned char *to, uint32_t x)
{
    for (int k = 0; k < 4; k++) to[k] = (unsigned char)(x >> (24 - 8 * k));
}

static void put_chunk(FILE *f, const char *kind, const unsigned char *data, size_t n)
{
    unsigned char word[4];
    uLong sum = crc32(0, (const Bytef *)kind, 4);
    if (n) sum = crc32(sum, data, (uInt)n);
    put_big(word, (uint32_t)n);
    fwrite(word, 1, 4, f);
    fwrite(kind, 1, 4, f);
    if (n) fwrite(data, 1, n, f);
    put_big(word, (uint32_t)sum);
    fwrite(word, 1, 4, f);
}

int fl_png_write(FILE *f, const fl_picture *p, int level, fl_err *err)
{
    const size_t row = 3 * (size_t)p->w + 1, n = row * (size_t)p->h;
    uLongf len = compressBound((uLong)n);
    unsigned char head[13] = {0}, *raw = fl_alloc((int64_t)n, 1, err),
                  *z = raw ? fl_alloc((int64_t)len, 1, err) : NULL;
    if (!z) {
        free(raw);
        return -1;
    }
    for (int y = 0; y < p->h; y++) {
        unsigned char *d = raw + row * (size_t)y;
        const unsigned char *s = p->px + 4 * (size_t)p->w * (size_t)y,
                            *above = y ? s - 4 * (size_t)p->w : NULL;
        *d++ = 2; /* Up */
        for (int x = 0; x < p->w; x++)
            for (int c = 0; c < 3; c++) *d++ = (unsigned char)(s[4 * x + c] - (above ? above[4 * x + c] : 0));
    }
    const int bad = compress2(z, &len, raw, (uLong)n, level) != Z_OK;
    put_big(head, (uint32_t)p->w);
    put_big(head + 4, (uint32_t)p->h);
    head[8] = 8;
    head[9] = 2;
    fwrite("\x89PNG\r\n\x1a\n", 1, 8, f);
    put_chunk(f, "IHDR", head, sizeof head);
    put_chunk(f, "IDAT", z, len);
    put_chunk(f, "IEND", NULL, 0);
    free(raw);
    free(z);
    return bad ? fl_fail(err, FL_SYSTEM, "out of memory for a picture") : 0;
}

static void put_little(unsigned char *to, uint32_t x)
{
    for (int k = 0; k < 4; k++) to[k] = (unsigned char)(x >> (8 * k));
}

void fl_bmp_write(FILE *f, const fl_picture *p)
{
    const size_t row = (3 * (size_t)p->w + 3) / 4 * 4;
    unsigned char head[54] = {'B', 'M'};
    put_little(head + 2, (uint32_t)(sizeof head + row * (size_t)p->h));
    put_little(head + 10, sizeof head);
    put_little(head + 14, 40);
    put_little(head + 18, (uint32_t)p->w);
    put_little(head + 22, (uint32_t)p->h);
    head[26] = 1;
    head[28] = 24;
    fwrite(head, 1, sizeof head, f);
    for (int y = p->h - 1; y >= 0; y--) {
        const unsigned char *s = p->px + 4 * (size_t)p->w * (size_t)y;
        for (int x = 0; x < p->w; x++)
            for (int c = 2; c >= 0; c--) putc(s[4 * x + c], f);
        for (size_t k = 3 * (size_t)p->w; k < row; k++) putc(0, f);
    }
}
