/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "geom/merge_coplanar.h"
#include <stdlib.h>
#include <string.h>
#include "base/array.h"

/* Rims of more corners than this are not looked at whole: the time is their square. */
enum { RIM_CORNERS = 4096 };

/* Side k of triangle t is the half-edge 3 t + k. */
typedef struct {
    const fl_vec3 *v;
    const fl_tri *t;
    const int32_t *region;
    const fl_vec3 *normal;
    int32_t nt;
    double tol;
    int32_t *next, *prev, *twin; /* [3 nt] round a tile; across, -1 on the rim and where joined */
    int32_t *over;               /* [nt] union-find: towards the triangle that stands for the tile */
    int32_t *work;               /* [3 nt] a loop in work */
    uint8_t *gone;               /* [3 nt] half-edges that were joined over */
    fl_merged_faces out;
} mesh;

static int32_t origin(const mesh *m, int32_t h) { return m->t[h / 3].v[h % 3]; }

static int32_t tile_of(mesh *m, int32_t t)
{
    while (m->over[t] != t) t = m->over[t] = m->over[m->over[t]];
    return t;
}

/* How far b stands out of the line from a to c, to the right seen along against n: >= 0 where a, b, c turn
 * left. */
static double stands_out(const mesh *m, int32_t a, int32_t b, int32_t c, fl_vec3 n)
{
    const fl_vec3 along = v3_sub(m->v[c], m->v[a]);
    const double size = v3_norm(along);
    if (!(size > 0.0)) return -INFINITY; /* a spike */
    return v3_dot(n, v3_cross(v3_sub(m->v[b], m->v[a]), along)) / size;
}

/* Corners of loop[0 .. n) that are straight go; returns how many stay, at least 3.  note: where they are
 * counted, or NULL. */
static int32_t without_straight(const mesh *m, int32_t *loop, int32_t n, fl_vec3 normal, int32_t *note)
{
    for (int32_t k = 0, kept = 0; n > 3 && kept < n;) {
        const int32_t a = loop[(k + n - 1) % n], b = loop[k], c = loop[(k + 1) % n];
        const fl_vec3 to = v3_sub(m->v[c], m->v[b]), from = v3_sub(m->v[b], m->v[a]);
        if (v3_dot(to, from) > 0.0 && fabs(stands_out(m, a, b, c, normal)) <= m->tol) {
            if (note) note[b]++;
            memmove(loop + k, loop + k + 1, (size_t)(n - k - 1) * sizeof *loop);
            n--;
            k = (k + n - 1) % n; /* the one before may be straight now */
            kept = 0;
        } else {
            k = (k + 1) % n;
            kept++;
        }
    }
    return n;
}

/* Every corner lies on the inner side of every side, and the loop goes round once: its area is that of what
 * it goes round. */
static int is_convex(const mesh *m, const int32_t *loop, int32_t n, fl_vec3 normal, double area)
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

static double area_of(const mesh *m, int32_t t)
{
    const int32_t *v = m->t[t].v;
    return 0.5 * v3_dot(m->normal[m->region[t]],
                        v3_cross(v3_sub(m->v[v[1]], m->v[v[0]]), v3_sub(m->v[v[2]], m->v[v[0]])));
}

static int lower(fl_vec3 a, fl_vec3 b) { return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z < b.z; }

/* Append a convex loop as one tile, or as several of FL_MERGED_SIDES_MAX sides; it starts at its lowest corner, so
 * that it does not hang on the order of triangles. */
static int32_t put(mesh *m, int32_t region, int32_t *loop, int32_t n)
{
    fl_merged_faces *o = &m->out;
    const int32_t tile = o->n;
    int32_t start = 0;
    for (int32_t k = 1; k < n; k++)
        if (lower(m->v[loop[k]], m->v[loop[start]])) start = k;
    for (int32_t from = 1; from + 1 < n; from += FL_MERGED_SIDES_MAX - 2) {
        const int32_t to = from + FL_MERGED_SIDES_MAX - 2 < n - 1 ? from + FL_MERGED_SIDES_MAX - 2 : n - 1;
        int32_t at = o->first[o->n];
        o->loop[at++] = loop[start];
        for (int32_t k = from; k <= to; k++) o->loop[at++] = loop[(start + k) % n];
        o->region[o->n] = region;
        o->first[++o->n] = at;
    }
    return tile;
}

/* The loop of half-edges from h, by vertices. */
static int32_t walk(const mesh *m, int32_t h)
{
    int32_t n = 0, k = h;
    do {
        m->work[n++] = origin(m, k);
        k = m->next[k];
    } while (k != h);
    return n;
}

/* The whole region round rim half-edge h as one tile; rims: how many there are.  -1 where it is not convex.
 */
static int32_t whole(mesh *m, int32_t h, int32_t rims, double area)
{
    const fl_vec3 normal = m->normal[m->region[h / 3]];
    int32_t n = 0, k = h;
    if (rims > RIM_CORNERS) return -1;
    do {
        if (n == rims) return -1;
        m->work[n++] = origin(m, k);
        k = m->next[k];
        while (m->twin[k] >= 0) k = m->next[m->twin[k]];
    } while (k != h);
    if (n < rims) return -1; /* holes */
    n = without_straight(m, m->work, n, normal, NULL);
    if (!is_convex(m, m->work, n, normal, area)) return -1;
    /* again, now that it is known: what was dropped is counted */
    n = 0, k = h;
    do {
        m->work[n++] = origin(m, k);
        k = m->next[k];
        while (m->twin[k] >= 0) k = m->next[m->twin[k]];
    } while (k != h);
    n = without_straight(m, m->work, n, normal, m->out.straight_corners);
    return put(m, m->region[h / 3], m->work, n);
}

/* Join the tiles on both sides of h over all the sides that they share in a row, when the two corners at the
 * ends stay convex. */
static int join(mesh *m, int32_t h)
{
    int32_t g = m->twin[h], ha = h, hb = h; /* first and last shared half-edge of the one tile */
    if (g < 0 || m->gone[h]) return 0;
    const int32_t p = tile_of(m, h / 3), q = tile_of(m, g / 3);
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
    const double low = -0.1 * m->tol; /* several must not add up to tol; checked when all are joined */
    if (stands_out(m, origin(m, before), a, origin(m, m->next[after]), n) < low ||
        stands_out(m, origin(m, back), b, origin(m, m->next[on]), n) < low)
        return 0;
    for (int32_t k = ha;; k = m->next[k]) {
        m->gone[k] = m->gone[m->twin[k]] = 1;
        if (k == hb) break;
    }
    m->next[before] = after, m->prev[after] = before;
    m->next[back] = on, m->prev[on] = back;
    if (p < q) m->over[q] = p;
    else m->over[p] = q;
    return 1;
}

typedef struct {
    double length;
    int32_t h;
} inner;

/* Longest first: the diagonals of cells before their sides. */
static int longer_first(const void *x, const void *y)
{
    const inner *p = x, *q = y;
    if (p->length != q->length) return p->length > q->length ? -1 : 1;
    return (p->h > q->h) - (p->h < q->h);
}

static int join_all(mesh *m, const int32_t *done, fl_err *err)
{
    int32_t n = 0;
    inner *list = fl_alloc(3 * (int64_t)m->nt, sizeof *list, err);
    if (!list) return -1;
    for (int32_t h = 0; h < 3 * m->nt; h++) {
        if (m->twin[h] < h || done[m->region[h / 3]] >= 0) continue;
        list[n++] = (inner){v3_norm(v3_sub(m->v[origin(m, m->twin[h])], m->v[origin(m, h)])), h};
    }
    if (n > 1) qsort(list, (size_t)n, sizeof *list, longer_first);
    for (int again = 1; again;) {
        again = 0;
        for (int32_t k = 0; k < n; k++) again |= join(m, list[k].h);
    }
    free(list);
    return 0;
}

static int start(mesh *m, int32_t nv, const int32_t *across, fl_err *err)
{
    const int64_t nh = 3 * (int64_t)m->nt;
    fl_merged_faces *o = &m->out;
    m->next = fl_alloc(nh, sizeof *m->next, err);
    m->prev = fl_alloc(nh, sizeof *m->prev, err);
    m->twin = fl_alloc(nh, sizeof *m->twin, err);
    m->work = fl_alloc(nh, sizeof *m->work, err);
    m->gone = fl_alloc(nh, sizeof *m->gone, err);
    m->over = fl_alloc(m->nt, sizeof *m->over, err);
    o->first = fl_alloc((int64_t)m->nt + 1, sizeof *o->first, err);
    o->loop = fl_alloc(nh, sizeof *o->loop, err);
    o->region = fl_alloc(m->nt, sizeof *o->region, err);
    o->face_of_tri = fl_alloc(m->nt, sizeof *o->face_of_tri, err);
    o->straight_corners = fl_alloc(nv, sizeof *o->straight_corners, err);
    if (!m->next || !m->prev || !m->twin || !m->work || !m->gone || !m->over || !o->first || !o->loop ||
        !o->region || !o->face_of_tri || !o->straight_corners)
        return -1;
    memset(m->gone, 0, (size_t)nh);
    memset(o->straight_corners, 0, (size_t)nv * sizeof *o->straight_corners);
    o->first[0] = 0;
    for (int32_t t = 0; t < m->nt; t++) {
        m->over[t] = t;
        o->face_of_tri[t] = -1;
        for (int k = 0; k < 3; k++) {
            const int32_t h = 3 * t + k, u = across[h];
            m->next[h] = 3 * t + (k + 1) % 3;
            m->prev[h] = 3 * t + (k + 2) % 3;
            m->twin[h] = -1;
            if (u < 0 || m->region[t] < 0 || m->region[u] != m->region[t]) continue;
            for (int c = 0; c < 3; c++) /* the side of u that goes from the end of h to its origin */
                if (m->t[u].v[c] == m->t[t].v[(k + 1) % 3] && m->t[u].v[(c + 1) % 3] == m->t[t].v[k])
                    m->twin[h] = 3 * u + c;
        }
    }
    return 0;
}

/* A tile of each region whose rim is convex; done[region], -1 for the others. */
static int whole_regions(mesh *m, int32_t regions, int32_t *done, fl_err *err)
{
    int32_t *rims = fl_alloc(regions, sizeof *rims, err), *rim = fl_alloc(regions, sizeof *rim, err);
    double *area = fl_alloc(regions, sizeof *area, err);
    const int ok = rims && rim && area;
    if (ok) {
        for (int32_t r = 0; r < regions; r++) rims[r] = 0, rim[r] = -1, area[r] = 0.0, done[r] = -1;
        for (int32_t t = 0; t < m->nt; t++) {
            if (m->region[t] < 0) continue;
            area[m->region[t]] += area_of(m, t);
            for (int k = 0; k < 3; k++) {
                if (m->twin[3 * t + k] >= 0) continue;
                rims[m->region[t]]++;
                if (rim[m->region[t]] < 0) rim[m->region[t]] = 3 * t + k;
            }
        }
        for (int32_t r = 0; r < regions; r++)
            if (rim[r] >= 0) done[r] = whole(m, rim[r], rims[r], area[r]);
    }
    free(rims), free(rim), free(area);
    return ok ? 0 : -1;
}

/* The tile of half-edge h and of triangles of the given area; 0 where its corners stand in by more than tol
 * together. */
static int put_tile(mesh *m, int32_t h, double area)
{
    const fl_vec3 normal = m->normal[m->region[h / 3]];
    const int32_t corners = without_straight(m, m->work, walk(m, h), normal, NULL);
    if (!is_convex(m, m->work, corners, normal, area)) return 0;
    const int32_t n = without_straight(m, m->work, walk(m, h), normal, m->out.straight_corners);
    m->out.face_of_tri[tile_of(m, h / 3)] = put(m, m->region[h / 3], m->work, n);
    return 1;
}

/* The tiles of the other regions; what is no tile after all stays triangles. */
static int put_joined(mesh *m, const int32_t *done, fl_err *err)
{
    double *area = fl_alloc(m->nt, sizeof *area, err); /* of the tile, or negative: triangles */
    if (!area) return -1;
    for (int32_t t = 0; t < m->nt; t++) {
        if (m->region[t] < 0) continue;
        area[tile_of(m, t)] += area_of(m, t);
        m->out.face_of_tri[t] = done[m->region[t]];
    }
    for (int32_t h = 0; h < 3 * m->nt; h++) {
        if (m->region[h / 3] < 0 || m->gone[h]) continue;
        const int32_t tile = tile_of(m, h / 3);
        if (m->out.face_of_tri[tile] < 0 && area[tile] >= 0.0 && !put_tile(m, h, area[tile]))
            area[tile] = -1.0;
    }
    for (int32_t t = 0; t < m->nt; t++) {
        if (m->region[t] < 0 || m->out.face_of_tri[t] >= 0) continue;
        if (area[tile_of(m, t)] >= 0.0) m->out.face_of_tri[t] = m->out.face_of_tri[tile_of(m, t)];
    }
    for (int32_t t = 0; t < m->nt; t++) { /* last, as one of them stands for the tile */
        if (m->region[t] < 0 || m->out.face_of_tri[t] >= 0) continue;
        memcpy(m->work, m->t[t].v, sizeof m->t[t].v);
        m->out.face_of_tri[t] = put(m, m->region[t], m->work, 3);
    }
    free(area);
    return 0;
}

int fl_merge_coplanar(fl_merged_faces *out, int32_t nv, const fl_vec3 *v, int32_t nt, const fl_tri *t,
                      const int32_t *region, const fl_vec3 *normal, const int32_t *across, double tol,
                      fl_err *err)
{
    mesh m = {.v = v, .t = t, .region = region, .normal = normal, .nt = nt, .tol = tol};
    int32_t regions = 0, *done = NULL;
    int rc = -1;
    for (int32_t k = 0; k < nt; k++) regions = region[k] >= regions ? region[k] + 1 : regions;
    done = fl_alloc(regions, sizeof *done, err);
    if (!done || start(&m, nv, across, err) || whole_regions(&m, regions, done, err) ||
        join_all(&m, done, err) || put_joined(&m, done, err))
        goto done;
    *out = m.out;
    m.out = (fl_merged_faces){0};
    rc = 0;
done:
    free(done), free(m.next), free(m.prev), free(m.twin), free(m.work), free(m.gone), free(m.over);
    fl_merged_faces_free(&m.out);
    return rc;
}

void fl_merged_faces_free(fl_merged_faces *tiles)
{
    free(tiles->first), free(tiles->loop), free(tiles->region), free(tiles->face_of_tri),
        free(tiles->straight_corners);
    *tiles = (fl_merged_faces){0};
}
