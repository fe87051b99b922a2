/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "block/block_model.h"
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "base/rng.h"
#include "block/closed_surface.h"
#include "geom/hilbert_order.h"

/* Planes of two sets coincide if they are closer than this all over the model, relative to its size. */
static const double SAME_TOL = 1e-9;
/* Share of the model's size by which the box around a surface is larger. */
static const double MARGIN = 0.05;

static int push_block(fl_block_model *m, fl_block_shape *s, fl_err *err)
{
    if (fl_grow(&m->block, &m->cap, (int64_t)m->n + 1, sizeof *m->block, err)) return -1;
    m->block[m->n++] = *s;
    *s = (fl_block_shape){0};
    return 0;
}

static int32_t push_plane(fl_block_model *m, fl_joint_plane p, fl_err *err)
{
    if (fl_grow(&m->plane, &m->plane_cap, (int64_t)m->planes + 1, sizeof *m->plane, err) ||
        fl_grow(&m->cuts, &m->cuts_cap, (int64_t)m->planes + 1, sizeof *m->cuts, err))
        return -1;
    m->plane[m->planes] = p;
    m->cuts[m->planes] = 0;
    return m->planes++;
}

static void set_size(fl_block_model *m, fl_vec3 lo, fl_vec3 hi)
{
    m->size = fmax(hi.x - lo.x, fmax(hi.y - lo.y, hi.z - lo.z));
    m->tol = FL_BLOCK_TOL * (m->size + v3_norm(lo) + v3_norm(hi));
}

static int start_box(fl_block_model *m, fl_vec3 lo, fl_vec3 hi, fl_err *err)
{
    fl_block_shape s;
    *m = (fl_block_model){0};
    set_size(m, lo, hi);
    if (fl_block_shape_box(&s, lo, hi, err)) return -1;
    if (push_block(m, &s, err) == 0) return 0;
    fl_block_shape_free(&s);
    return -1;
}

int fl_block_model_box(fl_block_model *m, fl_vec3 lo, fl_vec3 hi, fl_err *err)
{
    if (start_box(m, lo, hi, err)) return -1;
    m->volume = (hi.x - lo.x) * (hi.y - lo.y) * (hi.z - lo.z);
    return 0;
}

/* --- surfaces ----------------------------------------------------------------------------------- */

/* True if the triangle passes through the inside of block s; room for the corners of the clipped triangle
 * grows. */
static int passes_through(const fl_block_shape *s, const fl_vec3 t[3], double tol)
{
    enum { ROOM = 256 };
    fl_vec3 v[ROOM], out[ROOM];
    fl_aabb box = aabb_add(aabb_add(aabb_add(aabb_empty(), t[0]), t[1]), t[2]);
    int32_t n = 3;
    if (!aabb_overlap(box, s->box)) return 0;
    memcpy(v, t, 3 * sizeof *v);
    for (int32_t f = 0; f < s->nf && n >= 3; f++) {
        double c;
        const fl_vec3 nf = fl_block_face_normal(s, f, &c);
        int32_t at = 0, inside = 0;
        for (int32_t k = 0; k < n && at + 2 < ROOM; k++) {
            const fl_vec3 a = v[k], b = v[(k + 1) % n];
            const double sa = v3_dot(nf, a) - c, sb = v3_dot(nf, b) - c;
            inside |= sa < -tol;
            if (sa <= 0.0) out[at++] = a;
            if ((sa < 0.0 && sb > 0.0) || (sa > 0.0 && sb < 0.0)) out[at++] = v3_lerp(a, b, sa / (sa - sb));
        }
        if (!inside) return 0;
        n = at;
        memcpy(v, out, (size_t)n * sizeof *v);
    }
    fl_vec3 area = v3(0, 0, 0);
    for (int32_t k = 1; k + 1 < n; k++)
        area = v3_add(area, v3_cross(v3_sub(v[k], v[0]), v3_sub(v[k + 1], v[0])));
    return v3_norm(area) > tol * v3_norm(v3_sub(s->box.hi, s->box.lo));
}

/* Splits block k by a plane; the part above is appended. */
static int split_block(fl_block_model *m, int32_t k, int32_t plane, fl_err *err)
{
    fl_block_shape part[2];
    const fl_joint_plane *p = &m->plane[plane];
    const int rc = fl_block_shape_split(&m->block[k], p->n, p->c, plane, m->tol, part, err);
    if (rc <= 0) return rc;
    fl_block_shape_free(&m->block[k]);
    m->block[k] = part[0];
    m->cuts[plane]++;
    if (push_block(m, &part[1], err) == 0) return 0;
    fl_block_shape_free(&part[1]);
    return -1;
}

/* The number of the plane of a triangle, a new one if none is equal. */
static int32_t plane_of(fl_block_model *m, const fl_vec3 t[3], fl_err *err)
{
    fl_vec3 n = v3_unit(v3_cross(v3_sub(t[1], t[0]), v3_sub(t[2], t[0])));
    if (n.z < 0.0 || (n.z == 0.0 && (n.y < 0.0 || (n.y == 0.0 && n.x < 0.0)))) n = v3_neg(n);
    const double c = v3_dot(n, t[0]);
    for (int32_t k = 0; k < m->planes; k++) {
        const fl_joint_plane *p = &m->plane[k];
        int same = v3_dot(n, p->n) > 0.5;
        for (int e = 0; e < 3 && same; e++) same = fabs(v3_dot(p->n, t[e]) - p->c) <= 10.0 * m->tol;
        if (same) return k;
    }
    return push_plane(m, (fl_joint_plane){n, c, -1, m->planes}, err);
}

/* Cuts all blocks through which triangles of the surface pass. */
static int cut_by_surface(fl_block_model *m, const fl_part *p, fl_err *err)
{
    for (int32_t t = 0; t < p->nt; t++) {
        const fl_vec3 x[3] = {p->v[p->t[t].v[0]], p->v[p->t[t].v[1]], p->v[p->t[t].v[2]]};
        const int32_t plane = plane_of(m, x, err), blocks = m->n;
        if (plane < 0) return -1;
        for (int32_t k = 0; k < blocks; k++)
            if (passes_through(&m->block[k], x, m->tol) && split_block(m, k, plane, err)) return -1;
    }
    m->first_joint = m->planes;
    return 0;
}

static int is_inside(const fl_block_shape *s, const fl_part *p)
{
    fl_vec3 centre;
    fl_block_shape_volume(s, &centre);
    return fl_closed_surface_contains(p, centre);
}

int fl_block_model_surface(fl_block_model *m, const fl_part *p, fl_err *err)
{
    *m = (fl_block_model){0};
    if (fl_closed_surface_check(p, err)) return -1;
    const fl_aabb box = fl_part_aabb(p);
    const double size = fmax(box.hi.x - box.lo.x, fmax(box.hi.y - box.lo.y, box.hi.z - box.lo.z));
    const fl_aabb around = aabb_grow(box, MARGIN * size);
    if (start_box(m, around.lo, around.hi, err)) return -1;
    set_size(m, box.lo, box.hi);
    if (cut_by_surface(m, p, err)) return -1;
    int32_t n = 0;
    for (int32_t k = 0; k < m->n; k++) {
        if (is_inside(&m->block[k], p)) m->block[n++] = m->block[k];
        else fl_block_shape_free(&m->block[k]);
    }
    m->n = n;
    m->volume = fl_closed_surface_volume(p);
    return 0;
}

int fl_block_model_region(fl_block_model *m, const fl_part *p, const char *group, fl_err *err)
{
    int32_t some = 0;
    if (fl_closed_surface_check(p, err)) return -1;
    const int32_t g = fl_string_table_add(&m->groups, group, err);
    if (g < 0 || cut_by_surface(m, p, err)) return -1;
    for (int32_t k = 0; k < m->n; k++)
        if (is_inside(&m->block[k], p)) m->block[k].group = g, some++;
    return some ? 0 : fl_fail(err, FL_INPUT, "region %s has no part of the model", group);
}

/* --- joints ------------------------------------------------------------------------------------- */

static int copy_pieces(fl_block_model *m, fl_err *err)
{
    if (!(m->piece = fl_alloc(m->n, sizeof *m->piece, err))) return -1;
    for (int32_t k = 0; k < m->n; k++) {
        const fl_block_shape *from = &m->block[k];
        fl_block_shape *to = &m->piece[k];
        const int32_t nl = from->first[from->nf];
        if (fl_block_shape_alloc(to, from->nv, from->nf, nl, err)) return -1;
        m->pieces++;
        to->nv = from->nv, to->nf = from->nf, to->box = from->box, to->group = from->group;
        memcpy(to->v, from->v, (size_t)from->nv * sizeof *to->v);
        memcpy(to->first, from->first, ((size_t)from->nf + 1) * sizeof *to->first);
        memcpy(to->tag, from->tag, (size_t)from->nf * sizeof *to->tag);
        memcpy(to->loop, from->loop, (size_t)nl * sizeof *to->loop);
    }
    return 0;
}

static int check_coincidence(const fl_block_model *m, const fl_joint_sets *sets, fl_err *err)
{
    fl_aabb box = aabb_empty();
    for (int32_t k = 0; k < m->n; k++) box = aabb_join(box, m->block[k].box);
    const fl_vec3 mid = v3_scale(0.5, v3_add(box.lo, box.hi));
    for (int32_t a = m->first_joint; a < m->planes; a++)
        for (int32_t b = m->first_joint; b < a; b++) {
            const fl_joint_plane *p = &m->plane[a], *q = &m->plane[b];
            if (p->set == q->set) continue;
            const double turn = v3_norm(v3_cross(p->n, q->n)), sign = v3_dot(p->n, q->n) < 0.0 ? -1.0 : 1.0;
            const double apart = fabs(v3_dot(p->n, mid) - p->c - sign * (v3_dot(q->n, mid) - q->c));
            if (turn * m->size + apart < SAME_TOL * m->size)
                return fl_fail(err, FL_INPUT, "plane %d of joint %s and plane %d of joint %s coincide",
                               q->number, sets->set[q->set].name, p->number, sets->set[p->set].name);
        }
    return 0;
}

static int add_planes(fl_block_model *m, const fl_joint_sets *sets, uint64_t seed, fl_err *err)
{
    fl_aabb box = aabb_empty();
    for (int32_t k = 0; k < m->n; k++) box = aabb_join(box, m->block[k].box);
    for (int32_t s = 0; s < sets->n; s++) {
        int32_t first, last;
        fl_joint_set_range(&sets->set[s], s, box, seed, &first, &last);
        for (int32_t k = first; k <= last; k++)
            if (push_plane(m, fl_joint_set_plane(&sets->set[s], s, k, seed), err) < 0) return -1;
    }
    return check_coincidence(m, sets, err);
}

/* Whether a plane that meets a block cuts it: a random number of the two. */
static int is_cut(const fl_joint_set *s, const fl_block_shape *b, int32_t set, int32_t number, uint64_t seed)
{
    if (s->persistence >= 1.0 || s->meaning == FL_PERSISTENCE_GLUE) return 1;
    const uint64_t plane = (uint64_t)fl_rng_entity(set, number);
    fl_rng g = fl_rng_of(seed, (int64_t)(fl_block_mix(plane + 1) ^ b->key), FL_RNG_PERSISTENCE);
    return fl_rng_unit(&g) < s->persistence;
}

/* Cuts all blocks by plane p; part[2 n] is scratch. */
static int cut_by_plane(fl_block_model *m, const fl_joint_set *s, int32_t p, uint64_t seed,
                        fl_block_shape *part, int8_t *split, fl_err *err)
{
    enum { FEW = 256 };
    const fl_joint_plane pl = m->plane[p];
    const int32_t n = m->n;
    int failed = 0;
#pragma omp parallel for schedule(static) if (n > FEW)
    for (int32_t k = 0; k < n; k++) {
        fl_err why = {0};
        split[k] = 0;
        if (!is_cut(s, &m->block[k], pl.set, pl.number, seed)) continue;
        split[k] =
            (int8_t)fl_block_shape_split(&m->block[k], pl.n, pl.c, p, m->tol, part + 2 * (int64_t)k, &why);
        if (split[k] >= 0) continue;
#pragma omp critical(fl_block_cut)
        if (!failed) {
            failed = 1;
            *err = why;
        }
    }
    for (int32_t k = 0; k < n; k++) {
        if (split[k] <= 0) continue;
        fl_block_shape_free(&m->block[k]);
        m->block[k] = part[2 * (int64_t)k];
        m->cuts[p]++;
        if (!failed && push_block(m, &part[2 * (int64_t)k + 1], err)) failed = 1;
        fl_block_shape_free(&part[2 * (int64_t)k + 1]);
    }
    return failed ? -1 : 0;
}

int fl_block_model_cut(fl_block_model *m, const fl_joint_sets *sets, uint64_t seed, fl_err *err)
{
    fl_block_shape *part = NULL;
    int8_t *split = NULL;
    int32_t cap = 0, split_cap = 0;
    int rc = copy_pieces(m, err) || add_planes(m, sets, seed, err) ? -1 : 0;
    for (int32_t p = m->first_joint; p < m->planes && rc == 0; p++) {
        if (fl_grow(&part, &cap, 2 * (int64_t)m->n, sizeof *part, err) ||
            fl_grow(&split, &split_cap, m->n, sizeof *split, err))
            rc = -1;
        else rc = cut_by_plane(m, &sets->set[m->plane[p].set], p, seed, part, split, err);
    }
    free(part), free(split);
    return rc;
}

/* --- order -------------------------------------------------------------------------------------- */

typedef struct {
    uint64_t at;
    int32_t k;
} block_place;

static int by_place(const void *a, const void *b)
{
    const block_place *s = a, *t = b;
    if (s->at != t->at) return s->at < t->at ? -1 : 1;
    return (s->k > t->k) - (s->k < t->k);
}

int fl_block_model_sort(fl_block_model *m, fl_err *err)
{
    enum { CELLS = (1 << 21) - 1 };
    block_place *order = fl_alloc(m->n, sizeof *order, err);
    fl_block_shape *to = fl_alloc(m->n, sizeof *to, err);
    fl_aabb box = aabb_empty();
    if (!order || !to) {
        free(order), free(to);
        return -1;
    }
    for (int32_t k = 0; k < m->n; k++) box = aabb_join(box, m->block[k].box);
    const double scale = CELLS / fmax(m->size * 1.2, 1e-300);
    for (int32_t k = 0; k < m->n; k++) {
        fl_vec3 x;
        fl_block_shape_volume(&m->block[k], &x);
        x = v3_scale(scale, v3_sub(x, box.lo));
        order[k] = (block_place){fl_hilbert_index3((uint32_t)x.x, (uint32_t)x.y, (uint32_t)x.z), k};
    }
    qsort(order, (size_t)m->n, sizeof *order, by_place);
    for (int32_t k = 0; k < m->n; k++) to[k] = m->block[order[k].k];
    memcpy(m->block, to, (size_t)m->n * sizeof *to);
    free(order), free(to);
    return 0;
}

int32_t fl_block_model_delete(fl_block_model *m, const char *group, fl_err *err)
{
    const int32_t g = fl_string_table_find(&m->groups, group);
    int32_t n = 0, gone = 0;
    if (g < 0) return fl_fail(err, FL_INPUT, "no region has the name %s", group);
    for (int32_t k = 0; k < m->n; k++) {
        if (m->block[k].group != g) {
            m->block[n++] = m->block[k];
            continue;
        }
        fl_block_shape_free(&m->block[k]);
        gone++;
    }
    m->n = n;
    return gone;
}

void fl_block_model_free(fl_block_model *m)
{
    for (int32_t k = 0; k < m->n; k++) fl_block_shape_free(&m->block[k]);
    for (int32_t k = 0; k < m->pieces; k++) fl_block_shape_free(&m->piece[k]);
    free(m->block), free(m->piece), free(m->plane), free(m->cuts);
    fl_string_table_free(&m->groups);
    *m = (fl_block_model){0};
}
