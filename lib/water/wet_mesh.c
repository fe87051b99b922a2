/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "water/wet_mesh.h"
#include <stdlib.h>
#include <string.h>
#include "base/array.h"

/* Triangles of a leaf. */
enum { LEAF = 4 };

/* --- sums -------------------------------------------------------------------------------------------- */

/* Adds the triangle a, b, c. int x_i x_j dA = area/12 (sum_k v_i v_j + s_i s_j), s the sum of the corners. */
static void add_triangle(fl_wet_sums *o, fl_vec3 a, fl_vec3 b, fl_vec3 c)
{
    const fl_vec3 n = v3_scale(0.5, v3_cross(v3_sub(b, a), v3_sub(c, a))), s = v3_add(a, v3_add(b, c));
    const double N[3] = {n.x, n.y, n.z}, x[3] = {s.x / 3.0, s.y / 3.0, s.z / 3.0}, w = 1.0 / 12.0;
    const double xy = w * (a.x * a.y + b.x * b.y + c.x * c.y + s.x * s.y),
                 yz = w * (a.y * a.z + b.y * b.z + c.y * c.z + s.y * s.z),
                 zx = w * (a.z * a.x + b.z * b.x + c.z * c.x + s.z * s.x),
                 xx = w * (a.x * a.x + b.x * b.x + c.x * c.x + s.x * s.x),
                 yy = w * (a.y * a.y + b.y * b.y + c.y * c.y + s.y * s.y),
                 zz = w * (a.z * a.z + b.z * b.z + c.z * c.z + s.z * s.z);
    const double X[3][3] = {{xx, xy, zx}, {xy, yy, yz}, {zx, yz, zz}}; /* int x x dA over the area */
    o->A = v3_add(o->A, n);
    o->wetted += v3_norm(n);
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) o->M.m[i][j] += x[i] * N[j];
        o->Q.m[i][0] += X[i][1] * N[2] - X[i][2] * N[1];
        o->Q.m[i][1] += X[i][2] * N[0] - X[i][0] * N[2];
        o->Q.m[i][2] += X[i][0] * N[1] - X[i][1] * N[0];
    }
}

static void add_sums(fl_wet_sums *o, const fl_wet_sums *p)
{
    o->A = v3_add(o->A, p->A);
    o->wetted += p->wetted;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) o->M.m[i][j] += p->M.m[i][j], o->Q.m[i][j] += p->Q.m[i][j];
}

/* The wet part of a triangle; p: heads of its corners. */
static void add_cut(fl_wet_sums *o, const fl_vec3 *v, const double *p)
{
    fl_vec3 w[4];
    int m = 0;
    for (int k = 0; k < 3; k++) {
        const int j = (k + 1) % 3;
        if (p[k] > 0.0) w[m++] = v[k];
        if ((p[k] > 0.0) != (p[j] > 0.0)) /* from the wet end, as across the side */
            w[m++] = p[k] > 0.0 ? v3_lerp(v[k], v[j], p[k] / (p[k] - p[j]))
                                : v3_lerp(v[j], v[k], p[j] / (p[j] - p[k]));
    }
    for (int k = 1; k + 1 < m; k++) add_triangle(o, w[0], w[k], w[k + 1]);
}

void fl_wet_mesh_sums(const fl_wet_mesh *m, fl_vec3 G, double c, fl_wet_sums *out)
{
    enum { DEEP = 64 };
    int32_t open[DEEP], n = 0;
    *out = (fl_wet_sums){0};
    open[n++] = 0;
    while (n) {
        const fl_wet_box *b = &m->box[open[--n]];
        const double p = c - v3_dot(G, b->middle),
                     far = fabs(G.x) * b->half.x + fabs(G.y) * b->half.y + fabs(G.z) * b->half.z;
        if (p <= -far) continue;
        if (p >= far) {
            add_sums(out, &b->sums);
        } else if (b->second) {
            open[n++] = b->second;
            open[n++] = (int32_t)(b - m->box) + 1;
        } else {
            for (int32_t k = b->first; k < b->last; k++) {
                const fl_vec3 *v = m->v + 3 * (int64_t)k;
                const double head[3] = {c - v3_dot(G, v[0]), c - v3_dot(G, v[1]), c - v3_dot(G, v[2])};
                if (head[0] > 0.0 && head[1] > 0.0 && head[2] > 0.0) add_triangle(out, v[0], v[1], v[2]);
                else if (head[0] > 0.0 || head[1] > 0.0 || head[2] > 0.0) add_cut(out, v, head);
            }
        }
    }
}

void fl_wet_sums_load(const fl_wet_sums *s, fl_vec3 G, double c, fl_vec3 *force, fl_vec3 *moment)
{
    const double(*M)[3] = s->M.m;
    const fl_vec3 S = v3(M[1][2] - M[2][1], M[2][0] - M[0][2], M[0][1] - M[1][0]);
    *force = v3_madd(m3_tmul(s->M, G), -c, s->A);
    *moment = v3_madd(m3_tmul(s->Q, G), -c, S);
}

/* --- the tree ---------------------------------------------------------------------------------------- */

typedef struct {
    fl_vec3 v[3], middle;
    int32_t index;
    double key;
} tree_item;

static int compare_items(const void *a, const void *b)
{
    const tree_item *p = a, *q = b;
    if (p->key != q->key) return p->key < q->key ? -1 : 1;
    return (p->index > q->index) - (p->index < q->index);
}

static void widen(fl_vec3 *lo, fl_vec3 *hi, fl_vec3 x)
{
    *lo = v3(fmin(lo->x, x.x), fmin(lo->y, x.y), fmin(lo->z, x.z));
    *hi = v3(fmax(hi->x, x.x), fmax(hi->y, x.y), fmax(hi->z, x.z));
}

/* Makes the box of items [first, last) and those below it. */
static void make_box(fl_wet_mesh *m, tree_item *item, int32_t first, int32_t last)
{
    fl_wet_box *const b = &m->box[m->boxes++];
    fl_vec3 lo = item[first].v[0], hi = lo, low = item[first].middle, high = low;
    *b = (fl_wet_box){.first = first, .last = last};
    for (int32_t k = first; k < last; k++) {
        for (int c = 0; c < 3; c++) widen(&lo, &hi, item[k].v[c]);
        widen(&low, &high, item[k].middle);
    }
    b->middle = v3_lerp(lo, hi, 0.5);
    b->half = v3_scale(0.5, v3_sub(hi, lo));
    if (last - first <= LEAF) {
        for (int32_t k = first; k < last; k++)
            add_triangle(&b->sums, item[k].v[0], item[k].v[1], item[k].v[2]);
        return;
    }
    const fl_vec3 wide = v3_sub(high, low);
    const int axis = wide.x >= wide.y && wide.x >= wide.z ? 0 : wide.y >= wide.z ? 1 : 2;
    for (int32_t k = first; k < last; k++) item[k].key = v3_at(item[k].middle, axis);
    qsort(item + first, (size_t)(last - first), sizeof *item, compare_items);
    const int32_t middle = first + (last - first) / 2, next = m->boxes;
    make_box(m, item, first, middle);
    b->second = m->boxes;
    make_box(m, item, middle, last);
    add_sums(&b->sums, &m->box[next].sums);
    add_sums(&b->sums, &m->box[b->second].sums);
}

int fl_wet_mesh_make(fl_wet_mesh *m, fl_vec3 *v, int32_t n, fl_err *err)
{
    tree_item *const item = fl_alloc(n, sizeof *item, err);
    *m = (fl_wet_mesh){.n = n, .v = v};
    if (item) m->box = fl_alloc(2 * (int64_t)n, sizeof *m->box, err);
    if (!m->box) {
        free(item);
        fl_wet_mesh_free(m);
        return -1;
    }
    for (int32_t k = 0; k < n; k++) {
        const fl_vec3 *x = v + 3 * (int64_t)k;
        memcpy(item[k].v, x, sizeof item[k].v);
        item[k].middle = v3_scale(1.0 / 3.0, v3_add(x[0], v3_add(x[1], x[2])));
        item[k].index = k;
        for (int c = 0; c < 3; c++) m->reach = fmax(m->reach, v3_norm(x[c]));
    }
    make_box(m, item, 0, n);
    for (int32_t k = 0; k < n; k++) memcpy(v + 3 * (int64_t)k, item[k].v, sizeof item[k].v);
    free(item);
    return 0;
}

void fl_wet_mesh_free(fl_wet_mesh *m)
{
    free(m->v), free(m->box);
    *m = (fl_wet_mesh){0};
}
