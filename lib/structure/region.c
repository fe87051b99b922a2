/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "structure/region.h"
#include <string.h>
#include "base/array.h"
#include "structure/region_cut.h"
#include "structure/region_join.h"

/* Distance within which members touch, over the diagonal of all of them: coordinates that went through 32-bit
 * floats, as in STL, are rounded by 6e-8 of the largest of them (coplanar_regions.c has the same). */
#define TOUCH_TOL 1e-6

static fl_aabb box_of_piece(const fl_piece *p)
{
    fl_aabb box = aabb_empty();
    for (int32_t k = 0; k < p->core.first[p->core.nf]; k++)
        box = aabb_add(box, v3_add(p->x, q_rotate(p->q, p->core.v[p->core.loop[k]])));
    return box;
}

static double diagonal_of(fl_aabb box) { return v3_norm(v3_sub(box.hi, box.lo)); }

/* The pieces that hang together, by a forest; the root is the first of them. */
typedef struct {
    int32_t *parent;
    fl_aabb *box;
} grouping;

static int32_t root_of(int32_t *parent, int32_t k)
{
    while (parent[k] != k) k = parent[k] = parent[parent[k]];
    return k;
}

/* Joins the pieces that touch. */
static int find_groups(grouping *g, const fl_structure *s, const int32_t *mover, fl_err *err)
{
    fl_bvh tree = {0};
    fl_aabb all = aabb_empty();
    int32_t *near = NULL, cap = 0;
    int rc = -1;
    g->parent = fl_alloc(s->n, sizeof *g->parent, err);
    g->box = fl_alloc(s->n, sizeof *g->box, err);
    if (!g->parent || !g->box) goto done;
    for (int32_t k = 0; k < s->n; k++) g->parent[k] = k, g->box[k] = box_of_piece(&s->piece[k]);
    if (fl_bvh_build(&tree, g->box, s->n, err) || fl_grow(&near, &cap, s->n, sizeof *near, err)) goto done;
    for (int32_t k = 0; k < s->n; k++) all = aabb_join(all, g->box[k]);
    for (int32_t k = 0; k < s->n; k++) {
        const int32_t n = fl_bvh_query(&tree, g->box, aabb_grow(g->box[k], TOUCH_TOL * diagonal_of(all)), near, cap);
        for (int32_t c = 0; c < n; c++) {
            const int32_t j = near[c];
            const fl_piece *a = &s->piece[k], *b = &s->piece[j];
            if (j <= k || root_of(g->parent, j) == root_of(g->parent, k)) continue;
            if (mover && mover[a->part] != mover[b->part]) continue;
            const int touch = fl_pieces_touch(a, b, TOUCH_TOL * diagonal_of(aabb_join(g->box[k], g->box[j])), err);
            if (touch < 0) goto done;
            const int32_t x = root_of(g->parent, k), y = root_of(g->parent, j);
            if (touch) g->parent[x > y ? x : y] = x < y ? x : y;
        }
    }
    rc = 0;
done:
    free(near);
    fl_bvh_free(&tree);
    return rc;
}

static int is_longer(fl_aabb box, fl_vec3 period)
{
    const fl_vec3 d = v3_sub(box.hi, box.lo);
    for (int k = 0; k < 3; k++)
        if (v3_at(period, k) > 0.0 && v3_at(d, k) > v3_at(period, k) * (1.0 + 1e-9)) return 1;
    return 0;
}

/* Makes the piece of the union of piece[of[0 .. n)] after the others.  Returns 1, or 0 if its surface has holes
 * that its members do not have, or cannot be made. */
static int join_pieces(fl_structure *s, const fl_surface *surface, int32_t n, const int32_t *of, fl_aabb box,
                       fl_err *err)
{
    fl_region_surface cut;
    fl_part part = {.name = surface->part[s->piece[of[0]].part].name, .id = -1};
    fl_err no = {0};
    uint8_t *thin = NULL;
    int32_t rims = 0;
    int made = -1;
    if (fl_region_cut(&cut, s->piece, n, of, TOUCH_TOL * diagonal_of(box), err)) return -1;
    if (fl_region_join(&part, &thin, &rims, &cut, err)) goto done;
    made = cut.open || rims == 0;
    if (made && (part.nt == 0 || fl_structure_add_joined(s, &part, thin, s->piece[of[0]].part, &no))) {
        made = 0;
        if (no.code == FL_SYSTEM) *err = no, made = -1;
    }
done:
    part.name = NULL;
    fl_part_free(&part);
    free(thin);
    fl_region_surface_free(&cut);
    return made;
}

/* Lists the members of the last piece, and frees the pieces they were. */
static int take_members(fl_structure *s, int32_t n, const int32_t *of, uint8_t *gone, fl_err *err)
{
    fl_piece *to = &s->piece[s->n - 1];
    to->member = fl_alloc(n, sizeof *to->member, err);
    if (!to->member) return -1;
    for (int32_t k = 0; k < n; k++) {
        fl_piece *from = &s->piece[of[k]];
        to->member[k] = (fl_piece_member){from->part, from->cone};
        if (from->part != to->part) to->several_parts = 1;
        gone[of[k]] = 1;
    }
    to->members = n;
    return 0;
}

int fl_regions_join(fl_structure *s, const fl_surface *surface, const int32_t *mover, fl_vec3 period,
                    fl_err *err)
{
    grouping g = {0};
    const int32_t all = s->n;
    int32_t *of = NULL;
    uint8_t *gone = NULL;
    int rc = -1;
    if (s->n < 2) return 0;
    of = fl_alloc(s->n, sizeof *of, err);
    gone = fl_alloc(2 * (int64_t)s->n, 1, err);
    if (!of || !gone || find_groups(&g, s, mover, err)) goto done;
    for (int32_t k = 0; k < all; k++) {
        int32_t n = 0;
        fl_aabb box = aabb_empty();
        for (int32_t j = k; j < all && g.parent[k] == k; j++)
            if (root_of(g.parent, j) == k) of[n++] = j, box = aabb_join(box, g.box[j]);
        if (n < 2 || is_longer(box, period)) continue;
        const int made = join_pieces(s, surface, n, of, box, err);
        if (made < 0 || (made && take_members(s, n, of, gone, err))) goto done;
        if (!made) s->unjoined++, s->unjoined_part = s->piece[k].part;
    }
    int32_t kept = 0;
    for (int32_t k = 0; k < s->n; k++) {
        if (gone[k]) fl_piece_free(&s->piece[k]);
        else s->piece[kept++] = s->piece[k];
    }
    s->n = kept;
    rc = 0;
done:
    free(of), free(gone), free(g.parent), free(g.box);
    return rc;
}
