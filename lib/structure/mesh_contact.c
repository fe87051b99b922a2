/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "structure/mesh_contact.h"
#include "structure/mesh_sphere_kernel.h"
#include "structure/mesh_side.h"
#include "narrow/closest_point.h"
#include "patch/patch_law.h"
#include "patch/plane_distances.h"

/* A wall that overlaps a core by this part of the largest overlap counts as loaded. */
#define KNOWN_SHARE 0.8

/* True if the point lies on the rim of the surface. */
static int is_on_rim(const fl_poly *p, const fl_piece_mesh *sh, fl_vec3 x)
{
    const double same = FL_MESH_EDGE * p->size;
    fl_bvh_walk at = fl_bvh_walk_from(&sh->edge_tree, sh->edge_box, x);
    for (int32_t k; (k = fl_bvh_walk_next(&at, same)) >= 0;) {
        const fl_edge e = p->edge[k];
        if (e.left >= 0 && e.right >= 0) continue;
        const fl_vec3 u = v3_sub(p->v[e.b], p->v[e.a]), r = v3_sub(x, p->v[e.a]);
        const double t = v3_dot(r, u) / v3_norm2(u), in = t < 0.0 ? 0.0 : t > 1.0 ? 1.0 : t;
        if (v3_norm(v3_madd(r, -in, u)) <= same) return 1;
    }
    return 0;
}

/* Height of x in front of the surface: the largest among the faces that meet in the nearest point, seen from
 * that point, since the plane of a face may miss its corners. If more than two planes meet there and x is in
 * front of one and behind another, the corner as a whole decides the side. */
static double height_in_front(const fl_nearest_search *b, const fl_poly *p, const fl_piece_mesh *sh,
                              fl_vec3 x)
{
    const fl_vec3 r = v3_sub(x, b->at.p);
    const double same = FL_MESH_EDGE * p->size;
    const fl_vec3 first = p->n[b->of];
    fl_vec3 second = first;
    double most = v3_dot(first, r), low = most, high = most;
    int planes = 1;
    if (fabs(most) > FL_MESH_NORMAL_COSINE * b->at.d) return most;
    fl_bvh_walk at = fl_bvh_walk_from(&sh->tree, sh->box, b->at.p);
    for (int32_t f; (f = fl_bvh_walk_next(&at, same)) >= 0;) {
        const double s = v3_dot(p->n[f], r);
        if (fl_closest_on_face(p, f, b->at.p).d > same) continue;
        if (fl_nearest_is_decisive(s, most, b->thin)) most = s;
        low = fmin(low, s), high = fmax(high, s);
        if (v3_norm2(v3_sub(p->n[f], first)) <= FL_MESH_SAME_NORMAL * FL_MESH_SAME_NORMAL) continue;
        if (planes == 1) second = p->n[f], planes = 2;
        else if (v3_norm2(v3_sub(p->n[f], second)) > FL_MESH_SAME_NORMAL * FL_MESH_SAME_NORMAL) planes = 3;
    }
    if (planes < 3 || low * high >= 0.0) return most;
    return fl_mesh_side(p, sh, x, b->at.p, same) < 0.0 ? -fabs(most) : fabs(most);
}

/* Signs the distance: a point nearest to a rim is beside the surface, not behind it. */
static fl_closest_point with_sign(const fl_nearest_search *b, const fl_poly *p, const fl_piece_mesh *sh,
                                  fl_vec3 x)
{
    fl_closest_point q = b->at;
    if (height_in_front(b, p, sh, x) < 0.0 && !is_on_rim(p, sh, q.p)) {
        q.d = -q.d;
        q.n = v3_neg(q.n);
    }
    return q;
}

static fl_nearest_search empty_search(const fl_poly *p, const fl_piece_mesh *sh)
{
    return fl_nearest_of_none(p, sh->thin != NULL);
}

static fl_nearest_search find_nearest(const fl_poly *p, const fl_piece_mesh *sh, fl_vec3 x)
{
    fl_nearest_search b = empty_search(p, sh);
    fl_bvh_walk at = fl_bvh_walk_from(&sh->tree, sh->box, x);
    for (int32_t f; (f = fl_bvh_walk_next(&at, b.at.d + b.same)) >= 0;) fl_nearest_try(&b, p, f, x);
    return b;
}

/* Signed distance of x from the surface, and the face it is of. */
static fl_closest_point signed_nearest_face(const fl_poly *p, const fl_piece_mesh *sh, fl_vec3 x, int32_t *of)
{
    const fl_nearest_search b = find_nearest(p, sh, x);
    *of = b.of;
    return with_sign(&b, p, sh, x);
}

static fl_closest_point signed_nearest(const fl_poly *p, const fl_piece_mesh *sh, fl_vec3 x)
{
    int32_t of;
    return signed_nearest_face(p, sh, x, &of);
}

/* A part of a joined piece: the facets of one cone, or, with only = -1, all but those of the cones marked. */
typedef struct {
    const uint8_t *is_free; /* [cones] */
    int32_t only, cones;
} mesh_selection;

/* True if something of that cone (-1: of none) counts; of: NULL for all of a mesh. */
static int is_selected(const mesh_selection *of, int32_t cone)
{
    if (!of) return 1;
    return of->only >= 0 ? cone == of->only : cone < 0 || !of->is_free[cone];
}

static int32_t cone_of_edge(const fl_poly *p, const fl_piece_mesh *sh, int32_t e)
{
    const int32_t l = p->edge[e].left, r = p->edge[e].right;
    return l >= 0 && r >= 0 && sh->cone_of_face[l] == sh->cone_of_face[r] ? sh->cone_of_face[l] : -1;
}

/* Keeps the walls of a part of the piece. */
static void keep_selected(fl_feature_set *r, const fl_poly *p, const fl_piece_mesh *sh,
                          const mesh_selection *of)
{
    int32_t n = 0;
    for (int32_t k = 0; k < r->faces; k++)
        if (is_selected(of, sh->cone_of_face[r->face[k]])) r->face[n++] = r->face[k];
    r->faces = n;
    n = 0;
    for (int32_t k = 0; k < r->edges; k++)
        if (is_selected(of, cone_of_edge(p, sh, r->edge[k]))) r->edge[n++] = r->edge[k];
    r->edges = n;
    if (of->only >= 0) r->vertices = 0;
}

/* True if the piece is a union of cones and x is farther than `far` from all of them.  Facets are long, and
 * those of a slanting cone have large boxes: the cones themselves tell it soonest. */
static int is_outside_cones(const fl_piece *b, fl_vec3 x, double far)
{
    far += 2.0 * b->facet_error;
    for (int32_t k = 0; k < b->cones; k++) {
        const fl_free_cone *c = &b->free_cone[k];
        const double reach = fmax(c->r0, c->r1) + c->h + far;
        const fl_vec3 r = v3_sub(x, c->x);
        if (!(c->h > 0.0)) return 0; /* a body of another kind */
        if (v3_norm2(r) > reach * reach) continue;
        if (fl_closest_on_cone(c->r0, c->r1, c->h, q_rotate(q_conj(c->q), r)).d < far) return 0;
    }
    return b->cones > 0;
}

/* True if x is behind the surface, or may pass behind when it moves by the margin. That is excluded if x is
 * farther away, and in front of every face that may become the nearest. */
static int may_pass_behind(const fl_poly *p, const fl_piece_mesh *sh, fl_vec3 x, double margin)
{
    const double d = signed_nearest(p, sh, x).d, most = d + 2.0 * margin;
    if (d < margin) return 1;
    fl_bvh_walk at = fl_bvh_walk_from(&sh->tree, sh->box, x);
    for (int32_t f; (f = fl_bvh_walk_next(&at, most)) >= 0;) {
        const double s = v3_dot(p->n[f], x) - p->c[f];
        if (s < margin && -s <= most && fl_closest_on_face(p, f, x).d < most) return 1;
    }
    return 0;
}

static int32_t query_boxes(const fl_bvh *tree, const fl_aabb *box, fl_aabb q, int32_t **list, int32_t *cap)
{
    fl_err lost = {0};
    int32_t n = fl_bvh_query(tree, box, q, *list, *cap);
    if (n <= *cap) return n;
    if (fl_grow(list, cap, n, sizeof **list, &lost)) return -1;
    return fl_bvh_query(tree, box, q, *list, *cap);
}

static int compare_int(const void *a, const void *b)
{
    const int32_t x = *(const int32_t *)a, y = *(const int32_t *)b;
    return (x > y) - (x < y);
}

/* Lists every feature of the core. */
static int list_all_features(fl_feature_set *r, const fl_poly *a)
{
    fl_err lost = {0};
    if (fl_grow(&r->vertex, &r->vertex_cap, a->nv, sizeof *r->vertex, &lost) ||
        (a->ne && fl_grow(&r->edge, &r->edge_cap, a->ne, sizeof *r->edge, &lost)) ||
        (a->nf && fl_grow(&r->face, &r->face_cap, a->nf, sizeof *r->face, &lost)))
        return -1;
    for (int32_t v = 0; v < a->nv; v++) r->vertex[v] = v;
    for (int32_t e = 0; e < a->ne; e++) r->edge[e] = e;
    for (int32_t f = 0; f < a->nf; f++) r->face[f] = f;
    r->vertices = a->nv;
    r->edges = a->ne;
    r->faces = a->nf;
    return 0;
}

/* Lists faces within the reach, edges and corners within the radius; -1 when memory runs out. */
static int list_near_features(fl_feature_set *r, const fl_poly *core, const fl_piece_mesh *sh, fl_aabb box,
                              double ra, double reach)
{
    fl_err lost = {0};
    r->faces = query_boxes(&sh->tree, sh->box, aabb_grow(box, reach), &r->face, &r->face_cap);
    r->edges = r->vertices = 0;
    if (r->faces <= 0) return r->faces;
    qsort(r->face, (size_t)r->faces, sizeof *r->face, compare_int);
    box = aabb_grow(box, ra);
    r->edges = query_boxes(&sh->edge_tree, sh->edge_box, box, &r->edge, &r->edge_cap);
    if (r->edges < 0) return -1;
    if (r->edges > 0) qsort(r->edge, (size_t)r->edges, sizeof *r->edge, compare_int);
    if (sh->corners && fl_grow(&r->vertex, &r->vertex_cap, sh->corners, sizeof *r->vertex, &lost)) return -1;
    for (int32_t k = 0; k < sh->corners; k++) {
        const fl_vec3 x = core->v[sh->corner[k]];
        if (aabb_overlap((fl_aabb){x, x}, box)) r->vertex[r->vertices++] = sh->corner[k];
    }
    return 0;
}

static fl_vec3 middle_of(const fl_vec3 *v, int32_t n)
{
    fl_vec3 middle = v3(0, 0, 0);
    for (int32_t k = 0; k < n; k++) middle = v3_madd(middle, 1.0 / n, v[k]);
    return middle;
}

/* True if the straight way from a to b leads through the surface, from its front to its back; -1 when memory
 * runs out. */
static int leads_through(fl_feature_set *r, const fl_poly *p, const fl_piece_mesh *sh, fl_vec3 a, fl_vec3 b)
{
    r->faces = query_boxes(&sh->tree, sh->box, aabb_add((fl_aabb){a, a}, b), &r->face, &r->face_cap);
    for (int32_t k = 0; k < r->faces; k++) {
        const int32_t f = r->face[k];
        const double ha = v3_dot(p->n[f], a) - p->c[f], hb = v3_dot(p->n[f], b) - p->c[f];
        if (ha <= 0.0 || hb > 0.0) continue;
        if (fl_closest_on_face(p, f, v3_madd(a, ha / (ha - hb), v3_sub(b, a))).d <= FL_MESH_EDGE * p->size)
            return 1;
    }
    return r->faces < 0 ? -1 : 0;
}

/* Evaluates the vertices of the core that may be behind the surface, or beyond a sheet. Adds the contact
 * points of those behind, and sets *behind if there are any. An open surface has gone into the core if it
 * lies between its middle and the vertex; else the vertex has come round the rim, or the core from the
 * back. */
static int add_vertices_behind(fl_patch_points *w, fl_mesh_contact_work *near, const fl_patch_core *A,
                               const fl_patch_core *B, const fl_piece_mesh *sh, const fl_feature_pairs *l,
                               double ra, const mesh_selection *of, int *behind)
{
    *behind = 0;
    for (int32_t k = 0; k < l->candidates; k++) {
        const int32_t v = l->candidate[k];
        int32_t face;
        fl_closest_point q = signed_nearest_face(B->p, sh, w->va[v], &face);
        if (of && !is_selected(of, sh->cone_of_face[face])) continue;
        if (q.d >= 0.0 && sh->thin) { /* it may have passed a sheet */
            const int through = leads_through(&near->of_mesh, B->p, sh, middle_of(w->va, A->p->nv), w->va[v]);
            if (through < 0) return -1;
            if (through) q.d = -q.d, q.n = v3_neg(q.n);
        }
        if (q.d >= 0.0) continue;
        if (!sh->closed && !sh->thin) {
            const int through = leads_through(&near->of_mesh, B->p, sh, middle_of(w->va, A->p->nv), w->va[v]);
            if (through < 0) return -1;
            if (!through) continue;
        }
        *behind = 1;
        if (fl_patch_points_add_vertex(w, A, 0.0, v, q.n, ra - q.d)) return -1;
    }
    return 0;
}

/* True if some face of the core has all of the points beyond it by `far`: they are farther than that from the
 * core. */
static int is_beyond(const fl_patch_core *A, const fl_patch_core *B, const int32_t *at, int32_t n, double far)
{
    for (int32_t F = 0; F < A->p->nf; F++) {
        const double level = v3_dot(A->n[F], A->v[A->p->loop[A->p->first[F]]]) + far;
        int32_t k = 0;
        while (k < n && v3_dot(A->n[F], B->v[at[k]]) > level) k++;
        if (k == n) return 1;
    }
    return 0;
}

/* Keeps the walls within `far` of the core. */
static void keep_near(fl_feature_set *r, const fl_patch_core *A, const fl_patch_core *B, double far)
{
    const fl_poly *p = B->p;
    int32_t n = 0;
    for (int32_t k = 0; k < r->faces; k++) {
        const int32_t f = r->face[k];
        if (!is_beyond(A, B, p->loop + p->first[f], p->first[f + 1] - p->first[f], far)) r->face[n++] = f;
    }
    r->faces = n;
    n = 0;
    for (int32_t k = 0; k < r->edges; k++) {
        const fl_edge e = p->edge[r->edge[k]];
        if (!is_beyond(A, B, (const int32_t[2]){e.a, e.b}, 2, far)) r->edge[n++] = r->edge[k];
    }
    r->edges = n;
    n = 0;
    for (int32_t k = 0; k < r->vertices; k++)
        if (!is_beyond(A, B, &r->vertex[k], 1, far)) r->vertex[n++] = r->vertex[k];
    r->vertices = n;
}

/* Keeps of the sides of sheets those that face x. */
static void keep_facing(fl_feature_set *r, const fl_poly *p, const fl_piece_mesh *mesh, fl_vec3 x)
{
    int32_t n = 0;
    for (int32_t k = 0; k < r->faces; k++) {
        const int32_t f = r->face[k];
        if (!mesh->thin[f] || v3_dot(p->n[f], x) > p->c[f]) r->face[n++] = f;
    }
    r->faces = n;
}

/* Lists the walls within reach, and the features of them and of the core that may have contact points, until
 * the pair has moved by the margin.  facing: of sheets only the sides that face the middle of the core. */
static int list_feature_pairs(fl_patch_points *w, fl_mesh_contact_work *near, const fl_patch_core *A,
                              const fl_patch_core *B, const fl_piece *piece, double ra, double reach,
                              const mesh_selection *of, int facing, fl_feature_pairs *l)
{
    const fl_piece_mesh *const mesh = &piece->mesh;
    const double margin = fl_feature_pairs_margin(l, ra), same = FL_MESH_ROUNDING * (A->p->size + B->p->size),
                 margin_behind = margin + FL_MESH_EDGE * B->p->size;
    fl_feature_set *walls = &near->of_mesh, *all = &near->of_core;
    fl_aabb box = aabb_empty();
    for (int32_t v = 0; v < A->p->nv; v++) box = aabb_add(box, w->va[v]);
    if (list_near_features(walls, B->p, mesh, box, ra + margin, reach + margin)) return -1;
    if (of) keep_selected(walls, B->p, mesh, of);
    l->out_of_reach = walls->faces == 0;
    l->stores_planes = 1;
    l->candidates = 0;
    if (fl_reserve(&l->candidate, &l->candidate_cap, A->p->nv, sizeof *l->candidate)) return -1;
    for (int32_t v = 0; v < A->p->nv && !l->out_of_reach; v++)
        if (!is_outside_cones(piece, w->va[v], margin_behind) &&
            may_pass_behind(B->p, mesh, w->va[v], margin_behind))
            l->candidate[l->candidates++] = v;
    keep_near(walls, A, B, ra + margin + same);
    if (facing) keep_facing(walls, B->p, mesh, middle_of(w->va, A->p->nv));
    return list_all_features(all, A->p) || fl_feature_pairs_build(l, w, A, all, B, walls, ra, ra, margin) ||
                   fl_mesh_under_face_list(l, A, B)
               ? -1
               : 0;
}

/* Sets *distance to reach if no face is in reach now. The list may be an old one, and the free travel
 * computed from the distance has to be the same with a new list. */
static void bound_distance(const fl_patch_points *w, const fl_poly *a, const fl_piece_mesh *mesh,
                           double reach, double *distance)
{
    fl_aabb box = aabb_empty();
    for (int32_t v = 0; v < a->nv; v++) box = aabb_add(box, w->va[v]);
    if (!fl_bvh_meets(&mesh->tree, mesh->box, aabb_grow(box, reach))) *distance = reach;
}

static int add_listed_points(fl_patch_points *w, fl_mesh_contact_work *near, const fl_patch_core *A,
                             const fl_patch_core *B, double ra, double far, const fl_feature_pairs *l)
{
    const double rim = FL_PATCH_RIM_WIDTH * ra;
    fl_feature_pairs rest;
    return fl_mesh_under_face_evaluate(w, l, &near->under_face, A, B, ra, far, rim, &rest) ||
                   fl_feature_pairs_evaluate(w, &rest, A, B, ra, far, rim, 0.0)
               ? -1
               : 0;
}

/* True if some point, from `from` on, has the core itself touch the surface. */
static int has_core_contact(const fl_patch_points *w, int32_t from, double ra)
{
    for (int32_t k = from; k < w->n; k++)
        if (w->point[k].overlap >= ra * (1.0 - FL_MESH_ROUNDING)) return 1;
    return 0;
}

/* The list of a part among those of the pair, invalid where it was one without other cones.  NULL when memory
 * runs out. */
static fl_feature_pairs *list_of_part(fl_feature_pairs *l, const mesh_selection *of)
{
    fl_err lost = {0};
    fl_feature_pairs now = {.only = of->only};
    int32_t k = 0;
    for (int32_t c = 0; of->only < 0 && c < of->cones; c++) {
        if (!of->is_free[c]) continue;
        if (now.marks < FL_PART_MARKS) now.mark[now.marks] = c;
        now.marks++;
    }
    while (k < l->parts && l->part[k].only != of->only) k++;
    if (k == l->parts) {
        if (fl_grow(&l->part, &l->part_cap, (int64_t)k + 1, sizeof *l->part, &lost)) return NULL;
        l->part[l->parts++] = (fl_feature_pairs){.only = of->only};
    }
    fl_feature_pairs *const own = &l->part[k];
    int same = own->marks == now.marks && now.marks <= FL_PART_MARKS;
    for (int32_t c = 0; c < now.marks && same; c++) same = own->mark[c] == now.mark[c];
    if (!same) {
        own->max_shift2 = 0.0;
        own->marks = now.marks;
        memcpy(own->mark, now.mark, sizeof now.mark);
    }
    return own;
}

/* Adds the points of a mesh, or of a part of it.  l->out_of_reach is set if no face is near. */
static int add_points(fl_patch_points *w, fl_mesh_contact_work *near, const fl_poly *a, const fl_piece *b,
                      double ra, double reach, const mesh_selection *of, fl_feature_pairs *l)
{
    const fl_poly *core = &b->core;
    const fl_patch_core A = {a, w->va, w->na, ra, 1.0}, B = {core, core->v, core->n, 0.0, -1.0};
    const int32_t before = w->n;
    int behind;
    if (!fl_feature_pairs_valid(l, &w->M, w->o) &&
        list_feature_pairs(w, near, &A, &B, b, ra, reach, of, 0, l))
        return -1;
    if (l->out_of_reach) {
        if (!of) l->max_shift2 = 0.0; /* not near now: no list is kept, since the distance is asked for */
        return 0;
    }
    if (add_vertices_behind(w, near, &A, &B, &b->mesh, l, ra, of, &behind)) return -1;
    if (behind) { /* a vertex farther behind than all faces reach is beyond the surface, not in it */
        double beside = 0.0;
        bound_distance(w, a, &b->mesh, ra, &beside);
        if (beside == ra) {
            w->n = before;
            return 0;
        }
    }
    const double far = behind ? ra : 0.0;
    const int32_t vertices = w->n, features = w->features;
    const fl_vec3 couple = w->couple;
    if (add_listed_points(w, near, &A, &B, ra, far, l)) return -1;
    if (b->mesh.thin &&
        (behind || has_core_contact(w, before, ra))) { /* the far side of the sheet is in the core */
        w->n = vertices, w->features = features, w->couple = couple;
        if (list_feature_pairs(w, near, &A, &B, b, ra, reach, of, 1, l) ||
            add_listed_points(w, near, &A, &B, ra, far, l))
            return -1;
        l->max_shift2 = 0.0; /* so does one with the far side */
    }
    return 0;
}

int fl_mesh_contact_points(fl_patch_points *w, fl_mesh_contact_work *near, const fl_poly *a,
                           const fl_piece *b, double ra, double reach, fl_feature_pairs *l, double *distance)
{
    w->n = w->features = 0;
    w->couple = v3(0, 0, 0);
    *distance = reach;
    if (add_points(w, near, a, b, ra, reach, NULL, l)) return -1;
    if (l->out_of_reach) return 0;
    *distance = ra; /* a face is near: no bound is claimed */
    if (w->n == 0) bound_distance(w, a, &b->mesh, reach, distance);
    return 0;
}

int fl_mesh_contact_add_points(fl_patch_points *w, fl_mesh_contact_work *near, const fl_poly *a,
                               const fl_piece *b, double ra, int32_t only, fl_feature_pairs *l)
{
    const mesh_selection of = {near->is_free, only, b->cones};
    fl_feature_pairs *const own = list_of_part(l, &of);
    return own ? add_points(w, near, a, b, ra, ra, &of, own) : -1;
}

int fl_mesh_contact_reserve_cones(fl_mesh_contact_work *near, int32_t n)
{
    return fl_reserve(&near->is_free, &near->free_cap, n, 1);
}

void fl_mesh_contact_bound(const fl_patch_points *w, const fl_poly *a, const fl_piece *b, double reach,
                           double *distance)
{
    double far = 0.0;
    bound_distance(w, a, &b->mesh, reach + b->facet_error, &far);
    if (far > 0.0) *distance = reach;
}

/* Lists the faces that point x may meet until it has moved by the margin: those that can be the nearest if
 * it can touch one wall only, else all in reach. If nothing is near enough, *distance is set, and there are
 * none unless `always`. */
static int list_tiles(fl_mesh_contact_work *near, const fl_piece *b, fl_vec3 x, double ra, double margin,
                      int always, fl_feature_pairs *l, double *distance)
{
    const double same = FL_MESH_ROUNDING * b->core.size, far = ra + margin + same + b->facet_error;
    const fl_piece_mesh *sh = &b->mesh;
    fl_feature_set *walls = &near->of_mesh;
    int32_t n = 0;
    l->candidates = 0;
    l->max_shift2 = 0.0;
    *distance = find_nearest(&b->core, sh, x).least;
    if (*distance > far && !always) return 0;
    const double next = *distance + 2.0 * (margin + same);
    const int touches = !(*distance > far);
    *distance -= b->facet_error;
    fl_bvh_walk at = fl_bvh_walk_from(&sh->tree, sh->box, x);
    for (int32_t f; (f = fl_bvh_walk_next(&at, fmax(far, next))) >= 0;) {
        if (fabs(v3_dot(b->core.n[f], x) - b->core.c[f]) > fmax(far, next)) continue;
        if (fl_reserve(&walls->face, &walls->face_cap, (int64_t)n + 1, sizeof *walls->face)) return -1;
        walls->face[n++] = f;
    }
    if (n > 1) qsort(walls->face, (size_t)n, sizeof *walls->face, compare_int);
    l->single_wall = 1;
    if (touches)
        l->single_wall = fl_persistence_is_single(&sh->seams, &near->persistence, &b->core,
                                                  &(fl_near_tiles){walls->face, n}, x, far);
    if (l->single_wall < 0 || fl_reserve(&l->candidate, &l->candidate_cap, n, sizeof *l->candidate))
        return -1;
    for (int32_t c = 0; c < n; c++)
        if (fl_closest_on_face(&b->core, walls->face[c], x).d <= (l->single_wall ? next : fmax(far, next)))
            l->candidate[l->candidates++] = walls->face[c];
    return 0;
}

static int list_sphere_tiles(fl_patch_points *w, fl_mesh_contact_work *near, const fl_piece *b, double ra,
                             fl_feature_pairs *l, double *distance)
{
    const double margin = fl_feature_pairs_margin(l, ra);
    if (list_tiles(near, b, w->va[0], ra, margin, 0, l, distance)) return -1;
    if (l->candidates == 0) return 0;
    l->M = w->M, l->o = w->o;
    l->max_shift2 = margin * margin, l->max_turn2 = 1.0;
    l->margin = margin, l->uses = 1;
    return 0;
}

int fl_mesh_contact_single_wall(fl_mesh_contact_work *near, const fl_piece *b, fl_vec3 x, double ra,
                                double way, fl_feature_pairs *l)
{
    double distance;
    if (list_tiles(near, b, x, ra, way + FL_MESH_EDGE * b->core.size, 1, l, &distance)) return -1;
    return l->candidates > 0 && l->single_wall;
}

double fl_mesh_contact_known_distance(const fl_piece *b, double ra)
{
    const fl_feature_pairs none = {.margin = 0.0};
    return ra + fl_feature_pairs_margin(&none, ra) + FL_MESH_ROUNDING * b->core.size + b->facet_error;
}

int fl_mesh_contact_sphere(fl_patch_points *w, fl_mesh_contact_work *near, const fl_piece *b, double ra,
                           fl_feature_pairs *l, double *distance)
{
    const fl_poly *core = &b->core;
    const fl_piece_mesh *sh = &b->mesh;
    const fl_vec3 x = w->va[0];
    fl_nearest_search best = empty_search(core, sh);
    w->n = w->features = 0;
    w->couple = v3(0, 0, 0);
    if (!fl_feature_pairs_valid(l, &w->M, w->o) && list_sphere_tiles(w, near, b, ra, l, distance)) return -1;
    if (l->candidates == 0) return 0;
    for (int32_t c = 0; c < l->candidates; c++) fl_nearest_try(&best, core, l->candidate[c], x);
    fl_closest_point q = with_sign(&best, core, sh, x);
    if (sh->cone_of_face && sh->cone_of_face[best.of] >= 0 &&
        fl_blend_with_cone(&q, &b->free_cone[sh->cone_of_face[best.of]], x, ra))
        best.least = fabs(q.d);
    *distance = best.least;
    if (best.least >= ra) return 0; /* from behind as well */
    return l->single_wall
               ? fl_patch_points_add_plain(w, x, q.n, ra - q.d, ra)
               : fl_persistence_points(&sh->seams, &near->persistence, w, core,
                                       &(fl_near_tiles){l->candidate, l->candidates}, x, ra, &q, best.of);
}

int fl_mesh_contact_contains(const fl_piece *b, fl_vec3 x)
{
    return b->mesh.closed && signed_nearest(&b->core, &b->mesh, x).d < 0.0;
}

int fl_mesh_contact_gap(fl_mesh_contact_work *near, const fl_vec3 *v, const fl_poly *a, const fl_piece *b,
                        double within, fl_gap *out)
{
    const fl_poly *core = &b->core;
    fl_feature_set *r = &near->of_mesh;
    fl_err lost = {0};
    fl_vec3 *tile = NULL;
    int32_t cap = 0;
    fl_aabb box = aabb_empty();
    *out = (fl_gap){.d = INFINITY};
    for (int32_t k = 0; k < a->nv; k++) box = aabb_add(box, v[k]);
    r->faces = query_boxes(&b->mesh.tree, b->mesh.box, aabb_grow(box, within), &r->face, &r->face_cap);
    for (int32_t k = 0; k < r->faces; k++) {
        const int32_t from = core->first[r->face[k]], n = core->first[r->face[k] + 1] - from;
        fl_gjk_cache cold = {0};
        fl_gap gap;
        if (fl_grow(&tile, &cap, n, sizeof *tile, &lost)) break;
        for (int32_t c = 0; c < n; c++) tile[c] = core->v[core->loop[from + c]];
        fl_gjk((fl_core){v, a->nv, a}, (fl_core){tile, n, NULL}, &cold, &gap);
        if (gap.d < out->d) *out = gap;
    }
    free(tile);
    if (!out->overlap && fl_mesh_contact_contains(b, v[0])) out->d = -out->d, out->n = v3_neg(out->n);
    return r->faces < 0 || lost.code ? -1 : out->d < within;
}

/* Height of the lowest point above a plane, or any height below `enough` as soon as one is found. */
static double lowest_above(fl_vec3 n, fl_vec3 o, const fl_vec3 *v, int32_t points, double enough)
{
    const double level = v3_dot(n, o);
    double low = INFINITY;
    for (int32_t k = 0; k < points && low > enough; k++) low = fmin(low, v3_dot(n, v[k]) - level);
    return low;
}

double fl_mesh_contact_free_travel(fl_mesh_contact_work *near, const fl_vec3 *v, const fl_poly *a,
                                   const fl_piece *b, double ra, double overlap, double part)
{
    const fl_poly *core = &b->core;
    const double known = ra - KNOWN_SHARE * overlap;
    double most = ra;
    fl_feature_set *r = &near->of_mesh;
    fl_aabb box = aabb_empty();
    for (int32_t k = 0; k < a->nv; k++) box = aabb_add(box, v[k]);
    r->faces = query_boxes(&b->mesh.tree, b->mesh.box, aabb_grow(box, ra + most), &r->face, &r->face_cap);
    for (int32_t k = 0; k < r->faces; k++) {
        const int32_t f = r->face[k];
        const double low =
            lowest_above(core->n[f], core->v[core->loop[core->first[f]]], v, a->nv, known) - b->facet_error;
        if (low > known) most = fmin(most, fmax(low - ra + part * part * overlap, part * (ra - low)));
    }
    return r->faces < 0 ? -1.0 : most;
}

void fl_mesh_contact_work_free(fl_mesh_contact_work *near)
{
    fl_persistence_work_free(&near->persistence);
    fl_feature_set_free(&near->of_mesh), fl_feature_set_free(&near->of_core);
    fl_mesh_under_face_work_free(&near->under_face);
    free(near->is_free);
}
