/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdint.h>
#include "base/number_text.h"
#include "mesh/write_off.h"

void fl_off_write(FILE *f, const fl_surface *s)
{
    int64_t nv = 0, nt = 0, first = 0;
    for (int32_t i = 0; i < s->n; i++) {
        nv += s->part[i].nv;
        nt += s->part[i].nt;
    }
    fprintf(f, "OFF\n%lld %lld 0\n", (long long)nv, (long long)nt);
    for (int32_t i = 0; i < s->n; i++)
        for (int32_t v = 0; v < s->part[i].nv; v++) {
            const fl_vec3 p = s->part[i].v[v];
            char x[FL_NUMBER_LEN], y[FL_NUMBER_LEN], z[FL_NUMBER_LEN];
            fprintf(f, "%s %s %s\n", fl_number_text(p.x, x), fl_number_text(p.y, y), fl_number_text(p.z, z));
        }
    for (int32_t i = 0; i < s->n; i++) {
        for (int32_t t = 0; t < s->part[i].nt; t++) {
            const int32_t *v = s->part[i].t[t].v;
            fprintf(f, "3 %lld %lld %lld\n", (long long)(first + v[0]), (long long)(first + v[1]),
                    (long long)(first + v[2]));
        }
        first += s->part[i].nv;
    }
}
