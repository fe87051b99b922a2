/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "structure/region.h"
#include "base/array.h"
#include "structure/region_cone.h"
#include "structure/region_cut.h"
#include "structure/region_join.h"

/* Distance within which members touch, over the diagonal of all of them: coordinates that went through 32-bit
 * floats, as in STL, are rounded by 6e-8 of the largest of them (coplanar_regions.c has the same). */
#define TOUCH_TOL 1e-6

/* Corners and edges of two members may lie within that of each other by chance, so that the cuts of one do
 * not fit those of the other.  Then smaller tolerances are tried, by tenths. */
enum { FINER = 5 };

/* Distance of the facets of a cone from it, over its radius: the facets are 1 - cos(pi/96) = 5.4e-4 deep, and
 * some of that is on either side. */
#define FACET_ERROR 1e-3

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
    for (int32_t k = 0; k < s->n; k++) g->parent[k] = k, g->box[k] = fl_piece_box(&s->piece[k]);
    if (fl_bvh_build(&tree, g->box, s->n, err) || fl_grow(&near, &cap, s->n, sizeof *near, err)) goto done;
    for (int32_t k = 0; k < s->n; k++) all = aabb_join(all, g->box[k]);
    for (int32_t k = 0; k < s->n; k++) {
        const int32_t n =
            fl_bvh_query(&tree, g->box, aabb_grow(g->box[k], TOUCH_TOL * diagonal_of(all)), near, cap);
        for (int32_t c = 0; c < n; c++) {
            const int32_t j = near[c];
            const fl_piece *a = &s->piece[k], *b = &s->piece[j];
            if (j <= k || root_of(g->parent, j) == root_of(g->parent, k)) continue;
            if (mover && mover[a->part] != mover[b->part]) continue;
            const int touch =
                fl_pieces_touch(a, b, TOUCH_TOL * diagonal_of(aabb_join(g->box[k], g->box[j])), err);
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

/* The bodies of a region: its pieces, but that cones which continue one another are one. */
typedef struct {
    int32_t n, united;
    const fl_piece **body; /* [n] */
    fl_piece *cone;        /* [united] */
} region_bodies;

static void bodies_free(region_bodies *r)
{
    for (int32_t k = 0; k < r->united; k++) fl_piece_free(&r->cone[k]);
    free(r->body), free(r->cone);
}

/* Unites body k with others as long as there are any. */
static int unite_cone(region_bodies *r, int32_t k, double tol, fl_err *err)
{
    for (int32_t j = k + 1; j < r->n && r->body[k]->kind == FL_PIECE_CONE; j++) {
        if (r->body[j]->kind != FL_PIECE_CONE) continue;
        const int one = fl_cones_unite(&r->cone[r->united], r->body[k], r->body[j], tol, err);
        if (one < 0) return -1;
        if (!one) continue;
        r->body[k] = &r->cone[r->united++];
        for (int32_t m = j--; m + 1 < r->n; m++) r->body[m] = r->body[m + 1];
        r->n--;
        j = k; /* the longer one may reach others */
    }
    return 0;
}

static int list_bodies(region_bodies *r, const fl_structure *s, int32_t n, const int32_t *of, double tol,
                       fl_err *err)
{
    *r = (region_bodies){.n = n};
    r->body = fl_alloc(n, sizeof *r->body, err);
    r->cone = fl_alloc(n, sizeof *r->cone, err);
    if (!r->body || !r->cone) return -1;
    for (int32_t k = 0; k < n; k++) r->body[k] = &s->piece[of[k]];
    for (int32_t k = 0; k < r->n; k++)
        if (unite_cone(r, k, tol, err)) return -1;
    return 0;
}

/* Finds where the cones of a joined piece are free, in its frame. */
static int add_free_cones(fl_piece *to, const region_bodies *r, double tol, fl_err *err)
{
    if (!to->mesh.cone_of_face) return 0;
    to->free_cone = fl_alloc(r->n, sizeof *to->free_cone, err);
    if (!to->free_cone) return -1;
    for (to->cones = 0; to->cones < r->n; to->cones++) {
        fl_free_cone *c = &to->free_cone[to->cones];
        if (r->body[to->cones]->kind != FL_PIECE_CONE) continue;
        if (fl_cone_find_free(c, r->n, r->body, to->cones, tol, err)) return -1;
        c->x = q_rotate(q_conj(to->q), v3_sub(c->x, to->x));
        c->q = q_mul(q_conj(to->q), c->q);
        to->facet_error = fmax(to->facet_error, FACET_ERROR * fmax(c->r0, c->r1));
    }
    return 0;
}

/* Makes the piece of the union of the bodies after the others: 1, or 0 if its surface has holes that the
 * bodies do not have, or cannot be made. */
static int join_bodies(fl_structure *s, const fl_surface *surface, const region_bodies *r, int32_t part,
                       double tol, fl_err *err)
{
    fl_region_surface cut;
    fl_part joined = {.name = surface->part[part].name, .id = -1};
    fl_err no = {0};
    fl_joined_triangle *of = NULL;
    int32_t rims = 0;
    int made = -1;
    if (fl_region_cut(&cut, r->n, r->body, tol, err)) return -1;
    if (fl_region_join(&joined, &of, &rims, &cut, err)) goto done;
    made = joined.nt > 0 && (cut.open || rims == 0);
    if (made && fl_structure_add_joined(s, &joined, of, part, &no)) {
        made = 0;
        if (no.code == FL_SYSTEM) *err = no, made = -1;
    }
done:
    joined.name = NULL;
    fl_part_free(&joined);
    free(of);
    fl_region_surface_free(&cut);
    return made;
}

/* Makes the piece of the union of piece[of[0 .. n)] after the others.  Returns as join_bodies(). */
static int join_pieces(fl_structure *s, const fl_surface *surface, int32_t n, const int32_t *of, fl_aabb box,
                       fl_err *err)
{
    const double tol = TOUCH_TOL * diagonal_of(box);
    const int32_t part = s->piece[of[0]].part;
    region_bodies r = {0};
    int made = -1;
    /* the bodies point to pieces, which must not move */
    if (fl_grow(&s->piece, &s->cap, (int64_t)s->n + 1, sizeof *s->piece, err) == 0 &&
        list_bodies(&r, s, n, of, tol, err) == 0) {
        if (r.n == 1) { /* one long cone */
            s->piece[s->n++] = r.cone[--r.united];
            made = 1;
        } else {
            double by = tol;
            for (int k = 0; k < FINER && (made = join_bodies(s, surface, &r, part, by, err)) == 0; k++)
                by *= 0.1;
            if (made > 0 && add_free_cones(&s->piece[s->n - 1], &r, tol, err)) made = -1;
        }
    }
    bodies_free(&r);
    return made;
}

/* Lists the members of the last piece, and marks the pieces that they were. */
static int take_members(fl_structure *s, int32_t n, const int32_t *of, uint8_t *gone, fl_err *err)
{
    fl_piece *to = &s->piece[s->n - 1];
    to->member = fl_alloc(n, sizeof *to->member, err);
    if (!to->member) return -1;
    for (int32_t k = 0; k < n; k++) {
        const fl_piece *from = &s->piece[of[k]];
        to->member[k] = (fl_piece_member){from->part, from->cone};
        if (from->part != to->part) to->several_parts = 1;
        gone[of[k]] = 1;
    }
    to->members = n;
    return 0;
}

/* Joining n cones takes a time of n2: 1.4 s of 104 cones, 7 s of 180, 42 s of 609. */
enum { MOST_CONES = 250 };

static int is_frame(const fl_structure *s, int32_t n, const int32_t *of)
{
    for (int32_t k = 0; k < n; k++)
        if (s->piece[of[k]].kind != FL_PIECE_CONE) return 0;
    return n > MOST_CONES;
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
        const int made = is_frame(s, n, of) ? 0 : join_pieces(s, surface, n, of, box, err);
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
