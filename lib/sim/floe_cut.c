/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "sim/floe_cut.h"
#include <math.h>
#include <stdlib.h>
#include "base/array.h"
#include "contact/active_pairs.h"
#include "contact/crushing.h"
#include "contact/pair_store.h"
#include "geom/clip.h"
#include "patch/mesh_under_face.h"
#include "sim/body_step.h"
#include "sim/energy_balance.h"
#include "sim/energy_ledger.h"
#include "sim/floe_setup.h"
#include "sim/neighbour_list.h"
#include "world/access.h"

/* Fewest places where none are given. */
enum { LEAST_ROOM = 64 };
/* Radii that are tried for a narrow half: r to r/16. */
enum { RADII = 5 };

static int breaks(const fl_scene *s)
{
    return s->failure.head.present &&
           (s->failure.flexural_strength < INFINITY || s->failure.fracture_toughness < INFINITY);
}

int32_t fl_fragment_places(const fl_scene *s, const fl_ice_field *field)
{
    if (!breaks(s)) return 0;
    if (s->failure.fragments_max > 0) return s->failure.fragments_max;
    return field->n > LEAST_ROOM ? field->n : LEAST_ROOM;
}

int fl_breaking_make(fl_world *w, fl_err *err)
{
    fl_breaking_state *s = &w->breaking;
    if (!breaks(w->scene)) return 0;
    if (w->has_points)
        return fl_scene_fail(w->scene, "failure.flexural_strength", err,
                             "spheres do not bend or split, and %s has some: ice of polyhedra is expected",
                             w->scene->ice.file);
    s->on = 1;
    s->least_area = w->scene->failure.fragment_min;
    s->shape = fl_alloc(w->n, sizeof *s->shape, err);
    s->last_load = fl_alloc(w->n, sizeof *s->last_load, err);
    s->bend_gate = fl_alloc(w->n, sizeof *s->bend_gate, err);
    s->split_gate = fl_alloc(w->n, sizeof *s->split_gate, err);
    return s->shape && s->last_load && s->bend_gate && s->split_gate ? 0 : -1;
}

static void free_shape(fl_poly **p)
{
    if (*p) fl_poly_free(*p);
    free(*p);
    *p = NULL;
}

void fl_breaking_free(fl_world *w)
{
    fl_breaking_state *s = &w->breaking;
    for (int32_t i = 0; s->shape && i < w->n; i++) free_shape(&s->shape[i]);
    free(s->shape), free(s->last_load), free(s->bend_gate), free(s->split_gate), free(s->event);
    *s = (fl_breaking_state){0};
}

void fl_breaking_forget(fl_world *w, int32_t i)
{
    fl_breaking_state *s = &w->breaking;
    if (!s->on) return;
    free_shape(&s->shape[i]);
    s->last_load[i] = s->bend_gate[i] = s->split_gate[i] = 0.0;
}

int fl_breaking_set_shape(fl_world *w, int32_t i, fl_poly *core, double r, fl_err *err)
{
    fl_poly *own = fl_alloc(1, sizeof *own, err);
    if (!own) {
        fl_poly_free(core);
        return -1;
    }
    *own = *core;
    *core = (fl_poly){0};
    fl_breaking_forget(w, i);
    w->breaking.shape[i] = own;
    return fl_world_place_shape(w, i, own, r, err);
}

/* --- the halves --------------------------------------------------------------------------------- */

/* A half: its core in the axes of the ice file, about the centre of the whole floe. */
typedef struct {
    fl_poly core;
    double radius; /* [m] */
    double volume; /* of the outer shape, for the choice of the larger one [m3] */
} floe_half;

static double volume_of(const fl_poly *p)
{
    double V = 0.0;
    for (int32_t f = 0; f < p->nf; f++)
        V += v3_dot(fl_poly_face_area_vector(p, f), p->v[p->loop[p->first[f]]]) / 3.0;
    return V;
}

/* Core of a part that keeps all its faces: of radius r, or of r/2, r/4, ... where it is too narrow for that.
 * 1, 0 if it is too narrow for all of them, -1 with FL_SYSTEM. */
static int inset_part(floe_half *h, const fl_poly *part, double r, fl_err *err)
{
    for (int k = 0; k < RADII; k++, r *= 0.5) {
        fl_err why = {0};
        if (fl_poly_offset(&h->core, part, -r, &why)) {
            if (why.code != FL_SYSTEM) continue;
            *err = why;
            return -1;
        }
        h->radius = r;
        if (h->core.nf == part->nf) return 1;
        fl_poly_free(&h->core);
    }
    return 0;
}

/* The part n.x <= c of `outer`; 1, 0 if it is too thin, -1 with FL_SYSTEM. */
static int make_half(floe_half *h, const fl_poly *outer, double r, fl_mat3 to_ice, fl_vec3 n, double c,
                     fl_err *err)
{
    fl_poly part = {0};
    fl_err why = {0};
    int rc = 0;
    if (fl_poly_copy(&part, outer, err)) return -1;
    if (fl_poly_cut(&part, n, c, &why) == 0 && part.nv > 0) rc = inset_part(h, &part, r, &why);
    if (rc > 0) {
        h->volume = volume_of(&part);
        fl_poly_to_frame(&h->core, v3(0, 0, 0), to_ice);
    }
    fl_poly_free(&part);
    if (why.code != FL_SYSTEM) return rc;
    *err = why;
    return -1;
}

/* What is kept of the floe while its place is filled anew. */
typedef struct {
    fl_vec3 x, v, spin, flow;
    fl_quat turn; /* ice file to world */
    double odometer;
} floe_before;

static int place_half(fl_world *w, int32_t i, floe_half *h, const floe_before *was, fl_err *err)
{
    fl_bodies *b = &w->b;
    fl_poly own;
    /* made anew from its vertices, as a checkpoint does */
    if (fl_poly_make(&own, h->core.nv, h->core.v, h->core.nf, h->core.first, h->core.loop, err) ||
        fl_breaking_set_shape(w, i, &own, h->radius, err))
        return -1;
    const fl_vec3 way = q_rotate(was->turn, b->x[i]);
    b->x[i] = v3_add(was->x, way);
    b->q[i] = q_mul(was->turn, b->q[i]);
    b->v[i] = v3_add(was->v, v3_cross(was->spin, way));
    fl_body_set_spin(b, i, was->spin);
    b->odometer[i] = w->odometer_at_search[i] = was->odometer;
    if (b->flow_velocity) b->flow_velocity[i] = was->flow;
    return 0;
}

/* --- contacts ----------------------------------------------------------------------------------- */

/* Frees what a pair has learnt of the shape of its bodies, and takes over the mass of the half. */
static void update_pair(const fl_world *w, fl_pair *p)
{
    fl_pair fresh;
    fl_pair_init(w, &fresh, p->i, p->j);
    p->mass = fresh.mass;
    p->k = p->crush ? p->crush->stiffening * fresh.k : fresh.k;
    if (p->feature_pairs) fl_mesh_under_face_free_pairs(p->feature_pairs);
    free(p->feature_pairs), free(p->surrogate);
    if (p->quick_list) fl_quick_list_free(p->quick_list);
    free(p->quick_list);
    p->feature_pairs = NULL;
    p->surrogate = NULL;
    p->quick_list = NULL;
    p->cache.n = 0;
    p->has_axis = p->cores_overlap = 0;
    p->free_travel = 0.0;
}

/* How a vector of the axes of the whole floe reads in those of a half. */
typedef struct {
    fl_quat turn;  /* axes of the whole to those of the half */
    fl_vec3 shift; /* centre of the half, in axes of the whole [m] */
} to_half;

static fl_vec3 point_in_half(const to_half *t, fl_vec3 x) { return q_rotate(t->turn, v3_sub(x, t->shift)); }

static to_half to_half_of(const fl_world *w, int32_t i, const floe_before *was, fl_quat q)
{
    return (to_half){q_mul(q_conj(w->b.q[i]), q), q_rotate(q_conj(q), v3_sub(w->b.x[i], was->x))};
}

static int compare_keys(const void *a, const void *b)
{
    const fl_neighbour_pair *p = a, *q = b;
    if (p->i != q->i) return p->i < q->i ? -1 : 1;
    if (p->j != q->j) return p->j < q->j ? -1 : 1;
    for (int k = 0; k < 3; k++)
        if (p->image[k] != q->image[k]) return p->image[k] < q->image[k] ? -1 : 1;
    return 0;
}

/* Turns the record of crushing of a contact of the whole floe into that of a half. */
static void turn_crush(fl_crush *c, const to_half *t)
{
    c->offset = q_rotate(t->turn, c->offset);
    c->normal = q_rotate(t->turn, c->normal);
    c->lean = q_rotate(t->turn, c->lean);
    c->centre = point_in_half(t, c->centre);
}

/* Appends the pair of the other half with the same thing, worn alike: a contact may reach over the cut. */
static int add_worn_pair(fl_world *w, int32_t i, const fl_neighbour_pair *of, const to_half *t, fl_err *err)
{
    fl_pair p;
    if (fl_grow(&w->pair, &w->pair_cap, (int64_t)w->n_pair + 1, sizeof *w->pair, err)) return -1;
    fl_neighbour_pair *const q = &w->pair[w->n_pair];
    fl_neighbour_pair_init(q, i, of->j, of->image);
    fl_neighbour_pair_expand(w, q, &p);
    if (!(p.crush = fl_alloc(1, sizeof *p.crush, err))) return -1;
    *p.crush = *of->contact->crush;
    p.crush->unsaved = 0;
    p.crush->work = p.crush->volume = 0.0;
    p.k = p.crush->stiffening * p.k;
    turn_crush(p.crush, t);
    if (fl_neighbour_pair_put_back(w, q, &p)) return fl_fail(err, FL_SYSTEM, "out of memory");
    w->n_pair++;
    return 0;
}

/* Gives the near pairs of floe i to its halves, i and k; q: the attitude of the whole. */
static int share_pairs(fl_world *w, int32_t i, int32_t k, fl_vec3 n, double c, double side, fl_quat q,
                       const floe_before *was, fl_err *err)
{
    const to_half to[2] = {to_half_of(w, i, was, q), to_half_of(w, k, was, q)};
    const int32_t all = w->n_pair;
    int32_t kept = 0;
    w->pair_cap = w->n_pair; /* the search fits the list to its length */
    for (int32_t a = 0; a < all; a++) {
        const fl_neighbour_pair p = w->pair[a];
        if ((p.i != i && p.j != i) || !p.contact) continue;
        if (!p.contact->touching && !p.contact->crush) {
            fl_neighbour_pair_free(w, &w->pair[a]); /* the search makes it anew */
            continue;
        }
        fl_vec3 x = p.contact->load_point; /* from the centre of p.i */
        if (p.i != i) x = v3_sub(x, fl_separation(w, p.i, p.j, p.image));
        x = q_rotate(q_conj(q), x);
        if (p.contact->crush && !p.contact->touching && p.i == i) x = p.contact->crush->centre;
        const int second = side * (v3_dot(n, x) - c) > 0.0;
        w->pair[a].cores_overlap = w->pair[a].has_axis = 0;
        w->pair[a].cache_size = 0;
        w->pair[a].free_travel = 0.0;
        if (second && p.j < w->n) {
            fl_neighbour_pair_free(w, &w->pair[a]);
            continue;
        }
        if (second) w->pair[a].i = p.contact->i = k;
        update_pair(w, p.contact);
        if (!p.contact->crush || p.i != i) continue;
        if (p.j >= w->n && add_worn_pair(w, second ? i : k, &p, &to[!second], err)) return -1;
        turn_crush(p.contact->crush, &to[second]);
    }
    for (int32_t a = 0; a < w->n_pair; a++) {
        const fl_neighbour_pair p = w->pair[a];
        if ((p.i == i || p.j == i || p.i == k || p.j == k) && !p.contact) continue;
        w->pair[kept++] = p;
    }
    w->n_pair = kept;
    qsort(w->pair, (size_t)kept, sizeof *w->pair, compare_keys);
    return 0;
}

/* Gives both halves the dents of floe i: one may reach over the cut. */
static int share_dents(fl_world *w, int32_t i, int32_t k, fl_quat q, const floe_before *was, fl_err *err)
{
    fl_floe_dents **const of = w->crushing.dents;
    const int32_t half[2] = {i, k};
    if (w->crushing.of == FL_CRUSHING_NONE || !of[i]) return 0;
    if (!(of[k] = fl_alloc(1, sizeof **of, err))) return -1;
    *of[k] = *of[i];
    for (int h = 0; h < 2; h++) {
        const to_half to = to_half_of(w, half[h], was, q);
        for (int32_t a = 0; a < of[half[h]]->n; a++) {
            fl_dent *d = &of[half[h]]->dent[a];
            d->x = point_in_half(&to, d->x);
            d->offset = q_rotate(to.turn, d->offset);
        }
    }
    return 0;
}

/* Searches the neighbours of both halves and evaluates their contacts. */
static int find_contacts(fl_world *w, int32_t i, int32_t k, fl_err *err)
{
    w->last_search_step = -1;
    if (fl_neighbour_list_update(w, err)) return -1;
    for (int32_t c = 0; c < w->n_pair; c++) {
        const fl_neighbour_pair *p = &w->pair[c];
        if (p->i != i && p->j != i && p->i != k && p->j != k) continue;
        fl_evaluate_neighbour_pair(w, c, 0, NULL, 0.0, 1);
        if (!p->contact || !p->contact->crush) continue;
        w->crushing.volume += p->contact->crush->volume;
        p->contact->crush->volume = 0.0;
    }
    if (fl_neighbour_list_index(w, err)) return -1;
    for (int32_t a = 0; a < w->b.total; a++)
        if (a >= w->n || !fl_body_absent(w, a)) fl_body_sum_forces(w, a);
    return 0;
}

/* --- the cut ------------------------------------------------------------------------------------ */

/* The place of a driven floe that has left stays free: what it held would be driven. */
static int32_t free_place(const fl_world *w)
{
    for (int32_t k = 0; k < w->n; k++)
        if (w->inflow.absent[k] && !(k < w->driven_floes.n && w->driven_floes.is_driven[k])) return k;
    return -1;
}

/* Fills the places of both halves: half[0] goes to i, half[1] to k. */
static int place_halves(fl_world *w, int32_t i, int32_t k, floe_half half[2], fl_err *err)
{
    fl_bodies *b = &w->b;
    fl_inflow_state *t = &w->inflow;
    const floe_before was = {.x = b->x[i],
                             .v = b->v[i],
                             .spin = b->w[i],
                             .flow = b->flow_velocity ? b->flow_velocity[i] : v3(0, 0, 0),
                             .turn = q_mul(b->q[i], q_conj(w->q0[i])),
                             .odometer = b->odometer[i]};
    w->material[k] = w->material[i];
    b->fixed_dof[k] = b->fixed_dof[i];
    t->absent[k] = 0;
    t->floes++;
    if (k >= t->places) t->places = k + 1;
    t->source_floe[k] = -1;
    t->guided[k] = 0;
    t->entry_step[i] = t->entry_step[k] = w->step;
    w->id[k] = t->next_id++;
    if (b->flow_work) b->flow_work[k] = 0.0;
    return place_half(w, i, &half[0], &was, err) || place_half(w, k, &half[1], &was, err) ? -1 : 0;
}

/* Works that were booked ahead for contacts which have ended. */
static void unbook_works(fl_world *w, const fl_work *before)
{
    const fl_work after = fl_work_ahead(w);
    w->ledger.damping -= before->damping - after.damping;
    w->ledger.friction -= before->friction - after.friction;
    w->ledger.drive -= before->drive - after.drive;
}

/* Replaces floe i by its halves, i and k. */
static int replace_floe(fl_world *w, int32_t i, int32_t k, fl_vec3 n, double c, double side,
                        floe_half half[2], fl_err *err)
{
    fl_ledger *g = &w->ledger;
    const floe_before was = {.x = w->b.x[i]};
    const fl_quat q = w->b.q[i];
    fl_energy_update(w);
    const double residual = g->residual, throughput = g->throughput, elastic = g->elastic;
    const fl_work before = fl_work_ahead(w);
    if (place_halves(w, i, k, half, err)) return -1;
    if (share_pairs(w, i, k, n, c, side, q, &was, err) || share_dents(w, i, k, q, &was, err) ||
        find_contacts(w, i, k, err))
        return -1;
    unbook_works(w, &before);
    fl_energy_update(w);
    w->breaking.lost += elastic - g->elastic;
    fl_energy_update(w);
    g->carried += g->residual - residual;
    g->residual = residual;
    g->throughput = throughput;
    w->critical_body = -1;
    return 0;
}

int fl_floe_cut(fl_world *w, int32_t i, fl_vec3 n, double c, int32_t *child, fl_err *err)
{
    floe_half half[2] = {{.volume = 0.0}, {.volume = 0.0}};
    fl_poly outer = {0};
    const double r = w->b.radius[i];
    const int32_t k = free_place(w);
    if (k < 0 || w->inflow.next_id == INT32_MAX) {
        w->breaking.no_room++;
        return 0;
    }
    /* columns of `to_ice` are the axes of the ice file in body axes */
    const fl_mat3 to_ice = q_matrix(q_conj(w->q0[i]));
    if (fl_poly_offset(&outer, &w->b.core[i], r, err)) return -1;
    const int first = make_half(&half[0], &outer, r, to_ice, n, c, err),
              second = first > 0 ? make_half(&half[1], &outer, r, to_ice, v3_neg(n), -c, err) : 0;
    fl_poly_free(&outer);
    int rc = first < 0 || second < 0 ? -1 : first > 0 && second > 0;
    if (rc == 0) w->breaking.too_small++;
    if (rc > 0) {
        /* the larger half keeps the place; equal ones: the first */
        const double side = half[1].volume > half[0].volume ? -1.0 : 1.0;
        if (side < 0.0) {
            const floe_half swap = half[0];
            half[0] = half[1], half[1] = swap;
        }
        *child = k;
        if (replace_floe(w, i, k, n, c, side, half, err)) rc = -1;
    }
    fl_poly_free(&half[0].core), fl_poly_free(&half[1].core);
    return rc;
}
