/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "base/pi.h"
#include "view/rounded_mesh.h"

/* Triangles of the structure that meet below 30 degrees share a normal. */
#define SMOOTH_COSINE 0.866
enum { RING_MAX = 256, SIDES_LEAST = 24, SIDES_MOST = 512 };

static int32_t add_vertex(fl_rounded_mesh *m, fl_vec3 v, fl_vec3 n, double r, fl_err *err)
{
    if (m->nv == m->v_cap && fl_grow(&m->v, &m->v_cap, (int64_t)m->nv + 1, sizeof *m->v, err)) return -1;
    const fl_vec3 x = v3_madd(v, r, n);
    m->v[m->nv] =
        (fl_mesh_vertex){{(float)x.x, (float)x.y, (float)x.z}, {(float)n.x, (float)n.y, (float)n.z}};
    return m->nv++;
}

static int add_triangle(fl_rounded_mesh *m, int32_t a, int32_t b, int32_t c, fl_err *err)
{
    int32_t cap = m->t_cap;
    if (a < 0 || b < 0 || c < 0) return -1;
    if (3 * ((int64_t)m->nt + 1) > cap) {
        if (fl_grow(&m->t, &cap, 3 * ((int64_t)m->nt + 1), sizeof *m->t, err)) return -1;
        m->t_cap = cap;
    }
    uint32_t *t = m->t + 3 * (size_t)m->nt++;
    t[0] = (uint32_t)a;
    t[1] = (uint32_t)b;
    t[2] = (uint32_t)c;
    return 0;
}

/* On the arc from a to b, unit vectors that are not opposite. */
static fl_vec3 between(fl_vec3 a, fl_vec3 b, double s)
{
    const double c = fmax(-1.0, fmin(1.0, v3_dot(a, b))), w = acos(c), z = sin(w);
    return z < 1e-9 ? v3_unit(v3_lerp(a, b, s))
                    : v3_add(v3_scale(sin((1 - s) * w) / z, a), v3_scale(sin(s * w) / z, b));
}

/* The half-edges of a shape: half-edge e runs from loop[e] to loop[next[e]]. */
struct edges {
    const fl_vec3 *v;
    const int32_t *loop;
    int32_t n, nf, nv;
    int32_t *next, *twin, *face, *corner, *leaving, *arc;
    fl_vec3 *normal;
    double radius;
    int cuts;
};

static void free_edges(struct edges *e)
{
    free(e->next);
    free(e->normal);
}

struct side {
    int32_t a, b, e;
};

static int compare_sides(const void *p, const void *q)
{
    const struct side *a = p, *b = q;
    return a->a != b->a   ? (a->a < b->a ? -1 : 1)
           : a->b != b->b ? (a->b < b->b ? -1 : 1)
                          : (a->e > b->e) - (a->e < b->e);
}

static int pair_sides(struct edges *h, fl_err *err)
{
    struct side *s = fl_alloc(h->n, sizeof *s, err);
    if (!s) return -1;
    for (int32_t e = 0; e < h->n; e++) s[e] = (struct side){h->loop[e], h->loop[h->next[e]], e};
    qsort(s, (size_t)h->n, sizeof *s, compare_sides);
    for (int32_t e = 0; e < h->n; e++) {
        const struct side key = {h->loop[h->next[e]], h->loop[e], -1};
        int32_t lo = 0, hi = h->n;
        while (lo < hi) {
            const int32_t mid = (lo + hi) / 2;
            if (compare_sides(&s[mid], &key) < 0) lo = mid + 1;
            else hi = mid;
        }
        h->twin[e] = lo < h->n && s[lo].a == key.a && s[lo].b == key.b ? s[lo].e : -1;
    }
    free(s);
    return 0;
}

static int make_edges(struct edges *h, const fl_frame_data *d, const fl_frame_shape *s, int cuts, fl_err *err)
{
    const int32_t *first = d->face + s->f;
    h->v = d->vertex + s->v;
    h->loop = d->loop + first[0];
    h->n = first[s->nf] - first[0];
    h->nf = s->nf;
    h->nv = s->nv;
    h->radius = s->radius;
    h->cuts = cuts;
    h->next = fl_alloc((int64_t)h->n * (4 + (cuts + 1)) + s->nv, sizeof *h->next, err);
    h->normal = h->next ? fl_alloc(s->nf, sizeof *h->normal, err) : NULL;
    if (!h->normal) return -1;
    h->twin = h->next + h->n;
    h->face = h->twin + h->n;
    h->corner = h->face + h->n;
    h->arc = h->corner + h->n;
    h->leaving = h->arc + (int64_t)h->n * (cuts + 1);
    for (int32_t v = 0; v < s->nv; v++) h->leaving[v] = -1;
    for (int32_t f = 0; f < s->nf; f++) {
        const int32_t a = first[f] - first[0], b = first[f + 1] - first[0];
        fl_vec3 area = v3(0, 0, 0);
        for (int32_t e = a; e < b; e++) {
            h->next[e] = e + 1 < b ? e + 1 : a;
            h->face[e] = f;
            h->leaving[h->loop[e]] = e;
            area = v3_add(area, v3_cross(v3_sub(h->v[h->loop[e]], h->v[h->loop[a]]),
                                         v3_sub(h->v[h->loop[h->next[e]]], h->v[h->loop[a]])));
        }
        h->normal[f] = v3_unit(area);
    }
    return pair_sides(h, err);
}

static int add_faces(fl_rounded_mesh *m, struct edges *h, fl_err *err)
{
    int32_t start = 0;
    for (int32_t e = 0; e < h->n; e++) {
        if (e && h->face[e] != h->face[e - 1]) start = e;
        h->corner[e] = add_vertex(m, h->v[h->loop[e]], h->normal[h->face[e]], h->radius, err);
        if (h->corner[e] < 0 ||
            (e >= start + 2 && add_triangle(m, h->corner[start], h->corner[e - 1], h->corner[e], err)))
            return -1;
    }
    return 0;
}

/* The vertex i of `cuts` on the arc at the start of half-edge e, from the normal of its face to that of
 * its twin's, about the edge: n cos w + o sin w, o normal to the edge in the plane of the face. */
static fl_vec3 arc_normal(const struct edges *h, int32_t e, double part)
{
    const fl_vec3 a = h->normal[h->face[e]], b = h->normal[h->face[h->twin[e]]];
    const fl_vec3 o = v3_unit(v3_cross(v3_sub(h->v[h->loop[h->next[e]]], h->v[h->loop[e]]), a));
    const double w = part * atan2(fmax(0.0, v3_dot(b, o)), v3_dot(a, b));
    return v3_unit(v3_add(v3_scale(cos(w), a), v3_scale(sin(w), o)));
}

static int add_strips(fl_rounded_mesh *m, struct edges *h, fl_err *err)
{
    const int k = h->cuts;
    for (int32_t e = 0; e < h->n; e++) {
        const int32_t g = h->twin[e];
        if (g < 0) continue;
        for (int i = 0; i <= k; i++) {
            int32_t *at = &h->arc[(int64_t)e * (k + 1) + i];
            *at = i == 0   ? h->corner[e]
                  : i == k ? h->corner[h->next[g]]
                           : add_vertex(m, h->v[h->loop[e]], arc_normal(h, e, (double)i / k), h->radius, err);
            if (*at < 0) return -1;
        }
    }
    for (int32_t e = 0; e < h->n; e++) {
        const int32_t g = h->twin[e];
        if (g < e || h->twin[g] != e) continue; /* each edge once */
        const int32_t *p = h->arc + (int64_t)e * (k + 1), *q = h->arc + (int64_t)g * (k + 1);
        for (int i = 0; i < k; i++)
            if (add_triangle(m, p[i], p[i + 1], q[k - i], err) ||
                add_triangle(m, p[i + 1], q[k - i - 1], q[k - i], err))
                return -1;
    }
    return 0;
}

/* A spherical triangle of `mid` and the arc of half-edge e: rows from mid, row j with j + 1 vertices. */
static int add_wedge(fl_rounded_mesh *m, const struct edges *h, int32_t e, fl_vec3 mid, int32_t hub,
                     int32_t *low, int32_t *row, const int32_t *spoke, const int32_t *next_spoke, fl_err *err)
{
    const int k = h->cuts;
    const fl_vec3 v = h->v[h->loop[e]];
    low[0] = hub;
    for (int j = 1; j <= k; j++) {
        for (int c = 0; c <= j; c++) {
            if (c == 0) row[c] = spoke[j];
            else if (c == j) row[c] = next_spoke[j];
            else if (j == k) row[c] = h->arc[(int64_t)e * (k + 1) + c];
            else {
                const fl_vec3 rim = arc_normal(h, e, (double)c / j);
                row[c] = add_vertex(m, v, between(mid, rim, (double)j / k), h->radius, err);
            }
            if (row[c] < 0) return -1;
        }
        for (int c = 0; c < j; c++) {
            if (add_triangle(m, low[c], row[c + 1], row[c], err) ||
                (c + 1 < j && add_triangle(m, low[c], low[c + 1], row[c + 1], err)))
                return -1;
        }
        memcpy(low, row, (size_t)(j + 1) * sizeof *low);
    }
    return 0;
}

/* The patch of a vertex: the half-edges that leave it in turn, e -> next of its twin. */
static int add_patch(fl_rounded_mesh *m, struct edges *h, int32_t v, int32_t *work, fl_err *err)
{
    const int k = h->cuts;
    int32_t ring[RING_MAX], d = 0, e = h->leaving[v];
    if (e < 0) return 0;
    do {
        ring[d++] = e;
        if (h->twin[e] < 0) return 0; /* open: left as it is */
        e = h->next[h->twin[e]];
    } while (e != ring[0] && d < RING_MAX);
    if (e != ring[0]) return 0;
    if (k == 1) {
        for (int32_t i = 2; i < d; i++)
            if (add_triangle(m, h->corner[ring[0]], h->corner[ring[i]], h->corner[ring[i - 1]], err))
                return -1;
        return 0;
    }
    fl_vec3 mid = v3(0, 0, 0);
    for (int32_t i = 0; i < d; i++) mid = v3_add(mid, arc_normal(h, ring[i], 0.5));
    mid = v3_unit(mid);
    const int32_t hub = add_vertex(m, h->v[v], mid, h->radius, err);
    int32_t *spoke = work, *low = work + (RING_MAX + 1) * (k + 1), *row = low + k + 1;
    if (hub < 0) return -1;
    for (int32_t i = 0; i < d; i++)
        for (int j = 1; j <= k; j++) {
            int32_t *at = &spoke[i * (k + 1) + j];
            *at = j == k ? h->corner[ring[i]]
                         : add_vertex(m, h->v[v], between(mid, h->normal[h->face[ring[i]]], (double)j / k),
                                      h->radius, err);
            if (*at < 0) return -1;
        }
    for (int32_t i = 0; i < d; i++)
        if (add_wedge(m, h, ring[i], mid, hub, low, row, spoke + i * (k + 1), spoke + (i + 1) % d * (k + 1),
                      err))
            return -1;
    return 0;
}

static int add_polyhedron(fl_rounded_mesh *m, const fl_frame_data *d, const fl_frame_shape *s, int cuts,
                          fl_err *err)
{
    struct edges h = {0};
    int32_t *work = NULL;
    int rc = -1;
    if (s->radius == 0.0) cuts = 0;
    if (make_edges(&h, d, s, cuts, err) || add_faces(m, &h, err)) goto done;
    if (cuts) {
        work = fl_alloc((int64_t)(RING_MAX + 3) * (cuts + 1), sizeof *work, err);
        if (!work || add_strips(m, &h, err)) goto done;
        for (int32_t v = 0; v < s->nv; v++)
            if (add_patch(m, &h, v, work, err)) goto done;
    }
    rc = 0;
done:
    free(work);
    free_edges(&h);
    return rc;
}

/* A sphere, or a capsule between a and b: circles of latitude about the axis. */
static int add_round(fl_rounded_mesh *m, fl_vec3 a, fl_vec3 b, double r, int cuts, fl_err *err)
{
    const int rings = cuts < 1 ? 2 : 2 * cuts + 2, sides = 2 * rings, half = rings / 2;
    const fl_vec3 w = v3_norm(v3_sub(b, a)) > 0.0 ? v3_unit(v3_sub(b, a)) : v3(0, 0, 1);
    const fl_vec3 u = v3_normal_to(w), t = v3_cross(w, u);
    const int32_t first = m->nv;
    /* rows 0 .. half about a, half .. rings about b: the equator twice */
    for (int j = 0; j <= rings + 1; j++) {
        const int of_b = j > half;
        const double z = -0.5 * PI + PI * (of_b ? j - 1 : j) / rings;
        for (int i = 0; i < sides; i++) {
            const double p = 2.0 * PI * i / sides;
            const fl_vec3 n = v3_add(v3_scale(cos(z) * cos(p), u),
                                     v3_add(v3_scale(cos(z) * sin(p), t), v3_scale(sin(z), w)));
            if (add_vertex(m, of_b ? b : a, v3_unit(n), r, err) < 0) return -1;
        }
    }
    for (int j = 0; j <= rings; j++)
        for (int i = 0; i < sides; i++) {
            const int32_t p = first + j * sides + i, q = first + j * sides + (i + 1) % sides;
            if (j == half && v3_norm2(v3_sub(b, a)) == 0.0) continue;
            if ((j > 0 && add_triangle(m, p, q, q + sides, err)) ||
                (j < rings && add_triangle(m, p, q + sides, p + sides, err)))
                return -1;
        }
    return 0;
}

int fl_rounded_mesh_shape(fl_rounded_mesh *m, const fl_frame_data *d, const fl_frame_shape *s, int cuts,
                          fl_err *err)
{
    if (s->nf) return add_polyhedron(m, d, s, cuts, err);
    const fl_vec3 a = d->vertex[s->v];
    return add_round(m, a, s->nv > 1 ? d->vertex[s->v + 1] : a, s->radius, cuts, err);
}

/* --- structure --------------------------------------------------------------------------------- */

static int add_part_triangles(fl_rounded_mesh *m, const fl_part *p, fl_err *err)
{
    int rc = -1;
    fl_vec3 *area = fl_alloc(p->nt, sizeof *area, err);
    int32_t *head = fl_alloc(p->nv, sizeof *head, err),
            *next = fl_alloc(3 * (int64_t)p->nt, sizeof *next, err);
    if (!area || !head || !next) goto done;
    for (int32_t v = 0; v < p->nv; v++) head[v] = -1;
    for (int32_t t = 0; t < p->nt; t++) {
        const int32_t *v = p->t[t].v;
        area[t] = v3_cross(v3_sub(p->v[v[1]], p->v[v[0]]), v3_sub(p->v[v[2]], p->v[v[0]]));
        for (int k = 0; k < 3; k++) {
            next[3 * t + k] = head[v[k]];
            head[v[k]] = 3 * t + k;
        }
    }
    for (int32_t t = 0; t < p->nt; t++) {
        int32_t at[3];
        for (int k = 0; k < 3; k++) {
            fl_vec3 n = v3(0, 0, 0);
            for (int32_t c = head[p->t[t].v[k]]; c >= 0; c = next[c])
                if (v3_dot(area[c / 3], area[t]) > SMOOTH_COSINE * v3_norm(area[c / 3]) * v3_norm(area[t]))
                    n = v3_add(n, area[c / 3]);
            at[k] = add_vertex(m, p->v[p->t[t].v[k]], v3_unit(n), 0.0, err);
        }
        if (add_triangle(m, at[0], at[1], at[2], err)) goto done;
    }
    rc = 0;
done:
    free(area);
    free(head);
    free(next);
    return rc;
}

static int add_disc(fl_rounded_mesh *m, fl_vec3 x, fl_vec3 n, fl_vec3 u, double r, int sides, fl_err *err)
{
    const fl_vec3 t = v3_cross(n, u);
    const int32_t first = m->nv;
    for (int i = 0; i < sides; i++) {
        const double p = 2.0 * PI * i / sides;
        const fl_vec3 at = v3_add(x, v3_scale(r, v3_add(v3_scale(cos(p), u), v3_scale(sin(p), t))));
        if (add_vertex(m, at, n, 0.0, err) < 0 ||
            (i > 1 && add_triangle(m, first, first + i - 1, first + i, err)))
            return -1;
    }
    return 0;
}

static int add_cone(fl_rounded_mesh *m, const fl_cone *c, double chord, fl_err *err)
{
    const double big = fmax(c->r0, c->r1), wanted = chord < big ? 2.0 * PI / acos(1.0 - chord / big) : 0.0;
    const int sides = wanted > SIDES_MOST ? SIDES_MOST : wanted < SIDES_LEAST ? SIDES_LEAST : (int)wanted;
    const fl_vec3 along = v3_sub(c->p1, c->p0), w = v3_unit(along), u = v3_normal_to(w), t = v3_cross(w, u);
    const double slope = (c->r0 - c->r1) / v3_norm(along);
    const int32_t first = m->nv;
    for (int i = 0; i < sides; i++) {
        const double p = 2.0 * PI * i / sides;
        const fl_vec3 o = v3_add(v3_scale(cos(p), u), v3_scale(sin(p), t)), n = v3_unit(v3_madd(o, slope, w));
        if (add_vertex(m, v3_madd(c->p0, c->r0, o), n, 0.0, err) < 0 ||
            add_vertex(m, v3_madd(c->p1, c->r1, o), n, 0.0, err) < 0)
            return -1;
    }
    for (int i = 0; i < sides; i++) {
        const int32_t a = first + 2 * i, b = first + 2 * ((i + 1) % sides);
        if ((c->r0 > 0.0 && add_triangle(m, a, b, b + 1, err)) ||
            (c->r1 > 0.0 && add_triangle(m, a, b + 1, a + 1, err)))
            return -1;
    }
    return (c->r0 > 0.0 && add_disc(m, c->p0, v3_neg(w), u, c->r0, sides, err)) ||
                   (c->r1 > 0.0 && add_disc(m, c->p1, w, u, c->r1, sides, err))
               ? -1
               : 0;
}

int fl_rounded_mesh_part(fl_rounded_mesh *m, const fl_part *p, double chord, fl_err *err)
{
    if (p->nt && add_part_triangles(m, p, err)) return -1;
    for (int32_t k = 0; k < p->nc; k++)
        if (add_cone(m, &p->cone[k], chord, err)) return -1;
    return 0;
}

double fl_rounded_mesh_volume(const fl_rounded_mesh *m)
{
    double six = 0.0;
    for (int32_t t = 0; t < m->nt; t++) {
        fl_vec3 p[3];
        for (int k = 0; k < 3; k++) {
            const float *x = m->v[m->t[3 * (size_t)t + (size_t)k]].x;
            p[k] = v3(x[0], x[1], x[2]);
        }
        six += v3_dot(p[0], v3_cross(p[1], p[2]));
    }
    return six / 6.0;
}

void fl_rounded_mesh_free(fl_rounded_mesh *m)
{
    free(m->v);
    free(m->t);
    *m = (fl_rounded_mesh){0};
}
