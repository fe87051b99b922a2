/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "failure/strip_wall.h"
#include <math.h>
#include <stdlib.h>
#include "base/array.h"
#include "base/pi.h"

/* Sine of the steepest slope of a wall against the vertical, and cosine of the bend at which sectors end. */
#define SLOPE 0.25881904510252074
#define BEND 0.93969262078590843

/* A straight piece of the outline, of one face. */
typedef struct {
    fl_vec3 a, b; /* ends; the wall's normal is to the right of the way from a to b, seen from above */
    fl_vec3 n;
    int32_t face, next, previous; /* -1: none */
    int first;                    /* 1: a run begins here */
} outline_side;

typedef struct {
    int32_t n, cap;
    outline_side *side;
    fl_vec3 up, x;
    double size;
} outline;

static int add_side(outline *o, const outline_side *s, fl_err *err)
{
    if (fl_grow(&o->side, &o->cap, (int64_t)o->n + 1, sizeof *o->side, err)) return -1;
    o->side[o->n++] = *s;
    return 0;
}

/* Where the edge from p to q meets the height of the ice: 1 and the point, or 0. */
static int cut_edge(const outline *o, fl_vec3 p, fl_vec3 q, fl_vec3 *at)
{
    const double hp = v3_dot(o->up, v3_sub(p, o->x)), hq = v3_dot(o->up, v3_sub(q, o->x));
    if ((hp < 0.0) == (hq < 0.0)) return 0;
    *at = v3_madd(p, hp / (hp - hq), v3_sub(q, p));
    return 1;
}

/* Adds the line in which face f meets the height of the ice, if it is steep. */
static int add_face(outline *o, const fl_poly *p, int32_t f, fl_err *err)
{
    fl_vec3 end[2];
    int ends = 0;
    if (fabs(v3_dot(p->n[f], o->up)) > SLOPE) return 0;
    for (int32_t k = p->first[f]; k < p->first[f + 1] && ends < 2; k++) {
        const int32_t next = k + 1 < p->first[f + 1] ? k + 1 : p->first[f];
        ends += cut_edge(o, p->v[p->loop[k]], p->v[p->loop[next]], &end[ends]);
    }
    if (ends < 2) return 0;
    const fl_vec3 way = v3_cross(o->up, p->n[f]);
    const int forward = v3_dot(way, v3_sub(end[1], end[0])) > 0.0;
    const outline_side s = {forward ? end[0] : end[1], forward ? end[1] : end[0], p->n[f], f, -1, -1, 0};
    return v3_norm(v3_sub(s.b, s.a)) > 1e-9 * o->size ? add_side(o, &s, err) : 0;
}

static void link_sides(outline *o)
{
    for (int32_t i = 0; i < o->n; i++)
        for (int32_t j = 0; j < o->n; j++)
            if (i != j && v3_norm(v3_sub(o->side[i].b, o->side[j].a)) <= 1e-6 * o->size &&
                o->side[i].next < 0 && o->side[j].previous < 0)
                o->side[i].next = j, o->side[j].previous = i;
    for (int32_t j = 0; j < o->n; j++) {
        const int32_t i = o->side[j].previous;
        o->side[j].first = i < 0 || v3_dot(o->side[i].n, o->side[j].n) < BEND;
    }
}

/* The part of the line x + s up that face f reaches. */
static void face_reach(const fl_poly *p, int32_t f, fl_vec3 x, fl_vec3 up, double *from, double *to)
{
    *from = -INFINITY, *to = INFINITY;
    for (int32_t k = p->first[f]; k < p->first[f + 1]; k++) {
        const fl_vec3 a = p->v[p->loop[k]], b = p->v[p->loop[k + 1 < p->first[f + 1] ? k + 1 : p->first[f]]],
                      out = v3_cross(v3_sub(b, a), p->n[f]);
        const double rise = v3_dot(out, up), room = v3_dot(out, v3_sub(a, x));
        if (rise > 0.0) *to = fmin(*to, room / rise);
        else if (rise < 0.0) *from = fmax(*from, room / rise);
    }
}

/* Number of sectors on a length. */
static int32_t count_of(double length, double width)
{
    return length > width ? (int32_t)ceil(length / width * (1.0 - 1e-12)) : 1;
}

/* The sector over the lengths from s0 to s1 of the run that begins with side i. */
static fl_wall_sector sector_of(const outline *o, const fl_poly *p, int32_t i, double s0, double s1)
{
    fl_wall_sector q = {.left = -1, .right = -1};
    fl_vec3 sum = v3(0, 0, 0);
    const double middle = 0.5 * (s0 + s1);
    double at = 0.0;
    int32_t face = -1;
    for (int32_t k = i; k >= 0; k = o->side[k].next) {
        const outline_side *s = &o->side[k];
        const double length = v3_norm(v3_sub(s->b, s->a)), lo = fmax(s0, at), hi = fmin(s1, at + length);
        if (k != i && s->first) break;
        if (hi > lo) sum = v3_madd(sum, hi - lo, s->n);
        if (middle >= at && (middle <= at + length || face < 0)) {
            face = s->face;
            q.x = v3_madd(s->a, fmin(1.0, (middle - at) / length), v3_sub(s->b, s->a));
        }
        at += length;
        if (at >= s1) break;
    }
    q.n = v3_unit(sum);
    q.width = v3_norm(sum);
    q.along = v3_unit(v3_cross(o->up, q.n));
    q.up = v3_cross(q.n, q.along);
    face_reach(p, face, q.x, q.up, &q.from, &q.to);
    return q;
}

static double run_length(const outline *o, int32_t i)
{
    double length = 0.0;
    for (int32_t k = i; k >= 0 && (k == i || !o->side[k].first); k = o->side[k].next) {
        length += v3_norm(v3_sub(o->side[k].b, o->side[k].a));
        if (o->side[k].next == i) break;
    }
    return length;
}

static int32_t last_side(const outline *o, int32_t i)
{
    int32_t k = i;
    while (o->side[k].next >= 0 && o->side[k].next != i && !o->side[o->side[k].next].first)
        k = o->side[k].next;
    return k;
}

/* Sectors of all runs, and their neighbours across sharp bends. */
static int add_runs(fl_wall *out, const outline *o, const fl_poly *p, double width, fl_err *err)
{
    int32_t cap = 0, *start = fl_alloc(o->n, sizeof *start, err), *end = fl_alloc(o->n, sizeof *end, err);
    int rc = start && end ? 0 : -1;
    for (int32_t i = 0; i < o->n && rc == 0; i++) {
        if (!o->side[i].first) continue;
        const double length = run_length(o, i);
        const int32_t n = count_of(length, width);
        start[i] = out->n;
        rc = fl_grow(&out->sector, &cap, (int64_t)out->n + n, sizeof *out->sector, err);
        for (int32_t k = 0; k < n && rc == 0; k++) {
            fl_wall_sector q = sector_of(o, p, i, length * k / n, length * (k + 1) / n);
            q.left = k > 0 ? out->n - 1 : -1;
            q.right = k + 1 < n ? out->n + 1 : -1;
            out->sector[out->n++] = q;
        }
        end[last_side(o, i)] = out->n - 1;
    }
    for (int32_t i = 0; i < o->n && rc == 0; i++) {
        const int32_t before = o->side[i].previous;
        if (!o->side[i].first || before < 0) continue;
        out->sector[start[i]].left = end[before];
        out->sector[end[before]].right = start[i];
    }
    free(start), free(end);
    return rc;
}

static int wall_of_faces(fl_wall *out, const fl_piece *piece, fl_vec3 up, fl_vec3 x, double width,
                         int32_t ring, fl_err *err)
{
    outline o = {.up = up, .x = x, .size = piece->core.size};
    double around = 0.0;
    int rc = 0, bends = 0;
    for (int32_t f = 0; f < piece->core.nf && rc == 0; f++) rc = add_face(&o, &piece->core, f, err);
    if (rc == 0 && o.n) {
        link_sides(&o);
        for (int32_t k = 0; k < o.n; k++) {
            around += v3_norm(v3_sub(o.side[k].b, o.side[k].a));
            bends += o.side[k].first;
        }
        out->is_round = bends == 0;
        if (bends == 0) o.side[0].first = 1;
        if (ring > 0) width = fmin(width, around / ring);
        rc = add_runs(out, &o, &piece->core, width, err);
    }
    free(o.side);
    return rc;
}

static int wall_of_cone(fl_wall *out, const fl_piece *piece, fl_vec3 up, fl_vec3 x, double width,
                        int32_t ring, fl_err *err)
{
    const double rise = (piece->r1 - piece->r0) / piece->h, slant = sqrt(1.0 + rise * rise);
    if (!(fabs(up.z) > 0.5)) return 0;
    const double z = v3_dot(up, x) / up.z, r = piece->r0 + rise * z, turn = up.z > 0.0 ? 1.0 : -1.0;
    if (!(z > 0.0 && z < piece->h && r > 0.0)) return 0;
    int32_t n = count_of(2.0 * PI * r, width);
    if (n < ring) n = ring;
    out->sector = fl_alloc(n, sizeof *out->sector, err);
    if (!out->sector) return -1;
    for (int32_t k = 0; k < n; k++) {
        const double angle = turn * 2.0 * PI * (k + 0.5) / n, c = cos(angle), s = sin(angle);
        fl_wall_sector q = {.x = v3(r * c, r * s, z),
                            .n = v3(c / slant, s / slant, -rise / slant),
                            .along = v3(-turn * s, turn * c, 0.0),
                            .left = (k + n - 1) % n,
                            .right = (k + 1) % n};
        if (fabs(v3_dot(q.n, up)) > SLOPE) {
            out->n = 0;
            return 0; /* the whole ring, or nothing */
        }
        q.up = v3_cross(q.n, q.along);
        q.width = 2.0 * r * sin(PI / n);
        q.taper = 2.0 * rise / slant * turn * sin(PI / n);
        q.from = (turn > 0.0 ? -z : z - piece->h) * slant;
        q.to = (turn > 0.0 ? piece->h - z : z) * slant;
        out->sector[out->n++] = q;
    }
    out->is_round = 1;
    return 0;
}

int fl_wall_make(fl_wall *out, const fl_piece *piece, fl_vec3 up, fl_vec3 x, double width, int32_t ring,
                 fl_err *err)
{
    *out = (fl_wall){0};
    if (piece->kind == FL_PIECE_PLANE) return 0;
    return piece->kind == FL_PIECE_CONE ? wall_of_cone(out, piece, up, x, width, ring, err)
                                        : wall_of_faces(out, piece, up, x, width, ring, err);
}

void fl_wall_free(fl_wall *w)
{
    free(w->sector);
    *w = (fl_wall){0};
}
