/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdlib.h>
#include "base/array.h"
#include "structure/mesh_contact.h"
#include "narrow/closest_point.h"
#include "patch/patch_law.h"
#include "patch/plane_distances.h"

/* Two distances within this fraction of the size are one: rounding of the coordinates. */
#define SAME 1e-12
/* A point is on an edge or a face where it is within this fraction of the size: straight runs of edges are as
 * straight, and corners of faces as far from their planes, as that (coplanar_regions.c). */
#define ON_EDGE 2e-6
/* Where the way to a face is upright to it but for that cosine, no other tells the side. */
#define UPRIGHT (1.0 - 1e-9)

/* A wall that is as deep in a core as that part of the deepest is known by what it bears. */
#define KNOWN 0.8

/* The point lies where the surface ends. */
static int on_rim(const fl_poly *p, const fl_piece_mesh *sh, fl_vec3 x)
{
    const double same = ON_EDGE * p->size;
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

/* The nearest point of some faces, looked at one by one, in any order but for rounding. */
typedef struct {
    fl_closest_point at;
    double least; /* distance, in any order at all */
    double front; /* how far x is in front of the face */
    double same;
    int32_t of; /* the face */
} finding;

/* Of faces whose nearest points agree within rounding (a shared edge or corner) the one that x is most in
 * front of tells the side: its plane passes between x and the others. */
static inline void look_at(finding *b, const fl_poly *p, int32_t f, fl_vec3 x)
{
    const double s = v3_dot(p->n[f], x) - p->c[f], most = b->at.d + b->same;
    if (fabs(s) > most) return;
    const fl_closest_point q = fl_closest_on_face(p, f, x);
    if (q.d > most) return;
    if (q.d < b->least) b->least = q.d;
    if (q.d < b->at.d - b->same || fabs(s) > fabs(b->front)) b->at = q, b->front = s, b->of = f;
}

/* How far x is in front of the surface: of the faces that meet in the nearest point the one that it is most
 * in front of tells, seen from that point, since the plane of a face may pass its corners by. */
static double in_front(const finding *b, const fl_poly *p, const fl_piece_mesh *sh, fl_vec3 x)
{
    const fl_vec3 r = v3_sub(x, b->at.p);
    const double same = ON_EDGE * p->size;
    double most = v3_dot(p->n[b->of], r);
    if (fabs(most) > UPRIGHT * b->at.d) return most;
    fl_bvh_walk at = fl_bvh_walk_from(&sh->tree, sh->box, b->at.p);
    for (int32_t f; (f = fl_bvh_walk_next(&at, same)) >= 0;) {
        const double s = v3_dot(p->n[f], r);
        if (fabs(s) > fabs(most) && fl_closest_on_face(p, f, b->at.p).d <= same) most = s;
    }
    return most;
}

/* With its sign: what is nearest to a rim is beside the surface, not behind it. */
static fl_closest_point sided(const finding *b, const fl_poly *p, const fl_piece_mesh *sh, fl_vec3 x)
{
    fl_closest_point q = b->at;
    if (in_front(b, p, sh, x) < 0.0 && !on_rim(p, sh, q.p)) {
        q.d = -q.d;
        q.n = v3_neg(q.n);
    }
    return q;
}

static finding nothing_yet(const fl_poly *p)
{
    return (finding){.at.d = INFINITY, .least = INFINITY, .same = SAME * p->size, .of = -1};
}

static finding nearest(const fl_poly *p, const fl_piece_mesh *sh, fl_vec3 x)
{
    finding b = nothing_yet(p);
    fl_bvh_walk at = fl_bvh_walk_from(&sh->tree, sh->box, x);
    for (int32_t f; (f = fl_bvh_walk_next(&at, b.at.d + b.same)) >= 0;) look_at(&b, p, f, x);
    return b;
}

/* Signed distance of x from the surface. */
static fl_closest_point nearest_to(const fl_poly *p, const fl_piece_mesh *sh, fl_vec3 x)
{
    const finding b = nearest(p, sh, x);
    return sided(&b, p, sh, x);
}

/* Is x behind the surface, or may it come there when it moves by the margin?  Not when it is farther off than
 * that, and in front of every face that may become the nearest. */
static int may_come_behind(const fl_poly *p, const fl_piece_mesh *sh, fl_vec3 x, double margin)
{
    const double d = nearest_to(p, sh, x).d, most = d + 2.0 * margin;
    if (d < margin) return 1;
    fl_bvh_walk at = fl_bvh_walk_from(&sh->tree, sh->box, x);
    for (int32_t f; (f = fl_bvh_walk_next(&at, most)) >= 0;) {
        const double s = v3_dot(p->n[f], x) - p->c[f];
        if (s < margin && -s <= most && fl_closest_on_face(p, f, x).d < most) return 1;
    }
    return 0;
}

static int32_t query(const fl_bvh *tree, const fl_aabb *box, fl_aabb q, int32_t **list, int32_t *cap)
{
    fl_err lost = {0};
    int32_t n = fl_bvh_query(tree, box, q, *list, *cap);
    if (n <= *cap) return n;
    if (fl_grow(list, cap, n, sizeof **list, &lost)) return -1;
    return fl_bvh_query(tree, box, q, *list, *cap);
}

static int ascending(const void *a, const void *b)
{
    const int32_t x = *(const int32_t *)a, y = *(const int32_t *)b;
    return (x > y) - (x < y);
}

/* Every feature of the core. */
static int whole(fl_feature_set *r, const fl_poly *a)
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

/* Faces within the reach, edges and corners within the radius; -1 when memory runs out. */
static int around(fl_feature_set *r, const fl_poly *core, const fl_piece_mesh *sh, fl_aabb box, double ra,
                  double reach)
{
    fl_err lost = {0};
    r->faces = query(&sh->tree, sh->box, aabb_grow(box, reach), &r->face, &r->face_cap);
    r->edges = r->vertices = 0;
    if (r->faces <= 0) return r->faces;
    qsort(r->face, (size_t)r->faces, sizeof *r->face, ascending);
    box = aabb_grow(box, ra);
    r->edges = query(&sh->edge_tree, sh->edge_box, box, &r->edge, &r->edge_cap);
    if (r->edges < 0) return -1;
    if (r->edges > 0) qsort(r->edge, (size_t)r->edges, sizeof *r->edge, ascending);
    if (sh->corners && fl_grow(&r->vertex, &r->vertex_cap, sh->corners, sizeof *r->vertex, &lost)) return -1;
    for (int32_t k = 0; k < sh->corners; k++) {
        const fl_vec3 x = core->v[sh->corner[k]];
        if (aabb_overlap((fl_aabb){x, x}, box)) r->vertex[r->vertices++] = sh->corner[k];
    }
    return 0;
}

/* The vertices of the core that may be behind the surface: signed distances.  *behind is set when one is; the
 * places of those are added here. */
static int core_vertices(fl_patch_points *w, const fl_patch_core *A, const fl_patch_core *B,
                         const fl_piece_mesh *sh, const fl_feature_pairs *l, double ra, int *behind)
{
    *behind = 0;
    for (int32_t k = 0; k < l->candidates; k++) {
        const int32_t v = l->candidate[k];
        const fl_closest_point q = nearest_to(B->p, sh, w->va[v]);
        if (q.d >= 0.0) continue;
        *behind = 1;
        if (fl_patch_points_add_vertex(w, A, 0.0, v, q.n, ra - q.d)) return -1;
    }
    return 0;
}

/* Some face of the core has all of the points beyond it by `far`: they are farther than that from the core.
 */
static int beyond(const fl_patch_core *A, const fl_patch_core *B, const int32_t *at, int32_t n, double far)
{
    for (int32_t F = 0; F < A->p->nf; F++) {
        const double level = v3_dot(A->n[F], A->v[A->p->loop[A->p->first[F]]]) + far;
        int32_t k = 0;
        while (k < n && v3_dot(A->n[F], B->v[at[k]]) > level) k++;
        if (k == n) return 1;
    }
    return 0;
}

/* Leave of the walls what is within `far` of the core. */
static void leave_near(fl_feature_set *r, const fl_patch_core *A, const fl_patch_core *B, double far)
{
    const fl_poly *p = B->p;
    int32_t n = 0;
    for (int32_t k = 0; k < r->faces; k++) {
        const int32_t f = r->face[k];
        if (!beyond(A, B, p->loop + p->first[f], p->first[f + 1] - p->first[f], far)) r->face[n++] = f;
    }
    r->faces = n;
    n = 0;
    for (int32_t k = 0; k < r->edges; k++) {
        const fl_edge e = p->edge[r->edge[k]];
        if (!beyond(A, B, (const int32_t[2]){e.a, e.b}, 2, far)) r->edge[n++] = r->edge[k];
    }
    r->edges = n;
    n = 0;
    for (int32_t k = 0; k < r->vertices; k++)
        if (!beyond(A, B, &r->vertex[k], 1, far)) r->vertex[n++] = r->vertex[k];
    r->vertices = n;
}

/* The walls within reach, and what of them and of the core may have places, until the pair has moved by the
 * margin. */
static int list_matches(fl_patch_points *w, fl_mesh_contact_work *near, const fl_patch_core *A,
                        const fl_patch_core *B, const fl_piece_mesh *shell, double ra, double reach,
                        fl_feature_pairs *l)
{
    const double margin = fl_feature_pairs_margin(l, ra), same = SAME * (A->p->size + B->p->size),
                 shy = margin + ON_EDGE * B->p->size;
    fl_feature_set *walls = &near->of_shell, *all = &near->of_core;
    fl_aabb box = aabb_empty();
    for (int32_t v = 0; v < A->p->nv; v++) box = aabb_add(box, w->va[v]);
    if (around(walls, B->p, shell, box, ra + margin, reach + margin)) return -1;
    l->out_of_reach = walls->faces == 0;
    l->stores_planes = 1;
    l->candidates = 0;
    if (fl_reserve(&l->candidate, &l->candidate_cap, A->p->nv, sizeof *l->candidate)) return -1;
    for (int32_t v = 0; v < A->p->nv && !l->out_of_reach; v++)
        if (may_come_behind(B->p, shell, w->va[v], shy)) l->candidate[l->candidates++] = v;
    leave_near(walls, A, B, ra + margin + same);
    return whole(all, A->p) || fl_feature_pairs_build(l, w, A, all, B, walls, ra, ra, margin) ||
                   fl_mesh_under_face_list(l, A, B)
               ? -1
               : 0;
}

/* Whether no face is in reach now: the list may be one of another time, and what sleeps by the distance has
 * to be told the same with a list that is new. */
static int nothing_near(const fl_patch_points *w, fl_mesh_contact_work *near, const fl_poly *a,
                        const fl_piece_mesh *shell, double reach, double *distance)
{
    fl_feature_set *walls = &near->of_shell;
    fl_aabb box = aabb_empty();
    for (int32_t v = 0; v < a->nv; v++) box = aabb_add(box, w->va[v]);
    walls->faces = query(&shell->tree, shell->box, aabb_grow(box, reach), &walls->face, &walls->face_cap);
    if (walls->faces < 0) return -1;
    if (walls->faces == 0) *distance = reach;
    return 0;
}

int fl_mesh_contact_points(fl_patch_points *w, fl_mesh_contact_work *near, const fl_poly *a,
                           const fl_piece *b, double ra, double reach, fl_feature_pairs *l, double *distance)
{
    const fl_poly *core = &b->core;
    const fl_patch_core A = {a, w->va, w->na, ra, 1.0}, B = {core, core->v, core->n, 0.0, -1.0};
    int behind;
    w->n = w->features = 0;
    w->couple = v3(0, 0, 0);
    *distance = reach;
    if (!fl_feature_pairs_valid(l, &w->M, w->o) && list_matches(w, near, &A, &B, &b->mesh, ra, reach, l))
        return -1;
    if (l->out_of_reach) {
        l->max_shift2 = 0.0; /* what is not near now is not known later */
        return 0;
    }
    *distance = ra; /* something is near: no bound is claimed */
    if (core_vertices(w, &A, &B, &b->mesh, l, ra, &behind)) return -1;
    if (behind) { /* what is farther behind than all faces reach is beyond the surface, not in it */
        double beside = 0.0;
        if (nothing_near(w, near, a, &b->mesh, ra, &beside)) return -1;
        if (beside == ra) {
            w->n = 0;
            return nothing_near(w, near, a, &b->mesh, reach, distance);
        }
    }
    fl_feature_pairs rest;
    const double far = behind ? ra : 0.0, rim = FL_PATCH_RIM_WIDTH * ra;
    if (fl_mesh_under_face_evaluate(w, l, &near->under_face, &A, &B, ra, far, rim, &rest) ||
        fl_feature_pairs_evaluate(w, &rest, &A, &B, ra, far, rim, 0.0))
        return -1;
    return w->n ? 0 : nothing_near(w, near, a, &b->mesh, reach, distance);
}

/* The faces that the point may meet until it has moved by the margin: where it can touch one wall only those
 * that can be the nearest, else all in reach.  None where nothing is near enough: *distance tells how far. */
static int list_point(fl_patch_points *w, fl_mesh_contact_work *near, const fl_piece *b, double ra,
                      fl_feature_pairs *l, double *distance)
{
    const double margin = fl_feature_pairs_margin(l, ra), same = SAME * b->core.size,
                 far = ra + margin + same;
    const fl_piece_mesh *sh = &b->mesh;
    const fl_vec3 x = w->va[0];
    fl_feature_set *walls = &near->of_shell;
    int32_t n = 0;
    l->candidates = 0;
    l->max_shift2 = 0.0;
    *distance = nearest(&b->core, sh, x).least;
    if (*distance > far) return 0;
    const double next = *distance + 2.0 * (margin + same);
    fl_bvh_walk at = fl_bvh_walk_from(&sh->tree, sh->box, x);
    for (int32_t f; (f = fl_bvh_walk_next(&at, fmax(far, next))) >= 0;) {
        if (fabs(v3_dot(b->core.n[f], x) - b->core.c[f]) > fmax(far, next)) continue;
        if (fl_reserve(&walls->face, &walls->face_cap, (int64_t)n + 1, sizeof *walls->face)) return -1;
        walls->face[n++] = f;
    }
    if (n > 1) qsort(walls->face, (size_t)n, sizeof *walls->face, ascending);
    l->single_wall = fl_persistence_is_single(&sh->seams, &near->persistence, &b->core,
                                              &(fl_near_tiles){walls->face, n}, x, far);
    if (l->single_wall < 0 || fl_reserve(&l->candidate, &l->candidate_cap, n, sizeof *l->candidate))
        return -1;
    for (int32_t c = 0; c < n; c++)
        if (fl_closest_on_face(&b->core, walls->face[c], x).d <= (l->single_wall ? next : fmax(far, next)))
            l->candidate[l->candidates++] = walls->face[c];
    l->M = w->M, l->o = w->o;
    l->max_shift2 = margin * margin, l->max_turn2 = 1.0;
    l->margin = margin, l->uses = 1;
    return 0;
}

int fl_mesh_contact_sphere(fl_patch_points *w, fl_mesh_contact_work *near, const fl_piece *b, double ra,
                           fl_feature_pairs *l, double *distance)
{
    const fl_poly *core = &b->core;
    const fl_piece_mesh *sh = &b->mesh;
    const fl_vec3 x = w->va[0];
    finding best = nothing_yet(core);
    w->n = w->features = 0;
    w->couple = v3(0, 0, 0);
    if (!fl_feature_pairs_valid(l, &w->M, w->o) && list_point(w, near, b, ra, l, distance)) return -1;
    if (l->candidates == 0) return 0;
    for (int32_t c = 0; c < l->candidates; c++) look_at(&best, core, l->candidate[c], x);
    const fl_closest_point q = sided(&best, core, sh, x);
    *distance = best.least;
    if (best.least >= ra) return 0; /* also from behind */
    return l->single_wall
               ? fl_patch_points_add_plain(w, x, q.n, ra - q.d, ra)
               : fl_persistence_points(&sh->seams, &near->persistence, w, core,
                                       &(fl_near_tiles){l->candidate, l->candidates}, x, ra, &q, best.of);
}

int fl_mesh_contact_contains(const fl_piece *b, fl_vec3 x)
{
    for (int32_t e = 0; e < b->core.ne; e++)
        if (b->core.edge[e].left < 0 || b->core.edge[e].right < 0) return 0;
    return nearest_to(&b->core, &b->mesh, x).d < 0.0;
}

int fl_mesh_contact_gap(fl_mesh_contact_work *near, const fl_vec3 *v, const fl_poly *a, const fl_piece *b,
                        double within, fl_gap *out)
{
    const fl_poly *core = &b->core;
    fl_feature_set *r = &near->of_shell;
    fl_err lost = {0};
    fl_vec3 *tile = NULL;
    int32_t cap = 0;
    fl_aabb box = aabb_empty();
    *out = (fl_gap){.d = INFINITY};
    for (int32_t k = 0; k < a->nv; k++) box = aabb_add(box, v[k]);
    r->faces = query(&b->mesh.tree, b->mesh.box, aabb_grow(box, within), &r->face, &r->face_cap);
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

/* The lowest of the points over a plane, or something lower than `enough` as soon as one is. */
static double lowest_over(fl_vec3 n, fl_vec3 o, const fl_vec3 *v, int32_t points, double enough)
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
    const double known = ra - KNOWN * overlap;
    double most = ra;
    fl_feature_set *r = &near->of_shell;
    fl_aabb box = aabb_empty();
    for (int32_t k = 0; k < a->nv; k++) box = aabb_add(box, v[k]);
    r->faces = query(&b->mesh.tree, b->mesh.box, aabb_grow(box, ra + most), &r->face, &r->face_cap);
    for (int32_t k = 0; k < r->faces; k++) {
        const int32_t f = r->face[k];
        const double low = lowest_over(core->n[f], core->v[core->loop[core->first[f]]], v, a->nv, known);
        if (low > known) most = fmin(most, fmax(low - ra + part * part * overlap, part * (ra - low)));
    }
    return r->faces < 0 ? -1.0 : most;
}

void fl_mesh_contact_work_free(fl_mesh_contact_work *near)
{
    fl_persistence_work_free(&near->persistence);
    fl_feature_set_free(&near->of_shell), fl_feature_set_free(&near->of_core);
    fl_mesh_under_face_work_free(&near->under_face);
}
