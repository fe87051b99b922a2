/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "outputs.h"
#include <stddef.h>
#include <stdlib.h>
#include "base/number_text.h"
#include "out/frames.h"
#include "out/tables.h"
#include "scene/scene_print.h"
#include "sim/device_step.h"
#include "sim/energy_balance.h"
#include "sim/moving_structure.h"
#include "sim/sleep.h"
#include "step_choice.h"
#include "table_rows.h"
#include "warnings.h"

enum when {
    ALONE,      /* at its own interval */
    WITH_LOADS, /* with the rows of the loads, whose interval it has */
};

struct table {
    const char *name;
    size_t path, every; /* offsets in fl_scene_output */
    const fl_table_format *format;
    unsigned (*options)(const fl_world *w); /* columns that the table has; NULL: all */
    void (*rows)(struct run *r, FILE *f, double t, double interval);
    enum when when;
    int of_interval; /* rows are means over an interval: the header has its start */
    int needs_now;   /* sleeping bodies are advanced to the time of now first */
};

static unsigned motion_columns(const fl_world *w) { return loads_options(w); }

static unsigned joint_column(const fl_world *w) { return fl_world_joints(w) ? FL_BONDS_JOINTS : 0; }

#define PATH(key) offsetof(fl_scene_output, key)
#define NO_PATH ((size_t)-1)

/* The path of the loads is on the command line; frames have a format of their own. */
static const struct table TABLE[TABLES] = {
    [TABLE_LOADS] = {"loads", NO_PATH, PATH(loads_every), &fl_loads_table, motion_columns, write_loads, ALONE,
                     1, 0},
    [TABLE_STATE] = {"state", PATH(state), PATH(state_every), &fl_state_table, NULL, write_state, ALONE, 0,
                     1},
    [TABLE_ENERGY] = {"energy", PATH(energy), PATH(energy_every), &fl_energy_table, fl_energy_table_options,
                      write_energy, ALONE, 0, 1},
    [TABLE_CONTACTS] = {"contacts", PATH(contacts), PATH(contacts_every), &fl_contacts_table, NULL,
                        write_contacts, ALONE, 0, 0},
    [TABLE_HASH] = {"hash", PATH(hash), PATH(hash_every), &fl_hash_table, NULL, write_hash, ALONE, 0, 1},
    [TABLE_FRAMES] = {"frames", PATH(frames), PATH(frames_every), NULL, NULL, NULL, ALONE, 0, 1},
    [TABLE_PANELS] = {"panels", PATH(panels), PATH(loads_every), &fl_panels_table, NULL, write_panels,
                      WITH_LOADS, 1, 0},
    [TABLE_EVENTS] = {"events", PATH(events), PATH(loads_every), &fl_contacts_table, NULL, write_events,
                      WITH_LOADS, 0, 0},
    [TABLE_BONDS] = {"bonds", PATH(bonds), PATH(bonds_every), &fl_bonds_table, joint_column, write_bonds,
                     ALONE, 0, 1},
    [TABLE_MEMBERS] = {"members", PATH(members), PATH(members_every), &fl_member_forces_table, NULL,
                       write_members, ALONE, 0, 0},
    [TABLE_ZONES] = {"zones", PATH(zones), PATH(zones_every), &fl_zones_table, NULL, write_zones, ALONE, 0,
                     0},
    [TABLE_FAILURES] = {"failures", PATH(failures), PATH(loads_every), &fl_failures_table, NULL,
                        write_failures, WITH_LOADS, 0, 0},
};

const char *table_name(int table) { return TABLE[table].name; }

const char *scene_path(const fl_scene *s, int table)
{
    return TABLE[table].path == NO_PATH ? "" : (const char *)&s->output + TABLE[table].path;
}

void table_path(const struct run *r, const struct outputs *u, int table, char path[FL_SCENE_PATH + 16])
{
    const char *name = table == TABLE_LOADS ? r->loads_path : scene_path(r->scene, table);
    if (table == TABLE_FRAMES && r->scene->output.files > 1 && name[0])
        snprintf(path, FL_SCENE_PATH + 16, "%s.%d", name, u->frame_file);
    else snprintf(path, FL_SCENE_PATH + 16, "%s", name);
}

/* --- when rows are due ------------------------------------------------------------------------- */

static double interval_of(const fl_scene_output *s, int timer)
{
    if (timer == TIMER_ICE) return s->ice_every;
    if (timer == TIMER_SAVE) return s->checkpoint_every;
    return *(const double *)((const char *)s + TABLE[timer].every);
}

static void move_timer(struct timer *t, int64_t k, const fl_world *w)
{
    t->k = k;
    t->due = step_at(w, (double)k * t->every);
}

void set_timer(struct run *r, struct outputs *u, int timer, int64_t row)
{
    u->timer[timer].every = interval_of(&r->scene->output, timer);
    move_timer(&u->timer[timer], row, r->w);
}

void reschedule(struct run *r, struct outputs *u)
{
    for (int k = 0; k < TIMERS; k++) move_timer(&u->timer[k], u->timer[k].k, r->w);
}

/* The time now as rows write it: the time at which the row was due, 0.3 and not 0.1 + 0.1 + 0.1, if the
 * step is there but for rounding. */
static double row_time(const struct run *r, double due)
{
    const double t = fl_world_time(r->w);
    char digits[32];
    double x = t;
    if (!(fabs(t - due) <= TIME_ROUNDING * due)) return t;
    snprintf(digits, sizeof digits, "%.15g", due);
    return fl_number_f64(digits, &x) ? t : x;
}

/* --- open and close ---------------------------------------------------------------------------- */

/* NULL: frames are text. */
static fl_packed_writer *packed_writer(const struct run *r, struct outputs *u)
{
    if (r->scene->output.frames_form != FL_FRAMES_PACKED) return NULL;
    if (!u->packed.key_every)
        u->packed = fl_packed_writer_make(FL_PACKED_BOUND_X, FL_PACKED_BOUND_Q, FL_PACKED_KEY_EVERY);
    return &u->packed;
}

/* The lines "#set ..." of a table, and of contacts "#part NUMBER NAME", to be freed; NULL with FL_SYSTEM in
 * err. */
static char *make_sets(const struct run *r, int table, fl_err *err)
{
    char interval[40], *text = NULL;
    size_t n = 0;
    FILE *f = open_memstream(&text, &n);
    snprintf(interval, sizeof interval, "%s_every", table_name(table));
    int bad = !f || fl_scene_write_sets(f, r->scene, interval, err);
    /* Contacts have numbers for the parts of the structure. */
    for (int32_t k = 0; f && TABLE[table].format == &fl_contacts_table && k < r->w->parts; k++)
        fprintf(f, "#part %d %s\n", -1 - k, r->surface->part[k].name);
    if (f) bad |= fclose(f) != 0;
    if (!bad) return text;
    fl_fail(err, FL_SYSTEM, "out of memory for the head of a table");
    free(text);
    return NULL;
}

int write_header(struct run *r, struct outputs *u, int table, fl_err *err)
{
    const struct table *a = &TABLE[table];
    if (!a->format) {
        const fl_poses now = poses_of(r);
        fl_packed_writer *const packed = packed_writer(r, u);
        if (packed) fl_packed_writer_restart(packed);
        fl_frames_header(u->table[table].f, r->history, r->by, &now, r->frames_surface, packed);
        return 0;
    }
    struct mode_columns modes;
    const fl_more_columns *more = table == TABLE_LOADS    ? mode_displacements(r->w, -1, &modes)
                                  : table == TABLE_ENERGY ? mode_energies(r->w, &modes)
                                                          : NULL;
    char *const sets = make_sets(r, table, err);
    if (!sets) return -1;
    fl_table_write_header_more(u->table[table].f, a->format, a->options ? a->options(r->w) : 0, r->history,
                               r->by, sets, a->of_interval ? u->last_row : 0.0, more);
    free(sets);
    return 0;
}

static int open_table(struct run *r, struct outputs *u, int table, fl_err *err)
{
    char path[FL_SCENE_PATH + 16];
    table_path(r, u, table, path);
    return path[0] ? fl_out_open(&u->table[table], path, table == TABLE_LOADS ? r->gzip : 0, err) : 0;
}

int open_outputs(struct run *r, struct outputs *u, fl_err *err)
{
    for (int k = 0; k < TABLES; k++)
        if (open_table(r, u, k, err)) return -1;
    for (int k = 0; k < TABLES; k++)
        if (u->table[k].f && write_header(r, u, k, err)) return -1;
    for (int k = 0; k < TIMERS; k++) set_timer(r, u, k, k == TABLE_LOADS || k == TIMER_SAVE);
    return 0;
}

void keep_outputs(struct outputs *u)
{
    for (int k = 0; k < TABLES; k++) u->table[k].keep_part = 1;
}

void discard_outputs(struct outputs *u)
{
    for (int k = 0; k < TABLES; k++) u->table[k].keep_part = 0;
    abort_outputs(u);
}

int close_outputs(struct outputs *u, fl_err *err)
{
    int rc = 0;
    for (int k = 0; k < TABLES; k++) rc |= fl_out_close(&u->table[k], err);
    fl_packed_writer_free(&u->packed);
    return rc;
}

void abort_outputs(struct outputs *u)
{
    for (int k = 0; k < TABLES; k++) fl_out_abort(&u->table[k]);
    fl_packed_writer_free(&u->packed);
}

/* --- rows -------------------------------------------------------------------------------------- */

/* A table that has lost a row is not continued: the run ends. */
static int check_lost_row(struct outputs *u, fl_err *err)
{
    for (int k = 0; k < TABLES; k++)
        if (u->table[k].f && ferror(u->table[k].f)) return fl_out_flush(&u->table[k], err);
    return 0;
}

static int write_loads_rows(struct run *r, struct outputs *u, double t, fl_err *err)
{
    const double interval = t - u->last_row;
    TABLE[TABLE_LOADS].rows(r, u->table[TABLE_LOADS].f, t, interval);
    warn_at_row(r, t);
    for (int k = 0; k < TABLES; k++)
        if (u->table[k].f && TABLE[k].when == WITH_LOADS) TABLE[k].rows(r, u->table[k].f, t, interval);
    u->last_row = t;
    return fl_out_flush(&u->table[TABLE_LOADS], err);
}

/* Step from which on shapes of new floes have not been written: that of the last frame with ice; -1: all
 * have. */
static int64_t first_new_shape(const struct run *r, const struct outputs *u)
{
    struct timer last = u->timer[TIMER_ICE];
    if (!r->w->inflow.absent || last.k == 0) return -1; /* the header has the shapes of the first frame */
    move_timer(&last, last.k - 1, r->w);
    return last.due;
}

static int write_frames(struct run *r, struct outputs *u, double t, fl_err *err)
{
    const fl_scene_output *s = &r->scene->output;
    const int ice = r->w->step >= u->timer[TIMER_ICE].due;
    const int32_t file =
        s->files > 1 ? (int32_t)fmin(s->files - 1, floor(t / s->until * s->files * (1 + 1e-12))) : 0;
    if (t > s->until * (1.0 + 1e-12)) return 0;
    if (file != u->frame_file) {
        if (fl_out_close(&u->table[TABLE_FRAMES], err)) return -1;
        u->frame_file = file;
        if (open_table(r, u, TABLE_FRAMES, err)) return -1;
        if (write_header(r, u, TABLE_FRAMES, err)) return -1;
        keep_outputs(u);
    }
    if (write_frame(r, u->table[TABLE_FRAMES].f, packed_writer(r, u), t, ice,
                    ice ? first_new_shape(r, u) : -1, err))
        return -1;
    if (ice) move_timer(&u->timer[TIMER_ICE], u->timer[TIMER_ICE].k + 1, r->w);
    return 0;
}

static int write_table(struct run *r, struct outputs *u, int table, double t, fl_err *err)
{
    if (table == TABLE_LOADS) return write_loads_rows(r, u, t, err);
    if (table == TABLE_FRAMES) return write_frames(r, u, t, err);
    TABLE[table].rows(r, u->table[table].f, t, 0.0);
    return 0;
}

int write_due(struct run *r, struct outputs *u, fl_err *err)
{
    int advanced = 0; /* sleeping bodies */
    for (int k = 0; k < TABLES; k++) {
        struct timer *const timer = &u->timer[k];
        if (!u->table[k].f || r->w->step < timer->due || TABLE[k].when == WITH_LOADS) continue;
        const double t = row_time(r, (double)timer->k * timer->every);
        if (!TABLE[k].of_interval && fl_device_refresh(r->w, err)) return -1;
        if (!advanced && TABLE[k].needs_now) {
            fl_sleep_advance_to_now(r->w);
            advanced = 1;
        }
        if (write_table(r, u, k, t, err) || check_lost_row(u, err)) return -1;
        move_timer(timer, timer->k + 1, r->w);
    }
    if (advanced) fl_sleep_restore(r->w);
    return 0;
}

int write_last_loads(struct run *r, struct outputs *u, fl_err *err)
{
    const double end = row_time(r, r->scene->run.duration);
    return end > u->last_row * (1.0 + TIME_ROUNDING) ? write_loads_rows(r, u, end, err) : 0;
}
