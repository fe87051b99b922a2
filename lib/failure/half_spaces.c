/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "failure/half_spaces.h"
#include <math.h>

/* Offset of face f: the largest over its vertices. */
static double offset_of_face(const fl_poly *p, int32_t f)
{
    if (p->c) return p->c[f];
    double c = -INFINITY;
    for (int32_t k = p->first[f]; k < p->first[f + 1]; k++) c = fmax(c, v3_dot(p->n[f], p->v[p->loop[k]]));
    return c;
}

void fl_half_spaces_of(fl_half_spaces *q, const fl_poly *p, double r, const fl_mat3 *M, fl_vec3 o)
{
    q->n = p->nf < FL_HALF_SPACES ? p->nf : FL_HALF_SPACES;
    for (int k = 0; k < q->n; k++) {
        q->normal[k] = m3_mul(*M, p->n[k]);
        q->c[k] = offset_of_face(p, k) + r + v3_dot(q->normal[k], o);
    }
    fl_aabb box = aabb_empty();
    for (int32_t v = 0; v < p->nv; v++) box = aabb_add(box, v3_add(o, m3_mul(*M, p->v[v])));
    /* the outer shape stands out by more than r at its corners: 4 r covers those above 30 degrees */
    q->box = aabb_grow(box, 4.0 * r);
}
