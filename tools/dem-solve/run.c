/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <errno.h>
#include <string.h>
#include <time.h>
#include <unistd.h>
#include "base/stream.h"
#include "out/frames.h"
#include "out/tables.h"
#include "run.h"
#include "step/interact.h"
#include "step/step.h"

double run_clock(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

int32_t run_partner(const fl_world *w, int32_t j)
{
    if (j < w->n) return w->id[j];
    const int32_t part = w->structure.piece[j - w->n].part;
    return part >= 0 ? -1 - part : -1 - w->parts - (j - w->n - w->pieces);
}

void run_step_size(struct run *r)
{
    const double safety = r->scene->run.safety, every = r->scene->output.loads_every;
    const double automatic = fl_world_dt(r->w, &r->step_body);
    double dt = r->scene->run.dt;
    r->limit = automatic / safety;
    if (dt <= 0.0) {
        dt = fmin(automatic, fmin(every, r->scene->run.duration));
        dt = every / ceil(every / dt * (1.0 - 1e-12));
    }
    r->w->dt = dt;
    r->steps = (int64_t)ceil(r->scene->run.duration / dt * (1.0 - 1e-12));
}

/* --- outputs that come at an interval
 * ------------------------------------------------------------------------ */

/* Row k is due at the first step at or after k every. */
typedef struct {
    double every;
    int64_t k, due;
} timer;

static void next(timer *t, double dt)
{
    t->k++;
    t->due = (int64_t)ceil((double)t->k * t->every / dt * (1.0 - 1e-12));
}

static timer timer_of(double every, double dt, int from_zero)
{
    timer t = {every, 0, 0};
    if (!from_zero) next(&t, dt);
    return t;
}

typedef struct {
    fl_out loads, state, energy, contacts, frames;
    timer at_loads, at_state, at_energy, at_contacts, at_frames, at_ice;
    int32_t frame_file; /* number of the one that is open */
    double last_row;    /* [s] */
} outputs;

static int open_table(fl_out *out, const char *path, fl_err *err)
{
    return path[0] ? fl_out_open(out, path, 0, err) : 0;
}

/* File k of the frames: the name itself, or NAME.k when there are several. */
static int open_frames(struct run *r, outputs *u, fl_err *err)
{
    char path[FL_SCENE_PATH + 16];
    const fl_scene_output *s = &r->scene->output;
    if (!s->frames[0]) return 0;
    if (s->files > 1) snprintf(path, sizeof path, "%s.%d", s->frames, u->frame_file);
    else snprintf(path, sizeof path, "%s", s->frames);
    if (fl_out_open(&u->frames, path, 0, err)) return -1;
    fl_frames_header(u->frames.f, r->history, r->by, &r->w->b, r->w->id, r->w->q0, r->surface);
    return 0;
}

static int open_outputs(struct run *r, outputs *u, fl_err *err)
{
    const fl_scene_output *s = &r->scene->output;
    const double dt = r->w->dt;
    if (fl_out_open(&u->loads, r->o->out, r->o->gzip, err) || open_table(&u->state, s->state, err) ||
        open_table(&u->energy, s->energy, err) || open_table(&u->contacts, s->contacts, err) ||
        open_frames(r, u, err))
        return -1;
    fl_loads_header(u->loads.f, r->history, r->by);
    if (u->state.f) fl_state_header(u->state.f, r->history, r->by);
    if (u->energy.f) fl_rows_header(u->energy.f, "energy", r->history, r->by, FL_ENERGY_COLUMNS);
    if (u->contacts.f) fl_contacts_header(u->contacts.f, r->history, r->by);
    u->at_loads = timer_of(s->loads_every, dt, 0);
    u->at_state = timer_of(s->state_every, dt, 1);
    u->at_energy = timer_of(s->energy_every, dt, 1);
    u->at_contacts = timer_of(s->contacts_every, dt, 1);
    u->at_frames = timer_of(s->frames_every, dt, 1);
    u->at_ice = timer_of(s->ice_every, dt, 1);
    return 0;
}

static int write_loads(struct run *r, outputs *u, double t, fl_err *err)
{
    fl_world *w = r->w;
    const double length = t - u->last_row;
    for (int32_t p = 0; p < w->parts; p++) {
        int32_t touching = 0;
        for (int32_t k = 0; k < w->pieces; k++) {
            const int32_t j = w->n + k;
            if (w->structure.piece[k].part != p) continue;
            for (int64_t c = w->inc_first[j]; c < w->inc_first[j + 1]; c++)
                touching += w->pair[w->inc[c]].n > 0;
        }
        fl_loads_row(u->loads.f, t, r->surface->part[p].name, v3_scale(1.0 / length, w->part_impulse[p]),
                     v3_scale(1.0 / length, w->part_moment[p]), w->part_peak[p], touching);
        w->part_impulse[p] = w->part_moment[p] = v3(0, 0, 0);
        w->part_peak[p] = 0.0;
    }
    u->last_row = t;
    if (fflush(u->loads.f) == 0 && !ferror(u->loads.f)) return 0;
    return fl_fail(err, FL_SYSTEM, "%s: %s", u->loads.path ? u->loads.path : "<stdout>", strerror(errno));
}

static void write_contacts(struct run *r, outputs *u, double t)
{
    fl_world *w = r->w;
    for (int32_t c = 0; c < w->n_pair; c++) {
        const fl_pair *p = &w->pair[c];
        fl_contact k;
        if (p->n == 0 || !fl_interact_probe(w, p->i, p->j, 0.0, &k)) continue;
        const double normal = v3_dot(p->f, k.n);
        fl_contacts_row(u->contacts.f, t, w->id[p->i], run_partner(w, p->j), &k, normal,
                        v3_madd(p->f, -normal, k.n));
    }
}

static void write_energy(struct run *r, outputs *u, double t)
{
    const fl_ledger *g = &r->w->ledger;
    fl_step_ledger(r->w);
    const double row[] = {
        t,       g->kinetic, g->gravity,   g->elastic, g->hydrostatic, g->friction_now, g->damping_now,
        g->drag, g->wind,    g->drive_now, g->residual};
    fl_rows_row(u->energy.f, (int)(sizeof row / sizeof *row), row);
}

static int write_frames(struct run *r, outputs *u, double t, fl_err *err)
{
    const fl_scene_output *s = &r->scene->output;
    const int64_t step = r->w->step;
    const int ice = step >= u->at_ice.due;
    const int32_t file =
        s->files > 1 ? (int32_t)fmin(s->files - 1, floor(t / s->until * s->files * (1 + 1e-12))) : 0;
    if (t > s->until * (1.0 + 1e-12)) return 0;
    if (file != u->frame_file) {
        if (fl_out_close(&u->frames, err)) return -1;
        u->frame_file = file;
        if (open_frames(r, u, err)) return -1;
    }
    fl_frames_frame(u->frames.f, t, &r->w->b, r->w->id, r->w->q0, v3_scale(t, r->scene->structure.velocity),
                    ice);
    if (ice) next(&u->at_ice, r->w->dt);
    return 0;
}

/* What is due at this step; at the end the last interval of the loads may be shorter than the others. */
static int write_due(struct run *r, outputs *u, fl_err *err)
{
    const fl_world *w = r->w;
    const double t = (double)w->step * w->dt;
    if (w->step > 0 && (w->step >= u->at_loads.due || (w->step == r->steps && t > u->last_row))) {
        if (write_loads(r, u, t, err)) return -1;
        next(&u->at_loads, w->dt);
    }
    if (u->state.f && w->step >= u->at_state.due) {
        fl_state_rows(u->state.f, t, &w->b, w->id, w->q0);
        next(&u->at_state, w->dt);
    }
    if (u->energy.f && w->step >= u->at_energy.due) {
        write_energy(r, u, t);
        next(&u->at_energy, w->dt);
    }
    if (u->contacts.f && w->step >= u->at_contacts.due) {
        write_contacts(r, u, t);
        next(&u->at_contacts, w->dt);
    }
    if (u->frames.f && w->step >= u->at_frames.due) {
        if (write_frames(r, u, t, err)) return -1;
        next(&u->at_frames, w->dt);
    }
    return 0;
}

static int close_outputs(outputs *u, fl_err *err)
{
    fl_out *all[] = {&u->loads, &u->state, &u->energy, &u->contacts, &u->frames};
    int rc = 0;
    for (int k = 0; k < 5; k++) rc |= fl_out_close(all[k], err);
    return rc;
}

static void abort_outputs(outputs *u)
{
    fl_out_abort(&u->loads), fl_out_abort(&u->state), fl_out_abort(&u->energy);
    fl_out_abort(&u->contacts), fl_out_abort(&u->frames);
}

static void progress(const struct run *r, double begun, int last)
{
    const double t = (double)r->w->step * r->w->dt, wall = run_clock() - begun, end = r->scene->run.duration;
    const double left = t > 0.0 ? wall / t * (end - t) : 0.0;
    fprintf(stderr, "\r%8.2f s of %g s   %6.2f x real time   %5.0f s left ", t, end,
            wall > 0.0 ? t / wall : 0.0, left);
    if (last) fputc('\n', stderr);
    fflush(stderr);
}

/* Bodies that stand in one another at the start are pushed apart, with loads that belong to no case. A run
 * may take hours: this is said before it. */
static void warn_overlaps(const struct run *r)
{
    const fl_world *w = r->w;
    int32_t found = 0, first = -1;
    for (int32_t c = 0; c < w->n_pair; c++) {
        if (!w->pair[c].n || !w->pair[c].deep) continue;
        if (!found++) first = c;
    }
    if (!found || r->o->quiet) return;
    fprintf(stderr, "dem-solve: warning: %d %s at the start, first ", found,
            found == 1 ? "pair overlaps by more than its radii" : "pairs overlap by more than their radii");
    fprintf(stderr, "body %d and %d; they will be pushed apart\n", w->id[w->pair[first].i],
            run_partner(w, w->pair[first].j));
}

int run_scene(struct run *r, fl_err *err)
{
    outputs u = {0};
    fl_world *w = r->w;
    const int show = r->o->verbose || (!r->o->quiet && isatty(STDERR_FILENO));
    double begun, shown;
    int rc = -1;
    if (open_outputs(r, &u, err)) {
        abort_outputs(&u);
        return -1;
    }
    begun = shown = run_clock();
    if (fl_step_start(w, err)) goto done;
    warn_overlaps(r);
    if (write_due(r, &u, err)) goto done;
    while (w->step < r->steps) {
        if (fl_step(w, err) || write_due(r, &u, err)) goto done;
        if (show && w->step % 64 == 0) {
            const double now = run_clock();
            if (now - shown >= 0.5) progress(r, begun, 0), shown = now;
        }
    }
    rc = 0;
done:
    r->wall = run_clock() - begun;
    if (show) progress(r, begun, 1);
    fl_step_ledger(w);
    /* Also after a failure of the run: the rows until then are good and keep their names. */
    return close_outputs(&u, err) ? -1 : rc;
}
