/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "report.h"
#include <inttypes.h>
#include "contact/bond_list.h"
#include "contact/joint_list.h"
#include "sim/critical_step.h"
#include "sim/energy_balance.h"
#include "sim/inflow.h"
#include "sim/sleep.h"
#include "step_choice.h"
#include "warnings.h"

/* The rows of run.error: goal, error found, cost. */
static void report_run_error(const fl_error_budget *g, FILE *f)
{
    double difference;
    const double error = fl_error_budget_run_error(g, &difference);
    const fl_companion *s = &g->companion;
    if (!(s->step_ratio > 0.0) || g->latest_window < 0) return;
    fprintf(f,
            "                   run as a whole: error %.2g; the companion run, of %.3g times the step, "
            "differs by "
            "%.2g",
            error, s->step_ratio, difference);
    if (s->ended) fprintf(f, " until %.4g s, where its step is above the critical one", s->last_row_time);
    if (s->exceeded_since >= 0.0) fprintf(f, "; above three times the goal since %.4g s", s->exceeded_since);
    putc('\n', f);
}

static void report_budget(const struct run *r, FILE *f, enum report_kind kind)
{
    static const char *const OF[] = {"impulse", "peak", "fx", "fy", "fz", "mx", "my", "mz"};
    const fl_error_budget *g = r->budget;
    const double horizon = fl_error_budget_horizon(g), window = g->row_interval * g->window_rows;
    const int32_t last = g->latest_window;
    fprintf(f, "error budget       %.3g of the %s: ", g->goal, OF[g->load]);
    if (last < 0) fprintf(f, "no contact, the step is the largest allowed\n");
    else
        fprintf(f, "%.2g by estimate, of order %.2g; %" PRId64 " searches, steps of %.3g s to %.3g s\n",
                fl_error_budget_estimate(g, r->w->dt), g->window[last].order, g->n_searches, g->min_dt,
                g->max_dt);
    if (kind == REPORT_WHOLE)
        fprintf(f, "                   cost: %" PRId64 " steps in trials, %.3g of all, in %.3g s\n",
                g->trial_steps,
                g->trial_steps > 0 ? (double)g->trial_steps / (double)(g->trial_steps + r->w->step) : 0.0,
                r->budget_wall);
    if (horizon < r->scene->run.duration)
        fprintf(
            f,
            "                   states that differ by one bit diverge within %.3g s: the load of the whole "
            "run is one sample of many; the error is that of windows of %.3g s\n",
            horizon, window);
    report_run_error(g, f);
}

static int has_failed_bonds(const fl_world *w)
{
    const fl_bond_counts n = fl_bond_list_counts(w);
    return n.state[FL_BOND_DAMAGED] + n.state[FL_BOND_BROKEN] + n.state[FL_BOND_ENDED] > 0;
}

static void report_bonds(const fl_world *w, FILE *f)
{
    const fl_bond_counts n = fl_bond_list_counts(w);
    const int32_t broken = n.state[FL_BOND_BROKEN] + n.state[FL_BOND_ENDED];
    const int32_t all = n.state[FL_BOND_INTACT] + n.state[FL_BOND_DAMAGED] + broken + n.left;
    fprintf(f, "bonds              %d whole, %d damaged, %d broken of %d: %.4g m2 of crack, %.4g J",
            n.state[FL_BOND_INTACT], n.state[FL_BOND_DAMAGED], broken, all, n.area, w->ledger.fracture);
    if (n.left) fprintf(f, "; %d left with their spheres", n.left);
    putc('\n', f);
}

static void report_joints(const fl_world *w, FILE *f)
{
    const fl_joint_counts n = fl_joint_list_counts(w);
    fprintf(
        f,
        "joints             %d elastic, %d slip, %d open, %d ended: %.4g J of friction, %.4g J of strength\n",
        n.elastic, n.slip, n.open, n.ended, fl_joint_list_friction_loss(w), w->ledger.fracture);
}

/* Members whose sections have yielded or ruptured. */
static void report_members(const fl_world *w, FILE *f)
{
    const fl_member_dynamics *d = &w->moving.members.dynamics;
    const fl_member_chain *c = &d->chain;
    int32_t yielded = 0;
    const fl_member_fibres *first = NULL;
    for (int32_t k = 0; k < c->yielding; k++) {
        yielded += c->fibres[k].yielded;
        if (!first && c->fibres[k].ruptured) first = &c->fibres[k];
    }
    fprintf(f, "members            %d of %d pieces yielded, %d ruptured: %.4g J", yielded, c->yielding,
            d->ruptured, w->ledger.plastic);
    if (first)
        fprintf(f, "; of member %s first",
                w->moving.members.model->member_name.name[c->contact[first->contact].member]);
    putc('\n', f);
}

/* Zones, those that have yielded, and what they lost. */
static void report_zones(const fl_world *w, FILE *f)
{
    const fl_zone_set *s = &w->zones.set;
    int32_t yielded = 0;
    for (int32_t k = 0; k < s->zones; k++) yielded += fl_zone_lost(s, k) > 0.0;
    fprintf(f, "zones              %d in %d blocks", s->zones, s->blocks);
    if (s->plastic) fprintf(f, ", %d yielded: %.4g J", yielded, w->ledger.plastic);
    putc('\n', f);
}

void note_long_bonds(const fl_world *w, FILE *f)
{
    const fl_bond_counts n = fl_bond_list_counts(w);
    const fl_scene_bond *s = &w->scene->bond;
    if (n.coarse == 0) return;
    fprintf(f,
            "dem-solve: note: %d of %d bonds store more than the %.4g J/m2 of bond.energy at their strength: "
            "the longest is %.3g m, and the limit is %.3g m; a crack takes %.4g J/m2 in the mean%s\n",
            n.coarse, fl_world_bonds(w) - fl_world_joints(w), s->energy, n.longest, n.limit, n.energy,
            s->softening == FL_SOFTENING_STRETCH ? "" : " (see bond.softening)");
}

/* A failed run may leave no balance; floes at rest have no throughput to compare rounding with. */
static void report_energy(const fl_world *w, FILE *f)
{
    const fl_ledger *g = &w->ledger;
    const double error = fl_energy_error(w);
    if (!isfinite(g->residual) || !isfinite(g->throughput))
        fprintf(f, "energy residual    unknown: the energies are not finite\n");
    else if (!isfinite(error)) fprintf(f, "energy residual    unknown: the throughput is 0\n");
    else if (error == 0.0 && g->residual != 0.0)
        fprintf(f, "energy residual    0 but for rounding (%.3g J; %.3g J are stored, throughput %.3g J)\n",
                g->residual, fl_energy_stored(w), g->throughput);
    else
        fprintf(f, "energy residual    %.2g of the throughput (%.3g J of %.3g J)\n", error, g->residual,
                g->throughput);
}

static void report_momentum(const fl_world *w, FILE *f)
{
    const double residual = v3_norm(w->imbalance);
    if (isfinite(residual) && isfinite(w->impulse_sum))
        fprintf(f, "momentum residual  %.2g of the contact impulses (%.3g N s of %.3g N s)\n",
                w->impulse_sum > 0.0 ? residual / w->impulse_sum : 0.0, residual, w->impulse_sum);
    else fprintf(f, "momentum residual  unknown: the impulses are not finite\n");
}

/* The rows of the step that a record has: those that do not depend on how the run was stopped. */
static void report_step(const struct run *r, FILE *f, enum report_kind kind)
{
    const fl_world *w = r->w;
    char name[64];
    fprintf(f, "steps              %" PRId64 " of %.4g s\n", w->step, w->dt);
    if (kind == REPORT_WHOLE) fprintf(f, "set by             %s\n", r->step_by);
    if (isfinite(w->dt_critical))
        fprintf(f, "step over critical %.3g (smallest 2/omega seen: %.4g s, %s)\n", w->dt / w->dt_critical,
                w->dt_critical, body_name(w, w->critical_body, name));
    else fprintf(f, "step over critical no contact was made\n");
    if (r->budget) report_budget(r, f, kind);
    else if (isfinite(w->dt_critical_contacts))
        fprintf(
            f,
            "error of the step  about %.2g of a peak, at most %.2g of the impulse: estimated from the step "
            "over critical of contacts and the restitution, not measured (run.error measures it)%s\n",
            fl_peak_error(w), fl_impulse_error(w),
            has_failed_bonds(w) ? "; without the time at which bonds fail" : "");
}

static void report_speed(const struct run *r, FILE *f)
{
    const fl_world *w = r->w;
    const double steps = (double)(w->step - r->first_step), simulated = fl_world_time(w) - r->first_time,
                 contacts = (double)(w->contact_steps - r->first_contact_steps),
                 threads = fl_thread_count_mean(&w->team);
    fprintf(f, "speed              %.4g s simulated in %.4g s: %.3g x real time, %.3g thread%s", simulated,
            r->step_wall, r->step_wall > 0.0 ? simulated / r->step_wall : 0.0, threads,
            threads == 1.0 ? "" : "s");
    if (w->team.adaptive) fprintf(f, " of %d", w->threads);
    putc('\n', f);
    if (r->body_steps > 0)
        fprintf(
            f,
            "                   %.0f ns per body-step, %.0f ns per contact-step (%.3g contacts at a time, "
            "%" PRId64 " neighbour searches)\n",
            1e9 * r->step_wall / (double)r->body_steps, contacts > 0.0 ? 1e9 * r->step_wall / contacts : 0.0,
            contacts / steps, w->searches);
    if (w->device.gpu)
        fprintf(f, "device             %s; the processor moves %d of %d bodies\n", r->device,
                fl_device_guests(w), fl_floes_in_domain(w));
    fprintf(f, "processor          %.4g s of all threads, with searches, checkpoints and tables\n",
            r->cpu_time);
}

static void report_sleep(const fl_world *w, FILE *f)
{
    const fl_sleep_totals c = fl_sleep_sum_totals(w);
    const double all = (double)w->step * w->n;
    fprintf(
        f,
        "sleeping           %.3g %% of body-steps skipped without contact, %.3g steps per skip; %.3g %% at "
        "rest\n",
        100.0 * (double)c.ballistic_steps / all,
        c.n_skips ? (double)c.ballistic_steps / (double)c.n_skips : 0.0,
        100.0 * (double)c.resting_steps / all);
    fprintf(
        f,
        "                   error of a skip at most %.2g of the radius (run.sleep %.3g), %.2g in sum for a "
        "floe\n",
        c.max_error, w->sleep.tol, c.max_error_sum);
}

static void report_surrogate(const fl_world *w, FILE *f)
{
    const fl_surrogate_count c = fl_surrogate_count_sum(w->surrogate_counts, w->threads);
    fprintf(f,
            "surrogate share    %.3g of contact-steps; %.2g of the evaluations differ by more than the "
            "tolerance, at most by %.2g of the force\n",
            (double)c.hits / (double)w->contact_steps, c.checks ? (double)c.misses / (double)c.checks : 0.0,
            c.worst_error);
}

static void report_inflow(const fl_world *w, FILE *f)
{
    const fl_inflow_state *t = &w->inflow;
    if (t->leaves) fprintf(f, "floes out          %" PRId64 " (%.4g kg)\n", t->n_left, t->mass_left);
    if (t->feed) {
        fprintf(f, "floes in           %" PRId64 " (%.4g kg), %.4g kg/s", t->n_entered, t->mass_entered,
                fl_world_time(w) > 0.0 ? t->mass_entered / fl_world_time(w) : 0.0);
        if (t->n_blocked) fprintf(f, "; %" PRId64 " had to wait", t->n_blocked);
        if (t->n_dropped) fprintf(f, ", %" PRId64 " dropped", t->n_dropped);
        fputc('\n', f);
    }
    fprintf(f, "floes in domain    %d (capacity %d)\n", fl_floes_in_domain(w), w->n);
}

static void report_push(const fl_world *w, FILE *f)
{
    static const char *const OF[] = {"", "the row", "the wall", "the inflow"};
    const fl_push *p = &w->push;
    const double t = fl_world_time(w);
    fprintf(f, "pushed by          %s: ", OF[p->of]);
    if (isfinite(p->limit))
        fprintf(f, "at most %.4g N/m over %.4g m, %.4g N; ", p->limit / p->width, p->width, p->limit);
    fprintf(f, "mean push %.4g N, mean speed %.3g m/s", t > 0.0 ? p->impulse / t : 0.0,
            t > 0.0 ? p->way / t : 0.0);
    if (isfinite(p->limit))
        fprintf(f, ", %.3g %% of the time at the limit", t > 0.0 ? 100.0 * p->limited / t : 0.0);
    putc('\n', f);
}

static void report_crushing(const fl_world *w, FILE *f)
{
    const fl_crushing_state *s = &w->crushing;
    fprintf(f,
            "crushing           %.4g m3 of ice in %" PRId64 " contact-steps, %.4g J; largest force %.4g N\n",
            s->volume, s->contact_steps, w->ledger.crushing, s->peak);
    if (s->dents_dropped)
        fprintf(f, "                   %" PRId64 " dents more than a floe keeps, %d\n", s->dents_dropped,
                FL_DENTS);
}

static void report_breaking(const fl_world *w, FILE *f)
{
    const fl_breaking_state *s = &w->breaking;
    fprintf(f,
            "broken floes       %" PRId64 " bent, %" PRId64 " split, %" PRId64 " cut to cusps, %" PRId64
            " checks",
            s->bent, s->split, s->cusps, s->checks);
    if (s->too_small)
        fprintf(f, "; %" PRId64 " breaks too small (failure.fragment_min, or the step)", s->too_small);
    if (s->no_room) fprintf(f, "; %" PRId64 " without room (failure.fragments_max)", s->no_room);
    if (s->buckled) fprintf(f, "; %" PRId64 " loads near buckling", s->buckled);
    putc('\n', f);
}

static void report_overlaps(const struct run *r, FILE *f)
{
    const fl_world *w = r->w;
    char other[NAME_OF_ID];
    if (w->max_overlap_i >= 0)
        fprintf(f, "largest overlap    %.3g of the radii (body %d and %s, t = %.6g s)\n", w->max_overlap,
                w->max_overlap_i, name_of_id(r, w->max_overlap_j, other), w->max_overlap_time);
    else fprintf(f, "largest overlap    0 of the radii\n");
    if (w->deep_overlap_steps)
        fprintf(f,
                "deep overlaps      %" PRId64
                " steps above %g of the radii, first body %d and %s at t = %.6g s\n",
                w->deep_overlap_steps, FL_DEEP_OVERLAP, w->deep_overlap_i,
                name_of_id(r, w->deep_overlap_j, other), w->deep_overlap_time);
    if (w->overlapping_cores)
        fprintf(f,
                "core overlaps      %" PRId64
                " evaluations (the radius is too small or the contact too soft)\n",
                w->overlapping_cores);
}

/* Speed is never printed without the errors: the two blocks belong together. */
void write_report(const struct run *r, FILE *f, enum report_kind kind)
{
    const fl_world *w = r->w;
    report_step(r, f, kind);
    if (kind == REPORT_WHOLE) report_speed(r, f);
    if (w->sleep.state && w->step > 0 && w->n) report_sleep(w, f);
    if (w->surrogate_counts && w->contact_steps > 0) report_surrogate(w, f);
    if (r->saves && kind == REPORT_WHOLE)
        fprintf(f, "checkpoints        %" PRId64 " in %.3g s, the last at t = %.6g s\n", r->saves,
                r->save_wall, fl_world_time(w));
    report_energy(w, f);
    report_momentum(w, f);
    if (fl_world_bonds(w) > fl_world_joints(w)) report_bonds(w, f);
    if (fl_world_joints(w)) report_joints(w, f);
    if (w->zones.set.blocks) report_zones(w, f);
    if (w->moving.members.dynamics.chain.yielding) report_members(w, f);
    if (w->crushing.of != FL_CRUSHING_NONE) report_crushing(w, f);
    if (w->breaking.on) report_breaking(w, f);
    if (w->inflow.absent) report_inflow(w, f);
    if (w->push.of) report_push(w, f);
    report_overlaps(r, f);
    fprintf(f, "state hash         %016" PRIx64 "\n", fl_state_hash(w));
}
