/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "sim/companion_run.h"
#include "base/array.h"
#include "base/fast_math.h"
#include "contact/panel_load.h"
#include "out/state_io.h"
#include "sim/setup.h"
#include "sim/step.h"
#include "world/access.h"

int fl_companion_make(fl_companion *s, const fl_scene *scene, const fl_ice_field *field,
                      const fl_ice_field *feed, const fl_surface *surface, const fl_member_model *members,
                      fl_err *err)
{
    *s = (fl_companion){.exceeded_since = -1.0};
    if (fl_world_make_with_inflow(&s->world, scene, field, feed, surface, members, err)) return -1;
    s->run_load = fl_alloc(s->world.parts, sizeof *s->run_load, err);
    s->own_load = s->run_load ? fl_alloc(s->world.parts, sizeof *s->own_load, err) : NULL;
    if (s->own_load) return 0;
    fl_companion_free(s);
    return -1;
}

void fl_companion_free(fl_companion *s)
{
    fl_world_free(&s->world);
    free(s->run_load), free(s->own_load);
    *s = (fl_companion){0};
}

/* Add the loads of a row on the parts of w. */
static void add_loads(fl_total_load *all, const fl_world *w)
{
    for (int32_t p = 0; p < w->parts; p++) {
        all[p].impulse = v3_add(all[p].impulse, w->part_impulse[p]);
        all[p].moment = v3_add(all[p].moment, w->part_moment[p]);
        all[p].peak = fmax(all[p].peak, w->part_peak[p]);
    }
}

/* |r^p - 1| */
static double error_factor(double ratio, double p) { return fabs(fl_pow(ratio, p) - 1.0); }

double fl_companion_difference(const fl_companion *s, int32_t of)
{
    double difference = 0.0, size = 0.0;
    for (int32_t p = 0; p < s->world.parts; p++) {
        const fl_vec3 a = fl_load_component(of, s->run_load[p]);
        difference += v3_norm(v3_sub(fl_load_component(of, s->own_load[p]), a));
        size += v3_norm(a);
    }
    return size > 0.0 ? difference / size : 0.0;
}

double fl_companion_error(const fl_companion *s, double difference, double p)
{
    return s->step_ratio > 0.0 ? difference / error_factor(s->step_ratio, p) : 0.0;
}

/* Compare the loads at the end of a row with r = ratio. */
static void compare_row(fl_companion *s, const fl_world *w, double ratio, int32_t of, double goal, double p)
{
    fl_world *o = &s->world;
    add_loads(s->run_load, w), add_loads(s->own_load, o);
    for (int32_t k = 0; k < o->parts; k++) {
        o->part_impulse[k] = o->part_moment[k] = v3(0, 0, 0);
        o->part_peak[k] = 0.0;
    }
    if (o->panel_load.panels) fl_panels_end_interval(o), fl_events_end_interval(o); /* not written */
    if (!(s->step_ratio > 0.0) || error_factor(ratio, p) < error_factor(s->step_ratio, p))
        s->step_ratio = ratio;
    s->last_row_time = fl_world_time(w);
    if (fl_companion_error(s, fl_companion_difference(s, of), p) <= FL_COMPANION_TOLERANCE * goal)
        s->exceeded_since = -1.0;
    else if (s->exceeded_since < 0.0) s->exceeded_since = s->last_row_time;
}

int fl_companion_follow(fl_companion *s, const fl_world *w, double every, int32_t of, double goal, double p,
                        fl_err *err)
{
    fl_world *o = &s->world;
    const int64_t m = llround(every / w->dt), done = w->step - w->step0,
                  n = m > 1 ? llround((double)m * sqrt(0.5)) : 2;
    fl_err why = {0};
    if (s->ended) return 0;
    if (!s->started) {
        s->started = 1;
        o->dt = every / (double)n;
        fl_step_start(o, &why);
    }
    if (done == 1) fl_step_set_size(o, every / (double)n, w->t0);
    while (!why.code && o->step - o->step0 < done * n / m) fl_step(o, &why);
    if (why.code == FL_SYSTEM) {
        *err = why;
        return -1;
    }
    if (why.code) s->ended = 1;
    else if (done == m) compare_row(s, w, (double)m / (double)n, of, goal, p);
    return 0;
}

int fl_companion_state_io(FILE *f, fl_text *in, fl_companion *s, fl_err *err)
{
    fl_state_io t = {f, in, err};
    fl_state_io_open(&t, "beside");
    fl_state_io_int(&t, 0, 1, &s->started);
    fl_state_io_int(&t, 0, 1, &s->ended);
    fl_state_io_real(&t, &s->step_ratio);
    fl_state_io_real(&t, &s->exceeded_since);
    fl_state_io_real(&t, &s->last_row_time);
    fl_state_io_close(&t);
    for (int32_t p = 0; p < s->world.parts; p++) {
        fl_state_io_open(&t, "borne");
        for (int k = 0; k < 2; k++) {
            fl_total_load *b = k ? &s->own_load[p] : &s->run_load[p];
            fl_state_io_vec3(&t, &b->impulse);
            fl_state_io_vec3(&t, &b->moment);
            fl_state_io_real(&t, &b->peak);
        }
        fl_state_io_close(&t);
    }
    return err->code ? -1 : 0;
}
