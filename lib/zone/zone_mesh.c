/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "zone/zone_mesh.h"
#include <string.h>
#include "base/array.h"

/* A zone with less than this share of the cube of its longest edge is none. */
static const double LEAST_VOLUME = 1e-9;

static double six_volumes(const fl_vec3 *x, const int32_t t[4])
{
    const fl_vec3 a = v3_sub(x[t[1]], x[t[0]]), b = v3_sub(x[t[2]], x[t[0]]), c = v3_sub(x[t[3]], x[t[0]]);
    return v3_dot(a, v3_cross(b, c));
}

static double longest_edge2(const fl_vec3 *x, const int32_t t[4])
{
    double most = 0.0;
    for (int a = 0; a < 4; a++)
        for (int b = a + 1; b < 4; b++) most = fmax(most, v3_norm2(v3_sub(x[t[a]], x[t[b]])));
    return most;
}

static int check_zones(const fl_zone_mesh *m, fl_err *err)
{
    for (int32_t k = 0; k < m->zones; k++) {
        const double d2 = longest_edge2(m->x, m->zone[k]);
        if (!(six_volumes(m->x, m->zone[k]) > LEAST_VOLUME * d2 * sqrt(d2)))
            return fl_fail(err, FL_INPUT, "a zone of the block has no volume");
    }
    return 0;
}

void fl_zone_mesh_free(fl_zone_mesh *m)
{
    free(m->x), free(m->zone), free(m->triangle), free(m->face);
    *m = (fl_zone_mesh){0};
}

/* --- boundary ----------------------------------------------------------------------------------- */

/* A side of a zone: its nodes ascending, then as they turn. */
typedef struct {
    int32_t key[3], node[3];
} zone_side;

static int by_key(const void *x, const void *y)
{
    const zone_side *a = x, *b = y;
    for (int k = 0; k < 3; k++)
        if (a->key[k] != b->key[k]) return (a->key[k] > b->key[k]) - (a->key[k] < b->key[k]);
    return 0;
}

static void swap_nodes(int32_t *a, int32_t *b)
{
    const int32_t t = *a;
    *a = *b, *b = t;
}

/* The sides that one zone alone has. */
static int find_boundary(fl_zone_mesh *m, fl_err *err)
{
    static const int SIDE[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
    const int64_t n = 4 * (int64_t)m->zones;
    zone_side *s = fl_alloc(n, sizeof *s, err);
    int32_t cap = 0;
    if (!s) return -1;
    for (int64_t k = 0; k < n; k++) {
        for (int e = 0; e < 3; e++) s[k].node[e] = s[k].key[e] = m->zone[k / 4][SIDE[k % 4][e]];
        int32_t *q = s[k].key;
        if (q[0] > q[1]) swap_nodes(&q[0], &q[1]);
        if (q[1] > q[2]) swap_nodes(&q[1], &q[2]);
        if (q[0] > q[1]) swap_nodes(&q[0], &q[1]);
    }
    qsort(s, (size_t)n, sizeof *s, by_key);
    int rc = 0;
    for (int64_t k = 0; k < n && rc == 0; k++) {
        const int twin =
            (k > 0 && by_key(&s[k - 1], &s[k]) == 0) || (k + 1 < n && by_key(&s[k], &s[k + 1]) == 0);
        if (twin) continue;
        rc = fl_grow(&m->triangle, &cap, (int64_t)m->triangles + 1, sizeof *m->triangle, err);
        if (rc == 0) memcpy(m->triangle[m->triangles++], s[k].node, sizeof s[k].node);
    }
    free(s);
    if (rc == 0 && !(m->face = fl_alloc(m->triangles, sizeof *m->face, err))) rc = -1;
    return rc;
}

static fl_vec3 triangle_centre(const fl_zone_mesh *m, int32_t k)
{
    const int32_t *t = m->triangle[k];
    return v3_scale(1.0 / 3.0, v3_add(v3_add(m->x[t[0]], m->x[t[1]]), m->x[t[2]]));
}

/* The face of p whose plane each triangle lies in. */
static void assign_faces(fl_zone_mesh *m, const fl_poly *p)
{
    for (int32_t k = 0; k < m->triangles; k++) {
        const fl_vec3 x = triangle_centre(m, k);
        double least = INFINITY;
        for (int32_t f = 0; f < p->nf; f++) {
            const double d = fabs(v3_dot(p->n[f], v3_sub(x, p->v[p->loop[p->first[f]]])));
            if (d < least) least = d, m->face[k] = f;
        }
    }
}

/* --- grid --------------------------------------------------------------------------------------- */

static fl_vec3 grid_point(const fl_vec3 c[8], double r, double s, double t)
{
    const fl_vec3 a = v3_lerp(v3_lerp(c[0], c[1], r), v3_lerp(c[2], c[3], r), s),
                  b = v3_lerp(v3_lerp(c[4], c[5], r), v3_lerp(c[6], c[7], r), s);
    return v3_lerp(a, b, t);
}

/* Appends the zones of the cell with the nodes q[8]; odd: mirrored. */
static void add_cell(fl_zone_mesh *m, const int32_t q[8], int odd, enum fl_zone_split split)
{
    static const int FIVE[2][5][4] = {{{0, 1, 2, 4}, {3, 2, 1, 7}, {5, 4, 7, 1}, {6, 7, 4, 2}, {1, 2, 4, 7}},
                                      {{1, 3, 0, 5}, {2, 0, 3, 6}, {4, 5, 6, 0}, {7, 6, 5, 3}, {0, 3, 5, 6}}};
    static const int SIX[6][4] = {{0, 1, 3, 7}, {0, 3, 2, 7}, {0, 2, 6, 7},
                                  {0, 6, 4, 7}, {0, 4, 5, 7}, {0, 5, 1, 7}};
    const int n = split == FL_ZONE_SPLIT_FIVE ? 5 : 6;
    for (int k = 0; k < n; k++) {
        const int *t = split == FL_ZONE_SPLIT_FIVE ? FIVE[odd][k] : SIX[k];
        int32_t *z = m->zone[m->zones++];
        for (int e = 0; e < 4; e++) z[e] = q[t[e]];
        if (six_volumes(m->x, z) < 0.0) swap_nodes(&z[2], &z[3]);
    }
}

static int make_grid(fl_zone_mesh *m, const fl_vec3 corner[8], const int32_t n[3], enum fl_zone_split split,
                     fl_err *err)
{
    const int64_t nx = n[0] + 1, ny = n[1] + 1, nz = n[2] + 1, cells = (int64_t)n[0] * n[1] * n[2];
    *m = (fl_zone_mesh){0};
    if (nx * ny * nz > INT32_MAX / 8 || cells > INT32_MAX / 8)
        return fl_fail(err, FL_INPUT, "a block of %g zones is too large", 5.0 * (double)cells);
    m->x = fl_alloc(nx * ny * nz, sizeof *m->x, err);
    m->zone = fl_alloc((split == FL_ZONE_SPLIT_FIVE ? 5 : 6) * cells, sizeof *m->zone, err);
    if (!m->x || !m->zone) return -1;
    for (int32_t k = 0; k < nz; k++)
        for (int32_t j = 0; j < ny; j++)
            for (int32_t i = 0; i < nx; i++)
                m->x[m->nodes++] = grid_point(corner, (double)i / n[0], (double)j / n[1], (double)k / n[2]);
    for (int32_t k = 0; k < n[2]; k++)
        for (int32_t j = 0; j < n[1]; j++)
            for (int32_t i = 0; i < n[0]; i++) {
                int32_t q[8];
                for (int e = 0; e < 8; e++)
                    q[e] = (int32_t)(i + (e & 1) + nx * (j + (e >> 1 & 1) + ny * (k + (e >> 2 & 1))));
                add_cell(m, q, (i + j + k) & 1, split);
            }
    return find_boundary(m, err);
}

int fl_zone_grid(fl_zone_mesh *m, const fl_vec3 corner[8], const int32_t n[3], enum fl_zone_split split,
                 fl_err *err)
{
    if (make_grid(m, corner, n, split, err) || check_zones(m, err)) {
        fl_zone_mesh_free(m);
        return -1;
    }
    const int32_t nx = n[0] + 1, ny = n[1] + 1;
    for (int32_t k = 0; k < m->triangles; k++) {
        int32_t at[3][3];
        for (int e = 0; e < 3; e++) {
            const int32_t p = m->triangle[k][e];
            at[e][0] = p % nx, at[e][1] = p / nx % ny, at[e][2] = p / nx / ny;
        }
        for (int d = 0; d < 3; d++)
            for (int side = 0; side < 2; side++) {
                const int32_t c = side ? n[d] : 0;
                if (at[0][d] == c && at[1][d] == c && at[2][d] == c) m->face[k] = 2 * d + side;
            }
    }
    return 0;
}

/* The corners of p as those of a cube; 0 if it has another topology. */
static int find_cube(const fl_poly *p, int32_t corner[8])
{
    int32_t neighbour[3], n = 0;
    if (p->nv != 8 || p->nf != 6 || p->ne != 12) return 0;
    for (int32_t f = 0; f < 6; f++)
        if (p->first[f + 1] - p->first[f] != 4) return 0;
    for (int32_t e = 0; e < 12; e++)
        if (p->edge[e].a == 0 || p->edge[e].b == 0) {
            if (n == 3) return 0;
            neighbour[n++] = p->edge[e].a + p->edge[e].b;
        }
    if (n != 3) return 0;
    const fl_vec3 o = p->v[0], a = v3_sub(p->v[neighbour[0]], o), b = v3_sub(p->v[neighbour[1]], o),
                  c = v3_sub(p->v[neighbour[2]], o);
    if (v3_dot(a, v3_cross(b, c)) < 0.0) swap_nodes(&neighbour[1], &neighbour[2]);
    for (int k = 0; k < 8; k++) corner[k] = -1;
    corner[0] = 0, corner[1] = neighbour[0], corner[2] = neighbour[1], corner[4] = neighbour[2];
    /* the fourth corner of each face at corner 0 */
    for (int32_t f = 0; f < 6; f++) {
        const int32_t *l = p->loop + p->first[f];
        int has[8] = {0}, sum = 0;
        for (int e = 0; e < 4; e++)
            for (int k = 0; k < 8; k++) has[k] |= corner[k] >= 0 && corner[k] == l[e];
        if (!has[0]) continue;
        for (int k = 1; k <= 4; k *= 2) sum += has[k] ? k : 0;
        if (sum != 3 && sum != 5 && sum != 6) return 0;
        for (int e = 0; e < 4; e++)
            if (l[e] != 0 && l[e] != neighbour[0] && l[e] != neighbour[1] && l[e] != neighbour[2])
                corner[sum] = l[e];
    }
    int32_t left = 28;
    for (int k = 0; k < 7; k++) {
        if (corner[k] < 0) return 0;
        left -= corner[k];
    }
    corner[7] = left;
    return left >= 0 && left < 8;
}

/* Cells along each direction of the cube. */
static void count_cells(const fl_vec3 c[8], double size, int32_t n[3])
{
    for (int d = 0; d < 3; d++) {
        double longest = 0.0;
        for (int k = 0; k < 8; k++)
            if (!(k >> d & 1)) longest = fmax(longest, v3_norm(v3_sub(c[k | 1 << d], c[k])));
        n[d] = (int32_t)fmin(1e6, fmax(1.0, ceil(longest / size - 1e-6)));
    }
}

/* --- bisection ---------------------------------------------------------------------------------- */

typedef struct {
    double length2;
    int32_t a, b;
} long_edge;

/* A mesh that grows: the zones of each node, with some that are no longer its own. */
typedef struct {
    fl_zone_mesh *m;
    int32_t cap_x, cap_zone, cap_of;
    struct zone_list {
        int32_t *of, n, cap;
    } * at;
    long_edge *heap;
    int32_t edges, cap_heap;
    double limit2;
} bisection;

static int goes_before(const long_edge *a, const long_edge *b)
{
    if (a->length2 != b->length2) return a->length2 > b->length2;
    return a->a != b->a ? a->a < b->a : a->b < b->b;
}

static int push_edge(bisection *s, int32_t a, int32_t b, fl_err *err)
{
    const long_edge e = {v3_norm2(v3_sub(s->m->x[a], s->m->x[b])), a < b ? a : b, a < b ? b : a};
    if (!(e.length2 > s->limit2)) return 0;
    if (fl_grow(&s->heap, &s->cap_heap, (int64_t)s->edges + 1, sizeof *s->heap, err)) return -1;
    int32_t k = s->edges++;
    for (; k > 0 && goes_before(&e, &s->heap[(k - 1) / 2]); k = (k - 1) / 2)
        s->heap[k] = s->heap[(k - 1) / 2];
    s->heap[k] = e;
    return 0;
}

static long_edge pop_edge(bisection *s)
{
    const long_edge top = s->heap[0], last = s->heap[--s->edges];
    int32_t k = 0;
    for (int32_t c = 1; c < s->edges; c = 2 * k + 1) {
        if (c + 1 < s->edges && goes_before(&s->heap[c + 1], &s->heap[c])) c++;
        if (!goes_before(&s->heap[c], &last)) break;
        s->heap[k] = s->heap[c], k = c;
    }
    if (s->edges) s->heap[k] = last;
    return top;
}

static int add_node(bisection *s, fl_vec3 x, fl_err *err)
{
    fl_zone_mesh *m = s->m;
    if (fl_grow(&m->x, &s->cap_x, (int64_t)m->nodes + 1, sizeof *m->x, err) ||
        fl_grow(&s->at, &s->cap_of, (int64_t)m->nodes + 1, sizeof *s->at, err))
        return -1;
    s->at[m->nodes] = (struct zone_list){0};
    m->x[m->nodes++] = x;
    return 0;
}

static int list_zone(bisection *s, int32_t node, int32_t zone, fl_err *err)
{
    struct zone_list *l = &s->at[node];
    if (fl_grow(&l->of, &l->cap, (int64_t)l->n + 1, sizeof *l->of, err)) return -1;
    l->of[l->n++] = zone;
    return 0;
}

static int add_zone(bisection *s, const int32_t t[4], fl_err *err)
{
    fl_zone_mesh *m = s->m;
    if (fl_grow(&m->zone, &s->cap_zone, (int64_t)m->zones + 1, sizeof *m->zone, err)) return -1;
    memcpy(m->zone[m->zones], t, sizeof *m->zone);
    for (int e = 0; e < 4; e++)
        if (list_zone(s, t[e], m->zones, err)) return -1;
    m->zones++;
    return 0;
}

static int place_in(const int32_t t[4], int32_t node)
{
    for (int e = 0; e < 4; e++)
        if (t[e] == node) return e;
    return -1;
}

/* Halves the edge and all zones around it. */
static int halve_edge(bisection *s, long_edge edge, fl_err *err)
{
    fl_zone_mesh *m = s->m;
    const int32_t mid = m->nodes, first = m->zones;
    if (add_node(s, v3_lerp(m->x[edge.a], m->x[edge.b], 0.5), err)) return -1;
    const int32_t listed = s->at[edge.b].n;
    int32_t kept = 0;
    for (int32_t k = 0; k < listed; k++) {
        const int32_t zone = s->at[edge.b].of[k];
        int32_t t[4];
        memcpy(t, m->zone[zone], sizeof t);
        const int pa = place_in(t, edge.a), pb = place_in(t, edge.b);
        if (pb < 0) continue;
        if (pa < 0) {
            s->at[edge.b].of[kept++] = zone;
            continue;
        }
        m->zone[zone][pb] = mid; /* the half at a keeps the number */
        t[pa] = mid;
        if (list_zone(s, mid, zone, err) || add_zone(s, t, err)) return -1;
    }
    /* halves at b were listed behind */
    for (int32_t k = listed; k < s->at[edge.b].n; k++) s->at[edge.b].of[kept++] = s->at[edge.b].of[k];
    s->at[edge.b].n = kept;
    if (push_edge(s, edge.a, mid, err) || push_edge(s, mid, edge.b, err)) return -1;
    for (int32_t k = first; k < m->zones; k++)
        for (int e = 0; e < 4; e++) {
            const int32_t c = m->zone[k][e];
            int seen = c == mid || c == edge.b;
            for (int32_t l = first; l < k && !seen; l++) seen = place_in(m->zone[l], c) >= 0;
            if (!seen && push_edge(s, mid, c, err)) return -1;
        }
    return 0;
}

static fl_vec3 mean_of_face(const fl_poly *p, int32_t f)
{
    fl_vec3 sum = v3(0, 0, 0);
    for (int32_t k = p->first[f]; k < p->first[f + 1]; k++) sum = v3_add(sum, p->v[p->loop[k]]);
    return v3_scale(1.0 / (p->first[f + 1] - p->first[f]), sum);
}

/* Zones from the mean of the corners to the faces; edges of all of them. */
static int start_bisection(bisection *s, const fl_poly *p, fl_err *err)
{
    fl_vec3 centre = v3(0, 0, 0);
    for (int32_t k = 0; k < p->nv; k++) {
        centre = v3_add(centre, p->v[k]);
        if (add_node(s, p->v[k], err)) return -1;
    }
    if (add_node(s, v3_scale(1.0 / p->nv, centre), err)) return -1;
    for (int32_t k = 0; k < p->nv; k++)
        if (push_edge(s, k, p->nv, err)) return -1;
    for (int32_t e = 0; e < p->ne; e++)
        if (push_edge(s, p->edge[e].a, p->edge[e].b, err)) return -1;
    for (int32_t f = 0; f < p->nf; f++) {
        const int32_t n = p->first[f + 1] - p->first[f], *l = p->loop + p->first[f];
        const int32_t hub = n > 3 ? s->m->nodes : l[0];
        if (n > 3) {
            if (add_node(s, mean_of_face(p, f), err) || push_edge(s, p->nv, hub, err)) return -1;
            for (int32_t k = 0; k < n; k++)
                if (push_edge(s, l[k], hub, err)) return -1;
        }
        for (int32_t k = n > 3 ? 0 : 1; k < (n > 3 ? n : 2); k++)
            if (add_zone(s, (int32_t[4]){p->nv, hub, l[k], l[(k + 1) % n]}, err)) return -1;
    }
    return 0;
}

static int bisect_block(fl_zone_mesh *m, const fl_poly *p, double size, fl_err *err)
{
    bisection s = {.m = m, .limit2 = 2.0 * size * size * (1.0 + 1e-9)};
    *m = (fl_zone_mesh){0};
    int rc = start_bisection(&s, p, err);
    while (rc == 0 && s.edges) rc = halve_edge(&s, pop_edge(&s), err);
    for (int32_t k = 0; k < m->nodes && s.at; k++) free(s.at[k].of);
    free(s.at), free(s.heap);
    return rc ? -1 : find_boundary(m, err);
}

int fl_zone_mesh_make(fl_zone_mesh *m, const fl_poly *p, double size, fl_err *err)
{
    int32_t cube[8], n[3];
    if (find_cube(p, cube)) {
        fl_vec3 corner[8];
        fl_err why = {0};
        for (int k = 0; k < 8; k++) corner[k] = p->v[cube[k]];
        count_cells(corner, size, n);
        if (make_grid(m, corner, n, FL_ZONE_SPLIT_FIVE, err)) goto fail;
        if (check_zones(m, &why) == 0) {
            assign_faces(m, p);
            return 0;
        }
        fl_zone_mesh_free(m);
    }
    if (bisect_block(m, p, size, err) || check_zones(m, err)) goto fail;
    assign_faces(m, p);
    return 0;
fail:
    fl_zone_mesh_free(m);
    return -1;
}

double fl_zone_mesh_thickness(const fl_poly *p)
{
    double least = INFINITY;
    for (int32_t f = 0; f < p->nf; f++) {
        const fl_vec3 x = p->v[p->loop[p->first[f]]];
        double deepest = 0.0;
        for (int32_t k = 0; k < p->nv; k++) deepest = fmax(deepest, v3_dot(p->n[f], v3_sub(x, p->v[k])));
        least = fmin(least, deepest);
    }
    return least;
}
