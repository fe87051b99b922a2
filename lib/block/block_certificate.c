/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "block/block_certificate.h"
#include <stdlib.h>
#include "base/array.h"
#include "base/parallel.h"
#include "geom/polygon_clip.h"

/* Half-spaces of a convex piece. */
typedef struct {
    int32_t n;
    fl_vec3 *normal;
    double *c;
} half_spaces;

static int make_half_spaces(half_spaces *h, const fl_block_shape *s, fl_err *err)
{
    h->n = s->nf;
    h->normal = fl_alloc(s->nf, sizeof *h->normal, err);
    h->c = fl_alloc(s->nf, sizeof *h->c, err);
    if (!h->normal || !h->c) return -1;
    for (int32_t f = 0; f < s->nf; f++) h->normal[f] = fl_block_face_normal(s, f, &h->c[f]);
    return 0;
}

/* True if the plane has corners of the piece on both sides. */
static int plane_crosses(const fl_block_shape *s, const fl_joint_plane *p, double tol)
{
    int below = 0, above = 0;
    for (int32_t k = 0; k < s->nv; k++) {
        const double d = v3_dot(p->n, s->v[k]) - p->c;
        below |= d<-tol, above |= d> tol;
    }
    return below && above;
}

/* The part lo .. hi of the line x + t d inside; 0 if none. */
static int clip_line(const half_spaces *h, fl_vec3 x, fl_vec3 d, double tol, double *lo, double *hi)
{
    *lo = -INFINITY, *hi = INFINITY;
    for (int32_t f = 0; f < h->n; f++) {
        const double to = v3_dot(h->normal[f], d), room = h->c[f] - v3_dot(h->normal[f], x);
        if (fabs(to) < 1e-13) {
            if (room <= tol) return 0;
        } else if (to > 0.0) *hi = fmin(*hi, room / to);
        else *lo = fmax(*lo, room / to);
    }
    return *hi - *lo > tol;
}

/* Area of the section of a piece by a plane: a large square is cut by all half-spaces. */
static double section_area(const half_spaces *h, const fl_block_shape *s, const fl_joint_plane *p, fl_vec2 *v)
{
    const fl_vec3 a = v3_normal_to(p->n), b = v3_cross(p->n, a),
                  mid = v3_scale(0.5, v3_add(s->box.lo, s->box.hi)),
                  o = v3_madd(mid, p->c - v3_dot(p->n, mid), p->n);
    const double R = v3_norm(v3_sub(s->box.hi, s->box.lo));
    int32_t n = 4;
    v[0] = (fl_vec2){-R, -R}, v[1] = (fl_vec2){R, -R}, v[2] = (fl_vec2){R, R}, v[3] = (fl_vec2){-R, R};
    for (int32_t f = 0; f < h->n && n; f++) {
        const double x = v3_dot(h->normal[f], a), y = v3_dot(h->normal[f], b), r2 = x * x + y * y,
                     c = h->c[f] - v3_dot(h->normal[f], o);
        if (r2 < 1e-26) continue;
        n = fl_polygon_keep_left(n, v, (fl_vec2){c * x / r2, c * y / r2}, (fl_vec2){-y, x});
    }
    return n >= 3 ? fl_polygon_area(n, v) : 0.0;
}

/* Lines through the piece of plane a with later planes, and points on them, each point counted thrice. */
static void count_lines(fl_block_certificate *c, const fl_block_model *m, const half_spaces *h,
                        const int32_t *cross, int32_t n, int32_t a, int64_t *points)
{
    const double tol = m->tol;
    for (int32_t b = a + 1; b < n; b++) {
        const fl_joint_plane *p = &m->plane[cross[a]], *q = &m->plane[cross[b]];
        const fl_vec3 d = v3_cross(p->n, q->n);
        const double d2 = v3_norm2(d);
        double lo, hi;
        if (d2 < 1e-24) continue;
        const fl_vec3 x = v3_scale(1.0 / d2, v3_cross(v3_sub(v3_scale(p->c, q->n), v3_scale(q->c, p->n)), d)),
                      u = v3_scale(1.0 / sqrt(d2), d);
        if (!clip_line(h, x, u, tol, &lo, &hi)) continue;
        c->lines++;
        for (int32_t k = 0; k < n; k++) {
            if (k == a || k == b) continue;
            const fl_joint_plane *r = &m->plane[cross[k]];
            const double to = v3_dot(r->n, u), room = r->c - v3_dot(r->n, x);
            if (fabs(to) < 1e-13) {
                if (fabs(room) <= tol) c->special = 1; /* three planes through one line */
                continue;
            }
            const double t = room / to;
            if (t > lo + tol && t < hi - tol) ++*points;
            else if (fabs(t - lo) <= tol || fabs(t - hi) <= tol) c->special = 1;
        }
    }
}

static int count_piece(fl_block_certificate *c, const fl_block_model *m, const fl_block_shape *s, fl_err *err)
{
    half_spaces h = {0};
    int32_t *cross = fl_alloc(m->planes, sizeof *cross, err), n = 0;
    fl_vec2 *v = fl_alloc((int64_t)s->nf + 8, sizeof *v, err);
    int64_t points = 0;
    int rc = !cross || !v || make_half_spaces(&h, s, err) ? -1 : 0;
    for (int32_t p = m->first_joint; p < m->planes && rc == 0; p++) {
        if (!plane_crosses(s, &m->plane[p], m->tol)) continue;
        cross[n++] = p;
        c->section[m->plane[p].set] += section_area(&h, s, &m->plane[p], v);
    }
    for (int32_t a = 0; a < n && rc == 0; a++) count_lines(c, m, &h, cross, n, a, &points);
    c->pieces++;
    c->planes += n;
    c->points += points / 3;
    if (points % 3) c->special = 1;
    free(h.normal), free(h.c), free(cross), free(v);
    return rc;
}

static int measure_blocks(fl_block_certificate *c, const fl_block_model *m, fl_err *err)
{
    double *volume = fl_alloc(m->n, sizeof *volume, err), *square = fl_alloc(m->n, sizeof *square, err);
    if (!volume || !square) {
        free(volume), free(square);
        return -1;
    }
    c->blocks = m->n;
    c->least = INFINITY, c->least_faces = INT32_MAX;
    for (int32_t k = 0; k < m->n; k++) {
        volume[k] = fl_block_shape_volume(&m->block[k], NULL);
        square[k] = volume[k] * volume[k];
        c->least = fmin(c->least, volume[k]), c->most = fmax(c->most, volume[k]);
        if (m->block[k].nf < c->least_faces) c->least_faces = m->block[k].nf;
        if (m->block[k].nf > c->most_faces) c->most_faces = m->block[k].nf;
    }
    c->volume = fl_parallel_sum(volume, m->n);
    c->square_sum = fl_parallel_sum(square, m->n);
    free(volume), free(square);
    return 0;
}

int fl_block_certify(fl_block_certificate *c, const fl_block_model *m, const fl_face_pairs *pairs,
                     const fl_joint_sets *sets, fl_err *err)
{
    *c = (fl_block_certificate){.full = 1};
    c->section = fl_alloc(sets->n, sizeof *c->section, err);
    c->area = fl_alloc(sets->n, sizeof *c->area, err);
    c->intact = fl_alloc(sets->n, sizeof *c->intact, err);
    if (!c->section || !c->area || !c->intact || measure_blocks(c, m, err)) goto failed;
    for (int32_t k = 0; k < sets->n; k++)
        if (sets->set[k].persistence < 1.0 && sets->set[k].meaning == FL_PERSISTENCE_SKIP) c->full = 0;
    for (int32_t k = 0; k < m->pieces; k++)
        if (count_piece(c, m, &m->piece[k], err)) goto failed;
    for (int32_t k = 0; k < pairs->n; k++) {
        const fl_face_pair *p = &pairs->pair[k];
        const int32_t set = m->plane[p->plane].set;
        if (set < 0) {
            c->surfaces += p->area;
            continue;
        }
        c->area[set] += p->area;
        if (p->intact) c->intact[set] += p->area;
    }
    return 0;
failed:
    fl_block_certificate_free(c);
    return -1;
}

void fl_block_certificate_free(fl_block_certificate *c)
{
    free(c->section), free(c->area), free(c->intact);
    *c = (fl_block_certificate){0};
}
