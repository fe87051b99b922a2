/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <inttypes.h>
#include "run.h"
#include "sim/energy_balance.h"
#include "sim/critical_step.h"
#include "contact/bond_list.h"
#include "sim/sleep.h"
#include "sim/step.h"
#include "sim/inflow.h"

/* What the run comes to as a whole, by the one beside it. */
static void whole_of(const fl_error_budget *g, FILE *f)
{
    double apart;
    const double off = fl_error_budget_run_error(g, &apart);
    const fl_companion *s = &g->companion;
    if (!(s->step_ratio > 0.0) || g->latest_window < 0) return;
    fprintf(f,
            "                   as a whole %.2g, for beside it a run of %.3g times the step differs by %.2g",
            off, s->step_ratio, apart);
    if (s->ended) fprintf(f, " until %.4g s, where that step is above the critical one", s->last_row_time);
    if (s->exceeded_since >= 0.0)
        fprintf(f, "; more than three times what was asked for from %.4g s on", s->exceeded_since);
    putc('\n', f);
}

/* What was asked for, what was found, and what finding it cost. */
static void budget_of(const struct run *r, FILE *f)
{
    static const char *const OF[] = {"impulse", "peak", "fx", "fy", "fz", "mx", "my", "mz"};
    const fl_error_budget *g = r->budget;
    const double far = fl_error_budget_horizon(g), window = g->row_interval * g->window_rows;
    const int32_t last = g->latest_window;
    fprintf(f, "error budget       %.3g of the %s: ", g->goal, OF[g->load]);
    if (last < 0) fprintf(f, "nothing was touched, the step is the largest there may be\n");
    else
        fprintf(f, "%.2g by estimate, of order %.2g; %" PRId64 " looks, steps of %.3g s to %.3g s\n",
                fl_error_budget_estimate(g, r->w->dt), g->window[last].order, g->n_searches, g->min_dt,
                g->max_dt);
    fprintf(f, "                   found by %" PRId64 " steps besides, %.3g of all, in %.3g s\n",
            g->trial_steps,
            g->trial_steps > 0 ? (double)g->trial_steps / (double)(g->trial_steps + r->w->step) : 0.0,
            r->look_wall);
    if (far < r->scene->run.duration)
        fprintf(
            f,
            "                   states that differ by a bit are apart after %.3g s: what the run as a whole "
            "sums up to is one of many; the error is that of windows of %.3g s\n",
            far, window);
    whole_of(g, f);
}

static int bonds_failed(const fl_world *w)
{
    return w->bonds.n && fl_bond_list_counts(w).state[FL_BOND_INTACT] < w->bonds.n;
}

static void bonds_of(const fl_world *w, FILE *f)
{
    const fl_bond_counts n = fl_bond_list_counts(w);
    const int32_t open = n.state[FL_BOND_BROKEN] + n.state[FL_BOND_ENDED];
    fprintf(f, "bonds              %d whole, %d damaged, %d broken of %d: %.4g m2 of crack, %.4g J\n",
            n.state[FL_BOND_INTACT], n.state[FL_BOND_DAMAGED], open, w->bonds.n, n.area, w->ledger.fracture);
}

void report_bonds(const fl_world *w, FILE *f)
{
    const fl_bond_counts n = fl_bond_list_counts(w);
    const fl_scene_bond *s = &w->scene->bond;
    if (n.coarse == 0) return;
    fprintf(f,
            "dem-solve: note: %d of %d bonds store more than the %.4g J/m2 of bond.energy at their strength: "
            "the longest is %.3g m, and the limit is %.3g m; a crack takes %.4g J/m2 in the mean%s\n",
            n.coarse, w->bonds.n, s->energy, n.longest, n.limit, n.energy,
            s->softening == FL_SOFTENING_STRETCH ? "" : " (see bond.softening)");
}

/* A run that failed may leave no balance, and floes at rest have no throughput to hold rounding against. */
static void energy_of(const fl_world *w, FILE *f)
{
    const fl_ledger *g = &w->ledger;
    const double off = fl_energy_error(w);
    if (!isfinite(g->residual) || !isfinite(g->throughput))
        fprintf(f, "energy residual    unknown: the energies are not finite numbers any more\n");
    else if (!isfinite(off)) fprintf(f, "energy residual    unknown: nothing has gone through yet\n");
    else if (off == 0.0 && g->residual != 0.0)
        fprintf(f, "energy residual    0 but for rounding (%.3g J; %.3g J are stored, throughput %.3g J)\n",
                g->residual, fl_energy_stored(w), g->throughput);
    else
        fprintf(f, "energy residual    %.2g of the throughput (%.3g J of %.3g J)\n", off, g->residual,
                g->throughput);
}

static void momentum_of(const fl_world *w, FILE *f)
{
    const double off = v3_norm(w->imbalance);
    if (isfinite(off) && isfinite(w->impulse_sum))
        fprintf(f, "momentum residual  %.2g of the contact impulses (%.3g N s of %.3g N s)\n",
                w->impulse_sum > 0.0 ? off / w->impulse_sum : 0.0, off, w->impulse_sum);
    else fprintf(f, "momentum residual  unknown: the impulses are not finite numbers any more\n");
}

/* Speed is never printed without its error: the two blocks belong together. */
void report_write(const struct run *r, FILE *f)
{
    const fl_world *w = r->w;
    const double steps = (double)w->step, made = steps - (double)r->begun,
                 simulated = fl_world_time(w) - r->begun_time, touches = (double)w->contact_steps,
                 since = touches - (double)r->begun_touching;
    char name[64];
    fprintf(f, "steps              %" PRId64 " of %.4g s\n", w->step, w->dt);
    fprintf(f, "set by             %s\n", r->step_by);
    if (isfinite(w->dt_critical))
        fprintf(f, "step over critical %.3g (smallest 2/omega seen: %.4g s, %s)\n", w->dt / w->dt_critical,
                w->dt_critical, run_body(w, w->critical_body, name));
    else fprintf(f, "step over critical no contact was made\n");
    if (r->budget) budget_of(r, f);
    else if (isfinite(w->dt_critical_contacts))
        fprintf(f,
                "error of the step  about %.2g of a peak, %.2g of the impulse at the most: by the step over "
                "critical of what touches and the restitution, not measured (run.error does)%s\n",
                fl_peak_error(w), fl_impulse_error(w), bonds_failed(w) ? "; not of when bonds fail" : "");
    fprintf(f, "speed              %.4g s simulated in %.4g s: %.3g x real time, %.3g thread%s", simulated,
            r->wall, r->wall > 0.0 ? simulated / r->wall : 0.0, fl_thread_count_mean(&w->team),
            fl_thread_count_mean(&w->team) == 1.0 ? "" : "s");
    if (w->team.adaptive) fprintf(f, " of %d", w->threads);
    putc('\n', f);
    if (r->moved > 0)
        fprintf(f,
                "                   %.0f ns a body-step, %.0f ns a contact-step (%.3g contacts at a time, "
                "%" PRId64 " searches)\n",
                1e9 * r->wall / (double)r->moved, since > 0.0 ? 1e9 * r->wall / since : 0.0, since / made,
                w->searches);
    fprintf(f, "processor          %.4g s, of all threads and all that was done\n", r->busy);
    if (w->sleep.state && w->step > 0 && w->n) {
        const fl_sleep_totals c = fl_sleep_sum_totals(w);
        const double all = steps * w->n;
        fprintf(f,
                "asleep             %.3g of all body-steps coasting, %.3g at a time, %.3g resting; off by "
                "%.2g of "
                "the radius at most (run.sleep %.3g), and %.2g in all\n",
                (double)c.ballistic_steps / all,
                c.n_skips ? (double)c.ballistic_steps / (double)c.n_skips : 0.0,
                (double)c.resting_steps / all, c.max_error, w->sleep.tol, c.max_error_sum);
    }
    if (w->surrogate_counts && touches > 0.0) {
        const fl_surrogate_count c = fl_surrogate_count_sum(w->surrogate_counts, w->threads);
        fprintf(f,
                "surrogate          %.3g of all contact-steps without a look; the force of looks off by more "
                "than "
                "told in %.2g of them, by %.2g of the force at most\n",
                (double)c.hits / touches, c.checks ? (double)c.misses / (double)c.checks : 0.0,
                c.worst_error);
    }
    if (r->saves)
        fprintf(f, "checkpoints        %" PRId64 " in %.3g s besides, the last at t = %.6g s\n", r->saves,
                r->save_wall, fl_world_time(w));
    energy_of(w, f);
    momentum_of(w, f);
    if (w->bonds.n) bonds_of(w, f);
    if (w->inflow.absent) {
        const fl_inflow_state *t = &w->inflow;
        fprintf(f, "floes out          %" PRId64 " (%.4g kg)\n", t->n_left, t->mass_left);
        if (t->feed) {
            fprintf(f, "floes in           %" PRId64 " (%.4g kg), %.4g kg/s", t->n_entered, t->mass_entered,
                    fl_world_time(w) > 0.0 ? t->mass_entered / fl_world_time(w) : 0.0);
            if (t->n_blocked) fprintf(f, "; %" PRId64 " found their place taken", t->n_blocked);
            if (t->n_dropped) fprintf(f, ", %" PRId64 " never got one", t->n_dropped);
            fputc('\n', f);
        }
        fprintf(f, "floes there        %d of room for %d\n", fl_floes_in_domain(w), w->n);
    }
    if (w->max_overlap_i >= 0)
        fprintf(f, "largest overlap    %.3g of the radii (body %d and %d, t = %.6g s)\n", w->max_overlap,
                w->max_overlap_i, w->max_overlap_j, w->max_overlap_time);
    else fprintf(f, "largest overlap    0 of the radii\n");
    if (w->deep_overlap_steps)
        fprintf(f, "past half          %" PRId64 " steps, first body %d and %d at t = %.6g s\n",
                w->deep_overlap_steps, w->deep_overlap_i, w->deep_overlap_j, w->deep_overlap_time);
    if (w->overlapping_cores)
        fprintf(f,
                "core overlaps      %" PRId64
                " evaluations (the radius is too small or the contact too soft)\n",
                w->overlapping_cores);
    fprintf(f, "state hash         %016" PRIx64 "\n", fl_state_hash(w));
}
