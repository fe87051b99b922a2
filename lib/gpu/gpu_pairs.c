/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "gpu/gpu_pairs.h"
#include <math.h>
#include <string.h>
#include "base/array.h"
#include "body/integrate.h"
#include "contact/active_pairs.h"
#include "contact/pair_force.h"
#include "contact/pair_law.h"
#include "contact/pair_store.h"
#include "contact/point_force.h"
#include "contact/strip_contact.h"
#include "world/access.h"

#define PUT FL_GPU_PUT
#define ROOM FL_GPU_ROOM
#define GET FL_GPU_GET

/* --- which bodies -------------------------------------------------------------------------------- */

/* Relative margin of the path until the next search. */
#define PATH_MARGIN 1e-6

/* 1 if near pair c may touch before the next search: no two bodies move by more than the skin. */
static int is_in_reach(const fl_world *w, int32_t c)
{
    const double *const from = w->odometer_at_search;
    const fl_next_check q = w->next_check[c];
    return !((from[q.i] + from[q.j] + w->skin) * (1.0 + PATH_MARGIN) < w->pair[c].free_travel) ||
           w->pair[c].touching;
}

/* 1 if a device evaluates pairs of a sphere with piece or wall j: a cone, a convex solid or a closed mesh at
 * rest or moving as prescribed, by springs at the closest point. */
static int has_kernel(const fl_world *w, int32_t i, int32_t j)
{
    const fl_piece *piece = fl_world_piece(w, j);
    if (!piece || piece->kind == FL_PIECE_PLANE) return 0;
    if (piece->kind == FL_PIECE_MESH && (!piece->mesh.closed || piece->mesh.thin || piece->one_sided))
        return 0;
    const fl_pair_law *law = fl_pair_law_of(w, i, j);
    return !piece->elastic && !piece->several_parts && !fl_piece_is_free(w, j) && !w->cell.periodic &&
           law->law->end_speed && law->law->points != FL_POINTS_FEATURES && !(law->rolling > 0.0) &&
           !w->panel_load.panels && !fl_pair_has_strip(w, j);
}

static int is_guided(const fl_world *w, int32_t k) { return w->inflow.absent && w->inflow.guided[k]; }

/* Lists the faces of a mesh for near pair c.  1 if the sphere can touch a single wall until the next search,
 * 0 if not, -1 when memory runs out. */
static int list_tiles(struct fl_gpu_world *g, fl_world *w, int32_t c, fl_err *err)
{
    const fl_neighbour_pair *q = &w->pair[c];
    const fl_vec3 off = fl_separation(w, q->i, q->j, q->image);
    fl_feature_pairs l = {.candidates = 0};
    const int single = fl_mesh_contact_single_wall(&w->mesh_near[0], fl_world_piece(w, q->j),
                                                   v3_neg(m3_tmul(fl_body_axes(&w->b, q->j), off)),
                                                   w->b.radius[q->i], w->skin * (1.0 + PATH_MARGIN), &l);
    int rc = single;
    if (single > 0 &&
        (fl_grow(&g->tile, &g->tile_cap, (int64_t)g->tiles + l.candidates, sizeof *g->tile, err) ||
         fl_grow(&g->tiles_of, &g->listed_cap, (int64_t)g->listed + 1, sizeof *g->tiles_of, err)))
        rc = -1;
    if (rc > 0) {
        memcpy(g->tile + g->tiles, l.candidate, (size_t)l.candidates * sizeof *l.candidate);
        g->tiles_of[g->listed++] = (fl_gpu_tiles){c, g->tiles, l.candidates};
        g->tiles += l.candidates;
    }
    free(l.candidate);
    return rc;
}

int fl_gpu_body_kind(struct fl_gpu_world *g, fl_world *w, int32_t k, fl_err *err)
{
    if (fl_body_absent(w, k)) return FL_GPU_EMPTY;
    if (!w->b.is_isotropic[k] || w->contact_sums.one_each || w->previous_sums.one_each || w->relax.kind ||
        (is_guided(w, k) && w->sea.water && !w->discs.n) ||
        (w->driven_floes.track.n && fl_floe_is_driven(w, k)))
        return FL_GPU_GUEST;
    for (int32_t at = w->first_pair_of_body[k]; at < w->first_pair_of_body[k + 1]; at++) {
        const int32_t c = w->pairs_of_body[at], j = w->pair[c].j;
        if (!is_in_reach(w, c)) continue;
        if (!has_kernel(w, k, j)) return FL_GPU_GUEST;
        if (fl_world_piece(w, j)->kind != FL_PIECE_MESH) continue;
        const int single = list_tiles(g, w, c, err);
        if (single < 0) return -1;
        if (!single) return FL_GPU_GUEST;
    }
    return FL_GPU_OWN;
}

/* 1 if a wet sphere whose constraints have done work is in no batch of the CPU: its losses are rounded with
 * that work. */
static int is_always_single(const fl_world *w, int32_t k)
{
    return w->sea.water && w->b.work_of_constraints[k] != 0.0;
}

/* Number of pairs of own body k in reach; -1: it needs nothing of this file. */
static int32_t pairs_in_reach(const fl_world *w, int32_t k)
{
    int32_t n = 0;
    for (int32_t at = w->first_pair_of_body[k]; at < w->first_pair_of_body[k + 1]; at++)
        n += is_in_reach(w, w->pairs_of_body[at]);
    return n || w->b.fixed_dof[k] || w->contact_sums.slot[k] || w->previous_sums.slot[k] ||
                   fl_floe_is_driven(w, k) || is_always_single(w, k)
               ? n
               : -1;
}

/* --- up ------------------------------------------------------------------------------------------ */

static fl_gpu_pair_sum sum_of(const fl_contact_sum *s)
{
    return (fl_gpu_pair_sum){s->damping, s->damping_torque, s->friction, s->friction_torque, s->contacts};
}

static fl_gpu_near near_of(const fl_world *w, int32_t k, int32_t first)
{
    fl_gpu_near b = {.body = k,
                     .first = first,
                     .end = first,
                     .hold = w->b.fixed_dof[k],
                     .is_driven = fl_floe_is_driven(w, k),
                     .is_always_single = is_always_single(w, k) && !w->discs.n,
                     .work_of_constraints = w->b.work_of_constraints[k]};
    b.before = b.now = sum_of(fl_sums_before(w, k));
    if (w->previous_sums.slot[k]) {
        const fl_velocity_change *const kick = fl_kick_change(w, k), *const change =
                                                                         fl_predicted_change(w, k);
        b.kick_v = kick->v, b.kick_w = kick->w, b.change_v = change->v, b.change_w = change->w;
    }
    if (b.is_driven) b.spring = w->driven_floes.k[k], b.rest_height = w->driven_floes.rest_height[k];
    return b;
}

static fl_gpu_pair row_of(const fl_world *w, int32_t c)
{
    const fl_piece *const piece = fl_world_piece(w, w->pair[c].j);
    const fl_neighbour_pair *q = &w->pair[c];
    fl_pair made;
    const fl_pair *p = q->contact;
    if (!p) fl_neighbour_pair_expand(w, q, &made), p = &made;
    return (fl_gpu_pair){.memory = fl_pair_memory(p),
                         .forces = fl_pair_forces(p),
                         .law = {p->k, p->exponent, p->law->friction, p->law->tangential_ratio,
                                 p->law->impact_damping, p->law->slow_damping_factor},
                         .mass = p->mass,
                         .free_travel = q->free_travel,
                         .known = piece->kind == FL_PIECE_MESH
                                      ? fl_mesh_contact_known_distance(piece, w->b.radius[q->i])
                                      : 0.0,
                         .body = q->i,
                         .piece = q->j - w->n,
                         .pair = c,
                         .touching = q->touching};
}

/* Adds near pair c, with its faces. */
static void add_row(struct fl_gpu_world *g, const fl_world *w, int32_t c, int32_t *next)
{
    fl_gpu_pair *const r = &g->pair[g->pairs];
    *r = row_of(w, c);
    r->row = g->pairs++;
    while (*next < g->listed && g->tiles_of[*next].pair < c) ++*next;
    if (*next < g->listed && g->tiles_of[*next].pair == c)
        r->first_tile = g->tiles_of[*next].first, r->tiles = g->tiles_of[*next].n;
}

/* Lists them; the pairs of a body follow each other, in their order. */
static int list_near(struct fl_gpu_world *g, const fl_world *w, fl_err *err)
{
    int32_t next = 0; /* list of faces */
    g->nears = g->pairs = g->guided = 0;
    for (int32_t k = 0; k < w->n; k++) {
        const int32_t n = g->host[k] == FL_GPU_OWN ? pairs_in_reach(w, k) : -1;
        g->near_of[k] = 0;
        if (n < 0) continue;
        if (fl_grow(&g->near, &g->near_cap, (int64_t)g->nears + 1, sizeof *g->near, err) ||
            fl_grow(&g->pair, &g->pair_cap, (int64_t)g->pairs + n, sizeof *g->pair, err))
            return -1;
        fl_gpu_near *const b = &g->near[g->nears++];
        *b = near_of(w, k, g->pairs);
        if (is_guided(w, k)) {
            if (fl_grow(&g->guided_body, &g->guided_cap, (int64_t)g->guided + 1, sizeof *g->guided_body, err))
                return -1;
            g->guided_body[g->guided++] = k;
        }
        for (int32_t at = w->first_pair_of_body[k]; at < w->first_pair_of_body[k + 1]; at++)
            if (is_in_reach(w, w->pairs_of_body[at])) add_row(g, w, w->pairs_of_body[at], &next);
        b->end = g->pairs;
        g->near_of[k] = g->nears;
    }
    return 0;
}

/* Offsets of the arrays of a solid piece or a mesh in those of all. */
typedef struct {
    int64_t v, f, loop, cone, interval;
} piece_offsets;

static int has_faces(const fl_piece *p) { return p->kind == FL_PIECE_SOLID || p->kind == FL_PIECE_MESH; }

static piece_offsets after(piece_offsets at, const fl_piece *p)
{
    const int32_t nf = p->core.nf;
    if (!has_faces(p)) return at;
    at.v += p->core.nv, at.f += nf, at.loop += nf ? p->core.first[nf] : 0;
    for (int32_t c = 0; c < p->cones; c++) at.cone++, at.interval += p->free_cone[c].n;
    return at;
}

static int upload(struct fl_gpu_world *g, void *to, const void *from, int64_t n, size_t size, fl_err *err)
{
    return n > 0 && g->e->upload(to, from, (size_t)n * size) ? fl_gpu_fail(g, err) : 0;
}
#define UP(to, from, n) upload(g, to, from, n, sizeof *(from), err)

/* The cones of a mesh. */
static int put_cones(struct fl_gpu_world *g, const fl_piece *p, piece_offsets at, fl_gpu_piece *to,
                     fl_err *err)
{
    int32_t *const cone_of_face = g->v.piece_cone + at.f;
    to->free_cone = g->v.free_cone + at.cone;
    for (int32_t c = 0; c < p->cones; c++) {
        fl_free_cone one = p->free_cone[c];
        if (UP(g->v.free_interval + at.interval, one.free, one.n)) return -1;
        one.free = g->v.free_interval + at.interval;
        at.interval += one.n;
        if (UP(g->v.free_cone + at.cone + c, &one, 1)) return -1;
    }
    if (!p->mesh.cone_of_face) return 0;
    to->cone_of_face = cone_of_face;
    return UP(cone_of_face, p->mesh.cone_of_face, p->core.nf);
}

static int put_shape(struct fl_gpu_world *g, const fl_piece *p, piece_offsets at, int32_t k, fl_gpu_piece *to,
                     fl_err *err)
{
    const fl_poly *s = &p->core;
    to->core = (fl_poly){.nv = s->nv,
                         .nf = s->nf,
                         .v = g->v.piece_v + at.v,
                         .n = g->v.piece_n + at.f,
                         .c = g->v.piece_c + at.f,
                         .first = g->v.piece_first + at.f + k,
                         .loop = g->v.piece_loop + at.loop,
                         .size = s->size};
    if (UP(to->core.v, s->v, s->nv)) return -1;
    if (s->nf && (UP(to->core.n, s->n, s->nf) || UP(to->core.c, s->c, s->nf) ||
                  UP(to->core.first, s->first, s->nf + 1) || UP(to->core.loop, s->loop, s->first[s->nf])))
        return -1;
    return p->kind == FL_PIECE_MESH ? put_cones(g, p, at, to, err) : 0;
}

/* Copies the shapes of the pieces, once. */
static int put_shapes(struct fl_gpu_world *g, const fl_world *w, fl_err *err)
{
    piece_offsets all = {0}, at = {0};
    for (int32_t k = 0; k < w->pieces; k++) all = after(all, &w->structure.piece[k]);
    if (ROOM(piece_v, all.v) || ROOM(piece_n, all.f) || ROOM(piece_c, all.f) || ROOM(piece_loop, all.loop) ||
        ROOM(piece_first, all.f + w->pieces) || ROOM(piece_cone, all.f) || ROOM(free_cone, all.cone) ||
        ROOM(free_interval, all.interval))
        return -1;
    for (int32_t k = 0; k < w->pieces; k++) {
        const fl_piece *p = &w->structure.piece[k];
        g->piece[k] = (fl_gpu_piece){.kind = (int32_t)p->kind,
                                     .r0 = p->r0,
                                     .r1 = p->r1,
                                     .h = p->h,
                                     .facet_error = p->facet_error,
                                     .radius = w->b.radius[w->n + k]};
        if (has_faces(p) && put_shape(g, p, at, k, &g->piece[k], err)) return -1;
        at = after(at, p);
    }
    return 0;
}

/* Copies the poses of the pieces. */
static int put_poses(struct fl_gpu_world *g, const fl_world *w, fl_err *err)
{
    const fl_bodies *b = &w->b;
    for (int32_t k = 0; k < w->pieces; k++) {
        const int32_t j = w->n + k;
        fl_gpu_piece *const p = &g->piece[k];
        p->R = fl_body_axes(b, j), p->x = b->x[j], p->v = b->v[j], p->w = b->w[j];
        p->change_v = p->change_w = v3(0, 0, 0);
        if (fl_sums_before(w, j)->contacts)
            p->change_v = fl_predicted_change(w, j)->v, p->change_w = fl_predicted_change(w, j)->w;
        p->odometer = b->odometer[j];
    }
    return PUT(piece, g->piece, w->pieces);
}

int fl_gpu_put_near(struct fl_gpu_world *g, fl_world *w, fl_err *err)
{
    if (!g->near_of) {
        g->near_of = fl_alloc(w->n, sizeof *g->near_of, err);
        g->piece = fl_alloc(w->pieces, sizeof *g->piece, err);
        if (!g->near_of || (w->pieces && !g->piece) || put_shapes(g, w, err)) return -1;
    }
    if (list_near(g, w, err)) return -1;
    free(g->told_pair);
    g->told_pair = fl_alloc(g->pairs, sizeof *g->told_pair, err);
    g->v.nears = g->nears, g->v.pairs = g->pairs;
    return (g->pairs && !g->told_pair) || PUT(near_of, g->near_of, w->n) ||
                   PUT(near_body, g->near, g->nears) || PUT(tile, g->tile, g->tiles) ||
                   PUT(pair, g->pair, g->pairs) || ROOM(pair_count, (int64_t)g->pairs + 1) ||
                   ROOM(told_pair, g->pairs) || put_poses(g, w, err)
               ? -1
               : 0;
}

void fl_gpu_drift_guided(const struct fl_gpu_world *g, fl_world *w)
{
    for (int32_t m = 0; m < g->guided; m++) {
        const int32_t k = g->guided_body[m];
        if (w->inflow.guided[k]) w->b.x[k] = v3_madd(w->b.x[k], w->dt, w->b.v[k]);
    }
}

int fl_gpu_set_hold(struct fl_gpu_world *g, const fl_world *w, int32_t k, fl_err *err)
{
    const int32_t m = g->near_of[k] - 1;
    const fl_sym3 e = fl_body_mobility(&w->b, k).linear;
    const fl_vec3 yields = v3(e.xx, e.yy, e.zz);
    const double inverse = fl_body_inverse_mass(&w->b, k);
    const uint32_t hold = g->near[m].hold = w->b.fixed_dof[k];
    return g->e->upload(&g->v.near_body[m].hold, &hold, sizeof hold) ||
                   g->e->upload(&g->v.yields[k], &yields, sizeof yields) ||
                   g->e->upload(&g->v.inverse[k], &inverse, sizeof inverse)
               ? fl_gpu_fail(g, err)
               : 0;
}

int fl_gpu_begin_pairs(struct fl_gpu_world *g, fl_world *w, fl_err *err)
{
    for (int32_t r = 0; r < g->pairs; r++) w->next_check[g->pair[r].pair].free_travel = INFINITY;
    if (!g->pairs || g->pairs_known) return 0;
    if (fl_structure_moves(w) && put_poses(g, w, err)) return -1;
    if (FL_GPU_LAUNCH(PAIRS, g->pairs)) return -1;
    if (g->e->offsets(g->v.pair_count, g->pairs + 1)) return fl_gpu_fail(g, err);
    return FL_GPU_LAUNCH(TELL_PAIRS, g->pairs);
}

/* --- down ---------------------------------------------------------------------------------------- */

/* Puts row r into its pair; it touches or not. */
static int set_pair(fl_world *w, const fl_gpu_pair *r)
{
    fl_neighbour_pair *const q = &w->pair[r->pair];
    fl_pair made, *p = q->contact;
    if (!p) fl_neighbour_pair_expand(w, q, p = &made);
    fl_pair_set_point(p, &r->memory, &r->forces);
    p->touching = r->touching;
    p->index = r->pair;
    p->free_travel = r->free_travel;
    if (!r->touching) p->omega2_i = p->omega2_j = 0.0;
    if (fl_neighbour_pair_put_back(w, q, p)) return -1;
    w->pair_touches[r->pair] = (uint8_t)(r->touching != 0);
    return 0;
}

/* A pair that touches, after its evaluation in a step. */
static int take_pair(fl_world *w, const fl_gpu_pair *r, int survey)
{
    const int begins = !w->pair[r->pair].touching;
    if (set_pair(w, r)) return -1;
    fl_pair *const p = w->pair[r->pair].contact;
    p->omega2_i = p->omega2_j = 0.0;
    if (survey) fl_pair_bound_single_point(w, p, r->n, r->aj, r->off, r->normal);
    if (begins) fl_pair_note_beginning(w, p, r->moved);
    w->body_touches[p->i] = w->body_touches[p->j] = 1;
    return 0;
}

static void set_sums(fl_world *w, const fl_gpu_near *b)
{
    const int32_t k = b->body, now = w->contact_sums.slot[k], before = w->previous_sums.slot[k];
    const fl_gpu_pair_sum *const s[2] = {&b->now, &b->before};
    fl_contact_sum *const to[2] = {now ? &w->contact_sums.sum[now] : NULL,
                                   before ? &w->previous_sums.sum[before] : NULL};
    for (int e = 0; e < 2; e++)
        if (to[e])
            *to[e] = (fl_contact_sum){s[e]->damping, s[e]->damping_torque, s[e]->friction,
                                      s[e]->friction_torque, (int32_t)s[e]->contacts};
    w->b.work_of_constraints[k] = b->work_of_constraints;
    if (!before) return;
    w->kick_change[before] = (fl_velocity_change){b->kick_v, b->kick_w};
    w->predicted_change[before] = (fl_velocity_change){b->change_v, b->change_w};
}

/* Evaluates row r here, with the numbers of its sphere now, and gives it back. */
static int evaluate_here(struct fl_gpu_world *g, fl_world *w, const fl_gpu_pair *r, int survey, fl_err *err)
{
    const int32_t i = r->body, c = r->pair;
    fl_gpu_near near;
    fl_sphere_state s;
    if (fl_gpu_get_bytes(g, &near, &g->v.near_body[g->near_of[i] - 1], sizeof near, err) ||
        fl_gpu_get_bytes(g, &s, &g->v.state[i], sizeof s, err) ||
        fl_gpu_get_bytes(g, &w->b.odometer[i], &g->v.odometer[i], sizeof *w->b.odometer, err) ||
        fl_gpu_get_bytes(g, &w->spheres.previous_contact_count[i], &g->v.contact_count[i],
                         sizeof *w->spheres.contact_count, err))
        return -1;
    w->b.x[i] = s.x, w->b.v[i] = s.v, w->b.w[i] = s.w;
    if (w->b.heave_mass &&
        fl_gpu_get_bytes(g, &w->b.heave_mass[i], &g->v.heave_mass[i], sizeof *w->b.heave_mass, err))
        return -1;
    set_sums(w, &near);
    if (set_pair(w, r)) return fl_fail(err, FL_SYSTEM, "out of memory");
    fl_evaluate_neighbour_pair(w, c, 0, NULL, w->dt, survey);
    const fl_neighbour_pair *q = &w->pair[c];
    w->pair_touches[c] = q->touching;
    if (q->touching) w->body_touches[q->i] = w->body_touches[q->j] = 1;
    fl_gpu_pair row = row_of(w, c);
    row.row = r->row, row.first_tile = r->first_tile, row.tiles = r->tiles;
    return UP(&g->v.pair[r->row], &row, 1);
}

int fl_gpu_take_pairs(struct fl_gpu_world *g, fl_world *w, int32_t touching, int survey, fl_err *err)
{
    if (!g->pairs || g->pairs_known) return 0;
    if (GET(told_pair, g->told_pair, touching)) return -1;
    for (int32_t r = 0; r < g->pairs; r++) w->pair_touches[g->pair[r].pair] = 0;
    for (int32_t r = 0; r < touching; r++)
        if (g->told_pair[r].undecided) {
            if (evaluate_here(g, w, &g->told_pair[r], survey, err)) return -1;
        } else if (take_pair(w, &g->told_pair[r], survey)) {
            return fl_fail(err, FL_SYSTEM, "out of memory");
        }
    for (int32_t r = 0; r < g->pairs; r++) {
        fl_neighbour_pair *const q = &w->pair[g->pair[r].pair];
        if (q->touching && !w->pair_touches[g->pair[r].pair]) q->touching = 0, q->contact->touching = 0;
    }
    return 0;
}

int fl_gpu_get_near(struct fl_gpu_world *g, fl_world *w, fl_err *err)
{
    if (GET(near_body, g->near, g->nears) || GET(pair, g->pair, g->pairs)) return -1;
    for (int32_t m = 0; m < g->nears; m++) set_sums(w, &g->near[m]);
    for (int32_t r = 0; r < g->pairs; r++) {
        if (set_pair(w, &g->pair[r])) return fl_fail(err, FL_SYSTEM, "out of memory");
        fl_set_next_check(w, g->pair[r].pair);
    }
    return 0;
}

void fl_gpu_near_free(struct fl_gpu_world *g)
{
    free(g->near_of), free(g->near), free(g->pair), free(g->told_pair), free(g->piece);
    free(g->guided_body), free(g->tile), free(g->tiles_of);
}
