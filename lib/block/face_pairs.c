/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "block/face_pairs.h"
#include <stdlib.h>
#include "base/array.h"
#include "base/rng.h"
#include "geom/polygon_clip.h"

/* Least common part over the smaller face. */
static const double LEAST_PART = 1e-9;

/* A face of a plane with its rectangle in that plane. */
typedef struct {
    int32_t block, face, tag, first, n; /* corners first .. first + n in the plane */
    fl_vec2 lo, hi;
    double area;
} flat_face;

typedef struct {
    const fl_block_model *m;
    const fl_joint_sets *sets;
    uint64_t seed;
    fl_face_pairs *out;
    flat_face *face; /* sorted by plane and side, then lo.x */
    fl_vec2 *corner, *scratch;
    int32_t scratch_cap;
} pair_search;

static int by_plane(const void *a, const void *b)
{
    const flat_face *s = a, *t = b;
    if (s->tag / 2 != t->tag / 2) return s->tag / 2 < t->tag / 2 ? -1 : 1;
    if (s->lo.x < t->lo.x || s->lo.x > t->lo.x) return s->lo.x < t->lo.x ? -1 : 1;
    if (s->block != t->block) return s->block < t->block ? -1 : 1;
    return (s->face > t->face) - (s->face < t->face);
}

/* Corners of a face in the plane, counter-clockwise about the normal of the plane. */
static void flatten_face(const pair_search *w, flat_face *f, int32_t k, int32_t at)
{
    const fl_block_shape *s = &w->m->block[k];
    const fl_joint_plane *p = &w->m->plane[f->tag / 2];
    const fl_vec3 a = v3_normal_to(p->n), b = v3_cross(p->n, a);
    const int32_t n = s->first[f->face + 1] - s->first[f->face];
    f->block = k, f->first = at, f->n = n;
    f->lo = (fl_vec2){INFINITY, INFINITY}, f->hi = (fl_vec2){-INFINITY, -INFINITY};
    for (int32_t c = 0; c < n; c++) {
        const int32_t turn = f->tag % 2 ? n - 1 - c : c; /* a block above the plane faces down */
        const fl_vec3 x = s->v[s->loop[s->first[f->face] + turn]];
        const fl_vec2 v = {v3_dot(a, x), v3_dot(b, x)};
        w->corner[at + c] = v;
        f->lo = (fl_vec2){fmin(f->lo.x, v.x), fmin(f->lo.y, v.y)};
        f->hi = (fl_vec2){fmax(f->hi.x, v.x), fmax(f->hi.y, v.y)};
    }
    f->area = fl_polygon_area(n, w->corner + at);
}

/* Whether the pair is intact: a plane of a surface, outside the disc of its set, or by chance. */
static int is_intact(const pair_search *w, int32_t i, int32_t j, int32_t plane, fl_vec3 x)
{
    const fl_joint_plane *p = &w->m->plane[plane];
    if (p->set < 0) return 1;
    const fl_joint_set *s = &w->sets->set[p->set];
    if (s->radius > 0.0) {
        const fl_vec3 from = v3_sub(x, s->origin), across = v3_madd(from, -v3_dot(from, p->n), p->n);
        if (v3_norm(across) > s->radius) return 1;
    }
    if (s->meaning != FL_PERSISTENCE_GLUE || s->persistence >= 1.0) return 0;
    const uint64_t key = fl_block_mix(w->m->block[i].key) ^ fl_block_mix(w->m->block[j].key) ^
                         fl_block_mix((uint64_t)fl_rng_entity(p->set, p->number) + 1);
    fl_rng g = fl_rng_of(w->seed, (int64_t)key, FL_RNG_PERSISTENCE);
    return !(fl_rng_unit(&g) < s->persistence);
}

static int compare_faces(pair_search *w, const flat_face *f, const flat_face *g, fl_err *err)
{
    if (f->tag == g->tag || f->lo.y > g->hi.y || g->lo.y > f->hi.y) return 0;
    if (fl_grow(&w->scratch, &w->scratch_cap, (int64_t)f->n + g->n, sizeof *w->scratch, err)) return -1;
    const int32_t n = fl_polygon_common(f->n, w->corner + f->first, g->n, w->corner + g->first, w->scratch);
    if (n < 3) return 0;
    const fl_polygon_moments q = fl_polygon_moments_of(n, w->scratch);
    if (!(q.area > LEAST_PART * fmin(f->area, g->area))) return 0;
    const int32_t plane = f->tag / 2;
    const fl_joint_plane *p = &w->m->plane[plane];
    const fl_vec3 a = v3_normal_to(p->n), b = v3_cross(p->n, a),
                  x = v3_madd(v3_madd(v3_scale(p->c, p->n), q.centre.x, a), q.centre.y, b);
    fl_face_pairs *s = w->out;
    if (f->block > g->block) {
        const flat_face *t = f;
        f = g, g = t;
    }
    if (fl_grow(&s->pair, &s->cap, (int64_t)s->n + 1, sizeof *s->pair, err)) return -1;
    s->pair[s->n++] = (fl_face_pair){
        f->block, g->block, f->face, g->face, plane, is_intact(w, f->block, g->block, plane, x), q.area, x};
    return 0;
}

static int by_blocks(const void *a, const void *b)
{
    const fl_face_pair *s = a, *t = b;
    if (s->i != t->i) return s->i < t->i ? -1 : 1;
    if (s->j != t->j) return s->j < t->j ? -1 : 1;
    return (s->fi > t->fi) - (s->fi < t->fi);
}

int fl_face_pairs_find(fl_face_pairs *s, const fl_block_model *m, const fl_joint_sets *sets, uint64_t seed,
                       fl_err *err)
{
    pair_search w = {m, sets, seed, s, NULL, NULL, NULL, 0};
    int64_t faces = 0, corners = 0;
    int32_t n = 0, at = 0;
    int rc = -1;
    *s = (fl_face_pairs){0};
    for (int32_t k = 0; k < m->n; k++) faces += m->block[k].nf, corners += m->block[k].first[m->block[k].nf];
    if (corners > INT32_MAX)
        return fl_fail(err, FL_SYSTEM, "%lld corners of faces are too many", (long long)corners);
    w.face = fl_alloc(faces, sizeof *w.face, err);
    w.corner = fl_alloc(corners, sizeof *w.corner, err);
    if (!w.face || !w.corner) goto done;
    for (int32_t k = 0; k < m->n; k++)
        for (int32_t f = 0; f < m->block[k].nf; f++) {
            if (m->block[k].tag[f] < 0) continue;
            w.face[n] = (flat_face){.face = f, .tag = m->block[k].tag[f]};
            flatten_face(&w, &w.face[n], k, at);
            at += w.face[n++].n;
        }
    qsort(w.face, (size_t)n, sizeof *w.face, by_plane);
    for (int32_t a = 0; a < n; a++)
        for (int32_t b = a + 1;
             b < n && w.face[b].tag / 2 == w.face[a].tag / 2 && w.face[b].lo.x <= w.face[a].hi.x; b++)
            if (compare_faces(&w, &w.face[a], &w.face[b], err)) goto done;
    qsort(s->pair, (size_t)s->n, sizeof *s->pair, by_blocks);
    rc = 0;
done:
    free(w.face), free(w.corner), free(w.scratch);
    if (rc) fl_face_pairs_free(s);
    return rc;
}

void fl_face_pairs_free(fl_face_pairs *s)
{
    free(s->pair);
    *s = (fl_face_pairs){0};
}
