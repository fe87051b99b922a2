/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <signal.h>
#include <string.h>
#include <time.h>
#include <unistd.h>
#include "base/number_text.h"
#include "out/frames.h"
#include "out/tables.h"
#include "run.h"
#include "save.h"
#include "sim/energy_balance.h"
#include "sphere/contact_list.h"
#include "sim/critical_step.h"
#include "contact/bond_list.h"
#include "contact/panel_load.h"
#include "sim/moving_structure.h"
#include "sim/sleep.h"
#include "contact/pair_geometry.h"
#include "sim/step.h"
#include "sim/inflow.h"

double run_clock(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

double run_processor(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

const char *run_body(const fl_world *w, int32_t k, char name[64])
{
    if (k >= w->b.total) snprintf(name, 64, "%s", fl_mover_name(w, k - w->b.total));
    else if (k >= 0) snprintf(name, 64, "body %d", w->id[k]);
    else snprintf(name, 64, "a floe that has left");
    return name;
}

/* So many steps no run has, see run_countable(). */
#define NEVER (INT64_C(1) << 60)

/* What numbers that are to be the same differ by, over either. */
#define ROUNDING 1e-12

/* The first step at or after t: a row is due at the step that differs from its time by rounding alone. */
static int64_t step_at(const fl_world *w, double t)
{
    const double n = ceil((t - w->t0 - ROUNDING * t) / w->dt);
    return n < (double)NEVER ? w->step0 + (int64_t)n : NEVER;
}

void run_steps(struct run *r) { r->steps = step_at(r->w, r->scene->run.duration); }

int run_countable(const struct run *r, fl_err *err)
{
    const double most = 9007199254740992.0,
                 n = r->scene->run.duration / r->w->dt; /* doubles tell those apart */
    if (n < most) return 0;
    return fl_scene_fail(r->scene, "run.duration", err,
                         "run.duration of %g s in steps of %g s: %.3g steps, at most %.3g are expected",
                         r->scene->run.duration, r->w->dt, n, most);
}

/* Half of the critical step; or of what damping leaves, or 0.8 of it; or less where many contacts are damped
 * at once. */
static void damped_origin(char *to, size_t n, double share, double left, double limit)
{
    const double part = share / left;
    if (fabs(share - 0.5) < 1e-3)
        snprintf(to, n, "half of the critical %.4g s, and no more without run.dt", limit);
    else if (fabs(part - 0.5) < 1e-3 || fabs(part - 0.8) < 1e-3)
        snprintf(to, n, "damping, %.2g of the %.3g that it leaves of the critical %.4g s", part, left, limit);
    else snprintf(to, n, "damping by many contacts, %.3g of the critical %.4g s", share, limit);
}

/* What the step comes from, for --plan and the report alike. */
static void step_origin(struct run *r, double automatic)
{
    const fl_scene_run *s = &r->scene->run;
    const double left = fl_damped_share(r->w), every = r->scene->output.loads_every;
    char name[64], *to = r->step_by;
    const size_t n = sizeof r->step_by;
    if (r->budget)
        snprintf(to, n, "run.error, up to %.3g of the critical %.4g s",
                 r->budget->lateral_share * automatic / r->limit, r->limit);
    else if (s->dt > 0.0) snprintf(to, n, "run.dt");
    else if (automatic >= fmin(every, s->duration))
        snprintf(to, n, every <= s->duration ? "output.loads_every" : "run.duration");
    else if (r->w->bonds.n &&
             automatic / r->limit > fl_predict_step_limit(r->w).contact_share * (1.0 + ROUNDING))
        snprintf(to, n, "bonds and contacts, %.3g of the critical %.4g s", automatic / r->limit, r->limit);
    else if (automatic / r->limit < s->safety * (1.0 - ROUNDING))
        damped_origin(to, n, automatic / r->limit, left, r->limit);
    else snprintf(to, n, "run.safety, %.3g of the critical %.4g s", s->safety, r->limit);
    if (s->dt > 0.0 || r->step_body < 0 || automatic >= fmin(every, s->duration)) return;
    const size_t used = strlen(to);
    snprintf(to + used, n - used, " of %s", run_body(r->w, r->step_body, name));
}

void run_step_size(struct run *r)
{
    const double every = r->scene->output.loads_every;
    const double automatic = fl_automatic_step(r->w, &r->step_body);
    double dt = r->scene->run.dt;
    r->limit = fl_critical_step(r->w);
    step_origin(r, automatic);
    if (r->budget) {
        dt = fl_error_budget_first_step(r->budget);
    } else if (dt <= 0.0) {
        dt = fmin(automatic, fmin(every, r->scene->run.duration));
        dt = every / ceil(every / dt * (1.0 - 1e-12));
    }
    r->w->dt = dt;
    run_steps(r);
}

static double time_of(const struct run *r) { return fl_world_time(r->w); }

/* The time now as rows tell it: that for which they were due, 0.3 and not 0.1 + 0.1 + 0.1, where the step is
 * there but for rounding. */
static double told_time(const struct run *r, double due)
{
    const double t = time_of(r);
    char digits[32];
    double x = t;
    if (!(fabs(t - due) <= ROUNDING * due)) return t;
    snprintf(digits, sizeof digits, "%.15g", due);
    return fl_number_f64(digits, &x) ? t : x;
}

/* --- outputs that come at an interval ---------------------------------------------------------- */

void run_timer(struct timer *t, int64_t k, const fl_world *w)
{
    t->k = k;
    t->due = step_at(w, (double)k * t->every);
}

static void next(struct outputs *u, int k, const fl_world *w) { run_timer(&u->at[k], u->at[k].k + 1, w); }

void run_frames_path(const struct run *r, const struct outputs *u, char path[FL_SCENE_PATH + 16])
{
    const fl_scene_output *s = &r->scene->output;
    if (s->files > 1 && s->frames[0]) snprintf(path, FL_SCENE_PATH + 16, "%s.%d", s->frames, u->frame_file);
    else snprintf(path, FL_SCENE_PATH + 16, "%s", s->frames);
}

/* The bodies as the tables tell them. */
static fl_poses poses(const struct run *r)
{
    return (fl_poses){&r->w->b, r->w->id, r->w->q0, r->at, &r->w->cell, r->w->inflow.absent};
}

static void energy_header(const struct run *r, FILE *f)
{
    char columns[400];
    snprintf(columns, sizeof columns, "%s%s%s%s", FL_ENERGY_COLUMNS,
             fl_structure_moves_freely(r->w) ? FL_ENERGY_MOVING : "", r->w->sea.waves ? FL_ENERGY_WAVES : "",
             r->w->bonds.n ? FL_ENERGY_BONDS : "");
    fl_values_header(f, "energy", r->history, r->by, columns);
}

void run_header(struct run *r, struct outputs *u, int k)
{
    const fl_poses now = poses(r);
    FILE *f = u->table[k].f;
    switch (k) {
    case AT_LOADS: fl_loads_header(f, r->history, r->by, u->last_row, fl_motion_columns(r->w)); break;
    case AT_STATE: fl_state_header(f, r->history, r->by); break;
    case AT_ENERGY: energy_header(r, f); break;
    case AT_CONTACTS: fl_contacts_header(f, r->history, r->by); break;
    case AT_HASH: fl_hash_header(f, r->history, r->by); break;
    case AT_PANELS: fl_panels_header(f, r->history, r->by, u->last_row); break;
    case AT_EVENTS: fl_contacts_header(f, r->history, r->by); break;
    case AT_BONDS: fl_bonds_header(f, r->history, r->by); break;
    default: fl_frames_header(f, r->history, r->by, &now, r->surface);
    }
}

static int open_table(struct run *r, struct outputs *u, int k, const char *path, fl_err *err)
{
    return path[0] ? fl_out_open(&u->table[k], path, k == AT_LOADS ? r->gzip : 0, err) : 0;
}

static int open_outputs(struct run *r, struct outputs *u, fl_err *err)
{
    const fl_scene_output *s = &r->scene->output;
    const double every[TIMERS] = {s->loads_every, s->state_every,  s->energy_every,    s->contacts_every,
                                  s->hash_every,  s->frames_every, s->loads_every,     s->loads_every,
                                  s->bonds_every, s->ice_every,    s->checkpoint_every};
    char frames[FL_SCENE_PATH + 16];
    run_frames_path(r, u, frames);
    const char *const path[TABLES] = {r->out, s->state,  s->energy, s->contacts, s->hash,
                                      frames, s->panels, s->events, s->bonds};
    for (int k = 0; k < TABLES; k++)
        if (open_table(r, u, k, path[k], err)) return -1;
    for (int k = 0; k < TABLES; k++)
        if (u->table[k].f) run_header(r, u, k);
    for (int k = 0; k < TIMERS; k++) {
        u->at[k].every = every[k];
        run_timer(&u->at[k], k == AT_LOADS || k == AT_SAVE, r->w);
    }
    return 0;
}

/* From here on the tables hold rows, which are good without those that a full disk leaves no room for. */
static void keep_tables(struct outputs *u)
{
    for (int k = 0; k < TABLES; k++) u->table[k].keep_part = 1;
}

/* A table that has lost a row is not gone on with: the run ends. */
static int lost_row(struct outputs *u, fl_err *err)
{
    for (int k = 0; k < TABLES; k++)
        if (u->table[k].f && ferror(u->table[k].f)) return fl_out_flush(&u->table[k], err);
    return 0;
}

/* Triangles and cones by number within their part, where they are now. */
static void write_panels(struct run *r, FILE *f, double t, double length)
{
    fl_world *w = r->w;
    const fl_panel_loads *s = &w->panel_load;
    for (int32_t k = 0; k < s->panels; k++) {
        const fl_load_panel *p = &s->panel[k];
        char name[32];
        fl_vec3 x = p->centroid;
        if (!(p->area > 0.0)) continue; /* a triangle without one has no pressure */
        if (w->moving.movers.n && w->moving.mover_of_part[p->part] >= 0) x = fl_part_point(w, p->part, x);
        snprintf(name, sizeof name, ".%d", k - s->first[p->part] + 1);
        fl_panels_row(f, t, r->surface->part[p->part].name, name, x, p->area,
                      v3_scale(1.0 / length, s->impulse[k]));
    }
    fl_panels_end_interval(w);
}

static void write_events(struct run *r, FILE *f, double t, double length)
{
    fl_world *w = r->w;
    for (int32_t k = 0; k < w->panel_load.events; k++) {
        const fl_load_event *e = &w->panel_load.event[k];
        const fl_vec3 force = v3_scale(-1.0 / length, e->impulse); /* on the floe */
        fl_contact c = {.gap = -e->max_overlap, .n = v3_unit(e->normal_impulse)};
        if (e->impulse_sum > 0.0) {
            c.p = v3_scale(1.0 / e->impulse_sum, e->impulse_point);
            c.area = e->impulse_area / e->impulse_sum;
        }
        if (!(v3_norm2(c.n) > 0.5)) c.n = v3_unit(force);
        if (!(v3_norm2(c.n) > 0.5)) continue; /* no force at all */
        const double normal = v3_dot(force, c.n);
        fl_contacts_row(f, t, e->id, -1 - e->part, &c, normal, v3_madd(force, -normal, c.n));
    }
    fl_events_end_interval(w);
}

static int write_loads(struct run *r, struct outputs *u, double t, fl_err *err)
{
    fl_world *w = r->w;
    fl_out *loads = &u->table[AT_LOADS];
    const double length = t - u->last_row;
    const enum fl_loads_motion_kind moving = fl_motion_columns(w);
    for (int32_t p = 0; p < w->parts; p++) {
        fl_loads_motion motion;
        int32_t touching = 0;
        if (moving) fl_part_motion(w, p, t, &motion);
        for (int32_t k = 0; k < w->pieces; k++) {
            const int32_t j = w->n + k;
            if (w->structure.piece[k].part != p) continue;
            for (int64_t c = w->first_pair_of_body[j]; c < w->first_pair_of_body[j + 1]; c++)
                touching += w->pair[w->pairs_of_body[c]].touching > 0;
        }
        fl_loads_row(loads->f, t, r->surface->part[p].name, v3_scale(1.0 / length, w->part_impulse[p]),
                     v3_scale(1.0 / length, w->part_moment[p]), w->part_peak[p], touching, moving, &motion);
        w->part_impulse[p] = w->part_moment[p] = v3(0, 0, 0);
        w->part_peak[p] = 0.0;
    }
    warn_at_row(r, t);
    if (u->table[AT_PANELS].f) write_panels(r, u->table[AT_PANELS].f, t, length);
    if (u->table[AT_EVENTS].f) write_events(r, u->table[AT_EVENTS].f, t, length);
    u->last_row = t;
    return fl_out_flush(loads, err);
}

static void write_contacts(struct run *r, struct outputs *u, double t)
{
    fl_world *w = r->w;
    fl_pair_iterator at = {.w = w};
    for (const fl_pair *p; (p = fl_pair_next(&at)) != NULL;) {
        fl_contact k;
        if (p->touching == 0 || !fl_pair_probe(w, p, 0.0, &k)) continue;
        const double normal = v3_dot(p->force, k.n);
        fl_contacts_row(u->table[AT_CONTACTS].f, t, w->id[p->i], fl_world_id(w, p->j), &k, normal,
                        v3_madd(p->force, -normal, k.n));
    }
}

static void write_bonds(struct run *r, struct outputs *u, double t)
{
    static const char *const STATE[] = {"whole", "damaged", "broken", "ended"};
    const fl_world *w = r->w;
    for (int32_t k = 0; k < w->bonds.n; k++) {
        const fl_bond *c = &w->bonds.bond[k];
        const fl_bond_load q = fl_bond_list_load(w, k);
        if (fl_body_absent(w, c->i) || fl_body_absent(w, c->j)) continue;
        fl_bonds_row(u->table[AT_BONDS].f, t,
                     &(fl_bonds_record){w->id[c->i], w->id[c->j], STATE[c->state], fl_bond_mean_damage(c),
                                        q.tension, q.shear, q.moment, c->area, q.x});
    }
}

static void write_energy(struct run *r, struct outputs *u, double t)
{
    const fl_ledger *g = &r->w->ledger;
    fl_energy_update(r->w);
    double row[18] = {
        t,        g->kinetic, g->gravity,   g->elastic, g->hydrostatic, g->friction_now, g->damping_now,
        g->drag,  g->wind,    g->drive_now, g->carried, g->residual,    g->structure,    g->spring,
        g->damper};
    int all = fl_structure_moves_freely(r->w) ? 15 : 12;
    if (r->w->sea.waves) row[all++] = g->waves;
    if (r->w->bonds.n) {
        row[all++] = g->bond;
        row[all++] = g->fracture;
    }
    fl_values_row(u->table[AT_ENERGY].f, all, row);
}

/* A structure that as a whole goes one way is told by that way, any other part by part. */
static int one_way(const fl_world *w)
{
    return w->moving.movers.n == 1 && w->scene->n_part == 0 && fl_motion_columns(w) == FL_LOADS_TRANSLATION;
}

static fl_vec3 gone_one_way(const fl_world *w)
{
    if (!one_way(w)) return v3(0, 0, 0);
    return v3_sub(w->moving.movers.b.x[0], w->moving.movers.motion[0].reference);
}

static void write_moved(const struct run *r, FILE *f)
{
    const fl_rigid_motions *v = &r->w->moving.movers;
    if (v->n == 0 || one_way(r->w)) return;
    for (int32_t p = 0; p < r->w->parts; p++) {
        const int32_t m = r->w->moving.mover_of_part[p];
        if (m < 0) continue;
        fl_frames_part_pose(f, r->surface->part[p].id,
                            v3_sub(v->b.x[m], m3_mul(fl_body_axes(&v->b, m), v->motion[m].reference)),
                            v->b.q[m]);
    }
}

/* The shapes of floes that have come in since the last frame with ice. */
static void write_newcomers(const struct run *r, const struct outputs *u, const fl_poses *now)
{
    const fl_inflow_state *t = &r->w->inflow;
    struct timer last = u->at[AT_ICE];
    if (!t->absent || last.k == 0) return; /* the first frame is that of the header */
    run_timer(&last, last.k - 1, r->w);
    for (int32_t i = 0; i < r->w->n; i++)
        if (!t->absent[i] && t->entry_step[i] > 0 && t->entry_step[i] >= last.due)
            fl_frames_shape(u->table[AT_FRAMES].f, now, i);
}

static int write_frames(struct run *r, struct outputs *u, double t, fl_err *err)
{
    const fl_scene_output *s = &r->scene->output;
    const int ice = r->w->step >= u->at[AT_ICE].due;
    const fl_poses now = poses(r);
    const int32_t file =
        s->files > 1 ? (int32_t)fmin(s->files - 1, floor(t / s->until * s->files * (1 + 1e-12))) : 0;
    if (t > s->until * (1.0 + 1e-12)) return 0;
    if (file != u->frame_file) {
        char path[FL_SCENE_PATH + 16];
        if (fl_out_close(&u->table[AT_FRAMES], err)) return -1;
        u->frame_file = file;
        run_frames_path(r, u, path);
        if (open_table(r, u, AT_FRAMES, path, err)) return -1;
        run_header(r, u, AT_FRAMES);
        keep_tables(u);
    }
    if (ice) write_newcomers(r, u, &now);
    fl_frames_frame(u->table[AT_FRAMES].f, t, &now, gone_one_way(r->w), ice);
    write_moved(r, u->table[AT_FRAMES].f);
    if (ice) next(u, AT_ICE, r->w);
    return 0;
}

/* What is due at this step. */
static int write_due(struct run *r, struct outputs *u, fl_err *err)
{
    const fl_poses now = poses(r);
    int asleep = 1; /* until a table asks for more than loads and contacts */
    for (int k = 0; k < TABLES; k++) {
        if (!u->table[k].f || r->w->step < u->at[k].due || k == AT_PANELS || k == AT_EVENTS) continue;
        const double t = told_time(r, (double)u->at[k].k * u->at[k].every);
        if (asleep && k != AT_LOADS && k != AT_CONTACTS) {
            fl_sleep_advance_to_now(r->w);
            asleep = 0;
        }
        switch (k) {
        case AT_LOADS:
            if (write_loads(r, u, t, err)) return -1;
            break;
        case AT_STATE: fl_state_rows(u->table[k].f, t, &now); break;
        case AT_ENERGY: write_energy(r, u, t); break;
        case AT_CONTACTS: write_contacts(r, u, t); break;
        case AT_BONDS: write_bonds(r, u, t); break;
        case AT_HASH: fl_hash_row(u->table[k].f, t, fl_state_hash(r->w)); break;
        default:
            if (write_frames(r, u, t, err)) return -1;
        }
        if (lost_row(u, err)) return -1;
        next(u, k, r->w);
    }
    if (!asleep) fl_sleep_restore(r->w);
    return 0;
}

static int close_outputs(struct outputs *u, fl_err *err)
{
    int rc = 0;
    for (int k = 0; k < TABLES; k++) rc |= fl_out_close(&u->table[k], err);
    return rc;
}

/* --- signals ----------------------------------------------------------------------------------- */

static volatile sig_atomic_t told_to_stop, told_to_save, reader_gone;

static void on_signal(int number)
{
    if (number == SIGUSR1) told_to_save = 1;
    else if (number == SIGPIPE) reader_gone = 1;
    else told_to_stop = number;
}

/* SIGTERM, SIGINT and SIGHUP end the run after the step under way; a second one ends it at once.  A reader
 * that goes away does so as well, once a row for it has failed. */
static void listen_to_signals(const struct run *r)
{
    static const int STOP[] = {SIGTERM, SIGINT, SIGHUP};
    struct sigaction act = {.sa_handler = on_signal, .sa_flags = SA_RESTART}, was;
    if (r->scene->output.checkpoint[0]) sigaction(SIGUSR1, &act, NULL);
    if (sigaction(SIGPIPE, NULL, &was) == 0 && was.sa_handler != SIG_IGN) sigaction(SIGPIPE, &act, NULL);
    act.sa_flags |= (int)SA_RESETHAND;
    for (size_t k = 0; k < sizeof STOP / sizeof *STOP; k++)
        if (sigaction(STOP[k], NULL, &was) == 0 && was.sa_handler != SIG_IGN) sigaction(STOP[k], &act, NULL);
}

/* A checkpoint where the interval, a signal or the end of the run asks for one. */
static int save_due(struct run *r, struct outputs *u, int last, fl_err *err)
{
    if (!r->scene->output.checkpoint[0]) return 0;
    const int due = r->w->step >= u->at[AT_SAVE].due;
    if (!due && !told_to_save && !told_to_stop && !last) return 0;
    if (r->saves && r->saved_at == r->w->step) return 0;
    told_to_save = 0;
    while (r->w->step >= u->at[AT_SAVE].due) next(u, AT_SAVE, r->w);
    return save_write(r, u, err);
}

/* The step that fails may leave a state that is whole, when it only is too long for the contacts there are.
 */
static int whole_state(const fl_world *w)
{
    for (int32_t i = 0; i < w->n; i++) {
        const fl_vec3 all[] = {w->b.x[i], w->b.v[i], w->b.L[i], w->b.f[i], w->b.t[i]};
        for (int k = 0; k < 5; k++)
            if (!isfinite(all[k].x) || !isfinite(all[k].y) || !isfinite(all[k].z)) return 0;
    }
    return 1;
}

static void progress(const struct run *r, double begun, int last)
{
    const double t = time_of(r), wall = run_clock() - begun, end = r->scene->run.duration;
    const double left = t > 0.0 ? wall / t * (end - t) : 0.0;
    fprintf(stderr, "\r%8.2f s of %g s   %6.2f x real time   %5.0f s left ", t, end,
            wall > 0.0 ? t / wall : 0.0, left);
    if (last) fputc('\n', stderr);
    fflush(stderr);
}

/* At the end of a row of the loads the error budget may change the step, and with it when what is due. */
static int look_after_step(struct run *r, struct outputs *u, fl_err *err)
{
    const int64_t row = u->at[AT_LOADS].k - 1;
    const double dt = r->w->dt, begun = run_clock();
    if (!r->budget || step_at(r->w, (double)row * u->at[AT_LOADS].every) != r->w->step) return 0;
    if (fl_error_budget_update(r->budget, r->w, row, err)) return -1;
    if (r->w->dt != dt) {
        for (int k = 0; k < TIMERS; k++) run_timer(&u->at[k], u->at[k].k, r->w);
        run_steps(r);
    }
    r->look_wall += run_clock() - begun;
    return 0;
}

/* The run beside it comes after, before the row is told that this step ends. */
static int follow(struct run *r, fl_err *err)
{
    const double begun = run_clock();
    if (fl_error_budget_follow(r->budget, r->w, err)) return -1;
    r->look_wall += run_clock() - begun;
    return 0;
}

static int run_steps_of(struct run *r, struct outputs *u, int show, double begun, fl_err *err)
{
    fl_world *w = r->w;
    double shown = begun;
    r->going = 1;
    if (!r->saved) {
        const int bad = fl_step_start(w, err);
        if (!bad || err->code == FL_NUMERIC)
            warn_at_start(r); /* why a step may be too long for its contacts */
        if (bad) return -1;
        warn_at_row(r, 0.0);
        if (write_due(r, u, err)) return -1;
    }
    while (w->step < r->steps && !told_to_stop) {
        if (look_after_step(r, u, err)) return -1;
        if (told_to_stop) break; /* a look that was broken off is made again where the run goes on */
        r->moved += w->inflow.absent ? fl_floes_in_domain(w) : w->n;
        if (fl_step(w, err) || (r->budget && follow(r, err)) || write_due(r, u, err) ||
            save_due(r, u, 0, err))
            return -1;
        if (show && w->step % 64 == 0) {
            const double now = run_clock();
            if (now - shown >= 0.5) progress(r, begun, 0), shown = now;
        }
    }
    r->stopped = w->step < r->steps ? told_to_stop : 0;
    if (r->stopped) return save_due(r, u, 0, err); /* the signal may have come before the first step */
    /* The last interval of the loads may be shorter than the others, and the books are looked at.  A longer
     * run would do neither here, so what can be gone on from comes before. */
    if (save_due(r, u, 1, err) || fl_energy_check(w, err)) return -1;
    const double end = told_time(r, r->scene->run.duration);
    return end > u->last_row * (1.0 + ROUNDING) ? write_loads(r, u, end, err) : 0;
}

int run_scene(struct run *r, fl_err *err)
{
    struct outputs u = {0};
    const int show = r->o->verbose || (!r->o->quiet && isatty(STDERR_FILENO));
    if (r->saved ? save_restore(r, &u, err) : open_outputs(r, &u, err)) {
        for (int k = 0; k < TABLES; k++) fl_out_abort(&u.table[k]);
        return -1;
    }
    keep_tables(&u);
    listen_to_signals(r);
    if (r->budget) r->budget->stop = &told_to_stop;
    const double begun = run_clock(), busy = run_processor();
    const int rc = run_steps_of(r, &u, show, begun, err);
    if (rc && err->code == FL_NUMERIC && r->w->step > 0 && r->scene->output.checkpoint[0] &&
        whole_state(r->w)) {
        fl_err why = {0}; /* the failure of the run is what is told */
        save_write(r, &u, &why);
    }
    r->wall = run_clock() - begun - r->save_wall - r->look_wall;
    r->busy = run_processor() - busy;
    if (show) progress(r, begun, 1);
    fl_sleep_advance_to_now(r->w);
    fl_energy_update(r->w);
    warn_at_end(r, rc != 0);
    /* Also after a failure of the run: the rows until then are good and keep their names. */
    if (!close_outputs(&u, err) && !rc) return 0;
    if (!reader_gone || err->code != FL_SYSTEM) return -1;
    r->stopped = SIGPIPE;
    *err = (fl_err){0};
    return 0;
}
