/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <string.h>
#include "mesh/byte_order.h"

void fl_put_uint_le(FILE *f, uint64_t u, int n)
{
    unsigned char byte[8];
    for (int k = 0; k < n; k++) byte[k] = (unsigned char)(u >> 8 * k & 0xff);
    fwrite(byte, (size_t)n, 1, f);
}

void fl_put_f64_le(FILE *f, double x)
{
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    fl_put_uint_le(f, bits, 8);
}

void fl_put_vec3_le(FILE *f, fl_vec3 x)
{
    fl_put_f64_le(f, x.x);
    fl_put_f64_le(f, x.y);
    fl_put_f64_le(f, x.z);
}
