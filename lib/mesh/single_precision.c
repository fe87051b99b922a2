/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include "mesh/single_precision.h"

enum { DIGITS = 24 }; /* binary, of single precision */

double fl_single_spacing(fl_aabb box)
{
    const double at[6] = {box.lo.x, box.lo.y, box.lo.z, box.hi.x, box.hi.y, box.hi.z};
    double largest = 0.0;
    int e;
    for (int k = 0; k < 6; k++)
        if (isfinite(at[k])) largest = fmax(largest, fabs(at[k]));
    if (largest == 0.0) return 0.0;
    frexp(largest, &e); /* largest < 2^e */
    return ldexp(1.0, e - DIGITS);
}

double fl_single_rounding(const fl_part *p)
{
    double most = 0.0;
    for (int32_t v = 0; v < p->nv; v++) {
        const fl_vec3 x = p->v[v], y = v3((double)(float)x.x, (double)(float)x.y, (double)(float)x.z);
        most = fmax(most, v3_norm(v3_sub(y, x)));
    }
    return most;
}

int fl_single_is_all(const fl_surface *s)
{
    int broken = 0;
    for (int32_t i = 0; i < s->n; i++)
        for (int32_t v = 0; v < s->part[i].nv; v++) {
            const fl_vec3 x = s->part[i].v[v];
            if ((double)(float)x.x != x.x || (double)(float)x.y != x.y || (double)(float)x.z != x.z) return 0;
            broken |= x.x != floor(x.x) || x.y != floor(x.y) || x.z != floor(x.z);
        }
    return broken;
}
