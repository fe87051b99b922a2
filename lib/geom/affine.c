/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "geom/affine.h"

static const double RADIANS = 0.01745329251994329577; /* radians per degree */

fl_affine fl_affine_identity(void) { return (fl_affine){.q = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, .s = 1.0}; }

/* Cosine and sine of an angle in degrees.  The C library gets at most an eighth of a turn: the rest after
 * whole quarter turns, which fmod() and a subtraction remove exactly. */
static void cos_sin_degrees(double degrees, double *c, double *s)
{
    const double turn = fmod(degrees, 360.0), quarters = nearbyint(turn / 90.0);
    const double a = (turn - 90.0 * quarters) * RADIANS, x = cos(a), y = sin(a);
    const int k = ((int)quarters % 4 + 4) % 4;
    *c = k == 0 ? x : k == 1 ? -y : k == 2 ? -x : y;
    *s = k == 0 ? y : k == 1 ? x : k == 2 ? -y : -x;
}

fl_mat3 fl_affine_rotation(fl_vec3 axis, double degrees)
{
    const fl_vec3 u = v3_unit(axis);
    const double a[3] = {u.x, u.y, u.z};
    const double cross[3][3] = {{0, -u.z, u.y}, {u.z, 0, -u.x}, {-u.y, u.x, 0}};
    double c, s;
    fl_mat3 r;
    cos_sin_degrees(degrees, &c, &s);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            r.m[i][j] = (i == j ? c : 0.0) + (1.0 - c) * a[i] * a[j] + s * cross[i][j];
    for (int i = 0; i < 3; i++) /* c + (1 - c) 1 rounds; rotation about a coordinate axis leaves it fixed */
        if (fabs(a[i]) == 1.0) r.m[i][i] = 1.0;
    return r;
}

fl_mat3 fl_affine_matrix_product(const fl_mat3 *a, const fl_mat3 *b)
{
    fl_mat3 p;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            p.m[i][j] = a->m[i][0] * b->m[0][j] + a->m[i][1] * b->m[1][j] + a->m[i][2] * b->m[2][j];
    return p;
}

static fl_vec3 map_point(const fl_affine *m, fl_vec3 x) { return v3_madd(m->t, m->s, m3_mul(m->q, x)); }

static int is_mirror(const fl_mat3 *q)
{
    return v3_dot(m3_col(*q, 0), v3_cross(m3_col(*q, 1), m3_col(*q, 2))) < 0.0;
}

void fl_part_map(fl_part *p, const fl_affine *m)
{
    const int wind = is_mirror(&m->q);
    for (int32_t v = 0; v < p->nv; v++) p->v[v] = map_point(m, p->v[v]);
    for (int32_t t = 0; wind && t < p->nt; t++) {
        const int32_t keep = p->t[t].v[1];
        p->t[t].v[1] = p->t[t].v[2];
        p->t[t].v[2] = keep;
    }
    for (int32_t c = 0; c < p->nc; c++) {
        fl_cone *k = &p->cone[c];
        *k = (fl_cone){map_point(m, k->p0), map_point(m, k->p1), m->s * k->r0, m->s * k->r1};
    }
}
