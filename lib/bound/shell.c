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

int fl_shell_places(fl_places *w, fl_shell_near *near, const fl_poly *a, const fl_piece *b, fl_mat3 M,
                    fl_vec3 o, double ra, double reach, double *distance)
{
    const fl_poly *core = &b->core;
    const fl_shell *sh = &b->shell;
    fl_aabb box = aabb_empty();
    w->n = 0;
    *distance = reach;
    for (int32_t v = 0; v < a->nv; v++) box = aabb_add(box, w->va[v]);
    const int32_t nf = query(&sh->tree, sh->box, aabb_grow(box, reach), &near->face, &near->face_cap);
    if (nf <= 0) return nf;
    *distance = ra; /* something is near: no bound is claimed */
    qsort(near->face, (size_t)nf, sizeof *near->face, ascending);
    box = aabb_grow(box, ra);
    for (int32_t v = 0; v < a->nv; v++) {
        const fl_nearest q = nearest_of(core, near->face, nf, w->va[v]);
        if (q.d < ra && fl_places_vertex(w, v, w->va[v], q.n, ra - q.d, ra)) return -1;
    }
    for (int32_t k = 0; k < sh->corners; k++) {
        const fl_vec3 x = core->v[sh->corner[k]];
        if (!aabb_meet((fl_aabb){x, x}, box)) continue;
        const fl_nearest q = fl_nearest_poly(a, m3_tmul(M, v3_sub(x, o)));
        const fl_vec3 n = v3_neg(m3_mul(M, q.n));
        if (q.d < ra &&
            fl_places_vertex(w, (int64_t)a->nv + sh->corner[k], v3_madd(x, q.d, n), n, ra - q.d, ra))
            return -1;
    }
    const int32_t ne = query(&sh->edges, sh->edge_box, box, &near->edge, &near->edge_cap);
    if (ne < 0) return -1;
    if (ne > 0) qsort(near->edge, (size_t)ne, sizeof *near->edge, ascending);
    for (int32_t i = 0; i < a->ne; i++) {
        const fl_vec3 a0 = w->va[a->edge[i].a], a1 = w->va[a->edge[i].b];
        const fl_aabb reached = aabb_grow(aabb_add((fl_aabb){a0, a0}, a1), ra);
        for (int32_t k = 0; k < ne; k++) {
            const int32_t e = near->edge[k];
            if (!aabb_meet(reached, sh->edge_box[e])) continue;
            const int64_t key = (int64_t)a->nv + core->nv + (int64_t)i * core->ne + e;
            if (fl_places_edges(w, key, a0, a1, core->v[core->edge[e].a], core->v[core->edge[e].b], ra, 0.0,
                                0.0))
                return -1;
        }
    }
    return 0;
}

void fl_shell_near_free(fl_shell_near *near)
{
    free(near->face), free(near->edge);
    *near = (fl_shell_near){0};
}
