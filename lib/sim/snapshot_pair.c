/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "sim/snapshot_pair.h"
#include <string.h>
#include "base/array.h"
#include "contact/bond_list.h"
#include "contact/crushing.h"
#include "contact/pair_gap.h"
#include "contact/pair_surrogate.h"
#include "contact/pair_law.h"
#include "contact/pair_response.h"
#include "contact/pair_store.h"
#include "contact/rolling_pair.h"
#include "contact/strip_contact.h"
#include "sphere/contact_list.h"
#include "sphere/sphere_pair.h"

/* 1 if M is orthogonal. */
static int is_orthogonal(const fl_mat3 *M)
{
    for (int k = 0; k < 3; k++)
        for (int l = 0; l < 3; l++) {
            double sum = k == l ? -1.0 : 0.0;
            for (int m = 0; m < 3; m++) sum += M->m[k][m] * M->m[l][m];
            if (!(fabs(sum) < 1e-9)) return 0;
        }
    return 1;
}

/* Memory of a pair. */
static void exchange_memory(fl_state_io *t, fl_pair *p)
{
    int32_t mode = (int32_t)p->mode;
    fl_state_io_int(t, FL_MODE_NONE, FL_FF, &mode);
    p->mode = (fl_mode)mode;
    fl_state_io_int(t, 0, 1, &p->cores_overlap);
    fl_state_io_int(t, 0, 1, &p->has_axis);
    fl_state_io_vec3(t, &p->axis);
    fl_state_io_int(t, 0, 4, &p->cache.n);
    for (int k = 0; k < p->cache.n && !t->err->code; k++) {
        fl_state_io_int(t, 0, INT32_MAX, &p->cache.a[k]);
        fl_state_io_int(t, 0, INT32_MAX, &p->cache.b[k]);
    }
    fl_state_io_real(t, &p->free_travel);
    fl_state_io_real(t, &p->max_approach_speed);
    fl_state_io_real(t, &p->sustained_load);
    fl_state_io_real(t, &p->sustained_load_rate);
    fl_state_io_vec3(t, &p->sustained_spin);
    fl_state_io_vec3(t, &p->sustained_spin_rate);
    fl_state_io_real(t, &p->sustained_step);
    fl_state_io_vec3(t, &p->springs.force);
    fl_state_io_real(t, &p->springs.k);
    fl_state_io_real(t, &p->springs.moment);
    fl_state_io_real(t, &p->springs.k_turn);
    fl_state_io_real(t, &p->springs.energy);
    fl_state_io_vec3(t, &p->springs.damping);
    fl_state_io_real(t, &p->springs.damping_moment);
}

/* The gap of a pair that does not touch. */
static void exchange_gap(fl_state_io *t, fl_known_gap *g)
{
    float *const all[] = {&g->k[0], &g->k[1], &g->k[2], &g->level};
    for (int k = 0; k < 4; k++) {
        double x = (double)*all[k];
        fl_state_io_real(t, &x);
        *all[k] = (float)x;
    }
}

static void exchange_rolling(fl_state_io *t, fl_rolling_spring *r)
{
    fl_state_io_vec3(t, &r->elastic);
    fl_state_io_real(t, &r->k);
    fl_state_io_vec3(t, &r->total);
    fl_state_io_real(t, &r->arm);
}

/* Rolling springs of a touching pair, where its law has rolling resistance. */
static void exchange_pair_rolling(fl_state_io *t, const fl_world *w, fl_pair *p)
{
    if (!p->touching || !fl_pair_has_rolling(w, p)) return;
    if (!p->rolling && !(p->rolling = fl_alloc(1, sizeof *p->rolling, t->err))) return;
    exchange_rolling(t, p->rolling);
}

/* Record of crushing, if there is one. */
static void exchange_crush(fl_state_io *t, const fl_world *w, fl_pair *p)
{
    int32_t there = p->crush != NULL;
    fl_state_io_int(t, 0, 1, &there);
    if (p->touching || there) fl_state_io_real(t, &p->nominal_area), fl_state_io_real(t, &p->crush_checked);
    if (!there || t->err->code) return;
    if (!p->crush && !(p->crush = fl_alloc(1, sizeof *p->crush, t->err))) return;
    fl_crush *const c = p->crush;
    fl_state_io_vec3(t, &c->offset);
    fl_state_io_vec3(t, &c->centre);
    fl_state_io_vec3(t, &c->normal);
    fl_state_io_vec3(t, &c->lean);
    fl_state_io_real(t, &c->stiffening);
    fl_state_io_int(t, 0, 1, &c->unsaved);
    if (t->f || t->err->code) return;
    if (!(c->stiffening > 0.0) || p->nominal_area < 0.0)
        fl_text_fail(t->in, t->err, "the crushing of a contact has impossible values");
    p->k = c->stiffening * fl_pair_stiffness(w, p->i, p->j).k;
}

/* Results of the last evaluation. */
static void exchange_forces(fl_state_io *t, fl_pair *p)
{
    fl_vec3 *const all[] = {&p->force,          &p->torque_i,          &p->torque_j,
                            &p->force_damping,  &p->torque_i_damping,  &p->torque_j_damping,
                            &p->force_friction, &p->torque_i_friction, &p->torque_j_friction};
    for (int k = 0; k < 9; k++) fl_state_io_vec3(t, all[k]);
    fl_state_io_real(t, &p->energy);
    fl_state_io_real(t, &p->spring_energy);
    fl_state_io_real(t, &p->overlap);
    fl_state_io_real(t, &p->omega2_i);
    fl_state_io_real(t, &p->omega2_j);
}

/* 1 if e is a unit vector or 0. */
static int is_unit_or_zero(const double e[6])
{
    double sum = 0.0;
    for (int k = 0; k < 6; k++) sum += e[k] * e[k];
    return sum == 0.0 || fabs(sum - 1.0) < 1e-9;
}

/* 1 if the learnt values are possible. */
static int is_possible(const fl_surrogate *s)
{
    double zero = 0.0 * (s->previous.energy + s->slope_trend + s->defect_return + s->energy_defect +
                         s->half_width + s->skewness);
    for (int k = 0; k < 6; k++)
        zero += 0.0 * (s->third_order[k] + s->previous.slope[k] + s->previous.path[k]);
    return zero == 0.0 && is_unit_or_zero(s->path_direction) && s->previous.energy >= 0.0 &&
           s->half_width >= 0.0 && s->skewness >= 0.0;
}

/* Memory of the surrogate of its last exact evaluation; the rest follows from the relative pose of that
 * time. */
static void exchange_surrogate(fl_state_io *t, const fl_pair *p, fl_surrogate *s)
{
    fl_state_io_int(t, 0, p->points == FL_POINTS_PATCH, &s->valid);
    if (!s->valid) return;
    fl_state_io_int(t, 0, 1, &s->used);
    for (int k = 0; k < 9; k++) fl_state_io_real(t, &s->M.m[k / 3][k % 3]);
    fl_state_io_vec3(t, &s->o);
    fl_state_io_vec3(t, &s->point_a);
    fl_state_io_real(t, &s->length);
    fl_state_io_real(t, &s->reach);
    fl_state_io_real(t, &s->stiffness_i);
    fl_state_io_real(t, &s->stiffness_j);
    for (int r = 0; r < 6; r++)
        for (int k = r; k < 6; k++) {
            fl_state_io_real(t, &s->learnt[r][k]);
            s->learnt[k][r] = s->learnt[r][k];
        }
    for (int k = 0; k < 6; k++) {
        fl_state_io_real(t, &s->path_direction[k]);
        fl_state_io_real(t, &s->third_order[k]);
        fl_state_io_real(t, &s->previous.slope[k]);
        fl_state_io_real(t, &s->previous.path[k]);
    }
    fl_state_io_real(t, &s->previous.energy);
    fl_state_io_real(t, &s->slope_trend);
    fl_state_io_real(t, &s->defect_return);
    fl_state_io_real(t, &s->energy_defect);
    fl_state_io_real(t, &s->half_width);
    fl_state_io_real(t, &s->skewness);
    if (t->in && !t->err->code &&
        !(is_orthogonal(&s->M) && s->length > 0.0 && s->reach > 0.0 && s->reach <= FL_SURROGATE_MAX_REACH &&
          is_possible(s)))
        fl_text_fail(t->in, t->err, "the surrogate of a contact has impossible values");
}

/* Rebuild the surrogate that was read, by an exact evaluation at its pose. */
static void rebuild_surrogate(fl_world *w, fl_pair *p, const fl_surrogate *surrogate, fl_err *err)
{
    p->surrogate = fl_alloc(1, sizeof *p->surrogate, err);
    if (!p->surrogate) return;
    *p->surrogate = *surrogate;
    p->surrogate->valid = 0;
    p->surrogate->max_change = fl_surrogate_max_change(p->law->surrogate_tolerance);
    if (fl_pair_rebuild_surrogate(w, p, &surrogate->M, surrogate->o))
        fl_fail(err, FL_SYSTEM, "out of memory for pair %d and %d", p->i, p->j);
    p->surrogate->used = surrogate->used;
}

static void exchange_element(fl_state_io *t, fl_strip *q, int32_t k)
{
    int64_t count = q->count[k];
    fl_state_io_real(t, &fl_strip_column(q, FL_STRIP_E)[k]);
    fl_state_io_real(t, &fl_strip_column(q, FL_STRIP_U)[k]);
    fl_state_io_count(t, &count);
    fl_state_io_real(t, &fl_strip_column(q, FL_STRIP_AREA)[k]);
    fl_state_io_real(t, &fl_strip_column(q, FL_STRIP_MIDDLE)[k]);
    fl_state_io_real(t, &fl_strip_column(q, FL_STRIP_LOAD)[k]);
    for (int c = FL_STRIP_LEFT; c < FL_STRIP_COLUMNS; c++) fl_state_io_real(t, &fl_strip_column(q, c)[k]);
    q->count[k] = (int32_t)count;
}

/* The strip of a touching pair with a wall. */
static void exchange_strip(fl_state_io *t, const fl_world *w, fl_pair *p)
{
    if (!p->touching || !fl_pair_has_strip(w, p->j)) return;
    const fl_wall *wall = &w->strips.wall[p->j - w->n];
    if (!p->strip && !(p->strip = fl_strip_make(wall))) {
        fl_fail(t->err, FL_SYSTEM, "out of memory for pair %d and %d", p->i, p->j);
        return;
    }
    fl_strip *q = p->strip;
    fl_state_io_real(t, &q->largest_area);
    fl_state_io_real(t, &q->k);
    fl_state_io_real(t, &q->store);
    fl_state_io_real(t, &q->work);
    fl_state_io_vec3(t, &q->slid);
    fl_state_io_vec3(t, &q->turned);
    fl_state_io_vec3(t, &q->near_area);
    fl_state_io_int(t, 0, 1, &q->near_known);
    fl_state_io_int(t, 0, 1, &q->apart);
    fl_state_io_real(t, &q->way);
    fl_state_io_real(t, &q->farthest);
    fl_state_io_real(t, &q->known_until);
    fl_state_io_count(t, &q->strength.node);
    fl_state_io_real(t, &q->strength.y0);
    fl_state_io_real(t, &q->strength.y1);
    fl_state_io_real(t, &q->closing);
    fl_state_io_int(t, 0, INT32_MAX, &q->breaks);
    for (int32_t k = 0; k < q->n && !t->err->code; k++) {
        exchange_element(t, q, k);
        if (t->in) fl_strip_place(q, wall, k);
    }
}

void fl_snapshot_pair(fl_state_io *t, fl_world *w, int32_t c)
{
    fl_neighbour_pair *near = &w->pair[c];
    fl_pair expanded = {0}, *p = near->contact ? near->contact : &expanded;
    if (t->f && p == &expanded) fl_neighbour_pair_expand(w, near, p);
    int32_t i = p->i, j = p->j;
    fl_state_io_open(t, "pair");
    fl_state_io_int(t, 0, w->n - 1, &i);
    fl_state_io_int(t, 0, w->b.total - 1, &j);
    if (t->in) {
        const fl_neighbour_pair *q = c > 0 ? near - 1 : NULL;
        if (t->err->code) return;
        if (i >= j || (q && (q->i > i || (q->i == i && (w->cell.periodic ? q->j > j : q->j >= j))))) {
            fl_text_fail(t->in, t->err, "pair %d and %d found, pairs in ascending order expected", i, j);
            return;
        }
        if (fl_sphere_pair_kind(w, i, j)) {
            fl_text_fail(t->in, t->err, "pair %d and %d is of spheres, a row \"ball\" expected", i, j);
            return;
        }
        fl_pair_init(w, p, i, j);
    }
    for (int axis = 0; w->cell.periodic && axis < 3; axis++)
        fl_state_io_int(t, -INT32_MAX, INT32_MAX, &p->image[axis]);
    if (t->in && !t->err->code && fl_bond_list_is_bonded(w, i, j, p->image))
        fl_text_fail(t->in, t->err, "pair %d and %d found, but their bond is not ended", i, j);
    if (t->in && !t->err->code) fl_bond_list_init_pair(w, p);
    fl_state_io_int(t, 0, 1, &p->touching);
    exchange_memory(t, p);
    if (p->touching) exchange_forces(t, p);
    fl_known_gap gap = near->gap;
    if (!p->touching) exchange_gap(t, &gap);
    if (p->touching && j >= w->n && w->structure.piece[j - w->n].several_parts)
        fl_state_io_int(t, FL_LOAD_SHARED, w->parts - 1, &p->load_part);
    exchange_pair_rolling(t, w, p);
    if (w->strips.wall) exchange_strip(t, w, p);
    if (fl_pair_crushes(w, p)) exchange_crush(t, w, p);
    fl_surrogate surrogate = {0};
    if (t->f && p->surrogate) surrogate = *p->surrogate;
    if (p->touching && p->law->surrogate_tolerance > 0.0) exchange_surrogate(t, p, &surrogate);
    fl_state_io_close(t);
    if (!t->in || t->err->code) return;
    fl_neighbour_pair_init(near, i, j, p->image);
    near->gap = gap;
    if (fl_neighbour_pair_put_back(w, near, p))
        fl_fail(t->err, FL_SYSTEM, "out of memory for pair %d and %d", i, j);
    else if (surrogate.valid) rebuild_surrogate(w, near->contact, &surrogate, t->err);
}

void fl_snapshot_sphere_contact(fl_state_io *t, fl_world *w, int32_t c, int32_t last[2])
{
    const fl_sphere_contacts *s = &w->spheres;
    fl_sphere_contact r = {0};
    fl_rolling_spring roll = {.k = 0.0};
    int32_t i = 0, j = 0, touches = 0, image[3] = {0};
    if (t->f && c < 0) {
        const fl_wall_contact *const l = &s->wall[~c];
        i = l->i, j = l->j, touches = l->touches, r = l->contact;
        if (w->has_rolling) roll = s->wall_rolling[~c];
    } else if (t->f) {
        i = s->i[c], j = s->j[c], touches = s->touches[c], r = s->contact[c];
        if (w->has_rolling) roll = s->rolling[c];
        if (s->image) memcpy(image, &s->image[3 * c], sizeof image);
    }
    fl_state_io_open(t, "ball");
    fl_state_io_int(t, 0, w->n - 1, &i);
    fl_state_io_int(t, 0, w->b.total - 1, &j);
    for (int axis = 0; w->cell.periodic && axis < 3; axis++)
        fl_state_io_int(t, -INT32_MAX, INT32_MAX, &image[axis]);
    fl_state_io_int(t, 0, 1, &touches);
    fl_state_io_real(t, &r.max_approach_speed);
    fl_state_io_vec3(t, &r.spring_force);
    fl_state_io_real(t, &r.spring_stiffness);
    fl_state_io_vec3(t, &r.friction_force);
    fl_state_io_real(t, &r.normal_damping);
    if (w->has_rolling) exchange_rolling(t, &roll);
    fl_state_io_close(t);
    if (t->f || t->err->code) return;
    if (i >= j || i < last[0] || (i == last[0] && (w->cell.periodic ? j < last[1] : j <= last[1])) ||
        !fl_sphere_pair_kind(w, i, j)) {
        fl_text_fail(t->in, t->err, "spheres %d and %d found, pairs of spheres in ascending order expected",
                     i, j);
        return;
    }
    last[0] = i, last[1] = j;
    r.k = fl_pair_stiffness(w, i, j).k;
    fl_contact_list_append(w, i, j, image, touches, &r, &roll, t->err);
}
