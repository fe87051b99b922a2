/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <inttypes.h>
#include "run.h"
#include "sim/energy_balance.h"
#include "step/critical.h"
#include "step/frozen.h"
#include "step/sleep.h"
#include "step/step.h"
#include "step/traffic.h"

/* What the run comes to as a whole, by the one beside it. */
static void whole_of(const fl_budget *g, FILE *f)
{
    double apart;
    const double off = fl_budget_whole(g, &apart);
    const fl_beside *s = &g->beside;
    if (!(s->ratio > 0.0) || g->latest < 0) return;
    fprintf(f,
            "                   as a whole %.2g, for beside it a run of %.3g times the step differs by %.2g",
            off, s->ratio, apart);
    if (s->ended) fprintf(f, " until %.4g s, where that step is above the critical one", s->until);
    if (s->since >= 0.0) fprintf(f, "; more than three times what was asked for from %.4g s on", s->since);
    putc('\n', f);
}

/* What was asked for, what was found, and what finding it cost. */
static void budget_of(const struct run *r, FILE *f)
{
    static const char *const OF[] = {"impulse", "peak", "fx", "fy", "fz", "mx", "my", "mz"};
    const fl_budget *g = r->budget;
    const double far = fl_budget_horizon(g), window = g->every * g->rows;
    const int32_t last = g->latest;
    fprintf(f, "error budget       %.3g of the %s: ", g->goal, OF[g->of]);
    if (last < 0) fprintf(f, "nothing was touched, the step is the largest there may be\n");
    else
        fprintf(f, "%.2g by estimate, of order %.2g; %" PRId64 " looks, steps of %.3g s to %.3g s\n",
                fl_budget_estimate(g, r->w->dt), g->window[last].order, g->looks, g->shortest, g->longest);
    fprintf(f, "                   found by %" PRId64 " steps besides, %.3g of all, in %.3g s\n", g->spent,
            g->spent > 0 ? (double)g->spent / (double)(g->spent + r->w->step) : 0.0, r->look_wall);
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
    return w->frozen.n && fl_frozen_counted(w).state[FL_BOND_WHOLE] < w->frozen.n;
}

static void bonds_of(const fl_world *w, FILE *f)
{
    const fl_frozen_count n = fl_frozen_counted(w);
    const int32_t open = n.state[FL_BOND_BROKEN] + n.state[FL_BOND_ENDED];
    fprintf(f, "bonds              %d whole, %d damaged, %d broken of %d: %.4g m2 of crack, %.4g J\n",
            n.state[FL_BOND_WHOLE], n.state[FL_BOND_HURT], open, w->frozen.n, n.area, w->ledger.fracture);
}

void report_bonds(const fl_world *w, FILE *f)
{
    const fl_frozen_count n = fl_frozen_counted(w);
    const fl_scene_bond *s = &w->scene->bond;
    if (n.coarse == 0) return;
    fprintf(f,
            "dem-solve: note: %d of %d bonds store more than the %.4g J/m2 of bond.energy at their strength: "
            "the longest is %.3g m, and the limit is %.3g m; a crack takes %.4g J/m2 in the mean%s\n",
            n.coarse, w->frozen.n, s->energy, n.longest, n.limit, n.energy,
            s->softening == FL_SOFTENING_STRETCH ? "" : " (see bond.softening)");
}

/* A run that failed may leave no balance, and floes at rest have no throughput to hold rounding against. */
static void energy_of(const fl_world *w, FILE *f)
{
    const fl_ledger *g = &w->ledger;
    const double off = fl_step_off(w);
    if (!isfinite(g->residual) || !isfinite(g->throughput))
        fprintf(f, "energy residual    unknown: the energies are not finite numbers any more\n");
    else if (!isfinite(off)) fprintf(f, "energy residual    unknown: nothing has gone through yet\n");
    else if (off == 0.0 && g->residual != 0.0)
        fprintf(f, "energy residual    0 but for rounding (%.3g J; %.3g J are stored, throughput %.3g J)\n",
                g->residual, fl_step_stored(w), g->throughput);
    else
        fprintf(f, "energy residual    %.2g of the throughput (%.3g J of %.3g J)\n", off, g->residual,
                g->throughput);
}

static void momentum_of(const fl_world *w, FILE *f)
{
    const double off = v3_norm(w->imbalance);
    if (isfinite(off) && isfinite(w->impulse_size))
        fprintf(f, "momentum residual  %.2g of the contact impulses (%.3g N s of %.3g N s)\n",
                w->impulse_size > 0.0 ? off / w->impulse_size : 0.0, off, w->impulse_size);
    else fprintf(f, "momentum residual  unknown: the impulses are not finite numbers any more\n");
}

/* Speed is never printed without its error: the two blocks belong together. */
void report_write(const struct run *r, FILE *f)
{
    const fl_world *w = r->w;
    const double steps = (double)w->step, made = steps - (double)r->begun,
                 simulated = fl_world_time(w) - r->begun_time, touches = (double)w->touching_steps,
                 since = touches - (double)r->begun_touching;
    char name[64];
    fprintf(f, "steps              %" PRId64 " of %.4g s\n", w->step, w->dt);
    fprintf(f, "set by             %s\n", r->step_by);
    if (isfinite(w->dt_critical))
        fprintf(f, "step over critical %.3g (smallest 2/omega seen: %.4g s, %s)\n", w->dt / w->dt_critical,
                w->dt_critical, run_body(w, w->critical_body, name));
    else fprintf(f, "step over critical no contact was made\n");
    if (r->budget) budget_of(r, f);
    else if (isfinite(w->dt_touching))
        fprintf(f,
                "error of the step  about %.2g of a peak, %.2g of the impulse at the most: by the step over "
                "critical of what touches and the restitution, not measured (run.error does)%s\n",
                fl_world_peak_off(w), fl_world_impulse_off(w),
                bonds_failed(w) ? "; not of when bonds fail" : "");
    fprintf(f, "speed              %.4g s simulated in %.4g s: %.3g x real time, %.3g thread%s", simulated,
            r->wall, r->wall > 0.0 ? simulated / r->wall : 0.0, fl_team_mean(&w->team),
            fl_team_mean(&w->team) == 1.0 ? "" : "s");
    if (w->team.open) fprintf(f, " of %d", w->threads);
    putc('\n', f);
    if (r->moved > 0)
        fprintf(f,
                "                   %.0f ns a body-step, %.0f ns a contact-step (%.3g contacts at a time, "
                "%" PRId64 " searches)\n",
                1e9 * r->wall / (double)r->moved, since > 0.0 ? 1e9 * r->wall / since : 0.0, since / made,
                w->searches);
    fprintf(f, "processor          %.4g s, of all threads and all that was done\n", r->busy);
    if (w->sleep.nap && w->step > 0 && w->n) {
        const fl_sleep_count c = fl_sleep_counted(w);
        const double all = steps * w->n;
        fprintf(f,
                "asleep             %.3g of all body-steps coasting, %.3g at a time, %.3g resting; off by "
                "%.2g of "
                "the radius at most (run.sleep %.3g), and %.2g in all\n",
                (double)c.coasted / all, c.naps ? (double)c.coasted / (double)c.naps : 0.0,
                (double)c.rested / all, c.off, w->sleep.tol, c.summed);
    }
    if (w->told && touches > 0.0) {
        const fl_surrogate_count c = fl_surrogate_sum(w->told, w->threads);
        fprintf(f,
                "surrogate          %.3g of all contact-steps without a look; the force of looks off by more "
                "than "
                "told in %.2g of them, by %.2g of the force at most\n",
                (double)c.told / touches, c.looked ? (double)c.off / (double)c.looked : 0.0, c.worst);
    }
    if (r->saves)
        fprintf(f, "checkpoints        %" PRId64 " in %.3g s besides, the last at t = %.6g s\n", r->saves,
                r->save_wall, fl_world_time(w));
    energy_of(w, f);
    momentum_of(w, f);
    if (w->frozen.n) bonds_of(w, f);
    if (w->traffic.away) {
        const fl_traffic *t = &w->traffic;
        fprintf(f, "floes out          %" PRId64 " (%.4g kg)\n", t->left, t->mass_left);
        if (t->feed) {
            fprintf(f, "floes in           %" PRId64 " (%.4g kg), %.4g kg/s", t->entered, t->mass_entered,
                    fl_world_time(w) > 0.0 ? t->mass_entered / fl_world_time(w) : 0.0);
            if (t->waited) fprintf(f, "; %" PRId64 " found their place taken", t->waited);
            if (t->missed) fprintf(f, ", %" PRId64 " never got one", t->missed);
            fputc('\n', f);
        }
        fprintf(f, "floes there        %d of room for %d\n", fl_traffic_there(w), w->n);
    }
    if (w->worst_i >= 0)
        fprintf(f, "largest overlap    %.3g of the radii (body %d and %d, t = %.6g s)\n", w->worst_overlap,
                w->worst_i, w->worst_j, w->worst_time);
    else fprintf(f, "largest overlap    0 of the radii\n");
    if (w->half_steps)
        fprintf(f, "past half          %" PRId64 " steps, first body %d and %d at t = %.6g s\n",
                w->half_steps, w->half_i, w->half_j, w->half_time);
    if (w->deep_pairs)
        fprintf(f,
                "core overlaps      %" PRId64
                " evaluations (the radius is too small or the contact too soft)\n",
                w->deep_pairs);
    fprintf(f, "state hash         %016" PRIx64 "\n", fl_step_hash(w));
}
