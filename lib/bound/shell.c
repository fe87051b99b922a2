/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/mem.h"
#include "bound/shell.h"
#include "narrow/nearest.h"

/* Signed distance of x from the faces in the list.  Of faces whose nearest points agree within rounding (a
 * shared edge or corner) the one that x is most in front of tells the side: its plane passes between x and
 * the others. */
static fl_nearest nearest_of(const fl_poly *p, const int32_t *face, int32_t n, fl_vec3 x)
{
    fl_nearest best = {.d = INFINITY};
    double front = 0.0;
    const double same = 1e-12 * p->size;
    for (int32_t k = 0; k < n; k++) {
        const int32_t f = face[k];
        const double s = v3_dot(p->n[f], x) - p->c[f];
        if (fabs(s) > best.d + same) continue;
        const fl_nearest q = fl_nearest_face(p, f, x);
        if (q.d > best.d + same) continue;
        if (q.d < best.d - same || fabs(s) > fabs(front)) {
            best = q;
            front = s;
        }
    }
    if (front < 0.0) {
        best.d = -best.d;
        best.n = v3_neg(best.n);
    }
    return best;
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
static int whole(fl_reach *r, const fl_poly *a)
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
static int around(fl_reach *r, const fl_poly *core, const fl_shell *sh, fl_aabb box, double ra, double reach)
{
    fl_err lost = {0};
    r->faces = query(&sh->tree, sh->box, aabb_grow(box, reach), &r->face, &r->face_cap);
    r->edges = r->vertices = 0;
    if (r->faces <= 0) return r->faces;
    qsort(r->face, (size_t)r->faces, sizeof *r->face, ascending);
    box = aabb_grow(box, ra);
    r->edges = query(&sh->edges, sh->edge_box, box, &r->edge, &r->edge_cap);
    if (r->edges < 0) return -1;
    if (r->edges > 0) qsort(r->edge, (size_t)r->edges, sizeof *r->edge, ascending);
    if (sh->corners && fl_grow(&r->vertex, &r->vertex_cap, sh->corners, sizeof *r->vertex, &lost)) return -1;
    for (int32_t k = 0; k < sh->corners; k++) {
        const fl_vec3 x = core->v[sh->corner[k]];
        if (aabb_meet((fl_aabb){x, x}, box)) r->vertex[r->vertices++] = sh->corner[k];
    }
    return 0;
}

/* The vertices of the core: signed distances from the walls.  *behind is set when one is behind the surface;
 * the places of those are added here, or, for `single`, the place of the deepest. */
static int core_vertices(fl_places *w, const fl_side *A, const fl_side *B, const fl_matches *l, double ra,
                         int single, int *behind)
{
    fl_nearest deepest = {.d = ra};
    int32_t which = -1;
    *behind = 0;
    for (int32_t v = 0; v < A->p->nv; v++) {
        const fl_nearest q = nearest_of(B->p, l->wall, l->walls, w->va[v]);
        if (q.d < deepest.d) deepest = q, which = v;
        if (single || q.d >= 0.0) continue;
        *behind = 1;
        if (fl_places_vertex(w, A, 0.0, v, q.n, ra - q.d)) return -1;
    }
    return single && which >= 0 ? fl_places_point(w, w->va[which], deepest.n, ra - deepest.d, ra) : 0;
}

/* The walls within reach, and what of them and of the core may have places, until the pair has moved by the
 * margin. */
static int list_matches(fl_places *w, fl_shell_near *near, const fl_side *A, const fl_side *B,
                        const fl_shell *shell, double ra, double reach, fl_matches *l, double path)
{
    const double margin = FL_PLACE_MARGIN * ra;
    fl_reach *walls = &near->of_shell, *all = &near->of_core;
    fl_aabb box = aabb_empty();
    fl_err lost = {0};
    for (int32_t v = 0; v < A->p->nv; v++) box = aabb_add(box, w->va[v]);
    if (around(walls, B->p, shell, box, ra + margin, reach + margin)) return -1;
    if (walls->faces && fl_grow(&l->wall, &l->wall_cap, walls->faces, sizeof *l->wall, &lost)) return -1;
    for (int32_t k = 0; k < walls->faces; k++) l->wall[k] = walls->face[k];
    l->walls = walls->faces;
    return whole(all, A->p) || fl_matches_list(l, A, all, B, walls, ra, ra, margin, path) ? -1 : 0;
}

int fl_shell_places(fl_places *w, fl_shell_near *near, const fl_poly *a, const fl_piece *b, double ra,
                    double reach, int single, fl_matches *l, double path, double *distance)
{
    const fl_poly *core = &b->core;
    const fl_side A = {a, w->va, w->na, ra, 1.0}, B = {core, core->v, core->n, 0.0, -1.0};
    int behind;
    w->n = 0;
    w->couple = v3(0, 0, 0);
    *distance = reach;
    if (path >= l->until && list_matches(w, near, &A, &B, &b->shell, ra, reach, l, path)) return -1;
    if (l->walls == 0) {
        l->until = path; /* what is not near now is not known later */
        return 0;
    }
    *distance = ra; /* something is near: no bound is claimed */
    if (core_vertices(w, &A, &B, l, ra, single, &behind) || single) return single ? 0 : -1;
    return fl_matches_places(w, l, &A, &B, ra, behind ? ra : 0.0, FL_PLACE_RIM * ra, 0.0);
}

void fl_shell_near_free(fl_shell_near *near)
{
    fl_reach_free(&near->of_shell), fl_reach_free(&near->of_core);
}
