/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "sim/snapshot.h"
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "base/parallel.h"
#include "contact/pair_law.h"
#include "contact/pair_response.h"
#include "contact/pair_store.h"
#include "contact/panel_load.h"
#include "out/state_io.h"
#include "sim/energy_ledger.h"
#include "sim/floe_setup.h"
#include "sim/inflow.h"
#include "sim/inflow_bonds.h"
#include "sim/member_structure.h"
#include "sim/moving_structure.h"
#include "sim/neighbour_list.h"
#include "sim/setup.h"
#include "sim/sleep.h"
#include "sim/snapshot_bond.h"
#include "sim/snapshot_failure.h"
#include "sim/snapshot_pair.h"
#include "sim/snapshot_zone.h"
#include "sphere/contact_list.h"

static void exchange_ledger(fl_state_io *t, fl_world *w)
{
    fl_ledger *g = &w->ledger;
    fl_state_io_open(t, "books");
    fl_state_io_real(t, &g->start);
    fl_state_io_real(t, &g->residual);
    fl_state_io_real(t, &g->throughput);
    fl_state_io_real(t, &g->friction);
    fl_state_io_real(t, &g->damping);
    fl_state_io_real(t, &g->drive);
    fl_state_io_real(t, &g->carried);
    fl_state_io_real(t, &g->crushing);
    fl_state_io_vec3(t, &w->imbalance);
    fl_state_io_real(t, &w->impulse_sum);
    fl_state_io_real(t, &w->max_overlap);
    fl_state_io_int(t, -1, INT32_MAX, &w->max_overlap_i);
    fl_state_io_int(t, -INT32_MAX, INT32_MAX, &w->max_overlap_j);
    fl_state_io_real(t, &w->max_overlap_time);
    fl_state_io_count(t, &w->deep_overlap_steps);
    fl_state_io_int(t, -INT32_MAX, INT32_MAX, &w->deep_overlap_i);
    fl_state_io_int(t, -INT32_MAX, INT32_MAX, &w->deep_overlap_j);
    fl_state_io_real(t, &w->deep_overlap_time);
    fl_state_io_count(t, &w->sudden.n);
    fl_state_io_count(t, &w->sudden.step);
    fl_state_io_int(t, -1, INT32_MAX, &w->sudden.i);
    fl_state_io_int(t, -1, INT32_MAX, &w->sudden.j);
    fl_state_io_real(t, &w->sudden.overlap);
    fl_state_io_real(t, &w->sudden.moved);
    fl_state_io_real(t, &w->sudden.time);
    fl_state_io_count(t, &w->contact_steps);
    fl_state_io_count(t, &w->searches);
    fl_state_io_count(t, &w->overlapping_cores);
    fl_state_io_count(t, &w->penetration_count.queries);
    fl_state_io_count(t, &w->penetration_count.no_answer);
    fl_state_io_count(t, &w->penetration_count.rejected);
    fl_state_io_count(t, &w->penetration_count.capped);
    fl_state_io_close(t);
}

static void exchange_surrogate_counts(fl_state_io *t, fl_world *w)
{
    fl_surrogate_count all = fl_surrogate_count_sum(w->surrogate_counts, w->threads);
    fl_state_io_open(t, "told");
    fl_state_io_count(t, &all.hits);
    fl_state_io_count(t, &all.checks);
    fl_state_io_count(t, &all.misses);
    fl_state_io_real(t, &all.worst_error);
    fl_state_io_close(t);
    if (!t->in || t->err->code) return;
    for (int32_t k = 0; k < w->threads; k++) w->surrogate_counts[k] = (fl_surrogate_count){0};
    w->surrogate_counts[0] = all;
}

/* Counts of outflow and inflow, and the floe in each place.  A floe that came in is built again before
 * its body is read. */
static void exchange_inflow(fl_state_io *t, fl_world *w)
{
    fl_inflow_state *c = &w->inflow;
    const int32_t feed = c->feed ? c->feed->n : 0;
    fl_state_io_open(t, "traffic");
    fl_state_io_count(t, &c->n_left);
    fl_state_io_count(t, &c->n_entered);
    fl_state_io_real(t, &c->mass_left);
    fl_state_io_real(t, &c->mass_entered);
    fl_state_io_vec3(t, &c->momentum_left);
    fl_state_io_vec3(t, &c->momentum_entered);
    fl_state_io_int(t, 0, INT32_MAX, &c->next_id);
    fl_state_io_count(t, &c->n_blocked);
    fl_state_io_count(t, &c->n_dropped);
    fl_state_io_close(t);
    for (int32_t k = 0; k < feed && !t->err->code; k++) {
        fl_state_io_open(t, "next");
        fl_state_io_count(t, &c->next_copy[k]);
        fl_state_io_close(t);
    }
    c->floes = 0;
    for (int32_t i = 0; i < w->n && !t->err->code; i++) {
        int32_t floe = c->source_floe[i], id = w->id[i];
        uint8_t guided = c->guided[i], cut = w->breaking.on && w->breaking.shape[i];
        fl_state_io_open(t, "place");
        fl_state_io_byte(t, 1, &c->absent[i]);
        c->floes += !c->absent[i];
        if (!c->absent[i] && i >= c->places) c->places = i + 1;
        fl_state_io_int(t, -1, feed - 1, &floe);
        fl_state_io_int(t, 0, INT32_MAX, &id);
        fl_state_io_count(t, &c->entry_step[i]);
        fl_state_io_byte(t, 1, &guided);
        if (w->breaking.on) fl_state_io_byte(t, 1, &cut);
        fl_state_io_close(t);
        if (cut && !t->err->code) fl_snapshot_shape(t, w, i);
        if (t->f || t->err->code) continue;
        if (cut || (w->breaking.on && c->absent[i])) {
            c->source_floe[i] = floe;
            w->id[i] = id;
            continue;
        }
        if (floe != c->source_floe[i] && (!c->feed || (floe < 0 && i >= c->ice->n))) {
            fl_text_fail(t->in, t->err, "place %d has no floe of the ice file", i);
            continue;
        }
        const int other = floe != c->source_floe[i];
        fl_inflow_set_guided(w, i, 0); /* release the floe of a state read before */
        c->source_floe[i] = floe;
        if (other && fl_world_place_floe(w, i, floe < 0 ? c->ice : c->feed, floe < 0 ? i : floe, t->err))
            continue;
        w->id[i] = id;
        fl_inflow_set_guided(w, i, guided);
    }
    if (t->in && !t->err->code) fl_inflow_bonds_refresh(w);
}

/* The motion of a body, to the last bit: w does not always follow from L and q. */
static void exchange_motion(fl_state_io *t, fl_bodies *b, int32_t k)
{
    fl_state_io_vec3(t, &b->x[k]);
    fl_state_io_vec3(t, &b->v[k]);
    fl_state_io_vec3(t, &b->L[k]);
    fl_state_io_quat(t, &b->q[k]);
    fl_state_io_vec3(t, &b->w[k]);
    fl_state_io_vec3(t, &b->f[k]);
    fl_state_io_vec3(t, &b->t[k]);
    fl_state_io_real(t, &b->work_of_constraints[k]);
}

static void exchange_body(fl_state_io *t, fl_world *w, int32_t k)
{
    fl_bodies *b = &w->b;
    fl_state_io_open(t, "body");
    exchange_motion(t, b, k);
    if (b->added_mass) fl_state_io_real(t, &b->flow_work[k]);
    if (b->heave_mass) fl_state_io_real(t, &b->heave_work[k]);
    fl_state_io_real(t, &b->odometer[k]);
    fl_state_io_real(t, &w->odometer_at_search[k]);
    fl_state_io_close(t);
}

/* The table of the current is not stored, but must be the same. */
static void exchange_current_hash(fl_state_io *t, const fl_current *c)
{
    const uint64_t bits = fl_hash(FL_HASH_START, c->z, c->n * (int64_t)sizeof *c->z);
    fl_state_io_open(t, "current");
    if (fl_state_io_hash(t, fl_hash(bits, c->u, c->n * (int64_t)sizeof *c->u)))
        fl_text_fail(t->in, t->err, "the rows of water.profile_file have changed since the checkpoint");
    fl_state_io_close(t);
}

static void exchange_sleep(fl_state_io *t, fl_world *w, int32_t k)
{
    fl_sleep_state *n = &w->sleep.state[k];
    fl_state_io_open(t, "nap");
    fl_state_io_byte(t, FL_RESTING, &w->sleep.phase[k]);
    fl_state_io_count(t, &n->since_step);
    fl_state_io_count(t, &w->sleep.phase_end[k]);
    fl_state_io_real(t, &n->path_bound);
    fl_state_io_real(t, &n->window_odometer);
    fl_state_io_real(t, &n->drag_rate);
    fl_state_io_real(t, &n->max_error);
    fl_state_io_real(t, &n->sum_error);
    fl_state_io_count(t, &n->ballistic_steps);
    fl_state_io_count(t, &n->resting_steps);
    fl_state_io_count(t, &n->n_skips);
    fl_state_io_int(t, 1, INT32_MAX, &n->next_skip);
    fl_state_io_close(t);
    if (t->in && !t->err->code && (n->since_step > w->step || n->path_bound < 0.0))
        fl_text_fail(t->in, t->err, "body %d sleeps since step %g of %g", w->id[k], (double)n->since_step,
                     (double)w->step);
}

/* The path of a body through a block of waves; the rest is evaluated again. */
static void exchange_block(fl_state_io *t, fl_wave_block *c)
{
    fl_state_io_count(t, &c->level);
    fl_state_io_int(t, 0, 2, &c->span);
    fl_state_io_int(t, 0, INT32_MAX, &c->short_blocks_left);
    fl_state_io_quat(t, &c->q);
    for (int k = 0; k < FL_WAVE_SAMPLES; k++) fl_state_io_vec3(t, &c->x[k]), fl_state_io_vec3(t, &c->turn[k]);
    if (t->in && !t->err->code && c->level != FL_WAVE_NO_BLOCK && (c->level < 0 || c->span < 1))
        fl_text_fail(t->in, t->err, "a block of waves at level %lld in steps of %d does not exist",
                     (long long)c->level, c->span);
}

static void exchange_water(fl_state_io *t, fl_environment *s, const fl_bodies *b, int32_t i)
{
    double energy = s->water && !s->waves ? fl_environment_energy(s, b, i) : 0.0,
           unused = 0.0; /* written, but not needed */
    fl_state_io_open(t, "sea");
    fl_state_io_real(t, &s->wetted_area[i]);
    fl_state_io_real(t, &s->buoyancy[i]);
    fl_state_io_real(t, &energy);
    fl_state_io_real(t, &s->drag_loss[i]);
    fl_state_io_real(t, s->wind_work ? &s->wind_work[i] : &unused);
    if (s->waves) fl_state_io_real(t, &s->water_work[i]);
    if (s->sample) {
        fl_wave_sample *h = &s->sample[i];
        fl_state_io_vec3(t, &h->df), fl_state_io_vec3(t, &h->dt), fl_state_io_vec3(t, &h->dflow);
        fl_state_io_real(t, &h->dz), fl_state_io_real(t, &h->dslope);
        fl_state_io_pose(t, &h->x, &h->q);
        fl_state_io_real(t, &h->when);
    }
    if (s->block) exchange_block(t, &s->block[i]);
    fl_state_io_close(t);
}

/* The track is read again from its file; its hash must be the same. */
static void exchange_mover(fl_state_io *t, fl_world *w, int32_t k)
{
    fl_rigid_motions *m = &w->moving.movers;
    fl_bodies *b = &m->b;
    const fl_track *tr = &m->motion[k].track;
    uint64_t bits = FL_HASH_START;
    if (tr->n)
        bits = fl_hash(fl_hash(bits, tr->t, tr->n * (int64_t)sizeof *tr->t), tr->value,
                       tr->n * (int64_t)sizeof *tr->value);
    fl_state_io_open(t, "mover");
    if (fl_state_io_hash(t, bits))
        fl_text_fail(t->in, t->err, "the rows of the track of %s have changed since the checkpoint",
                     fl_mover_name(w, k));
    exchange_motion(t, b, k);
    fl_state_io_vec3(t, &m->prescribed[k]);
    fl_state_io_vec3(t, &m->prescribed_velocity[k]);
    fl_state_io_vec3(t, &m->spring_force[k]);
    fl_state_io_vec3(t, &m->spring_torque[k]);
    fl_state_io_real(t, &m->spring_energy[k]);
    fl_state_io_real(t, &m->damper_loss[k]);
    fl_state_io_real(t, &m->prescribed_work[k]);
    fl_state_io_close(t);
}

/* Waves on the hull of mover k; the load is evaluated again. */
static void exchange_hull(fl_state_io *t, fl_rigid_motions *m, int32_t k)
{
    fl_floating_hull *h = &m->hulls.hull[k];
    fl_state_io_open(t, "hull");
    fl_state_io_real(t, &h->work);
    fl_state_io_real(t, &h->drag_loss);
    if (m->b.added_mass) fl_state_io_real(t, &m->b.flow_work[k]);
    if (m->hulls.sea->by_blocks) exchange_block(t, &h->block);
    fl_state_io_close(t);
    if (t->in && !t->err->code) fl_floating_hull_refresh(&m->hulls, &m->b, k);
}

/* The state of a mode; its name must be the same. */
static void exchange_mode(fl_state_io *t, fl_world *w, int32_t k)
{
    int32_t mover;
    fl_modal_dof *m = (fl_modal_dof *)(uintptr_t)fl_structure_mode(w, k, &mover);
    fl_state_io_open(t, "mode");
    if (fl_state_io_hash(t, fl_hash(FL_HASH_START, m->name, (int64_t)strlen(m->name))))
        fl_text_fail(t->in, t->err, "the modes of %s have changed since the checkpoint",
                     fl_mover_name(w, mover));
    fl_state_io_real(t, &m->q);
    fl_state_io_real(t, &m->v);
    fl_state_io_real(t, &m->load);
    fl_state_io_real(t, &m->force);
    fl_state_io_real(t, &m->spring_energy);
    fl_state_io_real(t, &m->damped);
    fl_state_io_close(t);
}

/* The track of the driven floes is not stored, but must be the same. */
static void exchange_drive_track(fl_state_io *t, const fl_track *tr)
{
    const uint64_t bits = fl_hash(FL_HASH_START, tr->t, tr->n * (int64_t)sizeof *tr->t);
    fl_state_io_open(t, "drive");
    if (fl_state_io_hash(t, fl_hash(bits, tr->value, tr->n * (int64_t)sizeof *tr->value)))
        fl_text_fail(t->in, t->err, "the rows of boundary.drive_track have changed since the checkpoint");
    fl_state_io_close(t);
}

static void exchange_push(fl_state_io *t, fl_push *p)
{
    fl_state_io_open(t, "push");
    fl_state_io_real(t, &p->velocity);
    fl_state_io_real(t, &p->back);
    fl_state_io_real(t, &p->force);
    fl_state_io_real(t, &p->way);
    fl_state_io_real(t, &p->impulse);
    fl_state_io_real(t, &p->limited);
    fl_state_io_real(t, &p->work);
    fl_state_io_close(t);
}

/* A structure of members: its balls.  Its forces follow from them and from those on the pieces. */
static void exchange_members(fl_state_io *t, fl_world *w)
{
    fl_member_dynamics *d = &w->moving.members.dynamics;
    int32_t balls = d->chain.balls;
    fl_state_io_open(t, "members");
    fl_state_io_int(t, balls, balls, &balls);
    fl_state_io_real(t, &d->damped);
    fl_state_io_int(t, 0, INT32_MAX, &d->ruptured);
    fl_state_io_close(t);
    for (int32_t k = 0; k < d->chain.balls && !t->err->code; k++) {
        fl_member_ball *a = &d->chain.ball[k];
        fl_state_io_open(t, "chain");
        fl_state_io_vec3(t, &a->d);
        fl_state_io_vec3(t, &a->v);
        fl_state_io_quat(t, &a->q);
        fl_state_io_vec3(t, &a->w);
        fl_state_io_close(t);
    }
    for (int32_t k = 0; k < d->chain.yielding && !t->err->code; k++) {
        fl_member_fibres *f = &d->chain.fibres[k];
        fl_state_io_open(t, "yields");
        fl_state_io_real(t, &f->dissipated);
        fl_state_io_real(t, &f->strain);
        fl_state_io_int(t, 0, 1, &f->ruptured);
        fl_state_io_int(t, 0, 1, &f->yielded);
        for (int e = 0; e < f->section->n && f->yielded && !t->err->code; e++)
            fl_state_io_real(t, &f->plastic[e]);
        fl_state_io_close(t);
    }
    if (t->in && !t->err->code) fl_member_structure_refresh(w);
}

/* A contact point on the structure, of the last step. */
static void exchange_point(fl_state_io *t, fl_world *w, fl_panel_point *m)
{
    fl_state_io_open(t, "mark");
    fl_state_io_int(t, 0, w->n - 1, &m->i);
    fl_state_io_int(t, 0, w->parts - 1, &m->part);
    fl_state_io_int(t, 0, w->panel_load.panels - 1, &m->panel);
    fl_state_io_vec3(t, &m->force);
    fl_state_io_vec3(t, &m->n);
    fl_state_io_vec3(t, &m->point);
    fl_state_io_real(t, &m->normal_force);
    fl_state_io_real(t, &m->area);
    fl_state_io_real(t, &m->overlap);
    fl_state_io_close(t);
}

static void exchange_event(fl_state_io *t, fl_world *w, fl_load_event *e)
{
    fl_state_io_open(t, "event");
    fl_state_io_int(t, INT32_MIN, INT32_MAX, &e->id);
    fl_state_io_int(t, 0, w->parts - 1, &e->part);
    fl_state_io_vec3(t, &e->impulse);
    fl_state_io_vec3(t, &e->normal_impulse);
    fl_state_io_vec3(t, &e->impulse_point);
    fl_state_io_real(t, &e->impulse_sum);
    fl_state_io_real(t, &e->impulse_area);
    fl_state_io_real(t, &e->max_overlap);
    fl_state_io_close(t);
}

/* The contact points of the last step, and the loads of panels and events in the interval so far. */
static void exchange_panel_loads(fl_state_io *t, fl_world *w)
{
    fl_panel_loads *s = &w->panel_load;
    int32_t panels = s->panels, loaded = 0;
    for (int32_t k = 0; k < s->panels; k++) loaded += v3_norm2(s->impulse[k]) > 0.0;
    fl_state_io_open(t, "pressed");
    fl_state_io_int(t, s->panels, s->panels, &panels);
    fl_state_io_int(t, 0, s->panels, &loaded);
    fl_state_io_int(t, 0, INT32_MAX, &s->points);
    fl_state_io_int(t, 0, INT32_MAX, &s->events);
    fl_state_io_close(t);
    const int32_t points = s->points, events = s->events;
    if (t->in) s->points = s->events = 0;
    if (t->in && !t->err->code) fl_panels_end_interval(w);
    for (int32_t c = 0, k = -1; c < loaded && !t->err->code; c++) {
        if (t->f) do
                k++;
            while (!(v3_norm2(s->impulse[k]) > 0.0));
        fl_state_io_open(t, "panel");
        fl_state_io_int(t, k < 0 ? 0 : k, s->panels - 1, &k);
        if (!t->err->code) fl_state_io_vec3(t, &s->impulse[k]);
        fl_state_io_close(t);
    }
    for (int32_t k = 0; k < points && !t->err->code;
         k++) { /* the numbers are hints: the arrays grow with the rows */
        if (t->in && fl_grow(&s->point, &s->point_cap, (int64_t)k + 1, sizeof *s->point, t->err)) return;
        if (t->in) s->point[k] = (fl_panel_point){0};
        exchange_point(t, w, &s->point[k]);
        s->points = k + 1;
    }
    for (int32_t k = 0; k < events && !t->err->code; k++) {
        if (t->in && fl_grow(&s->event, &s->event_cap, (int64_t)k + 1, sizeof *s->event, t->err)) return;
        if (t->in) s->event[k] = (fl_load_event){0};
        exchange_event(t, w, &s->event[k]);
        s->events = k + 1;
    }
}

/* The loads of the last step that several parts bear. */
static void exchange_load_shares(fl_state_io *t, fl_world *w)
{
    fl_panel_loads *s = &w->panel_load;
    fl_state_io_open(t, "shared");
    fl_state_io_int(t, 0, INT32_MAX, &s->shares);
    fl_state_io_close(t);
    const int32_t shares = s->shares;
    if (t->in) s->shares = 0;
    for (int32_t k = 0; k < shares && !t->err->code; k++) {
        if (t->in && fl_grow(&s->share, &s->share_cap, (int64_t)k + 1, sizeof *s->share, t->err)) return;
        if (t->in) s->share[k] = (fl_load_share){0};
        fl_state_io_open(t, "share");
        fl_state_io_int(t, 0, w->n - 1, &s->share[k].i);
        fl_state_io_int(t, w->n, w->b.total - 1, &s->share[k].j);
        fl_state_io_int(t, 0, w->parts - 1, &s->share[k].part);
        fl_state_io_vec3(t, &s->share[k].force);
        fl_state_io_vec3(t, &s->share[k].torque);
        fl_state_io_close(t);
        s->shares = k + 1;
    }
}

/* Stages, and the way to a state of rest. */
static void exchange_statics(fl_state_io *t, fl_world *w)
{
    fl_relax_state *s = &w->relax;
    fl_state_io_open(t, "stage");
    fl_state_io_int(t, 0, w->scene->n_stage, &w->next_stage);
    fl_state_io_count(t, &w->stage_step);
    fl_state_io_int(t, 0, 1, &s->settled);
    fl_state_io_real(t, &s->rate);
    fl_state_io_real(t, &s->r.c);
    fl_state_io_real(t, &s->r.kinetic);
    fl_state_io_int(t, 0, 1, &s->r.fresh);
    fl_state_io_int(t, 0, 1, &s->r.rests);
    fl_state_io_close(t);
    for (int32_t k = 0; k < w->n && s->damping && !t->err->code; k++) {
        fl_state_io_open(t, "damped");
        fl_state_io_vec3(t, &s->damping[k][0]), fl_state_io_vec3(t, &s->damping[k][1]);
        if (s->force) fl_state_io_vec3(t, &s->force[k]);
        fl_state_io_close(t);
    }
}

/* Everything but the pairs; returns their number. */
static int32_t exchange_all_but_pairs(fl_state_io *t, fl_world *w, int32_t *spheres)
{
    int32_t parts = w->parts, total = w->b.total, n_sea = w->sea.n, pairs = w->n_pair;
    *spheres = fl_contact_list_size(w);
    fl_state_io_open(t, "world");
    fl_state_io_count(t, &w->step);
    fl_state_io_count(t, &w->last_search_step);
    fl_state_io_real(t, &w->dt);
    fl_state_io_real(t, &w->t0);
    fl_state_io_count(t, &w->step0);
    fl_state_io_real(t, &w->sea.time);
    fl_state_io_real(t, &w->skin);
    fl_state_io_real(t, &w->dt_critical);
    fl_state_io_real(t, &w->dt_critical_contacts);
    fl_state_io_int(t, -1, w->b.total + w->moving.movers.n - 1 + fl_structure_has_members(w),
                    &w->critical_body);
    fl_state_io_real(t, &w->dt_safe);
    fl_state_io_int(t, w->parts, w->parts, &parts);
    fl_state_io_int(t, w->b.total, w->b.total, &total);
    fl_state_io_int(t, w->sea.n, w->sea.n, &n_sea);
    fl_state_io_int(t, 0, INT32_MAX, &pairs);
    fl_state_io_int(t, 0, INT32_MAX, spheres);
    fl_state_io_close(t);
    if (t->in && !t->err->code &&
        !(w->step >= 0 && w->dt > 0.0 && isfinite(w->dt) && w->skin >= 0.0 && w->t0 >= 0.0 &&
          isfinite(w->t0) && w->step0 >= 0 && w->step0 <= w->step &&
          fabs(w->sea.time - fl_world_time(w)) < 0.5 * w->dt)) /* but for rounding after a change of step */
        fl_text_fail(t->in, t->err, "step %g of %g s is not a valid state of a run", (double)w->step, w->dt);
    exchange_ledger(t, w);
    if (w->surrogate_counts) exchange_surrogate_counts(t, w);
    for (int32_t p = 0; p < w->parts && !t->err->code; p++) {
        fl_state_io_open(t, "part");
        fl_state_io_vec3(t, &w->part_impulse[p]);
        fl_state_io_vec3(t, &w->part_moment[p]);
        fl_state_io_real(t, &w->part_peak[p]);
        if (w->strips.wall) {
            fl_state_io_real(t, &w->strips.part_closing[p]);
            fl_state_io_real(t, &w->strips.part_seconds[p]);
            fl_state_io_count(t, &w->strips.part_breaks[p]);
        }
        fl_state_io_close(t);
    }
    if (w->inflow.absent && !t->err->code) exchange_inflow(t, w);
    if (w->crushing.dents && !t->err->code) fl_snapshot_crushing(t, w);
    if (w->breaking.on && !t->err->code) fl_snapshot_breaking(t, w);
    if ((w->relax.kind || w->scene->n_stage) && !t->err->code) exchange_statics(t, w);
    for (int32_t k = 0; k < w->b.total && !t->err->code; k++) exchange_body(t, w, k);
    if (t->in) w->sleep.n_resting = 0;
    for (int32_t k = 0; k < w->n && w->sleep.state && !t->err->code; k++) {
        exchange_sleep(t, w, k);
        if (t->in) w->sleep.n_resting += w->sleep.phase[k] == FL_RESTING;
    }
    for (int32_t k = 0; k < w->moving.movers.n && !t->err->code; k++) exchange_mover(t, w, k);
    for (int32_t k = 0, n = fl_structure_modes(w); k < n && !t->err->code; k++) exchange_mode(t, w, k);
    if (w->driven_floes.track.n && !t->err->code) exchange_drive_track(t, &w->driven_floes.track);
    if (w->push.of && !t->err->code) exchange_push(t, &w->push);
    if (fl_structure_has_members(w) && !t->err->code) exchange_members(t, w);
    fl_snapshot_bonds(t, w);
    if (w->discs.n && !t->err->code) fl_snapshot_discs(t, w);
    if (w->zones.set.blocks && !t->err->code) fl_snapshot_zones(t, w);
    if (w->panel_load.panels && !t->err->code) exchange_panel_loads(t, w);
    if (w->panel_load.shared && !t->err->code) exchange_load_shares(t, w);
    const double now = w->sea.time;
    if (w->sea.current.n) exchange_current_hash(t, &w->sea.current);
    if (t->in && !t->err->code && fl_environment_prepare(&w->sea, &w->b, w->inflow.absent, now, 1, t->err))
        return pairs;
    for (int32_t i = 0; i < w->sea.n && !t->err->code; i++) {
        exchange_water(t, &w->sea, &w->b, i);
        if (t->in && !t->err->code && w->sea.sample && !fl_body_absent(w, i) &&
            !(w->sea.sample[i].when <= now))
            fl_text_fail(t->in, t->err, "a sample of the water at %g s is not in the past",
                         w->sea.sample[i].when);
        if (!t->in || t->err->code || fl_body_absent(w, i)) continue;
        if (fl_sleep_phase_of(w, i) != FL_AWAKE) /* it feels the water of that time */
            w->sea.time = fl_sleep_start_time(w, i);
        fl_environment_refresh(&w->sea, &w->b, i);
        w->sea.time = now;
    }
    for (int32_t k = 0; k < w->moving.movers.n && !t->err->code; k++)
        if (fl_floating_hulls_has(&w->moving.movers.hulls, k)) exchange_hull(t, &w->moving.movers, k);
    return pairs;
}

void fl_snapshot_write(FILE *f, fl_world *w)
{
    fl_err unused = {0};
    fl_state_io t = {.f = f, .err = &unused};
    int32_t spheres;
    exchange_all_but_pairs(&t, w, &spheres);
    for (int32_t c = 0; c < w->n_pair; c++) fl_snapshot_pair(&t, w, c);
    fl_contact_iterator at = {0};
    for (int32_t c = 0; c < spheres; c++)
        fl_snapshot_sphere_contact(&t, w, fl_contact_list_next(w, &at), NULL);
}

int fl_snapshot_read(fl_world *w, fl_text *in, fl_err *err)
{
    fl_state_io t = {.in = in, .err = err};
    int32_t cap = 0, spheres, last[2] = {-1, -1};
    const int32_t pairs = exchange_all_but_pairs(&t, w, &spheres);
    fl_neighbour_pairs_free(w);
    /* The number is a hint: the array grows with the rows. */
    for (int32_t c = 0; c < pairs && !err->code; c++) {
        if (fl_grow(&w->pair, &cap, (int64_t)c + 1, sizeof *w->pair, err)) return -1;
        w->pair[c] = (fl_neighbour_pair){0};
        fl_snapshot_pair(&t, w, c);
        w->n_pair = c + 1;
    }
    w->spheres.n = w->spheres.walls = 0;
    for (int32_t c = 0; c < spheres && !err->code; c++) fl_snapshot_sphere_contact(&t, w, c, last);
    if (err->code) return -1;
    const int more = fl_text_row(in, err);
    if (more > 0) fl_text_fail(in, err, "unexpected \"%.40s\" after the last pair", in->field[0]);
    if (more) return -1;
    if (fl_structure_moves(w)) fl_moving_structure_set_step(w);
    if ((fl_contact_list_size(w) || w->spheres.bodies) && fl_contact_list_index(w, err)) return -1;
    if (fl_neighbour_list_index(w, err)) return -1;
    fl_sleep_after_read(w);
    for (int32_t k = 0; k < w->b.total; k++) fl_contact_sums_recompute(w, k);
    return 0;
}
