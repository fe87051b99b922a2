/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "start_up.h"
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include "stat/startup.h"

/* The force that a designer reads first: of all columns in newton that of the largest root mean square. */
static const double *largest_force(const fl_series *s, int32_t *pair)
{
    const double *largest = NULL;
    double most = 0.0;
    for (int32_t k = 0; k < s->parts * s->signals; k++) {
        double square = 0.0;
        if (!s->x[k] || strcmp(s->unit[k % s->signals], "N") != 0) continue;
        for (int32_t j = 0; j < s->n; j++) square += s->x[k][j] * s->x[k][j];
        if (square > most) most = square, largest = s->x[k], *pair = k;
    }
    return largest;
}

static int is_whole(const struct options *o)
{
    return !o->keep_start && !o->skips && !isfinite(o->from) && !isfinite(o->to) && !(o->window > 0.0) &&
           !o->wheres && !o->over;
}

/* Find the start-up of the largest force of the record of a run of dem-solve, which is known to have one. */
static int find_start(const fl_series *s, fl_startup *start, int32_t *pair, fl_err *err)
{
    const int is_run = strcmp(s->kind, "loads") == 0 && s->run_lines && s->edge[0] == 0.0;
    const double *force = is_run ? largest_force(s, pair) : NULL;
    *start = (fl_startup){0};
    return force ? fl_startup_find(start, s->n, force, s->edge[s->n] - s->edge[0], err) : 0;
}

int start_up_drop(fl_series *s, const struct options *o, char note[START_NOTE], fl_err *err)
{
    fl_startup start;
    int32_t pair = 0;
    note[0] = '\0';
    if (!is_whole(o)) return 0;
    if (find_start(s, &start, &pair, err)) return -1;
    if (start.rows == 0) return 0;
    snprintf(
        note, START_NOTE,
        "start-up until %.6g s is left out: mean %s of %s %.3g kN there and %.3g kN later, %.2g standard "
        "errors apart (--skip none keeps it)",
        s->edge[start.rows], s->signal[pair % s->signals], s->part[pair / s->signals], 1e-3 * start.mean[0],
        1e-3 * start.mean[1], start.apart);
    fl_series_drop_first(s, start.rows);
    return 0;
}

int start_up_of_runs(const struct options *o, double *from, char note[START_NOTE], fl_err *err)
{
    const fl_record_selection selection = {.signal = o->signal,
                                           .signals = o->signals,
                                           .part = o->part,
                                           .about = o->abouts ? o->about : NULL,
                                           .from = o->from,
                                           .to = o->to};
    struct stat file;
    double latest = 0.0, shortest = INFINITY;
    int sure = 0, which = 0;
    *from = o->from;
    note[0] = '\0';
    if (!is_whole(o) || o->merge || o->stream || o->follow > 0.0) return 0;
    for (int k = 0; k < o->files; k++)
        if (stat(o->file[k], &file) || !S_ISREG(file.st_mode)) return 0;
    for (int k = 0; k < o->files; k++) {
        fl_series s = {0};
        fl_startup start;
        int32_t pair = 0;
        if (fl_series_read(&s, o->file[k], &selection, err) || find_start(&s, &start, &pair, err)) {
            fl_series_free(&s);
            return -1;
        }
        sure += start.rows > 0;
        shortest = fmin(shortest, s.edge[s.n]);
        if (start.rows && s.edge[start.rows] > latest) latest = s.edge[start.rows], which = k;
        fl_series_free(&s);
    }
    if (!sure || latest > 0.5 * shortest) return 0;
    *from = latest;
    snprintf(note, START_NOTE,
             "start-up until %.6g s is left out of all runs: it is sure in %d of %d, latest in %.100s "
             "(--skip none "
             "keeps it)",
             latest, sure, o->files, o->file[which]);
    return 0;
}
