/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "sim/setup.h"
#include "step/beside.h"
#include "base/expo.h"
#include "base/mem.h"
#include "out/relay.h"
#include "step/press.h"
#include "step/step.h"
#include "world/access.h"

int fl_beside_make(fl_beside *s, const fl_scene *scene, const fl_field *field, const fl_field *feed,
                   const fl_surface *surface, fl_err *err)
{
    *s = (fl_beside){.since = -1.0};
    if (fl_world_make_fed(&s->w, scene, field, feed, surface, err)) return -1;
    s->run = fl_alloc(s->w.parts, sizeof *s->run, err);
    s->other = s->run ? fl_alloc(s->w.parts, sizeof *s->other, err) : NULL;
    if (s->other) return 0;
    fl_beside_free(s);
    return -1;
}

void fl_beside_free(fl_beside *s)
{
    fl_world_free(&s->w);
    free(s->run), free(s->other);
    *s = (fl_beside){0};
}

/* What the parts of w have borne in a row comes to what they had. */
static void bear(fl_borne *all, const fl_world *w)
{
    for (int32_t p = 0; p < w->parts; p++) {
        all[p].impulse = v3_add(all[p].impulse, w->part_impulse[p]);
        all[p].moment = v3_add(all[p].moment, w->part_moment[p]);
        all[p].peak = fmax(all[p].peak, w->part_peak[p]);
    }
}

/* What r tells: |r^p - 1|. */
static double telling(double ratio, double p) { return fabs(fl_pow(ratio, p) - 1.0); }

double fl_beside_apart(const fl_beside *s, int32_t of)
{
    double apart = 0.0, size = 0.0;
    for (int32_t p = 0; p < s->w.parts; p++) {
        const fl_vec3 a = fl_borne_load(of, s->run[p]);
        apart += v3_norm(v3_sub(fl_borne_load(of, s->other[p]), a));
        size += v3_norm(a);
    }
    return size > 0.0 ? apart / size : 0.0;
}

double fl_beside_off(const fl_beside *s, double apart, double p)
{
    return s->ratio > 0.0 ? apart / telling(s->ratio, p) : 0.0;
}

/* A row has ended, with r = ratio. */
static void compare(fl_beside *s, const fl_world *w, double ratio, int32_t of, double goal, double p)
{
    fl_world *o = &s->w;
    bear(s->run, w), bear(s->other, o);
    for (int32_t k = 0; k < o->parts; k++) {
        o->part_impulse[k] = o->part_moment[k] = v3(0, 0, 0);
        o->part_peak[k] = 0.0;
    }
    if (o->press.panels) fl_press_panels_end(o), fl_press_events_end(o); /* nobody writes them */
    if (!(s->ratio > 0.0) || telling(ratio, p) < telling(s->ratio, p)) s->ratio = ratio;
    s->until = fl_world_time(w);
    if (fl_beside_off(s, fl_beside_apart(s, of), p) <= FL_DOUBT * goal) s->since = -1.0;
    else if (s->since < 0.0) s->since = s->until;
}

int fl_beside_follow(fl_beside *s, const fl_world *w, double every, int32_t of, double goal, double p,
                     fl_err *err)
{
    fl_world *o = &s->w;
    const int64_t m = llround(every / w->dt), done = w->step - w->step0,
                  n = m > 1 ? llround((double)m * sqrt(0.5)) : 2;
    fl_err why = {0};
    if (s->ended) return 0;
    if (!s->started) {
        s->started = 1;
        o->dt = every / (double)n;
        fl_step_start(o, &why);
    }
    if (done == 1) fl_step_resize(o, every / (double)n, w->t0);
    while (!why.code && o->step - o->step0 < done * n / m) fl_step(o, &why);
    if (why.code == FL_SYSTEM) {
        *err = why;
        return -1;
    }
    if (why.code) s->ended = 1;
    else if (done == m) compare(s, w, (double)m / (double)n, of, goal, p);
    return 0;
}

int fl_beside_exchange(FILE *f, fl_text *in, fl_beside *s, fl_err *err)
{
    fl_relay t = {f, in, err};
    fl_relay_open(&t, "beside");
    fl_relay_whole(&t, 0, 1, &s->started);
    fl_relay_whole(&t, 0, 1, &s->ended);
    fl_relay_real(&t, &s->ratio);
    fl_relay_real(&t, &s->since);
    fl_relay_real(&t, &s->until);
    fl_relay_close(&t);
    for (int32_t p = 0; p < s->w.parts; p++) {
        fl_relay_open(&t, "borne");
        for (int k = 0; k < 2; k++) {
            fl_borne *b = k ? &s->other[p] : &s->run[p];
            fl_relay_vec3(&t, &b->impulse);
            fl_relay_vec3(&t, &b->moment);
            fl_relay_real(&t, &b->peak);
        }
        fl_relay_close(&t);
    }
    return err->code ? -1 : 0;
}
