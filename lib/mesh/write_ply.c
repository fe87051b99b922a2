/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdint.h>
#include "mesh/byte_order.h"
#include "mesh/write_ply.h"

static void put_header(FILE *f, const fl_surface *s, int64_t nv, int64_t nt)
{
    fputs("ply\nformat binary_little_endian 1.0\n", f);
    for (int32_t i = 0; i < s->n; i++) fprintf(f, "comment part %d %s\n", s->part[i].id, s->part[i].name);
    fprintf(f, "element vertex %lld\nproperty double x\nproperty double y\nproperty double z\n",
            (long long)nv);
    fprintf(f, "element face %lld\nproperty list uchar int vertex_indices\nproperty int part\nend_header\n",
            (long long)nt);
}

int fl_ply_write(FILE *f, const fl_surface *s, fl_err *err)
{
    int64_t nv = 0, nt = 0;
    int32_t first = 0;
    for (int32_t i = 0; i < s->n; i++) {
        nv += s->part[i].nv;
        nt += s->part[i].nt;
    }
    if (nv > INT32_MAX)
        return fl_fail(err, FL_INPUT, "%lld vertices are more than PLY can number", (long long)nv);
    put_header(f, s, nv, nt);
    for (int32_t i = 0; i < s->n; i++)
        for (int32_t v = 0; v < s->part[i].nv; v++) fl_put_vec3_le(f, s->part[i].v[v]);
    for (int32_t i = 0; i < s->n; i++) {
        for (int32_t t = 0; t < s->part[i].nt; t++) {
            fputc(3, f);
            for (int k = 0; k < 3; k++) fl_put_uint_le(f, (uint64_t)(first + s->part[i].t[t].v[k]), 4);
            fl_put_uint_le(f, (uint64_t)s->part[i].id, 4);
        }
        first += s->part[i].nv;
    }
    return 0;
}
