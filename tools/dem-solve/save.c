/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "save.h"
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "base/number_text.h"
#include "clocks.h"
#include "mesh/gstruct.h"
#include "run_record.h"
#include "scene/scene_check.h"
#include "scene/scene_print.h"
#include "scene/scene_read.h"
#include "sim/critical_step.h"
#include "sim/snapshot.h"
#include "sim/step.h"
#include "step_choice.h"
#include "world/access.h"

/* Keys that a resumed run may change, besides the paths of its tables.  The first two give it another step
 * from then on; the others change no step and no row. */
enum { STEP_KEYS = 2 };
static const char *const FREE_KEY[] = {"run.dt",      "run.safety",        "run.duration",
                                       "run.threads", "output.checkpoint", "output.checkpoint_every"};

/* --- write ------------------------------------------------------------------------------------- */

static int close_text(FILE *f, fl_restart_part *part, const size_t *n, fl_err *err)
{
    const int bad = ferror(f);
    if (fclose(f) || bad) return fl_fail(err, FL_SYSTEM, "out of memory for a checkpoint");
    part->n = (int64_t)*n;
    return 0;
}

int save_inputs_as_text(fl_restart_part input[INPUT_TEXTS], const fl_ice_field *field,
                        const fl_surface *surface, const fl_member_model *members, const fl_ice_field *feed,
                        const fl_history_line *by, fl_err *err)
{
    static const char *const NAME[INPUT_TEXTS] = {"ice", "structure", "inflow"};
    const int present[INPUT_TEXTS] = {1, surface != NULL, feed->n > 0};
    for (int k = 0; k < INPUT_TEXTS; k++) {
        char *text = NULL;
        size_t n = 0;
        input[k] = (fl_restart_part){.name = ""};
        if (!present[k]) continue;
        snprintf(input[k].name, sizeof input[k].name, "%s", NAME[k]);
        FILE *f = open_memstream(&text, &n);
        if (!f) return fl_fail(err, FL_SYSTEM, "out of memory for a checkpoint");
        if (k == 1 && members) fl_member_model_write(f, members, by);
        else if (k == 1) fl_gstruct_write(f, surface, by);
        else fl_ice_field_write(f, k ? feed : field, by);
        const int bad = close_text(f, &input[k], &n, err);
        input[k].text = text;
        if (bad) return -1;
    }
    return 0;
}

/* Positions in the tables: next rows, and the end of each file. */
static void write_positions(FILE *f, const struct run *r, const struct outputs *u, const fl_file_mark *mark)
{
    char num[FL_NUMBER_LEN];
    fprintf(f, "rows");
    for (int k = 0; k < TIMERS; k++) fprintf(f, " %" PRId64, u->timer[k].k);
    fprintf(f, " %s %" PRId32 "\n", fl_number_text(u->last_row, num), u->frame_file);
    for (int k = 0; k < TABLES; k++)
        if (u->table[k].f)
            fprintf(f, "table %s %" PRId64 " %" PRIu64 " %d\n", table_name(k), mark[k].offset,
                    mark[k].tail_hash, k == TABLE_LOADS && r->gzip);
}

int save_write(struct run *r, struct outputs *u, fl_err *err)
{
    enum { SCENE, ICE, STRUCTURE, INFLOW, POSITIONS, LOADS, STATE, BUDGET, COMPANION, PARTS };
    fl_restart_part part[PARTS] = {
        [SCENE] = {.name = "scene"},
        [ICE] = r->input_text[0],
        [STRUCTURE] = r->input_text[1],
        [INFLOW] = r->input_text[2],
        [POSITIONS] = {.name = "tables"},
        [LOADS] = {.name = "loads", .text = r->loads_path, .n = (int64_t)strlen(r->loads_path)},
        [STATE] = {.name = "state"},
        [BUDGET] = {.name = "budget"},
        [COMPANION] = {.name = "beside"}};
    fl_file_mark mark[TABLES];
    char *text[PARTS] = {0}, *history = NULL;
    size_t n[PARTS] = {0};
    const double begun = wall_clock();
    fl_scene scene = *r->scene; /* a copy for writing, without the number of threads */
    int rc = -1;
    const int companion = r->budget && fl_companion_is_active(&r->budget->companion);
    if (!r->budget) part[BUDGET].name[0] = '\0';
    if (!companion) part[COMPANION].name[0] = '\0';
    scene.run.threads = 0; /* the only byte that would depend on the machine */
    for (int k = 0; k < TABLES; k++)
        if (u->table[k].f && fl_out_mark(&u->table[k], &mark[k], err)) return -1;
    fl_packed_writer_restart(&u->packed); /* the next frame does not refer to one before the mark */
    for (int k = 0; k < PARTS; k++) {
        if (part[k].text || !part[k].name[0]) continue;
        FILE *f = open_memstream(&text[k], &n[k]);
        if (!f) {
            fl_fail(err, FL_SYSTEM, "out of memory for a checkpoint");
            goto done;
        }
        if (k == SCENE) fl_scene_write(f, &scene);
        if (k == POSITIONS) write_positions(f, r, u, mark);
        if (k == STATE) fl_snapshot_write(f, r->w);
        if (k == BUDGET) fl_error_budget_write(f, r->budget);
        if (k == COMPANION) fl_snapshot_write(f, &r->budget->companion.world);
        if (close_text(f, &part[k], &n[k], err)) goto done;
        part[k].text = text[k];
    }
    const size_t own_line = strlen(r->by->text), before = r->history ? strlen(r->history) : 0;
    history = fl_alloc((int64_t)(before + own_line) + 2, 1, err);
    if (!history) goto done;
    if (before) memcpy(history, r->history, before);
    memcpy(history + before, r->by->text, own_line);
    history[before + own_line] = '\n';
    int present = 0; /* some may be absent */
    for (int k = 0; k < PARTS; k++)
        if (part[k].name[0]) part[present++] = part[k];
    rc = fl_restart_write(r->scene->output.checkpoint, history, part, present, err);
done:
    for (int k = 0; k < PARTS; k++) free(text[k]);
    free(history);
    r->saves++;
    r->saved_step = r->w->step;
    r->save_wall += wall_clock() - begun;
    return rc;
}

/* --- read -------------------------------------------------------------------------------------- */

/* 1 if an assignment sets that key. */
static int sets_key(const char *set, const char *key)
{
    const size_t len = strcspn(set, "= ");
    return strlen(key) == len && strncmp(key, set, len) == 0;
}

/* 1 if an assignment sets the path of a table. */
static int sets_table_path(const char *set)
{
    char key[32];
    for (int k = 0; k < TABLES; k++) {
        snprintf(key, sizeof key, "output.%s", table_name(k));
        if (k != TABLE_LOADS && sets_key(set, key)) return 1;
    }
    return 0;
}

static int change_key(fl_scene *scene, const char *set, fl_err *err)
{
    const int keys = (int)(sizeof FREE_KEY / sizeof *FREE_KEY);
    int may = sets_table_path(set);
    for (int k = 0; k < keys; k++) may |= sets_key(set, FREE_KEY[k]);
    if (may) return fl_scene_set(scene, set, err);
    return fl_fail(err, FL_USAGE,
                   "--set: \"%.60s\" would change the run that is resumed; run.duration, "
                   "run.threads, run.dt, run.safety and files of output may be changed",
                   set);
}

int save_read_inputs(const fl_restart *saved, const struct options *o, fl_scene *scene, fl_ice_field *field,
                     fl_ice_field *feed, fl_surface *surface, fl_member_model *members, fl_err *err)
{
    fl_text text = {0};
    if (fl_restart_open(saved, "scene", &text, err) || fl_scene_read_text(scene, &text, err)) return -1;
    const double duration = scene->run.duration;
    for (int k = 0; k < o->sets; k++)
        if (change_key(scene, o->set[k], err)) return -1;
    if (o->threads) scene->run.threads = o->threads;
    if (fl_scene_check(scene, err)) return -1;
    if (scene->output.until == duration)
        scene->output.until = scene->run.duration; /* its default is the duration */
    if (fl_restart_open(saved, "ice", &text, err) || fl_ice_field_read_text(field, &text, err)) return -1;
    if (fl_restart_find(saved, "inflow") &&
        (fl_restart_open(saved, "inflow", &text, err) || fl_ice_field_read_text(feed, &text, err)))
        return -1;
    if (!fl_restart_find(saved, "structure")) return 0;
    if (fl_restart_open(saved, "structure", &text, err)) return -1;
    if (!scene->structure.members[0]) return fl_gstruct_read_text(surface, &text, err) ? -1 : 0;
    const int rc = fl_member_model_read_text(members, &text, err);
    fl_text_close(&text);
    return rc;
}

int save_read_history(const fl_restart *saved, char **history, fl_history_line *by, fl_err *err)
{
    const char *all = saved->history, *own_line = NULL;
    for (const char *p = all; *p; p = strchr(p, '\n') + 1) own_line = p;
    if (!own_line || strlen(own_line) > FL_HISTORY_LINE_MAX)
        return fl_fail(err, FL_INPUT, "%s: the checkpoint has no history of its run", saved->path);
    by->len = (int)strlen(own_line) - 1;
    memcpy(by->text, own_line, (size_t)by->len);
    by->text[by->len] = '\0';
    *history = fl_alloc(own_line - all + 1, 1, err);
    if (!*history) return -1;
    memcpy(*history, all, (size_t)(own_line - all));
    return 0;
}

static int read_count(fl_text *in, int64_t *x, fl_err *err)
{
    const char *word = "";
    char *end;
    if (fl_text_word(in, "count", &word, err)) return -1;
    const long long n = strtoll(word, &end, 10);
    if (end == word || *end || n < -1 || n > INT64_C(1) << 53)
        return fl_text_fail(in, err, "\"%.40s\" found, a count expected", word);
    *x = n;
    return 0;
}

static int read_next_rows(fl_text *in, struct run *r, struct outputs *u, fl_err *err)
{
    int64_t k;
    for (int c = 0; c < TIMERS; c++) {
        if (read_count(in, &k, err)) return -1;
        set_timer(r, u, c, k);
    }
    /* the next checkpoint is after this one, also if its interval has changed */
    while (u->timer[TIMER_SAVE].due <= r->w->step) set_timer(r, u, TIMER_SAVE, u->timer[TIMER_SAVE].k + 1);
    return fl_text_f64(in, "time of the last row", &u->last_row, err) ||
                   fl_text_i32(in, "file of the frames", 0, INT32_MAX, &u->frame_file, err) ||
                   fl_text_no_more(in, err)
               ? -1
               : 0;
}

static int read_position(fl_text *in, fl_file_mark mark[TABLES], int written[TABLES], struct run *r,
                         fl_err *err)
{
    const char *name = "", *tail = "";
    fl_file_mark m = {0};
    int32_t gzip = 0;
    if (fl_text_word(in, "table", &name, err) || read_count(in, &m.offset, err) ||
        fl_text_word(in, "hash", &tail, err) || fl_text_i32(in, "gzip", 0, 1, &gzip, err) ||
        fl_text_no_more(in, err))
        return -1;
    if (fl_number_u64(tail, &m.tail_hash))
        return fl_text_fail(in, err, "\"%.40s\" found, a hash expected", tail);
    for (int k = 0; k < TABLES; k++) {
        if (strcmp(name, table_name(k)) != 0) continue;
        mark[k] = m;
        written[k] = 1;
        if (k == TABLE_LOADS) r->gzip = gzip;
        return 0;
    }
    return fl_text_fail(in, err, "unknown table \"%.40s\"", name);
}

static int read_positions(struct run *r, struct outputs *u, fl_file_mark mark[TABLES], int written[TABLES],
                          fl_err *err)
{
    fl_text in = {0};
    const char *word = "";
    int more, rows = 0;
    if (fl_restart_open(r->resumed, "tables", &in, err)) return -1;
    while ((more = fl_text_row(&in, err)) > 0) {
        if (fl_text_word(&in, "row", &word, err)) break;
        const int first = strcmp(word, "rows") == 0;
        if (!first && strcmp(word, "table") != 0) fl_text_fail(&in, err, "unknown row \"%.40s\"", word);
        else if (first ? read_next_rows(&in, r, u, err) : read_position(&in, mark, written, r, err)) break;
        if (err->code) break;
        rows += first;
    }
    if (!err->code && (rows != 1 || !written[TABLE_LOADS]))
        fl_fail(err, FL_INPUT, "%s: the checkpoint has no positions of its tables", r->resumed->path);
    fl_text_close(&in);
    return err->code ? -1 : 0;
}

/* Change the step from now on if the command line does: rows are due at the first step at or after their
 * times. water.every stays the same number of steps. */
static int change_step(struct run *r, double dt, fl_err *err)
{
    int requested = 0;
    for (int k = 0; k < r->o->sets; k++)
        for (int c = 0; c < STEP_KEYS; c++) requested |= sets_key(r->o->set[k], FREE_KEY[c]);
    if (!requested || dt == r->w->dt) return 0;
    snprintf(r->step_change, sizeof r->step_change, "from t = %.9g s on steps are %.4g s instead of %.4g s",
             fl_world_time(r->w), dt, r->w->dt);
    if (!r->o->quiet) fprintf(stderr, "dem-solve: note: %s\n", r->step_change);
    fl_step_set_size(r->w, dt, fl_world_time(r->w));
    return fl_check_wave_sampling(r->w, err);
}

/* The duration that the checkpoint has [s]. */
static int read_duration(const fl_restart *saved, double *duration, fl_err *err)
{
    fl_scene scene = {0};
    fl_text text = {0};
    if (fl_restart_open(saved, "scene", &text, err) || fl_scene_read_text(&scene, &text, err)) return -1;
    *duration = scene.run.duration;
    fl_scene_free(&scene);
    return 0;
}

int save_restore(struct run *r, struct outputs *u, fl_err *err)
{
    double before;
    char path[FL_SCENE_PATH + 16];
    fl_file_mark mark[TABLES];
    fl_text in = {0};
    int written[TABLES] = {0}, is_new[TABLES] = {0};
    const double dt = r->w->dt; /* that of the scene */
    if (read_duration(r->resumed, &before, err) || fl_restart_open(r->resumed, "state", &in, err)) return -1;
    fl_snapshot_read(r->w, &in, err);
    fl_text_close(&in);
    if (!err->code) change_step(r, dt, err);
    if (!err->code && r->budget && fl_restart_open(r->resumed, "budget", &in, err) == 0) {
        fl_error_budget_read(r->budget, &in, err);
        fl_text_close(&in);
    }
    if (!err->code && r->budget && fl_companion_is_active(&r->budget->companion) &&
        fl_restart_open(r->resumed, "beside", &in, err) == 0) {
        fl_snapshot_read(&r->budget->companion.world, &in, err);
        fl_text_close(&in);
    }
    if (err->code || read_positions(r, u, mark, written, err)) return -1;
    count_steps(r);
    r->first_step = r->w->step;
    r->first_time = fl_world_time(r->w);
    r->first_contact_steps = r->w->contact_steps;
    if (r->steps < r->w->step)
        return fl_fail(err, FL_USAGE,
                       "run.duration is %g s, and the checkpoint is of t = %g s: a later end expected",
                       r->scene->run.duration, fl_world_time(r->w));
    for (int k = 0; k < TABLES; k++) { /* check all before one is changed */
        table_path(r, u, k, path);
        if (path[0] && !written[k])
            return fl_fail(err, FL_USAGE,
                           "%s: the run to resume does not write output.%s, which cannot begin now", path,
                           table_name(k));
        if (!path[0] && written[k])
            return fl_fail(err, FL_USAGE,
                           "the run to resume writes output.%s, which cannot end now: a file expected",
                           table_name(k));
        if (path[0] && fl_out_check_mark(path, &mark[k], err)) return -1;
    }
    for (int k = 0; k < TABLES; k++) {
        table_path(r, u, k, path);
        if (!path[0]) continue;
        if (fl_out_resume(&u->table[k], path, k == TABLE_LOADS && r->gzip, &mark[k], &is_new[k], err))
            return -1;
    }
    for (int k = 0; k < TABLES; k++)
        if (is_new[k] && write_header(r, u, k, err)) return -1;
    record_changes(r, u, before, is_new);
    return 0;
}
