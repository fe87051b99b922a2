/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "sim/neighbour_list.h"
#include <math.h>
#include <string.h>
#include "base/array.h"
#include "contact/active_pairs.h"
#include "contact/bond_list.h"
#include "contact/pair_law.h"
#include "contact/pair_response.h"
#include "contact/pair_store.h"
#include "sim/device_step.h"
#include "sim/energy_ledger.h"
#include "sim/sleep.h"
#include "sphere/contact_list.h"
#include "sphere/sphere_pair.h"

/* Extend a box by the circular ends of a cone, which its polygon does not cover. */
static fl_aabb add_cone_ends(fl_aabb box, const fl_piece *p, fl_vec3 x, const fl_mat3 *R)
{
    const fl_vec3 a = m3_col(*R, 2),
                  e = v3(sqrt(fmax(0.0, 1.0 - a.x * a.x)), sqrt(fmax(0.0, 1.0 - a.y * a.y)),
                         sqrt(fmax(0.0, 1.0 - a.z * a.z)));
    for (int end = 0; end < 2; end++) {
        const fl_vec3 o = v3_madd(x, end ? p->h : 0.0, a);
        const double r = end ? p->r1 : p->r0;
        box = aabb_add(aabb_add(box, v3_madd(o, r, e)), v3_madd(o, -r, e));
    }
    return box;
}

/* Box of the dilated core of body k, world axes. */
static fl_aabb box_of(const fl_world *w, int32_t k)
{
    const fl_bodies *b = &w->b;
    const fl_poly *core = &b->core[k];
    fl_aabb box = aabb_empty();
    if (k < w->n && fl_body_absent(w, k)) return box;
    const fl_mat3 R = fl_body_axes(b, k);
    if (k >= w->n && w->structure.piece[k - w->n].kind == FL_PIECE_PLANE) { /* the half-space behind a wall */
        const fl_vec3 n = m3_col(R, 2), x = b->x[k];
        box = (fl_aabb){{-INFINITY, -INFINITY, -INFINITY}, {INFINITY, INFINITY, INFINITY}};
        if (n.x > 0.5) box.hi.x = x.x;
        if (n.x < -0.5) box.lo.x = x.x;
        if (n.y > 0.5) box.hi.y = x.y;
        if (n.y < -0.5) box.lo.y = x.y;
        if (n.z > 0.5) box.hi.z = x.z;
        if (n.z < -0.5) box.lo.z = x.z;
        return box;
    }
    if (k < w->n && w->elastic_walls.hull && core->nv > 2) { /* sharp corners are outside the dilated core */
        const fl_poly *outer = &w->elastic_walls.outer[k];
        for (int32_t v = 0; v < outer->nv; v++) box = aabb_add(box, v3_add(b->x[k], m3_mul(R, outer->v[v])));
        return box;
    }
    for (int32_t v = 0; v < core->nv; v++) box = aabb_add(box, v3_add(b->x[k], m3_mul(R, core->v[v])));
    if (k >= w->n && w->structure.piece[k - w->n].kind == FL_PIECE_CONE)
        box = add_cone_ends(box, &w->structure.piece[k - w->n], b->x[k], &R);
    return aabb_grow(box, b->radius[k]);
}

/* Move the boxes into the periodic cell, each by the cell of its body's centre; walls stay. */
static void wrap_boxes(fl_world *w)
{
#pragma omp parallel for schedule(static)
    for (int32_t k = 0; k < w->b.total - w->walls; k++) {
        w->cell_of_body[k] = fl_periodic_cell_of(&w->cell, w->b.x[k]);
        const fl_vec3 margin = fl_periodic_cell_offset(&w->cell, w->cell_of_body[k]);
        w->box[k] = (fl_aabb){v3_sub(w->box[k].lo, margin), v3_sub(w->box[k].hi, margin)};
    }
    w->candidates.period = w->cell.length;
}

/* Image of candidate k: the boxes met after each had been moved by its own cell. */
static void image_of(const fl_world *w, int64_t k, int32_t i, int32_t j, int32_t image[3])
{
    image[0] = image[1] = image[2] = 0;
    if (!w->cell.periodic || j >= w->b.total - w->walls) return;
    const fl_vec3 ci = w->cell_of_body[i], cj = w->cell_of_body[j];
    const double own[3] = {ci.x - cj.x, ci.y - cj.y, ci.z - cj.z};
    for (int axis = 0; axis < 3; axis++)
        image[axis] = fl_pairs_image_shift(w->candidates.image[k], axis) + (int32_t)own[axis];
}

/* -1, 0, 1: pair p is before, equal to or after (i, j, image) in the order of the list. */
static int compare_pair(const fl_neighbour_pair *p, int32_t i, int32_t j, const int32_t image[3])
{
    if (p->i != i) return p->i < i ? -1 : 1;
    if (p->j != j) return p->j < j ? -1 : 1;
    for (int axis = 0; axis < 3; axis++)
        if (p->image[axis] != image[axis]) return p->image[axis] < image[axis] ? -1 : 1;
    return 0;
}

/* 1 if the list may be incomplete.  by_block: w->blocks has the paths of the floes. */
static int is_due(const fl_world *w, int by_block)
{
    double first[2] = {0.0, 0.0};
    if (w->last_search_step < 0) return 1;
    if (w->scene->run.search_every > 0 && w->step - w->last_search_step >= w->scene->run.search_every)
        return 1;
    for (int32_t g = 0; g < fl_block_count(w) && by_block; g++)
        fl_update_two_largest(first, w->blocks[g].largest_moves[0]),
            fl_update_two_largest(first, w->blocks[g].largest_moves[1]);
    for (int32_t k = by_block ? w->n : 0; k < w->b.total; k++)
        fl_update_two_largest(first, w->b.odometer[k] - w->odometer_at_search[k]);
    return first[0] + first[1] >= w->skin * (1.0 - 1e-6);
}

/* Size an array for n new elements; it is kept if it is large enough and not more than a quarter too
 * large. */
static int fit_array(void *array, int32_t *cap, int64_t n, size_t size, fl_err *err)
{
    void *old;
    if (n <= *cap && *cap - n <= n / 4) return 0;
    memcpy(&old, array, sizeof old); /* array is the address of a T*, of any T */
    free(old);
    void *const list = fl_alloc(n + n / 8, size, err);
    memcpy(array, &list, sizeof list);
    *cap = list ? (int32_t)(n + n / 8) : 0;
    return list ? 0 : -1;
}

int fl_neighbour_list_index(fl_world *w, fl_err *err)
{
    const int32_t total = w->b.total;
    if (w->n_pair > INT32_MAX / 4)
        return fl_fail(err, FL_SYSTEM, "out of memory: %d pairs are near each other", w->n_pair);
    if (fit_array(&w->first_pair_of_body, &w->first_pair_of_body_cap, (int64_t)total + 1,
                  sizeof *w->first_pair_of_body, err))
        return -1;
    if (fit_array(&w->pairs_of_body, &w->pairs_of_body_cap, 2 * (int64_t)w->n_pair, sizeof *w->pairs_of_body,
                  err))
        return -1;
    for (int32_t k = 0; k <= total; k++) w->first_pair_of_body[k] = 0;
    for (int32_t c = 0; c < w->n_pair; c++) {
        w->first_pair_of_body[w->pair[c].i + 1]++;
        w->first_pair_of_body[w->pair[c].j + 1]++;
    }
    for (int32_t k = 0; k < total; k++) w->first_pair_of_body[k + 1] += w->first_pair_of_body[k];
    /* fill from the back, so that each list ends ascending and first[] returns to its start */
    for (int32_t k = total; k > 0; k--) w->first_pair_of_body[k] = w->first_pair_of_body[k - 1];
    for (int32_t c = 0; c < w->n_pair; c++) {
        w->pairs_of_body[w->first_pair_of_body[w->pair[c].i + 1]++] = c;
        w->pairs_of_body[w->first_pair_of_body[w->pair[c].j + 1]++] = c;
    }
    w->first_pair_of_body[0] = 0;
    if (fit_array(&w->pair_touches, &w->pair_touches_cap, w->n_pair, sizeof *w->pair_touches, err)) return -1;
    if (fit_array(&w->next_check, &w->next_check_cap, w->n_pair, sizeof *w->next_check, err)) return -1;
    if (w->sleep.state &&
        fit_array(&w->sleep.pair_due, &w->sleep.pair_due_cap, w->n_pair, sizeof *w->sleep.pair_due, err))
        return -1;
    if (w->sleep.state && w->n_pair) memset(w->sleep.pair_due, 0, (size_t)w->n_pair);
    for (int32_t c = 0; c < w->n_pair; c++)
        w->pair_touches[c] = w->pair[c].touching != 0, fl_set_next_check(w, c);
    fl_update_touching_pairs(w);
    return w->failed ? fl_fail(err, FL_SYSTEM, "out of memory") : 0;
}

void fl_update_touching_pairs(fl_world *w)
{
    fl_collect_touching(w);
    memset(w->body_touches, 0, (size_t)w->b.total);
    for (int32_t k = 0; k < w->n_touching; k++) {
        const fl_neighbour_pair *p = &w->pair[w->touching_pairs[k]];
        w->body_touches[p->i] = w->body_touches[p->j] = 1;
    }
    fl_contact_sums_assign(w);
}

/* A new pair whose bond has ended takes over the state of that bond. */
static int init_after_bond(fl_world *w, fl_neighbour_pair *q)
{
    fl_pair p;
    fl_neighbour_pair_expand(w, q, &p);
    fl_bond_list_init_pair(w, &p);
    return fl_neighbour_pair_put_back(w, q, &p);
}

/* Free the boxes and their tree after the search. */
static void free_boxes(fl_world *w)
{
    const fl_bvh *t = &w->candidates.tree;
    w->search_bytes = (double)((size_t)w->b.total * sizeof *w->box + (size_t)t->node_cap * sizeof *t->node +
                               (size_t)t->order_cap * sizeof *t->order);
    free(w->box);
    w->box = NULL;
    fl_bvh_free(&w->candidates.tree);
}

/* Free the candidates.  search_bytes: they exist beside the boxes first, then beside the old pairs. */
static void free_candidates(fl_world *w, int32_t pairs)
{
    const fl_pairs *p = &w->candidates;
    const double old_pairs = (double)((size_t)pairs * sizeof *w->pair);
    const size_t lists = (size_t)p->first_cap * sizeof *p->first +
                         (size_t)p->partner_cap * sizeof *p->partner +
                         (size_t)p->image_cap * sizeof *p->image +
                         (w->cell_of_body ? (size_t)w->b.total * sizeof *w->cell_of_body : 0);
    w->search_bytes = fmax(w->search_bytes, old_pairs) + (double)lists;
    free(w->cell_of_body);
    w->cell_of_body = NULL;
    fl_pairs_clear(&w->candidates);
}

/* Candidates of floes and things that are no floes alone: a device lists pairs of spheres. */
static int find_things(fl_world *w, fl_err *err)
{
    fl_pairs *p = &w->candidates;
    int64_t n = 0;
    if (fl_grow(&p->first, &p->first_cap, (int64_t)w->n + 1, sizeof *p->first, err)) return -1;
    for (int pass = 0; pass < 2; pass++) {
        n = 0;
        for (int32_t i = 0; i < w->n; i++) {
            p->first[i] = n;
            for (int32_t j = w->n; j < w->b.total; j++) {
                if (!aabb_overlap(w->box[i], w->box[j])) continue;
                if (pass) p->partner[n] = j;
                n++;
            }
        }
        p->first[w->n] = n;
        if (!pass && fl_grow(&p->partner, &p->partner_cap, n, sizeof *p->partner, err)) return -1;
    }
    return 0;
}

/* Lists of spheres and of walls from the candidates; *others: candidates that are none of these. */
static int list_spheres(fl_world *w, int64_t *others, fl_err *err)
{
    if (!fl_device_makes_lists(w)) return fl_contact_list_build(w, image_of, others, err);
    *others = 0;
    for (int32_t i = 0; i < w->n; i++)
        for (int64_t k = w->candidates.first[i]; k < w->candidates.first[i + 1]; k++)
            *others += !fl_sphere_pair_kind(w, i, w->candidates.partner[k]);
    return fl_contact_list_build_walls(w, err);
}

static int find_pairs(fl_world *w, fl_err *err)
{
    const int32_t total = w->b.total;
    fl_neighbour_pair *old = w->pair;
    const int32_t n_old = w->n_pair;
    w->box = fl_alloc(total, sizeof *w->box, err);
    if (w->cell.periodic) w->cell_of_body = fl_alloc(total, sizeof *w->cell_of_body, err);
    if (!w->box || (w->cell.periodic && !w->cell_of_body)) return -1;
#pragma omp parallel for schedule(static)
    for (int32_t k = 0; k < total; k++) {
        const double margin = fl_sleep_phase_of(w, k) == FL_BALLISTIC ? w->sleep.state[k].path_bound : 0.0;
        w->box[k] = aabb_grow(box_of(w, k), 0.5 * w->skin + margin);
    }
    if (w->cell.periodic) wrap_boxes(w);
    if (fl_device_makes_lists(w) ? find_things(w, err)
                                 : fl_pairs_find(&w->candidates, w->box, w->n, total, w->walls, err))
        return -1;
    int64_t n, to = 0;
    free_boxes(w);
    if (list_spheres(w, &n, err)) return -1;
    fl_disc_list_forget_ended(w);
    fl_neighbour_pair *list = fl_alloc(n, sizeof *list, err);
    if (!list) return -1;
    int32_t next = 0;
    for (int32_t i = 0; i < w->n && n > 0; i++) {
        for (int64_t k = w->candidates.first[i]; k < w->candidates.first[i + 1]; k++) {
            const int32_t j = w->candidates.partner[k];
            int32_t image[3];
            if (fl_sphere_pair_kind(w, i, j)) continue;
            image_of(w, k, i, j, image);
            if (fl_bond_list_is_bonded(w, i, j, image)) continue;
            while (next < n_old && compare_pair(&old[next], i, j, image) < 0)
                fl_neighbour_pair_free(w, &old[next++]);
            if (next < n_old && compare_pair(&old[next], i, j, image) == 0) {
                list[to] = old[next++];
                list[to].gap = (fl_known_gap){.level = 0.0f}; /* a floe may have been cut or replaced */
            } else {
                fl_neighbour_pair_init(&list[to], i, j, image);
                if (w->bonds.n && init_after_bond(w, &list[to])) w->failed = 1;
            }
            to++;
        }
    }
    while (next < n_old) fl_neighbour_pair_free(w, &old[next++]);
    free(old);
    w->pair = list;
    w->n_pair = (int32_t)to;
    return 0;
}

/* Lists anew what is near. */
static int search(fl_world *w, fl_err *err)
{
    const int32_t pairs = w->n_pair;
    const int rc = find_pairs(w, err);
    if (w->box) free_boxes(w);
    free_candidates(w, pairs);
    return rc || fl_neighbour_list_index(w, err) ? -1 : 0;
}

static int rebuild_list(fl_world *w, fl_err *err)
{
    if (search(w, err)) return -1;
    for (int32_t k = 0; k < w->b.total; k++) w->odometer_at_search[k] = w->b.odometer[k];
    w->last_search_step = w->step;
    w->searches++;
    return 0;
}

/* The pairs of bonded spheres that have come apart, which is all that a valid list lacks.  A device lists its
 * rows anew by itself, and where no spheres have met yet all is; the next search is due when it was. */
static int add_ended(fl_world *w, fl_err *err)
{
    if (!w->discs.ended) return 0;
    if (!w->spheres.bodies || fl_device_has_listed_none(w)) return search(w, err);
    if (!fl_device_makes_lists(w) && fl_contact_list_add_ended(w, err)) return -1;
    fl_disc_list_forget_ended(w);
    return 0;
}

int fl_neighbour_list_update(fl_world *w, fl_err *err)
{
    return is_due(w, 0) ? rebuild_list(w, err) : add_ended(w, err);
}

int fl_neighbour_list_from_blocks(fl_world *w, fl_err *err)
{
    return is_due(w, 1) ? rebuild_list(w, err) : add_ended(w, err);
}

int fl_neighbour_list_due(const fl_world *w) { return w->discs.ended || is_due(w, 1); }
