/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "geom/merge_coplanar.h"
#include <stdlib.h>
#include <string.h>
#include "base/array.h"

/* Boundaries with more corners are not tested as one polygon: the test takes quadratic time. */
enum { BOUNDARY_MAX = 4096 };

/* Side k of triangle t is half-edge 3 t + k. */
typedef struct {
    const fl_vec3 *v;
    const fl_tri *t;
    const int32_t *region;
    const fl_vec3 *normal;
    int32_t nt;
    double tol;
    int32_t *next, *prev, *twin; /* [3 nt] round a face; twin: -1 on the boundary and where joined */
    int32_t *parent;             /* [nt] union-find of the triangles of a face */
    int32_t *work;               /* [3 nt] the current loop */
    uint8_t *joined;             /* [3 nt] half-edges removed by joining */
    fl_merged_faces out;
} face_mesh;

static int32_t origin(const face_mesh *m, int32_t h) { return m->t[h / 3].v[h % 3]; }

static int32_t face_of(face_mesh *m, int32_t t)
{
    while (m->parent[t] != t) t = m->parent[t] = m->parent[m->parent[t]];
    return t;
}

/* Signed distance of b from the line from a to c: >= 0 where a, b, c turn left about n. */
static double offset_from_line(const face_mesh *m, int32_t a, int32_t b, int32_t c, fl_vec3 n)
{
    const fl_vec3 along = v3_sub(m->v[c], m->v[a]);
    const double size = v3_norm(along);
    if (!(size > 0.0)) return -INFINITY; /* a spike */
    return v3_dot(n, v3_cross(v3_sub(m->v[b], m->v[a]), along)) / size;
}

/* Removes the straight corners of loop[0 .. n).  Returns the number of corners left, at least 3.  note counts
 * the removed corners by vertex, or is NULL. */
static int32_t drop_straight_corners(const face_mesh *m, int32_t *loop, int32_t n, fl_vec3 normal,
                                     int32_t *note)
{
    for (int32_t k = 0, kept = 0; n > 3 && kept < n;) {
        const int32_t a = loop[(k + n - 1) % n], b = loop[k], c = loop[(k + 1) % n];
        const fl_vec3 to = v3_sub(m->v[c], m->v[b]), from = v3_sub(m->v[b], m->v[a]);
        if (v3_dot(to, from) > 0.0 && fabs(offset_from_line(m, a, b, c, normal)) <= m->tol) {
            if (note) note[b]++;
            memmove(loop + k, loop + k + 1, (size_t)(n - k - 1) * sizeof *loop);
            n--;
            k = (k + n - 1) % n; /* the corner before may be straight now */
            kept = 0;
        } else {
            k = (k + 1) % n;
            kept++;
        }
    }
    return n;
}

/* True if every corner lies on the inner side of every side and the loop turns once: its area equals
 * `area`. */
static int is_convex(const face_mesh *m, const int32_t *loop, int32_t n, fl_vec3 normal, double area)
{
    double twice = 0.0, length = 0.0;
    for (int32_t k = 0; k < n; k++) {
        const fl_vec3 a = m->v[loop[k]], e = v3_sub(m->v[loop[(k + 1) % n]], a), in = v3_cross(normal, e);
        const double low = -m->tol * v3_norm(e);
        length += v3_norm(e);
        twice += v3_dot(normal, v3_cross(v3_sub(a, m->v[loop[0]]), e));
        for (int32_t c = 0; c < n; c++)
            if (v3_dot(in, v3_sub(m->v[loop[c]], a)) < low) return 0;
    }
    return fabs(0.5 * twice - area) <= m->tol * length;
}

static double triangle_area(const face_mesh *m, int32_t t)
{
    const int32_t *v = m->t[t].v;
    return 0.5 * v3_dot(m->normal[m->region[t]],
                        v3_cross(v3_sub(m->v[v[1]], m->v[v[0]]), v3_sub(m->v[v[2]], m->v[v[0]])));
}

static int point_less(fl_vec3 a, fl_vec3 b)
{
    return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z < b.z;
}

/* Appends a convex loop as one face, or as several of FL_MERGED_SIDES_MAX sides.  The loop starts at its
 * lowest corner, so that it does not depend on the order of the triangles. */
static int32_t append_face(face_mesh *m, int32_t region, int32_t *loop, int32_t n)
{
    fl_merged_faces *o = &m->out;
    const int32_t face = o->n;
    int32_t build_half_edges = 0;
    for (int32_t k = 1; k < n; k++)
        if (point_less(m->v[loop[k]], m->v[loop[build_half_edges]])) build_half_edges = k;
    for (int32_t from = 1; from + 1 < n; from += FL_MERGED_SIDES_MAX - 2) {
        const int32_t to = from + FL_MERGED_SIDES_MAX - 2 < n - 1 ? from + FL_MERGED_SIDES_MAX - 2 : n - 1;
        int32_t at = o->first[o->n];
        o->loop[at++] = loop[build_half_edges];
        for (int32_t k = from; k <= to; k++) o->loop[at++] = loop[(build_half_edges + k) % n];
        o->region[o->n] = region;
        o->first[++o->n] = at;
    }
    return face;
}

/* Collects the vertices of the loop of half-edge h. */
static int32_t collect_loop(const face_mesh *m, int32_t h)
{
    int32_t n = 0, k = h;
    do {
        m->work[n++] = origin(m, k);
        k = m->next[k];
    } while (k != h);
    return n;
}

/* Appends the region of boundary half-edge h as one face; n_boundary is its number of boundary half-edges.
 * Returns -1 where it is not convex. */
static int32_t append_whole_region(face_mesh *m, int32_t h, int32_t n_boundary, double area)
{
    const fl_vec3 normal = m->normal[m->region[h / 3]];
    int32_t n = 0, k = h;
    if (n_boundary > BOUNDARY_MAX) return -1;
    do {
        if (n == n_boundary) return -1;
        m->work[n++] = origin(m, k);
        k = m->next[k];
        while (m->twin[k] >= 0) k = m->next[m->twin[k]];
    } while (k != h);
    if (n < n_boundary) return -1; /* the region has holes */
    n = drop_straight_corners(m, m->work, n, normal, NULL);
    if (!is_convex(m, m->work, n, normal, area)) return -1;
    /* repeated now that the region is known to be convex, to count the straight corners */
    n = 0, k = h;
    do {
        m->work[n++] = origin(m, k);
        k = m->next[k];
        while (m->twin[k] >= 0) k = m->next[m->twin[k]];
    } while (k != h);
    n = drop_straight_corners(m, m->work, n, normal, m->out.straight_corners);
    return append_face(m, m->region[h / 3], m->work, n);
}

/* Joins the faces on both sides of h across all consecutive sides that they share, if both end corners stay
 * convex. */
static int join_faces(face_mesh *m, int32_t h)
{
    int32_t g = m->twin[h], ha = h, hb = h; /* first and last shared half-edge of the first face */
    if (g < 0 || m->joined[h]) return 0;
    const int32_t p = face_of(m, h / 3), q = face_of(m, g / 3);
    if (p == q) return 0;
    while (m->twin[m->prev[ha]] >= 0 && m->twin[m->prev[ha]] == m->next[m->twin[ha]]) {
        ha = m->prev[ha];
        if (ha == h) return 0;
    }
    while (m->twin[m->next[hb]] >= 0 && m->twin[m->next[hb]] == m->prev[m->twin[hb]]) {
        hb = m->next[hb];
        if (hb == ha) return 0;
    }
    const fl_vec3 n = m->normal[m->region[h / 3]];
    const int32_t ga = m->twin[ha], gb = m->twin[hb]; /* ga ends where ha begins */
    const int32_t before = m->prev[ha], after = m->next[ga], back = m->prev[gb], on = m->next[hb];
    const int32_t a = origin(m, ha), b = origin(m, on);
    const double low =
        -0.1 * m->tol; /* several deviations must not add up to tol; final test after joining */
    if (offset_from_line(m, origin(m, before), a, origin(m, m->next[after]), n) < low ||
        offset_from_line(m, origin(m, back), b, origin(m, m->next[on]), n) < low)
        return 0;
    for (int32_t k = ha;; k = m->next[k]) {
        m->joined[k] = m->joined[m->twin[k]] = 1;
        if (k == hb) break;
    }
    m->next[before] = after, m->prev[after] = before;
    m->next[back] = on, m->prev[on] = back;
    if (p < q) m->parent[q] = p;
    else m->parent[p] = q;
    return 1;
}

typedef struct {
    double length;
    int32_t h;
} inner_edge;

/* Longest first: diagonals of grid cells come before their sides. */
static int compare_length(const void *x, const void *y)
{
    const inner_edge *p = x, *q = y;
    if (p->length != q->length) return p->length > q->length ? -1 : 1;
    return (p->h > q->h) - (p->h < q->h);
}

static int join_regions(face_mesh *m, const int32_t *finished, fl_err *err)
{
    int32_t n = 0;
    inner_edge *list = fl_alloc(3 * (int64_t)m->nt, sizeof *list, err);
    if (!list) return -1;
    for (int32_t h = 0; h < 3 * m->nt; h++) {
        if (m->twin[h] < h || finished[m->region[h / 3]] >= 0) continue;
        list[n++] = (inner_edge){v3_norm(v3_sub(m->v[origin(m, m->twin[h])], m->v[origin(m, h)])), h};
    }
    if (n > 1) qsort(list, (size_t)n, sizeof *list, compare_length);
    for (int again = 1; again;) {
        again = 0;
        for (int32_t k = 0; k < n; k++) again |= join_faces(m, list[k].h);
    }
    free(list);
    return 0;
}

static int build_half_edges(face_mesh *m, int32_t nv, const int32_t *across, fl_err *err)
{
    const int64_t nh = 3 * (int64_t)m->nt;
    fl_merged_faces *o = &m->out;
    m->next = fl_alloc(nh, sizeof *m->next, err);
    m->prev = fl_alloc(nh, sizeof *m->prev, err);
    m->twin = fl_alloc(nh, sizeof *m->twin, err);
    m->work = fl_alloc(nh, sizeof *m->work, err);
    m->joined = fl_alloc(nh, sizeof *m->joined, err);
    m->parent = fl_alloc(m->nt, sizeof *m->parent, err);
    o->first = fl_alloc((int64_t)m->nt + 1, sizeof *o->first, err);
    o->loop = fl_alloc(nh, sizeof *o->loop, err);
    o->region = fl_alloc(m->nt, sizeof *o->region, err);
    o->face_of_tri = fl_alloc(m->nt, sizeof *o->face_of_tri, err);
    o->straight_corners = fl_alloc(nv, sizeof *o->straight_corners, err);
    if (!m->next || !m->prev || !m->twin || !m->work || !m->joined || !m->parent || !o->first || !o->loop ||
        !o->region || !o->face_of_tri || !o->straight_corners)
        return -1;
    memset(m->joined, 0, (size_t)nh);
    memset(o->straight_corners, 0, (size_t)nv * sizeof *o->straight_corners);
    o->first[0] = 0;
    for (int32_t t = 0; t < m->nt; t++) {
        m->parent[t] = t;
        o->face_of_tri[t] = -1;
        for (int k = 0; k < 3; k++) {
            const int32_t h = 3 * t + k, u = across[h];
            m->next[h] = 3 * t + (k + 1) % 3;
            m->prev[h] = 3 * t + (k + 2) % 3;
            m->twin[h] = -1;
            if (u < 0 || m->region[t] < 0 || m->region[u] != m->region[t]) continue;
            for (int c = 0; c < 3; c++) /* the side of u that runs from the end of h to its origin */
                if (m->t[u].v[c] == m->t[t].v[(k + 1) % 3] && m->t[u].v[(c + 1) % 3] == m->t[t].v[k])
                    m->twin[h] = 3 * u + c;
        }
    }
    return 0;
}

/* Makes a face of each region with a convex boundary.  done[region] is its index, -1 for the others. */
static int whole_regions(face_mesh *m, int32_t regions, int32_t *finished, fl_err *err)
{
    int32_t *n_boundary = fl_alloc(regions, sizeof *n_boundary, err),
            *boundary = fl_alloc(regions, sizeof *boundary, err);
    double *area = fl_alloc(regions, sizeof *area, err);
    const int ok = n_boundary && boundary && area;
    if (ok) {
        for (int32_t r = 0; r < regions; r++)
            n_boundary[r] = 0, boundary[r] = -1, area[r] = 0.0, finished[r] = -1;
        for (int32_t t = 0; t < m->nt; t++) {
            if (m->region[t] < 0) continue;
            area[m->region[t]] += triangle_area(m, t);
            for (int k = 0; k < 3; k++) {
                if (m->twin[3 * t + k] >= 0) continue;
                n_boundary[m->region[t]]++;
                if (boundary[m->region[t]] < 0) boundary[m->region[t]] = 3 * t + k;
            }
        }
        for (int32_t r = 0; r < regions; r++)
            if (boundary[r] >= 0) finished[r] = append_whole_region(m, boundary[r], n_boundary[r], area[r]);
    }
    free(n_boundary), free(boundary), free(area);
    return ok ? 0 : -1;
}

/* Appends the face of half-edge h, whose triangles have the given area.  Returns 0 where its corners together
 * are concave by more than tol. */
static int append_joined_face(face_mesh *m, int32_t h, double area)
{
    const fl_vec3 normal = m->normal[m->region[h / 3]];
    const int32_t corners = drop_straight_corners(m, m->work, collect_loop(m, h), normal, NULL);
    if (!is_convex(m, m->work, corners, normal, area)) return 0;
    const int32_t n = drop_straight_corners(m, m->work, collect_loop(m, h), normal, m->out.straight_corners);
    m->out.face_of_tri[face_of(m, h / 3)] = append_face(m, m->region[h / 3], m->work, n);
    return 1;
}

/* Appends the faces of the other regions; a face that fails the test stays as triangles. */
static int append_joined_faces(face_mesh *m, const int32_t *finished, fl_err *err)
{
    double *area = fl_alloc(m->nt, sizeof *area, err); /* of the face, or negative: keep its triangles */
    if (!area) return -1;
    for (int32_t t = 0; t < m->nt; t++) {
        if (m->region[t] < 0) continue;
        area[face_of(m, t)] += triangle_area(m, t);
        m->out.face_of_tri[t] = finished[m->region[t]];
    }
    for (int32_t h = 0; h < 3 * m->nt; h++) {
        if (m->region[h / 3] < 0 || m->joined[h]) continue;
        const int32_t face = face_of(m, h / 3);
        if (m->out.face_of_tri[face] < 0 && area[face] >= 0.0 && !append_joined_face(m, h, area[face]))
            area[face] = -1.0;
    }
    for (int32_t t = 0; t < m->nt; t++) {
        if (m->region[t] < 0 || m->out.face_of_tri[t] >= 0) continue;
        if (area[face_of(m, t)] >= 0.0) m->out.face_of_tri[t] = m->out.face_of_tri[face_of(m, t)];
    }
    for (int32_t t = 0; t < m->nt; t++) { /* last, since the entry of the root triangle stands for the face */
        if (m->region[t] < 0 || m->out.face_of_tri[t] >= 0) continue;
        memcpy(m->work, m->t[t].v, sizeof m->t[t].v);
        m->out.face_of_tri[t] = append_face(m, m->region[t], m->work, 3);
    }
    free(area);
    return 0;
}

int fl_merge_coplanar(fl_merged_faces *out, int32_t nv, const fl_vec3 *v, int32_t nt, const fl_tri *t,
                      const int32_t *region, const fl_vec3 *normal, const int32_t *across, double tol,
                      fl_err *err)
{
    face_mesh m = {.v = v, .t = t, .region = region, .normal = normal, .nt = nt, .tol = tol};
    int32_t regions = 0, *finished = NULL;
    int rc = -1;
    for (int32_t k = 0; k < nt; k++) regions = region[k] >= regions ? region[k] + 1 : regions;
    finished = fl_alloc(regions, sizeof *finished, err);
    if (!finished || build_half_edges(&m, nv, across, err) || whole_regions(&m, regions, finished, err) ||
        join_regions(&m, finished, err) || append_joined_faces(&m, finished, err))
        goto finished;
    *out = m.out;
    m.out = (fl_merged_faces){0};
    rc = 0;
finished:
    free(finished), free(m.next), free(m.prev), free(m.twin), free(m.work), free(m.joined), free(m.parent);
    fl_merged_faces_free(&m.out);
    return rc;
}

void fl_merged_faces_free(fl_merged_faces *faces)
{
    free(faces->first), free(faces->loop), free(faces->region), free(faces->face_of_tri),
        free(faces->straight_corners);
    *faces = (fl_merged_faces){0};
}
