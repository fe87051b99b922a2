/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdint.h>
#include "base/number_text.h"
#include "mesh/write_obj.h"

void fl_obj_write(FILE *f, const fl_surface *s)
{
    int64_t first = 1; /* number of vertex 0 of the part */
    for (int32_t i = 0; i < s->n; i++) {
        const fl_part *p = &s->part[i];
        fprintf(f, "o %s\n", p->name);
        for (int32_t v = 0; v < p->nv; v++) {
            char x[FL_NUMBER_LEN], y[FL_NUMBER_LEN], z[FL_NUMBER_LEN];
            fprintf(f, "v %s %s %s\n", fl_number_text(p->v[v].x, x), fl_number_text(p->v[v].y, y),
                    fl_number_text(p->v[v].z, z));
        }
        for (int32_t t = 0; t < p->nt; t++) {
            const int32_t *v = p->t[t].v;
            fprintf(f, "f %lld %lld %lld\n", (long long)(first + v[0]), (long long)(first + v[1]),
                    (long long)(first + v[2]));
        }
        first += p->nv;
    }
}
