/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <string.h>
#include "base/array.h"
#include "base/pi.h"
#include "structure/region_cover.h"
#include "structure/coplanar_regions.h"
#include "structure/structure.h"
#include "geom/clip.h"
#include "geom/merge_coplanar.h"

/* True if every vertex in use lies behind every region's plane. */
static int is_convex(const fl_coplanar_regions *f)
{
    const fl_part *p = f->p;
    for (int32_t r = 0; r < f->regions; r++)
        for (int32_t t = 0; t < p->nt; t++)
            for (int k = 0; k < 3; k++)
                if (v3_dot(f->region_normal[r], p->v[p->t[t].v[k]]) - f->region_offset[r] > f->tol) return 0;
    return 1;
}

static fl_piece *add_piece(fl_structure *s, fl_err *err)
{
    if (fl_grow(&s->piece, &s->cap, (int64_t)s->n + 1, sizeof *s->piece, err)) return NULL;
    fl_piece *piece = &s->piece[s->n];
    *piece = (fl_piece){.q = q_one(), .cone = -1};
    return piece;
}

/* The convex part as the intersection of the half-spaces of its faces, cut out of a box that contains it. */
static int make_solid(fl_piece *piece, const fl_coplanar_regions *f, fl_err *err)
{
    const fl_aabb box = fl_part_aabb(f->p);
    const fl_vec3 side_half = v3_scale(0.5, v3_sub(box.hi, box.lo));
    piece->kind = FL_PIECE_SOLID;
    piece->x = v3_scale(0.5, v3_add(box.lo, box.hi));
    if (fl_poly_box(&piece->core, v3_scale(1.5, side_half), err)) return -1;
    for (int32_t r = 0; r < f->regions; r++)
        if (fl_poly_cut(&piece->core, f->region_normal[r],
                        f->region_offset[r] - v3_dot(f->region_normal[r], piece->x), err))
            return -1;
    return 0;
}

/* Makes a plate whose rim is loop[0 .. n) of the part's vertices. Returns 1 if that is convex, else 0. */
static int make_plate_of_loop(fl_piece *piece, const fl_coplanar_regions *f, int32_t n, const int32_t *loop,
                              fl_err *err)
{
    const fl_part *p = f->p;
    const fl_vec3 up = f->region_normal[0];
    const fl_aabb box = fl_part_aabb(p);
    fl_vec3 *rim = fl_alloc(n, sizeof *rim, err);
    int32_t *both = fl_alloc(2 * (int64_t)n, sizeof *both, err), count = n;
    int made = -1;
    if (!rim || !both) goto done;
    piece->kind = FL_PIECE_SOLID;
    piece->x = v3_scale(0.5, v3_add(box.lo, box.hi));
    for (int32_t k = 0; k < n; k++) {
        const fl_vec3 x = p->v[loop[k]];
        /* projected onto the plane */
        rim[k] = v3_madd(v3_sub(x, piece->x), f->region_offset[0] - v3_dot(up, x), up);
    }
    for (int again = 1; again && count > 3;) { /* drop straight corners */
        again = 0;
        for (int32_t k = 0; k < count && count > 3; k++) {
            const fl_vec3 a = rim[(k + count - 1) % count], b = rim[k], c = rim[(k + 1) % count];
            if (v3_norm(v3_cross(v3_sub(b, a), v3_sub(c, a))) > f->tol * v3_norm(v3_sub(c, a))) continue;
            memmove(rim + k, rim + k + 1, (size_t)(count - k - 1) * sizeof *rim);
            count--;
            again = 1;
        }
    }
    for (int32_t k = 0; k < count; k++) both[k] = k, both[2 * count - 1 - k] = k;
    const int32_t first[3] = {0, count, 2 * count};
    fl_err no = {0};
    made = fl_poly_make(&piece->core, count, rim, 2, first, both, &no) == 0;
    if (!made && no.code == FL_SYSTEM) {
        *err = no;
        made = -1;
    }
done:
    free(rim), free(both);
    return made;
}

/* The rim of a flat open part, into loop. Returns its number of vertices, 0 if it is not a single loop. */
static int32_t find_rim(const fl_coplanar_regions *f, int32_t *next, int32_t *loop)
{
    const fl_part *p = f->p;
    int32_t sides = 0, start = -1;
    memset(next, -1, (size_t)p->nv * sizeof *next);
    for (int32_t t = 0; t < p->nt; t++) {
        for (int k = 0; k < 3; k++) {
            if (f->neighbour[3 * t + k] >= 0) continue;
            start = p->t[t].v[k];
            if (next[start] >= 0) return 0; /* two loops meet in a vertex */
            next[start] = p->t[t].v[(k + 1) % 3];
            sides++;
        }
    }
    for (int32_t v = start, k = 0; k < sides; k++, v = next[v]) {
        if (v < 0 || (k > 0 && v == start)) return 0; /* more than one loop */
        loop[k] = v;
    }
    return sides;
}

/* Makes a plate of a flat part that is one convex polygon, by its rim or else by the area it covers. Returns
 * 1, or 0 if it is none. */
static int make_plate(fl_piece *piece, const fl_coplanar_regions *f, fl_err *err)
{
    const fl_part *p = f->p;
    int32_t *next = fl_alloc(p->nv, sizeof *next, err), *loop = fl_alloc(p->nv, sizeof *loop, err), n;
    int made = next && loop ? 0 : -1;
    if (made == 0 && f->regions == 1 && (n = find_rim(f, next, loop)) > 0)
        made = make_plate_of_loop(piece, f, n, loop, err);
    if (made == 0 && (made = fl_region_covers_hull(p, f->region_normal[0], f->tol, loop, &n, err)) > 0)
        made = make_plate_of_loop(piece, f, n, loop, err);
    free(next), free(loop);
    return made;
}

static void mesh_free(fl_piece_mesh *s)
{
    free(s->corner), free(s->box), free(s->edge_box), free(s->concave_face), free(s->saddle);
    free(s->thin), free(s->cone_of_face);
    fl_tile_seams_free(&s->seams);
    fl_bvh_free(&s->tree);
    fl_bvh_free(&s->edge_tree);
}

/* Bent edges at a vertex: their number, and the far ends of the first two. */
typedef struct {
    int32_t n, v[2];
} vertex_bends;

/* Lists the sides where the surface bends or ends, each once, and the bent edges at every vertex. */
static void bent_edges(const fl_coplanar_regions *f, fl_region_side *edge, int32_t *edges, vertex_bends *ends)
{
    const fl_part *p = f->p;
    for (int32_t k = 0; k < 3 * p->nt; k++) {
        const fl_region_side *s = &f->side[k];
        if (k > 0 && s->a == s[-1].a && s->b == s[-1].b) continue;
        int32_t u = -1;
        for (const fl_region_side *o = s; o < f->side + 3 * p->nt && o->a == s->a && o->b == s->b && u < 0;
             o++) {
            u = f->neighbour[3 * o->t + fl_region_side_of(&p->t[o->t], o->a, o->b)];
            if (u >= 0) s = o; /* of three at an edge one of the two that are joined */
        }
        if (f->region[s->t] < 0 || (u >= 0 && f->region[u] == f->region[s->t])) continue;
        edge[(*edges)++] = *s;
        for (int end = 0; end < 2; end++) {
            vertex_bends *at = &ends[end ? s->b : s->a];
            if (at->n < 2) at->v[at->n] = end ? s->a : s->b;
            at->n++;
        }
    }
}

/* True if exactly two bent edges meet at v in one line: v is no corner of the shape. */
static int is_straight(const fl_part *p, const vertex_bends *ends, int32_t v, double tol)
{
    if (ends[v].n != 2) return 0;
    const fl_vec3 a = p->v[ends[v].v[0]], b = p->v[ends[v].v[1]], along = v3_sub(b, a);
    const double length = v3_norm(along);
    return v3_dot(v3_sub(p->v[v], a), v3_sub(b, p->v[v])) > 0.0 &&
           v3_norm(v3_cross(v3_sub(p->v[v], a), along)) <= tol * length;
}

static double triangle_area(const fl_part *p, int32_t t)
{
    const fl_vec3 a = p->v[p->t[t].v[0]], b = p->v[p->t[t].v[1]], c = p->v[p->t[t].v[2]];
    return 0.5 * v3_norm(v3_cross(v3_sub(b, a), v3_sub(c, a)));
}

/* The faces on both sides of the edge a b of triangle t: left where a b runs counter-clockwise round it; -1
 * beyond a rim. */
static fl_edge faces_of_edge(const fl_coplanar_regions *f, const int32_t *face_of, int32_t t, int32_t a,
                             int32_t b)
{
    const fl_tri *tri = &f->p->t[t];
    const int k = fl_region_side_of(tri, a, b);
    const int32_t u = f->neighbour[3 * t + k], one = face_of[t], other = u < 0 ? -1 : face_of[u];
    return tri->v[k] == a ? (fl_edge){a, b, one, other} : (fl_edge){a, b, other, one};
}

/* Lays out the faces of a mesh, convex tiles of its flat regions. The block of a fl_poly is laid out by hand,
 * since fl_poly_make() requires a convex one. */
static int lay_out_mesh(fl_piece *piece, const fl_coplanar_regions *f, const fl_merged_faces *tiles,
                        fl_err *err)
{
    const fl_part *p = f->p;
    const fl_aabb box = fl_part_aabb(p);
    const size_t nv = (size_t)p->nv, nt = (size_t)p->nt, nf = (size_t)tiles->n;
    fl_poly *core = &piece->core;
    fl_piece_mesh *mesh = &piece->mesh;
    const size_t sides = (size_t)tiles->first[nf];
    const size_t bytes = (nv + nf) * sizeof(fl_vec3) + (nf + nv + 3 * nt) * sizeof(double) +
                         3 * nt * sizeof(fl_edge) + (nf + 1 + sides + nv + 1 + 6 * nt) * sizeof(int32_t);
    char *mem = fl_alloc((int64_t)bytes, 1, err);
    piece->kind = FL_PIECE_MESH;
    piece->x = v3_scale(0.5, v3_add(box.lo, box.hi));
    core->v = (fl_vec3 *)mem;
    mesh->corner = fl_alloc(p->nv, sizeof *mesh->corner, err);
    mesh->box = fl_alloc(tiles->n, sizeof *mesh->box, err);
    mesh->edge_box = fl_alloc(3 * (int64_t)p->nt, sizeof *mesh->edge_box, err);
    if (!mem || !mesh->corner || !mesh->box || !mesh->edge_box) return -1;
    core->n = core->v + nv;
    core->c = (double *)(core->n + nf);
    core->bend = core->c + nf;
    core->defect = core->bend + 3 * nt;
    core->edge = (fl_edge *)(core->defect + nv);
    core->first = (int32_t *)(core->edge + 3 * nt);
    core->loop = core->first + nf + 1;
    core->neighbour_first = core->loop + sides;
    core->neighbour = core->neighbour_first + nv + 1;
    core->nv = p->nv;
    core->nf = tiles->n;
    core->size = fmax(box.hi.x - box.lo.x, fmax(box.hi.y - box.lo.y, box.hi.z - box.lo.z));
    for (int32_t v = 0; v < p->nv; v++) core->v[v] = v3_sub(p->v[v], piece->x);
    memcpy(core->first, tiles->first, (nf + 1) * sizeof *core->first);
    memcpy(core->loop, tiles->loop, sides * sizeof *core->loop);
    for (int32_t t = 0; t < p->nt; t++) {
        if (f->region[t] < 0) continue; /* no area */
        const double area = f->area[f->region[t]] += triangle_area(p, t);
        if (area > piece->largest_region_area) piece->largest_region_area = area;
    }
    for (int32_t r = 0; r < core->nf; r++) {
        const int32_t region = tiles->region[r];
        mesh->box[r] = aabb_empty();
        for (int32_t k = core->first[r]; k < core->first[r + 1]; k++)
            mesh->box[r] = aabb_add(mesh->box[r], core->v[core->loop[k]]);
        core->n[r] = f->region_normal[region];
        core->c[r] = f->region_offset[region] - v3_dot(core->n[r], piece->x);
    }
    return 0;
}

/* Sides of triangles at borders between flat regions, by their first vertex. */
typedef struct {
    int32_t *begin; /* [nv + 1] */
    int32_t *side;  /* 3 triangle + side */
} region_borders;

static int find_borders(region_borders *s, const fl_coplanar_regions *f, fl_err *err)
{
    const fl_part *p = f->p;
    s->begin = fl_alloc((int64_t)p->nv + 2, sizeof *s->begin, err);
    s->side = fl_alloc(3 * (int64_t)p->nt, sizeof *s->side, err);
    if (!s->begin || !s->side) return -1;
    memset(s->begin, 0, ((size_t)p->nv + 2) * sizeof *s->begin);
    for (int fill = 0; fill < 2; fill++) {
        for (int32_t k = 0; k < 3 * p->nt; k++) {
            const int32_t t = k / 3, u = f->neighbour[k], from = p->t[t].v[k % 3];
            if (u < 0 || f->region[t] < 0 || f->region[u] < 0 || f->region[u] == f->region[t]) continue;
            if (fill) s->side[s->begin[from + 1]++] = k;
            else s->begin[from + 2]++;
        }
        for (int32_t v = 0; v <= p->nv && !fill; v++) s->begin[v + 1] += s->begin[v];
    }
    return 0;
}

/* The tile across the side from a to b of a tile of this region; -1 if there is none, or several that are not
 * of one plane. */
static int32_t tile_across(const region_borders *s, const fl_coplanar_regions *f,
                           const fl_merged_faces *tiles, int32_t region, int32_t a, int32_t b)
{
    const fl_part *p = f->p;
    const fl_vec3 way = v3_sub(p->v[b], p->v[a]);
    int32_t over = -1, v = a;
    while (v != b) {
        int32_t next = -1;
        for (int32_t k = s->begin[v]; k < s->begin[v + 1] && next < 0; k++) {
            const int32_t t = s->side[k] / 3, w = p->t[t].v[(s->side[k] + 1) % 3],
                          u = f->neighbour[s->side[k]];
            const fl_vec3 on = v3_sub(p->v[w], p->v[v]);
            if (f->region[t] != region || !(v3_dot(on, way) > 0.0) ||
                v3_norm(v3_cross(v3_sub(p->v[w], p->v[a]), way)) > 2.0 * f->tol * v3_norm(way))
                continue;
            if (over >= 0 && tiles->region[over] != f->region[u]) return -1;
            if (over < 0) over = tiles->face_of_tri[u];
            next = w;
        }
        if (next < 0) return -1;
        v = next;
    }
    return over;
}

/* cosine of the bend of a concave edge: sharper inner corners have independent walls */
#define MIN_CONCAVE_COSINE 0.5

static int find_concave_faces(fl_piece *piece, const fl_coplanar_regions *f, const fl_merged_faces *tiles,
                              fl_err *err)
{
    fl_poly *core = &piece->core;
    region_borders s = {0};
    int rc = -1;
    piece->mesh.concave_face = fl_alloc(core->first[core->nf], sizeof *piece->mesh.concave_face, err);
    if (piece->mesh.concave_face && find_borders(&s, f, err) == 0) {
        for (int32_t r = 0; r < core->nf; r++) {
            for (int32_t k = core->first[r]; k < core->first[r + 1]; k++) {
                const int32_t a = core->loop[k],
                              b = core->loop[k + 1 < core->first[r + 1] ? k + 1 : core->first[r]];
                const int32_t g = tile_across(&s, f, tiles, tiles->region[r], a, b);
                const fl_vec3 u = v3_sub(core->v[b], core->v[a]);
                const int concave = g >= 0 && v3_dot(core->n[r], core->n[g]) > MIN_CONCAVE_COSINE &&
                                    v3_dot(v3_cross(core->n[r], core->n[g]), u) < 0.0;
                piece->mesh.concave_face[k] = concave ? g : -1;
            }
        }
        core->concave_face = piece->mesh.concave_face;
        rc = 0;
    }
    free(s.begin), free(s.side);
    return rc;
}

/* Marks convex edges at vertices where the surface is concave too, or where a rim lies within it. */
static int find_saddles(fl_piece *piece, fl_err *err)
{
    fl_poly *p = &piece->core;
    uint8_t *hollow = fl_alloc(p->nv, 1, err);
    piece->mesh.saddle = p->saddle = fl_alloc(p->neighbour_first[p->nv], 1, err);
    if (!hollow || !p->saddle) {
        free(hollow);
        return -1;
    }
    for (int32_t e = 0; e < p->ne; e++) {
        const int32_t end[2] = {p->edge[e].a, p->edge[e].b};
        const int rim = p->edge[e].left < 0 || p->edge[e].right < 0;
        for (int k = 0; k < 2; k++) hollow[end[k]] |= p->bend[e] < 0.0 || (rim && p->defect[end[k]] < PI);
    }
    for (int32_t e = 0; e < p->ne; e++) {
        const int32_t end[2] = {p->edge[e].a, p->edge[e].b};
        for (int k = 0; k < 2 && p->bend[e] > 0.0; k++)
            for (int32_t at = p->neighbour_first[end[k]];
                 hollow[end[k]] && at < p->neighbour_first[end[k] + 1]; at++)
                if (p->neighbour[at] == end[1 - k]) p->saddle[at] = 1;
    }
    free(hollow);
    return 0;
}

/* Marks the faces of sheets with two sides and of cones; of: of triangles, or NULL. */
static int mark_joined(fl_piece *piece, const fl_merged_faces *tiles, int32_t nt,
                       const fl_joined_triangle *of, fl_err *err)
{
    fl_piece_mesh *mesh = &piece->mesh;
    int thin = 0, cones = 0;
    for (int32_t t = 0; of && t < nt; t++) thin |= of[t].thin, cones |= of[t].cone >= 0;
    if (thin && !(mesh->thin = fl_alloc(tiles->n, 1, err))) return -1;
    if (cones && !(mesh->cone_of_face = fl_alloc(tiles->n, sizeof *mesh->cone_of_face, err))) return -1;
    for (int32_t f = 0; cones && f < tiles->n; f++) mesh->cone_of_face[f] = INT32_MAX;
    for (int32_t t = 0; of && t < nt; t++) {
        const int32_t f = tiles->face_of_tri[t];
        if (f >= 0 && of[t].thin) mesh->thin[f] = 1;
        if (f < 0 || !cones) continue;
        int32_t *cone = &mesh->cone_of_face[f]; /* of one cone as a whole, or of none */
        *cone = *cone == INT32_MAX || *cone == of[t].cone ? of[t].cone : -1;
    }
    for (int32_t f = 0; cones && f < tiles->n; f++) /* one of several that a wide face was cut into */
        if (mesh->cone_of_face[f] == INT32_MAX) mesh->cone_of_face[f] = -1;
    return 0;
}

static int make_mesh(fl_piece *piece, const fl_coplanar_regions *f, const fl_joined_triangle *of, fl_err *err)
{
    const fl_part *p = f->p;
    fl_poly *core = &piece->core;
    fl_piece_mesh *mesh = &piece->mesh;
    fl_merged_faces tiles = {0};
    fl_region_side *edge = fl_alloc(3 * (int64_t)p->nt, sizeof *edge, err);
    vertex_bends *ends = fl_alloc(p->nv, sizeof *ends, err);
    int32_t edges = 0;
    int rc = -1;
    if (!edge || !ends ||
        fl_merge_coplanar(&tiles, p->nv, p->v, p->nt, p->t, f->region, f->region_normal, f->neighbour, f->tol,
                          err) ||
        lay_out_mesh(piece, f, &tiles, err) || find_concave_faces(piece, f, &tiles, err) ||
        mark_joined(piece, &tiles, p->nt, of, err))
        goto done;
    bent_edges(f, edge, &edges, ends);
    for (int32_t k = 0; k < edges; k++) { /* every straight run once, from its lower end */
        if (is_straight(p, ends, edge[k].a, f->tol) && is_straight(p, ends, edge[k].b, f->tol)) continue;
        for (int turn = 0; turn < 2; turn++) {
            const int32_t from = turn ? edge[k].b : edge[k].a;
            int32_t last = from, to = turn ? edge[k].a : edge[k].b;
            const fl_edge sides = faces_of_edge(f, tiles.face_of_tri, edge[k].t, from, to);
            if (is_straight(p, ends, from, f->tol)) continue;
            while (is_straight(p, ends, to, f->tol)) {
                const int32_t next = ends[to].v[0] == last ? ends[to].v[1] : ends[to].v[0];
                last = to;
                to = next;
            }
            if (from > to) continue;
            core->edge[core->ne] = (fl_edge){from, to, sides.left, sides.right};
            mesh->edge_box[core->ne++] = aabb_add((fl_aabb){core->v[from], core->v[from]}, core->v[to]);
        }
    }
    for (int32_t v = 0; v < p->nv; v++)
        if (ends[v].n && !is_straight(p, ends, v, f->tol)) mesh->corner[mesh->corners++] = v;
    fl_poly_angles(core);
    for (int32_t v = 0; v < p->nv; v++) core->defect[v] -= PI * tiles.straight_corners[v];
    rc = find_saddles(piece, err) || fl_bvh_build(&mesh->tree, mesh->box, core->nf, err) ||
                 fl_bvh_build(&mesh->edge_tree, mesh->edge_box, core->ne, err)
             ? -1
             : 0;
done:
    free(edge), free(ends);
    fl_merged_faces_free(&tiles);
    return rc;
}

/* Rejects inconsistent orientation: a wall would push both ways. */
static int check_orientation(const fl_coplanar_regions *f, fl_err *err)
{
    const fl_part *p = f->p;
    const int rows = p->line > 0 && p->last_line - p->line == p->nt - 1; /* one after another in the file */
    const int32_t first = rows ? p->line : 0;
    if (f->misoriented[0] < 0) return 0;
    return fl_fail(err, FL_INPUT,
                   "part %s: its triangles %s%d and %d share an edge and face different ways: struct-import "
                   "orients them",
                   p->name, rows ? "of lines " : "", first + f->misoriented[0], first + f->misoriented[1]);
}

/* Six times the volume that triangle t encloses with o. */
static double six_volumes(const fl_part *p, int32_t t, fl_vec3 o)
{
    const int32_t *v = p->t[t].v;
    return v3_dot(v3_sub(p->v[v[0]], o),
                  v3_cross(v3_sub(p->v[v[1]], p->v[v[0]]), v3_sub(p->v[v[2]], p->v[v[0]])));
}

/* Finds a connected body of a closed surface with a negative volume, as of a cavity or of a mesh inside out:
 * 1 + its first triangle, or 0. Returns -1 with FL_SYSTEM. */
static int32_t find_inward_body(const fl_coplanar_regions *f, fl_err *err)
{
    const fl_part *p = f->p;
    int32_t inward = 0;
    uint8_t *seen = fl_alloc(p->nt, 1, err);
    if (!seen) return -1;
    for (int32_t t = 0; t < p->nt && !inward; t++) {
        const fl_vec3 o = p->v[p->t[t].v[0]];
        double volume = 0.0;
        int32_t tail = 0;
        if (!seen[t]) seen[f->queue[tail++] = t] = 1;
        for (int32_t head = 0; head < tail; head++) {
            const int32_t u = f->queue[head];
            volume += six_volumes(p, u, o);
            for (int k = 0; k < 3; k++) {
                const int32_t next = f->neighbour[3 * u + k];
                if (!seen[next]) seen[f->queue[tail++] = next] = 1;
            }
        }
        if (volume < 0.0) inward = 1 + t;
    }
    free(seen);
    return inward;
}

/* A mesh without a rim, and whether it is solid inside or, as a tank, outside. */
static void find_solid_side(fl_piece *piece, const fl_part *p)
{
    fl_piece_mesh *mesh = &piece->mesh;
    double volume = 0.0;
    mesh->closed = 1;
    for (int32_t e = 0; e < piece->core.ne; e++)
        if (piece->core.edge[e].left < 0 || piece->core.edge[e].right < 0) mesh->closed = 0;
    for (int32_t t = 0; t < p->nt; t++) volume += six_volumes(p, t, piece->x);
    mesh->outer_winding = volume < 0.0 && !mesh->thin ? -1.0 : 0.0; /* sheets have no volume but rounding */
}

/* Makes the piece of the triangles; of: NULL, or as in fl_structure_add_joined().  0, or -1. */
static int make_piece(fl_piece *piece, const fl_part *p, const fl_joined_triangle *of, fl_err *err)
{
    fl_coplanar_regions f = {0};
    int rc = -1, plate = 0;
    if (fl_coplanar_regions_find(&f, p, err)) goto done;
    const int flat = f.regions == 1 || fl_region_is_flat(p, f.region_normal[0], f.region_offset[0], f.tol);
    if (flat) plate = make_plate(piece, &f, err);
    if (plate) rc = plate < 0 ? -1 : 0;
    else if (check_orientation(&f, err)) goto done;
    else rc = f.closed && !flat && is_convex(&f) ? make_solid(piece, &f, err) : make_mesh(piece, &f, of, err);
    piece->one_sided = flat && !plate && !piece->mesh.thin;
    if (rc == 0 && piece->kind == FL_PIECE_MESH) find_solid_side(piece, p);
    if (rc == 0 && f.closed && piece->kind == FL_PIECE_MESH && !of &&
        (piece->inward_triangle = find_inward_body(&f, err)) < 0)
        rc = -1;
done:
    fl_coplanar_regions_free(&f);
    return rc;
}

static int add_triangles(fl_structure *s, const fl_part *p, int32_t part, fl_err *err)
{
    fl_piece *piece = add_piece(s, err);
    if (!piece) return -1;
    s->n++;
    piece->part = part;
    return make_piece(piece, p, NULL, err);
}

int fl_structure_add_joined(fl_structure *s, const fl_part *p, const fl_joined_triangle *of, int32_t part,
                            fl_err *err)
{
    fl_piece *piece = add_piece(s, err);
    if (!piece) return -1;
    piece->part = part;
    if (make_piece(piece, p, of, err)) {
        fl_piece_free(piece);
        return -1;
    }
    s->n++;
    return 0;
}

int fl_cone_piece(fl_piece *piece, const fl_cone *c, fl_err *err)
{
    const int n = FL_CONE_SIDES;
    /* corners at this radius give the polygon the area of the circle */
    const double fit = sqrt(2.0 * PI / n / sin(2.0 * PI / n));
    const fl_vec3 along = v3_sub(c->p1, c->p0), z = v3_unit(along), x = v3_normal_to(z), y = v3_cross(z, x);
    const int point0 = c->r0 == 0.0, point1 = c->r1 == 0.0;
    fl_vec3 v[2 * FL_CONE_SIDES];
    int32_t first[FL_CONE_SIDES + 3] = {0}, loop[6 * FL_CONE_SIDES], nf = 0, nv = 0, k = 0;
    piece->kind = FL_PIECE_CONE;
    piece->x = c->p0;
    piece->q = q_of_matrix((fl_mat3){{{x.x, y.x, z.x}, {x.y, y.y, z.y}, {x.z, y.z, z.z}}});
    piece->r0 = c->r0, piece->r1 = c->r1, piece->h = v3_norm(along);
    const int32_t low = 0, high = point0 ? 1 : n; /* first vertex of each end */
    for (int j = 0; j < (point0 ? 1 : n); j++)
        v[nv++] = v3(fit * c->r0 * cos(2 * PI * j / n), fit * c->r0 * sin(2 * PI * j / n), 0.0);
    for (int j = 0; j < (point1 ? 1 : n); j++)
        v[nv++] = v3(fit * c->r1 * cos(2 * PI * j / n), fit * c->r1 * sin(2 * PI * j / n), piece->h);
    if (!point0) {
        for (int j = 0; j < n; j++) loop[k++] = low + n - 1 - j;
        first[++nf] = k;
    }
    if (!point1) {
        for (int j = 0; j < n; j++) loop[k++] = high + j;
        first[++nf] = k;
    }
    for (int j = 0; j < n; j++) {
        const int i = (j + 1) % n;
        loop[k++] = point0 ? low : low + j;
        if (!point0) loop[k++] = low + i;
        loop[k++] = point1 ? high : high + i;
        if (!point1) loop[k++] = high + j;
        first[++nf] = k;
    }
    return fl_poly_make(&piece->core, nv, v, nf, first, loop, err);
}

static int add_cone(fl_structure *s, const fl_cone *c, int32_t part, int32_t index, fl_err *err)
{
    fl_piece *piece = add_piece(s, err);
    if (!piece) return -1;
    s->n++;
    piece->part = part;
    piece->cone = index;
    return fl_cone_piece(piece, c, err);
}

int fl_structure_prepare_spheres(fl_structure *s, fl_err *err)
{
    for (int32_t k = 0; k < s->n; k++) {
        fl_piece *p = &s->piece[k];
        if (p->kind == FL_PIECE_MESH &&
            fl_tile_seams_make(&p->mesh.seams, &p->core, &p->mesh.tree, p->mesh.box, err))
            return -1;
    }
    return 0;
}

int fl_structure_build(fl_structure *s, const fl_surface *surface, fl_err *err)
{
    for (int32_t k = 0; k < surface->n; k++) {
        const fl_part *p = &surface->part[k];
        if (p->nt && add_triangles(s, p, k, err)) return -1;
        for (int32_t c = 0; c < p->nc; c++)
            if (add_cone(s, &p->cone[c], k, c, err)) return -1;
    }
    return 0;
}

void fl_piece_free(fl_piece *p)
{
    fl_poly_free(&p->core);
    mesh_free(&p->mesh);
    for (int32_t k = 0; k < p->cones; k++) free(p->free_cone[k].free);
    free(p->member), free(p->free_cone);
    *p = (fl_piece){0};
}

fl_aabb fl_piece_face_box(const fl_piece *p, int32_t f)
{
    fl_aabb box = aabb_empty();
    for (int32_t k = p->core.first[f]; k < p->core.first[f + 1]; k++)
        box = aabb_add(box, v3_add(p->x, q_rotate(p->q, p->core.v[p->core.loop[k]])));
    return box;
}

fl_aabb fl_piece_box(const fl_piece *p)
{
    fl_aabb box = aabb_empty();
    for (int32_t f = 0; f < p->core.nf; f++) box = aabb_join(box, fl_piece_face_box(p, f));
    return box;
}

void fl_structure_free(fl_structure *s)
{
    for (int32_t k = 0; k < s->n; k++) fl_piece_free(&s->piece[k]);
    free(s->piece);
    *s = (fl_structure){0};
}
