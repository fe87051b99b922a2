/* SPDX-License-Identifier: GPL-3.0-or-later */
/* gpu_list_kernel.h -- what one thread of a device does for the list of sphere contacts: the rows and links
 * that sphere/contact_list.h makes, in its order, with what rows remember.
 *
 *     keys     Morton code of the cell of a body; cells are as wide as the largest pair with the skin
 *              (the launcher sorts bodies by their keys)
 *     count    partners of a body in its cell and the 26 around: with larger numbers, and all
 *              (the launcher makes offsets of both)
 *     fill     rows of a body, sorted by (j, image), each with the memory of its row before, or of a bond
 *              that has ended
 *     links    rows of a body in the order of its sums
 *
 * A pair is listed under the conditions of the CPU: boxes of broad/pairs.h overlap, the distance is below the
 * skin, and no bond stands between the two. */
#ifndef FL_GPU_GPU_LIST_KERNEL_H
#define FL_GPU_GPU_LIST_KERNEL_H
#include "gpu/gpu_view.h"
#include "law/normal.h"

/* 21 bits, two zeros after each. */
static inline uint64_t fl_gpu_spread(uint64_t x)
{
    x = (x | x << 32) & UINT64_C(0x1f00000000ffff);
    x = (x | x << 16) & UINT64_C(0x1f0000ff0000ff);
    x = (x | x << 8) & UINT64_C(0x100f00f00f00f00f);
    x = (x | x << 4) & UINT64_C(0x10c30c30c30c30c3);
    return (x | x << 2) & UINT64_C(0x1249249249249249);
}

static inline uint64_t fl_gpu_key_of(const int32_t c[3])
{
    return fl_gpu_spread((uint64_t)c[0]) | fl_gpu_spread((uint64_t)c[1]) << 1 |
           fl_gpu_spread((uint64_t)c[2]) << 2;
}

/* Cells before that of coordinate 0 in directions without a period. */
#define FL_GPU_CELL_ORIGIN (1 << 20)

/* Index of the periodic cell, as fl_periodic_cell_index(). */
static inline double fl_gpu_period_index(double x, double lo, double length)
{
    return length > 0.0 ? floor((x - lo) / length) : 0.0;
}

static inline int32_t fl_gpu_cell_along(double x, double lo, double length, double scale, int32_t cells)
{
    if (!(length > 0.0)) return (int32_t)floor(x * scale) + FL_GPU_CELL_ORIGIN;
    const int32_t c = (int32_t)floor((x - length * floor((x - lo) / length) - lo) * scale);
    return c < 0 ? 0 : c < cells ? c : cells - 1;
}

static inline void fl_gpu_cell_of(const fl_gpu_view *a, fl_vec3 x, int32_t c[3])
{
    c[0] = fl_gpu_cell_along(x.x, a->cell_lo.x, a->cell_length.x, a->cell_scale[0], a->cells[0]);
    c[1] = fl_gpu_cell_along(x.y, a->cell_lo.y, a->cell_length.y, a->cell_scale[1], a->cells[1]);
    c[2] = fl_gpu_cell_along(x.z, a->cell_lo.z, a->cell_length.z, a->cell_scale[2], a->cells[2]);
}

static inline void fl_gpu_make_key(const fl_gpu_view *a, int32_t k)
{
    int32_t c[3];
    a->key[k] = UINT64_MAX; /* of no cell */
    a->order[k] = k;
    if (a->host[k] == FL_GPU_EMPTY) return;
    fl_gpu_cell_of(a, a->state[k].x, c);
    a->key[k] = fl_gpu_key_of(c);
}

/* First place whose key is not below. */
static inline int32_t fl_gpu_first_of_key(const fl_gpu_view *a, uint64_t key)
{
    int32_t lo = 0, hi = a->n;
    while (lo < hi) {
        const int32_t middle = lo + (hi - lo) / 2;
        if (a->key[middle] < key) lo = middle + 1;
        else hi = middle;
    }
    return lo;
}

/* Relative margin of a distance, as in sphere/contact_list.c. */
#define FL_GPU_MARGIN 1e-9

/* 1 if the boxes overlap along one direction; period: offset of the cell of each, shift: of the image. */
static inline int fl_gpu_boxes_meet(double xi, double ri, double own_i, double xj, double rj, double own_j,
                                    double shift, double half_skin)
{
    const double lo_i = ((xi - ri) - half_skin) - own_i, hi_i = ((xi + ri) + half_skin) - own_i,
                 lo_j = ((xj - rj) - half_skin) - own_j, hi_j = ((xj + rj) + half_skin) - own_j;
    return lo_i - shift <= hi_j && lo_j <= hi_i - shift;
}

/* Bond of i < j with that image, or -1. */
static inline int64_t fl_gpu_bond_of(const fl_gpu_view *a, int32_t i, int32_t j, const int32_t image[3])
{
    if (!a->discs) return -1;
    for (int64_t k = a->disc_first_i[i]; k < a->disc_first_i[i + 1]; k++) {
        if (a->disc_j[k] != j) continue;
        const int32_t *e = a->disc_image ? &a->disc_image[3 * k] : NULL;
        if (!e || (e[0] == image[0] && e[1] == image[1] && e[2] == image[2])) return k;
    }
    return -1;
}

/* 1 if i < j is a row; shift: image of j beside i, in periods, of both in their cell.  image: out. */
static inline int fl_gpu_is_row(const fl_gpu_view *a, int32_t i, int32_t j, const int32_t shift[3],
                                int32_t image[3])
{
    const fl_sphere_state *p = &a->state[i], *q = &a->state[j];
    const fl_vec3 L = a->cell_length, lo = a->cell_lo;
    const double ci[3] = {fl_gpu_period_index(p->x.x, lo.x, L.x), fl_gpu_period_index(p->x.y, lo.y, L.y),
                          fl_gpu_period_index(p->x.z, lo.z, L.z)},
                 cj[3] = {fl_gpu_period_index(q->x.x, lo.x, L.x), fl_gpu_period_index(q->x.y, lo.y, L.y),
                          fl_gpu_period_index(q->x.z, lo.z, L.z)};
    const double g = 0.5 * a->skin + 0.0;
    if (!fl_gpu_boxes_meet(p->x.x, p->r, ci[0] * L.x, q->x.x, q->r, cj[0] * L.x, shift[0] * L.x, g) ||
        !fl_gpu_boxes_meet(p->x.y, p->r, ci[1] * L.y, q->x.y, q->r, cj[1] * L.y, shift[1] * L.y, g) ||
        !fl_gpu_boxes_meet(p->x.z, p->r, ci[2] * L.z, q->x.z, q->r, cj[2] * L.z, shift[2] * L.z, g))
        return 0;
    for (int e = 0; e < 3; e++) image[e] = shift[e] + (int32_t)(ci[e] - cj[e]);
    const double R = (p->r + q->r + a->skin) * (1.0 + FL_GPU_MARGIN);
    const fl_vec3 way = v3(image[0] * L.x, image[1] * L.y, image[2] * L.z);
    if (!(v3_norm2(v3_sub(v3_sub(p->x, q->x), way)) < R * R)) return 0;
    const int64_t bond = fl_gpu_bond_of(a, i, j, image);
    return bond < 0 || a->disc_ended[bond];
}

/* Moves the last of n + 1 numbers to its place among the ascending ones before it; images go with them. */
static inline void fl_gpu_insert(int32_t *list, int32_t *image, int32_t n, int32_t x, const int32_t e[3])
{
    int32_t at = n;
    for (; at > 0 && list[at - 1] > x; at--) {
        list[at] = list[at - 1];
        for (int c = 0; c < 3 && image; c++) image[3 * at + c] = image[3 * at - 3 + c];
    }
    list[at] = x;
    for (int c = 0; c < 3 && image; c++) image[3 * at + c] = e[c];
}

typedef struct {
    int32_t upper, lower;
} fl_gpu_partners;

/* Partners of k with larger and with smaller numbers; into upper, its images, and lower, where they are
 * given. */
static inline fl_gpu_partners fl_gpu_find_partners(const fl_gpu_view *a, int32_t k, int32_t *upper,
                                                   int32_t *upper_image, int32_t *lower)
{
    fl_gpu_partners n;
    int32_t own[3];
    n.upper = n.lower = 0;
    if (a->host[k] == FL_GPU_EMPTY) return n;
    fl_gpu_cell_of(a, a->state[k].x, own);
    for (int32_t way = 0; way < 27; way++) {
        const int32_t step[3] = {way % 3 - 1, way / 3 % 3 - 1, way / 9 - 1};
        int32_t c[3], shift[3], back[3], image[3];
        for (int e = 0; e < 3; e++) {
            c[e] = own[e] + step[e];
            shift[e] = 0;
            if (a->cells[e] && c[e] < 0) c[e] += a->cells[e], shift[e] = -1;
            if (a->cells[e] && c[e] >= a->cells[e]) c[e] -= a->cells[e], shift[e] = 1;
            back[e] = -shift[e];
        }
        const uint64_t key = fl_gpu_key_of(c);
        for (int32_t at = fl_gpu_first_of_key(a, key); at < a->n && a->key[at] == key; at++) {
            const int32_t j = a->order[at];
            if (j > k && fl_gpu_is_row(a, k, j, shift, image)) {
                if (upper) fl_gpu_insert(upper, upper_image, n.upper, j, image);
                n.upper++;
            } else if (j < k && fl_gpu_is_row(a, j, k, back, image)) {
                if (lower) fl_gpu_insert(lower, NULL, n.lower, j, image);
                n.lower++;
            }
        }
    }
    return n;
}

static inline void fl_gpu_count_rows(const fl_gpu_view *a, int32_t k)
{
    const fl_gpu_partners n = fl_gpu_find_partners(a, k, NULL, NULL, NULL);
    a->new_first[k] = n.upper;
    a->new_link_first[k] = n.upper + n.lower;
}

/* kappa of two spheres, as fl_pair_stiffness(). */
static inline double fl_gpu_kappa(const fl_gpu_view *a, const fl_gpu_law *law, double ri, double rj)
{
    const double r = ri < rj ? ri : rj;
    if (law->stiffness > 0.0) return law->stiffness;
    if (a->linear) return law->stiffness_factor * (law->round_young * PI * r * r / (ri + rj));
    return law->stiffness_factor * (4.0 / 3.0 * law->modulus * sqrt(ri * rj / (ri + rj)));
}

/* Spring of friction after a bond that has just ended, as fl_disc_list_init_contact(). */
static inline void fl_gpu_after_bond(const fl_gpu_view *a, int32_t i, int32_t j, const int32_t image[3],
                                     const fl_gpu_law *law, fl_sphere_contact *c)
{
    const int64_t k = fl_gpu_bond_of(a, i, j, image);
    if (k < 0 || a->disc_ended[k] != 1) return;
    fl_vec3 d = v3_sub(a->state[j].x, a->state[i].x);
    if (a->disc_shift) d = v3_add(d, a->disc_shift[k]);
    const double over = a->state[i].r + a->state[j].r - v3_norm(d),
                 kt =
                     over > 0.0 ? law->tangential * c->k * fl_normal_slope(over, a->linear ? 1.0 : 1.5) : 0.0;
    if (!(kt > 0.0)) return;
    c->spring_force = c->friction_force = a->disc[k].S;
    c->spring_stiffness = kt;
}

/* Order of an old row and (j, image). */
static inline int fl_gpu_compare_row(const fl_gpu_view *a, int32_t c, int32_t j, const int32_t image[3])
{
    if (a->row_j[c] != j) return a->row_j[c] < j ? -1 : 1;
    for (int e = 0; a->row_image && e < 3; e++)
        if (a->row_image[3 * (int64_t)c + e] != image[e])
            return a->row_image[3 * (int64_t)c + e] < image[e] ? -1 : 1;
    return 0;
}

static inline void fl_gpu_fill_rows(const fl_gpu_view *a, int32_t k)
{
    const int32_t first = a->new_first[k], none[3] = {0, 0, 0};
    int32_t *const image = a->new_row_image ? &a->new_row_image[3 * (int64_t)first] : NULL;
    const fl_gpu_partners n =
        fl_gpu_find_partners(a, k, &a->new_row_j[first], image, &a->lower[a->new_link_first[k]]);
    int32_t at = a->first[k];
    const int32_t end = a->first[k + 1];
    for (int32_t e = 0; e < n.upper; e++) {
        const int32_t c = first + e, j = a->new_row_j[c], *cells = image ? &image[3 * e] : none,
                      l = a->material[k] * a->law_columns + a->material[j];
        a->new_row_i[c] = k;
        a->new_row_law[c] = l;
        while (at < end && fl_gpu_compare_row(a, at, j, cells) < 0) at++;
        if (at < end && fl_gpu_compare_row(a, at, j, cells) == 0) {
            if (a->rolling) a->new_rolling[c] = a->rolling[at];
            a->new_touches[c] = a->touches[at];
            a->new_contact[c] = a->contact[at++];
            continue;
        }
        fl_sphere_contact fresh;
        fresh.spring_force = fresh.friction_force = v3(0, 0, 0);
        fresh.spring_stiffness = fresh.normal_damping = fresh.max_approach_speed = 0.0;
        fresh.k = fl_gpu_kappa(a, &a->law[l], a->state[k].r, a->state[j].r);
        fl_gpu_after_bond(a, k, j, cells, &a->law[l], &fresh);
        a->new_contact[c] = fresh;
        a->new_touches[c] = 0;
        if (a->rolling) {
            fl_rolling_spring roll;
            roll.elastic = roll.total = v3(0, 0, 0), roll.k = roll.arm = 0.0;
            a->new_rolling[c] = roll;
        }
    }
}

/* Row of i with partner k, in the new list. */
static inline int32_t fl_gpu_row_of(const fl_gpu_view *a, int32_t i, int32_t k)
{
    int32_t lo = a->first[i], hi = a->first[i + 1];
    while (lo < hi) {
        const int32_t middle = lo + (hi - lo) / 2;
        if (a->row_j[middle] < k) lo = middle + 1;
        else hi = middle;
    }
    return lo;
}

/* After the new rows have taken the place of the old ones. */
static inline void fl_gpu_link_rows(const fl_gpu_view *a, int32_t k)
{
    const int32_t begin = k / FL_SPHERE_CHUNK * FL_SPHERE_CHUNK, from = a->link_first[k],
                  own = a->first[k + 1] - a->first[k], lower = a->link_first[k + 1] - from - own;
    int32_t at = from, e = 0;
    while (e < lower && a->lower[from + e] < begin) e++;
    for (int32_t l = e; l < lower; l++) a->link[at++] = 2 * fl_gpu_row_of(a, a->lower[from + l], k) + 1;
    for (int32_t l = 0; l < own; l++) a->link[at++] = 2 * (a->first[k] + l);
    for (int32_t l = 0; l < e; l++) a->link[at++] = 2 * fl_gpu_row_of(a, a->lower[from + l], k) + 1;
}

/* Bonds that have ended are listed now. */
static inline void fl_gpu_forget_ended(const fl_gpu_view *a, int32_t k)
{
    if (a->disc_ended[k] != 1) return;
    a->disc_ended[k] = 2;
    a->disc_pending[k] = 0.0;
}

#endif
