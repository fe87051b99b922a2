/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "sim/inflow.h"
#include <math.h>
#include <stdlib.h>
#include "base/array.h"
#include "base/simd.h"
#include "body/domain_kernel.h"
#include "contact/bond_list.h"
#include "contact/crushing.h"
#include "contact/pair_law.h"
#include "contact/pair_response.h"
#include "contact/pair_store.h"
#include "narrow/gjk.h"
#include "sim/body_step.h"
#include "sim/device_step.h"
#include "sim/energy_balance.h"
#include "sim/energy_ledger.h"
#include "sim/floe_cut.h"
#include "sim/floe_setup.h"
#include "sim/inflow_bonds.h"
#include "sim/neighbour_list.h"
#include "sim/sleep.h"
#include "sphere/contact_list.h"

/* Copies of floes that touch in the field may overlap by rounding.  This fraction of the size of a floe
 * is a million times the rounding of coordinates of a kilometre, and too small to load a contact. */
#define TOLERANCE 1e-7

/* Steps between two attempts to place a floe that waits. */
enum { RETRY_INTERVAL = 16 };

/* --- set-up ------------------------------------------------------------------------------------ */

#define MAX_PLACES 1e8 /* floes */

/* Number of places for floes that come in: those of the length of the domain, a quarter more for
 * congestion, and one field.  -1: too many. */
static int32_t places_needed(const fl_scene_boundary *s, const fl_ice_field *feed, double pitch)
{
    const double length = s->inflow_from / 2 ? s->max.y - s->min.y : s->max.x - s->min.x;
    const double largest = (double)feed->n * (1.25 * length / pitch + 1.0);
    if (s->room > 0) return s->room > feed->n ? s->room : feed->n;
    return largest < MAX_PLACES ? (int32_t)ceil(largest) : -1;
}

double fl_inflow_extent(const fl_inflow_state *t, const fl_ice_field *field, int32_t k, double end)
{
    double largest = -INFINITY;
    for (int32_t v = 0; v < field->core[k].nv; v++) {
        const fl_vec3 x = field->core[k].v[v];
        largest = fmax(largest, end * t->sign * (t->axis ? x.y : x.x));
    }
    return end * (largest + field->radius[k]);
}

/* 1 if floe k of the feed comes in: not if its group fixes it along the drift at another velocity than
 * that of the sheet. */
static int comes_in(const fl_world *w, const fl_ice_field *feed, int32_t k)
{
    const fl_inflow_state *t = &w->inflow;
    const int32_t g =
        feed->group[k] < 0 ? -1 : fl_scene_find_group(w->scene, feed->groups.name[feed->group[k]]);
    if (g < 0) return 1;
    const fl_scene_group *s = &w->scene->group[g];
    return !(s->fixed & (t->axis ? FL_DOF_Y : FL_DOF_X)) ||
           (t->axis ? s->velocity.y : s->velocity.x) == t->sign * t->speed;
}

/* Set up what comes in, except the arrays of all places. */
static int plan_inflow(fl_world *w, const fl_ice_field *field, const fl_ice_field *feed, fl_err *err)
{
    const fl_scene_boundary *s = &w->scene->boundary;
    fl_inflow_state *t = &w->inflow;
    double front = -INFINITY, back = INFINITY;
    t->feed = feed;
    t->ice = field;
    t->axis = s->inflow_from / 2;
    t->sign = s->inflow_from % 2 ? -1.0 : 1.0;
    t->entry = t->sign > 0.0 ? (t->axis ? s->min.y : s->min.x) : -(t->axis ? s->max.y : s->max.x);
    t->speed = s->inflow_speed > 0.0
                   ? s->inflow_speed
                   : t->sign * (t->axis ? w->scene->water.current.y : w->scene->water.current.x);
    for (int32_t k = 0; k < feed->n; k++) {
        if (!comes_in(w, feed, k)) continue;
        front = fmax(front, fl_inflow_extent(t, feed, k, 1.0));
        back = fmin(back, fl_inflow_extent(t, feed, k, -1.0));
    }
    if (!(front >= back))
        return fl_scene_fail(w->scene, "boundary.inflow", err,
                             "every floe of %s is fixed by its group along the drift: none comes in",
                             s->inflow == FL_INFLOW_FILE ? s->inflow_file : w->scene->ice.file);
    t->pitch = s->inflow_pitch > 0.0 ? s->inflow_pitch : front - back;
    t->lag = fl_alloc(feed->n, sizeof *t->lag, err);
    t->next_copy = fl_alloc(feed->n, sizeof *t->next_copy, err);
    if (!t->lag || !t->next_copy) return -1;
    for (int32_t k = 0; k < feed->n; k++)
        t->lag[k] = comes_in(w, feed, k) ? front - fl_inflow_extent(t, feed, k, 1.0) : INFINITY;
    return 0;
}

/* 1 if a stage takes bodies out. */
static int has_removals(const fl_scene *s)
{
    for (int32_t k = 0; k < s->n_stage; k++)
        if (s->stage[k].remove[0]) return 1;
    return 0;
}

int fl_inflow_make(fl_world *w, const fl_ice_field *field, const fl_ice_field *feed, fl_err *err)
{
    const fl_scene_boundary *s = &w->scene->boundary;
    fl_inflow_state *t = &w->inflow;
    const double none = INFINITY;
    const int staged = has_removals(w->scene);
    const int32_t fragments = fl_fragment_places(w->scene, field);
    const int bounded = s->head.present;
    t->lo = v3(bounded && s->type[0] == FL_BOUNDARY_FREE ? s->min.x : -none,
               bounded && s->type[1] == FL_BOUNDARY_FREE ? s->min.y : -none,
               bounded && s->type[2] == FL_BOUNDARY_FREE ? s->min.z : -none);
    t->hi = v3(bounded && s->type[0] == FL_BOUNDARY_FREE ? s->max.x : none,
               bounded && s->type[1] == FL_BOUNDARY_FREE ? s->max.y : none,
               bounded && s->type[2] == FL_BOUNDARY_FREE ? s->max.z : none);
    const int leave = t->lo.x > -none || t->lo.y > -none || t->lo.z > -none || t->hi.x < none ||
                      t->hi.y < none || t->hi.z < none;
    if (!leave && fragments == 0 && !staged) return 0;
    t->leaves = leave;
    w->breaking.room = fragments;
    w->n += fragments;
    if (leave && s->inflow != FL_INFLOW_NONE) {
        if (feed->n == 0)
            return fl_fail(err, FL_INPUT, "%s: the file has no body; an ice field expected", s->inflow_file);
        if (plan_inflow(w, field, feed, err)) return -1;
        const int32_t more = places_needed(s, feed, t->pitch);
        if (more < 0)
            return fl_fail(err, FL_INPUT,
                           "%s: fields %.3g m apart, boundary.inflow_pitch, would be more than %.3g floes in "
                           "the domain; boundary.room or a wider pitch expected",
                           s->inflow == FL_INFLOW_FILE ? s->inflow_file : w->scene->ice.file, t->pitch,
                           MAX_PLACES);
        w->n += more;
    }
    t->absent = fl_alloc(w->n, sizeof *t->absent, err);
    t->entry_step = fl_alloc(w->n, sizeof *t->entry_step, err);
    t->source_floe = fl_alloc(w->n, sizeof *t->source_floe, err);
    t->guided = fl_alloc(w->n, sizeof *t->guided, err);
    t->own_fixed_dof = fl_alloc(w->n, sizeof *t->own_fixed_dof, err);
    if (!t->absent || !t->entry_step || !t->source_floe || !t->guided || !t->own_fixed_dof) return -1;
    for (int32_t i = 0; i < w->n; i++) t->source_floe[i] = -1;
    for (int32_t i = 0; i < field->n; i++)
        if (field->id[i] >= t->next_id) t->next_id = field->id[i] + 1;
    return 0;
}

void fl_inflow_free(fl_inflow_state *t)
{
    free(t->absent), free(t->entry_step), free(t->lag), free(t->next_copy);
    free(t->source_floe), free(t->guided), free(t->own_fixed_dof);
    fl_inflow_bonds_free(&t->join);
    *t = (fl_inflow_state){0};
}

int32_t fl_floes_in_domain(const fl_world *w) { return w->inflow.absent ? w->inflow.floes : w->n; }

static double coordinate_along(const fl_inflow_state *t, fl_vec3 x)
{
    return t->sign * (t->axis ? x.y : x.x);
}

/* --- outflow ----------------------------------------------------------------------------------- */

static int is_outside(const fl_world *w, int32_t i)
{
    return fl_is_beyond(w->inflow.lo, w->inflow.hi, w->b.x[i], fl_body_extent(&w->b, i));
}

/* First body from `from` on, in steps of four, where one of four boxes may be outside; or one near n. */
FL_SIMD4_VERSIONS static int32_t skip_inside(const fl_vec3 *restrict x, const double *restrict r,
                                             const double *restrict more, fl_vec3 lo, fl_vec3 hi,
                                             int32_t from, int32_t n)
{
    int32_t k = from;
    for (; k + FL_SIMD_WIDTH <= n; k += FL_SIMD_WIDTH) {
        const fl_simd R = FL_SIMD_LOAD(&more[k]) + FL_SIMD_LOAD(&r[k]);
        fl_simd at[3];
        fl_simd_from_triples(at, &x[k]);
        const fl_simd_mask out = (at[0] + R < lo.x) | (at[0] - R > hi.x) | (at[1] + R < lo.y) |
                                 (at[1] - R > hi.y) | (at[2] + R < lo.z) | (at[2] - R > hi.z);
        if (fl_simd_any(&out)) break;
    }
    return k;
}

/* True if a body of the processor that may leave is outside. */
static int some_leaves(const fl_world *w)
{
    const fl_inflow_state *t = &w->inflow;
    const fl_bodies *b = &w->b;
    for (int32_t i = 0; t->leaves && i < w->n; i++) {
        if (i % FL_SIMD_WIDTH == 0)
            i = skip_inside(b->x, b->radius, b->bounding_radius, t->lo, t->hi, i, w->n);
        if (i < w->n && !t->absent[i] && !t->guided[i] && !fl_device_moves(w, i) && is_outside(w, i))
            return 1;
    }
    return 0;
}

static void remove_floe(fl_world *w, int32_t i)
{
    fl_inflow_state *t = &w->inflow;
    fl_bodies *b = &w->b;
    t->absent[i] = 1;
    t->floes--;
    if (w->critical_body == i) w->critical_body = -1; /* its id is free again */
    t->n_left++;
    t->mass_left += b->m[i];
    t->momentum_left = v3_madd(t->momentum_left, b->m[i], b->v[i]);
    fl_crushing_forget(w, i);
    fl_breaking_forget(w, i);
    b->v[i] = b->L[i] = b->w[i] = b->f[i] = b->t[i] = v3(0, 0, 0);
    fl_sums_clear(w, i);
}

/* End the pairs of absent floes, and update the forces on their partners. */
static int drop_pairs(fl_world *w, fl_err *err)
{
    int32_t kept = 0;
    fl_bond_list_end_absent(w);
    for (int32_t c = 0; c < w->n_pair; c++) {
        fl_neighbour_pair *p = &w->pair[c];
        const int32_t i = p->i, j = p->j;
        if (!fl_body_absent(w, i) && !(j < w->n && fl_body_absent(w, j))) {
            w->pair[kept++] = *p;
            continue;
        }
        fl_neighbour_pair_free(w, p);
        p->touching = 0;
    }
    w->n_pair = kept;
    kept = 0;
    for (int32_t k = 0; k < w->panel_load.points; k++)
        if (!fl_body_absent(w, w->panel_load.point[k].i))
            w->panel_load.point[kept++] = w->panel_load.point[k];
    w->panel_load.points = kept;
    kept = 0;
    for (int32_t k = 0; k < w->panel_load.shares; k++)
        if (!fl_body_absent(w, w->panel_load.share[k].i))
            w->panel_load.share[kept++] = w->panel_load.share[k];
    w->panel_load.shares = kept;
    if (fl_neighbour_list_index(w, err) || fl_contact_list_remove_absent(w, err)) return -1;
    for (int32_t k = 0; k < w->b.total; k++)
        if (k >= w->n || !fl_body_absent(w, k)) fl_body_sum_forces(w, k);
    return 0;
}

/* --- inflow ------------------------------------------------------------------------------------ */

/* Vertices of the core of thing k relative to `origin`, world axes. */
static int vertices_about(const fl_world *w, int32_t k, fl_vec3 origin, fl_vec3 **v, int32_t *cap,
                          fl_err *err)
{
    const fl_poly *p = &w->b.core[k];
    const fl_vec3 x = v3_sub(w->b.x[k], origin);
    const fl_mat3 R = fl_body_axes(&w->b, k);
    if (fl_grow(v, cap, p->nv, sizeof **v, err)) return -1;
    for (int32_t n = 0; n < p->nv; n++) (*v)[n] = v3_add(x, m3_mul(R, p->v[n]));
    return 0;
}

/* Number of cell lengths between two coordinates, to the nearest image. */
static double image_shift(double apart, double length) { return length > 0.0 ? round(apart / length) : 0.0; }

/* 1 if nothing overlaps floe i, 0 if something does, -1 if memory runs out. */
static int is_free(const fl_world *w, int32_t i, fl_err *err)
{
    const fl_bodies *b = &w->b;
    const fl_vec3 L = w->cell.length;
    const double size = b->bounding_radius[i] + b->radius[i];
    fl_vec3 *va = NULL, *vb = NULL;
    int32_t cap_a = 0, cap_b = 0;
    int fits = vertices_about(w, i, b->x[i], &va, &cap_a, err) ? -1 : 1;
    for (int32_t k = 0; k < b->total - w->walls && fits == 1; k++) {
        if (k == i || (k < w->n && fl_body_absent(w, k))) continue;
        fl_vec3 offset = v3_sub(b->x[k], b->x[i]), origin = b->x[i];
        if (w->cell.periodic) {
            const fl_vec3 shift =
                fl_periodic_cell_offset(&w->cell, v3(image_shift(offset.x, L.x), image_shift(offset.y, L.y),
                                                     image_shift(offset.z, L.z)));
            offset = v3_sub(offset, shift);
            origin = v3_add(origin, shift);
        }
        const double R = b->radius[i] + b->radius[k];
        if (v3_norm(offset) > size + b->bounding_radius[k] + b->radius[k]) continue;
        if (fl_inflow_bonds_joins(w, i, w->inflow.source_floe[i], k)) continue;
        fl_gap gap;
        if (vertices_about(w, k, origin, &vb, &cap_b, err)) {
            fits = -1;
            break;
        }
        fl_gjk((fl_core){va, b->core[i].nv, &b->core[i]}, (fl_core){vb, b->core[k].nv, &b->core[k]}, NULL,
               &gap);
        if (gap.overlap || gap.d < R - TOLERANCE * size) fits = 0;
    }
    free(va), free(vb);
    return fits;
}

/* Put the next copy of floe k into place i, its foremost point `in` beyond the bound. */
static int place_copy(fl_world *w, int32_t i, int32_t k, double in, fl_err *err)
{
    fl_inflow_state *t = &w->inflow;
    fl_bodies *b = &w->b;
    double front = -INFINITY;
    t->source_floe[i] = k;
    if (fl_world_place_floe(w, i, t->feed, k, err)) return -1;
    const fl_mat3 R = fl_body_axes(b, i);
    for (int32_t v = 0; v < b->core[i].nv; v++)
        front = fmax(front, coordinate_along(t, v3_add(b->x[i], m3_mul(R, b->core[i].v[v]))));
    const double shift = t->sign * (t->entry + in - front - b->radius[i]);
    const double drift = t->sign * (w->push.of == FL_PUSH_INFLOW ? w->push.velocity : t->speed);
    const fl_vec3 prescribed =
        v3(b->fixed_dof[i] & FL_DOF_X ? b->v[i].x : 0.0, b->fixed_dof[i] & FL_DOF_Y ? b->v[i].y : 0.0,
           b->fixed_dof[i] & FL_DOF_Z ? b->v[i].z : 0.0); /* prescribed by its group */
    b->x[i] = v3_add(b->x[i], v3(t->axis ? 0.0 : shift, t->axis ? shift : 0.0, 0.0));
    b->v[i] = v3(t->axis ? prescribed.x : drift, t->axis ? drift : prescribed.y, prescribed.z);
    fl_body_set_spin(b, i, v3(0, 0, 0));
    return 0;
}

void fl_inflow_set_guided(fl_world *w, int32_t i, int guided)
{
    fl_inflow_state *t = &w->inflow;
    uint8_t *const fixed = &w->b.fixed_dof[i];
    if (guided == t->guided[i]) return;
    const unsigned held = t->join.first ? FL_DOF_X | FL_DOF_Y | FL_DOF_Z | FL_DOF_RX | FL_DOF_RY | FL_DOF_RZ
                                        : FL_DOF_X | FL_DOF_Y | FL_DOF_RZ;
    if (guided) t->own_fixed_dof[i] = *fixed, *fixed = (uint8_t)(*fixed | held);
    else *fixed = t->own_fixed_dof[i];
    t->guided[i] = (uint8_t)guided;
}

static int admit_floe(fl_world *w, int32_t i, fl_err *err)
{
    fl_inflow_state *t = &w->inflow;
    fl_bodies *b = &w->b;
    t->absent[i] = 0;
    t->floes++;
    if (i >= t->places) t->places = i + 1;
    fl_sleep_reset_body(w, i);
    fl_inflow_set_guided(w, i, 1);
    w->id[i] = t->next_id++;
    t->entry_step[i] = w->step;
    t->n_entered++;
    t->mass_entered += b->m[i];
    t->momentum_entered = v3_madd(t->momentum_entered, b->m[i], b->v[i]);
    fl_body_sum_forces(w, i);
    w->last_search_step = -1;
    return fl_inflow_bonds_admit(w, i, err);
}

/* Largest number of fields that may be missed in one step: more is an error of the scene. */
#define MAX_MISSED 1e9

/* Way of the sheet since the start, and in the last step [m]: that of what pushes, or at one speed. */
static double sheet_way(const fl_world *w)
{
    return w->push.of == FL_PUSH_INFLOW ? w->push.way : w->inflow.speed * fl_world_time(w);
}

static double sheet_step(const fl_world *w)
{
    return w->push.of == FL_PUSH_INFLOW ? w->push.velocity * w->dt : w->inflow.speed * w->dt;
}

/* Place the copies of floe k that are due; *came counts them.  0 or -1. */
static int place_due(fl_world *w, int32_t k, int32_t *place, int *came, fl_err *err)
{
    fl_inflow_state *t = &w->inflow;
    const double shift = sheet_way(w), step = sheet_step(w);
    for (;;) {
        const double delay = shift - t->lag[k] - (double)t->next_copy[k] * t->pitch;
        if (delay < 0.0) return 0;
        if (delay >= t->pitch) {
            const double behind = floor(delay / t->pitch);
            if (!(behind < MAX_MISSED))
                return fl_fail(err, FL_NUMERIC, "inflow is %.3g fields behind in step %lld (t = %g s)",
                               behind, (long long)w->step, fl_world_time(w));
            t->next_copy[k] += (int64_t)behind;
            t->n_dropped += (int64_t)behind;
            continue;
        }
        const int first = delay < step * (1.0 + 1e-9); /* includes copies that are due at the start */
        if (!first && w->step % RETRY_INTERVAL) return 0;
        while (*place < w->n && !t->absent[*place]) ++*place;
        int fits = 0;
        if (*place < w->n) {
            if (place_copy(w, *place, k, first ? delay : 0.0, err)) return -1;
            fits = is_free(w, *place, err);
            if (fits < 0) return -1;
        }
        if (!fits) {
            t->n_blocked += first;
            return 0;
        }
        if (t->next_id == INT32_MAX) return fl_fail(err, FL_NUMERIC, "no id is left for a floe");
        if (admit_floe(w, *place, err)) return -1;
        t->next_copy[k]++;
        ++*came;
    }
}

/* Release the guided floes whose last point has passed the bound. */
static int release_guided(fl_world *w, fl_err *err)
{
    fl_inflow_state *t = &w->inflow;
    const fl_bodies *b = &w->b;
    for (int32_t i = 0; i < w->n; i++) {
        if (!t->guided[i] || t->absent[i]) continue;
        double last = INFINITY;
        const fl_mat3 R = fl_body_axes(b, i);
        for (int32_t v = 0; v < b->core[i].nv; v++)
            last = fmin(last, coordinate_along(t, v3_add(b->x[i], m3_mul(R, b->core[i].v[v]))));
        if (last - b->radius[i] < t->entry) continue;
        fl_inflow_set_guided(w, i, 0);
        if (fl_device_release(w, i, err)) return -1;
    }
    return 0;
}

/* --- between two steps -------------------------------------------------------------------------- */

static int is_due(const fl_world *w)
{
    const fl_inflow_state *t = &w->inflow;
    const double shift = sheet_way(w);
    for (int32_t k = 0; t->feed && k < t->feed->n; k++)
        if (shift >= t->lag[k] + (double)t->next_copy[k] * t->pitch) return 1;
    return 0;
}

/* Take out floes: those marked in gone, or those outside if that is NULL. */
static int take_out(fl_world *w, const uint8_t *gone, fl_err *err)
{
    fl_inflow_state *t = &w->inflow;
    fl_ledger *g = &w->ledger;
    /* The works of the half kick to come are booked already; contacts that end will not do them. */
    const fl_work before = fl_work_ahead(w);
    for (int32_t i = 0; i < w->n; i++)
        if (!t->absent[i] && (gone ? gone[i] : !t->guided[i] && is_outside(w, i))) remove_floe(w, i);
    if (drop_pairs(w, err)) return -1;
    fl_sleep_wake_resting(w);
    const fl_work after = fl_work_ahead(w);
    g->damping -= before.damping - after.damping;
    g->friction -= before.friction - after.friction;
    g->drive -= before.drive - after.drive;
    return 0;
}

/* The works ahead of the bodies of l and of those that they touch. */
static fl_work works_ahead(const fl_leaving *l, const fl_world *w)
{
    fl_work sum = {0};
    for (int32_t k = 0; k < l->n_touched; k++) fl_work_ahead_add(w, l->touched[k], &sum);
    return sum;
}

/* Books the energy that the bodies of l took with them, and what their contacts will not do any more; before:
 * the works ahead with them. */
static void book_leaving(fl_world *w, const fl_leaving *l, double energy, fl_work before)
{
    const fl_work after = works_ahead(l, w);
    w->ledger.damping -= before.damping - after.damping;
    w->ledger.friction -= before.friction - after.friction;
    w->ledger.carried -= energy;
}

/* Takes out the bodies of the device that are outside, while the others stay there.  1; 0 if all have to come
 * down; -1. */
static int leave_on_device(fl_world *w, fl_err *err)
{
    fl_leaving l = {0};
    int rc = fl_device_find_leaving(w, &l, err);
    if (rc == 1 && l.bodies) {
        const double energy = fl_leaving_energy(&l, w);
        const fl_work before = works_ahead(&l, w);
        for (int32_t k = 0; k < l.bodies; k++) remove_floe(w, l.body[k]);
        fl_leaving_end_discs(&l, w);
        for (int32_t k = 0; k < l.bodies; k++) w->spheres.sum[l.body[k]] = (fl_sphere_sum){0};
        if (fl_device_drop(w, &l, err)) rc = -1;
        else book_leaving(w, &l, energy, before);
    }
    fl_leaving_free(&l);
    return rc;
}

/* Takes out the floes outside and books what they take with them, if that is known of each.  1; 0 if not:
 * they are still there; -1. */
static int leave_one_by_one(fl_world *w, fl_err *err)
{
    fl_leaving l = {0};
    int rc = 1;
    for (int32_t i = 0; i < w->n && rc == 1; i++)
        if (!w->inflow.absent[i] && !w->inflow.guided[i] && is_outside(w, i) &&
            fl_leaving_add_body(&l, i, err))
            rc = -1;
    if (rc == 1 && l.bodies) rc = fl_leaving_collect(&l, w, err);
    if (rc == 1 && l.bodies) {
        const double energy = fl_leaving_energy(&l, w);
        const fl_work before = works_ahead(&l, w);
        for (int32_t k = 0; k < l.bodies; k++) remove_floe(w, l.body[k]);
        if (drop_pairs(w, err)) rc = -1;
        else book_leaving(w, &l, energy, before);
    }
    fl_leaving_free(&l);
    return rc;
}

int fl_inflow_remove(fl_world *w, const uint8_t *gone, fl_err *err)
{
    fl_ledger *g = &w->ledger;
    if (fl_device_hand_over(w, err)) return -1;
    fl_sleep_advance_to_now(w);
    fl_energy_update(w);
    const double residual = g->residual, throughput = g->throughput;
    if (take_out(w, gone, err)) return -1;
    fl_energy_update(w);
    g->carried += g->residual - residual;
    g->throughput = throughput;
    fl_sleep_restore(w);
    return 0;
}

int fl_inflow_step(fl_world *w, fl_err *err)
{
    fl_inflow_state *t = &w->inflow;
    fl_ledger *g = &w->ledger;
    int came = 0;
    int32_t place = 0;
    if (t->feed && release_guided(w, err)) return -1;
    const int due = is_due(w), of_cpu = some_leaves(w), of_device = t->leaves && fl_device_leaves(w);
    if (of_device && !of_cpu && !due && fl_leaving_has_books(w)) {
        const int done = leave_on_device(w, err);
        if (done) return done < 0 ? -1 : 0;
    }
    int leaving = of_cpu || of_device;
    if (!leaving && !due) return 0;
    if (fl_device_hand_over(w, err)) return -1;
    if (leaving) {
        const int done = leave_one_by_one(w, err);
        if (done < 0) return -1;
        leaving = !done;
        if (done && !due) return 0;
    }
    fl_sleep_advance_to_now(w);
    fl_energy_update(w);
    const double residual = g->residual, throughput = g->throughput;
    if (leaving && take_out(w, NULL, err)) return -1;
    if (is_due(w) && fl_inflow_bonds_renew(w, err)) return -1;
    for (int32_t k = 0; t->feed && k < t->feed->n; k++)
        if (place_due(w, k, &place, &came, err)) return -1;
    if (came && fl_inflow_bonds_renew(w, err)) return -1;
    fl_energy_update(w);
    g->carried += g->residual - residual;
    g->throughput = throughput;
    fl_sleep_restore(w);
    return 0;
}
