/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "geom/facet.h"
#include "mesh/face_groups.h"
#include "mesh/skin.h"

int fl_skin_start(fl_skin *k, const fl_elements *e, const fl_import_options *opt, fl_err *err)
{
    const int32_t n = e->element_id.n, targets = e->parts.n + e->sets.n;
    *k = (fl_skin){.e = e, .subdivide = opt && opt->subdivide, .by_name = fl_import_by_name(opt)};
    if (!(k->target = fl_alloc(n, sizeof *k->target, err)) || !(k->reversed = fl_alloc(n, 1, err)) ||
        !(k->outer_faces = fl_alloc(n, 1, err)) || !(k->picked_faces = fl_alloc(n, 1, err)) ||
        !(k->duplicate_faces = fl_alloc(n, 1, err)) || !(k->dropped = fl_alloc(n, 1, err)) ||
        !(k->dropped_of = fl_alloc(targets, sizeof *k->dropped_of, err)) ||
        !(k->owner = fl_alloc(e->node_id.n, sizeof *k->owner, err)) ||
        !(k->local = fl_alloc(e->node_id.n, sizeof *k->local, err)))
        return -1;
    for (int32_t i = 0; i < n; i++) k->target[i] = -1;
    return 0;
}

void fl_skin_free(fl_skin *k)
{
    free(k->target);
    free(k->reversed);
    free(k->outer_faces);
    free(k->free_faces);
    free(k->picked_faces);
    free(k->duplicate_faces);
    free(k->dropped);
    free(k->dropped_of);
    free(k->pick);
    free(k->owner);
    free(k->local);
    fl_id_map_free(&k->edge);
    free(k->edge_mid);
    fl_part_free(&k->pool);
    *k = (fl_skin){0};
}

int fl_group_by_target(int32_t n, int32_t targets, const int32_t *target, int stride, int32_t **first,
                       int32_t **list, fl_err *err)
{
    *first = fl_alloc((int64_t)targets + 1, sizeof **first, err);
    *list = *first ? fl_alloc(n, sizeof **list, err) : NULL;
    if (!*list) return -1;
    for (int32_t i = 0; i < n; i++)
        if (target[(int64_t)i * stride] >= 0) (*first)[target[(int64_t)i * stride]]++;
    for (int32_t t = 1; t <= targets; t++) (*first)[t] += (*first)[t - 1];
    for (int32_t i = n; i-- > 0;)
        if (target[(int64_t)i * stride] >= 0) (*list)[--(*first)[target[(int64_t)i * stride]]] = i;
    return 0;
}

int fl_skin_pick(fl_skin *k, const fl_pick *p, int32_t target, fl_err *err)
{
    const int faces = fl_shape_faces((enum fl_shape)k->e->element[p->element].shape);
    int32_t c[4];
    if (faces == 0) return 0;
    if (p->face == FL_PICK_FREE && !k->free_faces) {
        k->free_faces = fl_alloc(k->e->element_id.n, 1, err);
        if (!k->free_faces || fl_mark_free_faces(k->e, k->free_faces, err)) return -1;
    }
    for (int f = 0; f < faces; f++) {
        const int bit = 1 << f;
        const int asked = p->face == FL_PICK_FREE ? k->free_faces[p->element] & bit : p->face == f;
        if (!asked || k->picked_faces[p->element] & bit || fl_face_corner_nodes(k->e, p->element, f, c) < 3)
            continue;
        if (fl_grow(&k->pick, &k->pick_cap, (int64_t)k->picks + 1, sizeof *k->pick, err)) return -1;
        k->pick[k->picks++] = (fl_skin_face){target, p->element, (int8_t)f};
        k->picked_faces[p->element] = (uint8_t)(k->picked_faces[p->element] | bit);
    }
    return 0;
}

/* --- faces to triangles --------------------------------------------------------------------------------- */

/* Edges of a shape as pairs of digits, in the order of its mid-side nodes. */
static const char *mid_edges(enum fl_shape shape)
{
    switch (shape) {
    case FL_TRI6: return "011220";
    case FL_QUAD8:
    case FL_QUAD9: return "01122330";
    case FL_TET10: return "011220031323";
    case FL_PYRAMID13: return "0112233004142434";
    case FL_WEDGE15: return "011220344553031425";
    case FL_HEX20: return "011223304556677404152637";
    default: return "";
    }
}

/* The boundary of a face: corners, and the node between each and the next, -1 for none. */
typedef struct {
    int n;
    int32_t corner[4], mid[4], centre;
} face_ring;

static int32_t mid_node(const fl_elements *e, const fl_element *el, int a, int b)
{
    const char *p = mid_edges((enum fl_shape)el->shape);
    for (int k = fl_shape_corners((enum fl_shape)el->shape); *p; p += 2, k++)
        if ((p[0] - '0' == a && p[1] - '0' == b) || (p[0] - '0' == b && p[1] - '0' == a))
            return e->connectivity[el->first + k];
    return -1;
}

/* The edge between two nodes as a key of k->edge. */
static int64_t edge_key(int32_t a, int32_t b) { return a < b ? b : a; }

/* Record the mid-side node of each edge, if some elements omit theirs: a face whose element omits it gets
 * that of its neighbour, or the surface would gape along the edge. */
static int record_mids(fl_skin *k, fl_err *err)
{
    const fl_elements *e = k->e;
    int omitted = 0;
    for (int32_t i = 0; i < e->connectivity_n; i++) omitted |= e->connectivity[i] < 0;
    if (!k->subdivide || !omitted) return 0;
    for (int32_t i = 0; i < e->element_id.n; i++) {
        const fl_element *el = &e->element[i];
        const int32_t *node = e->connectivity + el->first;
        const char *p = mid_edges((enum fl_shape)el->shape);
        for (int m = fl_shape_corners((enum fl_shape)el->shape); *p; p += 2, m++) {
            const int32_t a = node[p[0] - '0'], b = node[p[1] - '0'], had = k->edge.n;
            int32_t at;
            if (node[m] < 0 || a == b) continue;
            at = fl_id_map_add(&k->edge, a < b ? a : b, edge_key(a, b), err);
            if (at < 0 || fl_grow(&k->edge_mid, &k->edge_cap, k->edge.n, sizeof *k->edge_mid, err)) return -1;
            if (at >= had) k->edge_mid[at] = node[m];
        }
    }
    return 0;
}

/* Complete the ring by the mid-side nodes of neighbours.  A node in the middle of two edges is in none. */
static void complete_mids(const fl_skin *k, face_ring *r)
{
    for (int i = 0; i < r->n; i++) {
        const int32_t a = r->corner[i], b = r->corner[(i + 1) % r->n];
        const int32_t at =
            r->mid[i] < 0 && k->edge.n ? fl_id_map_find(&k->edge, a < b ? a : b, edge_key(a, b)) : -1;
        if (at >= 0) r->mid[i] = k->edge_mid[at];
    }
    for (int i = 1; i < r->n; i++)
        for (int j = 0; j < i; j++)
            if (r->mid[i] >= 0 && r->mid[i] == r->mid[j]) r->mid[i] = r->mid[j] = -1;
}

/* The boundary of a face of a solid, or of a shell (face < 0), in the order of the element.  Repeated corners
 * are dropped together with the edge between them. */
static face_ring ring_of(const fl_elements *e, const fl_element *el, int face)
{
    const enum fl_shape shape = (enum fl_shape)el->shape;
    int place[4] = {0, 1, 2, 3}, n = fl_shape_corners(shape);
    face_ring r = {0, {0}, {0}, -1};
    if (face >= 0) n = fl_shape_face(shape, face, place);
    for (int i = 0; i < n; i++) {
        const int a = place[i], b = place[(i + 1) % n];
        if (e->connectivity[el->first + a] == e->connectivity[el->first + b]) continue;
        r.corner[r.n] = e->connectivity[el->first + a];
        r.mid[r.n++] = mid_node(e, el, a, b);
    }
    if (shape == FL_QUAD9 && r.n == 4) r.centre = e->connectivity[el->first + 8];
    return r;
}

static void reverse_ring(face_ring *r)
{
    const face_ring old = *r;
    for (int i = 0; i < r->n; i++) {
        r->corner[i] = old.corner[r->n - 1 - i];
        r->mid[i] = old.mid[(2 * r->n - 2 - i) % r->n];
    }
}

/* Get the vertex of a node in the part of this target, which is added if new. */
static int add_vertex(fl_skin *k, fl_part *p, int32_t target, int32_t node, int32_t *v, fl_err *err)
{
    if (k->owner[node] != target + 1) {
        k->owner[node] = target + 1;
        k->local[node] = p->nv;
        if (fl_surface_vertex(p, k->e->x[node], err)) return -1;
    }
    *v = k->local[node];
    return 0;
}

static int node_precedes(const fl_elements *e, int32_t a, int32_t b)
{
    if (e->node_id.scope[a] != e->node_id.scope[b]) return e->node_id.scope[a] < e->node_id.scope[b];
    return e->node_id.id[a] < e->node_id.id[b];
}

/* Add a polygon of up to 8 nodes.  Node numbers of the file decide ties of the triangulation, from the lowest
 * on, so the result does not depend on the orientation of the element. */
static int add_polygon(fl_skin *k, fl_part *p, int32_t target, int n, const int32_t *node, fl_err *err)
{
    int32_t sorted[8], loop[8] = {0}, v[8];
    int low = 0;
    if (n == 3) { /* no triangulation needed */
        if (node[0] == node[1] || node[1] == node[2] || node[2] == node[0]) return 0;
        for (int i = 1; i < 3; i++)
            if (node_precedes(k->e, node[i], node[low])) low = i;
        for (int i = 0; i < 3; i++)
            if (add_vertex(k, p, target, node[(low + i) % 3], &v[i], err)) return -1;
        return fl_surface_triangle(p, v[0], v[1], v[2], err);
    }
    for (int i = 0; i < n; i++) {
        int at = i;
        for (; at > 0 && node_precedes(k->e, node[i], sorted[at - 1]); at--) sorted[at] = sorted[at - 1];
        sorted[at] = node[i];
        if (node_precedes(k->e, node[i], node[low])) low = i;
    }
    k->pool.nv = k->pool.nt = 0;
    for (int i = 0; i < n; i++)
        if (fl_surface_vertex(&k->pool, k->e->x[sorted[i]], err)) return -1;
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++)
            if (sorted[j] == node[(low + i) % n]) loop[i] = j;
    if (fl_facet_polygon(&k->pool, n, loop, err)) return -1;
    for (int i = 0; i < n; i++)
        if (add_vertex(k, p, target, node[(low + i) % n], &v[loop[i]], err)) return -1;
    for (int32_t t = 0; t < k->pool.nt; t++) {
        const int32_t *c = k->pool.t[t].v;
        if (fl_surface_triangle(p, v[c[0]], v[c[1]], v[c[2]], err)) return -1;
    }
    return 0;
}

/* Split a quadratic face: a triangle at each corner and the rest in the middle, or quadrilaterals around the
 * centre.  If a mid-side node is omitted, the face is one polygon through the nodes it has. */
static int add_quadratic(fl_skin *k, fl_part *p, int32_t target, const face_ring *r, fl_err *err)
{
    int32_t loop[8];
    int n = 0, mids = 0;
    for (int i = 0; i < r->n; i++) {
        loop[n++] = r->corner[i];
        if (r->mid[i] < 0) continue;
        loop[n++] = r->mid[i];
        mids++;
    }
    if (mids < r->n) return add_polygon(k, p, target, n, loop, err);
    for (int i = 0; i < r->n; i++) {
        const int32_t last = r->mid[(i + r->n - 1) % r->n];
        const int32_t piece[4] = {r->corner[i], r->mid[i], r->centre >= 0 ? r->centre : last, last};
        if (add_polygon(k, p, target, r->centre >= 0 ? 4 : 3, piece, err)) return -1;
    }
    return r->centre >= 0 ? 0 : add_polygon(k, p, target, r->n, r->mid, err);
}

static int check_defined(const fl_elements *e, const fl_element *el, int32_t node, fl_err *err)
{
    if (node < 0 || !isnan(e->x[node].x)) return 0;
    return fl_elements_fail(e, el->file, el->line, err,
                            "the element refers to node %lld, which is not defined",
                            (long long)e->node_id.id[node]);
}

/* Distance of x from the line through a and b. */
static double chord_distance(fl_vec3 a, fl_vec3 b, fl_vec3 x)
{
    const fl_vec3 d = v3_sub(x, a), along = v3_unit(v3_sub(b, a));
    return v3_norm(v3_madd(d, -v3_dot(d, along), along));
}

/* Add a face (of a shell if face < 0), reversed or not. */
static int add_face(fl_skin *k, fl_part *p, int32_t target, int32_t element, int face, int turn, fl_err *err)
{
    const fl_elements *e = k->e;
    const fl_element *el = &e->element[element];
    face_ring r = ring_of(e, el, face);
    int mids = 0;
    if (r.n < 3) return 0;
    complete_mids(k, &r);
    if (turn) reverse_ring(&r);
    for (int i = 0; i < r.n; i++) {
        if (check_defined(e, el, r.corner[i], err) || check_defined(e, el, r.mid[i], err)) return -1;
        mids += r.mid[i] >= 0;
    }
    if (check_defined(e, el, r.centre, err)) return -1;
    if (mids && k->subdivide) return add_quadratic(k, p, target, &r, err);
    for (int i = 0; i < r.n; i++)
        if (r.mid[i] >= 0)
            k->sagitta = fmax(
                k->sagitta, chord_distance(e->x[r.corner[i]], e->x[r.corner[(i + 1) % r.n]], e->x[r.mid[i]]));
    k->curved += mids > 0;
    return add_polygon(k, p, target, r.n, r.corner, err);
}

/* Six times the volume of a solid, summed over its faces as listed, about its first corner.  Negative if the
 * faces wind inward, as they do in a right-handed element. */
static double signed_volume(const fl_elements *e, const fl_element *el)
{
    const fl_vec3 o = e->x[e->connectivity[el->first]];
    double sum = 0.0;
    for (int f = 0; f < fl_shape_faces((enum fl_shape)el->shape); f++) {
        const face_ring r = ring_of(e, el, f);
        fl_vec3 area = {0}, mean = {0};
        fl_vec3 x[4];
        if (r.n < 3) continue;
        for (int i = 0; i < r.n; i++) {
            x[i] = v3_sub(e->x[r.corner[i]], o);
            mean = v3_madd(mean, 1.0 / r.n, x[i]);
        }
        for (int i = 1; i + 1 < r.n; i++)
            area = v3_add(area, v3_cross(v3_sub(x[i], x[0]), v3_sub(x[i + 1], x[0])));
        sum += v3_dot(mean, area);
    }
    return sum;
}

/* Set *turn to 1 if the faces of a solid must be reversed to point outward. */
static int check_orientation(fl_skin *k, int32_t element, int *turn, fl_err *err)
{
    const fl_element *el = &k->e->element[element];
    double v;
    for (int i = 0; i < fl_shape_corners((enum fl_shape)el->shape); i++)
        if (check_defined(k->e, el, k->e->connectivity[el->first + i], err)) return -1;
    v = signed_volume(k->e, el);
    *turn = !(v > 0.0); /* without volume, treated as right-handed */
    if (!(k->picked_faces[element] & FL_SKIN_COUNTED)) {
        k->zero_volume += !(v > 0.0) && !(v < 0.0);
        k->left_handed += v > 0.0;
        k->picked_faces[element] |= FL_SKIN_COUNTED;
    }
    return 0;
}

static int add_solid(fl_skin *k, fl_part *p, int32_t target, int32_t element, int faces, fl_err *err)
{
    int turn = 0;
    if (check_orientation(k, element, &turn, err)) return -1;
    for (int f = 0; f < faces; f++)
        if (k->outer_faces[element] >> f & 1 && !(k->picked_faces[element] >> f & 1) &&
            add_face(k, p, target, element, f, turn, err))
            return -1;
    return 0;
}

/* Add a line with its radii; a line of three nodes becomes two cones when it is subdivided. */
static int add_line(fl_skin *k, fl_part *p, int32_t element, fl_err *err)
{
    const fl_elements *e = k->e;
    const fl_element *el = &e->element[element];
    const int32_t a = e->connectivity[el->first], b = e->connectivity[el->first + 1];
    const int32_t m = el->shape == FL_LINE3 ? e->connectivity[el->first + 2] : -1;
    const double *r = el->section >= 0 ? e->section[el->section] : NULL;
    fl_cone half[2];
    int n = 1;
    if (check_defined(e, el, a, err) || check_defined(e, el, b, err) || check_defined(e, el, m, err))
        return -1;
    half[0] = (fl_cone){e->x[a], e->x[b], r ? r[0] : 0.0, r ? r[1] : 0.0};
    if (m >= 0 && k->subdivide) {
        half[1] = (fl_cone){e->x[m], e->x[b], 0.5 * (half[0].r0 + half[0].r1), half[0].r1};
        half[0].p1 = half[1].p0;
        half[0].r1 = half[1].r0;
        n = 2;
    } else if (m >= 0 && r) {
        k->sagitta = fmax(k->sagitta, chord_distance(e->x[a], e->x[b], e->x[m]));
        k->curved++;
    }
    for (int i = 0; i < n; i++) {
        const double length = v3_norm(v3_sub(half[i].p1, half[i].p0));
        if (!(half[i].r0 + half[i].r1 > 0.0) || !(length > 0.0)) k->lines_without_radius++;
        else if (fl_surface_cone(p, half[i], err)) return -1;
    }
    return 0;
}

static int add_element(fl_skin *k, fl_part *p, int32_t target, int32_t element, fl_err *err)
{
    const enum fl_shape shape = (enum fl_shape)k->e->element[element].shape;
    const int faces = fl_shape_faces(shape);
    if (faces) return add_solid(k, p, target, element, faces, err);
    if (shape == FL_LINE2 || shape == FL_LINE3) return add_line(k, p, element, err);
    return add_face(k, p, target, element, -1, k->reversed[element], err);
}

static int add_pick(fl_skin *k, fl_part *p, const fl_skin_face *f, fl_err *err)
{
    int turn = 0;
    if (k->duplicate_faces[f->element] >> f->face & 1) return 0;
    if (check_orientation(k, f->element, &turn, err)) return -1;
    return add_face(k, p, f->target, f->element, f->face, turn, err);
}

/* --- parts ---------------------------------------------------------------------------------------------- */

static const char *target_name(const fl_elements *e, int32_t target)
{
    return target < e->parts.n ? e->parts.name[target] : e->sets.name[target - e->parts.n];
}

int fl_skin_emit(fl_skin *k, fl_surface *s, fl_err *err)
{
    const fl_elements *e = k->e;
    const int32_t targets = e->parts.n + e->sets.n;
    int32_t *first = NULL, *list = NULL, *pick_first = NULL, *pick_list = NULL;
    int rc = -1;
    if (record_mids(k, err) ||
        fl_group_by_target(e->element_id.n, targets, k->target, 1, &first, &list, err) ||
        fl_group_by_target(k->picks, targets, k->picks ? &k->pick[0].target : NULL,
                           (int)(sizeof *k->pick / sizeof(int32_t)), &pick_first, &pick_list, err))
        goto done;
    for (int32_t t = 0; t < targets; t++) {
        fl_part p = {0};
        int bad = 0;
        for (int32_t i = first[t]; !bad && i < first[t + 1]; i++) bad = add_element(k, &p, t, list[i], err);
        for (int32_t i = pick_first[t]; !bad && i < pick_first[t + 1]; i++)
            bad = add_pick(k, &p, &k->pick[pick_list[i]], err);
        if (!bad) bad = fl_part_merge_cylinders(&p, &k->merged, err);
        if (!bad && (p.nt || p.nc)) {
            const int32_t at = fl_surface_add(s, target_name(e, t), strlen(target_name(e, t)), err);
            bad = at < 0;
            if (!bad) {
                p.name = s->part[at].name;
                p.id = s->part[at].id;
                p.duplicates = k->dropped_of[t];
                s->part[at] = p;
                p = (fl_part){0};
            }
        }
        fl_part_free(&p);
        if (bad) goto done;
    }
    rc = 0;
done:
    free(first);
    free(list);
    free(pick_first);
    free(pick_list);
    return rc;
}

void fl_skin_report(const fl_skin *k, fl_bytes *b)
{
    char accuracy[100] = "";
    if (k->merged.max_error > 0.0)
        snprintf(accuracy, sizeof accuracy, ", with a deviation of at most %.3g in the unit of the file",
                 k->merged.max_error);
    if (k->curved)
        fl_bytes_note(
            b,
            "mid-side nodes of %d faces and lines were left out, the largest sagitta is %.3g in the "
            "unit of the file; --subdivide keeps them",
            k->curved, k->sagitta);
    if (k->lines_without_radius)
        fl_bytes_note(b, "%d lines without a section radius or a length were skipped",
                      k->lines_without_radius);
    if (k->merged.merged)
        fl_bytes_note(b, "%d lines that continue one another were merged into %d%s", k->merged.merged,
                      k->merged.remaining, accuracy);
    if (k->left_handed)
        fl_bytes_note(b, "%d solids are numbered left-handed; their faces were reversed", k->left_handed);
    if (k->zero_volume) fl_bytes_note(b, "%d solids have no volume", k->zero_volume);
    if (k->duplicates)
        fl_bytes_note(b, "%d elements on the nodes of others of their kind were skipped", k->duplicates);
    if (k->covered_shells)
        fl_bytes_note(b, "%d shells lie on faces of solids, which are there already, and were skipped%s",
                      k->covered_shells,
                      k->by_name ? "" : "; --part gives such faces to the parts of the shells");
    if (k->shell_faces)
        fl_bytes_note(b, "%d faces of solids went to the parts of the shells that lie on them",
                      k->shell_faces);
    if (k->interior_shells)
        fl_bytes_note(b, "%d shells lie between two solids and were skipped", k->interior_shells);
    if (k->nonmanifold)
        fl_bytes_note(b, "%d faces belong to three or more solids and were taken as interior",
                      k->nonmanifold);
}
