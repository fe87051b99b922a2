/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "block/sliver.h"
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "geom/clip.h"

/* Faces cover each other if their areas differ by less than this, relative to the smaller. */
static const double COVER_TOL = 1e-6;

/* A body of width w holds a ball of radius w/(2 sqrt 3) (Steinhagen 1921); twice that room is left for widths
 * between two edges, which fl_block_shape_width() overestimates. */
static const double SURE_WIDTH = 8.0;

static int has_core(const fl_block_shape *s, double radius)
{
    fl_poly sharp = {0}, core = {0};
    fl_err why = {0};
    int some = fl_block_shape_poly(s, &sharp, NULL, &why) == 1;
    if (some) some = fl_poly_offset(&core, &sharp, -radius, &why) == 0;
    fl_poly_free(&sharp), fl_poly_free(&core);
    return some;
}

static int is_sliver(const fl_block_shape *s, const fl_sliver_rule *rule)
{
    const double width = fl_block_shape_width(s);
    if (width < rule->min_width || fl_block_shape_volume(s, NULL) < rule->min_volume) return 1;
    return rule->radius > 0.0 && width < SURE_WIDTH * rule->radius && !has_core(s, rule->radius);
}

/* True if all corners of b lie behind all faces of a but face fa. */
static int is_behind(const fl_block_shape *a, int32_t fa, const fl_block_shape *b, double tol)
{
    for (int32_t f = 0; f < a->nf; f++) {
        double c;
        if (f == fa) continue;
        const fl_vec3 n = fl_block_face_normal(a, f, &c);
        for (int32_t k = 0; k < b->nv; k++)
            if (v3_dot(n, b->v[k]) > c + tol) return 0;
    }
    return 1;
}

/* The corner of a that is x, or -1. */
static int32_t corner_at(const fl_block_shape *a, fl_vec3 x, double tol)
{
    int32_t best = -1;
    double least = tol;
    for (int32_t k = 0; k < a->nv; k++) {
        const double d = v3_norm(v3_sub(a->v[k], x));
        if (d <= least) least = d, best = k;
    }
    return best;
}

/* Position in face f of the side from corner u to corner v, or -1. */
static int32_t side_in(const fl_block_shape *s, int32_t f, int32_t u, int32_t v)
{
    for (int32_t k = s->first[f]; k < s->first[f + 1]; k++)
        if (s->loop[k] == u && s->loop[k + 1 < s->first[f + 1] ? k + 1 : s->first[f]] == v) return k;
    return -1;
}

/* The face with the side u v, other than `but`. */
static int32_t face_with(const fl_block_shape *s, int32_t but, int32_t u, int32_t v)
{
    for (int32_t f = 0; f < s->nf; f++)
        if (f != but && side_in(s, f, u, v) >= 0) return f;
    return -1;
}

static int is_one_plane(const fl_block_shape *a, int32_t f, const fl_block_shape *b, int32_t g, double tol)
{
    double c, d;
    const fl_vec3 n = fl_block_face_normal(a, f, &c), m = fl_block_face_normal(b, g, &d);
    return v3_dot(n, m) > 0.5 && v3_norm(v3_cross(n, m)) < 1e-7 && fabs(c - d) <= 1e3 * tol &&
           (a->tag[f] == b->tag[g]);
}

/* Appends the corners of face f of s from position k + 1 round to k, so all of them, starting behind the side
 * at k. */
static int32_t append_from(const fl_block_shape *s, int32_t f, int32_t k, const int32_t *place, int32_t *loop,
                           int32_t at)
{
    const int32_t n = s->first[f + 1] - s->first[f];
    for (int32_t e = 0; e < n; e++) {
        const int32_t c = s->loop[s->first[f] + (k - s->first[f] + 1 + e) % n];
        loop[at++] = place ? place[c] : c;
    }
    return at;
}

/* The union of a and b, whose faces fa and fb are equal.  1, 0 if their corners do not match, -1. */
static int join_blocks(const fl_block_shape *a, int32_t fa, const fl_block_shape *b, int32_t fb, double tol,
                       fl_block_shape *out, fl_err *err)
{
    const int32_t n = a->first[fa + 1] - a->first[fa];
    int32_t *place = fl_alloc((int64_t)b->nv + b->nf, sizeof *place, err), at = 0, shared = 0;
    if (!place) return -1;
    int32_t *joined = place + b->nv; /* [b->nf] 1: the face went into one of a */
    int rc = 0;
    if (fl_block_shape_alloc(out, (int64_t)a->nv + b->nv, (int64_t)a->nf + b->nf,
                             (int64_t)a->first[a->nf] + b->first[b->nf], err)) {
        free(place);
        return -1;
    }
    memcpy(out->v, a->v, (size_t)a->nv * sizeof *out->v);
    out->nv = a->nv;
    for (int32_t k = 0; k < b->nv; k++) {
        place[k] = corner_at(a, b->v[k], 10.0 * tol);
        if (place[k] >= 0) shared++;
        else out->v[out->nv] = b->v[k], place[k] = out->nv++;
    }
    if (shared != n || b->first[fb + 1] - b->first[fb] != n) goto done;
    for (int32_t f = 0; f < a->nf; f++) {
        if (f == fa) continue;
        int done = 0;
        for (int32_t k = b->first[fb]; k < b->first[fb + 1] && !done; k++) {
            const int32_t p = b->loop[k], q = b->loop[k + 1 < b->first[fb + 1] ? k + 1 : b->first[fb]];
            /* the shared face of b runs p q, its neighbour q p; the neighbour in a runs p q */
            const int32_t g = face_with(b, fb, q, p), in_a = side_in(a, f, place[p], place[q]);
            if (g < 0 || in_a < 0 || joined[g] || !is_one_plane(a, f, b, g, tol)) continue;
            const int32_t begin = at;
            at = append_from(a, f, in_a, NULL, out->loop, at); /* q ... p */
            const int32_t in_b = side_in(b, g, q, p);
            at = append_from(b, g, in_b, place, out->loop, at) - 1; /* p ... q: both ends are there already */
            memmove(out->loop + begin + (a->first[f + 1] - a->first[f]),
                    out->loop + begin + (a->first[f + 1] - a->first[f]) + 1,
                    (size_t)(at - begin - (a->first[f + 1] - a->first[f])) * sizeof *out->loop);
            at--;
            joined[g] = 1, done = 1;
        }
        if (!done) at = append_from(a, f, a->first[f + 1] - 1, NULL, out->loop, at);
        out->tag[out->nf++] = a->tag[f];
        out->first[out->nf] = at;
    }
    for (int32_t g = 0; g < b->nf; g++) {
        if (g == fb || joined[g]) continue;
        at = append_from(b, g, b->first[g + 1] - 1, place, out->loop, at);
        out->tag[out->nf++] = b->tag[g];
        out->first[out->nf] = at;
    }
    out->group = b->group;
    out->key = b->key;
    fl_block_shape_bound(out);
    rc = 1;
done:
    free(place);
    if (rc != 1) fl_block_shape_free(out);
    return rc;
}

/* Joins the sliver k to a neighbour; 1 if done. */
static int join_sliver(fl_block_model *m, const fl_face_pairs *pairs, const fl_sliver_rule *rule, int32_t k,
                       uint8_t *busy, fl_err *err)
{
    double below = INFINITY;
    for (;;) {
        const fl_face_pair *best = NULL;
        for (int32_t p = 0; p < pairs->n; p++) {
            const fl_face_pair *q = &pairs->pair[p];
            if ((q->i == k || q->j == k) && q->area < below && (!best || q->area > best->area)) best = q;
        }
        if (!best) return 0;
        below = best->area;
        const int32_t other = best->i == k ? best->j : best->i, fk = best->i == k ? best->fi : best->fj,
                      fo = best->i == k ? best->fj : best->fi;
        const fl_block_shape *a = &m->block[k], *b = &m->block[other];
        fl_block_shape joined;
        if (busy[other] || a->group != b->group) continue;
        if (fl_block_face_area(b, fo) > (1.0 + COVER_TOL) * best->area ||
            fl_block_face_area(a, fk) > (1.0 + COVER_TOL) * best->area)
            continue;
        if (!is_behind(a, fk, b, 10.0 * m->tol) || !is_behind(b, fo, a, 10.0 * m->tol)) continue;
        const int rc = join_blocks(a, fk, b, fo, m->tol, &joined, err);
        if (rc < 0) return -1;
        if (rc == 0) continue;
        if (rule->radius > 0.0 && !has_core(&joined, rule->radius)) { /* corners too flat for it */
            fl_block_shape_free(&joined);
            continue;
        }
        fl_block_shape_free(&m->block[other]);
        m->block[other] = joined;
        busy[other] = 1;
        return 1;
    }
}

static int note_sliver(fl_slivers *s, const fl_block_shape *b, int merged, fl_err *err)
{
    fl_sliver one = {.merged = merged, .width = fl_block_shape_width(b)};
    one.volume = fl_block_shape_volume(b, &one.x);
    if (fl_grow(&s->sliver, &s->cap, (int64_t)s->n + 1, sizeof *s->sliver, err)) return -1;
    s->sliver[s->n++] = one;
    s->merged += merged;
    if (!merged) s->lost += one.volume;
    return 0;
}

/* One round: each block takes part in one union at most.  last: what cannot be merged is left out.  Returns
 * the number of slivers taken out, or -1. */
static int32_t remove_round(fl_slivers *s, fl_block_model *m, const fl_face_pairs *pairs,
                            const fl_sliver_rule *rule, int last, fl_err *err)
{
    uint8_t *busy = fl_alloc(m->n, 1, err), *gone = fl_alloc(m->n, 1, err);
    int32_t taken = 0, n = 0;
    if (!busy || !gone) taken = -1;
    for (int32_t k = 0; k < m->n && taken >= 0; k++) {
        if (busy[k] || !is_sliver(&m->block[k], rule)) continue;
        const int joined = last ? 0 : join_sliver(m, pairs, rule, k, busy, err);
        if (joined < 0 || ((joined || last) && note_sliver(s, &m->block[k], joined, err))) taken = -1;
        else if (joined || last) gone[k] = busy[k] = 1, taken++;
    }
    for (int32_t k = 0; k < m->n && taken > 0; k++) {
        if (gone[k]) fl_block_shape_free(&m->block[k]);
        else m->block[n++] = m->block[k];
    }
    if (taken > 0) m->n = n;
    free(busy), free(gone);
    return taken;
}

int fl_slivers_remove(fl_slivers *s, fl_block_model *m, fl_face_pairs *pairs, const fl_joint_sets *sets,
                      uint64_t seed, const fl_sliver_rule *rule, fl_err *err)
{
    *s = (fl_slivers){0};
    if (rule->keep) {
        for (int32_t k = 0; k < m->n; k++)
            if (is_sliver(&m->block[k], rule) && note_sliver(s, &m->block[k], 0, err)) return -1;
        s->lost = 0.0;
        return 0;
    }
    for (int last = 0; last < 2;) {
        const int32_t taken = remove_round(s, m, pairs, rule, last, err);
        if (taken < 0) return -1;
        if (taken > 0) {
            fl_face_pairs_free(pairs);
            if (fl_face_pairs_find(pairs, m, sets, seed, err)) return -1;
        }
        if (taken == 0 || last) last++;
    }
    return 0;
}

void fl_slivers_free(fl_slivers *s)
{
    free(s->sliver);
    *s = (fl_slivers){0};
}
